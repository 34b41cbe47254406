// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "BernsteinCells.h"

#include <Eigen/Core>

namespace knotwork
{
using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

/// Local parameters at which polynomials of a degree are interpolated: one a coefficient, in their
/// order, spaced evenly.
std::vector<std::array<double, 3>> LatticeParameters(CellShape shape, const CellDegree& degree);

/// Bernstein coefficients of polynomials from their values at the lattice.
class LatticeInterpolation
{
public:
  /// @complexity a dense inverse of each factor: of one direction, or of a simplex.
  LatticeInterpolation(CellShape shape, const CellDegree& degree);

  /// @param values  one row a place of the lattice, one column a polynomial.
  LongMatrix Coefficients(const LongMatrix& values) const;
  /// What products of a matrix, coefficients of functions of the given values, with numbers may be
  /// off by, times the numbers' absolute values: rounding of the entries, of products and sums.
  /// @param used  near Coefficients(values).
  /// @param rounding  unit roundoff of products and sums.
  Eigen::MatrixXd Bound(
    const LongMatrix& values, const LongMatrix& used, long double rounding = 0x1p-53L) const;

private:
  std::vector<LongMatrix> Collocation; ///< of every factor, the fastest first
  std::vector<LongMatrix> Inverse;
};
}
