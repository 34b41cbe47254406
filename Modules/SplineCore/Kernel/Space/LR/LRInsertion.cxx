// SPDX-License-Identifier: BSD-3-Clause
#include "LRRefinement.h"

namespace knotwork
{
namespace
{
Status InsertAll(LRRefinement& refinement, const std::vector<LRSegment>& segments)
{
  for (std::size_t i = 0; i < segments.size(); ++i)
  {
    if (const Status status = refinement.Insert(segments[i]); !status)
    {
      return { status.Code, "segment " + std::to_string(i) + ": " + status.Detail };
    }
  }
  return {};
}

Result<SplineSpacePtr<2>> AsLocallyRefined(const SplineSpacePtr<2>& space, int threads)
{
  if (space->Kind == SpaceKind::LocallyRefined)
  {
    return space;
  }
  Result<LRBasis> basis = LRBasisOfTensor(*space);
  return basis ? MakeLRSpace(std::move(basis.Value), threads) : basis.Status;
}
}

Result<SplineSpacePtr<2>> InsertSegments(
  const SplineSpacePtr<2>& space, const std::vector<LRSegment>& segments, int threads)
{
  const Result<SplineSpacePtr<2>> start = AsLocallyRefined(space, threads);
  if (!start || segments.empty())
  {
    return start;
  }
  LRRefinement refinement(*start.Value, PointMatrix(space->NumFunctions, 0));
  const Status status = InsertAll(refinement, segments);
  return status ? refinement.Finish(nullptr, threads) : status;
}

Result<Spline<2>> InsertSegments(
  const Spline<2>& spline, const std::vector<LRSegment>& segments, int threads)
{
  if (Status status = spline.Check(); !status)
  {
    return status;
  }
  Spline<2> result = spline;
  Result<SplineSpacePtr<2>> space = AsLocallyRefined(spline.Space, threads);
  if (space && !segments.empty())
  {
    LRRefinement refinement(*space.Value, spline.HomogeneousPoints());
    if (const Status status = InsertAll(refinement, segments); !status)
    {
      return status;
    }
    PointMatrix rows;
    const Result<SplineSpacePtr<2>> larger = refinement.Finish(&rows, threads);
    if (!larger)
    {
      return larger.Status;
    }
    // where all was there already, points keep every bit
    if (!(larger.Value->LocallyRefined->Basis == space.Value->LocallyRefined->Basis))
    {
      space = larger;
      result.SetHomogeneousPoints(rows, spline.IsRational());
    }
  }
  result.Space = space.Value;
  return space ? Result<Spline<2>>(std::move(result)) : space.Status;
}
}
