// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FeatureEdges.h"

namespace knotwork
{
/// Joins regions that are too small with neighbours, the smallest first, by taking the marks
/// between the two away: with the neighbour of the largest sum of length over angle of the common
/// edges, which is long or blunt.
/// @param isSmall  one a region of `labels`. A region that small ones have joined is small no more,
///        unless `stays` of it and theirs is true.
/// @param kept  edges that regions are not joined across.
/// @return how many regions have joined others.
/// @complexity O(n log n).
int JoinRegions(const SurfaceParts& parts, const EdgeAngle& angle, const RegionLabels& labels,
  const std::vector<char>& isSmall, const std::function<bool(double area, bool allSmall)>& stays,
  const EdgeMarks& kept, EdgeMarks& marks);
}
