// SPDX-License-Identifier: BSD-3-Clause
#include "FittedSpline.h"

#include "QueryBlocks.h"

#include <knotwork/SplineCore/MeshGeometry.h>

namespace knotwork
{
namespace
{
template <int Dim>
Status MakeSpace(const FittedMesh<Dim>& mesh, bool hasMeanLengths, bool areFeaturesProlonged,
  const CADFitParams& params, FittedSpline<Dim>& fitted)
{
  UnstructuredParams own = params.Space;
  if (hasMeanLengths)
  {
    auto lengths = MeanSheetLengths<Dim>(mesh.Mesh, mesh.Topology, mesh.Points);
    if (!lengths)
    {
      return lengths.Status;
    }
    own.Lengths = std::move(lengths.Value);
  }
  const std::vector<CellSide> facets =
    FeatureFacets<Dim>(mesh.Mesh, mesh.Topology, mesh.Surface, mesh.Parts);
  own.Features.insert(own.Features.end(), facets.begin(), facets.end());
  if (areFeaturesProlonged)
  {
    own.Features = Prolong<Dim>(mesh.Topology, own.Features);
  }
  auto made = MakeUnstructuredSpace<Dim>(mesh.Mesh, own);
  if (made)
  {
    fitted.Space = std::move(made->Space);
    fitted.Policy = made->Policy;
  }
  return made.Status;
}

/// Patches that are filled from their boundaries and are not valid are fitted inside.
template <int Dim>
Status GiveUpFastPath(
  const FittedMesh<Dim>& mesh, const CADFitParams& params, FittedSpline<Dim>& fitted)
{
  const std::size_t count = fitted.Verdicts.Bad.size();
  FastPath<Dim> own;
  own.Space = fitted.Space;
  own.Tried = fitted.Fast.Path;
  own.Note = std::to_string(count) + " elements had no certificate";
  fitted.Fast = std::move(own);
  Status status = fitted.Project(mesh, params);
  return status ? fitted.Certify(params, fitted.Verdicts) : status;
}

template <int Dim>
FastPathParams PathParams(
  const FittedMesh<Dim>& mesh, const CADFitParams& params, CreasePolicy policy)
{
  FastPathParams own;
  own.Path = params.Path;
  own.Weights = params.CompositeWeights;
  own.IsFull = policy == CreasePolicy::Full;
  own.IsMeshTheTarget = !mesh.IsFitted;
  own.IsInsideFitted = Dim == 2 && mesh.IsFitted && mesh.HasSurfaces;
  return own;
}

template <int Dim>
ProgressiveFitParams ProgressiveParams(
  const FittedMesh<Dim>& mesh, const CADFitParams& params, const std::vector<int>& linearCells)
{
  ProgressiveFitParams own;
  own.Surfaces = mesh.IsFitted && mesh.HasSurfaces;
  own.Curves = mesh.IsFitted && params.Curves;
  own.Points = mesh.IsFitted && params.Points;
  own.Constrain = params.Constrain;
  own.Projections = mesh.IsFitted ? params.Projections : 1;
  own.ExtraPoints = params.ExtraPoints;
  own.Threads = params.Threads;
  own.LinearCells = linearCells;
  own.Progress = PartOf(params.Progress, 0.2, 0.6);
  return own;
}
}

template <int Dim>
Status FittedSpline<Dim>::Project(const FittedMesh<Dim>& mesh, const CADFitParams& params)
{
  if (this->Fast.Space != this->Space)
  {
    this->Fast =
      ChooseFastPath<Dim>(this->Space, mesh.Points, PathParams(mesh, params, this->Policy));
  }
  const ProgressiveFitParams own = ProgressiveParams(mesh, params, this->LinearCells);
  auto fit = FitProgressively<Dim>(
    this->Fast, mesh.Surface, mesh.Parts, mesh.Points, mesh.Target.get(), own);
  if (fit)
  {
    this->Value = std::move(fit->Value);
    this->Before = std::move(fit->Before);
    this->Warnings = std::move(fit->Warnings);
    this->OnCurves = std::move(fit->OnCurves);
  }
  return fit.Status;
}

template <int Dim>
Result<ProgressiveFit<Dim>> FittedSpline<Dim>::ProjectedAgain(
  const FittedMesh<Dim>& mesh, const CADFitParams& params) const
{
  ProgressiveFitParams own = ProgressiveParams(mesh, params, this->LinearCells);
  own.Projections = 1;
  return FitProgressively<Dim>(
    this->Fast, mesh.Surface, mesh.Parts, mesh.Points, mesh.Target.get(), own, &this->Value);
}

template <int Dim>
Status FittedSpline<Dim>::Certify(const CADFitParams& params, ElementVerdicts& verdicts) const
{
  auto made = CertifyElements<Dim>(this->Value, params.Threads, PartOf(params.Progress, 0.6, 0.7));
  if (made)
  {
    verdicts = std::move(made.Value);
  }
  return made.Status;
}

template <int Dim>
Status FittedSpline<Dim>::Fit(
  const FittedMesh<Dim>& mesh, bool hasMeanLengths, const CADFitParams& params)
{
  Status status = MakeSpace(mesh, hasMeanLengths, false, params, *this);
  status = status ? this->Project(mesh, params) : status;
  if (status.Code == ErrorCode::NotInSpace)
  {
    // creases that end on the surface of a volume leave it without traces
    status = MakeSpace(mesh, hasMeanLengths, true, params, *this);
    status = status ? this->Project(mesh, params) : status;
  }
  status = status ? this->Certify(params, this->Verdicts) : status;
  if (status && this->Fast.Path == FitPath::Coons && !this->Verdicts.Bad.empty())
  {
    status = GiveUpFastPath(mesh, params, *this);
  }
  return status;
}

template struct FittedSpline<2>;
template struct FittedSpline<3>;
}
