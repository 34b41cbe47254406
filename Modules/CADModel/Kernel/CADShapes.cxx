// SPDX-License-Identifier: BSD-3-Clause
#include "CADShapes.h"

#include "AnalyticFace.h"
#include "CADGeometry.h"
#include "CADShells.h"
#include "EdgeSamples.h"
#include "SewnBoundary.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/ClampedSpline.h>
#include <knotwork/SplineCore/Numbers.h>

#include <BRep_Builder.hxx>
#include <Precision.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double ToleranceFactor = 1.02; ///< for what lies between the samples
constexpr double SameCurve = 1e-7;       ///< of an edge's size: it is a line or circle

std::string PlaceOfFace(std::size_t face)
{
  return "face " + std::to_string(face);
}

/// The model with clamped knots throughout.
Result<TrimmedModel> ClampedModel(const TrimmedModel& model)
{
  TrimmedModel result = model;
  for (std::size_t f = 0; f < result.Faces.size(); ++f)
  {
    TrimmedFace& face = result.Faces[f];
    auto surface = Clamped<2>(face.Surface);
    Status status = surface.Status;
    if (status)
    {
      face.Surface = std::move(surface.Value);
      status = CheckContinuity(face.Surface, PlaceOfFace(f));
    }
    for (TrimmedLoop& loop : face.Loops)
    {
      for (TrimmingCurve& use : loop.Curves)
      {
        auto curve = Clamped<1>(use.Curve);
        auto parameters = Clamped<1>(use.ParameterCurve());
        if (status)
        {
          status = curve ? parameters.Status : curve.Status;
        }
        if (!status)
        {
          return status;
        }
        use.Curve = std::move(curve.Value);
        use.UV = std::move(parameters->ControlPoints);
        status = CheckContinuity(
          use.Curve, PlaceOfFace(f) + ", the curve of edge " + std::to_string(use.Edge));
      }
    }
    if (!status)
    {
      return status;
    }
  }
  return result;
}

/// What is known of an edge while its uses are collected.
struct EdgeState
{
  TopoDS_Edge Edge;
  Spline<1> Curve;     ///< of the first use: the edge's
  AnalyticCurve Shape; ///< the same for OpenCASCADE
  std::array<int, 2> Vertices{};
  bool Degenerate = false;
  bool IsAnalytic = true; ///< all its faces are
  double Gap = 0.0;
  int Face = -1; ///< that is being made, and the pcurves of its uses: forward, reversed
  Handle(Geom2d_Curve) Parameters[2];
};

struct VertexState
{
  TopoDS_Vertex Vertex;
  Eigen::Vector3d Sum = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> Ends; ///< of curves and of images of pcurves
  int NumCurves = 0;
};

/// The parameter at which a pole's side lies: the one that does not run.
double PlaceOfPole(const BoundaryCurve& use)
{
  const PointMatrix& points = use.Parameters.ControlPoints;
  const Eigen::RowVectorXd length = (points.row(points.rows() - 1) - points.row(0)).cwiseAbs();
  return points(0, length[0] > length[1] ? 1 : 0);
}

/// The same loop from one of its poles on, if there are any.
BoundaryLoop BeginAtPole(const BoundaryLoop& loop, LoopBegin begin)
{
  auto best = loop.end();
  for (auto use = loop.begin(); use != loop.end(); ++use)
  {
    const bool isBetter = best == loop.end() ||
      (begin == LoopBegin::LowerPole ? PlaceOfPole(*use) < PlaceOfPole(*best)
                                     : PlaceOfPole(*use) > PlaceOfPole(*best));
    best = use->Degenerate && isBetter ? use : best;
  }
  BoundaryLoop turned(best, loop.end());
  turned.insert(turned.end(), loop.begin(), best);
  return turned;
}

class ShapeMaker
{
public:
  ShapeMaker(const TrimmedModel& model, const SewnBoundary& boundary, LoopBegin begin)
    : Model(model), Boundary(boundary), Begin(begin),
      Edges(static_cast<std::size_t>(boundary.NumEdges)),
      Vertices(static_cast<std::size_t>(boundary.NumVertices))
  {
    for (const TrimmedFace& face : model.Faces)
    {
      this->Analytic.push_back(AnalyticFace::Find(face));
    }
  }
  Result<CADShapes> Make();

private:
  Status AddUse(const BoundaryCurve& use, const BezierForm<2>& surface, const std::string& place);
  Status MeasureUse(const BoundaryCurve& use, const EdgeState& edge, const BezierForm<2>& surface,
    const std::string& place, double& gap);
  Status CollectUses();
  void ShapeEdges();
  void MakeVertices();
  void MakeEdges();
  void AddParameterCurves(const TopoDS_Face& face, const EdgeState& edge);
  Result<TopoDS_Face> MakeFace(std::size_t f);

  const TrimmedModel& Model;
  const SewnBoundary& Boundary;
  LoopBegin Begin;
  std::vector<std::optional<AnalyticFace>> Analytic; ///< faces that are
  BRep_Builder Builder;
  std::vector<EdgeState> Edges;
  std::vector<VertexState> Vertices;
};

/// Distances of the edge's curve to the image of a pcurve; ends go to the vertices.
Status ShapeMaker::MeasureUse(const BoundaryCurve& use, const EdgeState& edge,
  const BezierForm<2>& surface, const std::string& place, double& gap)
{
  const auto samples = SampleEdge(edge.Curve, use.Parameters, surface);
  if (!samples)
  {
    return { samples.Status.Code,
      place + ", edge " + std::to_string(use.Edge) + ": " + samples.Status.Detail };
  }
  gap = samples->MaxGap();
  for (std::size_t end = 0; end < 2; ++end)
  {
    VertexState& vertex = this->Vertices[static_cast<std::size_t>(use.Vertices[end])];
    const Eigen::Index row = end == 0 ? 0 : samples->Curve.rows() - 1;
    vertex.Ends.emplace_back(samples->Curve.row(row));
    vertex.Ends.emplace_back(samples->Image.row(row));
    vertex.Sum += samples->Curve.row(row).transpose();
    ++vertex.NumCurves;
  }
  return {};
}

Status ShapeMaker::AddUse(
  const BoundaryCurve& use, const BezierForm<2>& surface, const std::string& place)
{
  EdgeState& edge = this->Edges[static_cast<std::size_t>(use.Edge)];
  if (!edge.Curve.Space)
  {
    edge.Curve = use.Curve;
    edge.Vertices = use.Vertices;
    edge.Degenerate = use.Degenerate;
  }
  const KnotVector& own = use.Parameters.Space->Knots[0];
  const KnotVector& shared = edge.Curve.Space->Knots[0];
  if (edge.Vertices != use.Vertices || own.Begin() != shared.Begin() || own.End() != shared.End())
  {
    return { ErrorCode::InvalidTopology,
      place + ": edge " + std::to_string(use.Edge) +
        " has other vertices or another domain than in its first use" };
  }
  double gap = 0.0;
  const Status status = this->MeasureUse(use, edge, surface, place, gap);
  edge.Gap = std::max(edge.Gap, gap);
  return status;
}

Status ShapeMaker::CollectUses()
{
  for (std::size_t f = 0; f < this->Boundary.Faces.size(); ++f)
  {
    const BezierForm<2> surface = MakeBezierForm<2>(this->Model.Faces[f].Surface, 1);
    for (const BoundaryLoop& loop : this->Boundary.Faces[f])
    {
      for (const BoundaryCurve& use : loop)
      {
        if (Status status = this->AddUse(use, surface, PlaceOfFace(f)); !status)
        {
          return status;
        }
        EdgeState& edge = this->Edges[static_cast<std::size_t>(use.Edge)];
        edge.IsAnalytic = edge.IsAnalytic && this->Analytic[f].has_value();
      }
    }
  }
  return {};
}

/// Edges of analytic faces alone are lines and circles where they can be.
void ShapeMaker::ShapeEdges()
{
  for (EdgeState& edge : this->Edges)
  {
    if (!edge.Curve.Space)
    {
      continue;
    }
    const KnotVector& knots = edge.Curve.Space->Knots[0];
    if (edge.Degenerate)
    {
      edge.Shape = { {}, knots.Begin(), knots.End() };
      continue;
    }
    const double size = (edge.Curve.ControlPoints.colwise().maxCoeff() -
      edge.Curve.ControlPoints.colwise().minCoeff())
                          .norm();
    std::optional<AnalyticCurve> found;
    if (edge.IsAnalytic)
    {
      found = FindAnalyticCurve(edge.Curve, SameCurve * size);
    }
    edge.Shape =
      found ? *found : AnalyticCurve{ ToOpenCASCADE(edge.Curve), knots.Begin(), knots.End() };
  }
  for (std::size_t f = 0; f < this->Boundary.Faces.size(); ++f)
  {
    for (const BoundaryLoop& loop : this->Boundary.Faces[f])
    {
      for (const BoundaryCurve& use : loop)
      {
        EdgeState& edge = this->Edges[static_cast<std::size_t>(use.Edge)];
        if (this->Analytic[f] && !edge.Degenerate)
        {
          edge.Gap = std::max(edge.Gap, this->Analytic[f]->GapOf(edge.Shape));
        }
      }
    }
  }
}

void ShapeMaker::MakeVertices()
{
  for (VertexState& state : this->Vertices)
  {
    if (state.NumCurves == 0)
    {
      continue;
    }
    const Eigen::Vector3d point = state.Sum / state.NumCurves;
    double distance = 0.0;
    for (const Eigen::Vector3d& end : state.Ends)
    {
      distance = std::max(distance, (end - point).norm());
    }
    this->Builder.MakeVertex(state.Vertex, gp_Pnt(point.x(), point.y(), point.z()),
      std::max(ToleranceFactor * distance, Precision::Confusion()));
  }
}

void ShapeMaker::MakeEdges()
{
  for (EdgeState& state : this->Edges)
  {
    const double tolerance = std::max(ToleranceFactor * state.Gap, Precision::Confusion());
    if (state.Degenerate)
    {
      this->Builder.MakeEdge(state.Edge);
      this->Builder.Degenerated(state.Edge, true);
      this->Builder.UpdateEdge(state.Edge, tolerance);
    }
    else
    {
      this->Builder.MakeEdge(state.Edge, state.Shape.Curve, tolerance);
    }
    for (std::size_t end = 0; end < 2; ++end)
    {
      TopoDS_Vertex& vertex = this->Vertices[static_cast<std::size_t>(state.Vertices[end])].Vertex;
      this->Builder.UpdateVertex(vertex, tolerance); // never below the edge's
      this->Builder.Add(state.Edge, vertex.Oriented(end == 0 ? TopAbs_FORWARD : TopAbs_REVERSED));
    }
    this->Builder.Range(state.Edge, state.Shape.First, state.Shape.Last);
  }
}

void ShapeMaker::AddParameterCurves(const TopoDS_Face& face, const EdgeState& edge)
{
  const Handle(Geom2d_Curve)& forward = edge.Parameters[0];
  const Handle(Geom2d_Curve)& backward = edge.Parameters[1];
  const double tolerance = BRep_Tool::Tolerance(edge.Edge);
  if (forward.IsNull() && backward.IsNull())
  {
    return; // a plane
  }
  if (!forward.IsNull() && !backward.IsNull())
  {
    this->Builder.UpdateEdge(edge.Edge, forward, backward, face, tolerance);
  }
  else
  {
    this->Builder.UpdateEdge(edge.Edge, forward.IsNull() ? backward : forward, face, tolerance);
  }
  this->Builder.Range(edge.Edge, face, edge.Shape.First, edge.Shape.Last);
}

Result<TopoDS_Face> ShapeMaker::MakeFace(std::size_t f)
{
  TopoDS_Face face;
  const auto& analytic = this->Analytic[f];
  const Handle(Geom_Surface) surface = analytic
    ? analytic->Surface()
    : Handle(Geom_Surface)(ToOpenCASCADE(this->Model.Faces[f].Surface));
  this->Builder.MakeFace(face, surface, Precision::Confusion());
  // a surface of the opposite normal has its parameters mirrored
  const bool isTurned = analytic && analytic->IsTurned();
  const bool isPlane = analytic && analytic->IsPlane(); // which needs no pcurves
  std::vector<BoundaryLoop> loops = this->Boundary.Faces[f];
  for (BoundaryLoop& loop : loops)
  {
    if (isTurned)
    {
      std::reverse(loop.begin(), loop.end());
    }
    for (BoundaryCurve& use : loop)
    {
      use.Reversed = use.Reversed != isTurned;
    }
  }
  for (const BoundaryLoop& loop : loops) // an edge may be in several loops, or twice in one
  {
    for (const BoundaryCurve& use : loop)
    {
      EdgeState& edge = this->Edges[static_cast<std::size_t>(use.Edge)];
      if (edge.Face != static_cast<int>(f))
      {
        edge.Face = static_cast<int>(f);
        edge.Parameters[0].Nullify();
        edge.Parameters[1].Nullify();
      }
      Handle(Geom2d_Curve)& parameters = edge.Parameters[use.Reversed ? 1 : 0];
      if (!parameters.IsNull())
      {
        return { ErrorCode::InvalidTopology,
          PlaceOfFace(f) + " uses edge " + std::to_string(use.Edge) +
            " twice in the same direction" };
      }
      if (!isPlane)
      {
        parameters = analytic ? analytic->ParameterCurve(edge.Shape, use.Parameters)
                              : Handle(Geom2d_Curve)(ToOpenCASCADEPlane(use.Parameters));
      }
    }
  }
  for (const BoundaryLoop& loop : loops)
  {
    TopoDS_Wire wire;
    this->Builder.MakeWire(wire);
    for (const BoundaryCurve& use : BeginAtPole(loop, this->Begin))
    {
      EdgeState& edge = this->Edges[static_cast<std::size_t>(use.Edge)];
      this->AddParameterCurves(face, edge);
      this->Builder.SameRange(edge.Edge, true);
      this->Builder.SameParameter(edge.Edge, true);
      this->Builder.Add(wire, edge.Edge.Oriented(use.Reversed ? TopAbs_REVERSED : TopAbs_FORWARD));
    }
    wire.Closed(true);
    this->Builder.Add(face, wire);
  }
  if (this->Model.Faces[f].Reversed != isTurned)
  {
    face.Reverse();
  }
  return face;
}

Result<CADShapes> ShapeMaker::Make()
{
  if (Status status = this->CollectUses(); !status)
  {
    return status;
  }
  this->ShapeEdges();
  this->MakeVertices();
  this->MakeEdges();
  CADShapes shapes;
  ShellInput input;
  for (std::size_t f = 0; f < this->Model.Faces.size(); ++f)
  {
    auto face = this->MakeFace(f);
    if (!face)
    {
      return face.Status;
    }
    input.Faces.push_back(face.Value);
    const bool isPlane = this->Analytic[f] && this->Analytic[f]->IsPlane();
    shapes.HasPlanesOnly = shapes.HasPlanesOnly && isPlane;
    shapes.HasCurvedTypes = shapes.HasCurvedTypes || (this->Analytic[f] && !isPlane);
    input.Bodies.push_back(this->Model.Faces[f].Body);
    std::vector<EdgeUse>& uses = input.Uses.emplace_back();
    for (const BoundaryLoop& loop : this->Boundary.Faces[f])
    {
      for (const BoundaryCurve& use : loop)
      {
        shapes.HasPoles = shapes.HasPoles || use.Degenerate;
        if (!use.Degenerate)
        {
          uses.push_back({ use.Edge, use.Reversed != this->Model.Faces[f].Reversed });
        }
      }
    }
  }
  input.NumEdges = this->Boundary.NumEdges;
  shapes.Shape = MakeBodies(input);
  shapes.Faces = std::move(input.Faces);
  for (const VertexState& vertex : this->Vertices)
  {
    if (vertex.NumCurves > 0)
    {
      shapes.MaxGap = std::max(shapes.MaxGap, BRep_Tool::Tolerance(vertex.Vertex));
    }
  }
  return shapes;
}
}

Result<CADShapes> MakeShapes(const TrimmedModel& model, double sewTolerance, LoopBegin begin)
{
  if (Status status = model.Check(); !status)
  {
    return status;
  }
  auto clamped = ClampedModel(model);
  if (!clamped)
  {
    return clamped.Status;
  }
  const SewnBoundary boundary = SewBoundary(clamped.Value, sewTolerance * SizeOf(clamped.Value));
  return ShapeMaker(clamped.Value, boundary, begin).Make();
}
}
