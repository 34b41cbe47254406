// SPDX-License-Identifier: BSD-3-Clause
#include "RegionChains.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace knotwork
{
namespace
{
/// Side k of triangle t, from its corner k to the next one, is number 3 t + k.
class Tracer
{
public:
  Tracer(const DiscMesh& surface, const std::vector<int>& regions)
    : Surface(surface), RegionOf(regions), Twins(3 * surface.Triangles.size(), -1)
  {
    std::map<std::array<int, 2>, int> sides; // by their points, until the other side comes
    for (int side = 0; side < static_cast<int>(this->Twins.size()); ++side)
    {
      const auto other = sides.find({ this->Head(side), this->Tail(side) });
      if (other == sides.end())
      {
        sides.insert({ { this->Tail(side), this->Head(side) }, side });
        continue;
      }
      this->Twins[At(side)] = other->second;
      this->Twins[At(other->second)] = side;
    }
  }

  RegionChains Run(int numRegions, double cornerAngle)
  {
    const int numSides = 3 * static_cast<int>(this->Surface.Triangles.size());
    this->ChainOf.assign(static_cast<std::size_t>(numSides), -1);
    this->MarkVertices(cornerAngle);
    for (int side = 0; side < numSides; ++side)
    {
      if (this->IsBoundary(side) && this->VertexAt(this->Tail(side)) >= 0)
      {
        this->Follow(side);
      }
    }
    for (int side = 0; side < numSides; ++side) // closed ones are left
    {
      if (this->IsBoundary(side))
      {
        this->Follow(side);
      }
    }
    this->CollectLoops(numRegions);
    return std::move(this->Found);
  }

private:
  static std::size_t At(int i) { return static_cast<std::size_t>(i); }
  int Region(int side) const { return this->RegionOf[At(side / 3)]; }
  int Twin(int side) const { return this->Twins[At(side)]; }
  int RegionBeyond(int side) const
  {
    const int twin = this->Twin(side);
    return twin < 0 ? -1 : this->Region(twin);
  }
  bool IsBoundary(int side) const { return this->RegionBeyond(side) != this->Region(side); }
  int Tail(int side) const { return this->Surface.Triangles[At(side / 3)][At(side % 3)]; }
  int Head(int side) const { return this->Surface.Triangles[At(side / 3)][At((side + 1) % 3)]; }
  int VertexAt(int point) const { return this->VertexOf[At(point)]; }

  static int AfterInTriangle(int side) { return side / 3 * 3 + (side + 1) % 3; }

  /// The next side of the region's boundary.
  int Next(int side) const
  {
    int next = AfterInTriangle(side);
    while (!this->IsBoundary(next))
    {
      next = AfterInTriangle(this->Twin(next));
    }
    return next;
  }

  void MarkVertices(double cornerAngle)
  {
    constexpr double radians = 3.14159265358979323846 / 180.0;
    struct Meeting
    {
      int Edges = 0;
      std::set<std::array<int, 2>> Pairs; ///< of regions
      std::vector<Eigen::Vector3d> Rims;  ///< directions of the rim, in and out
      std::set<int> Regions;
    };
    std::map<int, Meeting> meetings;
    for (int side = 0; side < static_cast<int>(this->ChainOf.size()); ++side)
    {
      if (!this->IsBoundary(side))
      {
        continue;
      }
      const int own = this->Region(side);
      const int other = this->RegionBeyond(side);
      for (const int point : { this->Tail(side), this->Head(side) })
      {
        Meeting& meeting = meetings[point];
        meeting.Regions.insert(own);
        if (other < own) // an inner edge is seen from both sides
        {
          ++meeting.Edges;
          meeting.Pairs.insert({ other, own });
        }
        if (other < 0)
        {
          meeting.Rims.push_back(
            this->Surface.Point(this->Head(side)) - this->Surface.Point(this->Tail(side)));
        }
      }
    }
    this->VertexOf.assign(At(this->Surface.NumPoints()), -1);
    for (const auto& [point, meeting] : meetings)
    {
      const bool turns = meeting.Rims.size() == 2 &&
        meeting.Rims[0].normalized().dot(meeting.Rims[1].normalized()) <
          std::cos(cornerAngle * radians);
      if (meeting.Edges != 2 || meeting.Pairs.size() != 1 || turns)
      {
        this->VertexOf[At(point)] = static_cast<int>(this->Found.Vertices.size());
        this->Found.Vertices.push_back({ this->Surface.Point(point), this->Surface.Point(point),
          point, std::vector<int>(meeting.Regions.begin(), meeting.Regions.end()) });
      }
    }
  }

  void Follow(int first)
  {
    if (this->ChainOf[At(first)] >= 0)
    {
      return;
    }
    const int number = static_cast<int>(this->Found.Chains.size());
    RegionChain chain;
    chain.Regions = { this->Region(first), this->RegionBeyond(first) };
    chain.Vertices[0] = this->VertexAt(this->Tail(first));
    chain.Points.push_back(this->Surface.Point(this->Tail(first)));
    chain.PointIds.push_back(this->Tail(first));
    int side = first;
    while (true)
    {
      this->ChainOf[At(side)] = number;
      if (const int twin = this->Twin(side); twin >= 0)
      {
        this->ChainOf[At(twin)] = number;
      }
      chain.Points.push_back(this->Surface.Point(this->Head(side)));
      chain.PointIds.push_back(this->Head(side));
      chain.Vertices[1] = this->VertexAt(this->Head(side));
      side = chain.Vertices[1] >= 0 ? side : this->Next(side);
      if (chain.Vertices[1] >= 0 || side == first)
      {
        break;
      }
    }
    chain.MeshPoints = chain.Points;
    this->Found.Chains.push_back(std::move(chain));
  }

  void CollectLoops(int numRegions)
  {
    this->Found.Loops.resize(At(numRegions));
    std::vector<char> done(this->ChainOf.size(), 0);
    for (int first = 0; first < static_cast<int>(this->ChainOf.size()); ++first)
    {
      if (done[At(first)] || !this->IsBoundary(first) || !this->BeginsUse(first))
      {
        continue;
      }
      auto& loop = this->Found.Loops[At(this->Region(first))].emplace_back();
      for (int side = first; !done[At(side)]; side = this->Next(side))
      {
        done[At(side)] = 1;
        if (this->BeginsUse(side))
        {
          const int chain = this->ChainOf[At(side)];
          loop.push_back({ chain, this->Region(side) != this->Found.Chains[At(chain)].Regions[0] });
        }
      }
    }
  }

  /// Whether a chain begins, or ends, there. Of a closed one without a vertex: where it does.
  bool BeginsUse(int side) const
  {
    const RegionChain& chain = this->Found.Chains[At(this->ChainOf[At(side)])];
    return chain.Vertices[0] >= 0 ? this->VertexAt(this->Tail(side)) >= 0
                                  : this->Surface.Point(this->Tail(side)) == chain.Points.front();
  }

  const DiscMesh& Surface;
  const std::vector<int>& RegionOf;
  std::vector<int> Twins;    ///< a side: its triangle's neighbour, -1 on the rim
  std::vector<int> VertexOf; ///< a point
  std::vector<int> ChainOf;  ///< a side
  RegionChains Found;
};
}

namespace
{
/// A closed row that begins elsewhere.
template <typename Item>
void Turn(std::vector<Item>& points, std::size_t first)
{
  points.pop_back();
  std::rotate(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(first % points.size()),
    points.end());
  points.push_back(points.front());
}

/// What comes from a point on.
template <typename Item>
std::vector<Item> CutOff(std::vector<Item>& points, std::size_t first)
{
  const auto at = points.begin() + static_cast<std::ptrdiff_t>(first);
  std::vector<Item> rest(at, points.end());
  points.erase(at + 1, points.end());
  return rest;
}
}

int RegionChains::Split(int chain, std::size_t point)
{
  const int vertex = static_cast<int>(this->Vertices.size());
  RegionChain& first = this->Chains[static_cast<std::size_t>(chain)];
  RegionVertex& made = this->Vertices.emplace_back();
  made.Point = first.Points[point];
  made.MeshPoint = first.MeshPoints[point];
  made.PointId = first.PointIds[point];
  for (const int region : first.Regions)
  {
    if (region >= 0)
    {
      made.Regions.push_back(region);
    }
  }
  std::sort(made.Regions.begin(), made.Regions.end());
  if (first.Vertices[0] < 0)
  {
    Turn(first.Points, point);
    Turn(first.MeshPoints, point);
    Turn(first.PointIds, point);
    first.Vertices = { vertex, vertex };
    return vertex;
  }
  RegionChain second;
  second.Points = CutOff(first.Points, point);
  second.MeshPoints = CutOff(first.MeshPoints, point);
  second.PointIds = CutOff(first.PointIds, point);
  second.Regions = first.Regions;
  second.Vertices = { vertex, first.Vertices[1] };
  first.Vertices[1] = vertex;
  const int added = static_cast<int>(this->Chains.size());
  this->Chains.push_back(std::move(second));
  for (auto& loops : this->Loops)
  {
    for (auto& loop : loops)
    {
      for (std::size_t i = 0; i < loop.size(); ++i)
      {
        if (loop[i].Chain == chain)
        {
          const bool reversed = loop[i].Reversed;
          loop.insert(
            loop.begin() + static_cast<std::ptrdiff_t>(reversed ? i : i + 1), { added, reversed });
          ++i;
        }
      }
    }
  }
  return vertex;
}

void RegionChains::Reverse(int chain)
{
  RegionChain& own = this->Chains[static_cast<std::size_t>(chain)];
  std::reverse(own.Points.begin(), own.Points.end());
  std::reverse(own.MeshPoints.begin(), own.MeshPoints.end());
  std::reverse(own.PointIds.begin(), own.PointIds.end());
  std::swap(own.Regions[0], own.Regions[1]);
  std::swap(own.Vertices[0], own.Vertices[1]);
  for (auto& loops : this->Loops)
  {
    for (auto& loop : loops)
    {
      for (ChainUseOfRegion& use : loop)
      {
        use.Reversed = use.Chain == chain ? !use.Reversed : use.Reversed;
      }
    }
  }
}

RegionChains FindRegionChains(
  const DiscMesh& surface, const std::vector<int>& regions, int numRegions, double cornerAngle)
{
  return Tracer(surface, regions).Run(numRegions, cornerAngle);
}
}
