// SPDX-License-Identifier: BSD-3-Clause
#include "GridExtrapolation.h"
#include "LineContinuation.h"
#include "PenalizedFit.h"
#include "SurfaceContinuation.h"

#include <algorithm>

namespace knotwork
{
namespace
{
constexpr int FirstElements = 16;
}

Result<BackMap> FitExtrapolated(const ChartMesh& chart, const BackMapParams& params)
{
  const ParametricBox<2> rectangle = BackMapRectangle(chart, params.Margin);
  const std::vector<std::array<int, 2>> boundary = BoundaryEdges(chart.Triangles);
  const bool byNeed = params.Elements == 0;
  int elements = byNeed ? std::min(FirstElements, params.MaxElements) : params.Elements;
  BackMap map;
  while (true)
  {
    const NetKnots knots = UniformNet(rectangle, params.Degree, elements);
    if (Status size = CheckNet(knots, params); !size)
    {
      map.Stop = BackMapStop::Functions; // the nets before it are a result
      return map.Passes > 0 ? Result<BackMap>(std::move(map)) : Result<BackMap>(size);
    }
    Result<Spline<2>> surface = params.Method == BackMapMethod::Nurbs
      ? ContinueSurface(
          chart, rectangle, params.Degree, { knots[0].NumFunctions(), knots[1].NumFunctions() })
      : ContinueLines(chart, knots);
    if (!surface && byNeed && map.Passes == 0 && elements < params.MaxElements)
    {
      elements = std::min(2 * elements, params.MaxElements); // a grid too coarse for the chart
      continue;
    }
    if (!surface && map.Passes > 0)
    {
      return map; // finer nets overflow
    }
    if (!surface)
    {
      return surface.Status;
    }
    const BackMapResiduals residuals = MeasureBackMap(MakeBezierForm(surface.Value, params.Threads),
      SampleChart(chart, boundary, knots, params.Threads), params.Threads);
    if (map.Passes == 0 || residuals.Max < map.MaxResidual) // finer nets may be worse
    {
      map.Surface = std::move(surface.Value);
      map.MaxResidual = residuals.Max;
      map.RmsResidual = residuals.Rms;
      map.WithinTolerance = residuals.Max <= params.Tolerance;
    }
    ++map.Passes;
    if (params.Progress &&
      !params.Progress(static_cast<double>(elements) / std::max(elements, params.MaxElements)))
    {
      return { ErrorCode::Aborted, "the back-map was stopped" };
    }
    if (!byNeed || map.WithinTolerance || elements >= params.MaxElements)
    {
      return map;
    }
    elements = std::min(2 * elements, params.MaxElements);
  }
}
}
