// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SurfaceSides.h"

namespace knotwork
{
/// Standard deviation of the points of a surface from the shape that is meant, across it: the
/// smaller one of two robust estimates.
///
/// - Of every edge, the distance of its two triangles' four points from one plane: 0 within the
/// flat
///   faces of a clean mesh and along the rulings of its cylinders, however coarse it is, and the
///   same everywhere on a sphere.
/// - Of every point, the distance from a quadric through the points around it (two rings, without
///   hubs of more than 30 edges; around those one): next to 0 on a clean mesh that is curved all
///   over, however few of its triangles are flat.
///
/// Both are divided by what noise of unit size makes of them. Of their distribution, which sharp
/// edges and bends have a part in, the core is taken: the shortest interval of a fifth of the
/// values gives a first centre and deviation, medians of what lies within 2.5 deviations the next
/// ones, in turn.
/// @param threads  0: all cores; the result does not depend on it.
/// @return 0 where neither can be measured; Aborted.
/// @complexity O(n log n).
Result<double> EstimateNoise(
  const SurfaceParts& parts, int threads = 0, const ProgressCallback& progress = {});
}
