// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ChartSamples.h"
#include <knotwork/SplineCore/Spline.h>
#include <knotwork/SplineCore/Status.h>

/// Splines by values at the Greville points of a net, first direction fastest.
namespace knotwork
{
/// Control points of the spline that takes the values at the Greville points.
/// @complexity O(n^3) a direction with n functions in it.
/// @source  de Boor, A Practical Guide to Splines, chapter XVII (tensor products).
PointMatrix InterpolateAtGreville(const NetKnots& knots, const PointMatrix& values);

/// Centres of all elements, n x 2.
PointMatrix ElementCentres(const NetKnots& knots);

/// A spline on a net, or TooLarge.
Result<Spline<2>> SplineOnNet(const NetKnots& knots, PointMatrix control);
}
