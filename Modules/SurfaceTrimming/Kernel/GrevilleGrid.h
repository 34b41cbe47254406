// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ChartSamples.h"
#include <knotwork/SplineCore/Spline.h>
#include <knotwork/SplineCore/Status.h>

/// Splines by values at the crossings of lines, first direction fastest.
namespace knotwork
{
/// Greville abscissae of a net, by direction.
std::array<std::vector<double>, 2> GrevilleLines(const NetKnots& knots);

/// Control points of the spline that takes the values at the crossings.
/// @param lines   one a function, rising, each inside the support of its function.
/// @param values  a row a crossing, first direction fastest, of any number of columns.
/// @complexity O(n m p^2) with n x m functions.
/// @source  de Boor, A Practical Guide to Splines, chapter XVII (tensor products).
PointMatrix InterpolateOnGrid(const NetKnots& knots,
  const std::array<std::vector<double>, 2>& lines, const PointMatrix& values);

/// Centres of all elements, n x 2.
PointMatrix ElementCentres(const NetKnots& knots);

/// A spline on a net, or TooLarge.
Result<Spline<2>> SplineOnNet(const NetKnots& knots, PointMatrix control);
}
