// SPDX-License-Identifier: BSD-3-Clause
// Sides of hexahedra, and those that lie on faces of a CAD model.
#pragma once
#include "CADHexes.h"
#include "CADMesh.h"

namespace knotwork
{
/// Hexahedra of all solids, with the points of a mesh of their faces.
struct HexCells
{
  std::vector<int> Corners; ///< 8 a cell, CellMesh's order, right-handed
  std::vector<int> Bodies;  ///< one a cell
  std::vector<int> Layers;
};

/// Sides on faces of the model, by cell and side; of a side that two solids have, the first one's.
/// They are the quadrilaterals of the mesh of the faces, and outer sides whose corners lie on one
/// face of their solid, or on its rim, where a layer has moved others away.
/// @param cells  with points of `mesh`. @complexity O(sides log sides) of the sides without a point
/// inside.
std::vector<CADHexFacet> FindFacetsOnFaces(
  const CADTopology& model, const CADMesh& mesh, const HexCells& cells);
}
