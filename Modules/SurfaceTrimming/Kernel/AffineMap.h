// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineCore/Types.h>

namespace knotwork
{
/// x -> x * Linear + Shift, points as rows.
struct AffineMap
{
  Eigen::Matrix3d Linear = Eigen::Matrix3d::Identity();
  Eigen::RowVector3d Shift = Eigen::RowVector3d::Zero();
  double MaxResidual = 0.0; ///< largest distance between a point of `to` and its image

  PointMatrix Apply(const PointMatrix& points) const
  {
    return (points * this->Linear).rowwise() + this->Shift;
  }
};

/// The affine map that carries the rows of `from` to those of `to` best, in the sense of least
/// squares. Directions in which `from` does not extend (beyond 1e-9 of its size) are mapped to 0.
/// @return SizeMismatch unless both are n x 3 with the same n; EmptyInput; NonFiniteInput.
Result<AffineMap> FitAffineMap(const PointMatrix& from, const PointMatrix& to);
}
