// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <functional>

namespace knotwork
{
/// Value and gradient at x; infinite where x is not allowed (the gradient is then not read).
using Objective = std::function<double(const Eigen::VectorXd& x, Eigen::VectorXd& gradient)>;
/// Replaces a vector by an approximation of the inverse Hessian times it: symmetric, positive.
using Preconditioner = std::function<void(Eigen::VectorXd&)>;

struct MinimizeParams
{
  int MaxIterations = 1000;
  int Memory = 8; ///< pairs kept
  /// Stop when Patience successive iterations lower the value by less than this part of it.
  double EnergyTolerance = 1e-8;
  int Patience = 3;
  /// Stop when the largest component of the gradient is below this.
  double GradientTolerance = 0.0;
};

struct MinimizeState
{
  int Iteration = 0;
  double Value = 0.0;
  double GradientNorm = 0.0; ///< largest component
};
/// Called after every iteration (and with 0 at the start); false stops.
using MinimizeHook = std::function<bool(const MinimizeState&)>;

struct MinimizeResult
{
  MinimizeState State;
  int Evaluations = 0;
  bool Stopped = false;   ///< by the hook
  bool Converged = false; ///< a tolerance was reached; else a limit, or no step lowered the value
};

/// Limited-memory BFGS with a weak Wolfe line search by bisection, step 1 first; steps to where the
/// objective is infinite are halved.
/// @param x  start, where the objective is finite; becomes the best point found.
/// @source  Nocedal & Wright, Numerical Optimization, 2nd edition, algorithm 7.4; Lewis & Overton,
/// Math. Program. 141 (2013) 135-163 (line search).
MinimizeResult MinimizeLbfgs(Eigen::VectorXd& x, const Objective& objective,
  const MinimizeParams& params, const Preconditioner& preconditioner = {},
  const MinimizeHook& hook = {});
}
