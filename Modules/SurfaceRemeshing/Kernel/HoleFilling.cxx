// SPDX-License-Identifier: BSD-3-Clause
#include "HoleFilling.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/utility.h>

namespace knotwork
{
std::vector<MeshTriangle> FillRim(const PointMatrix& rim, const PointMatrix& apexes)
{
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_3> points;
  std::vector<Kernel::Point_3> beside;
  for (Eigen::Index i = 0; i < rim.rows(); ++i)
  {
    points.emplace_back(rim(i, 0), rim(i, 1), rim(i, 2));
    beside.emplace_back(apexes(i, 0), apexes(i, 1), apexes(i, 2));
  }
  std::vector<CGAL::Triple<int, int, int>> found;
  CGAL::Polygon_mesh_processing::triangulate_hole_polyline(
    points, beside, std::back_inserter(found), CGAL::parameters::geom_traits(Kernel()));
  std::vector<MeshTriangle> triangles;
  for (const auto& t : found)
  {
    triangles.push_back({ t.first, t.second, t.third });
  }
  return triangles;
}
}
