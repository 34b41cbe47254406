// SPDX-License-Identifier: BSD-3-Clause
#include "CADFit.h"

#include "FitMeasures.h"
#include "FitMending.h"

#include <optional>
#include <set>

namespace knotwork
{
namespace
{
/// Of surfaces; of volumes one fewer, which take minutes.
constexpr int MostAttempts = 4;

template <int Dim>
Status CheckInput(const CellMesh<Dim>& mesh, const PointMatrix& points, const CADFitParams& params)
{
  if (mesh.NumCells() == 0)
  {
    return { ErrorCode::EmptyInput, "the mesh has no cells" };
  }
  if (points.rows() != mesh.NumPoints || points.cols() != 3)
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(points.rows()) + " points of " + std::to_string(points.cols()) +
        " coordinates for a mesh of " + std::to_string(mesh.NumPoints) + " in space" };
  }
  if (!params.FittedCells.empty() &&
    params.FittedCells.size() != static_cast<std::size_t>(mesh.NumCells()))
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(params.FittedCells.size()) + " marks of fitted cells for " +
        std::to_string(mesh.NumCells()) + " cells" };
  }
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    if (!points.row(i).allFinite())
    {
      return { ErrorCode::NonFiniteInput, "point " + std::to_string(i) };
    }
  }
  if (params.UntanglingRings < 0 || params.SmoothingRings < 0 || params.ExtraPoints < 0 ||
    params.ExtraPoints > 16 || params.TargetSamples < 0 || params.BoundedElements < 0 ||
    params.Projections < 1 || params.Projections > 100 || !(params.FarShare > 0.0))
  {
    return { ErrorCode::InvalidParameter,
      "rings, target samples and bounded elements must be 0 or more, projections in [1, 100], "
      "extra points in [0, 16], the far share above 0" };
  }
  return {};
}

/// What another attempt may do differently.
struct Remedies
{
  bool Layer = false;    ///< it is needed
  std::set<int> LeftOut; ///< curves of the target that were left out
  std::set<int> Curves;  ///< that are matched and touch elements without a certificate
  std::set<int> Corners; ///< that are points of elements without a certificate
};

/// @param remedies  result.
template <int Dim>
Result<CADFit<Dim>> AttemptFit(const CellMesh<Dim>& mesh, const PointMatrix& points,
  const FitTargetPtr& target, const PlacementChoice& choice, bool hasMeanLengths,
  const CADFitParams& params, Remedies& remedies)
{
  CADFit<Dim> fit;
  FittedMesh<Dim> placed;
  FittedSpline<Dim> spline;
  Status status = placed.Place(mesh, points, target, choice, params);
  status = status ? spline.Fit(placed, hasMeanLengths, params) : status;
  status = status ? MendFit(placed, spline, params, fit) : status;
  fit.Value = std::move(spline.Value);
  status = status ? MeasureFit(placed, params, fit) : status;
  if (!status)
  {
    return status;
  }
  fit.Policy = spline.Policy;
  fit.HasMeanLengths = hasMeanLengths;
  fit.Certificate = std::move(spline.Verdicts.Certificate);
  fit.Uncertified = std::move(spline.Verdicts.Bad);
  fit.Path = spline.Fast.Path;
  fit.PathNote = spline.Fast.Note;
  fit.PathTried = spline.Fast.Note.empty() ? FitPath::Automatic : spline.Fast.Tried;
  fit.Warnings = std::move(spline.Warnings);
  for (const UnmatchedFeature& feature : placed.Parts.Unmatched)
  {
    fit.UnmatchedFeatures.push_back({ feature.Part, feature.Place });
  }
  remedies = { placed.IsLayerNeeded, std::move(placed.Choice.LeftOut),
    placed.CurvesAt(fit.Uncertified), placed.CornersAt(fit.Uncertified) };
  fit.Mesh = std::move(placed.Mesh);
  fit.Points = std::move(placed.Points);
  fit.CellOf = std::move(placed.CellOf);
  fit.LayerCells = placed.LayerCells;
  fit.SurfaceElements = std::move(placed.Surface.Facets);
  fit.FoldedCells = placed.FoldedCells;
  fit.StillFolded = static_cast<int>(placed.Folded.size());
  return fit;
}

/// Whether a fit is much farther from the target than another, in the sense of mending.
template <int Dim>
bool IsFar(const CADFit<Dim>& fit, const CADFit<Dim>& from)
{
  return fit.Distances.ToTarget.RootMeanSquare > AllowedDistance(from.Distances);
}

/// Whether a fit is to be preferred: one that is not far from the target, then with fewer elements
/// without a certificate, then nearer.
template <int Dim>
bool IsBetter(const CADFit<Dim>& fit, const CADFit<Dim>& than)
{
  if (IsFar(fit, than) || IsFar(than, fit))
  {
    return IsFar(than, fit);
  }
  return fit.Uncertified.size() != than.Uncertified.size()
    ? fit.Uncertified.size() < than.Uncertified.size()
    : fit.Distances.ToTarget.RootMeanSquare < than.Distances.ToTarget.RootMeanSquare;
}
}

template <int Dim>
Result<CADFit<Dim>> FitToTarget(const CellMesh<Dim>& mesh, const PointMatrix& points,
  const FitTargetPtr& target, const CADFitParams& params)
{
  if (Status status = CheckInput(mesh, points, params); !status)
  {
    return status;
  }
  PlacementChoice choice;
  bool hasMeanLengths = params.Lengths == FitLengths::Mean;
  bool mayTakeMean = params.Lengths == FitLengths::Automatic;
  Result<CADFit<Dim>> best;
  std::optional<Remedies> last; // but for the one with mean lengths
  for (int i = 0; i < (Dim == 2 ? MostAttempts : MostAttempts - 1);)
  {
    Remedies remedies;
    auto fit = AttemptFit(mesh, points, target, choice, hasMeanLengths, params, remedies);
    if (!fit)
    {
      return !last || fit.Status.Code == ErrorCode::Aborted ? fit : best;
    }
    if (!last || IsBetter(fit.Value, best.Value))
    {
      best = std::move(fit);
    }
    if (best->Uncertified.empty() || !target || params.Smoothing == FitSmoothing::Off)
    {
      break;
    }
    if (mayTakeMean && hasMeanLengths)
    {
      mayTakeMean = hasMeanLengths = false; // once, beside the others
    }
    else
    {
      last = std::move(remedies);
      ++i;
    }
    // with a layer, then by mean lengths, then without the curves where elements have no
    // certificate, then the corners
    if (last->Layer && params.Layer && !choice.Layer)
    {
      choice.Layer = true;
    }
    else if (mayTakeMean)
    {
      hasMeanLengths = true;
    }
    else if (!last->Curves.empty())
    {
      choice.LeftOut = last->LeftOut;
      choice.LeftOut.insert(last->Curves.begin(), last->Curves.end());
    }
    else if (!last->Corners.empty())
    {
      choice.LeftOut = last->LeftOut;
      choice.LeftOutCorners.insert(last->Corners.begin(), last->Corners.end());
    }
    else
    {
      break;
    }
  }
  return best;
}

template Result<CADFit<2>> FitToTarget(
  const CellMesh<2>&, const PointMatrix&, const FitTargetPtr&, const CADFitParams&);
template Result<CADFit<3>> FitToTarget(
  const CellMesh<3>&, const PointMatrix&, const FitTargetPtr&, const CADFitParams&);
}
