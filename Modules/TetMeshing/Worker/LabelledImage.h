// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ImageMeshParts.h"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace knotwork
{
/// Labels of the points of a box, by values on a grid; 0 outside of the solid and of the box.
class LabelledImage
{
public:
  /// @param values  one a point, x first.
  LabelledImage(const std::array<int, 3>& size, const Eigen::Vector3d& spacing,
    std::vector<double> values, ImageSolid solid, double level);

  /// Of the interpolated value, or the label that has most of the weight of the eight points
  /// around.
  int LabelAt(const Eigen::Vector3d& point) const;
  Eigen::Vector3d Upper() const; ///< corner of the box

  /// Parts of the boundary that no other may be found from: for each piece of one label some pairs
  /// of a point of it and a point of another label, or outside of the box.
  std::vector<std::array<Eigen::Vector3d, 2>> Crossings() const;

private:
  using Place = std::array<int, 3>;
  int LabelOf(double value) const;
  std::size_t IndexOf(const Place& at) const;
  Place PlaceOf(std::size_t index) const;
  bool IsIn(const Place& at) const;
  Eigen::Vector3d PointOf(const Place& at) const;

  std::array<int, 3> Size;
  Eigen::Vector3d Spacing;
  std::vector<double> Values;
  ImageSolid Solid;
  double Level;
};
}
