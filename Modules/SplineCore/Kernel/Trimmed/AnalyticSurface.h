// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>

namespace knotwork
{
/// Surfaces that CAD files hold as such, the simpler ones first.
enum class SurfaceType
{
  Plane = 0,
  Cylinder,
  Sphere,
  Cone,
  Torus,
  FreeForm
};
inline constexpr int NumSurfaceTypes = 6;

/// "plane", "cylinder", ...
const char* ToString(SurfaceType type);

/// An unbounded plane, cylinder, sphere, cone (one nappe) or torus.
struct AnalyticSurface
{
  SurfaceType Type = SurfaceType::FreeForm;
  /// In the plane; on the axis; the centre of a sphere or torus.
  Eigen::Vector3d Point = Eigen::Vector3d::Zero();
  /// Of length 1: the plane's normal, the axis.
  Eigen::Vector3d Axis = Eigen::Vector3d::UnitZ();
  double Radius = 0.0;      ///< of a cone beside Point, of a torus that of the circle of centres
  double MinorRadius = 0.0; ///< torus: of the circle that turns
  double Angle = 0.0;       ///< cone: between axis and rulings, radians; Radius grows along Axis

  /// Signed distance, positive outside, of a plane where Axis points to. 0 of FreeForm.
  double Distance(const Eigen::Vector3d& point) const;
  /// Gradient of Distance: of length 1, or 0 on an axis.
  Eigen::Vector3d Normal(const Eigen::Vector3d& point) const;
};
}
