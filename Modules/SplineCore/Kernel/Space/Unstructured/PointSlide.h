// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>

namespace knotwork
{
/// Where the points of a mesh may move. Points have 3 coordinates.
class PointSlide
{
public:
  virtual ~PointSlide() = default;
  virtual bool IsFixed(int point) const = 0;
  /// Closest place that the point may be at.
  virtual Eigen::RowVector3d Nearest(int point, const Eigen::RowVector3d& at) const = 0;
  /// Directions that the point may move in from where it is, as orthonormal columns.
  virtual Eigen::Matrix<double, 3, Eigen::Dynamic> Directions(
    int point, const Eigen::RowVector3d& at) const = 0;
};
}
