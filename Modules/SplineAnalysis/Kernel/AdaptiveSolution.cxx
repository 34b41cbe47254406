// SPDX-License-Identifier: BSD-3-Clause
#include "AdaptiveSolution.h"

#include <knotwork/SplineCore/Refinement.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

namespace knotwork
{
namespace
{
/// Estimates that differ by less, relatively, count as equal.
constexpr double Rounding = 1e-6;

using Clock = std::chrono::steady_clock;
double SecondsSince(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Status CheckParams(const AdaptiveParams& params)
{
  if (!(params.Theta > 0.0 && params.Theta <= 1.0))
  {
    return { ErrorCode::InvalidParameter, "the share of the estimate to mark must be in (0, 1]" };
  }
  if (!(params.Tolerance >= 0.0) || params.MaxFunctions < 1 || params.MaxSteps < 1)
  {
    return { ErrorCode::InvalidParameter,
      "the tolerance must be at least 0, the limits of functions and steps at least 1" };
  }
  return {};
}

/// Whether more than half of the squared estimate of the marked elements is on the highest level,
/// where it stays.
template <int Dim>
bool AreExhausted(const Spline<Dim>& spline, const std::vector<double>& estimates,
  const std::vector<int>& marked, int maxLevel)
{
  double sum = 0.0;
  double highest = 0.0;
  for (const int e : marked)
  {
    const auto index = static_cast<std::size_t>(e);
    const double square = estimates[index] * estimates[index];
    sum += square;
    highest += spline.Space->Elements[index].Level >= maxLevel ? square : 0.0;
  }
  return highest > 0.5 * sum;
}

/// Splits the marked elements; with a margin of half the degree where the parameters' own makes no
/// new function, so that one does.
template <int Dim>
Result<RefinedSpline<Dim>> Refine(
  const Spline<Dim>& spline, const std::vector<int>& marked, const RefinementParams& params)
{
  auto refined = RefineMarkedElements(spline, marked, params);
  const IntArray<Dim>& degree = spline.Space->Elements.front().Degree;
  RefinementParams wider = params;
  wider.Extension = *std::max_element(degree.begin(), degree.end()) / 2;
  if (refined && refined->Value.Space->NumFunctions == spline.Space->NumFunctions &&
    wider.Extension > params.Extension)
  {
    return RefineMarkedElements(spline, marked, wider);
  }
  return refined;
}
}

const char* ToString(AdaptiveStop stop)
{
  switch (stop)
  {
    case AdaptiveStop::Tolerance:
      return "the estimated error is within the tolerance";
    case AdaptiveStop::MaxFunctions:
      return "the next space has more functions than allowed";
    case AdaptiveStop::MaxSteps:
      return "all steps are done";
    case AdaptiveStop::MaxLevel:
      break;
  }
  return "most of the error is on the highest level";
}

std::vector<int> MarkElements(const std::vector<double>& estimates, double theta)
{
  std::vector<int> order(estimates.size());
  std::iota(order.begin(), order.end(), 0);
  const auto at = [&](int e) { return estimates[static_cast<std::size_t>(e)]; };
  std::sort(order.begin(), order.end(),
    [&](int a, int b) { return at(a) != at(b) ? at(a) > at(b) : a < b; });
  double total = 0.0;
  for (const int e : order)
  {
    total += at(e) * at(e);
  }
  std::vector<int> marked;
  double sum = 0.0;
  double smallest = 0.0;
  for (const int e : order)
  {
    if (at(e) == 0.0 || (sum >= theta * total && at(e) < (1.0 - Rounding) * smallest))
    {
      break;
    }
    smallest = sum < theta * total ? at(e) : smallest;
    sum += at(e) * at(e);
    marked.push_back(e);
  }
  std::sort(marked.begin(), marked.end());
  return marked;
}

template <int Dim>
Result<AdaptiveSolution<Dim>> SolveAdaptively(const Spline<Dim>& spline,
  const ProblemMaker<Dim>& makeProblem, const AdaptiveParams& params,
  const ProgressCallback& progress)
{
  if (const Status status = CheckParams(params); !status)
  {
    return status;
  }
  if (!makeProblem)
  {
    return { ErrorCode::InvalidParameter, "there is no problem; give a function that states it" };
  }
  if (!spline.Space || !spline.Space->HasDomain() || spline.Space->NumElements() == 0)
  {
    return { ErrorCode::DimensionMismatch,
      "only tensor-product, hierarchical and locally refined splines are refined by elements" };
  }
  AdaptiveSolution<Dim> result;
  result.Spline = spline;
  double done = 0.0;
  const ProgressCallback inner = [&](double) { return !progress || progress(done); };
  while (true)
  {
    AdaptiveStep step;
    auto start = Clock::now();
    auto space = MakeGalerkinSpace(result.Spline);
    if (!space)
    {
      return space.Status;
    }
    result.Space = std::move(space.Value);
    auto problem = makeProblem(result.Spline, result.Space);
    if (!problem)
    {
      return problem.Status;
    }
    result.Problem = std::move(problem.Value);
    auto solution = SolveGalerkin(result.Space, result.Problem, params.Galerkin, inner);
    if (!solution)
    {
      return solution.Status;
    }
    result.Solution = std::move(solution.Value);
    step.SecondsSolve = SecondsSince(start);
    start = Clock::now();
    auto estimate = EstimateError(
      result.Space, result.Problem, result.Solution.Coefficients, params.Galerkin.Threads, inner);
    if (!estimate)
    {
      return estimate.Status;
    }
    result.Estimate = std::move(estimate.Value);
    step.SecondsEstimate = SecondsSince(start);
    step.Functions = result.Space.NumFunctions();
    step.Elements = result.Space.NumElements();
    step.Estimate = result.Estimate.Total;
    step.Energy = result.Solution.Energy;
    result.History.push_back(step);

    if (step.Estimate <= params.Tolerance)
    {
      result.Stop = AdaptiveStop::Tolerance;
      break;
    }
    if (static_cast<int>(result.History.size()) == params.MaxSteps)
    {
      result.Stop = AdaptiveStop::MaxSteps;
      break;
    }
    start = Clock::now();
    const std::vector<int> marked = MarkElements(result.Estimate.Elements, params.Theta);
    if (AreExhausted(result.Spline, result.Estimate.Elements, marked, params.Refinement.MaxLevel))
    {
      result.Stop = AdaptiveStop::MaxLevel;
      break;
    }
    auto refined = Refine(result.Spline, marked, params.Refinement);
    if (!refined)
    {
      return refined.Status;
    }
    if (refined->Value.Space->NumFunctions > params.MaxFunctions)
    {
      result.Stop = AdaptiveStop::MaxFunctions;
      break;
    }
    if (refined->Value.Space->NumFunctions == step.Functions)
    {
      result.Stop = AdaptiveStop::MaxLevel;
      break;
    }
    result.History.back().Marked = static_cast<int>(marked.size());
    result.History.back().SecondsRefine = SecondsSince(start);
    result.Spline = std::move(refined->Value);
    done = std::max(static_cast<double>(result.History.size()) / params.MaxSteps,
      static_cast<double>(result.Spline.Space->NumFunctions) / params.MaxFunctions);
  }
  if (progress && !progress(1.0))
  {
    return { ErrorCode::Aborted, "after the last solution" };
  }
  return result;
}

template Result<AdaptiveSolution<2>> SolveAdaptively(
  const Spline<2>&, const ProblemMaker<2>&, const AdaptiveParams&, const ProgressCallback&);
template Result<AdaptiveSolution<3>> SolveAdaptively(
  const Spline<3>&, const ProblemMaker<3>&, const AdaptiveParams&, const ProgressCallback&);
}
