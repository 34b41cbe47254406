// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Types.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <cmath>

namespace knotwork
{
/// The affine map that brings points of a rim nearest to others, by least squares; of nearly flat
/// rims in their plane, and along its normal by the same scale, or by its opposite (mirrored).
class RimMap
{
public:
  RimMap(const PointMatrix& from, const PointMatrix& to, bool mirrored = false)
  {
    this->Centre = from.colwise().mean().transpose();
    this->Image = to.colwise().mean().transpose();
    const PointMatrix a = from.rowwise() - this->Centre.transpose();
    const PointMatrix b = to.rowwise() - this->Image.transpose();
    const Eigen::Matrix3d moments = a.transpose() * a;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(moments);
    // the two directions of the plane, the widest last
    const Eigen::Matrix<double, 3, 2> plane = axes.eigenvectors().rightCols<2>();
    const Eigen::Vector2d sizes = axes.eigenvalues().tail<2>();
    this->Flat = !(sizes[0] > 1e-12 * sizes[1]);
    const Eigen::Matrix3d product = b.transpose() * a;
    const Eigen::Matrix<double, 3, 2> images = product * plane * sizes.cwiseInverse().asDiagonal();
    const Eigen::Vector3d normal = plane.col(0).cross(plane.col(1));
    const Eigen::Vector3d image = images.col(0).cross(images.col(1));
    const double area = image.norm();
    this->Linear = images * plane.transpose();
    constexpr double LeastDepth = 0.1; ///< of the width, of a rim that is not nearly flat
    if (axes.eigenvalues()[0] > LeastDepth * LeastDepth * sizes[0])
    {
      this->Linear = product * axes.eigenvectors() *
        axes.eigenvalues().cwiseInverse().asDiagonal() * axes.eigenvectors().transpose();
    }
    else if (area > 0.0)
    {
      this->Linear += (mirrored ? -1.0 : 1.0) / std::sqrt(area) * image * normal.transpose();
    }
  }

  bool IsFlat() const { return this->Flat; }
  Eigen::RowVector3d operator()(const Eigen::RowVector3d& point) const
  {
    return (this->Linear * (point.transpose() - this->Centre) + this->Image).transpose();
  }

private:
  Eigen::Vector3d Centre;
  Eigen::Vector3d Image;
  Eigen::Matrix3d Linear;
  bool Flat = false; ///< no plane: the points lie in a line
};
}
