// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/MeshParameterization/TriangleMesh.h>
#include <knotwork/SplineCore/Tessellation.h>

namespace knotwork
{
/// Triangles on the boundary of a solid, outward where they are closed.
struct BoundaryMesh
{
  TriangleMesh Mesh;
  std::vector<int> Patches; ///< one a triangle
  std::vector<int> Faces;   ///< of a volume the side of the patch, 2 direction + end
  double Bound = 0.0;       ///< of the chordal deviation, proved
  bool Closed = false;      ///< every edge in two triangles that run it oppositely
  double Area = 0.0;
  double Volume = 0.0; ///< enclosed; 0 unless closed
};

/// Polygons as triangles: quadrilaterals are divided along the shorter diagonal, which keeps the
/// chordal bound.
/// @return as FinishBoundary.
Result<BoundaryMesh> MakeBoundaryMesh(const TessellationMesh& polygons);

/// Turns triangles that hang together alike, and all outward; measures them.
/// @return EmptyInput; InvalidTopology for a surface with one side.
Status FinishBoundary(BoundaryMesh& boundary);
}
