// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineCore/Types.h>

#include <vector>

namespace knotwork
{
/// s(u) = sum_i a_i phi(|u - c_i|) + b_0 + b_1 u_0 + b_2 u_1, phi(r) = r^2 ln r, sum a_i (1, c_i) =
/// 0: of all surfaces through given points that with the least thin-plate energy over the whole
/// plane.
/// @source  Duchon, RAIRO Anal. Num. 10 (1976) 5-12; Wendland, Scattered Data Approximation.
class RadialSurface
{
public:
  /// Through all points.
  /// @param parameters  n x 2, no two equal, not all on a line. @param points  n x c.
  /// @return SingularSystem.
  /// @complexity n^3 / 3 (dense Cholesky factorization on the null space of the affine maps).
  static Result<RadialSurface> Interpolate(
    const PointMatrix& parameters, const PointMatrix& points, int threads);

  /// Values at parameters, n x c. @complexity O(n centres).
  PointMatrix Evaluate(const PointMatrix& parameters, int threads) const;

private:
  Eigen::RowVector2d Origin = Eigen::RowVector2d::Zero();
  double Scale = 1.0;
  Eigen::MatrixXd Centres;      ///< n x 2, shifted and scaled
  Eigen::MatrixXd Coefficients; ///< n x c
  Eigen::MatrixXd Affine;       ///< 3 x c
};

/// Rows whose interpolation is within the tolerance at all others, as few as a greedy choice finds:
/// first far from each other, then, doubling their number, where the surface is off most; all rows
/// when there are at most maxCentres. Of rows with equal parameters one is taken.
/// @return the rows, ascending; failures of Interpolate.
struct RadialFit
{
  std::vector<int> Rows;
  RadialSurface Surface;
};
Result<RadialFit> FitRadialSurface(const PointMatrix& parameters, const PointMatrix& points,
  int maxCentres, double tolerance, int threads);
}
