// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "DomainParameterization.h"

#include <functional>

namespace knotwork
{
/// Measures of a map's patches at samples^Dim equally spaced parameters each, ends included.
/// @param area  S (a patch), for the ratios.
/// @param goOn  asked now and then; when it says no the measures are of what was seen.
/// @complexity tensor-product spaces: sums factorized direction by direction.
template <int Dim>
DomainMetrics MeasureMaps(const std::vector<Spline<Dim>>& patches, double area, int samples,
  const std::function<bool()>& goOn = {});
}
