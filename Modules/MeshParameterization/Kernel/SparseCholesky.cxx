// SPDX-License-Identifier: BSD-3-Clause
#include "SparseCholesky.h"

#ifdef KNOTWORK_HAS_CHOLMOD
#include <Eigen/CholmodSupport>
#else
#include <Eigen/SparseCholesky>
#endif

namespace knotwork
{
struct SparseCholesky::Solver
{
#ifdef KNOTWORK_HAS_CHOLMOD
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> Method;
#else
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> Method;
#endif
  Eigen::Index Rows = -1;
  Eigen::Index NonZeros = -1;
};

SparseCholesky::SparseCholesky() : Factor(std::make_unique<Solver>())
{
#ifdef KNOTWORK_HAS_CHOLMOD
  this->Factor->Method.cholmod().print = 0; // messages are the caller's
#endif
}

SparseCholesky::~SparseCholesky() = default;

Status SparseCholesky::Factorize(const Eigen::SparseMatrix<double>& lower)
{
  if (lower.rows() != this->Factor->Rows || lower.nonZeros() != this->Factor->NonZeros)
  {
    this->Factor->Method.analyzePattern(lower);
    this->Factor->Rows = lower.rows();
    this->Factor->NonZeros = lower.nonZeros();
  }
  this->Factor->Method.factorize(lower);
  bool positive = this->Factor->Method.info() == Eigen::Success;
#ifndef KNOTWORK_HAS_CHOLMOD
  positive = positive && this->Factor->Method.vectorD().minCoeff() > 0.0;
#endif
  if (!positive)
  {
    return { ErrorCode::SingularSystem, "a matrix of the mesh is not positive definite" };
  }
  return {};
}

void SparseCholesky::Solve(Eigen::MatrixXd& sides) const
{
  sides = this->Factor->Method.solve(sides).eval();
}

Status SolvePositive(const std::vector<Eigen::Triplet<double>>& lower, Eigen::MatrixXd& sides)
{
  Eigen::SparseMatrix<double> matrix(sides.rows(), sides.rows());
  matrix.setFromTriplets(lower.begin(), lower.end());
  SparseCholesky cholesky;
  const Status status = cholesky.Factorize(matrix);
  if (status)
  {
    cholesky.Solve(sides);
  }
  return status;
}
}
