// SPDX-License-Identifier: BSD-3-Clause
// A tetrahedron with a triangle that runs the wrong way.
#include <knotwork/SurfaceRemeshing/SurfaceRepair.h>

int main()
{
  knotwork::TriangleMesh mesh;
  mesh.Points.resize(4, 3);
  mesh.Points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  mesh.Triangles = { { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 0, 2, 3 } };
  const auto repaired = knotwork::RepairSurface(mesh);
  return repaired && repaired->Count(knotwork::RepairKind::TurnedFace) == 1 ? 0 : 1;
}
