// SPDX-License-Identifier: BSD-3-Clause
#include "PlaneLoops.h"

#include "BoxTree.h"

#include <algorithm>
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
        this->Edges.push_back({ a, b, l, passed });
        passed += (mesh.Point(b) - mesh.Point(a)).norm();
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
    lower.row(i) = uv.row(edge.A).cwiseMin(uv.row(edge.B));
    upper.row(i) = uv.row(edge.A).cwiseMax(uv.row(edge.B));
  }
  const BoxTree tree(lower, upper);
  const auto side = [&](int a, int b, int c) // of the line a -> b
  {
    const Eigen::RowVector2d p = uv.row(b) - uv.row(a);
    const Eigen::RowVector2d q = uv.row(c) - uv.row(a);
    return p[0] * q[1] - p[1] * q[0];
  };
  const auto apart = [&](Eigen::Index i, Eigen::Index j) // as edges of one line are
  {
    return (lower.row(i).array() > upper.row(j).array()).any() ||
      (lower.row(j).array() > upper.row(i).array()).any();
  };
  const auto cross = [&](const BoundaryEdge& p, const BoundaryEdge& q)
  {
    const bool neighbours = p.A == q.A || p.A == q.B || p.B == q.A || p.B == q.B;
    return !neighbours && side(p.A, p.B, q.A) * side(p.A, p.B, q.B) <= 0.0 &&
      side(q.A, q.B, p.A) * side(q.A, q.B, p.B) <= 0.0;
  };
  EdgeCrossing crossing;
  double longest = -1.0;
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const BoundaryEdge& edge = boundary.Edges[static_cast<std::size_t>(i)];
    tree.ForNear(lower.row(i).data(), upper.row(i).data(),
      [&](int item)
      {
        const BoundaryEdge& other = boundary.Edges[static_cast<std::size_t>(item)];
        if (item > i && !apart(i, item) && cross(edge, other) &&
          boundary.Way(edge, other) > longest)
        {
          longest = boundary.Way(edge, other);
          crossing.First = { edge.A, edge.B };
          crossing.Second = { other.A, other.B };
        }
      });
  }
  return crossing;
}
}
