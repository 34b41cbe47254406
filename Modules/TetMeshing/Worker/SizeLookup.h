// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BoxTree.h>

#include <Eigen/Core>

#include <array>
#include <vector>

namespace knotwork
{
/// Lengths of edges on a background grid of tetrahedra.
class SizeLookup
{
public:
  /// @param points  three coordinates each. @param corners, lengths  four of a tetrahedron.
  SizeLookup(std::vector<double> points, std::vector<int> corners, std::vector<double> lengths);

  bool IsEmpty() const { return this->Corners.empty(); }
  /// The least length at a point, linear in each tetrahedron that has it; infinite outside.
  double At(const Eigen::Vector3d& point) const;

private:
  Eigen::Vector3d Corner(std::size_t cell, std::size_t k) const;

  std::vector<double> Points;
  std::vector<int> Corners;
  std::vector<double> Lengths;
  BoxTree Tree;
};
}
