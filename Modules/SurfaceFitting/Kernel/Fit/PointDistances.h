// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ElementFunctions.h"
#include "FitDivision.h"
#include "FitPoints.h"

namespace knotwork
{
/// The distances of the points of an element, outliers (weight 0) left out.
struct ElementErrors
{
  double Max = 0.0;   ///< of absolute values
  double Ratio = 0.0; ///< largest distance / tolerance
  double Sum = 0.0;   ///< of absolute values
  double Squares = 0.0;
  std::size_t NumOutside = 0;
  std::size_t Count = 0;
};

/// Measures all points: fills points.Distance, value - surface with one measured component, else
/// the length of the difference of the measured ones.
/// @param numMeasured  of the components. @return one an element, of those of all processes.
std::vector<ElementErrors> MeasureDistances(const SplineSpace<2>& space,
  const ElementFunctions& functions, const PointMatrix& coefficients, int numMeasured,
  const FitDivision& division, FitPoints& points, int threads);

/// How much the distances of an element vary along each direction: the sum over eight slices across
/// it of weight * (mean distance)^2, which new lines across the direction could take away. The
/// measured components count alike.
RealArray<2> SplitGains(const SplineSpace<2>& space, const ElementFunctions& functions,
  const PointMatrix& coefficients, int numMeasured, const FitPoints& points, int e);
}
