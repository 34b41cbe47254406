// SPDX-License-Identifier: BSD-3-Clause
#include "TrimToPoints.h"

#include "BezierForm.h"
#include "LROperations.h"
#include "LocallyRefinedForm.h"
#include "Parallel.h"
#include "TrimmedRegion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr std::size_t ChunkSize = 1024; // points

/// NaN passes: the outline names it.
Status CheckInside(const Spline<2>& surface, const PointMatrixView& parameters)
{
  if (Status status = surface.Check(); !status)
  {
    return status;
  }
  const ParametricBox<2> domain = surface.Space->Domain();
  for (Eigen::Index d = 0; d < std::min<Eigen::Index>(2, parameters.cols()); ++d)
  {
    const double lower = domain.Lower[static_cast<std::size_t>(d)];
    const double upper = domain.Upper[static_cast<std::size_t>(d)];
    for (Eigen::Index i = 0; i < parameters.rows(); ++i)
    {
      if (parameters(i, d) < lower || parameters(i, d) > upper)
      {
        return { ErrorCode::OutsideDomain,
          "point " + std::to_string(i) + " is not over the surface; leave it out" };
      }
    }
  }
  return {};
}

Result<Spline<2>> TensorSurface(const Spline<2>& surface, int threads)
{
  if (surface.IsRational())
  {
    return { ErrorCode::InvalidWeight,
      "the surface is rational: only polynomial ones, as fits are, can be trimmed to points" };
  }
  if (surface.NumComponents() < 3)
  {
    return { ErrorCode::SizeMismatch, "the surface has fewer than three components" };
  }
  Spline<2> geometry = surface;
  geometry.ControlPoints = surface.ControlPoints.leftCols(3).eval();
  if (surface.Space->Kind == SpaceKind::Tensor)
  {
    return geometry;
  }
  auto local = MakeLocallyRefined(geometry, threads);
  return local ? ExpandToTensor(local.Value, threads) : local;
}

/// Parts of the outline on the surface.
Result<std::vector<ChartMesh>> MakeCharts(
  const CloudOutline& outline, const Spline<2>& surface, int threads)
{
  const BezierForm<2> form = MakeBezierForm(surface, threads);
  std::vector<ChartMesh> charts;
  for (const OutlinePart& part : outline.Parts)
  {
    EvaluationBatch batch;
    if (Status status = EvaluateParameters(form, part.Points, { 0, threads }, batch); !status)
    {
      return status;
    }
    ChartMesh chart;
    chart.Points = batch.Values;
    chart.UV = part.Points;
    chart.Triangles = part.Triangles;
    charts.push_back(std::move(chart));
  }
  return charts;
}

/// Length in space over length in the plane, on average.
double MeanScale(const std::vector<ChartMesh>& charts)
{
  double flat = 0.0;
  double area = 0.0;
  for (const ChartMesh& chart : charts)
  {
    for (const auto& [a, b, c] : chart.Triangles)
    {
      const Eigen::RowVector3d u = chart.Points.row(b) - chart.Points.row(a);
      const Eigen::RowVector3d v = chart.Points.row(c) - chart.Points.row(a);
      area += u.cross(v).norm();
      const Eigen::RowVector2d x = chart.UV.row(b) - chart.UV.row(a);
      const Eigen::RowVector2d y = chart.UV.row(c) - chart.UV.row(a);
      flat += x[0] * y[1] - x[1] * y[0];
    }
  }
  return std::sqrt(area / flat);
}

Result<std::size_t> CountOutside(
  const TrimmedModel& model, const PointMatrixView& parameters, int threads)
{
  std::vector<TrimmedRegion> regions;
  for (const TrimmedFace& face : model.Faces)
  {
    auto region = TrimmedRegion::Create(face.Loops);
    if (!region)
    {
      return region.Status;
    }
    regions.push_back(std::move(region.Value));
  }
  const auto n = static_cast<std::size_t>(parameters.rows());
  std::vector<std::size_t> outside(n / ChunkSize + 1, 0);
  ParallelFor(n, ChunkSize, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const auto row = static_cast<Eigen::Index>(i);
        bool inside = false;
        for (const TrimmedRegion& region : regions)
        {
          inside = inside ||
            region.Contains({ parameters(row, 0), parameters(row, 1) }) != RegionPlace::Outside;
        }
        outside[begin / ChunkSize] += inside ? 0 : 1;
      }
    });
  std::size_t count = 0;
  for (const std::size_t part : outside)
  {
    count += part;
  }
  return count;
}
}

Result<TrimmedToPoints> TrimToPoints(
  const Spline<2>& surface, const PointMatrixView& parameters, const TrimToPointsParams& params)
{
  if (!(params.Tolerance >= 0.0 && std::isfinite(params.Tolerance)))
  {
    return { ErrorCode::InvalidParameter, "the tolerance must be 0 or more" };
  }
  const Status inside = CheckInside(surface, parameters);
  auto tensor = inside ? TensorSurface(surface, params.Threads) : inside;
  const auto outline = tensor ? FindCloudOutline(parameters, params.Outline) : tensor.Status;
  if (!outline)
  {
    return outline.Status;
  }
  const auto charts = MakeCharts(outline.Value, tensor.Value, params.Threads);
  if (!charts)
  {
    return charts.Status;
  }

  TrimmedToPoints result;
  result.CellSize = outline->CellSize;
  result.MaxGap = outline->MaxGap;
  result.Tolerance =
    params.Tolerance > 0.0 ? params.Tolerance : MeanScale(charts.Value) * outline->CellSize / 3.0;
  LoopParams loopParams;
  loopParams.Tolerance = result.Tolerance;
  loopParams.CornerAngle = params.CornerAngle;
  loopParams.Threads = params.Threads;
  loopParams.Progress = params.Progress;
  const std::vector<Spline<2>> surfaces(charts->size(), tensor.Value);
  auto loops = FitLoops(charts.Value, surfaces, loopParams);
  if (!loops)
  {
    return loops.Status;
  }
  result.Loops = loops->Verdicts;
  result.MaxTrimDistance = loops->MaxTrimDistance;
  result.Model.NumEdges = loops->NumEdges;
  result.Model.NumVertices = loops->NumVertices;
  FaceCertificateParams certificate;
  certificate.Threads = params.Threads;
  for (std::size_t c = 0; c < charts->size(); ++c)
  {
    TrimmedFace face;
    face.Surface = tensor.Value;
    face.Loops = std::move(loops->Loops[c]);
    face.Body = static_cast<int>(c);
    result.NumLoops += static_cast<int>(face.Loops.size());
    auto proved = CertifyFace(face, certificate);
    if (!proved)
    {
      return proved.Status;
    }
    result.Certificates.push_back(std::move(proved.Value));
    result.Model.Faces.push_back(std::move(face));
  }
  const auto outside = CountOutside(result.Model, parameters, params.Threads);
  result.NumPointsOutside = outside.Value;
  return outside ? Result<TrimmedToPoints>(std::move(result)) : outside.Status;
}
}
