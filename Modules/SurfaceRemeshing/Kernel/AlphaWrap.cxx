// SPDX-License-Identifier: BSD-3-Clause
#include "AlphaWrap.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include <array>
#include <vector>

namespace knotwork
{
TriangleMesh WrapTriangles(const TriangleMesh& mesh, double alpha, double offset)
{
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_3> points;
  for (Eigen::Index i = 0; i < mesh.Points.rows(); ++i)
  {
    points.emplace_back(mesh.Points(i, 0), mesh.Points(i, 1), mesh.Points(i, 2));
  }
  std::vector<std::array<std::size_t, 3>> faces;
  for (const auto& [a, b, c] : mesh.Triangles)
  {
    faces.push_back(
      { static_cast<std::size_t>(a), static_cast<std::size_t>(b), static_cast<std::size_t>(c) });
  }
  CGAL::Surface_mesh<Kernel::Point_3> wrap;
  CGAL::alpha_wrap_3(points, faces, alpha, offset, wrap);
  wrap.collect_garbage();
  TriangleMesh result;
  result.Points.resize(static_cast<Eigen::Index>(wrap.number_of_vertices()), 3);
  for (const auto vertex : wrap.vertices())
  {
    const Kernel::Point_3& point = wrap.point(vertex);
    result.Points.row(static_cast<Eigen::Index>(vertex.idx())) << point.x(), point.y(), point.z();
  }
  for (const auto face : wrap.faces())
  {
    std::array<int, 3> corners{};
    std::size_t k = 0;
    for (const auto vertex : wrap.vertices_around_face(wrap.halfedge(face)))
    {
      corners[k++] = static_cast<int>(vertex.idx());
    }
    result.Triangles.push_back(corners);
  }
  return result;
}
}
