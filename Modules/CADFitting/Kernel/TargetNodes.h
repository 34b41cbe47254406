// SPDX-License-Identifier: BSD-3-Clause
// Points of facets on a target, private to the kernel.
#pragma once
#include "CurvedNodes.h"

namespace knotwork
{
/// Puts the points of facets on a target: edges between facets on different faces, or with an angle
/// between them, that lie along a curve of the target belong on it; corners where such edges end,
/// or those of several curves meet, on its corners. A point that would move farther than half of
/// its edge (a corner: of the shortest one) stays where it is.
/// @param facets  faces of the lattice. @param corners  of the elements.
/// @param unmatched  gets the number of curves without an edge.
/// @return the target's errors; InvalidParameter for facets whose middles are farther from the
/// target, in the mean, than a share of the diagonal of their closest points.
Status PlaceOnTarget(const FitTarget& target, const std::vector<int>& facets,
  const NodeLattice& lattice, const PointMatrix& corners, const CurvedElementsParams& params,
  CurvedNodes& nodes, PlacedPoints& placed, int& unmatched);

/// Distances of facets from a target, at places that are no points of the lattice, and at the
/// middle.
/// @param points  of the lattice.
/// @param farthest  gets the largest of every facet.
Result<DistanceSummary> MeasureFacets(const FitTarget& target, const std::vector<int>& facets,
  const NodeLattice& lattice, const PointMatrix& points, int threads,
  std::vector<double>& farthest);
}
