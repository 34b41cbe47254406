// SPDX-License-Identifier: BSD-3-Clause
#include "CADFit.h"

#include "ElementMending.h"
#include "ElementPatch.h"
#include "ElementUnfolding.h"
#include "FastPaths.h"
#include "MeshTarget.h"
#include "ProgressiveFit.h"
#include "SampledDistances.h"
#include "SurfaceLayer.h"
#include "TargetDistances.h"
#include "VertexFit.h"

#include <knotwork/JacobianValidation/CellMeasures.h>
#include <knotwork/SplineCore/MeshGeometry.h>
#include <knotwork/SplineCore/MeshTraces.h>
#include <knotwork/SplineCore/Quadrature.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <set>

namespace knotwork
{
namespace
{
/// Rounds in which elements without a certificate take the mesh map of their own corners alone.
constexpr int MostRounds = 4;
/// Rounds in which curves of the target are given up that fold cells, or that leave elements
/// without a certificate.
constexpr int MostFoldedRounds = 4;
/// Of surfaces; of volumes one fewer, which take minutes.
constexpr int MostAttempts = 4;
constexpr int MostSweeps = 40;
constexpr int LayerSweeps = 15;
/// Times that control points inside alone are moved by the barrier functional.
constexpr int InsideSteps = 4;
/// Times that elements of surfaces are unfolded, in a ring more each time; of volumes one fewer.
constexpr int MostUnfoldings = 4;
/// Times that what was moved is fitted once more, and the least share of its way to where that puts
/// it.
constexpr int MostApproaches = 4;
constexpr double LeastApproach = 0.1;
/// By which the surface's distance from the target may grow, or what share of the mesh's own it may
/// reach, when elements are mended.
constexpr double MostGrowth = 2.0;
constexpr double MostOfMesh = 0.25;
/// Of the largest distance that is found: how near the facets are that bounds are proved with, and
/// bounds that are good enough as they are; the least one that counts, of the target's size.
constexpr double FacetShare = 0.05;
constexpr double EnoughShare = 0.5;
constexpr double LeastBound = 1e-4;
/// Of the mean edge by which the points of the surface are shifted for a layer.
constexpr double LayerShare = 0.3;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// What differs between attempts.
struct Attempt
{
  std::set<int> LeftOut; ///< curves of the target
  std::set<int> LeftOutCorners;
  bool Layer = false;
  bool MeanLengths = false;
};

template <int Dim>
class CADFitting
{
public:
  CADFitting(const CellMesh<Dim>& mesh, const PointMatrix& points, const FitTarget* target,
    const CADFitParams& params, const Attempt& attempt)
    : Given(mesh), GivenPoints(points), Target(target), Params(params)
  {
    this->IsPart = target &&
      std::find(params.FittedCells.begin(), params.FittedCells.end(), 0) !=
        params.FittedCells.end();
    this->Classification.LeftOut = attempt.LeftOut;
    this->Classification.LeftOutCorners = attempt.LeftOutCorners;
    this->Layer = params.Layer && attempt.Layer;
    this->Fit.HasMeanLengths = attempt.MeanLengths;
    this->Fit.Mesh = mesh;
    this->Fit.Points = points;
    this->Fit.CellOf.resize(At(mesh.NumCells()));
    std::iota(this->Fit.CellOf.begin(), this->Fit.CellOf.end(), 0);
  }

  /// Curves of the target that are matched and touch elements without a certificate.
  std::set<int> CurvesAtUncertified() const { return this->CurvesAt(this->Fit.Uncertified); }
  /// Corners of the target that are points of elements without a certificate.
  std::set<int> CornersAtUncertified() const
  {
    std::set<int> corners;
    for (const int cell : this->Fit.Uncertified)
    {
      for (int k = 0; k < (1 << Dim); ++k)
      {
        const TargetPart& part = this->Parts.PointParts[At(this->Fit.Mesh.Cell(cell)[k])];
        if (part.Entity == TargetEntity::Vertex)
        {
          corners.insert(part.Id);
        }
      }
    }
    return corners;
  }
  bool NeedsLayer() const { return this->IsLayerNeeded; }
  const std::set<int>& LeftOut() const { return this->Classification.LeftOut; }

  Result<CADFit<Dim>> Run()
  {
    Status status = this->Check();
    status = status ? this->Link() : status;
    if (status && !this->Target)
    {
      status = this->TakeMeshAsTarget();
    }
    status = status && this->IsFitted ? this->CheckNear() : status;
    status = status ? this->Classify() : status;
    if (status && this->IsFitted)
    {
      status = this->PlacePoints({});
      status = status ? this->GiveUpFolded() : status;
      status = status ? this->AddLayerIfNeeded() : status;
    }
    status = status ? this->MakeSpace() : status;
    status = status ? this->Project() : status;
    if (status.Code == ErrorCode::NotInSpace)
    {
      // creases that end on the surface of a volume leave it without traces
      this->AreFeaturesProlonged = true;
      status = this->MakeSpace();
      status = status ? this->Project() : status;
    }
    status = status ? this->Certify(this->Verdicts) : status;
    if (status && this->Fast.Path == FitPath::Coons && !this->Verdicts.Bad.empty())
    {
      status = this->GiveUpFastPath();
    }
    if (status)
    {
      this->Fit.InvalidBefore = static_cast<int>(this->Candidates().size());
      status = this->Mend();
    }
    status = status ? this->Measure() : status;
    if (!status)
    {
      return status;
    }
    this->Fit.Certificate = std::move(this->Verdicts.Certificate);
    this->Fit.Uncertified = std::move(this->Verdicts.Bad);
    return this->Fit;
  }

private:
  ProgressCallback Share(double begin, double end) const
  {
    const ProgressCallback& progress = this->Params.Progress;
    return progress ? ProgressCallback([&progress, begin, end](double share)
                        { return progress(begin + share * (end - begin)); })
                    : ProgressCallback();
  }

  Status Check() const
  {
    if (this->Given.NumCells() == 0)
    {
      return { ErrorCode::EmptyInput, "the mesh has no cells" };
    }
    if (this->GivenPoints.rows() != this->Given.NumPoints || this->GivenPoints.cols() != 3)
    {
      return { ErrorCode::SizeMismatch,
        std::to_string(this->GivenPoints.rows()) + " points of " +
          std::to_string(this->GivenPoints.cols()) + " coordinates for a mesh of " +
          std::to_string(this->Given.NumPoints) + " in space" };
    }
    if (!this->Params.FittedCells.empty() &&
      this->Params.FittedCells.size() != At(this->Given.NumCells()))
    {
      return { ErrorCode::SizeMismatch,
        std::to_string(this->Params.FittedCells.size()) + " marks of fitted cells for " +
          std::to_string(this->Given.NumCells()) + " cells" };
    }
    for (Eigen::Index i = 0; i < this->GivenPoints.rows(); ++i)
    {
      if (!this->GivenPoints.row(i).allFinite())
      {
        return { ErrorCode::NonFiniteInput, "point " + std::to_string(i) };
      }
    }
    if (this->Params.UntanglingRings < 0 || this->Params.SmoothingRings < 0 ||
      this->Params.ExtraPoints < 0 || this->Params.ExtraPoints > 16 ||
      this->Params.TargetSamples < 0 || this->Params.BoundedElements < 0 ||
      this->Params.Projections < 1 || this->Params.Projections > 100 ||
      !(this->Params.FarShare > 0.0))
    {
      return { ErrorCode::InvalidParameter,
        "rings, target samples and bounded elements must be 0 or more, projections in [1, 100], "
        "extra points in "
        "[0, 16], the far share above 0" };
    }
    return {};
  }

  Status Link()
  {
    auto topology = MeshTopology<Dim>::Make(this->Fit.Mesh);
    if (topology)
    {
      this->Topology = std::move(topology.Value);
      this->Surface = MakeSurfaceMesh<Dim>(this->Fit.Mesh, this->Topology,
        this->IsPart ? this->Params.FittedCells : std::vector<char>());
    }
    if (topology && this->IsPart)
    {
      if (this->Surface.Facets.empty())
      {
        return { ErrorCode::InvalidParameter,
          Dim == 2 ? "no cell is to be fitted: all marks of fitted cells are 0"
                   : "no cell that is to be fitted has a face on the mesh's surface" };
      }
      this->PointsBeside =
        knotwork::PointsBeside<Dim>(this->Surface, this->Fit.Mesh, this->Topology);
    }
    return topology.Status;
  }

  Status TakeMeshAsTarget()
  {
    this->IsFitted = false;
    TriangleMesh triangles;
    triangles.Points = this->GivenPoints;
    for (const auto& quad : this->Surface.Quads)
    {
      triangles.Triangles.push_back({ quad[0], quad[1], quad[2] });
      triangles.Triangles.push_back({ quad[0], quad[2], quad[3] });
    }
    // a mesh that is no one surface is fitted all the same, and not measured
    MeshFeatureParams features;
    features.SharpAngle = 179.0;
    if (auto own = MakeMeshTarget(triangles, features))
    {
      this->Own = std::move(own.Value);
    }
    this->Target = this->Own.get();
    return {};
  }

  Status Classify()
  {
    this->Parts = {};
    this->Parts.PointParts.resize(At(this->Fit.Mesh.NumPoints));
    this->Parts.CurveOf.assign(this->Surface.Edges.size(), -1);
    this->Parts.FaceOf.assign(this->Surface.Quads.size(), -1);
    if (!this->IsFitted)
    {
      return {};
    }
    this->Classification.Faces = this->HasSurfaces;
    this->Classification.Threads = this->Params.Threads;
    auto parts = ClassifyMesh(this->Surface, this->Fit.Points, *this->Target, this->Classification);
    if (parts)
    {
      this->Parts = std::move(parts.Value);
    }
    return parts.Status;
  }

  /// Whether the mesh lies at the target, and which dimensions can be fitted.
  Status CheckNear()
  {
    if (Dim == 3 && this->Target->HasSurface() && !this->Target->IsClosed() &&
      this->Params.Surfaces && !this->IsPart)
    {
      return { ErrorCode::InvalidTopology,
        "the target has a rim, and the surface of hexahedra has none: close the target, fit "
        "curves alone, or choose the cells that are fitted" };
    }
    this->HasSurfaces = this->Params.Surfaces && this->Target->HasSurface();
    if (!this->Target->HasSurface())
    {
      return {};
    }
    PointMatrix points(static_cast<Eigen::Index>(this->Surface.Points.size()), 3);
    for (std::size_t i = 0; i < this->Surface.Points.size(); ++i)
    {
      points.row(static_cast<Eigen::Index>(i)) = this->GivenPoints.row(this->Surface.Points[i]);
    }
    TargetPoints feet;
    TargetDistanceParams search;
    search.Threads = this->Params.Threads;
    const bool isPlane =
      Dim == 2 && (this->GivenPoints.col(2).array() == this->GivenPoints(0, 2)).all();
    if (Status status = FindOnTarget(*this->Target, points, feet, search); !status)
    {
      // the inside of a plane mesh need not be near a target that its rim lies on
      this->HasSurfaces = this->HasSurfaces && !isPlane;
      return isPlane ? Status() : status;
    }
    const Eigen::VectorXd distances = (feet.Points - points).rowwise().norm();
    const std::vector<double> lengths = EdgeLengthsAt(this->Surface, this->GivenPoints);
    const double edge = std::accumulate(lengths.begin(), lengths.end(), 0.0) /
      static_cast<double>(this->Surface.Points.size());
    if (isPlane && distances.mean() > 0.5 * edge)
    {
      // the inside of a plane mesh does not lie on the target: its rim alone does
      this->HasSurfaces = false;
      return {};
    }
    const double size =
      (feet.Points.colwise().maxCoeff() - feet.Points.colwise().minCoeff()).norm();
    if (this->HasSurfaces && !(distances.mean() <= this->Params.FarShare * size))
    {
      return { ErrorCode::InvalidParameter,
        "the mesh is " + std::to_string(distances.mean()) +
          " from its target in the mean, whose closest points extend over " + std::to_string(size) +
          ": give both in the same unit and place" };
    }
    return {};
  }

  Status PlacePoints(const std::vector<int>& poor, int sweeps = MostSweeps)
  {
    VertexFitParams params;
    params.Surfaces = this->HasSurfaces;
    params.Untangle = this->Params.Untangle;
    params.Rings = this->Params.UntanglingRings;
    params.Poor = poor;
    params.IsHeld = this->PointsBeside;
    params.MaxSweeps = sweeps;
    params.Threads = this->Params.Threads;
    params.Progress = this->Share(0.0, 0.2);
    auto placed = MoveOntoTarget<Dim>(this->Fit.Mesh, this->Topology, this->Surface, this->Parts,
      this->Fit.Points, *this->Target, params);
    if (!placed)
    {
      return placed.Status;
    }
    if (this->Fit.LayerCells == 0 && !this->IsPlaced)
    {
      this->Fit.FoldedCells = static_cast<int>(placed->FoldedBefore.size());
    }
    this->IsPlaced = true;
    this->Fit.StillFolded = static_cast<int>(placed->Folded.size());
    this->Folded = std::move(placed->Folded);
    this->Fit.Points = std::move(placed->Points);
    return {};
  }

  /// Curves at points of some cells.
  std::set<int> CurvesAt(const std::vector<int>& cells) const
  {
    std::set<int> curves;
    std::set<int> points;
    for (const int cell : cells)
    {
      points.insert(this->Fit.Mesh.Cell(cell), this->Fit.Mesh.Cell(cell) + (1 << Dim));
    }
    for (std::size_t e = 0; e < this->Surface.Edges.size(); ++e)
    {
      const auto [a, b] = this->Surface.Edges[e];
      if (this->Parts.CurveOf[e] >= 0 && (points.count(a) != 0 || points.count(b) != 0))
      {
        curves.insert(this->Parts.CurveOf[e]);
      }
    }
    return curves;
  }

  /// A mesh that has no room for the edges of its target is better round there than folded.
  Status GiveUpFolded()
  {
    Status status;
    for (int round = 0; status && this->Params.Untangle && round < MostFoldedRounds; ++round)
    {
      const std::set<int> curves = this->CurvesAt(this->Folded);
      if (curves.empty())
      {
        break;
      }
      this->Classification.LeftOut.insert(curves.begin(), curves.end());
      this->Fit.Points = this->GivenPoints;
      status = this->Classify();
      status = status ? this->PlacePoints({}) : status;
    }
    return status;
  }

  Status AddLayerIfNeeded()
  {
    if constexpr (Dim == 3)
    {
      const std::vector<int> edges = EdgesOfTwoFaces(this->Surface, this->Parts);
      if (edges.empty() || !this->HasSurfaces || this->IsPart)
      {
        return {};
      }
      this->IsLayerNeeded = true;
      if (!this->Layer)
      {
        return {};
      }
      LayeredMesh layered = AddLayer(this->Fit.Mesh, this->Surface, this->Fit.Points, LayerShare);
      this->Fit.LayerCells = layered.Mesh.NumCells() - this->Fit.Mesh.NumCells();
      this->Fit.Mesh = std::move(layered.Mesh);
      this->Fit.Points = std::move(layered.Points);
      this->Fit.CellOf = std::move(layered.CellOf);
      Status status = this->Link();
      status = status ? this->Classify() : status;
      if (!status)
      {
        return status;
      }
      // the layer, and what it left
      std::vector<int> poor(At(this->Fit.LayerCells));
      std::iota(poor.begin(), poor.end(), this->Fit.Mesh.NumCells() - this->Fit.LayerCells);
      return this->PlacePoints(poor, LayerSweeps);
    }
    return {};
  }

  Status MakeSpace()
  {
    UnstructuredParams params = this->Params.Space;
    if (this->Fit.HasMeanLengths)
    {
      auto lengths = MeanSheetLengths<Dim>(this->Fit.Mesh, this->Topology, this->Fit.Points);
      if (!lengths)
      {
        return lengths.Status;
      }
      params.Lengths = std::move(lengths.Value);
    }
    const std::vector<CellSide> own =
      FeatureFacets<Dim>(this->Fit.Mesh, this->Topology, this->Surface, this->Parts);
    params.Features.insert(params.Features.end(), own.begin(), own.end());
    if (this->AreFeaturesProlonged)
    {
      params.Features = Prolong<Dim>(this->Topology, params.Features);
    }
    auto made = MakeUnstructuredSpace<Dim>(this->Fit.Mesh, params);
    if (made)
    {
      this->Space = std::move(made->Space);
      this->Fit.Policy = made->Policy;
    }
    return made.Status;
  }

  /// Patches that are filled from their boundaries and are not valid are fitted inside.
  Status GiveUpFastPath()
  {
    const std::size_t count = this->Verdicts.Bad.size();
    FastPath<Dim> own;
    own.Space = this->Space;
    own.Tried = this->Fast.Path;
    own.Note = std::to_string(count) + " elements had no certificate";
    this->Fast = std::move(own);
    Status status = this->Project();
    return status ? this->Certify(this->Verdicts) : status;
  }

  void ChoosePath()
  {
    FastPathParams params;
    params.Path = this->Params.Path;
    params.Weights = this->Params.CompositeWeights;
    params.IsFull = this->Fit.Policy == CreasePolicy::Full;
    params.IsMeshTheTarget = !this->IsFitted;
    params.IsInsideFitted = Dim == 2 && this->IsFitted && this->HasSurfaces;
    this->Fast = ChooseFastPath<Dim>(this->Space, this->Fit.Points, params);
  }

  ProgressiveFitParams ProjectionParams() const
  {
    ProgressiveFitParams params;
    params.Surfaces = this->IsFitted && this->HasSurfaces;
    params.Curves = this->IsFitted && this->Params.Curves;
    params.Points = this->IsFitted && this->Params.Points;
    params.Constrain = this->Params.Constrain;
    params.Projections = this->IsFitted ? this->Params.Projections : 1;
    params.ExtraPoints = this->Params.ExtraPoints;
    params.Threads = this->Params.Threads;
    params.LinearCells = this->LinearCells;
    params.Progress = this->Share(0.2, 0.6);
    return params;
  }

  Status Project()
  {
    if (this->Fast.Space != this->Space)
    {
      this->ChoosePath();
    }
    const ProgressiveFitParams params = this->ProjectionParams();
    auto fit = FitProgressively<Dim>(
      this->Fast, this->Surface, this->Parts, this->Fit.Points, this->Target, params);
    if (fit)
    {
      this->Fit.Value = std::move(fit->Value);
      this->Before = std::move(fit->Before);
      this->ProjectionWarnings = std::move(fit->Warnings);
      this->OnCurves = std::move(fit->OnCurves);
    }
    return fit.Status;
  }

  Status Certify(ElementVerdicts& verdicts)
  {
    auto made = CertifyElements<Dim>(this->Fit.Value, this->Params.Threads, this->Share(0.6, 0.7));
    if (made)
    {
      verdicts = std::move(made.Value);
    }
    return made.Status;
  }

  /// Elements that are mended.
  std::vector<int> Candidates() const
  {
    return this->Params.Smoothing == FitSmoothing::Net
      ? InvertedNets<Dim>(this->Fit.Value, this->Verdicts.IsReversed)
      : this->Verdicts.Bad;
  }

  /// Functions of the quadrilaterals that are fitted, where not all are.
  std::vector<int> FunctionsOfPart() const
  {
    if constexpr (Dim == 2)
    {
      return this->IsPart ? PartOnFacets(*this->Space, this->Surface.Facets).Functions
                          : std::vector<int>();
    }
    return {};
  }

  /// Functions of the surface, which stay.
  std::vector<char> Held() const
  {
    std::vector<char> held(At(this->Space->NumFunctions), 0);
    if constexpr (Dim == 3)
    {
      if (this->IsPart)
      {
        const auto whole = TraceOnFacets(*this->Space, BoundaryFacets<3>(this->Topology));
        for (const int function : whole->Functions)
        {
          held[At(function)] = HeldFast;
        }
      }
      const auto trace = TraceOnFacets(*this->Space, this->Surface.Facets);
      for (const int function : trace->Functions)
      {
        held[At(function)] = 1;
      }
    }
    else
    {
      // rims, and where the surface lies on the target all; what is on its curves for good
      if (this->IsFitted && this->HasSurfaces)
      {
        held.assign(held.size(), this->IsPart ? HeldFast : char(1));
        for (const int function : this->FunctionsOfPart())
        {
          held[At(function)] = 1;
        }
        for (const int function : this->OnCurves)
        {
          held[At(function)] = HeldFast;
        }
        return held;
      }
      const std::vector<CellSide> rims = BoundaryFacets<2>(this->Topology);
      if (!rims.empty())
      {
        const auto traces = TraceOnFacets(*this->Space, rims);
        for (const MeshTrace<1>& trace : traces.Value)
        {
          for (const int function : trace.Functions)
          {
            held[At(function)] = 1;
          }
        }
      }
    }
    return held;
  }

  /// Control points of a surface that were moved across its normals keep their offsets from the
  /// target.
  Status FollowTarget(const PointMatrix& before)
  {
    if (Dim == 3 || !this->IsFitted || !this->HasSurfaces)
    {
      return {};
    }
    PointMatrix& now = this->Fit.Value.ControlPoints;
    std::vector<Eigen::Index> moved;
    for (Eigen::Index i = 0; i < now.rows(); ++i)
    {
      if (now.row(i) != before.row(i))
      {
        moved.push_back(i);
      }
    }
    return KeepOffsets(*this->Target, before, moved, std::vector<TargetPart>(moved.size()), now);
  }

  /// What a step leaves is kept where it has fewer elements without a certificate, and stays at the
  /// target.
  template <class Step>
  Status Try(Step&& step)
  {
    const CADFit<Dim> fit = this->Fit;
    const Spline<Dim> before = this->Before;
    Result<int> changed = step();
    ElementVerdicts verdicts;
    Status status = changed.Status;
    if (status && changed.Value > 0)
    {
      status = this->Certify(verdicts);
    }
    bool isBetter = status && changed.Value > 0 && verdicts.Bad.size() < this->Verdicts.Bad.size();
    if (isBetter)
    {
      const auto distance = this->DistanceNow();
      status = distance.Status;
      isBetter = distance.Value <= this->AllowedDistance;
    }
    if (!status)
    {
      return status;
    }
    if (isBetter)
    {
      this->Verdicts = std::move(verdicts);
      this->Fit.Smoothed = std::max(this->Fit.Smoothed, changed.Value);
    }
    else
    {
      this->Fit = fit;
      this->Before = before;
    }
    return {};
  }

  Status Mend()
  {
    if (this->Params.Smoothing == FitSmoothing::Off)
    {
      return {};
    }
    Status status;
    if (!this->Candidates().empty())
    {
      status = this->DistanceNow(&this->AllowedDistance).Status;
    }
    for (int round = 0; status && round < MostRounds && !this->Candidates().empty(); ++round)
    {
      // wide windows swing on cells of bad shape
      const std::vector<int> own =
        Rings<Dim>(this->Fit.Mesh, this->Candidates(), round > 0 ? 1 : 0);
      const std::vector<int> before = this->LinearCells;
      std::set<int> all(before.begin(), before.end());
      all.insert(own.begin(), own.end());
      this->LinearCells.assign(all.begin(), all.end());
      const std::size_t last = this->Verdicts.Bad.size();
      status = this->Try(
        [&]
        {
          Status made = this->Project();
          return made ? Result<int>(static_cast<int>(all.size())) : Result<int>(made);
        });
      if (this->Verdicts.Bad.size() >= last)
      {
        this->LinearCells = before;
        break;
      }
    }
    if (status && this->IsFitted && this->Params.Untangle && !this->Candidates().empty())
    {
      const std::vector<int> bad = this->Candidates();
      status = this->Try(
        [&]
        {
          Status moved = this->PlacePoints(bad, LayerSweeps);
          moved = moved ? this->Project() : moved;
          return moved ? Result<int>(static_cast<int>(bad.size())) : Result<int>(moved);
        });
    }
    MendingParams params;
    params.Threads = this->Params.Threads;
    params.Progress = this->Share(0.7, 0.8);
    const std::vector<char> held = this->Verdicts.Bad.empty() ? std::vector<char>() : this->Held();
    if (status && !this->Candidates().empty())
    {
      params.Rings = this->Params.SmoothingRings;
      status = this->Try(
        [&]() -> Result<int>
        {
          const PointMatrix moves = this->Fit.Value.ControlPoints - this->Before.ControlPoints;
          return ExtendMoves<Dim>(this->Fit.Value, this->Candidates(), moves, held, params);
        });
    }
    const PointMatrix fitted = this->Fit.Value.ControlPoints;
    // inside, in more and more rings; then the surface too, along the target, then held less and
    // less fast
    for (int step = 0; status && step < 10 && !this->Candidates().empty(); ++step)
    {
      if (step == InsideSteps)
      {
        status = this->UnfoldElements();
        if (!status || this->Candidates().empty())
        {
          break;
        }
      }
      constexpr double attractions[] = { 1000.0, 100.0, 10.0, 1.0, 1.0, 0.1 };
      params.Rings = std::max(0,
        this->Params.SmoothingRings - 2 +
          (step < InsideSteps ? step
              : step < 8      ? 1
                              : 2));
      params.Attraction = step < InsideSteps ? 0.0 : attractions[step - InsideSteps];
      status = this->Try(
        [&]
        {
          const PointMatrix before = this->Fit.Value.ControlPoints;
          Result<int> changed = MinimizeBarrier<Dim>(
            this->Fit.Value, this->Candidates(), this->Verdicts.IsReversed, held, params);
          const Status followed =
            changed && changed.Value > 0 ? this->FollowTarget(before) : Status();
          return followed ? changed : Result<int>(followed);
        });
    }
    return status ? this->Approach(fitted) : status;
  }

  /// What control points may do when elements unfold: those on curves stay, others of a surface on
  /// its target slide.
  ControlPointPlaces Places() const
  {
    const auto count = At(this->Space->NumFunctions);
    ControlPointPlaces places;
    places.IsHeld.assign(count, 0);
    places.IsOnSurface.assign(count, Dim == 2 ? 1 : 0);
    places.Parts.resize(count);
    if (Dim == 2 && this->IsPart)
    {
      places.IsHeld.assign(count, 1);
      for (const int function : this->FunctionsOfPart())
      {
        places.IsHeld[At(function)] = 0;
      }
    }
    if constexpr (Dim == 3)
    {
      if (this->IsPart)
      {
        const auto whole = TraceOnFacets(*this->Space, BoundaryFacets<3>(this->Topology));
        for (const int function : whole->Functions)
        {
          places.IsHeld[At(function)] = 1;
        }
      }
      const auto trace = TraceOnFacets(*this->Space, this->Surface.Facets);
      for (std::size_t q = 0; q < this->Surface.Facets.size(); ++q)
      {
        const int face = this->Parts.FaceOf[q];
        for (const int own : trace->Space->AliveFunctions(static_cast<int>(q)))
        {
          const int function = trace->Functions[At(own)];
          places.IsHeld[At(function)] = 0;
          TargetPart& part = places.Parts[At(function)];
          const bool isFirst = places.IsOnSurface[At(function)] == 0;
          places.IsOnSurface[At(function)] = 1;
          // of two faces: on any
          part = face >= 0 && (isFirst || part.Id == face) ? TargetPart{ TargetEntity::Face, face }
                                                           : TargetPart();
        }
      }
    }
    for (const int function : this->OnCurves)
    {
      places.IsHeld[At(function)] = 1;
    }
    return places;
  }

  Status UnfoldElements()
  {
    Status status;
    if (!this->IsFitted || !this->HasSurfaces)
    {
      return status;
    }
    const ControlPointPlaces places = this->Places();
    for (int step = 0; status && step < (Dim == 2 ? MostUnfoldings : MostUnfoldings - 1) &&
         !this->Candidates().empty();
         ++step)
    {
      UnfoldingParams params;
      params.Rings = std::max(0, this->Params.SmoothingRings - (Dim == 2 ? 0 : 1)) + step;
      params.Threads = this->Params.Threads;
      params.Progress = this->Share(0.7, 0.8);
      status = this->Try(
        [&]
        {
          return knotwork::Unfold<Dim>(this->Fit.Value, this->Candidates(),
            this->Verdicts.IsReversed, places, *this->Target, params);
        });
    }
    return status;
  }

  /// Control points that were moved, fitted to the target once more from where the surface is now:
  /// as far as that brings it nearer, and leaves the verdicts as good.
  /// @param fitted  control points as they were before they were moved.
  Status Approach(const PointMatrix& fitted)
  {
    std::vector<Eigen::Index> moved;
    PointMatrix& now = this->Fit.Value.ControlPoints;
    for (Eigen::Index i = 0; i < now.rows(); ++i)
    {
      if (now.row(i) != fitted.row(i))
      {
        moved.push_back(i);
      }
    }
    Status status;
    bool isNearer = !moved.empty() && this->IsFitted && this->HasSurfaces;
    for (int pass = 0; status && isNearer && pass < MostApproaches; ++pass)
    {
      ProgressiveFitParams params = this->ProjectionParams();
      params.Projections = 1;
      const auto fit = FitProgressively<Dim>(this->Fast, this->Surface, this->Parts,
        this->Fit.Points, this->Target, params, &this->Fit.Value);
      const auto last = fit ? this->DistanceNow() : Result<double>(fit.Status);
      status = last.Status;
      isNearer = false;
      for (double share = 1.0; status && !isNearer && share > LeastApproach; share *= 0.5)
      {
        const PointMatrix before = now;
        for (const Eigen::Index i : moved)
        {
          now.row(i) += share * (fit->Value.ControlPoints.row(i) - before.row(i));
        }
        const auto distance = this->DistanceNow();
        ElementVerdicts verdicts;
        status = distance ? this->Certify(verdicts) : distance.Status;
        isNearer =
          status && verdicts.Bad.size() <= this->Verdicts.Bad.size() && distance.Value < last.Value;
        if (isNearer)
        {
          this->Verdicts = std::move(verdicts);
        }
        else
        {
          now = before;
        }
      }
    }
    return status;
  }

  /// Local parameters of the corners of every quadrilateral on the element of the surface.
  std::vector<std::array<double, 8>> CornersOnElements(const MeshTrace<2>& trace) const
  {
    std::vector<std::array<double, 8>> corners;
    for (std::size_t q = 0; q < this->Surface.Quads.size(); ++q)
    {
      std::array<double, 8>& own = corners.emplace_back();
      if constexpr (Dim == 2)
      {
        own = { 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0 };
      }
      else
      {
        const int* cell = this->Fit.Mesh.Cell(this->Surface.Facets[q].Cell);
        const TraceElement<2>& element = trace.Elements[q];
        for (std::size_t k = 0; k < 4; ++k)
        {
          const int corner =
            static_cast<int>(std::find(cell, cell + 8, this->Surface.Quads[q][k]) - cell);
          for (std::size_t d = 0; d < 2; ++d)
          {
            own[2 * k + d] = (corner >> element.Direction[d] & 1) ^ (element.Reversed[d] ? 1 : 0);
          }
        }
      }
    }
    return corners;
  }

  /// Area of a volume's surface; volume that a surface without a rim encloses, by the divergence
  /// theorem: Gauss points enough for polynomials of its degrees.
  /// @param fitted  what of the surface is fitted.
  Status MeasureSurface(const Spline<2>& fitted)
  {
    if constexpr (Dim == 3)
    {
      Spline<2> surface = fitted;
      if (this->IsPart)
      {
        const auto trace = TraceOnFacets(*this->Space, BoundaryFacets<3>(this->Topology));
        if (!trace)
        {
          return trace.Status;
        }
        surface = TraceOf<2>(this->Fit.Value, trace.Value);
      }
      const auto measures =
        MeasureCells(MakeBernsteinCells(MakeBezierForm(surface, this->Params.Threads)));
      this->Fit.Area = measures ? measures->Total.Measure : 0.0;
    }
    else
    {
      this->MeasureEnclosed();
    }
    return {};
  }
  void MeasureEnclosed()
  {
    const Spline<Dim>& surface = this->Fit.Value;
    const bool isClosed = BoundaryFacets<Dim>(this->Topology).empty();
    for (int side = 0; side < 2 * Dim * this->Topology.NumCells(); ++side)
    {
      const int cell = side / (2 * Dim);
      if (!isClosed || !this->Topology.Crossing(cell, side % (2 * Dim)).Coherent)
      {
        return; // cells are oriented differently
      }
    }
    const BezierForm<Dim> form = MakeBezierForm(surface, this->Params.Threads);
    const int count = 3 * this->Params.Space.Degree / 2 + 1;
    const ElementQuadrature<2> rule = MakeElementQuadrature<2>({ count, count });
    EvaluationParams params;
    params.Derivatives = 1;
    params.Threads = this->Params.Threads;
    EvaluationBatch batch;
    double sum = 0.0;
    for (int e = 0; e < surface.Space->NumElements(); ++e)
    {
      EvaluateElements<2>(form, std::vector<int>(At(static_cast<int>(rule.Local.rows())), e),
        rule.Local, params, batch);
      for (Eigen::Index i = 0; i < rule.Local.rows(); ++i)
      {
        const Eigen::RowVector3d u = batch.First.row(i).template head<3>();
        const Eigen::RowVector3d v = batch.First.row(i).template tail<3>();
        sum += rule.Weights[i] * u.cross(v).dot(batch.Values.row(i)) / 3.0;
      }
    }
    this->Fit.Volume = std::abs(sum);
  }

  /// The surface of the spline, a trace of volumes, or what of it is fitted.
  Status TraceSurface(Spline<2>& surface, MeshTrace<2>& trace) const
  {
    if constexpr (Dim == 2)
    {
      surface = this->Fit.Value;
      if (this->IsPart)
      {
        trace = PartOnFacets(*this->Space, this->Surface.Facets);
        surface = PartOf(this->Fit.Value, trace);
      }
    }
    else
    {
      auto made = TraceOnFacets(*this->Space, this->Surface.Facets);
      if (!made)
      {
        return made.Status;
      }
      trace = std::move(made.Value);
      surface = TraceOf<2>(this->Fit.Value, trace);
    }
    return {};
  }

  Result<FitDistances> MeasureFrom(
    const Spline<2>& surface, const MeshTrace<2>& trace, SampledDistanceParams params) const
  {
    params.Surfaces = this->HasSurfaces || !this->IsFitted;
    params.Threads = this->Params.Threads;
    PointMatrix points = this->Fit.Points;
    points.topRows(this->GivenPoints.rows()) = this->GivenPoints;
    return MeasureDistances(surface, this->Surface, this->CornersOnElements(trace), this->Parts,
      points, *this->Target, params);
  }

  /// Distance of the surface from the target that mending may end with: it may double, or reach a
  /// share of what the mesh has itself. A valid spline far from its target is of no use.
  Result<double> DistanceNow(double* allowed = nullptr) const
  {
    if (!this->Target)
    {
      return 0.0;
    }
    Spline<2> surface;
    MeshTrace<2> trace;
    if (Status status = this->TraceSurface(surface, trace); !status)
    {
      return status;
    }
    SampledDistanceParams params;
    params.Samples = 2;
    const auto distances = this->MeasureFrom(surface, trace, params);
    if (distances && allowed)
    {
      *allowed = std::max(MostGrowth * distances->ToTarget.RootMeanSquare,
        MostOfMesh * distances->MeshToTarget.RootMeanSquare);
    }
    return distances ? Result<double>(distances->ToTarget.RootMeanSquare) : distances.Status;
  }

  Status Measure()
  {
    this->Fit.Warnings.insert(
      this->Fit.Warnings.end(), this->ProjectionWarnings.begin(), this->ProjectionWarnings.end());
    for (const UnmatchedFeature& feature : this->Parts.Unmatched)
    {
      this->Fit.UnmatchedFeatures.push_back({ feature.Part, feature.Place });
    }
    const BezierForm<Dim> form = MakeBezierForm(this->Fit.Value, this->Params.Threads);
    if (const auto measures = MeasureCells(MakeBernsteinCells(form)))
    {
      (Dim == 2 ? this->Fit.Area : this->Fit.Volume) = std::abs(measures->Total.Measure);
    }
    this->Fit.SurfaceElements = this->Surface.Facets;
    this->Fit.Path = this->Fast.Path;
    this->Fit.PathNote = this->Fast.Note;
    this->Fit.PathTried = this->Fast.Note.empty() ? FitPath::Automatic : this->Fast.Tried;
    Spline<2> surface;
    MeshTrace<2> trace;
    if (Status status = this->TraceSurface(surface, trace); !status)
    {
      return status;
    }
    if (Status status = this->MeasureSurface(surface); !status)
    {
      return status;
    }
    if (!this->Target)
    {
      return {};
    }
    SampledDistanceParams params;
    params.TargetSamples = this->IsPart ? 0 : this->Params.TargetSamples;
    params.Progress = this->Share(0.8, 0.9);
    auto distances = this->MeasureFrom(surface, trace, params);
    if (distances)
    {
      this->Fit.Distances = std::move(distances.Value);
    }
    return distances ? this->Bound(surface) : distances.Status;
  }

  /// Bounds of distances that are as near to the largest ones as that is cheap.
  Status Bound(const Spline<2>& surface)
  {
    const TriangleIndex<3>* triangles = this->Target->Triangles();
    if (!triangles || !this->IsFitted || !this->HasSurfaces || this->IsPart ||
      surface.Space->NumElements() > this->Params.BoundedElements)
    {
      return {};
    }
    const PointMatrix& points = triangles->Points();
    const double size = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
    const double largest = std::max({ this->Fit.Distances.ToTarget.Largest,
      this->Fit.Distances.FromTarget.Largest, LeastBound * size });
    DeviationBoundParams params;
    params.Tolerance = FacetShare * largest;
    params.Enough = EnoughShare * largest;
    params.Threads = this->Params.Threads;
    params.Progress = this->Share(0.9, 1.0);
    auto bound =
      BoundSurfaceDeviation(MakeBezierForm(surface, this->Params.Threads), *triangles, params);
    if (bound)
    {
      this->Fit.Bound = std::move(bound.Value);
    }
    return bound.Status.Code == ErrorCode::TooLarge ? Status() : bound.Status;
  }

  const CellMesh<Dim>& Given;
  const PointMatrix& GivenPoints;
  const FitTarget* Target;
  FitTargetPtr Own; ///< the mesh itself
  const CADFitParams& Params;
  bool IsFitted = true;
  bool IsPart = false;            ///< whether some of the cells are fitted
  std::vector<char> PointsBeside; ///< of the surface that is not fitted
  bool HasSurfaces = false;
  bool IsPlaced = false;
  std::vector<int> LinearCells;
  bool IsLayerNeeded = false;
  bool AreFeaturesProlonged = false;
  MeshTopology<Dim> Topology;
  SurfaceMesh Surface;
  ClassificationParams Classification;
  bool Layer = true;
  std::vector<int> Folded;
  MeshClassification Parts;
  SplineSpacePtr<Dim> Space;
  FastPath<Dim> Fast;
  Spline<Dim> Before;
  std::vector<std::string> ProjectionWarnings;
  std::vector<int> OnCurves; ///< functions
  ElementVerdicts Verdicts;
  double AllowedDistance = 0.0; ///< of the surface from the target, when elements are mended
  CADFit<Dim> Fit;
};
}

namespace
{
/// Whether a fit is much farther from the target than another, in the sense of mending.
template <int Dim>
bool IsFar(const CADFit<Dim>& fit, const CADFit<Dim>& from)
{
  return fit.Distances.ToTarget.RootMeanSquare >
    std::max(MostGrowth * from.Distances.ToTarget.RootMeanSquare,
      MostOfMesh * from.Distances.MeshToTarget.RootMeanSquare);
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
  Attempt attempt;
  attempt.MeanLengths = params.Lengths == FitLengths::Mean;
  bool mayTakeMean = params.Lengths == FitLengths::Automatic;
  Result<CADFit<Dim>> best;
  std::unique_ptr<CADFitting<Dim>> last; // but for the one with mean lengths
  for (int i = 0; i < (Dim == 2 ? MostAttempts : MostAttempts - 1);)
  {
    auto fitting = std::make_unique<CADFitting<Dim>>(mesh, points, target.get(), params, attempt);
    auto fit = fitting->Run();
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
    if (mayTakeMean && attempt.MeanLengths)
    {
      mayTakeMean = attempt.MeanLengths = false; // once, beside the others
    }
    else
    {
      last = std::move(fitting);
      ++i;
    }
    // with a layer, then by mean lengths, then without the curves where elements have no
    // certificate, then the corners
    const std::set<int> curves = last->CurvesAtUncertified();
    const std::set<int> corners = last->CornersAtUncertified();
    if (last->NeedsLayer() && params.Layer && !attempt.Layer)
    {
      attempt.Layer = true;
    }
    else if (mayTakeMean)
    {
      attempt.MeanLengths = true;
    }
    else if (!curves.empty())
    {
      attempt.LeftOut = last->LeftOut();
      attempt.LeftOut.insert(curves.begin(), curves.end());
    }
    else if (!corners.empty())
    {
      attempt.LeftOut = last->LeftOut();
      attempt.LeftOutCorners.insert(corners.begin(), corners.end());
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
