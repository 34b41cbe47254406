// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FeatureEdges.h"

namespace knotwork
{
/// What decides whether a region is one: sums over its triangles.
struct RegionSums
{
  double Area = 0.0;
  double Patches = 0.0;  ///< area of triangles times that of the patches of their normals
  bool HasKnown = false; ///< some normal is known
  bool AllBand = true;   ///< all triangles are of narrow rows

  void Add(const RegionSums& other);
};

/// Joins regions that are too small with neighbours, the smallest first, by taking the marks
/// between the two away: with the neighbour of the largest sum of length over angle of the common
/// edges, which is long or blunt. What has come about is joined on as long as it is too small.
/// @param sums  one a region of `labels`.
/// @param kept  edges that regions are not joined across.
/// @return how many regions have joined others.
/// @complexity O(n log n).
int JoinRegions(const SurfaceParts& parts, const EdgeAngle& angle, const RegionLabels& labels,
  const std::vector<RegionSums>& sums, const std::function<bool(const RegionSums&)>& isSmall,
  const EdgeMarks& kept, EdgeMarks& marks);
}
