// SPDX-License-Identifier: BSD-3-Clause
#include "LinearSolver.h"

#include "SmoothingPreconditioners.h"
#include "TensorPreconditioners.h"

#include <memory>

namespace knotwork
{
namespace
{
Status Factorize(const Eigen::SparseMatrix<double>& lower, Eigen::MatrixXd& sides)
{
  SparseCholesky factor;
  if (const Status status = factor.Factorize(lower); !status)
  {
    return { ErrorCode::SingularSystem,
      "the matrix is not positive definite: functions are dependent, or materials or elements "
      "differ too much" };
  }
  const Eigen::MatrixXd right = sides;
  factor.Solve(sides);
  // one step of refinement: what is left is rounding of the residual
  Eigen::MatrixXd rest = right - lower.selfadjointView<Eigen::Lower>() * sides;
  factor.Solve(rest);
  sides += rest;
  return {};
}

Status CheckDiagonal(const Eigen::VectorXd& diagonal)
{
  return diagonal.minCoeff() > 0.0
    ? Status()
    : Status{ ErrorCode::SingularSystem,
        "the matrix is not positive definite: a function has no part in any element" };
}
}

Status SolveUnknowns(const GalerkinSpace& space, int components, const std::vector<int>& numbers,
  const Eigen::SparseMatrix<double>& lower, const GalerkinParams& params, Eigen::MatrixXd& sides,
  LinearSolverReport& report)
{
  // factors of volumes fill soonest, and fast diagonalization needs few iterations there
  const int limit = space.Knots.size() == 3 ? params.DirectLimit / 10 : params.DirectLimit;
  if (lower.rows() <= limit)
  {
    return Factorize(lower, sides);
  }
  const Eigen::VectorXd diagonal = lower.diagonal();
  if (const Status status = CheckDiagonal(diagonal); !status)
  {
    return status;
  }
  SymmetricMatrix<1> matrix(lower, params.Threads);
  std::unique_ptr<Preconditioner<1>> preconditioner;
  if (!space.Knots.empty())
  {
    report.Preconditioner = "fast diagonalization";
    preconditioner =
      std::make_unique<FastDiagonalization>(space, components, numbers, diagonal, params.Threads);
  }
  else
  {
    report.Preconditioner = "Gauss-Seidel and constants of cells";
    preconditioner = std::make_unique<TwoLevels>(space, components, numbers, lower, matrix);
  }
  UnknownColumns<1> x = sides.col(0);
  const Status status = Iterate(matrix, *preconditioner, { params.Tolerance, params.MaxIterations },
    params.Threads, x, report.Iterations);
  sides.col(0) = x;
  return status;
}

Status SolveMass(const GalerkinSpace& space, const Eigen::SparseMatrix<double>& lower, int threads,
  Eigen::MatrixXd& sides)
{
  constexpr IterationLimits Limits{ 1e-13, 1000 };
  constexpr Eigen::Index Width = 4;
  const Eigen::VectorXd diagonal = lower.diagonal();
  if (const Status status = CheckDiagonal(diagonal); !status)
  {
    return status;
  }
  SymmetricMatrix<Width> matrix(lower, threads);
  std::unique_ptr<Preconditioner<Width>> preconditioner;
  if (!space.Knots.empty())
  {
    preconditioner = std::make_unique<TensorMass>(space, diagonal, threads);
  }
  else
  {
    preconditioner = std::make_unique<OneLevel<Width>>(matrix);
  }
  UnknownColumns<Width> x;
  for (Eigen::Index first = 0; first < sides.cols(); first += Width)
  {
    const Eigen::Index count = std::min(Width, sides.cols() - first);
    x.setZero(sides.rows(), Width);
    x.leftCols(count) = sides.middleCols(first, count);
    int iterations = 0;
    if (const Status status = Iterate(matrix, *preconditioner, Limits, threads, x, iterations);
        !status)
    {
      return status;
    }
    sides.middleCols(first, count) = x.leftCols(count);
  }
  return {};
}
}
