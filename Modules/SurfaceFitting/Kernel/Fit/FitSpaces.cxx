// SPDX-License-Identifier: BSD-3-Clause
#include "FitSpaces.h"

#include <knotwork/SplineCore/HierarchicalSpace.h>
#include <knotwork/SplineCore/LRDependence.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr int MostInitialElements = 16; // a direction, unless asked for
constexpr double PointsPerElement = 64.0;

/// Elements of both directions, about as long as wide.
IntArray<2> InitialElements(
  const FitParams& params, const ParametricBox<2>& domain, std::size_t numPoints)
{
  const double most = std::clamp(std::sqrt(static_cast<double>(numPoints) / PointsPerElement), 1.0,
    static_cast<double>(MostInitialElements) / 2.0);
  const double aspect = (domain.Upper[0] - domain.Lower[0]) / (domain.Upper[1] - domain.Lower[1]);
  const RealArray<2> share{ std::sqrt(std::clamp(aspect, 0.0625, 16.0)),
    std::sqrt(std::clamp(1.0 / aspect, 0.0625, 16.0)) };
  IntArray<2> elements = params.NumInitialElements;
  for (std::size_t d = 0; d < 2; ++d)
  {
    if (elements[d] == 0)
    {
      elements[d] =
        std::clamp(static_cast<int>(std::lround(most * share[d])), 1, 2 * MostInitialElements);
    }
  }
  const auto numFunctions = [&]
  { return (elements[0] + params.Degree[0]) * (elements[1] + params.Degree[1]); };
  while (params.MaxFunctions > 0 && numFunctions() > params.MaxFunctions)
  {
    // the direction with more elements, of those that are not asked for
    const std::size_t d = params.NumInitialElements[0] != 0 ||
        (params.NumInitialElements[1] == 0 && elements[1] > elements[0])
      ? 1
      : 0;
    if (params.NumInitialElements[d] != 0 || elements[d] == 1)
    {
      break;
    }
    --elements[d];
  }
  return elements;
}

/// All columns side by side.
PointMatrix Join(const FitState& state)
{
  PointMatrix all(state.Coefficients.rows(),
    state.Coefficients.cols() + state.DomainPoints.cols() + state.Start.cols());
  all.leftCols(state.Coefficients.cols()) = state.Coefficients;
  all.middleCols(state.Coefficients.cols(), 2) = state.DomainPoints;
  if (state.Start.cols() > 0)
  {
    all.rightCols(state.Start.cols()) = state.Start;
  }
  return all;
}

/// Columns as Join has put those of a state together.
FitState Part(SplineSpacePtr<2> space, const PointMatrix& all, const FitState& like)
{
  FitState state;
  state.Space = std::move(space);
  state.Coefficients = all.leftCols(like.Coefficients.cols());
  state.DomainPoints = all.middleCols(like.Coefficients.cols(), 2);
  if (like.Start.cols() > 0)
  {
    state.Start = all.rightCols(like.Start.cols());
  }
  return state;
}

Result<FitState> RefineHierarchical(const FitState& state, const std::vector<SplitMark>& marks)
{
  std::vector<int> elements;
  for (const SplitMark& mark : marks)
  {
    elements.push_back(mark.Element);
  }
  RefinementParams refinement;
  const IntArray<2>& degree = state.Space->Elements[0].Degree;
  refinement.Extension = (std::max(degree[0], degree[1]) + 1) / 2;
  auto space = RefineElements<2>(state.Space, elements, refinement);
  if (!space)
  {
    return space.Status;
  }
  Spline<2> spline;
  spline.Space = state.Space;
  spline.ControlPoints = Join(state);
  auto refined = TransferToRefined<2>(spline, space.Value);
  if (!refined)
  {
    return refined.Status;
  }
  return Part(space.Value, refined.Value.ControlPoints, state);
}

Result<FitState> RefineLocally(const FitState& state, const std::vector<SplitMark>& marks,
  LRStrategy strategy, const FitParams& params)
{
  PointMatrix all = Join(state);
  LRRefinement refinement(*state.Space, all);
  for (std::size_t d = 0; d < 2; ++d)
  {
    std::vector<int> chosen;
    for (const SplitMark& mark : marks)
    {
      if (mark.Directions[d])
      {
        chosen.push_back(mark.Element);
      }
    }
    const auto segments =
      SegmentsForElements(*state.Space, chosen, { strategy, { d == 0, d == 1 } });
    if (!segments)
    {
      return segments.Status;
    }
    for (const LRSegment& segment : segments.Value)
    {
      if (Status status = refinement.Insert(segment); !status)
      {
        return status;
      }
    }
  }
  auto space = refinement.Finish(&all, params.Threads);
  if (!space)
  {
    return space.Status;
  }
  if (!params.Independent)
  {
    return Part(space.Value, all, state);
  }
  Spline<2> spline;
  spline.Space = space.Value;
  spline.ControlPoints = all;
  auto resolved = ResolveDependence(spline, MaxResolvingSegments, params.Threads);
  if (!resolved)
  {
    return resolved.Status;
  }
  return Part(resolved.Value.Value.Space, resolved.Value.Value.ControlPoints, state);
}

/// A tensor-product space becomes one that LR spaces are refined from where these are asked for;
/// functions keep their numbers.
Status TakeKind(const FitParams& params, SplineSpacePtr<2>& space)
{
  if (space->Kind != SpaceKind::Tensor || params.Space == FitSpace::Hierarchical)
  {
    return {};
  }
  auto basis = LRBasisOfTensor(*space);
  if (!basis)
  {
    return basis.Status;
  }
  auto made = MakeLRSpace(std::move(basis.Value), params.Threads);
  if (made)
  {
    space = made.Value;
  }
  return made.Status;
}
}

Result<FitState> MakeFirstState(
  const FitParams& params, const ParametricBox<2>& domain, int numComponents, std::size_t numPoints)
{
  const IntArray<2> elements = InitialElements(params, domain, numPoints);
  std::array<KnotVector, 2> knots;
  for (std::size_t d = 0; d < 2; ++d)
  {
    knots[d] = KnotVector::Uniform(params.Degree[d], elements[d], domain.Lower[d], domain.Upper[d]);
  }
  const auto made = MakeTensorSpace<2>(knots);
  if (!made)
  {
    return made.Status;
  }
  const SplineSpacePtr<2>& tensor = made.Value;
  FitState state;
  state.Space = tensor;
  state.Coefficients = PointMatrix::Zero(tensor->NumFunctions, numComponents);
  state.DomainPoints.resize(tensor->NumFunctions, 2);
  for (int f = 0; f < tensor->NumFunctions; ++f)
  {
    const int n0 = knots[0].NumFunctions();
    state.DomainPoints(f, 0) = knots[0].Greville(f % n0);
    state.DomainPoints(f, 1) = knots[1].Greville(f / n0);
  }
  if (Status status = TakeKind(params, state.Space); !status)
  {
    return status;
  }
  return state;
}

Result<FitState> MakeStartState(const FitParams& params, int numComponents)
{
  FitState state;
  state.Space = params.Start->Surface.Space;
  state.Start = params.Start->Surface.ControlPoints;
  state.Coefficients = state.Start.leftCols(numComponents);
  state.DomainPoints = params.Start->DomainPoints;
  if (Status status = TakeKind(params, state.Space); !status)
  {
    return { status.Code, "the start surface: " + status.Detail };
  }
  return state;
}

Result<FitState> RefineState(const FitState& state, const std::vector<SplitMark>& marks,
  int iteration, const FitParams& params)
{
  const bool isLater = params.StrategySwitch > 0 && iteration >= params.StrategySwitch;
  return params.Space == FitSpace::Hierarchical
    ? RefineHierarchical(state, marks)
    : RefineLocally(state, marks, isLater ? params.LaterStrategy : params.Strategy, params);
}
}
