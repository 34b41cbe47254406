// SPDX-License-Identifier: BSD-3-Clause
#include "RadialBackMap.h"
#include "GrevilleGrid.h"
#include "PenalizedFit.h"
#include "RadialSurface.h"
#include <knotwork/SplineCore/TensorSpace.h>

#include <algorithm>

namespace knotwork
{
namespace
{
constexpr int FirstElements = 16;
/// The radial surface is to be within this part of the tolerance at the chart's points, and the
/// spline within as much of the radial surface.
constexpr double FollowShare = 0.1;

Status Report(const BackMapParams& params, double done)
{
  if (params.Progress && !params.Progress(done))
  {
    return { ErrorCode::Aborted, "the back-map was stopped" };
  }
  return {};
}
}

Result<BackMap> FitRadial(const ChartMesh& chart, const BackMapParams& params)
{
  const auto radial = FitRadialSurface(
    chart.UV, chart.Points, params.Centres, FollowShare * params.Tolerance, params.Threads);
  if (!radial)
  {
    return radial.Status;
  }
  Status status = Report(params, 0.5);
  const ParametricBox<2> rectangle = BackMapRectangle(chart, params.Margin);
  const std::vector<std::array<int, 2>> boundary = BoundaryEdges(chart.Triangles);
  const bool byNeed = params.Elements == 0;
  int elements = byNeed ? std::min(FirstElements, params.MaxElements) : params.Elements;
  BackMap map;
  map.Centres = static_cast<int>(radial->Rows.size());
  while (status)
  {
    const NetKnots knots = UniformNet(rectangle, params.Degree, elements);
    if (Status size = CheckNet(knots, params); !size)
    {
      map.Stop = BackMapStop::Functions; // the nets before it are a result
      return map.Passes > 0 ? Result<BackMap>(std::move(map)) : Result<BackMap>(size);
    }
    auto surface = SplineOnNet(knots, {});
    if (!surface)
    {
      return surface.Status;
    }
    PointMatrix values =
      radial->Surface.Evaluate(GrevillePoints<2>(*surface->Space), params.Threads);
    if (params.Method == BackMapMethod::Rbf)
    {
      values = InterpolateOnGrid(knots, GrevilleLines(knots), values);
    }
    surface->ControlPoints = std::move(values);
    const BezierForm<2> form = MakeBezierForm(surface.Value, params.Threads);
    const BackMapResiduals residuals =
      MeasureBackMap(form, SampleChart(chart, boundary, knots, params.Threads), params.Threads);
    ++map.Passes;
    map.Surface = std::move(surface.Value);
    map.MaxResidual = residuals.Max;
    map.RmsResidual = residuals.Rms;
    map.WithinTolerance = residuals.Max <= params.Tolerance;
    status = Report(params, 0.5 + 0.5 * elements / std::max(elements, params.MaxElements));
    if (!byNeed || map.WithinTolerance || elements == params.MaxElements)
    {
      break;
    }
    const PointMatrix centres = ElementCentres(knots);
    EvaluationParams evaluation;
    evaluation.Threads = params.Threads;
    EvaluationBatch batch;
    EvaluateParameters<2>(form, centres, evaluation, batch);
    const PointMatrix target = radial->Surface.Evaluate(centres, params.Threads);
    if ((batch.Values - target).rowwise().norm().maxCoeff() <=
      FollowShare * std::max(params.Tolerance, map.MaxResidual))
    {
      break;
    }
    elements = std::min(2 * elements, params.MaxElements);
  }
  if (!status)
  {
    return status;
  }
  return map;
}
}
