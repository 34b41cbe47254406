// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeSamples.h"

#include <knotwork/SplineCore/Numbers.h>

#include <algorithm>

namespace knotwork
{
namespace
{
constexpr int SamplesOfSpan = 16;
/// Of the surface's domain: pcurves that leave it by rounding.
constexpr double DomainTolerance = 1e-9;

PointMatrix PlacesOf(const KnotVector& first, const KnotVector& second)
{
  std::vector<double> breaks = first.Breaks();
  breaks.insert(breaks.end(), second.Breaks().begin(), second.Breaks().end());
  std::sort(breaks.begin(), breaks.end());
  breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
  const auto spans = static_cast<Eigen::Index>(breaks.size()) - 1;
  PointMatrix places(spans * SamplesOfSpan + 1, 1);
  for (Eigen::Index i = 0; i < places.rows(); ++i)
  {
    const Eigen::Index span = std::min(i / SamplesOfSpan, spans - 1);
    const double s = static_cast<double>(i - span * SamplesOfSpan) / SamplesOfSpan;
    const auto b = static_cast<std::size_t>(span);
    places(i, 0) = (1.0 - s) * breaks[b] + s * breaks[b + 1];
  }
  return places;
}
}

Result<EdgeSamples> SampleEdge(
  const Spline<1>& curve, const Spline<1>& parameters, const BezierForm<2>& surface)
{
  const PointMatrix places = PlacesOf(curve.Space->Knots[0], parameters.Space->Knots[0]);
  EvaluationParams params;
  params.Threads = 1;
  EvaluationBatch points;
  EvaluationBatch uv;
  Status status = EvaluateParameters<1>(MakeBezierForm<1>(curve, 1), places, params, points);
  if (status)
  {
    status = EvaluateParameters<1>(MakeBezierForm<1>(parameters, 1), places, params, uv);
  }
  if (!status)
  {
    return status;
  }
  const ParametricBox<2> domain = surface.Space->Domain();
  for (Eigen::Index i = 0; i < places.rows(); ++i)
  {
    for (std::size_t d = 0; d < 2; ++d)
    {
      double& u = uv.Values(i, static_cast<Eigen::Index>(d));
      const double allowed = DomainTolerance * (domain.Upper[d] - domain.Lower[d]);
      if (!(u >= domain.Lower[d] - allowed && u <= domain.Upper[d] + allowed))
      {
        return { ErrorCode::OutsideDomain,
          std::string("the pcurve leaves the surface's domain: ") + (d == 0 ? "u = " : "v = ") +
            Digits(u) };
      }
      u = std::min(std::max(u, domain.Lower[d]), domain.Upper[d]);
    }
  }
  EvaluationBatch image;
  status = EvaluateParameters<2>(surface, uv.Values, params, image);
  if (!status)
  {
    return status;
  }
  return EdgeSamples{ std::move(points.Values), std::move(image.Values) };
}
}
