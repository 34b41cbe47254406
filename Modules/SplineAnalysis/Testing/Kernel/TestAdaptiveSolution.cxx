// SPDX-License-Identifier: BSD-3-Clause
#include "EnergyError.h"
#include "SingularCases.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace knotwork::testing
{
TEST(XAdaptive, Corner)
{
  std::printf("energy %.10f\n", CornerEnergy());
  for (int p = std::getenv("PP") ? std::atoi(std::getenv("PP")) : 2; p < (std::getenv("PP") ? std::atoi(std::getenv("PP")) + 1 : 4); ++p)
  {
    AdaptiveParams params;
    params.Theta = std::getenv("TH") ? std::atof(std::getenv("TH")) : 0.5;
    params.Refinement.Extension = std::getenv("EX") ? std::atoi(std::getenv("EX")) : 0;
    params.Refinement.AdmissibleClass = std::getenv("AC") ? std::atoi(std::getenv("AC")) : 2;
    params.MaxFunctions = std::getenv("MF") ? std::atoi(std::getenv("MF")) : 4000;
    const auto result = SolveAdaptively<2>(LShape<2>(p, std::getenv("N0") ? std::atoi(std::getenv("N0")) : 2), CornerProblem<2>, params);
    ASSERT_TRUE(result) << result.Status.Message();
    AdaptiveStep last;
    for (const AdaptiveStep& step : result->History)
    {
      const double error = CornerError(step.Energy);
      const double before = CornerError(last.Energy);
      std::printf("p %d N %6d el %6d est %.3e err %.3e ratio %.3f slope %.3f marked %d  t %.2f %.2f %.2f\n", p, step.Functions,
        step.Elements, step.Estimate, error, step.Estimate / error,
        -std::log(error / before) / std::log(1.0 * step.Functions / last.Functions), step.Marked,
        step.SecondsSolve, step.SecondsEstimate, step.SecondsRefine);
      last = step;
    }
    std::printf("parts I %.3e J %.3e L %.3e V %.3e %s\n", result->Estimate.Interior, result->Estimate.Jumps, result->Estimate.Loads,
      result->Estimate.Values, ToString(result->Stop));
    auto u = LShape<2>(p, std::getenv("NU") ? std::atoi(std::getenv("NU")) : 40);
    const auto space = MakeGalerkinSpace(u);
    const auto problem = CornerProblem<2>(u, space.Value);
    const auto s = SolveGalerkin(space.Value, problem.Value);
    const auto e = EstimateError(space.Value, problem.Value, s->Coefficients);
    std::printf("E %.10f last %.10f\n", s->Energy, result->Solution.Energy); std::printf("uniform p %d N %d err %.3e est %.3e\n", p, space->NumFunctions(), CornerError(s->Energy), e->Total);
  }
}
TEST(XAdaptive, Edge)
{
  const int p = std::getenv("PP") ? std::atoi(std::getenv("PP")) : 2;
    AdaptiveParams params;
    params.Theta = std::getenv("TH") ? std::atof(std::getenv("TH")) : 0.5;
    params.Refinement.Extension = std::getenv("EX") ? std::atoi(std::getenv("EX")) : 0;
    params.Refinement.AdmissibleClass = std::getenv("AC") ? std::atoi(std::getenv("AC")) : 2;
    params.MaxFunctions = std::getenv("MF") ? std::atoi(std::getenv("MF")) : 8000;
    const auto result = SolveAdaptively<3>(LShape<3>(p, std::getenv("N0") ? std::atoi(std::getenv("N0")) : 2), CornerProblem<3>, params);
    ASSERT_TRUE(result) << result.Status.Message();
    AdaptiveStep last;
    for (const AdaptiveStep& step : result->History)
    {
      const double error = CornerError(step.Energy);
      const double before = CornerError(last.Energy);
      std::printf("p %d N %6d el %6d est %.3e err %.3e ratio %.3f slope %.3f marked %d  t %.2f %.2f %.2f\n", p, step.Functions,
        step.Elements, step.Estimate, error, step.Estimate / error,
        -std::log(error / before) / std::log(1.0 * step.Functions / last.Functions), step.Marked,
        step.SecondsSolve, step.SecondsEstimate, step.SecondsRefine);
      last = step;
    }
    std::printf("parts I %.3e J %.3e L %.3e V %.3e %s\n", result->Estimate.Interior, result->Estimate.Jumps, result->Estimate.Loads,
      result->Estimate.Values, ToString(result->Stop));
}
TEST(XAdaptive, EdgeUniform)
{
  const int p = std::getenv("PP") ? std::atoi(std::getenv("PP")) : 2;
    auto u = LShape<3>(p, std::getenv("NU") ? std::atoi(std::getenv("NU")) : 10);
    const auto space = MakeGalerkinSpace(u);
    const auto problem = CornerProblem<3>(u, space.Value);
    GalerkinParams g; g.DirectLimit = 20000;
    const auto s = SolveGalerkin(space.Value, problem.Value, g);
    const auto e = EstimateError(space.Value, problem.Value, s->Coefficients);
    std::printf("uniform p %d N %d err %.3e est %.3e t %.2f %.2f\n", p, space->NumFunctions(), CornerError(s->Energy), e->Total, s->SecondsAssembly, s->SecondsSolve);
}
TEST(XAdaptive, Elastic)
{
  for (const int p : { 2, 3 })
  {
    AdaptiveParams params;
    params.MaxSteps=1;
    params.Refinement.Extension = 0;
    const OpenedCorner field;
    double last = 1, lastN = 1;
    for (params.MaxSteps = 1; params.MaxSteps < 23; ++params.MaxSteps) {
    const auto result = SolveAdaptively<2>(LShape<2>(p, 2), [&](const Spline<2>& s, const GalerkinSpace&) { return field.Problem(s); }, params);
    ASSERT_TRUE(result) << result.Status.Message();
      const AdaptiveStep& step = result->History.back();
      const double error = EnergyError(result->Space, result->Problem, result->Solution.Coefficients, field.Gradient(), 4);
      std::printf("p %d N %6d el %6d est %.3e err %.3e ratio %.3f slope %.3f  parts I %.3e J %.3e L %.3e V %.3e \n", p, step.Functions,
        step.Elements, step.Estimate, error, step.Estimate / error,
        -std::log(error / last) / std::log(1.0 * step.Functions / lastN), result->Estimate.Interior, result->Estimate.Jumps, result->Estimate.Loads,
      result->Estimate.Values);
      last = error; lastN = step.Functions;
    }
  }
}
TEST(XAdaptive, Smooth)
{
  for (const int kind : { 0, 1 })
  for (const int p : { 2, 3 })
  {
    // sine, and a peak
    const auto u = [kind](const double* x) { return kind == 0 ? std::sin(3 * x[0] + 1) * std::cos(2 * x[1]) : std::exp(-50 * ((x[0] - 0.4) * (x[0] - 0.4) + (x[1] - 0.6) * (x[1] - 0.6))); };
    const PointFunction values = [u](const double* x, double* v) { v[0] = u(x); };
    const PointFunction gradient = [u, kind](const double* x, double* g) {
      if (kind == 0) { g[0] = 3 * std::cos(3 * x[0] + 1) * std::cos(2 * x[1]); g[1] = -2 * std::sin(3 * x[0] + 1) * std::sin(2 * x[1]); }
      else { g[0] = -100 * (x[0] - 0.4) * u(x); g[1] = -100 * (x[1] - 0.6) * u(x); } };
    const PointFunction source = [u, kind](const double* x, double* f) {
      const double q = (x[0] - 0.4) * (x[0] - 0.4) + (x[1] - 0.6) * (x[1] - 0.6);
      f[0] = kind == 0 ? 13 * u(x) : (200 - 10000 * q) * u(x); };
    const ProblemMaker<2> make = [&](const Spline<2>&, const GalerkinSpace& space) -> Result<GalerkinProblem> {
      GalerkinProblem problem; problem.Source = source; problem.Prescribed.push_back({ BoundaryFacets(space).Value, -1, values }); return problem; };
    for (int n : { 8, 16, 32, 64 }) {
      const auto sp = BentBox<2>(p, n); const auto space = MakeGalerkinSpace(sp);
      const auto problem = make(sp, space.Value); const auto s = SolveGalerkin(space.Value, problem.Value);
      const auto est = EstimateError(space.Value, problem.Value, s->Coefficients);
      const double error = EnergyError(space.Value, problem.Value, s->Coefficients, gradient);
      std::printf("kind %d p %d uniform N %d err %.3e ratio %.3f\n", kind, p, space->NumFunctions(), error, est->Total / error);
    }
    AdaptiveParams params;
    params.Theta = std::getenv("TH") ? std::atof(std::getenv("TH")) : 0.5;
    params.Refinement.Extension = std::getenv("EX") ? std::atoi(std::getenv("EX")) : 0;
    params.MaxFunctions = 5000;
    for (params.MaxSteps = 1; params.MaxSteps < 30; ++params.MaxSteps) {
      const auto result = SolveAdaptively<2>(BentBox<2>(p, 8), make, params);
      ASSERT_TRUE(result) << result.Status.Message();
      const double error = EnergyError(result->Space, result->Problem, result->Solution.Coefficients, gradient);
      std::printf("kind %d p %d N %d err %.3e ratio %.3f\n", kind, p, result->Space.NumFunctions(), error, result->Estimate.Total / error);
      if (result->Stop == AdaptiveStop::MaxFunctions) break;
    }
  }
}
}
