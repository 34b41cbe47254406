// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleCollapse.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

namespace knotwork
{
void CollapseEdges(int wanted, PointMatrix& points, std::vector<MeshTriangle>& triangles)
{
  using Kernel = CGAL::Simple_cartesian<double>;
  using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
  namespace Collapse = CGAL::Surface_mesh_simplification;
  if (wanted >= static_cast<int>(triangles.size()))
  {
    return;
  }
  Mesh mesh;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    mesh.add_vertex({ points(i, 0), points(i, 1), points(i, 2) });
  }
  const auto vertex = [](int number) { return Mesh::Vertex_index(static_cast<unsigned>(number)); };
  for (const MeshTriangle& corners : triangles)
  {
    mesh.add_face(vertex(corners[0]), vertex(corners[1]), vertex(corners[2]));
  }
  // a closed surface has three edges on two triangles
  const auto edges = static_cast<std::size_t>(wanted) * 3 / 2;
  Collapse::edge_collapse(mesh, Collapse::Count_stop_predicate<Mesh>(edges),
    CGAL::parameters::get_cost(Collapse::LindstromTurk_cost<Mesh>())
      .get_placement(
        Collapse::Bounded_normal_change_placement<Collapse::LindstromTurk_placement<Mesh>>()));
  mesh.collect_garbage();
  points.resize(static_cast<Eigen::Index>(mesh.number_of_vertices()), 3);
  for (const Mesh::Vertex_index v : mesh.vertices())
  {
    const Kernel::Point_3& place = mesh.point(v);
    points.row(static_cast<Eigen::Index>(v.idx())) << place.x(), place.y(), place.z();
  }
  triangles.clear();
  for (const Mesh::Face_index f : mesh.faces())
  {
    MeshTriangle corners{};
    std::size_t k = 0;
    for (const Mesh::Vertex_index v : mesh.vertices_around_face(mesh.halfedge(f)))
    {
      corners[k++] = static_cast<int>(v.idx());
    }
    triangles.push_back(corners);
  }
}
}
