// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/DomainParameterization/Minimize.h>

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace knotwork
{
namespace
{
double Rosenbrock(const Eigen::VectorXd& x, Eigen::VectorXd& g)
{
  double value = 0.0;
  g = Eigen::VectorXd::Zero(x.size());
  for (Eigen::Index i = 0; i + 1 < x.size(); ++i)
  {
    const double a = x[i + 1] - x[i] * x[i];
    const double b = 1.0 - x[i];
    value += 100.0 * a * a + b * b;
    g[i] += -400.0 * a * x[i] - 2.0 * b;
    g[i + 1] += 200.0 * a;
  }
  return value;
}

TEST(Minimize, RosenbrockEndsAtOnes_ExactOracle)
{
  Eigen::VectorXd x = Eigen::VectorXd::Constant(20, -0.5);
  MinimizeParams params;
  params.MaxIterations = 5000;
  params.EnergyTolerance = 0.0;
  params.GradientTolerance = 1e-8;
  const MinimizeResult result = MinimizeLbfgs(x, Rosenbrock, params);
  EXPECT_TRUE(result.Converged);
  EXPECT_LE((x - Eigen::VectorXd::Ones(20)).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(Minimize, PerfectPreconditionerNeedsFewSteps_PropertyOracle)
{
  const Eigen::VectorXd d = Eigen::VectorXd::LinSpaced(50, 1.0, 1e6);
  const Objective quadratic = [&](const Eigen::VectorXd& x, Eigen::VectorXd& g)
  {
    g = d.cwiseProduct(x) - Eigen::VectorXd::Ones(50);
    return 0.5 * x.dot(d.cwiseProduct(x)) - x.sum();
  };
  MinimizeParams params;
  params.GradientTolerance = 1e-9;
  params.EnergyTolerance = 0.0;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(50);
  const auto exact =
    MinimizeLbfgs(x, quadratic, params, [&](Eigen::VectorXd& v) { v = v.cwiseQuotient(d).eval(); });
  EXPECT_LE(exact.State.Iteration, 3);
  EXPECT_LE((x - d.cwiseInverse()).cwiseAbs().maxCoeff(), 1e-9);
  x.setZero();
  const auto plain = MinimizeLbfgs(x, quadratic, params);
  EXPECT_GT(plain.State.Iteration, 3 * exact.State.Iteration);
}

TEST(Minimize, NeverLeavesTheRegionWhereTheObjectiveIsFinite_PropertyOracle)
{
  // minimum of x - log x at 1, infinite for x <= 0
  const Objective barrier = [](const Eigen::VectorXd& x, Eigen::VectorXd& g)
  {
    g.resize(1);
    if (!(x[0] > 0.0))
    {
      return std::numeric_limits<double>::infinity();
    }
    g[0] = 1.0 - 1.0 / x[0];
    return x[0] - std::log(x[0]);
  };
  for (double start : { 1e-6, 0.5, 30.0 })
  {
    Eigen::VectorXd x(1);
    x[0] = start;
    MinimizeParams params;
    params.EnergyTolerance = 0.0;
    params.GradientTolerance = 1e-9;
    EXPECT_TRUE(MinimizeLbfgs(x, barrier, params).Converged);
    EXPECT_NEAR(x[0], 1.0, 1e-8);
  }
}

TEST(Minimize, ValuesFallAndTheHookStops_PropertyOracle)
{
  Eigen::VectorXd x = Eigen::VectorXd::Constant(6, 2.0);
  double last = std::numeric_limits<double>::infinity();
  const MinimizeHook hook = [&](const MinimizeState& state)
  {
    EXPECT_LE(state.Value, last);
    last = state.Value;
    return state.Iteration < 5;
  };
  const MinimizeResult result = MinimizeLbfgs(x, Rosenbrock, {}, {}, hook);
  EXPECT_TRUE(result.Stopped);
  EXPECT_EQ(result.State.Iteration, 5);
  Eigen::VectorXd g;
  EXPECT_EQ(Rosenbrock(x, g), result.State.Value);
}
}
}
