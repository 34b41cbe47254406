// SPDX-License-Identifier: BSD-3-Clause
// Points of a boundary on a target, private to the kernel.
#pragma once
#include "CurvedTetrahedra.h"

namespace knotwork
{
/// Puts the points of a boundary on a target: edges between triangles on different faces, or with
/// an angle between them, that lie along a curve of the target belong on it; corners where such
/// edges end, or those of several curves meet, on its corners. A point that would move farther than
/// half of its edge (a corner: of the shortest one) stays where it is.
/// @param boundary  triangles of the boundary, of the lattice's corners.
/// @return the target's errors.
Status PlaceOnTarget(const FitTarget& target, const std::vector<std::array<int, 3>>& boundary,
  const NodeLattice& lattice, const PointMatrix& corners, int threads, CurvedNodes& nodes);

/// Largest distance of points of a boundary from a target, at ten places of each triangle.
/// @param lattice  of order 1 for straight triangles.
/// @param points  of the lattice.
Result<double> FarthestFromTarget(const FitTarget& target,
  const std::vector<std::array<int, 3>>& boundary, const NodeLattice& lattice,
  const PointMatrix& points, int threads);
}
