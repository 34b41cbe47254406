// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <Eigen/SparseCore>

namespace knotwork
{
struct SmallEigenpairs
{
  Eigen::VectorXd Values;  ///< ascending
  Eigen::MatrixXd Vectors; ///< one a column: orthonormal for the masses, orthogonal to constants
};

/// The smallest eigenvalues of K v = lambda M v beside that of the constant vectors, which K maps
/// to zero. Shift-invert by one Cholesky factorization of K + shift M, block Lanczos with complete
/// reorthogonalization from a fixed seed.
/// @param lower   lower triangle of K, positive semi-definite, every diagonal entry stored.
/// @param masses  diagonal of M, positive. @param shift  positive, below the eigenvalues looked for
///                or not far above them. @param count  [1, n - 2].
/// @return SingularSystem; NotConverged.
/// @source Grimes, Lewis, Simon, SIAM J. Matrix Anal. Appl. 15 (1994) 228-272.
Result<SmallEigenpairs> FindSmallEigenpairs(
  const Eigen::SparseMatrix<double>& lower, const Eigen::VectorXd& masses, double shift, int count);
}
