// SPDX-License-Identifier: BSD-3-Clause
#include "SolidOracle.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace knotwork
{
namespace
{
namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Triangle = Kernel::Triangle_3;

Point PointOf(const TriangleMesh& mesh, int i)
{
  return { mesh.Points(i, 0), mesh.Points(i, 1), mesh.Points(i, 2) };
}
}

std::string WhyNoSolid(const TriangleMesh& mesh)
{
  std::vector<Point> points;
  for (int i = 0; i < mesh.Points.rows(); ++i)
  {
    points.push_back(PointOf(mesh, i));
  }
  std::vector<std::array<std::size_t, 3>> polygons;
  for (const auto& t : mesh.Triangles)
  {
    polygons.push_back({ static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
      static_cast<std::size_t>(t[2]) });
  }
  if (!PMP::is_polygon_soup_a_polygon_mesh(polygons))
  {
    return "not manifold or not turned alike";
  }
  CGAL::Surface_mesh<Point> surface;
  PMP::polygon_soup_to_polygon_mesh(points, polygons, surface);
  if (!CGAL::is_closed(surface))
  {
    return "open";
  }
  if (PMP::does_self_intersect(surface))
  {
    return "meets itself";
  }
  // parts within others must be turned inward
  return PMP::does_bound_a_volume(surface) ? "" : "bounds no volume";
}

double SampledDistance(const TriangleMesh& from, const TriangleMesh& to)
{
  using Primitive = CGAL::AABB_triangle_primitive<Kernel, std::vector<Triangle>::const_iterator>;
  std::vector<Triangle> triangles;
  for (const auto& t : to.Triangles)
  {
    triangles.emplace_back(PointOf(to, t[0]), PointOf(to, t[1]), PointOf(to, t[2]));
  }
  const CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree(
    triangles.cbegin(), triangles.cend());
  constexpr int Steps = 4;
  double largest = 0.0;
  for (const auto& t : from.Triangles)
  {
    for (int i = 0; i <= Steps; ++i)
    {
      for (int j = 0; i + j <= Steps; ++j)
      {
        const double u = static_cast<double>(i) / Steps;
        const double v = static_cast<double>(j) / Steps;
        const Eigen::RowVector3d p = (1.0 - u - v) * from.Points.row(t[0]) +
          u * from.Points.row(t[1]) + v * from.Points.row(t[2]);
        largest = std::max(largest, tree.squared_distance(Point(p[0], p[1], p[2])));
      }
    }
  }
  return std::sqrt(largest);
}
}
