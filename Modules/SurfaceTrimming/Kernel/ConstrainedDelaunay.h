// SPDX-License-Identifier: BSD-3-Clause
// Private to the triangulation of faces.
#pragma once
#include "PlanarRegion.h"
#include <knotwork/SplineCore/Status.h>

namespace knotwork
{
/// Constrained Delaunay triangulation of the convex hull of points, counterclockwise. One of two
/// sources implements it: ConstrainedDelaunay.cxx by CGAL with exact predicates (and a symbolic
/// perturbation where points are cocircular), ConstrainedDelaunayPermissive.cxx by
/// FlipTriangulation for builds without libraries under the GPL. The result depends on the points
/// and segments alone.
/// @param segments  edges that the triangulation must have. @pre FindCrossings finds none; a point
/// on a segment is one of its ends.
/// @return InvalidTopology when that does not hold or no triangle exists.
/// @complexity O(n log n) for points in general position.
Result<std::vector<std::array<int, 3>>> ConstrainedDelaunay(
  const std::vector<PlanarPoint>& points, const std::vector<PlanarSegment>& segments);
}
