// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ElementFunctions.h"
#include "FitPoints.h"

namespace knotwork
{
/// One-sided fits. A surface on one side of its points and no farther away than their tolerances
/// lies in a band; within half the tolerance of the band's middle it is in it. So such a fit is one
/// to moved points.

/// Widths of bands that have a smooth surface in them: the smallest of the tolerances around a
/// point. Middles of bands with widths that change from point to point would be noise.
/// @param parameters  n x 2, in the domain. @param tolerances  n.
std::vector<double> EvenBands(const PointMatrix& parameters, const ParametricBox<2>& domain,
  const std::vector<double>& tolerances);

/// Moves the points to the middle of their bands and halves the tolerances.
/// @param bands  n, by the rows of the cloud.
void MoveToBands(FitSide side, const std::vector<double>& bands, FitPoints& points);

/// The points and tolerances as they were.
void MoveFromBands(
  const PointCloud& cloud, const std::vector<double>& tolerances, FitPoints& points);

/// Moves coefficients so that no point (outliers left out) is on the wrong side, nor would be by
/// the rounding of another evaluation, as little as one pass can: all functions on an element with
/// such points by the largest distance there. Their sum is 1, so the surface moves at least as far
/// on the element, and nowhere to the wrong side.
/// @pre points.Distance are the distances of points as they were.
void ShiftToSide(FitSide side, const ElementFunctions& functions, const FitPoints& points,
  PointMatrix& coefficients);
}
