// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "DataTerms.h"

#include <Eigen/IterativeLinearSolvers>

namespace knotwork
{
/// Preconditioner of a fit: incomplete Cholesky factor of its matrix without small couplings.
/// Blocks (f, g) whose norm is below 1 % of the geometric mean of those of f and g are left out;
/// what is left out goes to the diagonal in magnitude, so that the rest stays positive definite.
/// B-splines of far supports couple weakly: two thirds of the blocks go.
/// @source  Lin, More, SIAM J. Sci. Comput. 21 (1999) 24-45 (the factor); Axelsson, Kolotilina,
/// Diagonally compensated reduction, Numer. Linear Algebra Appl. 1 (1994) 155-177.
template <int Dim>
class IncompleteFactor
{
public:
  using Block = Eigen::Matrix<double, Dim, Dim>;

  /// @param truncation  see TruncationMatrix; empty when local functions are the functions.
  /// @param diagonal    blocks of the whole matrix, one a function.
  /// @param scalar      lower triangles in the functions, the same for every coordinate.
  /// @return false when there is no factor.
  bool Compute(const SplineSpace<Dim>& space, const DataTerms<Dim>& data,
    const Eigen::SparseMatrix<double, Eigen::RowMajor>& truncation,
    const std::vector<Block>& diagonal,
    const std::vector<const Eigen::SparseMatrix<double>*>& scalar, int threads);
  PointMatrix Solve(const PointMatrix& right) const;

private:
  Eigen::IncompleteCholesky<double, Eigen::Lower, Eigen::NaturalOrdering<int>> Factor;
};
}
