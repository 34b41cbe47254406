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

Status CheckKind(const Spline<2>& spline)
{
  if (Status status = spline.Check(); !status)
  {
    return status;
  }
  const SpaceKind kind = spline.Space->Kind;
  return kind == SpaceKind::Tensor || kind == SpaceKind::LocallyRefined
    ? Status()
    : Status(ErrorCode::DimensionMismatch,
        "only tensor-product and locally refined surfaces are refined by LR B-splines");
}

/// Without dependent functions, where that is wanted, and with the elements that it came from.
Result<RefinedSpline<2>> Finished(
  const Spline<2>& given, Result<Spline<2>> refined, const LRRefinementParams& params)
{
  if (!refined)
  {
    return refined.Status;
  }
  RefinedSpline<2> result;
  result.Value = std::move(refined.Value);
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
  result.Parents = ParentElements(*given.Space, *result.Value.Space, 1);
  return result;
}
}

Result<RefinedSpline<2>> RefineMarkedLR(
  const Spline<2>& spline, const std::vector<int>& marked, const LRRefinementParams& params)
{
  const Status status = CheckKind(spline);
  return status ? Finished(spline, marked.empty() ? spline : Split(spline, marked, params), params)
                : status;
}

Result<RefinedSpline<2>> RefineBySegments(const Spline<2>& spline,
  const std::vector<LRSegment>& segments, int maxFunctions, const LRRefinementParams& params)
{
  const Status status = CheckKind(spline);
  return status
    ? Finished(spline, InsertAllSegments(spline, segments, maxFunctions, params.Threads), params)
    : status;
}
}
