// SPDX-License-Identifier: BSD-3-Clause
// A layer of hexahedra under surfaces that go on smoothly where a hexahedron has two of its sides.
#pragma once
#include "CADMesh.h"
#include "FaceMesher.h"
#include "HexFacets.h"

namespace knotwork
{
/// Where two outer sides of a hexahedron meet at less than 45 degrees, as at a fillet's rim, its
/// corners there cannot be good. The faces that go on smoothly from there get a layer of hexahedra
/// under them, and points inside are moved for good shapes (UntangleMesh). What was, stays where
/// the layer makes nothing better, or a point of it would have no place.
/// @param mesh   faces of the solids; gets the new points.
/// @param cells  get the layer.
/// @return number of hexahedra that were added; failures of UntangleMesh but
/// InvalidTopology.
/// @source  Mitchell, Tautges, "Pillowing doublets", 4th Int. Meshing Roundtable (1995).
Result<int> PadSmoothSurfaces(const CADTopology& model, const FaceMesher& faces,
  const EdgeNodes& nodes, CADMesh& mesh, HexCells& cells, int threads,
  const ProgressCallback& progress);
}
