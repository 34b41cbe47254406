// SPDX-License-Identifier: BSD-3-Clause
#include "TrimToPoints.h"

#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/BoxTree.h>
#include <knotwork/SplineCore/LROperations.h>
#include <knotwork/SplineCore/LocallyRefinedForm.h>
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/TensorRestriction.h>
#include <knotwork/SplineCore/TrimmedRegion.h>

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

Result<Spline<2>> TensorSurface(const Spline<2>& surface, int maxFunctions, int threads)
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
  return local ? ExpandToTensor(local.Value, threads, maxFunctions) : local;
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

/// The surface around every chart, up to the next knots: trimming curves may be `margin` outside.
Result<std::vector<Spline<2>>> CutToCharts(
  const Spline<2>& surface, const std::vector<ChartMesh>& charts, double margin)
{
  std::vector<Spline<2>> parts;
  for (const ChartMesh& chart : charts)
  {
    ParametricBox<2> box;
    for (std::size_t d = 0; d < 2; ++d)
    {
      const auto uv = chart.UV.col(static_cast<Eigen::Index>(d));
      const std::vector<double>& breaks = surface.Space->Knots[d].Breaks();
      const auto low = std::upper_bound(breaks.begin(), breaks.end(), uv.minCoeff() - margin);
      const auto high = std::lower_bound(breaks.begin(), breaks.end(), uv.maxCoeff() + margin);
      box.Lower[d] = low == breaks.begin() ? breaks.front() : *(low - 1);
      box.Upper[d] = high == breaks.end() ? breaks.back() : *high;
    }
    auto part = RestrictTensor(surface, box);
    if (!part)
    {
      return part.Status;
    }
    parts.push_back(std::move(part.Value));
  }
  return parts;
}

/// Points in no face. Faces are looked up by the domains of their surfaces.
Result<std::size_t> CountOutside(
  const TrimmedModel& model, const PointMatrixView& parameters, int threads)
{
  std::vector<TrimmedRegion> regions;
  const auto numFaces = static_cast<Eigen::Index>(model.Faces.size());
  PointMatrix lower(numFaces, 2);
  PointMatrix upper(numFaces, 2);
  for (const TrimmedFace& face : model.Faces)
  {
    auto region = TrimmedRegion::Create(face.Loops);
    if (!region)
    {
      return region.Status;
    }
    const ParametricBox<2> box = face.Surface.Space->Domain();
    const auto row = static_cast<Eigen::Index>(regions.size());
    lower.row(row) << box.Lower[0], box.Lower[1];
    upper.row(row) << box.Upper[0], box.Upper[1];
    regions.push_back(std::move(region.Value));
  }
  const BoxTree faces(lower, upper);
  const auto n = static_cast<std::size_t>(parameters.rows());
  std::vector<std::size_t> outside(n / ChunkSize + 1, 0);
  ParallelFor(n, ChunkSize, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const auto row = static_cast<Eigen::Index>(i);
        const RealArray<2> point{ parameters(row, 0), parameters(row, 1) };
        bool inside = false;
        faces.ForNear(point.data(), point.data(),
          [&](int face)
          {
            inside = inside ||
              regions[static_cast<std::size_t>(face)].Contains(point) != RegionPlace::Outside;
          });
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
  auto tensor = inside ? TensorSurface(surface, params.MaxFunctions, params.Threads) : inside;
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
  const double scale = MeanScale(charts.Value);
  result.Tolerance = params.Tolerance > 0.0 ? params.Tolerance : scale * outline->CellSize / 3.0;
  LoopParams loopParams;
  loopParams.Tolerance = result.Tolerance;
  loopParams.CornerAngle = params.CornerAngle;
  loopParams.Threads = params.Threads;
  loopParams.Progress = params.Progress;
  auto surfaces =
    CutToCharts(tensor.Value, charts.Value, 2.0 * (outline->CellSize + result.Tolerance / scale));
  if (!surfaces)
  {
    return surfaces.Status;
  }
  tensor.Value = {};
  auto loops = FitLoops(charts.Value, surfaces.Value, loopParams);
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
    face.Surface = std::move(surfaces.Value[c]);
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
