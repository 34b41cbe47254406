// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "AnalysisCases.h"

#include <gtest/gtest.h>

#include <cstdio>

/// Orders of convergence, measured.
namespace knotwork::testing
{
/// Errors of a solution of Poisson's equation that is smooth and known.
inline ErrorNorms PoissonError(const AnalysisCase& body)
{
  const int n = body.Space.Dimension;
  const auto exact = [](const double* x, double* u) { u[0] = std::sin(2 * x[0]) * std::cos(x[1]); };
  const auto gradient = [n](const double* x, double* g)
  {
    g[0] = 2 * std::cos(2 * x[0]) * std::cos(x[1]);
    g[1] = -std::sin(2 * x[0]) * std::sin(x[1]);
    if (n == 3)
    {
      g[2] = 0.0;
    }
  };
  GalerkinProblem problem;
  problem.Source = [&](const double* x, double* f)
  {
    exact(x, f);
    f[0] *= 5.0;
  };
  problem.Prescribed.push_back({ body.Boundary, -1, exact });
  const auto solution = SolveGalerkin(body.Space, problem);
  EXPECT_TRUE(solution) << solution.Status.Message();
  return SolutionError(body.Space, solution.Value.Coefficients, exact, gradient);
}

template <typename MakeBody>
void ExpectRates(const std::string& name, int degree, int coarse, const MakeBody& make)
{
  const ErrorNorms first = PoissonError(make(coarse));
  const ErrorNorms second = PoissonError(make(2 * coarse));
  const double l2 = std::log2(first.L2 / second.L2);
  const double h1 = std::log2(first.H1 / second.H1);
  std::printf("[ rates    ] %-22s p %d: H1 %.3f L2 %.3f\n", name.c_str(), degree, h1, l2);
  EXPECT_NEAR(h1, degree, 0.15) << name;
  EXPECT_NEAR(l2, degree + 1, 0.15) << name;
}
}
