// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SurfaceTrimming/SurfaceRecognition.h>

/// Private to ModelMesh: whether regions beside free form are what they were taken for.
namespace knotwork
{
constexpr double SharpDegrees = 25.0;  ///< between triangles, of a sharp edge
constexpr double ExactDistance = 0.02; ///< of the tolerance: distances that are none

/// Whether distances from the surface are nothing, or those of noise, or the region ends mostly at
/// sharp edges; false of few points.
/// @param noise  with which regions were grown: where less than the tolerance did as well for the
/// whole mesh, its regions do not end for want of a larger one.
bool IsOnItsSurface(const DiscMesh& surface, const RecognizedRegion& region, bool endsAtEdges,
  double tolerance, double noise);

/// Makes regions free whose points do not lie on their surface as points with noise do: distances
/// of neighbours are alike (a smooth shape that leaves the surface) or go up to the tolerance, and
/// the region does not end at sharp edges; or there are hardly more points than the surface has
/// parameters.
/// @return the share of the area that is still of analytic surfaces.
double ReleaseDoubtfulRegions(const DiscMesh& surface, SurfaceRecognition& recognition);

/// Whether more than half of a mesh is covered by surfaces on which its points lie neither exactly
/// nor as points with noise do: pieces of a smooth shape.
bool IsPatchwork(const DiscMesh& surface, const SurfaceRecognition& recognition);
}
