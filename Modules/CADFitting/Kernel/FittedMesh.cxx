// SPDX-License-Identifier: BSD-3-Clause
#include "FittedMesh.h"

#include "MeshTarget.h"
#include "QueryBlocks.h"
#include "SurfaceLayer.h"
#include "TargetDistances.h"
#include "VertexFit.h"

#include <algorithm>
#include <numeric>

namespace knotwork
{
namespace
{
/// Rounds in which curves of the target are given up that fold cells.
constexpr int MostFoldedRounds = 4;
constexpr int MostSweeps = 40;
constexpr int PoorSweeps = 15; ///< where cells are to get a better shape
/// Of the mean edge by which the points of the surface are shifted for a layer.
constexpr double LayerShare = 0.3;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

template <int Dim>
Status Link(FittedMesh<Dim>& fitted, const CADFitParams& params)
{
  auto topology = MeshTopology<Dim>::Make(fitted.Mesh);
  if (topology)
  {
    fitted.Topology = std::move(topology.Value);
    fitted.Surface = MakeSurfaceMesh<Dim>(
      fitted.Mesh, fitted.Topology, fitted.IsPart ? params.FittedCells : std::vector<char>());
  }
  if (topology && fitted.IsPart)
  {
    if (fitted.Surface.Facets.empty())
    {
      return { ErrorCode::InvalidParameter,
        Dim == 2 ? "no cell is to be fitted: all marks of fitted cells are 0"
                 : "no cell that is to be fitted has a face on the mesh's surface" };
    }
    fitted.PointsBeside = PointsBeside<Dim>(fitted.Surface, fitted.Mesh, fitted.Topology);
  }
  return topology.Status;
}

template <int Dim>
void TakeMeshAsTarget(FittedMesh<Dim>& fitted)
{
  fitted.IsFitted = false;
  TriangleMesh triangles;
  triangles.Points = fitted.Points;
  for (const auto& quad : fitted.Surface.Quads)
  {
    triangles.Triangles.push_back({ quad[0], quad[1], quad[2] });
    triangles.Triangles.push_back({ quad[0], quad[2], quad[3] });
  }
  // a mesh that is no one surface is fitted all the same, and not measured
  MeshFeatureParams features;
  features.SharpAngle = 179.0;
  if (auto own = MakeMeshTarget(triangles, features))
  {
    fitted.Target = std::move(own.Value);
  }
}

/// Whether the mesh lies at the target, and which dimensions can be fitted.
template <int Dim>
Status CheckNear(FittedMesh<Dim>& fitted, const CADFitParams& params)
{
  const FitTarget& target = *fitted.Target;
  if (Dim == 3 && target.HasSurface() && !target.IsClosed() && params.Surfaces && !fitted.IsPart)
  {
    return { ErrorCode::InvalidTopology,
      "the target has a rim, and the surface of hexahedra has none: close the target, fit "
      "curves alone, or choose the cells that are fitted" };
  }
  fitted.HasSurfaces = params.Surfaces && target.HasSurface();
  if (!target.HasSurface())
  {
    return {};
  }
  PointMatrix points(static_cast<Eigen::Index>(fitted.Surface.Points.size()), 3);
  for (std::size_t i = 0; i < fitted.Surface.Points.size(); ++i)
  {
    points.row(static_cast<Eigen::Index>(i)) = fitted.Points.row(fitted.Surface.Points[i]);
  }
  TargetPoints feet;
  TargetDistanceParams search;
  search.Threads = params.Threads;
  const bool isPlane = Dim == 2 && (fitted.Points.col(2).array() == fitted.Points(0, 2)).all();
  if (Status status = FindOnTarget(target, points, feet, search); !status)
  {
    // the inside of a plane mesh need not be near a target that its rim lies on
    fitted.HasSurfaces = fitted.HasSurfaces && !isPlane;
    return isPlane ? Status() : status;
  }
  const Eigen::VectorXd distances = (feet.Points - points).rowwise().norm();
  const std::vector<double> lengths = EdgeLengthsAt(fitted.Surface, fitted.Points);
  const double edge = std::accumulate(lengths.begin(), lengths.end(), 0.0) /
    static_cast<double>(fitted.Surface.Points.size());
  if (isPlane && distances.mean() > 0.5 * edge)
  {
    // the inside of a plane mesh does not lie on the target: its rim alone does
    fitted.HasSurfaces = false;
    return {};
  }
  const double size = (feet.Points.colwise().maxCoeff() - feet.Points.colwise().minCoeff()).norm();
  if (fitted.HasSurfaces && !(distances.mean() <= params.FarShare * size))
  {
    return { ErrorCode::InvalidParameter,
      "the mesh is " + std::to_string(distances.mean()) +
        " from its target in the mean, whose closest points extend over " + std::to_string(size) +
        ": give both in the same unit and place" };
  }
  return {};
}

template <int Dim>
Status Classify(FittedMesh<Dim>& fitted, const CADFitParams& params)
{
  fitted.Parts = {};
  fitted.Parts.PointParts.resize(At(fitted.Mesh.NumPoints));
  fitted.Parts.CurveOf.assign(fitted.Surface.Edges.size(), -1);
  fitted.Parts.FaceOf.assign(fitted.Surface.Quads.size(), -1);
  if (!fitted.IsFitted)
  {
    return {};
  }
  ClassificationParams classification;
  classification.LeftOut = fitted.Choice.LeftOut;
  classification.LeftOutCorners = fitted.Choice.LeftOutCorners;
  classification.Faces = fitted.HasSurfaces;
  classification.Threads = params.Threads;
  auto parts = ClassifyMesh(fitted.Surface, fitted.Points, *fitted.Target, classification);
  if (parts)
  {
    fitted.Parts = std::move(parts.Value);
  }
  return parts.Status;
}

/// A mesh that has no room for the edges of its target is better round there than folded.
template <int Dim>
Status GiveUpFolded(FittedMesh<Dim>& fitted, const CADFitParams& params)
{
  Status status;
  for (int round = 0; status && params.Untangle && round < MostFoldedRounds; ++round)
  {
    const std::set<int> curves = fitted.CurvesAt(fitted.Folded);
    if (curves.empty())
    {
      break;
    }
    fitted.Choice.LeftOut.insert(curves.begin(), curves.end());
    fitted.Points = *fitted.Given;
    status = Classify(fitted, params);
    status = status ? fitted.MovePoints({}, params) : status;
  }
  return status;
}

Status AddLayerIfNeeded(FittedMesh<3>& fitted, const CADFitParams& params)
{
  const std::vector<int> edges = EdgesOfTwoFaces(fitted.Surface, fitted.Parts);
  if (edges.empty() || !fitted.HasSurfaces || fitted.IsPart)
  {
    return {};
  }
  fitted.IsLayerNeeded = true;
  if (!params.Layer || !fitted.Choice.Layer)
  {
    return {};
  }
  LayeredMesh layered = AddLayer(fitted.Mesh, fitted.Surface, fitted.Points, LayerShare);
  fitted.LayerCells = layered.Mesh.NumCells() - fitted.Mesh.NumCells();
  fitted.Mesh = std::move(layered.Mesh);
  fitted.Points = std::move(layered.Points);
  fitted.CellOf = std::move(layered.CellOf);
  Status status = Link(fitted, params);
  status = status ? Classify(fitted, params) : status;
  if (!status)
  {
    return status;
  }
  // the layer, and what it left
  std::vector<int> poor(At(fitted.LayerCells));
  std::iota(poor.begin(), poor.end(), fitted.Mesh.NumCells() - fitted.LayerCells);
  return fitted.MovePoints(poor, params);
}
}

template <int Dim>
std::set<int> FittedMesh<Dim>::CurvesAt(const std::vector<int>& cells) const
{
  std::set<int> curves;
  std::set<int> points;
  for (const int cell : cells)
  {
    points.insert(this->Mesh.Cell(cell), this->Mesh.Cell(cell) + (1 << Dim));
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

template <int Dim>
std::set<int> FittedMesh<Dim>::CornersAt(const std::vector<int>& cells) const
{
  std::set<int> corners;
  for (const int cell : cells)
  {
    for (int k = 0; k < (1 << Dim); ++k)
    {
      const TargetPart& part = this->Parts.PointParts[At(this->Mesh.Cell(cell)[k])];
      if (part.Entity == TargetEntity::Vertex)
      {
        corners.insert(part.Id);
      }
    }
  }
  return corners;
}

template <int Dim>
Status FittedMesh<Dim>::MovePoints(const std::vector<int>& poor, const CADFitParams& params)
{
  VertexFitParams own;
  own.Surfaces = this->HasSurfaces;
  own.Untangle = params.Untangle;
  own.Rings = params.UntanglingRings;
  own.Poor = poor;
  own.IsHeld = this->PointsBeside;
  own.MaxSweeps = poor.empty() ? MostSweeps : PoorSweeps;
  own.Threads = params.Threads;
  own.Progress = PartOf(params.Progress, 0.0, 0.2);
  auto placed = MoveOntoTarget<Dim>(
    this->Mesh, this->Topology, this->Surface, this->Parts, this->Points, *this->Target, own);
  if (!placed)
  {
    return placed.Status;
  }
  if (this->LayerCells == 0 && !this->IsPlaced)
  {
    this->FoldedCells = static_cast<int>(placed->FoldedBefore.size());
  }
  this->IsPlaced = true;
  this->Folded = std::move(placed->Folded);
  this->Points = std::move(placed->Points);
  return {};
}

template <int Dim>
Status FittedMesh<Dim>::Place(const CellMesh<Dim>& mesh, const PointMatrix& points,
  const FitTargetPtr& target, const PlacementChoice& choice, const CADFitParams& params)
{
  this->Given = &points;
  this->Target = target;
  this->Choice = choice;
  this->IsPart = target &&
    std::find(params.FittedCells.begin(), params.FittedCells.end(), 0) != params.FittedCells.end();
  this->Mesh = mesh;
  this->Points = points;
  this->CellOf.resize(At(mesh.NumCells()));
  std::iota(this->CellOf.begin(), this->CellOf.end(), 0);
  Status status = Link(*this, params);
  if (status && !target)
  {
    TakeMeshAsTarget(*this);
  }
  status = status && this->IsFitted ? CheckNear(*this, params) : status;
  status = status ? Classify(*this, params) : status;
  if (status && this->IsFitted)
  {
    status = this->MovePoints({}, params);
    status = status ? GiveUpFolded(*this, params) : status;
    if constexpr (Dim == 3)
    {
      status = status ? AddLayerIfNeeded(*this, params) : status;
    }
  }
  return status;
}

template struct FittedMesh<2>;
template struct FittedMesh<3>;
}
