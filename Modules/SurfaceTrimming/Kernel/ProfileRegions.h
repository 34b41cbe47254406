// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SurfaceGrowth.h"

/// Private to RecognizeSurfaces: regions that are parts of one extrusion or revolution.
namespace knotwork
{
/// A surface with a profile of any form lies in pieces on planes, cylinders and tori, but for
/// distances that are no noise: regions that pass over into each other smoothly, and whose points
/// lie nearer to one extrusion or revolution than to their own surfaces, become one. Exact
/// planes and cylinders stay what they are, but for strips of few points.
/// @param regions  those that went over to others are left without clusters.
/// @param tolerance  that was asked for.
void JoinAlongProfiles(const SurfaceGrowth& growth, const FacetClusters& facets, double tolerance,
  std::vector<GrownRegion>& regions, std::vector<int>& regionOfCluster);
}
