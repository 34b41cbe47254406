// SPDX-License-Identifier: BSD-3-Clause
#include "FreeRegions.h"
#include <knotwork/MeshParameterization/MeshFeatures.h>
#include <knotwork/MeshParameterization/TriangleAdjacency.h>
#include <knotwork/SplineCore/DisjointSets.h>

#include <algorithm>
#include <map>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Parts of what is of free form: apart from each other by sharp edges, but for small ones.
class FreeParts
{
public:
  FreeParts(const DiscMesh& surface, const SurfaceRecognition& recognition)
    : Surface(surface), Sets(static_cast<int>(surface.Triangles.size()))
  {
    this->IsFree.resize(surface.Triangles.size());
    for (std::size_t t = 0; t < this->IsFree.size(); ++t)
    {
      const auto region = At(recognition.RegionOfTriangle[t]);
      this->IsFree[t] = recognition.Regions[region].Surface.Type == SurfaceType::FreeForm;
    }
    if (auto adjacency = FindAdjacency(surface.Triangles))
    {
      this->Adjacency = std::move(adjacency.Value);
    }
    const auto features = FindMeshFeatures(surface);
    this->ForFreePairs(
      [&](int s, int t, double)
      {
        if (!features || features->Regions[At(s)] == features->Regions[At(t)])
        {
          this->Sets.Unite(s, t);
        }
      });
    while (this->JoinSmall(recognition.Tolerance))
    {
    }
  }

  /// Triangles of each part, ascending.
  std::vector<std::vector<int>> Collect()
  {
    std::map<int, std::vector<int>> parts;
    for (std::size_t t = 0; t < this->IsFree.size(); ++t)
    {
      if (this->IsFree[t])
      {
        parts[this->Sets.Find(static_cast<int>(t))].push_back(static_cast<int>(t));
      }
    }
    std::vector<std::vector<int>> all;
    for (auto& [set, triangles] : parts)
    {
      all.push_back(std::move(triangles));
    }
    std::sort(all.begin(), all.end());
    return all;
  }

private:
  /// Calls with two free triangles and the length of their common edge.
  template <typename Visit>
  void ForFreePairs(const Visit& visit)
  {
    for (std::size_t t = 0; t < this->Adjacency.Triangle.size(); ++t)
    {
      for (std::size_t k = 0; k < 3; ++k)
      {
        const int other = this->Adjacency.Triangle[t][k];
        if (other > static_cast<int>(t) && this->IsFree[t] && this->IsFree[At(other)])
        {
          const auto& corners = this->Surface.Triangles[t];
          visit(static_cast<int>(t), other,
            (this->Surface.Point(corners[k]) - this->Surface.Point(corners[(k + 1) % 3])).norm());
        }
      }
    }
  }

  /// Joins parts that are hardly wider than the tolerance to the neighbour with the longest common
  /// border. @return whether there were any.
  bool JoinSmall(double tolerance)
  {
    constexpr double Wide = 3.0; // tolerances
    std::map<int, double> areas;
    for (std::size_t t = 0; t < this->IsFree.size(); ++t)
    {
      if (this->IsFree[t])
      {
        areas[this->Sets.Find(static_cast<int>(t))] +=
          TriangleArea(this->Surface.Points, this->Surface.Triangles[t]);
      }
    }
    const auto isSmall = [&](int set) { return areas[set] < Wide * Wide * tolerance * tolerance; };
    std::map<std::pair<int, int>, double> borders;
    this->ForFreePairs(
      [&](int s, int t, double length)
      {
        const int a = this->Sets.Find(s);
        const int b = this->Sets.Find(t);
        for (const auto& [own, other] : { std::pair(a, b), std::pair(b, a) })
        {
          if (a != b && isSmall(own))
          {
            borders[{ own, other }] += length;
          }
        }
      });
    std::map<int, std::pair<double, int>> longest;
    for (const auto& [pair, length] : borders)
    {
      auto& best = longest[pair.first];
      best = std::max(best, { length, pair.second });
    }
    for (const auto& [own, best] : longest)
    {
      this->Sets.Unite(own, best.second);
    }
    return !longest.empty();
  }

  const DiscMesh& Surface;
  TriangleAdjacency Adjacency;
  DisjointSets Sets;
  std::vector<char> IsFree;
};

std::array<int, 3> Turned(const std::array<int, 3>& triangle, std::size_t first)
{
  return { triangle[first], triangle[(first + 1) % 3], triangle[(first + 2) % 3] };
}

/// A place on an edge of the mesh.
struct EdgePlace
{
  std::array<int, 2> Edge{ -1, -1 }; ///< ascending
  double Share = 0.0;                ///< from the first one
};

/// A chart while points come to its rim.
struct GrowingChart
{
  std::vector<std::array<int, 3>> Triangles; ///< rows of Ids
  std::vector<int> Ids;                      ///< points of the mesh
  std::vector<Eigen::Vector2d> UV;
};

/// The points of triangles, each once for every fan of triangles around it: fans that touch in a
/// point only have it for themselves.
class FanPoints
{
public:
  /// @param corners  of triangles.
  explicit FanPoints(const std::vector<std::array<int, 3>>& corners)
  {
    DisjointSets sets(3 * static_cast<int>(corners.size())); // of corners
    const auto adjacency = FindAdjacency(corners);
    for (std::size_t t = 0; adjacency && t < corners.size(); ++t)
    {
      for (std::size_t k = 0; k < 3; ++k)
      {
        if (const int other = adjacency->Triangle[t][k]; other >= 0)
        {
          const int side = adjacency->Side[t][k]; // which runs the other way
          sets.Unite(static_cast<int>(3 * t + k), 3 * other + (side + 1) % 3);
          sets.Unite(static_cast<int>(3 * t + (k + 1) % 3), 3 * other + side);
        }
      }
    }
    std::map<int, int> numbers;
    for (std::size_t t = 0; t < corners.size(); ++t)
    {
      auto& own = this->Triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k)
      {
        const int set = sets.Find(static_cast<int>(3 * t + k));
        const auto [at, isNew] = numbers.try_emplace(set, static_cast<int>(this->Ids.size()));
        if (isNew)
        {
          this->Ids.push_back(corners[t][k]);
        }
        own[k] = at->second;
      }
    }
  }

  std::vector<std::array<int, 3>> Triangles; ///< rows of Ids
  std::vector<int> Ids;
};

class RegionCharter
{
public:
  RegionCharter(const DiscMesh& surface, const SurfaceRecognition& recognition)
    : Surface(surface), Recognition(recognition)
  {
    for (Eigen::Index i = 0; i < surface.Points.rows(); ++i)
    {
      this->Points.push_back(surface.Point(static_cast<int>(i)));
    }
  }

  Status Flatten(const FreeRegionParams& params)
  {
    const std::vector<std::vector<int>> parts =
      FreeParts(this->Surface, this->Recognition).Collect();
    for (std::size_t p = 0; p < parts.size(); ++p)
    {
      if (Status status = this->FlattenPart(parts[p], params); !status)
      {
        return { status.Code, "region of free form " + std::to_string(p) + ": " + status.Detail };
      }
      this->Made.SmoothRegion.resize(this->Charts.size(), static_cast<int>(p));
    }
    return {};
  }

  Result<ChartedRegions> Assemble();

private:
  Status FlattenPart(const std::vector<int>& triangles, const FreeRegionParams& params);
  void Split(std::vector<std::array<int, 3>>& triangles, std::vector<int>& regions) const;
  void Split(GrowingChart& chart) const;
  int FirstBetween(int from, int to) const;
  double ShareOf(const std::array<int, 2>& edge, int point) const;

  const DiscMesh& Surface;
  const SurfaceRecognition& Recognition;
  std::vector<Eigen::Vector3d> Points; ///< of the mesh, then where charts are cut
  std::map<int, EdgePlace> Places;     ///< of points that were made on edges
  /// Of an edge: points that were made on it, with their shares.
  std::map<std::array<int, 2>, std::map<double, int>> OnEdges;
  std::vector<GrowingChart> Charts;
  ChartedRegions Made;
};

Status RegionCharter::FlattenPart(const std::vector<int>& triangles, const FreeRegionParams& params)
{
  std::vector<std::array<int, 3>> corners;
  for (const int t : triangles)
  {
    corners.push_back(this->Surface.Triangles[At(t)]);
  }
  FanPoints fans(corners);
  const std::vector<int>& ids = fans.Ids;
  TriangleMesh part;
  part.Triangles = std::move(fans.Triangles);
  part.Points.resize(static_cast<Eigen::Index>(ids.size()), 3);
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    part.Points.row(static_cast<Eigen::Index>(i)) = this->Surface.Points.row(ids[i]);
  }
  const auto charted = FlattenCharts(part, params.Flatten, params.Charts);
  if (!charted)
  {
    return charted.Status;
  }
  std::vector<int> numbers; // in the mesh, of points of the cut part
  for (std::size_t i = 0; i < charted->Origins.size(); ++i)
  {
    const PointOrigin& origin = charted->Origins[i];
    if (origin.Points[1] < 0)
    {
      numbers.push_back(ids[At(origin.Points[0])]);
      continue;
    }
    int number = static_cast<int>(this->Points.size());
    if (origin.Points[2] < 0)
    {
      const int a = ids[At(origin.Points[0])];
      const int b = ids[At(origin.Points[1])];
      EdgePlace place;
      place.Edge = { std::min(a, b), std::max(a, b) };
      place.Share = origin.Weights[a < b ? 1 : 0];
      number = this->OnEdges[place.Edge].try_emplace(place.Share, number).first->second;
      this->Places[number] = place;
    }
    numbers.push_back(number);
    if (At(number) == this->Points.size())
    {
      this->Points.emplace_back(charted->Points.row(static_cast<Eigen::Index>(i)).transpose());
    }
  }
  for (const MeshParameterization& map : charted->Charts)
  {
    GrowingChart& chart = this->Charts.emplace_back();
    chart.Triangles = map.Mesh.Triangles;
    for (std::size_t i = 0; i < map.Mesh.PointIds.size(); ++i)
    {
      chart.Ids.push_back(numbers[At(map.Mesh.PointIds[i])]);
      chart.UV.emplace_back(map.UV.row(static_cast<Eigen::Index>(i)).transpose());
    }
  }
  return {};
}

double RegionCharter::ShareOf(const std::array<int, 2>& edge, int point) const
{
  return point == edge[0] ? 0.0 : point == edge[1] ? 1.0 : this->Places.at(point).Share;
}

/// The next point that was made on the way along an edge of the mesh; -1: none.
int RegionCharter::FirstBetween(int from, int to) const
{
  const auto a = this->Places.find(from);
  const auto b = this->Places.find(to);
  const std::array<int, 2> edge = a != this->Places.end() ? a->second.Edge
    : b != this->Places.end()                             ? b->second.Edge
                              : std::array<int, 2>{ std::min(from, to), std::max(from, to) };
  const auto isOn = [&](int point)
  {
    const auto place = this->Places.find(point);
    return point == edge[0] || point == edge[1] ||
      (place != this->Places.end() && place->second.Edge == edge);
  };
  const auto points = this->OnEdges.find(edge);
  if (points == this->OnEdges.end() || !isOn(from) || !isOn(to))
  {
    return -1;
  }
  const double lower = std::min(this->ShareOf(edge, from), this->ShareOf(edge, to));
  const double upper = std::max(this->ShareOf(edge, from), this->ShareOf(edge, to));
  const auto next = points->second.upper_bound(lower);
  return next != points->second.end() && next->first < upper ? next->second : -1;
}

/// Divides triangles at points that were made on their edges.
void RegionCharter::Split(
  std::vector<std::array<int, 3>>& triangles, std::vector<int>& regions) const
{
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const auto [a, b, c] = Turned(triangles[t], k);
      if (const int middle = this->FirstBetween(a, b); middle >= 0)
      {
        triangles[t] = { a, middle, c };
        triangles.push_back({ middle, b, c });
        regions.push_back(int(regions[t]));
        --t; // there may be more
        break;
      }
    }
  }
}

/// The same on the rim of a chart.
void RegionCharter::Split(GrowingChart& chart) const
{
  for (std::size_t t = 0; t < chart.Triangles.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const auto [a, b, c] = Turned(chart.Triangles[t], k);
      const int from = chart.Ids[At(a)];
      const int to = chart.Ids[At(b)];
      const int point = this->FirstBetween(from, to);
      if (point < 0)
      {
        continue;
      }
      const std::array<int, 2>& edge = this->Places.at(point).Edge;
      const double begin = this->ShareOf(edge, from);
      const double share = (this->ShareOf(edge, point) - begin) / (this->ShareOf(edge, to) - begin);
      const int middle = static_cast<int>(chart.Ids.size());
      chart.Ids.push_back(point);
      chart.UV.emplace_back((1.0 - share) * chart.UV[At(a)] + share * chart.UV[At(b)]);
      chart.Triangles[t] = { a, middle, c };
      chart.Triangles.push_back({ middle, b, c });
      --t;
      break;
    }
  }
}

Result<ChartedRegions> RegionCharter::Assemble()
{
  SurfaceRecognition& regions = this->Made.Recognition;
  regions.Tolerance = this->Recognition.Tolerance;
  regions.Noise = this->Recognition.Noise;
  std::vector<int> newRegion(this->Recognition.Regions.size(), -1);
  for (std::size_t r = 0; r < newRegion.size(); ++r)
  {
    const RecognizedRegion& region = this->Recognition.Regions[r];
    if (region.Surface.Type != SurfaceType::FreeForm)
    {
      newRegion[r] = static_cast<int>(regions.Regions.size());
      this->Made.Origins.push_back(static_cast<int>(r));
      regions.Regions.push_back(region);
      regions.Regions.back().Triangles.clear();
    }
  }
  this->Made.FirstChart = static_cast<int>(regions.Regions.size());
  TriangleMesh mesh;
  for (std::size_t t = 0; t < this->Surface.Triangles.size(); ++t)
  {
    const int region = newRegion[At(this->Recognition.RegionOfTriangle[t])];
    if (region >= 0)
    {
      mesh.Triangles.push_back(this->Surface.Triangles[t]);
      regions.RegionOfTriangle.push_back(region);
    }
  }
  this->Split(mesh.Triangles, regions.RegionOfTriangle);
  for (GrowingChart& chart : this->Charts)
  {
    this->Split(chart);
    const int region = static_cast<int>(regions.Regions.size());
    regions.Regions.emplace_back().Surface.Type = SurfaceType::FreeForm;
    for (const auto& [a, b, c] : chart.Triangles)
    {
      mesh.Triangles.push_back({ chart.Ids[At(a)], chart.Ids[At(b)], chart.Ids[At(c)] });
      regions.RegionOfTriangle.push_back(region);
    }
  }
  mesh.Points.resize(static_cast<Eigen::Index>(this->Points.size()), 3);
  for (std::size_t i = 0; i < this->Points.size(); ++i)
  {
    mesh.Points.row(static_cast<Eigen::Index>(i)) = this->Points[i].transpose();
  }
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    regions.Regions[At(regions.RegionOfTriangle[t])].Triangles.push_back(static_cast<int>(t));
  }
  for (const RecognizedRegion& region : regions.Regions)
  {
    ++regions.NumOfType[static_cast<std::size_t>(region.Surface.Type)];
  }
  auto checked = CheckSurface(mesh);
  if (!checked)
  {
    return checked.Status;
  }
  if (checked->Triangles != mesh.Triangles)
  {
    return { ErrorCode::InvalidTopology, "charts of free form do not fit to what is beside them" };
  }
  this->Made.Surface = std::move(checked.Value);
  for (const GrowingChart& growing : this->Charts)
  {
    ChartMesh& chart = this->Made.Charts.emplace_back();
    const auto count = static_cast<Eigen::Index>(growing.Ids.size());
    chart.Points.resize(count, 3);
    chart.UV.resize(count, 2);
    for (Eigen::Index i = 0; i < count; ++i)
    {
      const auto row = static_cast<std::size_t>(i);
      chart.Points.row(i) = this->Points[At(growing.Ids[row])].transpose();
      chart.UV.row(i) = growing.UV[row].transpose();
    }
    chart.PointIds.assign(growing.Ids.begin(), growing.Ids.end());
    chart.Triangles = growing.Triangles;
  }
  return std::move(this->Made);
}
}

Result<ChartedRegions> ChartFreeRegions(
  const DiscMesh& surface, const SurfaceRecognition& recognition, const FreeRegionParams& params)
{
  RegionCharter charter(surface, recognition);
  if (Status status = charter.Flatten(params); !status)
  {
    return status;
  }
  return charter.Assemble();
}
}
