// SPDX-License-Identifier: BSD-3-Clause
#include "CADTopology.h"

#include "CADSession.h"
#include "CADTopologyShapes.h"
#include "LoadedDocument.h"
#include "ModelDocument.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <BOPTools_AlgoTools3D.hxx>
#include <BRepBndLib.hxx>
#include <BRepTools_WireExplorer.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GeomAPI_ProjectPointOnSurf.hxx>
#include <IntTools_Context.hxx>
#include <ShapeAnalysis.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Wire.hxx>

#include <algorithm>
#include <cmath>
#include <map>

namespace knotwork
{
int CADTopology::Shapes::AddVertex(const TopoDS_Vertex& vertex, CADTopology& model)
{
  if (const int* known = this->VertexIds.Seek(vertex))
  {
    return *known;
  }
  const Eigen::Vector3d point = ToEigen(BRep_Tool::Pnt(vertex));
  const double tolerance = std::max(BRep_Tool::Tolerance(vertex), this->Tolerance);
  int id = 0;
  const int count = static_cast<int>(model.Vertices.size());
  while (id < count &&
    (model.Vertices[static_cast<std::size_t>(id)] - point).norm() >
      std::max(tolerance, this->VertexTolerances[static_cast<std::size_t>(id)]))
  {
    ++id;
  }
  if (id == count)
  {
    model.Vertices.push_back(point);
    this->VertexTolerances.push_back(tolerance);
  }
  this->VertexIds.Bind(vertex, id);
  return id;
}

/// An edge of other bodies along the same curve, -1: none.
std::pair<int, bool> CADTopology::Shapes::FindEqual(
  const MeasuredCurve& curve, const std::array<int, 2>& vertices, int body, CADTopology& model)
{
  for (std::size_t e = 0; e < model.Edges.size(); ++e)
  {
    const auto& other = model.Edges[e].Vertices;
    const auto& bodies = this->BodiesOfEdges[e];
    const bool same = other == vertices;
    const bool opposite = other[0] == vertices[1] && other[1] == vertices[0];
    if ((!same && !opposite) || std::find(bodies.begin(), bodies.end(), body) != bodies.end())
    {
      continue;
    }
    for (const bool backward : { false, true })
    {
      double gap = 0.0;
      for (const double share : { 0.25, 0.5, 0.75 })
      {
        gap = std::max(gap,
          (this->Edges[e]->PointAt(share) - curve.PointAt(backward ? 1.0 - share : share)).norm());
      }
      const double tolerance =
        std::max({ this->Tolerance, this->VertexTolerances[static_cast<std::size_t>(vertices[0])],
          this->VertexTolerances[static_cast<std::size_t>(vertices[1])] });
      if ((backward ? opposite : same) && gap <= tolerance)
      {
        return { static_cast<int>(e), backward };
      }
    }
  }
  return { -1, false };
}

std::pair<int, bool> CADTopology::Shapes::AddEdge(
  const TopoDS_Edge& edge, int body, CADTopology& model)
{
  std::pair<int, bool> id;
  if (const auto* known = this->EdgeIds.Seek(edge))
  {
    id = *known;
  }
  else
  {
    const TopoDS_Edge forward = TopoDS::Edge(edge.Oriented(TopAbs_FORWARD));
    const auto curve = std::make_shared<MeasuredCurve>(forward);
    const std::array<int, 2> vertices{ this->AddVertex(TopExp::FirstVertex(forward), model),
      this->AddVertex(TopExp::LastVertex(forward), model) };
    id = this->FindEqual(*curve, vertices, body, model);
    if (id.first < 0)
    {
      id = { static_cast<int>(model.Edges.size()), false };
      this->Edges.push_back(curve);
      this->BodiesOfEdges.emplace_back();
      model.Edges.push_back({ vertices, curve->Length, curve->Turning() });
    }
    this->EdgeIds.Bind(edge, id);
  }
  auto& bodies = this->BodiesOfEdges[static_cast<std::size_t>(id.first)];
  if (bodies.empty() || bodies.back() != body)
  {
    bodies.push_back(body);
  }
  return id;
}

/// Whether two faces with the same edges are the same surface between them.
bool CADTopology::Shapes::IsSameFace(const TopoDS_Face& face, const TopologyFaceShape& other) const
{
  gp_Pnt inside;
  gp_Pnt2d parameters;
  const Handle(IntTools_Context) context = new IntTools_Context;
  if (BOPTools_AlgoTools3D::PointInFace(face, inside, parameters, context) != 0)
  {
    return false;
  }
  const GeomAPI_ProjectPointOnSurf projection(inside, other.Surface);
  return projection.NbPoints() > 0 &&
    projection.LowerDistance() <= std::max(10.0 * this->Tolerance, BRep_Tool::Tolerance(face));
}

Status CADTopology::Shapes::AddFace(
  const TopoDS_Face& given, int id, int body, const std::string& name, CADTopology& model)
{
  const std::string place = "face " + std::to_string(id);
  const TopoDS_Face face = TopoDS::Face(given.Oriented(TopAbs_FORWARD));
  CADTopologyFace made;
  TopologyFaceShape shape;
  shape.Face = face;
  shape.Surface = BRep_Tool::Surface(face);
  if (shape.Surface.IsNull())
  {
    return { ErrorCode::InvalidTopology, place + " has no surface; export the part as solids" };
  }
  made.Reversed = given.Orientation() == TopAbs_REVERSED;
  made.Name = name;
  std::vector<int> edges;
  std::vector<TopoDS_Wire> wires;
  for (TopExp_Explorer wire(face, TopAbs_WIRE); wire.More(); wire.Next())
  {
    wires.push_back(TopoDS::Wire(wire.Current()));
  }
  const TopoDS_Wire outer = ShapeAnalysis::OuterWire(face);
  std::stable_partition(
    wires.begin(), wires.end(), [&](const TopoDS_Wire& wire) { return wire.IsSame(outer); });
  for (const TopoDS_Wire& wire : wires)
  {
    std::vector<CADTopologyUse> loop;
    std::vector<UseShape> uses;
    int numEdges = 0;
    for (TopExp_Explorer edge(wire, TopAbs_EDGE); edge.More(); edge.Next())
    {
      const TopAbs_Orientation side = edge.Current().Orientation();
      numEdges += side == TopAbs_FORWARD || side == TopAbs_REVERSED ? 1 : 0;
    }
    for (BRepTools_WireExplorer explorer(wire, face); explorer.More(); explorer.Next())
    {
      const TopoDS_Edge& edge = explorer.Current();
      const bool backward = edge.Orientation() == TopAbs_REVERSED;
      CADTopologyUse use;
      UseShape useShape;
      useShape.Edge = edge;
      useShape.Curve = BRep_Tool::CurveOnSurface(edge, face, useShape.First, useShape.Last);
      useShape.Backward = backward;
      if (useShape.Curve.IsNull())
      {
        return { ErrorCode::InvalidTopology,
          place + " has an edge without a curve in its parameters; heal the file first" };
      }
      use.Vertex =
        this->AddVertex(backward ? TopExp::LastVertex(edge) : TopExp::FirstVertex(edge), model);
      if (!BRep_Tool::Degenerated(edge))
      {
        const auto [found, turned] = this->AddEdge(edge, body, model);
        use.Edge = found;
        use.Reversed = turned != backward;
        useShape.Measure =
          std::make_shared<MeasuredCurve>(TopoDS::Edge(edge.Oriented(TopAbs_FORWARD)));
        edges.push_back(found);
      }
      loop.push_back(use);
      uses.push_back(std::move(useShape));
    }
    if (loop.empty() || static_cast<int>(loop.size()) != numEdges)
    {
      return { ErrorCode::InvalidTopology,
        place + " has a loop whose edges do not follow each other; heal the file first" };
    }
    made.Loops.push_back(std::move(loop));
    shape.Loops.push_back(std::move(uses));
  }
  if (made.Loops.empty())
  {
    return { ErrorCode::InvalidTopology,
      place + " has no loop; write the file again with trimmed faces" };
  }
  std::sort(edges.begin(), edges.end());
  for (const int other : this->FacesOfEdges[edges])
  {
    CADTopologyFace& known = model.Faces[static_cast<std::size_t>(other)];
    if (known.Bodies.size() == 1 && known.Bodies[0] != body &&
      this->IsSameFace(face, this->Faces[static_cast<std::size_t>(other)]))
    {
      known.Ids.push_back(id);
      known.Bodies.push_back(body);
      model.Bodies[static_cast<std::size_t>(body)].Sides.push_back({ other, true });
      return {};
    }
  }
  made.Ids = { id };
  made.Bodies = { body };
  Bnd_Box box;
  BRepBndLib::Add(face, box, false);
  shape.Size = box.IsVoid() ? 0.0 : std::sqrt(box.SquareExtent());
  shape.Adaptor = std::make_shared<GeomAdaptor_Surface>(shape.Surface);
  made.IsPlane = shape.Adaptor->GetType() == GeomAbs_Plane;
  const int index = static_cast<int>(model.Faces.size());
  this->FacesOfEdges[edges].push_back(index);
  model.Bodies[static_cast<std::size_t>(body)].Sides.push_back({ index, false });
  model.Faces.push_back(std::move(made));
  this->Faces.push_back(std::move(shape));
  return {};
}

Status CADTopology::Build(const ModelBodies& bodies, const std::string& place)
{
  constexpr double LeastTolerance = 1e-7; ///< of the diagonal
  this->Impl = std::make_shared<Shapes>();
  Bnd_Box box;
  for (const ModelBody& body : bodies.Bodies)
  {
    BRepBndLib::Add(body.Shape, box, false);
  }
  if (box.IsVoid())
  {
    return { ErrorCode::EmptyInput, place + ": there is no face in it" };
  }
  this->Diagonal = std::sqrt(box.SquareExtent());
  this->Impl->Tolerance = LeastTolerance * this->Diagonal;
  int id = 0;
  for (const ModelBody& body : bodies.Bodies)
  {
    const int index = static_cast<int>(this->Bodies.size());
    this->Bodies.emplace_back();
    this->Bodies.back().IsSolid = body.Shape.ShapeType() == TopAbs_SOLID;
    for (TopExp_Explorer face(body.Shape, TopAbs_FACE); face.More(); face.Next())
    {
      const ShapeAttributes* own = bodies.Faces.Seek(face.Current());
      if (Status added = this->Impl->AddFace(
            TopoDS::Face(face.Current()), id++, index, own ? own->Name : std::string(), *this);
          !added)
      {
        return { added.Code, place + ": " + added.Detail };
      }
    }
  }
  return this->Faces.empty() ? Status{ ErrorCode::EmptyInput, place + ": there is no face in it" }
                             : Status();
}

Result<CADTopology> CADTopology::Read(const std::string& file, LengthUnit unit)
{
  CADTopology model;
  const std::string place = "'" + file + "'";
  CADSession session(unit);
  const Status status = session.Run(place,
    [&]() -> Status
    {
      LoadedDocument loaded;
      if (Status read = LoadDocument(session, file, unit, loaded); !read)
      {
        return read;
      }
      return model.Build(ModelDocument(loaded.Document).Take(), place);
    });
  return status ? Result<CADTopology>(std::move(model)) : Result<CADTopology>(status);
}

Eigen::Vector3d CADTopology::EdgePoint(int edge, double share) const
{
  return this->Impl->Edges[static_cast<std::size_t>(edge)]->PointAt(share);
}

namespace
{
/// Where parameters of a face are on one of its surfaces.
struct SurfacePlace
{
  const GeomAdaptor_Surface* Surface;
  Eigen::Vector2d Parameters;
  Eigen::Matrix2d Derivative; ///< of the surface's parameters by those of the face
  bool Reversed;              ///< the surface runs against the face
};

SurfacePlace PlaceOn(const JoinedFaces& joined, const Eigen::Vector2d& parameters)
{
  const CompositePlace place = joined.Chart.At(parameters);
  const auto at = static_cast<std::size_t>(place.Face);
  return { joined.Faces[at].Adaptor.get(), place.Parameters, place.Derivative,
    joined.Reversed[at] };
}

SurfacePlace PlaceOn(const TopologyFaceShape& shape, const Eigen::Vector2d& parameters)
{
  return shape.Joined
    ? PlaceOn(*shape.Joined, parameters)
    : SurfacePlace{ shape.Adaptor.get(), parameters, Eigen::Matrix2d::Identity(), false };
}

Eigen::Vector2d ParametersOnOutline(const OutlineUse& use, double share)
{
  const auto behind =
    std::upper_bound(use.Shares.begin() + 1, use.Shares.end() - 1, share) - use.Shares.begin();
  const auto i = static_cast<std::size_t>(behind);
  const double way = (share - use.Shares[i - 1]) / (use.Shares[i] - use.Shares[i - 1]);
  return (1.0 - way) * use.Places[i - 1] + way * use.Places[i];
}

/// Gauss-Newton steps that are halved where the derivative jumps, between faces.
CADPlace ProjectOnJoined(const JoinedFaces& joined, const Eigen::Vector3d& point,
  const Eigen::Vector2d& guess, double still)
{
  constexpr int MaxSteps = 30;
  constexpr int Halvings = 6;
  CADPlace place{ joined.Chart.Nearest(guess), {} };
  for (int step = 0; step < MaxSteps; ++step)
  {
    const SurfacePlace here = PlaceOn(joined, place.Parameters);
    gp_Pnt at;
    gp_Vec du;
    gp_Vec dv;
    here.Surface->D1(here.Parameters[0], here.Parameters[1], at, du, dv);
    place.Point = ToEigen(at);
    Eigen::Matrix<double, 3, 2> tangents;
    tangents << ToEigen(du), ToEigen(dv);
    tangents *= here.Derivative;
    const Eigen::Matrix2d matrix = tangents.transpose() * tangents;
    if (!(matrix.determinant() > 1e-12 * matrix(0, 0) * matrix(1, 1)))
    {
      break;
    }
    Eigen::Vector2d move = matrix.inverse() * (tangents.transpose() * (point - place.Point));
    bool nearer = false;
    for (int halving = 0; halving < Halvings && !nearer; ++halving, move *= 0.5)
    {
      const Eigen::Vector2d next = joined.Chart.Nearest(place.Parameters + move);
      const SurfacePlace there = PlaceOn(joined, next);
      const Eigen::Vector3d found =
        ToEigen(there.Surface->Value(there.Parameters[0], there.Parameters[1]));
      if ((found - point).squaredNorm() < (place.Point - point).squaredNorm())
      {
        nearer = (next - place.Parameters).norm() > still;
        place = { next, found };
        break;
      }
    }
    if (!nearer)
    {
      break;
    }
  }
  return place;
}
}

Eigen::Vector2d CADTopology::UseParameters(int face, int loop, int use, double share) const
{
  const TopologyFaceShape& ofFace = this->Impl->Faces[static_cast<std::size_t>(face)];
  if (ofFace.Joined)
  {
    return ParametersOnOutline(
      ofFace.Joined->Loops[static_cast<std::size_t>(loop)][static_cast<std::size_t>(use)], share);
  }
  const UseShape& shape =
    ofFace.Loops[static_cast<std::size_t>(loop)][static_cast<std::size_t>(use)];
  const double along = shape.Backward ? 1.0 - share : share;
  double parameter = shape.First + along * (shape.Last - shape.First);
  if (shape.Measure)
  {
    // pcurve and curve have the same parameter, but for files whose ranges differ
    const double own = shape.Measure->ParameterAt(along);
    parameter = shape.First +
      (own - shape.Measure->First) / (shape.Measure->Last - shape.Measure->First) *
        (shape.Last - shape.First);
  }
  const gp_Pnt2d place = shape.Curve->Value(parameter);
  return { place.X(), place.Y() };
}

Eigen::Vector3d CADTopology::FacePoint(int face, const Eigen::Vector2d& parameters) const
{
  const SurfacePlace place = PlaceOn(this->Impl->Faces[static_cast<std::size_t>(face)], parameters);
  return ToEigen(place.Surface->Value(place.Parameters[0], place.Parameters[1]));
}

Eigen::Vector3d CADTopology::FaceNormal(int face, const Eigen::Vector2d& parameters) const
{
  const SurfacePlace place = PlaceOn(this->Impl->Faces[static_cast<std::size_t>(face)], parameters);
  gp_Pnt point;
  gp_Vec u;
  gp_Vec v;
  place.Surface->D1(place.Parameters[0], place.Parameters[1], point, u, v);
  const Eigen::Vector3d normal = ToEigen(u).cross(ToEigen(v));
  const double length = normal.norm();
  const double size = std::max(u.SquareMagnitude(), v.SquareMagnitude());
  if (!(length > 1e-9 * size))
  {
    return Eigen::Vector3d::Zero();
  }
  const bool reversed = place.Reversed != this->Faces[static_cast<std::size_t>(face)].Reversed;
  return reversed ? Eigen::Vector3d(-normal / length) : Eigen::Vector3d(normal / length);
}

double CADTopology::FaceCurvature(int face, const Eigen::Vector2d& parameters) const
{
  const SurfacePlace place = PlaceOn(this->Impl->Faces[static_cast<std::size_t>(face)], parameters);
  gp_Pnt point;
  gp_Vec u;
  gp_Vec v;
  gp_Vec uu;
  gp_Vec vv;
  gp_Vec uv;
  place.Surface->D2(place.Parameters[0], place.Parameters[1], point, u, v, uu, vv, uv);
  const Eigen::Vector3d normal = ToEigen(u).cross(ToEigen(v));
  const double e = u.Dot(u);
  const double f = u.Dot(v);
  const double g = v.Dot(v);
  const double area = e * g - f * f;
  if (!(area > 1e-12 * std::max(e, g) * std::max(e, g)))
  {
    return 0.0;
  }
  // coefficients of the second fundamental form
  const Eigen::Vector3d unit = normal / normal.norm();
  const double l = ToEigen(uu).dot(unit);
  const double m = ToEigen(uv).dot(unit);
  const double n = ToEigen(vv).dot(unit);
  const double mean = (e * n - 2.0 * f * m + g * l) / (2.0 * area);
  const double gauss = (l * n - m * m) / area;
  return std::abs(mean) + std::sqrt(std::max(0.0, mean * mean - gauss));
}

CADPlace CADTopology::Project(
  int face, const Eigen::Vector3d& point, const Eigen::Vector2d& guess) const
{
  constexpr int MaxSteps = 30;
  const TopologyFaceShape& shape = this->Impl->Faces[static_cast<std::size_t>(face)];
  if (shape.Joined)
  {
    return ProjectOnJoined(*shape.Joined, point, guess, 1e-13 * shape.Size);
  }
  const GeomAdaptor_Surface& surface = *shape.Adaptor;
  CADPlace place{ guess, {} };
  // Gauss-Newton steps: they converge for points near the surface
  gp_Pnt at;
  gp_Vec du;
  gp_Vec dv;
  const auto limited = [](double value, double lower, double upper, bool periodic)
  { return periodic ? value : std::clamp(value, lower, upper); };
  for (int step = 0; step < MaxSteps; ++step)
  {
    surface.D1(place.Parameters[0], place.Parameters[1], at, du, dv);
    Eigen::Matrix<double, 3, 2> tangents;
    tangents << ToEigen(du), ToEigen(dv);
    const Eigen::Vector2d lengths = tangents.colwise().norm().transpose().cwiseMax(1e-300);
    const Eigen::Vector2d right = tangents.transpose() * (point - ToEigen(at));
    const Eigen::Matrix2d matrix = tangents.transpose() * tangents;
    const double determinant = matrix.determinant();
    Eigen::Vector2d move = Eigen::Vector2d::Zero();
    if (determinant > 1e-12 * std::pow(lengths[0] * lengths[1], 2))
    {
      move = matrix.inverse() * right;
    }
    else
    {
      const int strong = lengths[0] > lengths[1] ? 0 : 1;
      move[strong] = right[strong] / (lengths[strong] * lengths[strong]);
    }
    const Eigen::Vector2d before = place.Parameters;
    place.Parameters[0] = limited(before[0] + move[0], surface.FirstUParameter(),
      surface.LastUParameter(), surface.IsUPeriodic());
    place.Parameters[1] = limited(before[1] + move[1], surface.FirstVParameter(),
      surface.LastVParameter(), surface.IsVPeriodic());
    if ((place.Parameters - before).cwiseProduct(lengths).norm() <= 1e-13 * shape.Size)
    {
      break;
    }
  }
  place.Point = this->FacePoint(face, place.Parameters);
  return place;
}
}
