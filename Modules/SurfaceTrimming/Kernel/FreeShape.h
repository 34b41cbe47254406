// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SurfaceGrowth.h"

/// Private to RecognizeSurfaces: dense scans of free shapes are no machined parts, which need not
/// be found out region by region.
namespace knotwork
{
/// Grows regions at 64 places that are spread over the area, until two of them say that there are
/// surfaces: their points lie on them exactly, at least in the inner half of the region, or as
/// points with noise do, or sharp edges bound them. Where a tenth of the area is of such, fewer are
/// met once in a hundred meshes.
/// @return whether fewer were met. False of few facets, which take no time.
/// @param tolerance  with which growth grows.
bool LooksFree(const DiscMesh& surface, const FacetClusters& facets, const SurfaceGrowth& growth,
  double tolerance);
}
