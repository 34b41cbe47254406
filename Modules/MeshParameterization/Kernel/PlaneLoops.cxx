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
  double Length = 0.0; ///< in space
};

struct BoundaryEdges
{
  std::vector<BoundaryEdge> Edges;
  std::vector<double> Lengths; ///< of loops

  explicit BoundaryEdges(const DiscMesh& mesh)
  {
    for (std::size_t l = 0; l < mesh.Loops.size(); ++l)
    {
      const auto& loop = mesh.Loops[l];
      double passed = 0.0;
      for (std::size_t i = 0; i < loop.size(); ++i)
      {
        const int a = loop[i];
        const int b = loop[(i + 1) % loop.size()];
        const double length = (mesh.Point(b) - mesh.Point(a)).norm();
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

constexpr double Near = 0.5; // of an edge in the plane
constexpr double Far = 2.0;  // of an edge, in space

/// Distance of two segments that do not cross: an end of one is nearest.
double SegmentDistance(const PointMatrix& points, const BoundaryEdge& p, const BoundaryEdge& q)
{
  const auto distance = [&](int point, const BoundaryEdge& edge)
  {
    const auto along = points.row(edge.B) - points.row(edge.A);
    const auto to = points.row(point) - points.row(edge.A);
    const double share = std::clamp(to.dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (to - share * along).norm();
  };
  return std::min({ distance(p.A, q), distance(p.B, q), distance(q.A, p), distance(q.B, p) });
}

bool Cross(const PointMatrix& uv, const BoundaryEdge& p, const BoundaryEdge& q)
{
  const auto side = [&](int a, int b, int c) // of the line a -> b
  {
    const Eigen::RowVector2d ab = uv.row(b) - uv.row(a);
    const Eigen::RowVector2d ac = uv.row(c) - uv.row(a);
    return ab[0] * ac[1] - ab[1] * ac[0];
  };
  const auto apart = [&](int d) // as edges of one line are
  {
    return std::max(uv(p.A, d), uv(p.B, d)) < std::min(uv(q.A, d), uv(q.B, d)) ||
      std::max(uv(q.A, d), uv(q.B, d)) < std::min(uv(p.A, d), uv(p.B, d));
  };
  return !apart(0) && !apart(1) && side(p.A, p.B, q.A) * side(p.A, p.B, q.B) <= 0.0 &&
    side(q.A, q.B, p.A) * side(q.A, q.B, p.B) <= 0.0;
}

bool Conflict(
  const DiscMesh& mesh, const PointMatrix& uv, const BoundaryEdge& p, const BoundaryEdge& q)
{
  if (p.A == q.A || p.A == q.B || p.B == q.A || p.B == q.B)
  {
    return false;
  }
  const double size = 0.5 * (p.Length + q.Length);
  return Cross(uv, p, q) ||
    (SegmentDistance(uv, p, q) < Near * size && SegmentDistance(mesh.Points, p, q) > Far * size);
}

/// Twice the area that a loop runs around counterclockwise.
double TurnedArea(const PointMatrix& uv, const std::vector<int>& loop)
{
  double area = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i)
  {
    const Eigen::RowVector2d a = uv.row(loop[i]) - uv.row(loop[0]);
    const Eigen::RowVector2d b = uv.row(loop[(i + 1) % loop.size()]) - uv.row(loop[0]);
    area += a[0] * b[1] - a[1] * b[0];
  }
  return area;
}

/// Edges on opposite sides of a hole whose loop runs counterclockwise, as only the outer one may:
/// the surface is turned over its rim and covers the plane inside it twice.
EdgeCrossing FindTurnedHole(
  const DiscMesh& mesh, const PointMatrix& uv, const BoundaryEdges& boundary)
{
  std::vector<double> areas;
  for (const auto& loop : mesh.Loops)
  {
    areas.push_back(TurnedArea(uv, loop));
  }
  const auto outer =
    static_cast<std::size_t>(std::max_element(areas.begin(), areas.end()) - areas.begin());
  EdgeCrossing crossing;
  for (const BoundaryEdge& edge : boundary.Edges)
  {
    const bool turned = edge.Loop != outer && areas[edge.Loop] > 0.0;
    if (turned && !crossing)
    {
      crossing.First = { edge.A, edge.B };
      crossing.Second = crossing.First;
    }
    else if (crossing && turned && edge.Passed <= 0.5 * boundary.Lengths[edge.Loop])
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
}

EdgeCrossing FindCrossing(const DiscMesh& mesh, const PointMatrix& uv)
{
  const BoundaryEdges boundary(mesh);
  const auto n = static_cast<Eigen::Index>(boundary.Edges.size());
  PointMatrix lower(n, 2);
  PointMatrix upper(n, 2);
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const BoundaryEdge& edge = boundary.Edges[static_cast<std::size_t>(i)];
    const double margin = 0.5 * Near * edge.Length;
    lower.row(i) = uv.row(edge.A).cwiseMin(uv.row(edge.B)).array() - margin;
    upper.row(i) = uv.row(edge.A).cwiseMax(uv.row(edge.B)).array() + margin;
  }
  const BoxTree tree(lower, upper);
  EdgeCrossing crossing;
  double longest = -1.0;
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const BoundaryEdge& edge = boundary.Edges[static_cast<std::size_t>(i)];
    tree.ForNear(lower.row(i).data(), upper.row(i).data(),
      [&](int item)
      {
        const BoundaryEdge& other = boundary.Edges[static_cast<std::size_t>(item)];
        if (item > i && boundary.Way(edge, other) > longest && Conflict(mesh, uv, edge, other))
        {
          longest = boundary.Way(edge, other);
          crossing.First = { edge.A, edge.B };
          crossing.Second = { other.A, other.B };
        }
      });
  }
  return crossing ? crossing : FindTurnedHole(mesh, uv, boundary);
}
}
