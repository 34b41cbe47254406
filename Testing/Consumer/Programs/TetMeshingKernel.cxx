// SPDX-License-Identifier: BSD-3-Clause
// A tetrahedron, from a mesher that knows no other.
#include <knotwork/TetMeshing/SolidMesh.h>

int main()
{
  knotwork::TriangleMesh mesh;
  mesh.Points.resize(4, 3);
  mesh.Points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  mesh.Triangles = { { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 0, 3, 2 } };
  const auto maker = [](const knotwork::TriangleMesh& surface, const knotwork::TetrahedraParams&)
  {
    knotwork::Tetrahedra solid;
    solid.Points = surface.Points;
    solid.Cells = { { 0, 1, 2, 3 } };
    solid.Triangles = surface.Triangles;
    solid.Sources = { 0, 1, 2, 3 };
    return knotwork::Result<knotwork::Tetrahedra>(solid);
  };
  knotwork::SolidMeshParams params;
  params.Order = 2;
  const auto solid = knotwork::MeshSolid(mesh, nullptr, maker, params);
  return solid && solid->Points.rows() == 10 ? 0 : 1;
}
