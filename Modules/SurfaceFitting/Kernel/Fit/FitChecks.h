// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FitDivision.h"

namespace knotwork
{
/// What FitSurface says about its arguments.
Status CheckFit(const PointCloud& cloud, const FitParams& params);

/// The domain of a fit: the one asked for, or the box of the parameters of all points (a side
/// without length gets one).
ParametricBox<2> FitDomain(
  const PointCloud& cloud, const FitParams& params, const FitDivision& division);

/// The tolerance of every point. @pre CheckFit is Ok.
std::vector<double> FitTolerances(
  const PointCloud& cloud, const FitParams& params, const FitDivision& division);
}
