// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FitDivision.h"
#include "FitPoints.h"

namespace knotwork
{
/// Student's t-distribution around 0 that makes given distances most likely.
struct TDistribution
{
  double Scale = 0.0;
  double DegreesOfFreedom = 0.0; ///< in [0.5, 200]; 200 is as good as normal
  double LogLikelihood = 0.0;
};

/// Distances of the points of all processes that are no outliers, counted in classes of a relative
/// width of 1/16 down to 2^-60 of the largest, so the fit's cost is two passes over the points.
/// Without points all is 0.
/// @source  Liu, Rubin, Statistica Sinica 5 (1995) 19-39 (ECME); Skytt, Dokken, "Scattered data
/// approximation by LR B-spline surfaces" (information criteria for a stop).
TDistribution FitTDistribution(
  const FitPoints& points, int threads, const FitDivision& division = {});
}
