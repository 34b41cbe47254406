// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <Eigen/SparseCore>

#include <memory>
#include <vector>

namespace knotwork
{
/// Sparse Cholesky factorization of a symmetric positive definite matrix: CHOLMOD (supernodal)
/// where the build has it, Eigen's simplicial LDL^T elsewhere.
class SparseCholesky
{
public:
  SparseCholesky();
  ~SparseCholesky();
  SparseCholesky(const SparseCholesky&) = delete;
  SparseCholesky& operator=(const SparseCholesky&) = delete;

  /// @param lower  the lower triangle, compressed. May be called again; the order of elimination
  ///        is kept when the pattern is the same.
  /// @return SingularSystem when the matrix is not positive definite.
  Status Factorize(const Eigen::SparseMatrix<double>& lower);
  /// Replaces right-hand sides, one a column, by the solutions.
  void Solve(Eigen::MatrixXd& sides) const;

private:
  struct Solver;
  std::unique_ptr<Solver> Factor;
};

/// Solves one system of equations. @param lower  entries of the lower triangle; those of one place
/// are summed. @param sides  right-hand sides, one a column; they become the solutions.
Status SolvePositive(const std::vector<Eigen::Triplet<double>>& lower, Eigen::MatrixXd& sides);
}
