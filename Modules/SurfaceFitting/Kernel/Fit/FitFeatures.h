// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SurfaceFit.h"

namespace knotwork
{
/// Numbers of a regular grid about a fit and its points. @pre size > 0.
/// @complexity O(size^2 + points).
FitFeatures ComputeFeatures(
  const PointCloud& cloud, const SurfaceFit& fit, int numMeasured, int size, int threads);
}
