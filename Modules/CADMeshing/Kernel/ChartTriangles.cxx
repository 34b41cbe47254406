// SPDX-License-Identifier: BSD-3-Clause
#include "ChartTriangles.h"

#include <knotwork/MeshParameterization/PlaneLoops.h>
#include <knotwork/MeshParameterization/PolygonTriangles.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <numeric>
#include <optional>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Joins loops to one polygon by bridges that run there and back.
class LoopBridges
{
public:
  explicit LoopBridges(const PointMatrix& places) : Places(places) {}

  /// @return empty when there is no bridge to some loop.
  std::vector<int> Join(std::vector<std::vector<int>> loops) const
  {
    std::vector<int> polygon = std::move(loops.front());
    loops.erase(loops.begin());
    std::vector<double> distances(loops.size(), std::numeric_limits<double>::infinity());
    std::vector<int> joinedLast = polygon;
    while (!loops.empty())
    {
      std::size_t nearest = 0;
      for (std::size_t l = 0; l < loops.size(); ++l)
      {
        for (const int a : joinedLast)
        {
          for (const int b : loops[l])
          {
            distances[l] = std::min(distances[l], this->Distance(a, b));
          }
        }
        nearest = distances[l] < distances[nearest] ? l : nearest;
      }
      const std::vector<int> hole = std::move(loops[nearest]);
      loops.erase(loops.begin() + static_cast<std::ptrdiff_t>(nearest));
      distances.erase(distances.begin() + static_cast<std::ptrdiff_t>(nearest));
      joinedLast = hole;
      const auto bridge = this->Find(polygon, hole, loops);
      if (!bridge)
      {
        return {};
      }
      const auto [p, q] = *bridge;
      std::vector<int> joined(polygon.begin(), polygon.begin() + p + 1);
      joined.insert(joined.end(), hole.begin() + q, hole.end());
      joined.insert(joined.end(), hole.begin(), hole.begin() + q + 1);
      joined.insert(joined.end(), polygon.begin() + p, polygon.end());
      polygon = std::move(joined);
    }
    return polygon;
  }

private:
  double Distance(int a, int b) const
  {
    return (this->Places.row(a) - this->Places.row(b)).squaredNorm();
  }

  /// Whether a place is in front of a corner, between its sides.
  bool Sees(const std::vector<int>& loop, int i, int target) const
  {
    const auto n = static_cast<int>(loop.size());
    const int a = loop[At((i + n - 1) % n)];
    const int b = loop[At(i)];
    const int c = loop[At((i + 1) % n)];
    const bool afterFirst = Turn(this->Places, a, b, target) > 0;
    const bool beforeNext = Turn(this->Places, b, c, target) > 0;
    return Turn(this->Places, a, b, c) > 0 ? afterFirst && beforeNext : afterFirst || beforeNext;
  }

  bool Meets(const std::vector<int>& loop, int a, int b) const
  {
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      const int c = loop[i];
      const int d = loop[(i + 1) % loop.size()];
      if (c == a || c == b || d == a || d == b)
      {
        continue;
      }
      if (Turn(this->Places, a, b, c) * Turn(this->Places, a, b, d) <= 0 &&
        Turn(this->Places, c, d, a) * Turn(this->Places, c, d, b) <= 0)
      {
        return true;
      }
    }
    return false;
  }

  std::optional<std::pair<int, int>> Find(const std::vector<int>& polygon,
    const std::vector<int>& hole, const std::vector<std::vector<int>>& others) const
  {
    struct Bridge
    {
      double Length;
      int Outer;
      int Inner;
    };
    std::vector<Bridge> bridges;
    for (int p = 0; p < static_cast<int>(polygon.size()); ++p)
    {
      for (int q = 0; q < static_cast<int>(hole.size()); ++q)
      {
        bridges.push_back({ this->Distance(polygon[At(p)], hole[At(q)]), p, q });
      }
    }
    std::sort(bridges.begin(), bridges.end(),
      [](const Bridge& a, const Bridge& b)
      { return std::tie(a.Length, a.Outer, a.Inner) < std::tie(b.Length, b.Outer, b.Inner); });
    for (const Bridge& bridge : bridges)
    {
      const int a = polygon[At(bridge.Outer)];
      const int b = hole[At(bridge.Inner)];
      if (this->Sees(polygon, bridge.Outer, b) && this->Sees(hole, bridge.Inner, a) &&
        !this->Meets(polygon, a, b) && !this->Meets(hole, a, b) &&
        std::none_of(others.begin(), others.end(),
          [&](const std::vector<int>& other) { return this->Meets(other, a, b); }))
      {
        return std::make_pair(bridge.Outer, bridge.Inner);
      }
    }
    return std::nullopt;
  }

  const PointMatrix& Places;
};

/// Triangles in the chart that are flipped, divided and moved.
class Refinement
{
public:
  Refinement(const FaceChart& chart, const ChartSizes& sizes) : Chart(chart), Limits(sizes) {}

  Status Begin(const std::vector<ChartLoop>& loops);
  Status Refine(int maxTriangles);
  ChartTriangles Take();

private:
  using Corners = std::array<int, 3>;

  int Turned(int a, int b, int c) const { return Turn(this->Places, a, b, c); }
  Eigen::Vector2d PlaceOf(int i) const { return this->Places.row(i).transpose(); }
  int AddPoint(const Eigen::Vector2d& place, double size, bool fixed);
  double LengthOf(int a, int b);
  void Connect();
  bool IsSide(int t, int i) const { return this->Beside[At(t)][At(i)] < 0; }
  /// Corner of the neighbour across corner i that lies opposite.
  int Mirror(int t, int i) const
  {
    const int other = this->Beside[At(t)][At(i)];
    for (int k = 0; k < 3; ++k)
    {
      if (this->Beside[At(other)][At(k)] == t &&
        this->Triangles[At(other)][At((k + 1) % 3)] == this->Triangles[At(t)][At((i + 2) % 3)])
      {
        return k;
      }
    }
    return 0;
  }
  bool CanFlip(int t, int i) const;
  void Flip(int t, int i);
  void Replace(int triangle, int before, int after)
  {
    if (triangle >= 0)
    {
      auto& beside = this->Beside[At(triangle)];
      *std::find(beside.begin(), beside.end(), before) = after;
    }
  }
  void Divide(int t, int i, int point);
  bool MendFlat();
  double AngleAt(int t, int i);
  void FlipAll();
  int DivideLong(int maxTriangles);
  void Smooth();
  double SizeAt(const Eigen::Vector2d& place, double size) const;

  const FaceChart& Chart;
  ChartSizes Limits;
  PointMatrix Places;
  std::vector<Eigen::Vector3d> Points;
  std::vector<double> Sizes;
  std::vector<bool> Fixed;
  std::vector<Corners> Triangles;
  std::vector<Corners> Beside; ///< triangle opposite of each corner, -1: none
  std::map<std::pair<int, int>, double> Lengths;
};

int Refinement::AddPoint(const Eigen::Vector2d& place, double size, bool fixed)
{
  const auto id = static_cast<int>(this->Sizes.size());
  if (id >= this->Places.rows())
  {
    this->Places.conservativeResize(std::max<Eigen::Index>(64, 2 * this->Places.rows()), 2);
  }
  this->Places.row(id) = place.transpose();
  this->Points.push_back(this->Chart.Point(place));
  this->Sizes.push_back(size);
  this->Fixed.push_back(fixed);
  return id;
}

double Refinement::LengthOf(int a, int b)
{
  if (this->Chart.IsPlane())
  {
    return (this->Points[At(a)] - this->Points[At(b)]).norm();
  }
  const auto key = std::minmax(a, b);
  const auto [known, isNew] = this->Lengths.try_emplace(key, 0.0);
  if (isNew)
  {
    known->second = this->Chart.Length(this->PlaceOf(key.first), this->PlaceOf(key.second));
  }
  return known->second;
}

double Refinement::SizeAt(const Eigen::Vector2d& place, double size) const
{
  // towards the tip of a cone curvature grows without end
  constexpr double Share = 0.25;
  size = std::min(size, this->Limits.Largest);
  const double curvature = this->Chart.IsPlane() ? 0.0 : this->Chart.Curvature(place);
  const double limit = std::max(
    curvature > 0.0 ? this->Limits.Curvature / curvature : size, Share * this->Limits.Largest);
  return std::min(size, limit);
}

void Refinement::Connect()
{
  this->Beside.assign(this->Triangles.size(), { -1, -1, -1 });
  std::map<std::pair<int, int>, std::pair<int, int>> open;
  for (int t = 0; t < static_cast<int>(this->Triangles.size()); ++t)
  {
    for (int i = 0; i < 3; ++i)
    {
      const int a = this->Triangles[At(t)][At((i + 1) % 3)];
      const int b = this->Triangles[At(t)][At((i + 2) % 3)];
      const auto other = open.find({ b, a });
      if (other == open.end())
      {
        open[{ a, b }] = { t, i };
        continue;
      }
      this->Beside[At(t)][At(i)] = other->second.first;
      this->Beside[At(other->second.first)][At(other->second.second)] = t;
    }
  }
}

bool Refinement::CanFlip(int t, int i) const
{
  if (this->IsSide(t, i))
  {
    return false;
  }
  const Corners& own = this->Triangles[At(t)];
  const int other = this->Beside[At(t)][At(i)];
  const int opposite = this->Triangles[At(other)][At(this->Mirror(t, i))];
  const int apex = own[At(i)];
  return this->Turned(apex, own[At((i + 1) % 3)], opposite) > 0 &&
    this->Turned(apex, opposite, own[At((i + 2) % 3)]) > 0;
}

void Refinement::Flip(int t, int i)
{
  const int other = this->Beside[At(t)][At(i)];
  const int k = this->Mirror(t, i);
  const int apex = this->Triangles[At(t)][At(i)];
  const int a = this->Triangles[At(t)][At((i + 1) % 3)];
  const int b = this->Triangles[At(t)][At((i + 2) % 3)];
  const int opposite = this->Triangles[At(other)][At(k)];
  const int besideB = this->Beside[At(t)][At((i + 1) % 3)]; // across b, apex
  const int besideA = this->Beside[At(t)][At((i + 2) % 3)]; // across apex, a
  // the neighbour's corners: opposite, b, a
  const int otherB = this->Beside[At(other)][At((k + 2) % 3)]; // across opposite, b
  const int otherA = this->Beside[At(other)][At((k + 1) % 3)]; // across a, opposite
  this->Triangles[At(t)] = { apex, a, opposite };
  this->Beside[At(t)] = { otherA, other, besideA };
  this->Triangles[At(other)] = { apex, opposite, b };
  this->Beside[At(other)] = { otherB, besideB, t };
  this->Replace(otherA, other, t);
  this->Replace(besideB, t, other);
}

/// A point on the edge opposite of a corner.
void Refinement::Divide(int t, int i, int point)
{
  const int other = this->Beside[At(t)][At(i)];
  const int k = this->Mirror(t, i);
  const int apex = this->Triangles[At(t)][At(i)];
  const int a = this->Triangles[At(t)][At((i + 1) % 3)];
  const int b = this->Triangles[At(t)][At((i + 2) % 3)];
  const int opposite = this->Triangles[At(other)][At(k)];
  const int besideB = this->Beside[At(t)][At((i + 1) % 3)];
  const int besideA = this->Beside[At(t)][At((i + 2) % 3)];
  const int otherB = this->Beside[At(other)][At((k + 2) % 3)];
  const int otherA = this->Beside[At(other)][At((k + 1) % 3)];
  const auto first = static_cast<int>(this->Triangles.size());
  const int second = first + 1;
  this->Triangles[At(t)] = { apex, a, point };
  this->Beside[At(t)] = { second, first, besideA };
  this->Triangles.push_back({ apex, point, b });
  this->Beside.push_back({ other, besideB, t });
  this->Triangles[At(other)] = { opposite, b, point };
  this->Beside[At(other)] = { first, second, otherB };
  this->Triangles.push_back({ opposite, point, a });
  this->Beside.push_back({ t, otherA, other });
  this->Replace(besideB, t, first);
  this->Replace(otherA, other, second);
}

/// Polygons are divided for rounded coordinates: straight sides may have flat triangles.
bool Refinement::MendFlat()
{
  for (std::size_t pass = 0; pass < this->Triangles.size() + 1; ++pass)
  {
    bool flat = false;
    bool flipped = false;
    for (int t = 0; t < static_cast<int>(this->Triangles.size()); ++t)
    {
      const Corners corners = this->Triangles[At(t)];
      if (this->Turned(corners[0], corners[1], corners[2]) > 0)
      {
        continue;
      }
      flat = true;
      for (int i = 0; i < 3 && !flipped; ++i)
      {
        if (this->CanFlip(t, i))
        {
          this->Flip(t, i);
          flipped = true;
        }
      }
    }
    if (!flat || !flipped)
    {
      return !flat;
    }
  }
  return false;
}

Status Refinement::Begin(const std::vector<ChartLoop>& loops)
{
  const Status crossing{ ErrorCode::InvalidTopology, "the loops cross in the parameters" };
  std::vector<std::vector<int>> ids;
  for (const ChartLoop& loop : loops)
  {
    ids.emplace_back();
    for (const LoopPoint& point : loop)
    {
      ids.back().push_back(this->AddPoint(point.Place, 0.0, true));
    }
    const std::size_t n = ids.back().size();
    for (std::size_t i = 0; i < n; ++i)
    {
      const auto length = [&](std::size_t a)
      { return this->LengthOf(ids.back()[a % n], ids.back()[(a + 1) % n]); };
      const double before = length(i + n - 1);
      const double after = length(i);
      // at poles one of the sides is a point
      const double size = loop[i].BeginsPole ? before
        : loop[(i + n - 1) % n].BeginsPole   ? after
                                             : 0.5 * (before + after);
      this->Sizes[At(ids.back()[i])] = size;
    }
  }
  const std::vector<int> polygon = LoopBridges(this->Places).Join(ids);
  PointMatrix corners = PointMatrix::Zero(static_cast<Eigen::Index>(polygon.size()), 3);
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    corners.row(static_cast<Eigen::Index>(i)).head(2) = this->Places.row(polygon[i]);
  }
  for (const auto& triangle : DividePolygon(corners))
  {
    this->Triangles.push_back(
      { polygon[At(triangle[0])], polygon[At(triangle[1])], polygon[At(triangle[2])] });
  }
  this->Connect();
  return this->Triangles.empty() || !this->MendFlat() ? crossing : Status();
}

/// By the lengths of the sides on the surface.
double Refinement::AngleAt(int t, int i)
{
  const Corners& corners = this->Triangles[At(t)];
  const double opposite = this->LengthOf(corners[At((i + 1) % 3)], corners[At((i + 2) % 3)]);
  const double a = this->LengthOf(corners[At(i)], corners[At((i + 1) % 3)]);
  const double b = this->LengthOf(corners[At(i)], corners[At((i + 2) % 3)]);
  if (!(a > 0.0 && b > 0.0))
  {
    return 0.5 * 3.14159265358979323846;
  }
  return std::acos(std::clamp((a * a + b * b - opposite * opposite) / (2.0 * a * b), -1.0, 1.0));
}

void Refinement::FlipAll()
{
  constexpr double Straight = 3.14159265358979323846 + 1e-9;
  std::deque<int> queue(this->Triangles.size());
  std::iota(queue.begin(), queue.end(), 0);
  for (std::size_t left = 20 * this->Triangles.size(); !queue.empty() && left > 0; --left)
  {
    const int t = queue.front();
    queue.pop_front();
    for (int i = 0; i < 3; ++i)
    {
      if (!this->CanFlip(t, i))
      {
        continue;
      }
      const int other = this->Beside[At(t)][At(i)];
      if (this->AngleAt(t, i) + this->AngleAt(other, this->Mirror(t, i)) > Straight)
      {
        this->Flip(t, i);
        queue.push_back(t);
        queue.push_back(other);
        break;
      }
    }
  }
}

/// @return how many edges were divided.
int Refinement::DivideLong(int maxTriangles)
{
  constexpr double Long = 1.4;
  struct Edge
  {
    double Excess;
    int Triangle;
    int Corner;
  };
  std::vector<Edge> edges;
  for (int t = 0; t < static_cast<int>(this->Triangles.size()); ++t)
  {
    for (int i = 0; i < 3; ++i)
    {
      if (this->IsSide(t, i) || this->Beside[At(t)][At(i)] < t)
      {
        continue;
      }
      const int a = this->Triangles[At(t)][At((i + 1) % 3)];
      const int b = this->Triangles[At(t)][At((i + 2) % 3)];
      const double size = this->SizeAt(0.5 * (this->PlaceOf(a) + this->PlaceOf(b)),
        0.5 * (this->Sizes[At(a)] + this->Sizes[At(b)]));
      const double excess = this->LengthOf(a, b) / size;
      if (excess > Long)
      {
        edges.push_back({ excess, t, i });
      }
    }
  }
  std::sort(edges.begin(), edges.end(),
    [](const Edge& a, const Edge& b)
    { return a.Excess != b.Excess ? a.Excess > b.Excess : a.Triangle < b.Triangle; });
  std::vector<bool> touched(this->Triangles.size(), false);
  int count = 0;
  for (const Edge& edge : edges)
  {
    const int other = this->Beside[At(edge.Triangle)][At(edge.Corner)];
    if (touched[At(edge.Triangle)] || other >= static_cast<int>(touched.size()) ||
      touched[At(other)] || static_cast<int>(this->Triangles.size()) + 2 > maxTriangles)
    {
      continue;
    }
    const Corners& own = this->Triangles[At(edge.Triangle)];
    const int a = own[At((edge.Corner + 1) % 3)];
    const int b = own[At((edge.Corner + 2) % 3)];
    const Eigen::Vector2d middle = 0.5 * (this->PlaceOf(a) + this->PlaceOf(b));
    const int point = this->AddPoint(
      middle, this->SizeAt(middle, 0.5 * (this->Sizes[At(a)] + this->Sizes[At(b)])), false);
    const int opposite = this->Triangles[At(other)][At(this->Mirror(edge.Triangle, edge.Corner))];
    const int apex = own[At(edge.Corner)];
    if (this->Turned(apex, a, point) <= 0 || this->Turned(apex, point, b) <= 0 ||
      this->Turned(opposite, b, point) <= 0 || this->Turned(opposite, point, a) <= 0)
    {
      // rounding: the triangles are too thin
      this->Points.pop_back();
      this->Sizes.pop_back();
      this->Fixed.pop_back();
      continue;
    }
    touched[At(edge.Triangle)] = true;
    touched[At(other)] = true;
    this->Divide(edge.Triangle, edge.Corner, point);
    ++count;
  }
  return count;
}

/// Inner points to the middle of their neighbours, where no triangle turns over.
void Refinement::Smooth()
{
  const auto n = this->Sizes.size();
  std::vector<std::vector<int>> around(n);
  for (int t = 0; t < static_cast<int>(this->Triangles.size()); ++t)
  {
    for (const int corner : this->Triangles[At(t)])
    {
      around[At(corner)].push_back(t);
    }
  }
  const auto quality = [&](int t)
  {
    const Corners& c = this->Triangles[At(t)];
    const Eigen::Vector3d a = this->Points[At(c[1])] - this->Points[At(c[0])];
    const Eigen::Vector3d b = this->Points[At(c[2])] - this->Points[At(c[0])];
    const double sum = a.squaredNorm() + b.squaredNorm() + (a - b).squaredNorm();
    return sum > 0.0 ? 2.0 * std::sqrt(3.0) * a.cross(b).norm() / sum : 0.0;
  };
  constexpr double Good = 0.5;
  for (int p = 0; p < static_cast<int>(n); ++p)
  {
    if (this->Fixed[At(p)])
    {
      continue;
    }
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    double before = 1.0;
    for (const int t : around[At(p)])
    {
      for (const int corner : this->Triangles[At(t)])
      {
        middle += corner == p ? Eigen::Vector3d::Zero() : this->Points[At(corner)];
      }
      before = std::min(before, quality(t));
    }
    middle /= 2.0 * static_cast<double>(around[At(p)].size());
    const Eigen::Vector2d oldPlace = this->PlaceOf(p);
    const Eigen::Vector3d oldPoint = this->Points[At(p)];
    Eigen::Vector2d place = oldPlace;
    this->Points[At(p)] = this->Chart.Project(middle, place);
    this->Places.row(p) = place.transpose();
    bool kept = true;
    for (const int t : around[At(p)])
    {
      const Corners& c = this->Triangles[At(t)];
      kept = kept && this->Turned(c[0], c[1], c[2]) > 0 && quality(t) >= std::min(before, Good);
    }
    if (!kept)
    {
      this->Points[At(p)] = oldPoint;
      this->Places.row(p) = oldPlace.transpose();
    }
  }
  this->Lengths.clear();
}

Status Refinement::Refine(int maxTriangles)
{
  constexpr int MaxPasses = 40;
  constexpr int LastPasses = 5;
  this->FlipAll();
  for (int pass = 0; pass < MaxPasses; ++pass)
  {
    const int divided = this->DivideLong(maxTriangles);
    if (static_cast<int>(this->Triangles.size()) + 2 > maxTriangles)
    {
      return { ErrorCode::TooLarge, "more than " + std::to_string(maxTriangles) + " triangles" };
    }
    if (divided == 0)
    {
      break;
    }
    this->FlipAll();
    this->Smooth();
    this->FlipAll();
  }
  for (int pass = 0; pass < LastPasses; ++pass)
  {
    this->Smooth();
    this->FlipAll();
  }
  return {};
}

ChartTriangles Refinement::Take()
{
  this->Places.conservativeResize(static_cast<Eigen::Index>(this->Sizes.size()), 2);
  return { std::move(this->Places), std::move(this->Triangles) };
}
}

Result<ChartTriangles> TriangulateChart(const FaceChart& chart, const std::vector<ChartLoop>& loops,
  const ChartSizes& sizes, int maxTriangles)
{
  Refinement refinement(chart, sizes);
  if (Status begun = refinement.Begin(loops); !begun)
  {
    return begun;
  }
  if (Status refined = refinement.Refine(maxTriangles); !refined)
  {
    return refined;
  }
  return refinement.Take();
}
}
