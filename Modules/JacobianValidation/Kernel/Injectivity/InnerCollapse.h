// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "BoundaryInjectivity.h"

/// Private to the injectivity proof: edges inside of patches that are points.
namespace knotwork
{
/// Edges are allowed to be points on the boundary; inside of a patch all of the edge's points,
/// which are points of the map, have one image.
/// @return cell and two of its corners; -1: there is none.
std::array<int, 3> FindInnerCollapse(const BernsteinCells& cells, const CellComplex& complex,
  const JacobianCertificate& certificate, double tolerance);
}
