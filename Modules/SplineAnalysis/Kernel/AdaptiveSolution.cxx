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

/// Levels of the elements of all patches.
template <int Dim>
std::vector<int> LevelsOf(const MultiPatch<Dim>& body)
{
  std::vector<int> levels;
  for (const Spline<Dim>& patch : body.Patches)
  {
    for (const auto& element : patch.Space->Elements)
    {
      levels.push_back(element.Level);
    }
  }
  return levels;
}

/// Whether more than half of the squared estimate of the marked elements is on the highest level,
/// where it stays.
bool AreExhausted(const std::vector<int>& levels, const std::vector<double>& estimates,
  const std::vector<int>& marked, int maxLevel)
{
  double sum = 0.0;
  double highest = 0.0;
  for (const int e : marked)
  {
    const auto index = static_cast<std::size_t>(e);
    const double square = estimates[index] * estimates[index];
    sum += square;
    highest += levels[index] >= maxLevel ? square : 0.0;
  }
  return highest > 0.5 * sum;
}

template <int Dim>
int CountFunctions(const MultiPatch<Dim>& body)
{
  int count = 0;
  for (const Spline<Dim>& patch : body.Patches)
  {
    count += patch.Space->NumFunctions;
  }
  return count;
}

/// Splits the marked elements; with a margin of half the degree where the parameters' own makes no
/// new function, so that one does.
template <int Dim>
Result<MultiPatch<Dim>> Refine(
  const MultiPatch<Dim>& body, const std::vector<int>& marked, const RefinementParams& params)
{
  auto refined = RefineMarkedElements(body, marked, params);
  const IntArray<Dim>& degree = body.Patches.front().Space->Elements.front().Degree;
  RefinementParams wider = params;
  wider.Extension = *std::max_element(degree.begin(), degree.end()) / 2;
  if (refined && CountFunctions(refined.Value) == CountFunctions(body) &&
    wider.Extension > params.Extension)
  {
    return RefineMarkedElements(body, marked, wider);
  }
  return refined;
}

template <int Dim>
Status CheckBody(const MultiPatch<Dim>& body)
{
  for (const Spline<Dim>& patch : body.Patches)
  {
    if (!patch.Space || !patch.Space->HasDomain() || patch.Space->NumElements() == 0)
    {
      return { ErrorCode::DimensionMismatch,
        "only tensor-product, hierarchical and locally refined splines are refined by elements" };
    }
  }
  return body.Patches.empty()
    ? Status{ ErrorCode::EmptyInput, "there are no patches; give one at least" }
    : Status();
}

/// An element on a side, as the part of the side that it covers, in shares of its directions.
struct SidePart
{
  int Element = -1;
  std::array<double, 2> Lower{ 0.0, 0.0 };
  std::array<double, 2> Upper{ 1.0, 1.0 };
};

/// @param orientation  how the side lies on the first one; null: it is the first.
template <int Dim>
std::vector<SidePart> PartsOfSide(
  const SplineSpace<Dim>& space, int side, const SideOrientation* orientation)
{
  std::vector<SidePart> parts;
  const auto directions = SideDirections<Dim>(side);
  const ParametricBox<Dim>& domain = space.Domain();
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const auto& box = space.Elements[static_cast<std::size_t>(e)].Box;
    if (SideValue(box, side) != SideValue(domain, side))
    {
      continue;
    }
    SidePart& part = parts.emplace_back();
    part.Element = e;
    for (std::size_t k = 0; k < directions.size(); ++k)
    {
      const std::size_t d = directions[k];
      const double length = domain.Upper[d] - domain.Lower[d];
      const double lower = (box.Lower[d] - domain.Lower[d]) / length;
      const double upper = (box.Upper[d] - domain.Lower[d]) / length;
      const bool reversed = orientation && orientation->Reversed[k];
      const auto at = orientation ? static_cast<std::size_t>(orientation->Axis[k]) : k;
      part.Lower[at] = reversed ? 1.0 - upper : lower;
      part.Upper[at] = reversed ? 1.0 - lower : upper;
    }
  }
  return parts;
}

/// Elements on sides of interfaces that meet finer ones there, a list a patch.
template <int Dim>
std::vector<std::vector<int>> CoarserElements(const MultiPatch<Dim>& body)
{
  const auto isBetween = [](const SidePart& part, const SidePart& other, std::size_t d)
  {
    const double middle = 0.5 * (other.Lower[d] + other.Upper[d]);
    return middle > part.Lower[d] && middle < part.Upper[d];
  };
  std::vector<std::vector<int>> coarser(body.Patches.size());
  for (const PatchInterface& interface : body.Topology.Interfaces)
  {
    std::array<std::vector<SidePart>, 2> parts;
    for (std::size_t k = 0; k < 2; ++k)
    {
      const PatchSide& side = interface.Sides[k];
      parts[k] = PartsOfSide(*body.Patches[static_cast<std::size_t>(side.Patch)].Space, side.Side,
        k == 0 ? nullptr : &interface.Orientation);
      std::sort(parts[k].begin(), parts[k].end(),
        [](const SidePart& a, const SidePart& b) { return a.Lower[0] < b.Lower[0]; });
    }
    for (std::size_t k = 0; k < 2; ++k)
    {
      // parts of the other side whose middle lies in one of this, and which are smaller
      for (const SidePart& part : parts[k])
      {
        const double length = part.Upper[0] - part.Lower[0];
        const std::vector<SidePart>& others = parts[1 - k];
        auto other = std::lower_bound(others.begin(), others.end(), part.Lower[0] - 1e-9 * length,
          [](const SidePart& a, double value) { return a.Lower[0] < value; });
        for (; other != others.end() && other->Lower[0] < part.Upper[0]; ++other)
        {
          const bool isInside = isBetween(part, *other, 0) && isBetween(part, *other, 1);
          if (isInside && other->Upper[0] - other->Lower[0] < 0.75 * length)
          {
            coarser[static_cast<std::size_t>(interface.Sides[k].Patch)].push_back(part.Element);
            break;
          }
        }
      }
    }
  }
  for (std::vector<int>& elements : coarser)
  {
    std::sort(elements.begin(), elements.end());
    elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
  }
  return coarser;
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
Result<MultiPatch<Dim>> RefineMarkedElements(
  const MultiPatch<Dim>& body, const std::vector<int>& marked, const RefinementParams& params)
{
  std::vector<std::vector<int>> ofPatches(body.Patches.size());
  for (const int e : marked)
  {
    int own = e;
    std::size_t patch = 0;
    while (patch < body.Patches.size() && own >= body.Patches[patch].Space->NumElements())
    {
      own -= body.Patches[patch++].Space->NumElements();
    }
    if (e < 0 || patch == body.Patches.size())
    {
      return { ErrorCode::InvalidParameter,
        "there is no element " + std::to_string(e) + " in the patches" };
    }
    ofPatches[patch].push_back(own);
  }
  MultiPatch<Dim> refined = body;
  const auto isEmpty = [](const std::vector<int>& elements) { return elements.empty(); };
  while (!std::all_of(ofPatches.begin(), ofPatches.end(), isEmpty))
  {
    for (std::size_t i = 0; i < refined.Patches.size(); ++i)
    {
      auto patch = RefineMarkedElements(refined.Patches[i], ofPatches[i], params);
      if (!patch)
      {
        return { patch.Status.Code, "patch " + std::to_string(i) + ": " + patch.Status.Detail };
      }
      refined.Patches[i] = std::move(patch->Value);
    }
    ofPatches = CoarserElements(refined);
  }
  return refined;
}

template <int Dim>
Result<AdaptiveSolution<Dim>> SolveAdaptively(const MultiPatch<Dim>& body,
  const BodyProblemMaker<Dim>& makeProblem, const AdaptiveParams& params,
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
  if (const Status status = CheckBody(body); !status)
  {
    return status;
  }
  AdaptiveSolution<Dim> result;
  result.Body = body;
  auto start = Clock::now();
  auto space = MakeGalerkinSpace(body);
  if (!space)
  {
    return space.Status;
  }
  result.Space = std::move(space.Value);
  double done = 0.0;
  const ProgressCallback inner = [&](double) { return !progress || progress(done); };
  while (true)
  {
    AdaptiveStep step;
    auto problem = makeProblem(result.Body, result.Space);
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
    if (AreExhausted(
          LevelsOf(result.Body), result.Estimate.Elements, marked, params.Refinement.MaxLevel))
    {
      result.Stop = AdaptiveStop::MaxLevel;
      break;
    }
    auto refined = Refine(result.Body, marked, params.Refinement);
    if (!refined)
    {
      return refined.Status;
    }
    if (CountFunctions(refined.Value) == CountFunctions(result.Body))
    {
      result.Stop = AdaptiveStop::MaxLevel;
      break;
    }
    const double seconds = SecondsSince(start);
    start = Clock::now();
    space = MakeGalerkinSpace(refined.Value);
    if (!space)
    {
      return space.Status;
    }
    if (space->NumFunctions() > params.MaxFunctions)
    {
      result.Stop = AdaptiveStop::MaxFunctions;
      break;
    }
    result.History.back().Marked = static_cast<int>(marked.size());
    result.History.back().SecondsRefine = seconds;
    result.Body = std::move(refined.Value);
    result.Space = std::move(space.Value);
    done = std::max(static_cast<double>(result.History.size()) / params.MaxSteps,
      static_cast<double>(result.Space.NumFunctions()) / params.MaxFunctions);
  }
  if (progress && !progress(1.0))
  {
    return { ErrorCode::Aborted, "after the last solution" };
  }
  return result;
}

template <int Dim>
Result<AdaptiveSolution<Dim>> SolveAdaptively(const Spline<Dim>& spline,
  const ProblemMaker<Dim>& makeProblem, const AdaptiveParams& params,
  const ProgressCallback& progress)
{
  MultiPatch<Dim> body;
  body.Patches.push_back(spline);
  const BodyProblemMaker<Dim> make = [&makeProblem](
                                       const MultiPatch<Dim>& refined, const GalerkinSpace& space)
  { return makeProblem(refined.Patches.front(), space); };
  return SolveAdaptively(body, makeProblem ? make : BodyProblemMaker<Dim>(), params, progress);
}

// NOLINTBEGIN(bugprone-macro-parentheses): Dim>> ends two templates
#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template Result<MultiPatch<Dim>> RefineMarkedElements(                                           \
    const MultiPatch<Dim>&, const std::vector<int>&, const RefinementParams&);                     \
  template Result<AdaptiveSolution<Dim>> SolveAdaptively(const MultiPatch<Dim>&,                   \
    const BodyProblemMaker<Dim>&, const AdaptiveParams&, const ProgressCallback&);                 \
  template Result<AdaptiveSolution<Dim>> SolveAdaptively(                                          \
    const Spline<Dim>&, const ProblemMaker<Dim>&, const AdaptiveParams&, const ProgressCallback&);
// NOLINTEND(bugprone-macro-parentheses)
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
}
