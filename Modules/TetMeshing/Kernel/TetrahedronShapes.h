// SPDX-License-Identifier: BSD-3-Clause
// Measures of straight tetrahedra, private to the kernel.
#pragma once
#include <knotwork/SplineCore/Types.h>

#include <vector>

namespace knotwork
{
struct TetrahedronShapes
{
  double MinDihedral = 180.0; ///< degrees
  double MaxDihedral = 0.0;
  double WorstRadiusEdgeRatio = 0.0; ///< circumradius over shortest edge
  double Volume = 0.0;               ///< sum of the signed volumes
};

TetrahedronShapes MeasureTetrahedra(
  const PointMatrix& points, const std::vector<std::array<int, 4>>& cells);
}
