// SPDX-License-Identifier: BSD-3-Clause
#include "PlaneLoops.h"

#include <knotwork/SplineCore/BoxTree.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
struct BoundaryEdge
{
  int A = 0;
  int B = 0;
  std::size_t Loop = 0;
  double Passed = 0.0; ///< length of its loop up to it
  double Length = 0.0;
};

struct BoundaryEdges
{
  std::vector<BoundaryEdge> Edges;
  std::vector<double> Lengths; ///< of loops

  /// @param points  what lengths are measured in.
  BoundaryEdges(const std::vector<std::vector<int>>& loops, const PointMatrix& points)
  {
    for (std::size_t l = 0; l < loops.size(); ++l)
    {
      const auto& loop = loops[l];
      double passed = 0.0;
      for (std::size_t i = 0; i < loop.size(); ++i)
      {
        const int a = loop[i];
        const int b = loop[(i + 1) % loop.size()];
        const double length = (points.row(b) - points.row(a)).norm();
        this->Edges.push_back({ a, b, l, passed, length });
        passed += length;
      }
      this->Lengths.push_back(passed);
    }
  }

  /// Of the shorter way along the boundary.
  double Way(const BoundaryEdge& p, const BoundaryEdge& q) const
  {
    if (p.Loop != q.Loop)
    {
      return std::numeric_limits<double>::max();
    }
    const double way = std::abs(p.Passed - q.Passed);
    return std::min(way, this->Lengths[p.Loop] - way);
  }
};

constexpr double Near = 0.5;    // of an edge in the plane
constexpr double Far = 2.0;     // of an edge, in space
constexpr double Narrow = 0.25; // of the gap in space

double PointDistance(const PointMatrix& points, int point, const BoundaryEdge& edge)
{
  const auto along = points.row(edge.B) - points.row(edge.A);
  const auto to = points.row(point) - points.row(edge.A);
  const double share = std::clamp(to.dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (to - share * along).norm();
}

/// Distance of two segments that do not cross: an end of one is nearest.
double SegmentDistance(const PointMatrix& points, const BoundaryEdge& p, const BoundaryEdge& q)
{
  return std::min({ PointDistance(points, p.A, q), PointDistance(points, p.B, q),
    PointDistance(points, q.A, p), PointDistance(points, q.B, p) });
}

/// Whether edges have a point in common; exact.
bool Meet(const PointMatrix& uv, const BoundaryEdge& p, const BoundaryEdge& q)
{
  const auto apart = [&](int d) // as edges of one line are
  {
    return std::max(uv(p.A, d), uv(p.B, d)) < std::min(uv(q.A, d), uv(q.B, d)) ||
      std::max(uv(q.A, d), uv(q.B, d)) < std::min(uv(p.A, d), uv(p.B, d));
  };
  return !apart(0) && !apart(1) && Turn(uv, p.A, p.B, q.A) * Turn(uv, p.A, p.B, q.B) <= 0 &&
    Turn(uv, q.A, q.B, p.A) * Turn(uv, q.A, q.B, p.B) <= 0;
}

bool HaveCommonEnd(const BoundaryEdge& p, const BoundaryEdge& q)
{
  return p.A == q.A || p.A == q.B || p.B == q.A || p.B == q.B;
}

/// Whether a loop that comes along p turns back along q, which follows it; exact.
bool TurnsBack(const PointMatrix& uv, const BoundaryEdge& p, const BoundaryEdge& q)
{
  // signs of rounded differences are exact
  const auto back = [&](int d)
  {
    const double along = uv(p.B, d) - uv(p.A, d);
    const double onward = uv(q.B, d) - uv(q.A, d);
    return (along > 0.0 && onward < 0.0) || (along < 0.0 && onward > 0.0) ||
      (along == 0.0 && onward == 0.0);
  };
  return p.B == q.A && Turn(uv, p.A, p.B, q.B) == 0 && back(0) && back(1);
}

/// Whether boundary edges of one map meet where they must not.
bool Cross(const PointMatrix& uv, const BoundaryEdge& p, const BoundaryEdge& q)
{
  return HaveCommonEnd(p, q) ? TurnsBack(uv, p, q) || TurnsBack(uv, q, p) : Meet(uv, p, q);
}

/// Whether the outside between p and q, which follows it, is narrow in the plane but not in space.
bool IsSlit(
  const DiscMesh& mesh, const PointMatrix& uv, const BoundaryEdge& p, const BoundaryEdge& q)
{
  if (p.B != q.A || Turn(uv, p.A, p.B, q.B) >= 0)
  {
    return false;
  }
  const auto gap = [&](const PointMatrix& points)
  { return std::min(PointDistance(points, p.A, q), PointDistance(points, q.B, p)); };
  return gap(uv) < Narrow * gap(mesh.Points);
}

bool Conflict(
  const DiscMesh& mesh, const PointMatrix& uv, const BoundaryEdge& p, const BoundaryEdge& q)
{
  if (HaveCommonEnd(p, q))
  {
    return Cross(uv, p, q) || IsSlit(mesh, uv, p, q) || IsSlit(mesh, uv, q, p);
  }
  const double size = 0.5 * (p.Length + q.Length);
  return Cross(uv, p, q) ||
    (SegmentDistance(uv, p, q) < Near * size && SegmentDistance(mesh.Points, p, q) > Far * size);
}

/// Whether a loop that does not cross itself runs counterclockwise; exact.
bool RunsCounterclockwise(const PointMatrix& uv, const std::vector<int>& loop)
{
  const auto before = [&](std::size_t i, std::size_t j)
  {
    const int a = loop[i];
    const int b = loop[j];
    return uv(a, 0) < uv(b, 0) || (uv(a, 0) == uv(b, 0) && uv(a, 1) < uv(b, 1));
  };
  const std::size_t n = loop.size();
  std::size_t first = 0; // a corner of the convex hull
  for (std::size_t i = 1; i < n; ++i)
  {
    first = before(i, first) ? i : first;
  }
  return Turn(uv, loop[(first + n - 1) % n], loop[first], loop[(first + 1) % n]) > 0;
}

/// The loop around all others, that of the leftmost point.
std::size_t OuterLoop(const PointMatrix& uv, const std::vector<std::vector<int>>& loops)
{
  std::size_t outer = 0;
  double left = std::numeric_limits<double>::infinity();
  for (std::size_t l = 0; l < loops.size(); ++l)
  {
    for (int v : loops[l])
    {
      outer = uv(v, 0) < left ? l : outer;
      left = std::min(left, uv(v, 0));
    }
  }
  return outer;
}

/// Edges on opposite sides of a hole whose loop runs counterclockwise, as only the outer one may:
/// the surface is turned over its rim and covers the plane inside it twice.
EdgeCrossing FindTurnedHole(
  const PointMatrix& uv, const std::vector<std::vector<int>>& loops, const BoundaryEdges& boundary)
{
  const std::size_t outer = OuterLoop(uv, loops);
  std::vector<char> turned;
  for (std::size_t l = 0; l < loops.size(); ++l)
  {
    turned.push_back(l != outer && RunsCounterclockwise(uv, loops[l]) ? 1 : 0);
  }
  EdgeCrossing crossing;
  for (const BoundaryEdge& edge : boundary.Edges)
  {
    if (turned[edge.Loop] && !crossing)
    {
      crossing.First = { edge.A, edge.B };
      crossing.Second = crossing.First;
    }
    else if (crossing && turned[edge.Loop] && edge.Passed <= 0.5 * boundary.Lengths[edge.Loop])
    {
      crossing.Second = { edge.A, edge.B };
    }
    else if (crossing)
    {
      break;
    }
  }
  return crossing;
}

/// Boxes of edges with margins of a share of their length in space.
struct EdgeBoxes
{
  PointMatrix Lower;
  PointMatrix Upper;
  BoxTree Tree;

  EdgeBoxes(const BoundaryEdges& boundary, const PointMatrix& uv, double share)
    : Lower(static_cast<Eigen::Index>(boundary.Edges.size()), 2), Upper(Lower.rows(), 2)
  {
    for (Eigen::Index i = 0; i < this->Lower.rows(); ++i)
    {
      const BoundaryEdge& edge = boundary.Edges[static_cast<std::size_t>(i)];
      const double margin = share * edge.Length;
      this->Lower.row(i) = uv.row(edge.A).cwiseMin(uv.row(edge.B)).array() - margin;
      this->Upper.row(i) = uv.row(edge.A).cwiseMax(uv.row(edge.B)).array() + margin;
    }
    this->Tree = BoxTree(this->Lower, this->Upper);
  }
};

/// The pair of edges in conflict with the longest way between them.
/// @param conflict  called as conflict(edge, other) -> bool.
template <typename Test>
EdgeCrossing FarthestConflict(
  const BoundaryEdges& boundary, const PointMatrix& uv, double margin, Test&& conflict)
{
  const EdgeBoxes boxes(boundary, uv, margin);
  EdgeCrossing crossing;
  double longest = -1.0;
  for (Eigen::Index i = 0; i < boxes.Lower.rows(); ++i)
  {
    const BoundaryEdge& edge = boundary.Edges[static_cast<std::size_t>(i)];
    boxes.Tree.ForNear(boxes.Lower.row(i).data(), boxes.Upper.row(i).data(),
      [&](int item)
      {
        const BoundaryEdge& other = boundary.Edges[static_cast<std::size_t>(item)];
        if (item > i && boundary.Way(edge, other) > longest && conflict(edge, other))
        {
          longest = boundary.Way(edge, other);
          crossing.First = { edge.A, edge.B };
          crossing.Second = { other.A, other.B };
        }
      });
  }
  return crossing;
}

/// Exact sum of two numbers as their rounded sum and its error.
std::array<double, 2> TwoSum(double a, double b)
{
  const double sum = a + b;
  const double part = sum - a;
  return { sum, (a - (sum - part)) + (b - part) };
}

/// Sign of a sum, exact.
/// @source Shewchuk, Discrete Comput. Geom. 18 (1997) 305: GROW-EXPANSION.
int SignOfSum(const std::array<double, 12>& terms)
{
  std::array<double, 12> parts{}; // do not overlap; the largest one comes last
  std::size_t count = 0;
  for (double rest : terms)
  {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i)
    {
      const auto [sum, error] = TwoSum(rest, parts[i]);
      rest = sum;
      if (error != 0.0)
      {
        parts[kept++] = error;
      }
    }
    if (rest != 0.0)
    {
      parts[kept++] = rest;
    }
    count = kept;
  }
  const double largest = count > 0 ? parts[count - 1] : 0.0;
  return (largest > 0.0 ? 1 : 0) - (largest < 0.0 ? 1 : 0);
}

std::string Describe(const std::array<int, 2>& edge)
{
  return std::to_string(edge[0]) + "-" + std::to_string(edge[1]);
}
}

int Turn(const PointMatrix& uv, int a, int b, int c)
{
  const double left = (uv(a, 0) - uv(c, 0)) * (uv(b, 1) - uv(c, 1));
  const double right = (uv(a, 1) - uv(c, 1)) * (uv(b, 0) - uv(c, 0));
  // three roundings of each product, one of their difference
  if (std::abs(left - right) > 4e-16 * (std::abs(left) + std::abs(right)))
  {
    return left > right ? 1 : -1;
  }
  std::array<double, 12> terms{};
  std::size_t count = 0;
  for (const auto& [i, j] : { std::array<int, 2>{ a, b }, { b, c }, { c, a } })
  {
    for (const auto& [x, y] :
      { std::array<double, 2>{ uv(i, 0), uv(j, 1) }, { -uv(i, 1), uv(j, 0) } })
    {
      const double product = x * y;
      terms[count++] = std::fma(x, y, -product);
      terms[count++] = product;
    }
  }
  return SignOfSum(terms);
}

EdgeCrossing FindOverlap(const std::vector<std::vector<int>>& loops, const PointMatrix& uv)
{
  const BoundaryEdges boundary(loops, uv);
  const EdgeCrossing crossing = FarthestConflict(boundary, uv, 0.0,
    [&](const BoundaryEdge& p, const BoundaryEdge& q) { return Cross(uv, p, q); });
  return crossing ? crossing : FindTurnedHole(uv, loops, boundary);
}

bool IsCounterclockwise(const DiscMesh& mesh, const PointMatrix& uv)
{
  return std::all_of(mesh.Triangles.begin(), mesh.Triangles.end(),
    [&](const auto& corners) { return Turn(uv, corners[0], corners[1], corners[2]) > 0; });
}

Status CheckInjective(const DiscMesh& mesh, const PointMatrix& uv)
{
  if (!IsCounterclockwise(mesh, uv))
  {
    return { ErrorCode::InvalidTopology, "triangles are not counterclockwise in the plane" };
  }
  const EdgeCrossing overlap = FindOverlap(mesh.Loops, uv);
  return overlap ? Status(ErrorCode::InvalidTopology,
                     "the map lies over itself in the plane: boundary edges " +
                       Describe(overlap.First) + " and " + Describe(overlap.Second) + " meet")
                 : Status();
}

EdgeCrossing FindCrossing(const DiscMesh& mesh, const PointMatrix& uv)
{
  const BoundaryEdges boundary(mesh.Loops, mesh.Points);
  const EdgeCrossing crossing = FarthestConflict(boundary, uv, 0.5 * Near,
    [&](const BoundaryEdge& p, const BoundaryEdge& q) { return Conflict(mesh, uv, p, q); });
  return crossing ? crossing : FindTurnedHole(uv, mesh.Loops, boundary);
}
}
