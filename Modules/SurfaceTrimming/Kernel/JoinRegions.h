// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SurfaceGrowth.h"

/// Private to RecognizeSurfaces: regions that are pieces of one surface.
namespace knotwork
{
/// Growth from few noisy facets leaves pieces: neighbours across smooth borders become one where
/// one plane, cylinder, sphere, cone or torus is within the tolerance of both, and the points of
/// each are about as near to it as to the surfaces that they have. What lies exactly on its surface
/// joins nothing but what does so, too. A strip, a plane of few points beside a larger
/// region that lies on its own surface but roughly, says nothing: the tolerance decides.
/// @param growth  with the tolerance as its noise.
/// @param regions  those that went over to others are left without clusters.
/// @param tolerance  that was asked for.
void JoinPieces(const SurfaceGrowth& growth, const FacetClusters& facets, double tolerance,
  std::vector<GrownRegion>& regions, std::vector<int>& regionOfCluster);

/// A surface with a profile of any form lies in pieces on planes, cylinders and tori, but for
/// distances that are no noise: regions that pass over into each other smoothly, and whose points
/// lie nearer to one extrusion or revolution than to their own surfaces, become one. Exact
/// planes and cylinders stay what they are, but for strips of few points.
void JoinAlongProfiles(const SurfaceGrowth& growth, const FacetClusters& facets, double tolerance,
  std::vector<GrownRegion>& regions, std::vector<int>& regionOfCluster);
}
