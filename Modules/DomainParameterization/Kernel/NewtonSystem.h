// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "DomainEnergy.h"
#include "GluedMap.h"
#include "Minimize.h"

#include <Eigen/SparseCholesky>

namespace knotwork
{
/// Hessians of the functionals of DomainEnergy with respect to free control points, weights fixed,
/// and the solution of Newton's equations. Unknown c * free.size() + k is coordinate c of function
/// free[k].
template <int Dim>
class NewtonSystem
{
public:
  /// @param map  spaces, numbers and weights; its control points are not looked at.
  /// @param numPoints  Gauss points a direction of each element, patch after patch.
  NewtonSystem(
    const GluedMap<Dim>& map, const std::vector<int>& numPoints, const std::vector<int>& free);

  /// @param points  Dim planes of NumFunctions coordinates, as DomainEnergy takes them.
  /// @param project  the Hessian of every quadrature point is replaced by the nearest positive
  ///                 semidefinite matrix: the sum is then positive semidefinite.
  /// @pre density.Kind is Quality or Penalty.
  void Assemble(const Density& density, const double* points, bool project);

  /// Lower triangle of the last assembled matrix.
  const Eigen::SparseMatrix<double>& Matrix() const { return this->Lower; }

  /// What the last Assemble and Solve cost, in about nanoseconds; counted, not measured.
  double Work() const;

  /// Solves (matrix + shift) step = right; false when the factorization fails.
  bool Solve(const Eigen::VectorXd& right, Eigen::VectorXd& step);

private:
  void AddPatch(const SplineSpace<Dim>& space, const int* numPoints, const Eigen::VectorXd& weights,
    const std::vector<int>& numbers, const std::vector<int>& unknown);

  struct Block
  {
    std::vector<int> Functions;
    std::vector<int> Unknowns; ///< position in free, -1: fixed
    Eigen::MatrixXd Slopes;    ///< (functions * Dim) x points: derivatives along the directions
    Eigen::VectorXd Weights;
  };
  int NumFunctions = 0;
  int NumFree = 0;
  std::vector<Block> Blocks;
  std::vector<Eigen::Triplet<double>> Triplets;
  Eigen::SparseMatrix<double> Lower;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> Solver;
  bool Analyzed = false;
};

/// Newton's method with step halving: at x the callback puts the Newton step for a gradient, or
/// returns false.
using NewtonStep = std::function<bool(
  const Eigen::VectorXd& x, const Eigen::VectorXd& gradient, Eigen::VectorXd& step)>;
MinimizeResult MinimizeNewton(Eigen::VectorXd& x, const Objective& objective,
  const NewtonStep& newton, const MinimizeParams& params, const MinimizeHook& hook = {});
}
