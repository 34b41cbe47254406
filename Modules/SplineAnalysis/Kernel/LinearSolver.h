// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "GalerkinProblem.h"

#include <Eigen/SparseCore>

#include <string>

namespace knotwork
{
/// How a system was solved.
struct LinearSolverReport
{
  int Iterations = 0;         ///< 0: factorized
  std::string Preconditioner; ///< empty: factorized
};

/// Solves the equations of the coefficients that are not given: factorizes up to
/// GalerkinParams::DirectLimit unknowns (a tenth on one tensor-product volume), else conjugate
/// gradients. Their preconditioner on one
/// tensor-product patch is fast diagonalization of the Laplacian of its parameters, each component
/// alone, stretched in each direction as the map does in the mean, and scaled to the diagonal of
/// the matrix. Elsewhere it is symmetric Gauss-Seidel within blocks of unknowns, plus the constants
/// of the control points in each cell of a grid.
/// The bits of the result do not depend on the number of threads.
/// @param numbers  unknown of each coefficient f * components + component, -1: given.
/// @param lower  the lower triangle, compressed. @param sides  one column; becomes the solution.
/// @return SingularSystem, NotConverged.
/// @source  Sangalli, Tani, SIAM J. Sci. Comput. 38 (2016) A3644-A3671 (fast diagonalization);
/// Nicolaides, SIAM J. Numer. Anal. 24 (1987) 355-365 (constants of subdomains).
Status SolveUnknowns(const GalerkinSpace& space, int components, const std::vector<int>& numbers,
  const Eigen::SparseMatrix<double>& lower, const GalerkinParams& params, Eigen::MatrixXd& sides,
  LinearSolverReport& report);

/// Solves for the mass matrix of all functions, four columns at a time: conjugate gradients, on one
/// tensor-product patch with the mass matrix of its parameters as preconditioner, elsewhere with
/// Gauss-Seidel within blocks. The bits of the result do not depend on the number of threads.
/// @param lower  as above. @param sides  become the solutions. @return SingularSystem,
/// NotConverged.
Status SolveMass(const GalerkinSpace& space, const Eigen::SparseMatrix<double>& lower, int threads,
  Eigen::MatrixXd& sides);
}
