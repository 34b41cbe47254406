// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>

#include <memory>

namespace knotwork
{
class SurfaceProfile;

/// Surfaces that CAD files hold as such, the simpler ones first; then free form, and what a profile
/// of any form makes.
enum class SurfaceType
{
  Plane = 0,
  Cylinder,
  Sphere,
  Cone,
  Torus,
  FreeForm,
  Extrusion, ///< a profile moved along the axis
  Revolution ///< a profile turned about the axis
};
inline constexpr int NumSurfaceTypes = 8;

/// "plane", "cylinder", ...
const char* ToString(SurfaceType type);

/// Whether a surface has a profile.
inline bool HasProfile(SurfaceType type)
{
  return type == SurfaceType::Extrusion || type == SurfaceType::Revolution;
}

/// An unbounded plane, cylinder, sphere, cone (one nappe) or torus, or the surface of a profile
/// that goes on straight at its ends.
struct AnalyticSurface
{
  SurfaceType Type = SurfaceType::FreeForm;
  /// In the plane; on the axis; the centre of a sphere or torus; the origin of a profile.
  Eigen::Vector3d Point = Eigen::Vector3d::Zero();
  /// Of length 1: the plane's normal, the axis, the direction of an extrusion.
  Eigen::Vector3d Axis = Eigen::Vector3d::UnitZ();
  double Radius = 0.0;      ///< of a cone beside Point, of a torus that of the circle of centres
  double MinorRadius = 0.0; ///< torus: of the circle that turns
  double Angle = 0.0;       ///< cone: between axis and rulings, radians; Radius grows along Axis
  std::shared_ptr<const SurfaceProfile> Profile; ///< of an extrusion or revolution

  /// Signed distance, positive outside, of a plane where Axis points to, of a profile as its
  /// Distance. 0 of FreeForm.
  double Distance(const Eigen::Vector3d& point) const;
  /// Gradient of Distance: of length 1, or 0 on an axis.
  Eigen::Vector3d Normal(const Eigen::Vector3d& point) const;
  /// A point in the plane of the profile: of an extrusion along Across and Axis x Across, of a
  /// revolution from the axis and along it.
  Eigen::Vector2d InProfile(const Eigen::Vector3d& point) const;
};
}
