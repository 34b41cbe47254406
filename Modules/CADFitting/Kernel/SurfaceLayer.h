// SPDX-License-Identifier: BSD-3-Clause
// A layer of hexahedra under the surface of a mesh, private to the kernel.
#pragma once
#include "MeshClassification.h"

namespace knotwork
{
/// Edges of the surface, not classified on a curve, whose two quadrilaterals are faces of one
/// hexahedron: on a smooth surface its map cannot be regular there.
std::vector<int> EdgesOfTwoFaces(const SurfaceMesh& surface, const MeshClassification& parts);

struct LayeredMesh
{
  CellMesh<3> Mesh; ///< cells as before, then those of the layer; surface points keep their numbers
  PointMatrix Points;      ///< n x 3
  std::vector<int> CellOf; ///< old cell of every cell: itself, or the one below
};

/// Shifts the surface's points inward, and fills what is between with a hexahedron a quadrilateral.
/// @param share  of the mean edge at a point by which it is shifted.
LayeredMesh AddLayer(
  const CellMesh<3>& mesh, const SurfaceMesh& surface, const PointMatrix& points, double share);
}
