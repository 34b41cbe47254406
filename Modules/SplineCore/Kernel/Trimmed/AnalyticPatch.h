// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/AnalyticSurface.h>
#include <knotwork/SplineCore/Spline.h>

#include <array>

namespace knotwork
{
/// A part of an analytic surface, as the rational spline that it is.
///
/// Parameters of the surface: of a plane lengths along two axes, of an extrusion the profile's
/// parameter and the height; else u is the angle about the axis, and v the height along it
/// (cylinder, cone), the latitude (sphere), the angle of the turning circle, 0 outside (torus), or
/// the profile's parameter (revolution). Angles in radians. S_u x S_v points along the surface's
/// Normal.
///
/// The spline has the same domain. Along angles it has spans of at most 90 degrees, within which
/// its parameter is not the angle, but differs from it by less than a degree.
/// @source Piegl, Tiller, The NURBS Book, chapters 7 and 8 (arcs, surfaces of revolution).
class AnalyticPatch
{
public:
  AnalyticPatch() = default;
  /// @param reference  where u = 0; its part along the axis does not count. If nothing is left of
  /// it, any direction across the axis is taken. An extrusion has its own.
  AnalyticPatch(const AnalyticSurface& surface, const Eigen::Vector3d& reference);

  const AnalyticSurface& Surface() const { return this->Of; }
  bool IsPeriodic(int direction) const;
  Eigen::Vector3d Point(const Eigen::Vector2d& parameters) const;
  /// Of the nearest point of the surface; angles in (-pi, pi]. On an axis u is 0.
  Eigen::Vector2d Parameters(const Eigen::Vector3d& point) const;
  /// The same with angles moved by turns to where they are nearest to a place.
  Eigen::Vector2d ParametersNear(const Eigen::Vector3d& point, const Eigen::Vector2d& place) const;
  /// Where a cone or sphere is a point: v of the lower (index 0) and the upper one. Infinite where
  /// there is none.
  std::array<double, 2> Poles() const;

  /// A range within the profile, if there is one, as far as it goes.
  void SetRange(const Eigen::Vector2d& lower, const Eigen::Vector2d& upper);
  const Eigen::Vector2d& Lower() const { return this->Begin; }
  const Eigen::Vector2d& Upper() const { return this->End; }
  /// The spline over the range.
  Spline<2> MakeSpline() const;
  /// Parameters of the spline where it has the point of parameters of the surface, in the range but
  /// for a span at most.
  Eigen::Vector2d SplineParameters(const Eigen::Vector2d& parameters) const;
  /// The inverse of SplineParameters.
  Eigen::Vector2d SurfaceParameters(const Eigen::Vector2d& splineParameters) const;
  /// Where spans of the spline meet, without the ends.
  std::vector<double> Breaks(int direction) const;

private:
  bool IsAngle(int direction) const;
  int NumSpans(int direction) const;

  AnalyticSurface Of;
  Eigen::Vector3d X = Eigen::Vector3d::UnitX();
  Eigen::Vector3d Y = Eigen::Vector3d::UnitY();
  Eigen::Vector2d Begin = Eigen::Vector2d::Zero();
  Eigen::Vector2d End = Eigen::Vector2d::Ones();
};
}
