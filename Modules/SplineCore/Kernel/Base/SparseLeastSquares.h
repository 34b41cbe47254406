// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/SparseCore>

namespace knotwork
{
/// A solution with what it took.
struct SparseSolution
{
  Eigen::MatrixXd Value; ///< A.cols() x b.cols()
  std::size_t FactorEntries = 0;
  int Steps = 0;
};

/// Solves the least-squares problems A x = b, one a column of b, for a sparse A of any rank.
///
/// Of all solutions it takes the one with the least sum of squares of x_i |A_i|, A_i the columns of
/// A; x_i is 0 where A_i is. Columns are brought to length one, the normal equations shifted by
/// 1e-11 and factorized, and the solution refined with residuals of A itself until it gains no
/// more. Where b is in the range of A, the residual is rounding as long as no singular value of the
/// scaled A but zeros is below 1e-6 (B-splines of degree 7: above 1e-5).
/// @pre everything is finite. @param threads  0 = all cores; the result is the same for any number.
/// @complexity sum of the squares of the rows' entries, plus a sparse Cholesky factorization in
/// minimum-degree order: about n log n entries for n functions of two parameters.
/// @source  Riley, Math. Tables Aids Comput. 9 (1955) 96-101 (shift and refinement); Hanke,
/// Groetsch, J. Optim. Theory Appl. 98 (1998) 37-53 (iterated Tikhonov regularization).
SparseSolution SolveSparseLeastSquares(
  const Eigen::SparseMatrix<double, Eigen::RowMajor>& a, const Eigen::MatrixXd& b, int threads);
}
