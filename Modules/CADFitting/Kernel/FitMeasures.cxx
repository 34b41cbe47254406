// SPDX-License-Identifier: BSD-3-Clause
#include "FitMeasures.h"

#include "ElementPatch.h"
#include "QueryBlocks.h"
#include "SampledDistances.h"

#include <knotwork/JacobianValidation/CellMeasures.h>
#include <knotwork/SplineCore/MeshTraces.h>
#include <knotwork/SplineCore/Quadrature.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
/// By which the surface's distance from the target may grow, or what share of the mesh's own it may
/// reach, when elements are mended.
constexpr double MostGrowth = 2.0;
constexpr double MostOfMesh = 0.25;
/// Of the largest distance that is found: how near the facets are that bounds are proved with, and
/// bounds that are good enough as they are; the least one that counts, of the target's size.
constexpr double FacetShare = 0.05;
constexpr double EnoughShare = 0.5;
constexpr double LeastBound = 1e-4;

/// Local parameters of the corners of every quadrilateral on the element of the surface.
template <int Dim>
std::vector<std::array<double, 8>> CornersOnElements(
  const FittedMesh<Dim>& mesh, const MeshTrace<2>& trace)
{
  std::vector<std::array<double, 8>> corners;
  for (std::size_t q = 0; q < mesh.Surface.Quads.size(); ++q)
  {
    std::array<double, 8>& own = corners.emplace_back();
    if constexpr (Dim == 2)
    {
      own = { 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0 };
    }
    else
    {
      const int* cell = mesh.Mesh.Cell(mesh.Surface.Facets[q].Cell);
      const TraceElement<2>& element = trace.Elements[q];
      for (std::size_t k = 0; k < 4; ++k)
      {
        const int corner =
          static_cast<int>(std::find(cell, cell + 8, mesh.Surface.Quads[q][k]) - cell);
        for (std::size_t d = 0; d < 2; ++d)
        {
          own[2 * k + d] = (corner >> element.Direction[d] & 1) ^ (element.Reversed[d] ? 1 : 0);
        }
      }
    }
  }
  return corners;
}

/// Volume that a surface without a rim encloses, by the divergence theorem: Gauss points enough for
/// polynomials of its degrees; 0 of others.
double VolumeEnclosed(
  const FittedMesh<2>& mesh, const Spline<2>& surface, const CADFitParams& params)
{
  const bool isClosed = BoundaryFacets<2>(mesh.Topology).empty();
  for (int side = 0; side < 4 * mesh.Topology.NumCells(); ++side)
  {
    if (!isClosed || !mesh.Topology.Crossing(side / 4, side % 4).Coherent)
    {
      return 0.0; // cells are oriented differently
    }
  }
  const BezierForm<2> form = MakeBezierForm(surface, params.Threads);
  const int count = 3 * params.Space.Degree / 2 + 1;
  const ElementQuadrature<2> rule = MakeElementQuadrature<2>({ count, count });
  EvaluationParams evaluation;
  evaluation.Derivatives = 1;
  evaluation.Threads = params.Threads;
  EvaluationBatch batch;
  double sum = 0.0;
  for (int e = 0; e < surface.Space->NumElements(); ++e)
  {
    EvaluateElements<2>(form, std::vector<int>(static_cast<std::size_t>(rule.Local.rows()), e),
      rule.Local, evaluation, batch);
    for (Eigen::Index i = 0; i < rule.Local.rows(); ++i)
    {
      const Eigen::RowVector3d u = batch.First.row(i).head<3>();
      const Eigen::RowVector3d v = batch.First.row(i).tail<3>();
      sum += rule.Weights[i] * u.cross(v).dot(batch.Values.row(i)) / 3.0;
    }
  }
  return std::abs(sum);
}

/// Area of a volume's surface. @param fitted  what of the surface is fitted.
Result<double> AreaAround(const FittedMesh<3>& mesh, const Spline<3>& spline,
  const Spline<2>& fitted, const CADFitParams& params)
{
  Spline<2> surface = fitted;
  if (mesh.IsPart)
  {
    const auto trace = TraceOnFacets(*spline.Space, BoundaryFacets<3>(mesh.Topology));
    if (!trace)
    {
      return trace.Status;
    }
    surface = TraceOf<2>(spline, trace.Value);
  }
  const auto measures = MeasureCells(MakeBernsteinCells(MakeBezierForm(surface, params.Threads)));
  return measures ? measures->Total.Measure : 0.0;
}

/// The surface of the spline, a trace of volumes, or what of it is fitted.
template <int Dim>
Status TraceSurface(
  const FittedMesh<Dim>& mesh, const Spline<Dim>& spline, Spline<2>& surface, MeshTrace<2>& trace)
{
  if constexpr (Dim == 2)
  {
    surface = spline;
    if (mesh.IsPart)
    {
      trace = PartOnFacets(*spline.Space, mesh.Surface.Facets);
      surface = PartOf(spline, trace);
    }
  }
  else
  {
    auto made = TraceOnFacets(*spline.Space, mesh.Surface.Facets);
    if (!made)
    {
      return made.Status;
    }
    trace = std::move(made.Value);
    surface = TraceOf<2>(spline, trace);
  }
  return {};
}

template <int Dim>
Result<FitDistances> MeasureFrom(const FittedMesh<Dim>& mesh, const Spline<2>& surface,
  const MeshTrace<2>& trace, SampledDistanceParams params)
{
  params.Surfaces = mesh.HasSurfaces || !mesh.IsFitted;
  PointMatrix points = mesh.Points;
  points.topRows(mesh.Given->rows()) = *mesh.Given;
  return MeasureDistances(surface, mesh.Surface, CornersOnElements(mesh, trace), mesh.Parts, points,
    *mesh.Target, params);
}

/// Bounds of distances that are as near to the largest ones as that is cheap.
template <int Dim>
Status Bound(const FittedMesh<Dim>& mesh, const Spline<2>& surface, const CADFitParams& params,
  CADFit<Dim>& fit)
{
  const TriangleIndex<3>* triangles = mesh.Target->Triangles();
  if (!triangles || !mesh.IsFitted || !mesh.HasSurfaces || mesh.IsPart ||
    surface.Space->NumElements() > params.BoundedElements)
  {
    return {};
  }
  const PointMatrix& points = triangles->Points();
  const double size = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
  const double largest = std::max(
    { fit.Distances.ToTarget.Largest, fit.Distances.FromTarget.Largest, LeastBound * size });
  DeviationBoundParams own;
  own.Tolerance = FacetShare * largest;
  own.Enough = EnoughShare * largest;
  own.Threads = params.Threads;
  own.Progress = PartOf(params.Progress, 0.9, 1.0);
  auto bound = BoundSurfaceDeviation(MakeBezierForm(surface, params.Threads), *triangles, own);
  if (bound)
  {
    fit.Bound = std::move(bound.Value);
  }
  return bound.Status.Code == ErrorCode::TooLarge ? Status() : bound.Status;
}
}

double AllowedDistance(const FitDistances& before)
{
  return std::max(
    MostGrowth * before.ToTarget.RootMeanSquare, MostOfMesh * before.MeshToTarget.RootMeanSquare);
}

template <int Dim>
Result<double> DistanceFromTarget(const FittedMesh<Dim>& mesh, const Spline<Dim>& spline,
  const CADFitParams& params, double* allowed)
{
  if (!mesh.Target)
  {
    return 0.0;
  }
  Spline<2> surface;
  MeshTrace<2> trace;
  if (Status status = TraceSurface(mesh, spline, surface, trace); !status)
  {
    return status;
  }
  SampledDistanceParams own;
  own.Samples = 2;
  own.Threads = params.Threads;
  const auto distances = MeasureFrom(mesh, surface, trace, own);
  if (distances && allowed)
  {
    *allowed = AllowedDistance(distances.Value);
  }
  return distances ? Result<double>(distances->ToTarget.RootMeanSquare) : distances.Status;
}

template <int Dim>
Status MeasureFit(const FittedMesh<Dim>& mesh, const CADFitParams& params, CADFit<Dim>& fit)
{
  const BezierForm<Dim> form = MakeBezierForm(fit.Value, params.Threads);
  if (const auto measures = MeasureCells(MakeBernsteinCells(form)))
  {
    (Dim == 2 ? fit.Area : fit.Volume) = std::abs(measures->Total.Measure);
  }
  Spline<2> surface;
  MeshTrace<2> trace;
  if (Status status = TraceSurface(mesh, fit.Value, surface, trace); !status)
  {
    return status;
  }
  if constexpr (Dim == 3)
  {
    const auto area = AreaAround(mesh, fit.Value, surface, params);
    if (!area)
    {
      return area.Status;
    }
    fit.Area = area.Value;
  }
  else
  {
    fit.Volume = VolumeEnclosed(mesh, fit.Value, params);
  }
  if (!mesh.Target)
  {
    return {};
  }
  SampledDistanceParams own;
  own.TargetSamples = mesh.IsPart ? 0 : params.TargetSamples;
  own.Threads = params.Threads;
  own.Progress = PartOf(params.Progress, 0.8, 0.9);
  auto distances = MeasureFrom(mesh, surface, trace, own);
  fit.Distances = std::move(distances.Value);
  return distances ? Bound(mesh, surface, params, fit) : distances.Status;
}

template Result<double> DistanceFromTarget(
  const FittedMesh<2>&, const Spline<2>&, const CADFitParams&, double*);
template Result<double> DistanceFromTarget(
  const FittedMesh<3>&, const Spline<3>&, const CADFitParams&, double*);
template Status MeasureFit(const FittedMesh<2>&, const CADFitParams&, CADFit<2>&);
template Status MeasureFit(const FittedMesh<3>&, const CADFitParams&, CADFit<3>&);
}
