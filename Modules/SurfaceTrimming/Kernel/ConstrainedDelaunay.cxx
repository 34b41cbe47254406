// SPDX-License-Identifier: BSD-3-Clause
#include "ConstrainedDelaunay.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <exception>
#include <string>

namespace knotwork
{
namespace
{
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure,
  CGAL::No_constraint_intersection_tag>;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

Result<std::vector<std::array<int, 3>>> Triangulate(
  const std::vector<PlanarPoint>& points, const std::vector<PlanarSegment>& segments)
{
  std::vector<std::pair<Kernel::Point_2, int>> numbered;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    numbered.emplace_back(Kernel::Point_2(points[i][0], points[i][1]), static_cast<int>(i));
  }
  Triangulation triangulation;
  triangulation.insert(numbered.begin(), numbered.end());
  std::vector<Triangulation::Vertex_handle> vertices(points.size());
  for (Triangulation::Vertex_handle vertex : triangulation.finite_vertex_handles())
  {
    vertices[At(vertex->info())] = vertex;
  }
  for (const PlanarSegment& segment : segments)
  {
    const auto a = vertices[At(segment[0])];
    const auto b = vertices[At(segment[1])];
    if (a == Triangulation::Vertex_handle() || b == Triangulation::Vertex_handle() || a == b)
    {
      return { ErrorCode::InvalidTopology, "points of segments coincide" };
    }
    triangulation.insert_constraint(a, b);
  }
  if (triangulation.dimension() < 2)
  {
    return { ErrorCode::InvalidTopology, "all points lie on a line" };
  }
  std::vector<std::array<int, 3>> triangles;
  triangles.reserve(triangulation.number_of_faces());
  for (Triangulation::Face_handle face : triangulation.finite_face_handles())
  {
    std::array<int, 3> corners{ face->vertex(0)->info(), face->vertex(1)->info(),
      face->vertex(2)->info() };
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    triangles.push_back(corners);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}
}

Result<std::vector<std::array<int, 3>>> ConstrainedDelaunay(
  const std::vector<PlanarPoint>& points, const std::vector<PlanarSegment>& segments)
{
  try
  {
    return Triangulate(points, segments);
  }
  catch (const std::exception& error) // how CGAL reports constraints that cross
  {
    return { ErrorCode::InvalidTopology, error.what() };
  }
}
}
