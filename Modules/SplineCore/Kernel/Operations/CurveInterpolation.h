// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>
#include <knotwork/SplineCore/Status.h>

#include <Eigen/SparseLU>

namespace knotwork
{
/// Interpolation at the Greville points of a space of curves.
class CurveInterpolation
{
public:
  /// @param space  of tensor kind. @return SingularSystem.
  Status Prepare(const SplineSpace<1>& space);

  const PointMatrix& Points() const { return this->At; } ///< n x 1
  const Eigen::SparseMatrix<double>& Matrix() const { return this->Values; }
  /// Control points of the curve with values at the Greville points, a row each.
  PointMatrix Solve(const PointMatrix& values) const;

private:
  PointMatrix At;
  Eigen::SparseMatrix<double> Values;
  Eigen::SparseLU<Eigen::SparseMatrix<double>> Inverse;
};

/// Points of a curve at parameters of its domain, n x 1.
PointMatrix CurvePoints(const Spline<1>& curve, const PointMatrix& parameters);

/// So many parameters inside each span, equally far from each other, n x 1.
PointMatrix ParametersInSpans(const KnotVector& knots, int perSpan);
}
