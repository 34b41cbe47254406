// SPDX-License-Identifier: BSD-3-Clause
#include "ConstrainedDelaunay.h"
#include "FlipTriangulation.h"

namespace knotwork
{
Result<std::vector<std::array<int, 3>>> ConstrainedDelaunay(
  const std::vector<PlanarPoint>& points, const std::vector<PlanarSegment>& segments)
{
  return FlipTriangulation(points, segments);
}
}
