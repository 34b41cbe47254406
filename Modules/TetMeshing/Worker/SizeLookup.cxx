// SPDX-License-Identifier: BSD-3-Clause
#include "SizeLookup.h"

#include <Eigen/LU>

#include <cmath>

namespace knotwork
{
SizeLookup::SizeLookup(
  std::vector<double> points, std::vector<int> corners, std::vector<double> lengths)
  : Points(std::move(points)), Corners(std::move(corners)), Lengths(std::move(lengths))
{
  const std::size_t count = this->Corners.size() / 4;
  PointMatrix lower(static_cast<Eigen::Index>(count), 3);
  PointMatrix upper = lower;
  for (std::size_t c = 0; c < count; ++c)
  {
    const auto row = static_cast<Eigen::Index>(c);
    lower.row(row) = this->Corner(c, 0).transpose();
    upper.row(row) = lower.row(row);
    for (std::size_t k = 1; k < 4; ++k)
    {
      lower.row(row) = lower.row(row).cwiseMin(this->Corner(c, k).transpose());
      upper.row(row) = upper.row(row).cwiseMax(this->Corner(c, k).transpose());
    }
  }
  this->Tree = BoxTree(lower, upper);
}

Eigen::Vector3d SizeLookup::Corner(std::size_t cell, std::size_t k) const
{
  return Eigen::Map<const Eigen::Vector3d>(
    this->Points.data() + 3 * static_cast<std::size_t>(this->Corners[4 * cell + k]));
}

double SizeLookup::At(const Eigen::Vector3d& point) const
{
  constexpr double Rounding = 1e-9;
  double least = HUGE_VAL;
  this->Tree.ForNear(point.data(), point.data(),
    [&](int item)
    {
      const auto cell = static_cast<std::size_t>(item);
      const Eigen::Vector3d origin = this->Corner(cell, 0);
      Eigen::Matrix3d edges;
      edges << this->Corner(cell, 1) - origin, this->Corner(cell, 2) - origin,
        this->Corner(cell, 3) - origin;
      const Eigen::Vector3d shares = edges.partialPivLu().solve(point - origin);
      const double first = 1.0 - shares.sum();
      if (std::min(shares.minCoeff(), first) >= -Rounding)
      {
        const double* lengths = this->Lengths.data() + 4 * cell;
        least = std::min(least, first * lengths[0] + shares.dot(Eigen::Vector3d(lengths + 1)));
      }
    });
  return least;
}
}
