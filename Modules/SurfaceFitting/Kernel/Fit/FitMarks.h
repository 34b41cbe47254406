// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FitDivision.h"
#include "FitSpaces.h"
#include "PointDistances.h"

namespace knotwork
{
/// The elements that an iteration splits, ascending, by FitParams::Threshold and Directions.
std::vector<SplitMark> MarkElements(const FitState& state, const ElementFunctions& functions,
  const FitPoints& points, const std::vector<ElementErrors>& errors, const FitParams& params,
  const FitDivision& division, int iteration);

/// Whether every point outside is in the place of another one, up to rounding, whose values are so
/// different that no surface meets both. Points given several times with equal values do not
/// contradict, nor do those that only elements smaller than FitParams::MinElementSize would part.
/// Of several processes each answers for its points.
bool PointsContradict(const FitState& state, const FitPoints& points,
  const std::vector<ElementErrors>& errors, const FitParams& params);

/// Whether all points outside lie on held edges of the start, up to FitParams::MinElementSize. Of
/// several processes each answers for its points.
bool PointsAreHeld(const FitState& state, const FitPoints& points,
  const std::vector<ElementErrors>& errors, const FitParams& params);

/// Gives points outside their tolerance more weight in least squares where that is likely to bring
/// them inside without a split: they are few and not far outside. An iteratively reweighted fit
/// goes from least squares towards the smallest largest distance.
/// @return elements of these points; empty when it is not worthwhile.
/// @source  Lawson 1961; Rice, Usow, Math. Comp. 22 (1968) 118-127.
std::vector<int> ReweightPoints(
  const std::vector<ElementErrors>& errors, int perElement, FitPoints& points);
}
