// SPDX-License-Identifier: BSD-3-Clause
// Private to the triangulation of faces.
#pragma once
#include "PlanarRegion.h"
#include <knotwork/SplineCore/Status.h>

namespace knotwork
{
/// Constrained Delaunay triangulation as ConstrainedDelaunay.h asks for, without a library: points
/// are inserted one by one in rows of alternating direction, segments by flips of the edges that
/// they cross, all questions answered exactly.
/// @source  Lawson, in Mathematical Software III (1977) 161-194; Sloan, Computers & Structures 47
/// (1993) 441-450.
/// @complexity O(n log n) for points without large clusters.
Result<std::vector<std::array<int, 3>>> FlipTriangulation(
  const std::vector<PlanarPoint>& points, const std::vector<PlanarSegment>& segments);
}
