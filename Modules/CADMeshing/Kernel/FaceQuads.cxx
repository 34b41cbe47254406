// SPDX-License-Identifier: BSD-3-Clause
#include "FaceQuads.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

namespace knotwork
{
int FaceQuads::AddPoint(const Eigen::Vector2d& place, const Eigen::Vector3d& point, int node)
{
  this->Places.push_back(place);
  this->Points.push_back(point);
  this->Nodes.push_back(node);
  return static_cast<int>(this->Points.size()) - 1;
}

namespace
{
constexpr double Pi = 3.14159265358979323846;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Triangles between every other point of a face's loops that become quadrilaterals.
class Halving
{
public:
  Halving(const FaceChart& chart, const std::vector<ChartLoop>& loops);

  const std::vector<ChartLoop>& Corners() const { return this->HalfLoops; }
  FaceQuads Make(const ChartTriangles& triangles);

private:
  using Side = std::pair<int, int>;

  void CollapsePoles(std::vector<std::array<int, 3>>& triangles);
  void OpenEars(std::vector<std::array<int, 3>>& triangles) const;
  std::vector<std::vector<int>> Join(const std::vector<std::array<int, 3>>& triangles) const;
  int AddMiddle(const std::vector<int>& corners);
  int MiddleOf(int a, int b);
  Eigen::Vector3d DirectionOf(int corner, int to) const;
  Eigen::Vector3d TangentOf(int corner, int to) const;
  template <std::size_t N>
  bool IsStraight(const std::array<int, N>& corners, std::size_t at) const;
  template <std::size_t N>
  double Quality(const std::array<int, N>& corners) const;

  const FaceChart& Chart;
  std::vector<ChartLoop> HalfLoops;
  std::map<Side, LoopPoint> LoopMiddles; ///< by ids of corners
  std::set<Side> Poles;                  ///< sides that are a point
  std::map<int, int> PoleDirections;     ///< of their ends: the parameter that the pole runs in
  FaceQuads Mesh;
  std::vector<Eigen::Vector3d> Normals;
  std::map<Side, int> Middles; ///< points
  std::map<Side, Side> Same;   ///< sides that are one where a triangle at a pole went
};

Halving::Halving(const FaceChart& chart, const std::vector<ChartLoop>& loops) : Chart(chart)
{
  int first = 0;
  for (const ChartLoop& loop : loops)
  {
    ChartLoop half;
    std::vector<LoopPoint> between; ///< behind each point of half
    std::size_t i = 0;
    while (i < loop.size())
    {
      half.push_back(loop[i]);
      between.push_back(loop[std::min(i + 1, loop.size() - 1)]);
      i += loop[i].BeginsPole ? 1 : 2;
    }
    const auto n = static_cast<int>(half.size());
    for (int k = 0; k < n; ++k)
    {
      const Side side{ first + k, first + (k + 1) % n };
      if (!half[At(k)].BeginsPole)
      {
        this->LoopMiddles[std::minmax(side.first, side.second)] = between[At(k)];
        continue;
      }
      const Eigen::Vector2d way = (half[At((k + 1) % n)].Place - half[At(k)].Place).cwiseAbs();
      const int direction = way[0] > way[1] ? 0 : 1;
      this->Poles.insert(side);
      this->PoleDirections[side.first] = direction;
      this->PoleDirections[side.second] = direction;
    }
    first += n;
    this->HalfLoops.push_back(std::move(half));
  }
}

/// The point in the middle of corners, on the surface.
int Halving::AddMiddle(const std::vector<int>& corners)
{
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  Eigen::Vector2d weights = Eigen::Vector2d::Zero();
  for (const int corner : corners)
  {
    point += this->Mesh.Points[At(corner)] / static_cast<double>(corners.size());
    Eigen::Vector2d weight = Eigen::Vector2d::Ones();
    // one of the parameters says nothing at a pole
    if (const auto pole = this->PoleDirections.find(corner); pole != this->PoleDirections.end())
    {
      weight[pole->second] = 1e-9;
    }
    place += weight.cwiseProduct(this->Mesh.Places[At(corner)]);
    weights += weight;
  }
  place = place.cwiseQuotient(weights);
  const Eigen::Vector3d found = this->Chart.Project(point, place);
  return this->Mesh.AddPoint(place, found, -1);
}

int Halving::MiddleOf(int a, int b)
{
  Side side = std::minmax(a, b);
  for (auto same = this->Same.find(side); same != this->Same.end(); same = this->Same.find(side))
  {
    side = same->second;
  }
  const auto known = this->Middles.find(side);
  if (known != this->Middles.end())
  {
    return known->second;
  }
  const auto given = this->LoopMiddles.find(side);
  const int middle = given == this->LoopMiddles.end()
    ? this->AddMiddle({ side.first, side.second })
    : this->Mesh.AddPoint(
        given->second.Place, this->Chart.Point(given->second.Place), given->second.Node);
  this->Middles[side] = middle;
  return middle;
}

/// A triangle along a side that is a point in space has two sides that are one.
void Halving::CollapsePoles(std::vector<std::array<int, 3>>& triangles)
{
  std::vector<std::array<int, 3>> left;
  for (const auto& triangle : triangles)
  {
    bool collapsed = false;
    for (int i = 0; i < 3 && !collapsed; ++i)
    {
      const int a = triangle[At(i)];
      const int b = triangle[At((i + 1) % 3)];
      const int apex = triangle[At((i + 2) % 3)];
      if (this->Poles.count({ a, b }) == 0)
      {
        continue;
      }
      collapsed = true;
      Side first = std::minmax(a, apex);
      Side second = std::minmax(b, apex);
      if (this->LoopMiddles.count(second) > 0)
      {
        std::swap(first, second);
      }
      this->Same[second] = first;
    }
    if (!collapsed)
    {
      left.push_back(triangle);
    }
  }
  triangles = std::move(left);
}

/// Of the side from one corner to another, towards the point between.
Eigen::Vector3d Halving::DirectionOf(int corner, int to) const
{
  const auto given = this->LoopMiddles.find(std::minmax(corner, to));
  const Eigen::Vector3d there = given == this->LoopMiddles.end()
    ? this->Mesh.Points[At(to)]
    : this->Chart.Point(given->second.Place);
  return there - this->Mesh.Points[At(corner)];
}

/// Of a loop at a corner, as of the parabola through the point between.
Eigen::Vector3d Halving::TangentOf(int corner, int to) const
{
  return 4.0 * this->DirectionOf(corner, to) -
    (this->Mesh.Points[At(to)] - this->Mesh.Points[At(corner)]);
}

/// Whether a loop goes on nearly straight between the sides before and behind a corner: one
/// quadrilateral with both has no regular map there.
template <std::size_t N>
bool Halving::IsStraight(const std::array<int, N>& corners, std::size_t at) const
{
  constexpr double Straight = 0.35; ///< sine of the angle inside, an obtuse one
  const int here = corners[at];
  const int next = corners[(at + 1) % N];
  const int before = corners[(at + N - 1) % N];
  if (this->LoopMiddles.count(std::minmax(here, next)) == 0 ||
    this->LoopMiddles.count(std::minmax(here, before)) == 0)
  {
    return false;
  }
  const Eigen::Vector3d forward = this->TangentOf(here, next);
  const Eigen::Vector3d backward = this->TangentOf(here, before);
  return forward.dot(backward) < 0.0 &&
    forward.cross(backward).dot(this->Normals[At(here)]) <
    Straight * forward.norm() * backward.norm();
}

/// Scaled Jacobian of the corners, with sides towards their middles, where loops bend.
template <std::size_t N>
double Halving::Quality(const std::array<int, N>& corners) const
{
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (const int corner : corners)
  {
    normal += this->Normals[At(corner)];
  }
  normal.normalize();
  double least = 1.0;
  for (std::size_t i = 0; i < N; ++i)
  {
    const Eigen::Vector3d next = this->DirectionOf(corners[i], corners[(i + 1) % N]);
    const Eigen::Vector3d before = this->DirectionOf(corners[i], corners[(i + N - 1) % N]);
    const double lengths = next.norm() * before.norm();
    least = std::min(least, lengths > 0.0 ? next.cross(before).dot(normal) / lengths : -1.0);
  }
  return least;
}

/// A triangle with two sides on a loop that goes on nearly straight between them gets a side from
/// there into the face.
void Halving::OpenEars(std::vector<std::array<int, 3>>& triangles) const
{
  std::map<Side, std::pair<int, int>> across; ///< triangle and its corner opposite of a side
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
  {
    for (std::size_t i = 0; i < 3; ++i)
    {
      const auto& corners = triangles[At(t)];
      across[{ corners[i], corners[(i + 1) % 3] }] = { t, corners[(i + 2) % 3] };
    }
  }
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
  {
    for (std::size_t i = 0; i < 3; ++i)
    {
      const std::array<int, 3> ear = triangles[At(t)];
      const int tip = ear[i];
      const int next = ear[(i + 1) % 3];
      const int before = ear[(i + 2) % 3];
      if (!this->IsStraight(ear, i))
      {
        continue;
      }
      const auto other = across.find({ before, next });
      if (other == across.end())
      {
        continue;
      }
      const auto [beside, apex] = other->second;
      const std::array<int, 3> first{ tip, next, apex };
      const std::array<int, 3> second{ tip, apex, before };
      if (std::min(this->Quality(first), this->Quality(second)) <= 0.0)
      {
        continue;
      }
      triangles[At(t)] = first;
      triangles[At(beside)] = second;
      across.erase({ before, next });
      across.erase({ next, before });
      for (const auto& [triangle, corners] : { std::pair(t, first), std::pair(beside, second) })
      {
        for (std::size_t k = 0; k < 3; ++k)
        {
          across[{ corners[k], corners[(k + 1) % 3] }] = { triangle, corners[(k + 2) % 3] };
        }
      }
      break;
    }
  }
}

/// The best pairs first, those before them whose triangles are bad by themselves.
std::vector<std::vector<int>> Halving::Join(const std::vector<std::array<int, 3>>& triangles) const
{
  constexpr double Least = 0.35; ///< scaled Jacobian; worse ones stay triangles that are better
  constexpr double Good = 0.5;
  struct Pair
  {
    double Gain;
    std::array<int, 2> Triangles;
    std::array<int, 4> Corners;
  };
  std::map<Side, std::pair<int, int>> open;
  std::vector<Pair> pairs;
  std::vector<double> alone;
  for (const auto& triangle : triangles)
  {
    alone.push_back(this->Quality(triangle));
  }
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
  {
    for (int i = 0; i < 3; ++i)
    {
      const int a = triangles[At(t)][At(i)];
      const int b = triangles[At(t)][At((i + 1) % 3)];
      const int apex = triangles[At(t)][At((i + 2) % 3)];
      const auto other = open.find({ b, a });
      if (other == open.end())
      {
        open[{ a, b }] = { t, apex };
        continue;
      }
      const std::array<int, 4> corners{ a, other->second.second, b, apex };
      const bool isStraight = this->IsStraight(corners, 0) || this->IsStraight(corners, 1) ||
        this->IsStraight(corners, 2) || this->IsStraight(corners, 3);
      const double quality = isStraight ? 0.0 : this->Quality(corners);
      const double apart = std::min(alone[At(t)], alone[At(other->second.first)]);
      if (quality > std::min(Least, apart))
      {
        pairs.push_back(
          { quality + 2.0 * (Good - std::min(Good, apart)), { other->second.first, t }, corners });
      }
    }
  }
  std::sort(pairs.begin(), pairs.end(),
    [](const Pair& a, const Pair& b)
    { return a.Gain != b.Gain ? a.Gain > b.Gain : a.Triangles < b.Triangles; });
  std::vector<bool> taken(triangles.size(), false);
  std::vector<std::vector<int>> cells;
  for (const Pair& pair : pairs)
  {
    if (!taken[At(pair.Triangles[0])] && !taken[At(pair.Triangles[1])])
    {
      taken[At(pair.Triangles[0])] = true;
      taken[At(pair.Triangles[1])] = true;
      cells.emplace_back(pair.Corners.begin(), pair.Corners.end());
    }
  }
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    if (!taken[t])
    {
      cells.emplace_back(triangles[t].begin(), triangles[t].end());
    }
  }
  return cells;
}

FaceQuads Halving::Make(const ChartTriangles& given)
{
  std::vector<const LoopPoint*> loopPoints;
  for (const ChartLoop& loop : this->HalfLoops)
  {
    for (const LoopPoint& point : loop)
    {
      loopPoints.push_back(&point);
    }
  }
  for (Eigen::Index i = 0; i < given.Places.rows(); ++i)
  {
    const Eigen::Vector2d place = given.Places.row(i).transpose();
    const auto at = static_cast<std::size_t>(i);
    this->Mesh.AddPoint(
      place, this->Chart.Point(place), at < loopPoints.size() ? loopPoints[at]->Node : -1);
    this->Normals.push_back(this->Chart.Normal(place));
  }
  std::vector<std::array<int, 3>> triangles = given.Triangles;
  this->CollapsePoles(triangles);
  this->OpenEars(triangles);
  for (const std::vector<int>& cell : this->Join(triangles))
  {
    const int center = this->AddMiddle(cell);
    const std::size_t n = cell.size();
    for (std::size_t i = 0; i < n; ++i)
    {
      this->Mesh.Quads.push_back({ cell[i], this->MiddleOf(cell[i], cell[(i + 1) % n]), center,
        this->MiddleOf(cell[i], cell[(i + n - 1) % n]) });
    }
  }
  return std::move(this->Mesh);
}

/// Where another loop passes a loop's point: the same vertex at the same place, but for rounding.
std::optional<std::pair<std::size_t, std::size_t>> FindTouch(
  const ChartLoop& loop, const ChartLoop& other)
{
  Eigen::AlignedBox2d box;
  for (const LoopPoint& point : loop)
  {
    box.extend(point.Place);
  }
  const double near = 1e-9 * box.diagonal().norm();
  for (std::size_t a = 0; a < loop.size(); ++a)
  {
    for (std::size_t b = 0; b < other.size() && loop[a].IsCorner; ++b)
    {
      if (other[b].IsCorner && other[b].Node == loop[a].Node &&
        (other[b].Place - loop[a].Place).norm() <= near)
      {
        return std::pair(a, b);
      }
    }
  }
  return std::nullopt;
}

/// Loops that touch in vertices are one that passes these twice: the face ends there on both sides.
std::vector<ChartLoop> JoinTouching(std::vector<ChartLoop> loops)
{
  std::vector<ChartLoop> joined;
  while (!loops.empty())
  {
    ChartLoop loop = std::move(loops.front());
    loops.erase(loops.begin());
    for (std::size_t l = 0; l < loops.size();)
    {
      const auto touch = FindTouch(loop, loops[l]);
      if (!touch)
      {
        ++l;
        continue;
      }
      ChartLoop other = std::move(loops[l]);
      loops.erase(loops.begin() + static_cast<std::ptrdiff_t>(l));
      std::rotate(
        other.begin(), other.begin() + static_cast<std::ptrdiff_t>(touch->second), other.end());
      other.front().Place = loop[touch->first].Place;
      // along this loop to the vertex, around the other one, and on from the vertex
      loop.insert(
        loop.begin() + static_cast<std::ptrdiff_t>(touch->first), other.begin(), other.end());
      l = 0; // what touches the other one
    }
    joined.push_back(std::move(loop));
  }
  return joined;
}
}

Result<FaceQuads> PaveFace(const FaceChart& chart, const std::vector<ChartLoop>& loops,
  const ChartSizes& sizes, int maxTriangles)
{
  Halving halving(chart, JoinTouching(loops));
  const auto triangles = TriangulateChart(chart, halving.Corners(), sizes, maxTriangles);
  if (!triangles)
  {
    return triangles.Status;
  }
  return halving.Make(triangles.Value);
}

std::vector<Eigen::Vector3d> NormalsOf(const FaceChart& chart, const FaceQuads& mesh)
{
  std::vector<Eigen::Vector3d> normals;
  for (const Eigen::Vector2d& place : mesh.Places)
  {
    normals.push_back(chart.Normal(place));
  }
  return normals;
}

namespace
{
/// Smallest sine of the angle at a corner, signed, times what sides there count whose lengths
/// differ by more than a ratio.
double LeastCorner(
  const FaceQuads& mesh, const std::vector<Eigen::Vector3d>& normals, int quad, double ratio)
{
  const auto& corners = mesh.Quads[At(quad)];
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (const int corner : corners)
  {
    normal += normals[At(corner)];
  }
  if (normal.norm() < 1e-3)
  {
    normal = (mesh.Points[At(corners[2])] - mesh.Points[At(corners[0])])
               .cross(mesh.Points[At(corners[3])] - mesh.Points[At(corners[1])]);
  }
  normal.normalize();
  double least = 1.0;
  for (std::size_t i = 0; i < 4; ++i)
  {
    const Eigen::Vector3d& here = mesh.Points[At(corners[i])];
    const Eigen::Vector3d next = mesh.Points[At(corners[(i + 1) % 4])] - here;
    const Eigen::Vector3d before = mesh.Points[At(corners[(i + 3) % 4])] - here;
    const double longer = std::max(next.norm(), before.norm());
    const double shorter = std::min(next.norm(), before.norm());
    const double sine = shorter > 0.0 ? next.cross(before).dot(normal) / (longer * shorter) : -1.0;
    least = std::min(least, sine > 0.0 ? sine * std::min(1.0, ratio * shorter / longer) : sine);
  }
  return least;
}
}

double ScaledJacobian(const FaceQuads& mesh, const std::vector<Eigen::Vector3d>& normals, int quad)
{
  return LeastCorner(mesh, normals, quad, std::numeric_limits<double>::infinity());
}

namespace
{
/// Moves inner points of quadrilaterals.
class QuadSmoothing
{
public:
  QuadSmoothing(const FaceChart& chart, FaceQuads& mesh)
    : Chart(chart), Mesh(mesh), Normals(NormalsOf(chart, mesh)), Around(mesh.Points.size()),
      Neighbours(mesh.Points.size())
  {
    for (std::size_t q = 0; q < mesh.Quads.size(); ++q)
    {
      for (std::size_t i = 0; i < 4; ++i)
      {
        const int corner = mesh.Quads[q][i];
        this->Around[At(corner)].push_back(static_cast<int>(q));
        this->Neighbours[At(corner)].push_back(mesh.Quads[q][(i + 1) % 4]);
        this->Neighbours[At(corner)].push_back(mesh.Quads[q][(i + 3) % 4]);
      }
    }
  }

  double Run()
  {
    double least = this->ImproveBoth();
    if (least <= 0.0)
    {
      const FaceQuads folded = this->Mesh;
      this->Relax();
      const double relaxed = this->ImproveBoth();
      if (relaxed <= least)
      {
        this->Mesh = folded;
      }
      least = std::max(least, relaxed);
    }
    return least;
  }

private:
  /// Angles alone, or lengths and angles first, where that leaves no worse angles that matter.
  double ImproveBoth()
  {
    constexpr double Good = 0.7; ///< scaled Jacobian
    const FaceQuads given = this->Mesh;
    const std::vector<Eigen::Vector3d> normals = this->Normals;
    const double plain = this->Improve();
    const FaceQuads angles = this->Mesh;
    const std::vector<Eigen::Vector3d> normalsOfAngles = this->Normals;
    this->Mesh = given;
    this->Normals = normals;
    this->Ratio = 3.0;
    this->Improve();
    this->Ratio = Any;
    const double least = this->Improve();
    if (least < std::min(plain, Good))
    {
      this->Mesh = angles;
      this->Normals = normalsOfAngles;
      return plain;
    }
    return least;
  }

  double Improve()
  {
    constexpr int Passes = 12;
    for (int pass = 0; pass < Passes; ++pass)
    {
      bool moved = false;
      for (std::size_t p = 0; p < this->Mesh.Points.size(); ++p)
      {
        if (this->Mesh.Nodes[p] < 0 && !this->Around[p].empty())
        {
          moved = this->MovePoint(static_cast<int>(p)) || moved;
        }
      }
      if (!moved)
      {
        break;
      }
    }
    double least = 1.0;
    for (std::size_t q = 0; q < this->Mesh.Quads.size(); ++q)
    {
      least = std::min(least, ScaledJacobian(this->Mesh, this->Normals, static_cast<int>(q)));
    }
    return least;
  }

  /// Every inner point to the middle of its neighbours, whatever becomes of the corners: folds
  /// open.
  void Relax()
  {
    constexpr int Passes = 100;
    for (int pass = 0; pass < Passes; ++pass)
    {
      for (std::size_t p = 0; p < this->Mesh.Points.size(); ++p)
      {
        if (this->Mesh.Nodes[p] >= 0 || this->Around[p].empty())
        {
          continue;
        }
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        for (const int neighbour : this->Neighbours[p])
        {
          middle += this->Mesh.Points[At(neighbour)];
        }
        middle /= static_cast<double>(this->Neighbours[p].size());
        this->Mesh.Points[p] = this->Chart.Project(middle, this->Mesh.Places[p]);
        this->Normals[p] = this->Chart.Normal(this->Mesh.Places[p]);
      }
    }
  }

  double Least(int point) const
  {
    double least = 1.0;
    for (const int quad : this->Around[At(point)])
    {
      least = std::min(least, LeastCorner(this->Mesh, this->Normals, quad, this->Ratio));
    }
    return least;
  }

  /// Keeps a move that leaves the quadrilaterals around better than a bound.
  bool Try(int point, const Eigen::Vector3d& target, double bound)
  {
    const Eigen::Vector2d place = this->Mesh.Places[At(point)];
    const Eigen::Vector3d before = this->Mesh.Points[At(point)];
    const Eigen::Vector3d normal = this->Normals[At(point)];
    this->Mesh.Points[At(point)] = this->Chart.Project(target, this->Mesh.Places[At(point)]);
    this->Normals[At(point)] = this->Chart.Normal(this->Mesh.Places[At(point)]);
    if (this->Least(point) > bound)
    {
      return true;
    }
    this->Mesh.Places[At(point)] = place;
    this->Mesh.Points[At(point)] = before;
    this->Normals[At(point)] = normal;
    return false;
  }

  bool MovePoint(int point)
  {
    constexpr double Good = 0.7; ///< above it points go to the middle as they are
    constexpr double Better = 1e-3;
    constexpr double Still = 1e-3; ///< of the size around
    const double least = this->Least(point);
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    double size = 0.0;
    for (const int neighbour : this->Neighbours[At(point)])
    {
      middle += this->Mesh.Points[At(neighbour)];
      size += (this->Mesh.Points[At(neighbour)] - this->Mesh.Points[At(point)]).norm();
    }
    const auto count = static_cast<double>(this->Neighbours[At(point)].size());
    middle /= count;
    size /= count;
    const Eigen::Vector3d here = this->Mesh.Points[At(point)];
    if ((middle - here).norm() > Still * size &&
      this->Try(point, middle, std::min(least + Better, Good)))
    {
      return true;
    }
    if (least >= Good)
    {
      return false;
    }
    const Eigen::Vector3d normal = this->Normals[At(point)];
    const Eigen::Vector3d first =
      normal.norm() > 0.0 ? normal.unitOrthogonal() : Eigen::Vector3d::UnitX();
    const Eigen::Vector3d second = normal.cross(first);
    bool moved = false;
    double reached = least;
    for (const double step : { 0.3, 0.1, 0.03 })
    {
      for (int direction = 0; direction < 8; ++direction)
      {
        const double angle = direction * Pi / 4.0;
        if (this->Try(point,
              this->Mesh.Points[At(point)] +
                step * size * (std::cos(angle) * first + std::sin(angle) * second),
              reached + Better))
        {
          reached = this->Least(point);
          moved = true;
        }
      }
    }
    return moved;
  }

  const FaceChart& Chart;
  FaceQuads& Mesh;
  std::vector<Eigen::Vector3d> Normals;
  std::vector<std::vector<int>> Around;
  std::vector<std::vector<int>> Neighbours;
  static constexpr double Any = std::numeric_limits<double>::infinity();
  double Ratio = Any; ///< of lengths of sides at a corner, that is as good as one
};
}

double SmoothFace(const FaceChart& chart, FaceQuads& mesh)
{
  return QuadSmoothing(chart, mesh).Run();
}
}
