// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SurfaceFeatures/Contours.h>

namespace knotwork
{
/// A component of a level as a cubic spline curve.
struct ContourCurve
{
  int Component = 0; ///< index in ContourSet::Components
  /// Degree 3, knots 0, 1, 2, ... of multiplicity 3 (4 where the parameters jump: seams, and all
  /// borders of elements without a domain). Control points: the parameters u and v, then the
  /// positions in space.
  Spline<1> Curve;
  double MaxError = 0.0;      ///< proved bound of |value - level| on the parameter curve
  double SpaceDistance = 0.0; ///< proved bound of |curve in space - surface(parameter curve)|
};

/// Spline curves in the place of the straight pieces of contours: Hermite cubics along the contour,
/// as long as the tolerance is proved, from the Bernstein form of the value along them, else halved
/// at the contour's own points, at last straight. Tangents are continuous where the value is C^1
/// and no piece is straight. With ChordTolerance > 0 the distance in space obeys it likewise
/// wherever a halving is left.
/// @param params  those of TraceContours. @return DimensionMismatch for components that the surface
/// has not. @complexity O(points of the contours (p + 1)^3), each at most a few times.
Result<std::vector<ContourCurve>> FitContourCurves(
  const BezierForm<2>& form, const ContourSet& contours, const ContourParams& params);
}
