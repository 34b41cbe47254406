// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>

#include <cmath>

namespace knotwork
{
/// Angle between two directions of any length, [0, pi]: exact to rounding near 0 and pi too, where
/// an arc cosine is not. 0 when one of them is 0.
inline double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  return std::atan2(a.cross(b).norm(), a.dot(b));
}
}
