// SPDX-License-Identifier: BSD-3-Clause
#include "TrianglePairs.h"

#include <knotwork/SplineCore/Parallel.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace knotwork
{
namespace
{
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Segment = Kernel::Segment_3;
using Triangle = Kernel::Triangle_3;

constexpr std::size_t ChunkSize = 256;

class PairSearch
{
public:
  PairSearch(const PointMatrix& points, const std::vector<MeshTriangle>& triangles, int threads,
    const std::vector<char>& of)
    : Points(points), Triangles(triangles), Of(of),
      Degenerate(FindDegenerate(points, triangles, threads))
  {
    const auto count = static_cast<Eigen::Index>(triangles.size());
    this->Lower.resize(count, 3);
    this->Upper.resize(count, 3);
    for (Eigen::Index t = 0; t < count; ++t)
    {
      const MeshTriangle& corners = triangles[static_cast<std::size_t>(t)];
      const auto a = points.row(corners[0]).array();
      const auto b = points.row(corners[1]).array();
      const auto c = points.row(corners[2]).array();
      this->Lower.row(t) = a.min(b).min(c);
      this->Upper.row(t) = a.max(b).max(c);
    }
    this->Tree = BoxTree(this->Lower, this->Upper);
  }

  /// Triangles that t meets and whose own turn does not find t.
  void Collect(int t, std::vector<std::pair<int, int>>& pairs) const
  {
    if (this->Degenerate[static_cast<std::size_t>(t)] || !this->Searches(t))
    {
      return;
    }
    const std::size_t first = pairs.size();
    this->Tree.ForNear(this->Lower.row(t).data(), this->Upper.row(t).data(),
      [&](int other)
      {
        if ((other > t || !this->Searches(other)) && other != t &&
          !this->Degenerate[static_cast<std::size_t>(other)] && this->BoxesMeet(t, other) &&
          this->Meet(t, other))
        {
          pairs.emplace_back(std::min(t, other), std::max(t, other));
        }
      });
    std::sort(pairs.begin() + static_cast<std::ptrdiff_t>(first), pairs.end());
  }

private:
  bool Searches(int t) const
  {
    return this->Of.empty() || this->Of[static_cast<std::size_t>(t)] != 0;
  }
  Point At(int point) const
  {
    return { this->Points(point, 0), this->Points(point, 1), this->Points(point, 2) };
  }
  bool BoxesMeet(int s, int t) const
  {
    return (this->Lower.row(s).array() <= this->Upper.row(t).array()).all() &&
      (this->Lower.row(t).array() <= this->Upper.row(s).array()).all();
  }
  bool Meet(int s, int t) const
  {
    MeshTriangle a = this->Triangles[static_cast<std::size_t>(s)];
    MeshTriangle b = this->Triangles[static_cast<std::size_t>(t)];
    int shared = 0; // of both, brought to the front
    for (int i = 0; i < 3; ++i)
    {
      for (int j = shared; j < 3; ++j)
      {
        if (a[static_cast<std::size_t>(i)] == b[static_cast<std::size_t>(j)])
        {
          std::swap(a[static_cast<std::size_t>(i)], a[static_cast<std::size_t>(shared)]);
          std::swap(b[static_cast<std::size_t>(j)], b[static_cast<std::size_t>(shared)]);
          ++shared;
          break;
        }
      }
    }
    const Point p[3] = { this->At(a[0]), this->At(a[1]), this->At(a[2]) };
    const Point q[3] = { this->At(b[0]), this->At(b[1]), this->At(b[2]) };
    switch (shared)
    {
      case 0:
        return CGAL::do_intersect(Triangle(p[0], p[1], p[2]), Triangle(q[0], q[1], q[2]));
      case 1:
        return CGAL::do_intersect(Triangle(p[0], p[1], p[2]), Segment(q[1], q[2])) ||
          CGAL::do_intersect(Triangle(q[0], q[1], q[2]), Segment(p[1], p[2]));
      case 2:
        return CGAL::orientation(p[0], p[1], p[2], q[2]) == CGAL::COPLANAR &&
          CGAL::coplanar_orientation(p[0], p[1], p[2], q[2]) == CGAL::POSITIVE;
      default:
        return true;
    }
  }

  const PointMatrix& Points;
  const std::vector<MeshTriangle>& Triangles;
  const std::vector<char>& Of;
  std::vector<char> Degenerate;
  PointMatrix Lower;
  PointMatrix Upper;
  BoxTree Tree;
};
}

std::vector<char> FindDegenerate(
  const PointMatrix& points, const std::vector<MeshTriangle>& triangles, int threads)
{
  std::vector<char> degenerate(triangles.size(), 0);
  ParallelFor(triangles.size(), ChunkSize, threads,
    [&](std::size_t begin, std::size_t end)
    {
      const auto at = [&](int i) { return Point(points(i, 0), points(i, 1), points(i, 2)); };
      for (std::size_t t = begin; t < end; ++t)
      {
        const MeshTriangle& corners = triangles[t];
        degenerate[t] = CGAL::collinear(at(corners[0]), at(corners[1]), at(corners[2])) ? 1 : 0;
      }
    });
  return degenerate;
}

std::vector<std::pair<int, int>> FindIntersections(const PointMatrix& points,
  const std::vector<MeshTriangle>& triangles, int threads, const std::vector<char>& of)
{
  if (triangles.empty())
  {
    return {};
  }
  const PairSearch search(points, triangles, threads, of);
  std::vector<std::vector<std::pair<int, int>>> found(
    (triangles.size() + ChunkSize - 1) / ChunkSize);
  ParallelFor(triangles.size(), ChunkSize, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t t = begin; t < end; ++t)
      {
        search.Collect(static_cast<int>(t), found[begin / ChunkSize]);
      }
    });
  std::vector<std::pair<int, int>> pairs;
  for (const auto& part : found)
  {
    pairs.insert(pairs.end(), part.begin(), part.end());
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}
}
