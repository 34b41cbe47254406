// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>

#include <vector>

namespace knotwork
{
/// Centre + cos(a) X + sin(a) Y for a from Begin on, through Sweep (radians, of any sign).
struct CircularArc
{
  Eigen::Vector3d Centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d X = Eigen::Vector3d::UnitX(); ///< of the length of the radius
  Eigen::Vector3d Y = Eigen::Vector3d::UnitY();
  double Begin = 0.0;
  double Sweep = 0.0;

  double Radius() const { return this->X.norm(); }
  /// At a share of the sweep.
  Eigen::Vector3d Point(double share) const;
  double AngleOf(const Eigen::Vector3d& point) const;
  /// Of a point from the whole circle.
  double Distance(const Eigen::Vector3d& point) const;
};

/// The arc along points in a row, three at least, less than half a turn from one to the next:
/// algebraic least squares in the plane of least squares. Where the first and the last point are
/// equal it is the whole circle.
/// @return false: the points lie on a line, within a thousandth of their extent.
/// @source Kasa, IEEE Trans. Instrumentation and Measurement 25 (1976) 8.
bool FitCircle(const std::vector<Eigen::Vector3d>& points, CircularArc& arc);
}
