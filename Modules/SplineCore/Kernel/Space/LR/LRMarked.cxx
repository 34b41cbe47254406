// SPDX-License-Identifier: BSD-3-Clause
#include "LRDependence.h"
#include "Refinement.h"

#include <numeric>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// The functions that LRRefinementParams::ByFunction is about.
std::vector<int> FunctionsToSplit(const SplineSpace<2>& space, const std::vector<int>& marked)
{
  const LRData& data = *space.LocallyRefined;
  std::vector<bool> isMarked(At(space.NumElements()), false);
  for (const int e : marked)
  {
    isMarked[At(e)] = true;
  }
  // area of the support, and of its marked part
  std::vector<double> all(At(space.NumFunctions), 0.0);
  std::vector<double> part(At(space.NumFunctions), 0.0);
  const auto forEachAlive = [&](int e, auto&& use)
  {
    for (std::size_t k = data.AliveStart[At(e)]; k < data.AliveStart[At(e) + 1]; ++k)
    {
      use(data.AliveFunctions[k]);
    }
  };
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const ParametricBox<2>& box = space.Elements[At(e)].Box;
    const double area = (box.Upper[0] - box.Lower[0]) * (box.Upper[1] - box.Lower[1]);
    forEachAlive(e,
      [&](int f)
      {
        all[At(f)] += area;
        part[At(f)] += isMarked[At(e)] ? area : 0.0;
      });
  }
  std::vector<bool> chosen(At(space.NumFunctions));
  for (int f = 0; f < space.NumFunctions; ++f)
  {
    chosen[At(f)] = part[At(f)] >= 0.5 * all[At(f)];
  }
  for (const int e : marked)
  {
    int best = -1;
    forEachAlive(e,
      [&](int f)
      {
        const bool better = best < 0 || part[At(f)] * all[At(best)] > part[At(best)] * all[At(f)];
        best = better ? f : best;
      });
    chosen[At(best)] = true;
  }
  std::vector<int> functions;
  for (int f = 0; f < space.NumFunctions; ++f)
  {
    if (chosen[At(f)])
    {
      functions.push_back(f);
    }
  }
  return functions;
}

Result<Spline<2>> Split(
  const Spline<2>& spline, const std::vector<int>& marked, const LRRefinementParams& params)
{
  // elements and functions keep their numbers when a tensor-product space becomes locally refined
  Result<Spline<2>> start = InsertSegments(spline, {}, params.Threads);
  if (!start || marked.empty())
  {
    return start;
  }
  const SplineSpace<2>& space = *start->Space;
  for (const int e : marked)
  {
    if (e < 0 || e >= space.NumElements())
    {
      return { ErrorCode::InvalidParameter,
        "there is no element " + std::to_string(e) + " among " +
          std::to_string(space.NumElements()) };
    }
  }
  const auto segments = params.ByFunction
    ? SegmentsForFunctions(space, FunctionsToSplit(space, marked), params.Segments)
    : SegmentsForElements(space, marked, params.Segments);
  return segments ? InsertSegments(start.Value, segments.Value, params.Threads) : segments.Status;
}
}

Result<RefinedSpline<2>> RefineMarkedLR(
  const Spline<2>& spline, const std::vector<int>& marked, const LRRefinementParams& params)
{
  if (Status status = spline.Check(); !status)
  {
    return status;
  }
  const SpaceKind kind = spline.Space->Kind;
  if (kind != SpaceKind::Tensor && kind != SpaceKind::LocallyRefined)
  {
    return { ErrorCode::DimensionMismatch,
      "only tensor-product and locally refined surfaces are refined by LR B-splines" };
  }
  RefinedSpline<2> result;
  result.Value = spline;
  if (!marked.empty())
  {
    Result<Spline<2>> split = Split(spline, marked, params);
    if (!split)
    {
      return split.Status;
    }
    result.Value = std::move(split.Value);
  }
  if (params.KeepIndependent && result.Value.Space->Kind == SpaceKind::LocallyRefined)
  {
    Result<LRResolution> resolution =
      ResolveDependence(result.Value, MaxResolvingSegments, params.Threads);
    if (!resolution)
    {
      return resolution.Status;
    }
    result.Value = std::move(resolution->Value);
  }
  result.Parents = ParentElements(*spline.Space, *result.Value.Space, 1);
  return result;
}
}
