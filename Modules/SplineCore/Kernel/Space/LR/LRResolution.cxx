// SPDX-License-Identifier: BSD-3-Clause
#include "LRDependence.h"

#include <algorithm>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Segments across the support of a function that split it: first along lines that are there in
/// part, then through the middle of its longest spans.
std::vector<LRSegment> SplittingSegments(const LRBasis& basis, int f)
{
  std::vector<LRSegment> going, fresh;
  for (int d = 0; d < 2; ++d)
  {
    const std::vector<double>& values = basis.Knots[At(d)];
    const int* knots = basis.Local(f, d);
    const int* across = basis.Local(f, 1 - d);
    const int last = basis.Degree[At(d)] + 1;
    const int low = across[0];
    const int high = across[basis.Degree[At(1 - d)] + 1];
    LRSegment segment;
    segment.Direction = d;
    segment.Start = basis.Knots[At(1 - d)][At(low)];
    segment.End = basis.Knots[At(1 - d)][At(high)];
    for (int k = knots[0] + 1; k < knots[last]; ++k)
    {
      int most = 0;
      for (int i = low; i < high; ++i)
      {
        most = std::max(most, LRMultiplicity(basis.Lines[At(d)][At(k)], i, i + 1));
      }
      if (most > 0 && std::find(knots, knots + last + 1, k) == knots + last + 1)
      {
        segment.Value = values[At(k)];
        going.push_back(segment);
      }
    }
    for (int i = 0; i < last; ++i)
    {
      if (knots[i] < knots[i + 1])
      {
        segment.Value = 0.5 * (values[At(knots[i])] + values[At(knots[i + 1])]);
        fresh.push_back(segment);
      }
    }
  }
  going.insert(going.end(), fresh.begin(), fresh.end());
  return going;
}

/// The first of the segments that leaves fewer relations.
Result<SplineSpacePtr<2>> Improve(const SplineSpacePtr<2>& space,
  const LRDependenceResult& relation, int threads, LRSegment& chosen, LRDependenceResult& better)
{
  for (const int f : relation.Functions)
  {
    for (const LRSegment& segment : SplittingSegments(space->LocallyRefined->Basis, f))
    {
      Result<SplineSpacePtr<2>> refined = InsertSegments(space, { segment }, threads);
      if (!refined)
      {
        continue;
      }
      Result<LRDependenceResult> decided = DecideDependence(*refined.Value);
      if (decided->Verdict != LRVerdict::Undecided && decided->Defect < relation.Defect)
      {
        chosen = segment;
        better = std::move(decided.Value);
        return refined;
      }
    }
  }
  return { ErrorCode::NotConverged, "no segment across a function of the relation resolves it" };
}
}

Result<LRResolution> ResolveDependence(const Spline<2>& spline, int maxSegments, int threads)
{
  if (Status status = spline.Check(); !status)
  {
    return status;
  }
  Result<LRDependenceResult> decided = DecideDependence(*spline.Space);
  if (!decided)
  {
    return decided.Status;
  }
  LRResolution resolution;
  SplineSpacePtr<2> space = spline.Space;
  while (decided->Verdict == LRVerdict::Dependent)
  {
    if (static_cast<int>(resolution.Segments.size()) >= maxSegments)
    {
      return { ErrorCode::NotConverged,
        std::to_string(decided->Defect) + " relations are left after " +
          std::to_string(maxSegments) + " segments" };
    }
    LRSegment segment;
    LRDependenceResult better;
    Result<SplineSpacePtr<2>> refined = Improve(space, decided.Value, threads, segment, better);
    if (!refined)
    {
      return refined.Status;
    }
    space = refined.Value;
    decided.Value = std::move(better);
    resolution.Segments.push_back(segment);
  }
  if (decided->Verdict == LRVerdict::Undecided)
  {
    return { ErrorCode::NotConverged,
      std::to_string(decided->Unpeeled.size()) + " functions are too many for an elimination" };
  }
  Result<Spline<2>> value = InsertSegments(spline, resolution.Segments, threads);
  if (!value)
  {
    return value.Status;
  }
  resolution.Value = std::move(value.Value);
  return resolution;
}
}
