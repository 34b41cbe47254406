// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceExtraction.h"

namespace knotwork
{
Result<AnySpline> ExtractFromSurface(const Spline<2>& surface, const ExtractionParams& params)
{
  if (Status status = surface.Check(); !status)
  {
    return status;
  }
  const int threads = params.Threads;
  const bool toTensor = params.ExpandToTensor || surface.Space->Kind == SpaceKind::Tensor;
  Result<Spline<2>> result = InsertSegments(surface, {}, threads);
  const auto apply = [&result](auto&& operation)
  {
    if (result)
    {
      result = operation(result.Value);
    }
  };
  if (params.Restrict)
  {
    apply([&](const Spline<2>& spline) { return RestrictToBox(spline, params.Box, threads); });
  }
  if (params.Swap)
  {
    apply([&](const Spline<2>& spline) { return SwapParameters(spline, threads); });
  }
  for (int d = 0; d < 2; ++d)
  {
    if (params.Reverse[static_cast<std::size_t>(d)])
    {
      apply([&](const Spline<2>& spline) { return ReverseParameter(spline, d, threads); });
    }
  }
  if (params.MoveDomain)
  {
    apply([&](const Spline<2>& spline) { return MoveDomain(spline, params.Domain, threads); });
  }
  if (result && params.IsoDirection >= 0)
  {
    Result<Spline<1>> curve = IsoCurve(result.Value, params.IsoDirection, params.IsoValue, threads);
    return curve ? Result<AnySpline>(AnySpline(std::move(curve.Value))) : curve.Status;
  }
  if (toTensor)
  {
    apply([&](const Spline<2>& spline)
      { return ExpandToTensor(spline, threads, params.MaxFunctions); });
  }
  return result ? Result<AnySpline>(AnySpline(std::move(result.Value))) : result.Status;
}
}
