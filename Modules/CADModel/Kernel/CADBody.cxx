// SPDX-License-Identifier: BSD-3-Clause
#include "CADBody.h"

#include "CADEdge.h"
#include "CADGeometry.h"
#include "CADSession.h"
#include "EdgeSamples.h"
#include <knotwork/SplineCore/Numbers.h>

#include <BRepAdaptor_Surface.hxx>
#include <BRepTools_WireExplorer.hxx>
#include <BRep_Tool.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>

#include <algorithm>
#include <memory>

namespace knotwork
{
namespace
{
constexpr int SamplesOfPolygon = 16; ///< of an edge, to tell the outer loop

struct UseInWire
{
  int Edge = 0;        ///< index of the body's edges, from 1
  std::size_t Use = 0; ///< of the edge's uses
  bool Reversed = false;
};

struct FaceInWork
{
  std::unique_ptr<CADSurface> Surface;
  std::vector<std::vector<UseInWire>> Wires;
};

/// Edges of a wire in their order.
std::vector<TopoDS_Edge> OrderedEdges(const TopoDS_Wire& wire, const TopoDS_Face& face)
{
  std::vector<TopoDS_Edge> ordered;
  for (BRepTools_WireExplorer explorer(wire, face); explorer.More(); explorer.Next())
  {
    ordered.push_back(explorer.Current());
  }
  std::vector<TopoDS_Edge> stored;
  for (TopoDS_Iterator it(wire); it.More(); it.Next())
  {
    const TopAbs_Orientation orientation = it.Value().Orientation();
    if (orientation == TopAbs_FORWARD || orientation == TopAbs_REVERSED)
    {
      stored.push_back(TopoDS::Edge(it.Value()));
    }
  }
  return ordered.size() == stored.size() ? ordered : stored;
}

/// Splines that a reader made periodic, as closed curves without a period.
Handle(Geom2d_Curve) CutOpen(const Handle(Geom2d_Curve) & curve, double first, double last)
{
  const auto spline = Handle(Geom2d_BSplineCurve)::DownCast(curve);
  if (spline.IsNull() || !spline->IsPeriodic())
  {
    return curve;
  }
  const auto open = Handle(Geom2d_BSplineCurve)::DownCast(spline->Copy());
  open->SetNotPeriodic();
  return open->FirstParameter() <= first && open->LastParameter() >= last ? open : curve;
}

SurfaceType TypeOf(const TopoDS_Face& face)
{
  switch (BRepAdaptor_Surface(face, false).GetType())
  {
    case GeomAbs_Plane:
      return SurfaceType::Plane;
    case GeomAbs_Cylinder:
      return SurfaceType::Cylinder;
    case GeomAbs_Sphere:
      return SurfaceType::Sphere;
    case GeomAbs_Cone:
      return SurfaceType::Cone;
    case GeomAbs_Torus:
      return SurfaceType::Torus;
    case GeomAbs_SurfaceOfExtrusion:
      return SurfaceType::Extrusion;
    case GeomAbs_SurfaceOfRevolution:
      return SurfaceType::Revolution;
    default:
      return SurfaceType::FreeForm;
  }
}

class BodyReader
{
public:
  BodyReader(const std::vector<CADFace>& faces, int body, double tolerance, CADContents& contents)
    : Faces(faces), Body(body), Tolerance(tolerance), Contents(contents)
  {
  }
  void Read();

private:
  Status CollectFace(const TopoDS_Face& face, FaceInWork& work);
  Status UnifyEdges();
  Status MakeFace(const CADFace& face, const FaceInWork& work);
  double AreaOfWire(const std::vector<UseInWire>& wire) const;
  std::string PlaceOf(std::size_t f) const;

  const std::vector<CADFace>& Faces;
  int Body;
  double Tolerance;
  CADContents& Contents;
  TopTools_IndexedMapOfShape Edges;
  TopTools_IndexedMapOfShape Vertices;
  std::vector<std::vector<CADPcurve>> Uses; ///< of the edges
  std::vector<CADEdge> Unified;
  std::vector<int> NumberOfEdge; ///< in the model, -1 not yet
  std::vector<int> NumberOfVertex;
};

std::string BodyReader::PlaceOf(std::size_t f) const
{
  return "face " + std::to_string(f) + " of body " + std::to_string(this->Body) +
    (this->Faces[f].Name.empty() ? "" : " ('" + this->Faces[f].Name + "')");
}

Status BodyReader::CollectFace(const TopoDS_Face& oriented, FaceInWork& work)
{
  const TopoDS_Face face = TopoDS::Face(oriented.Oriented(TopAbs_FORWARD));
  if (BRep_Tool::Surface(face).IsNull())
  {
    return { ErrorCode::InvalidTopology, "it has no surface" };
  }
  work.Surface = std::make_unique<CADSurface>(face);
  if (work.Surface->Surface().IsNull())
  {
    return { ErrorCode::InvalidDegree, "its surface has no spline of degree 9 or less" };
  }
  for (TopExp_Explorer wires(face, TopAbs_WIRE); wires.More(); wires.Next())
  {
    std::vector<UseInWire>& wire = work.Wires.emplace_back();
    for (const TopoDS_Edge& edge : OrderedEdges(TopoDS::Wire(wires.Current()), face))
    {
      CADPcurve pcurve;
      pcurve.Curve = BRep_Tool::CurveOnSurface(edge, face, pcurve.First, pcurve.Last);
      pcurve.Surface = work.Surface.get();
      pcurve.Curve = CutOpen(pcurve.Curve, pcurve.First, pcurve.Last);
      if (pcurve.Curve.IsNull() || !(pcurve.First < pcurve.Last))
      {
        return { ErrorCode::InvalidTopology, "an edge has no pcurve" };
      }
      UseInWire use;
      use.Edge = this->Edges.Add(edge.Oriented(TopAbs_FORWARD));
      use.Reversed = edge.Orientation() == TopAbs_REVERSED;
      this->Uses.resize(static_cast<std::size_t>(this->Edges.Extent()));
      std::vector<CADPcurve>& uses = this->Uses[static_cast<std::size_t>(use.Edge - 1)];
      use.Use = uses.size();
      uses.push_back(pcurve);
      wire.push_back(use);
    }
    if (wire.empty())
    {
      work.Wires.pop_back();
    }
  }
  return {};
}

/// Signed, in the parameter plane.
double BodyReader::AreaOfWire(const std::vector<UseInWire>& wire) const
{
  std::vector<gp_XY> polygon;
  for (const UseInWire& use : wire)
  {
    const CADPcurve& pcurve = this->Uses[static_cast<std::size_t>(use.Edge - 1)][use.Use];
    for (int i = 0; i < SamplesOfPolygon; ++i)
    {
      const double s = static_cast<double>(i) / SamplesOfPolygon;
      const double share = use.Reversed ? 1.0 - s : s;
      const double t = (1.0 - share) * pcurve.First + share * pcurve.Last;
      polygon.push_back(pcurve.Surface->Map(pcurve.Curve->Value(t).XY()));
    }
  }
  double area = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    area += 0.5 * (polygon[i] ^ polygon[(i + 1) % polygon.size()]);
  }
  return area;
}

Status BodyReader::UnifyEdges()
{
  this->Unified.resize(this->Uses.size());
  this->NumberOfEdge.assign(this->Uses.size(), -1);
  for (std::size_t e = 0; e < this->Uses.size(); ++e)
  {
    const TopoDS_Edge& edge = TopoDS::Edge(this->Edges(static_cast<int>(e) + 1));
    if (this->Uses[e].empty())
    {
      continue;
    }
    auto unified = UnifyEdge(edge, this->Uses[e], this->Tolerance);
    if (!unified)
    {
      return unified.Status;
    }
    this->Unified[e] = std::move(unified.Value);
    this->Contents.NumRefitted += this->Unified[e].Refitted ? 1 : 0;
    if (this->Unified[e].Deviation > this->Tolerance)
    {
      this->Contents.Warnings.push_back("edge " + std::to_string(e) + " of body " +
        std::to_string(this->Body) + " is refitted within " + Digits(this->Unified[e].Deviation) +
        ", not within " + Digits(this->Tolerance));
    }
  }
  return {};
}

Status BodyReader::MakeFace(const CADFace& source, const FaceInWork& work)
{
  TrimmedModel& model = this->Contents.Model;
  TrimmedFace face;
  auto surface = FromOpenCASCADE(work.Surface->Surface());
  if (!surface)
  {
    return surface.Status;
  }
  face.Surface = std::move(surface.Value);
  face.Reversed = source.Face.Orientation() == TopAbs_REVERSED;
  face.Type = TypeOf(source.Face);
  face.Body = this->Body;
  face.Name = source.Name;
  face.HasColor = source.HasColor;
  face.Color = source.Color;
  const BezierForm<2> form = MakeBezierForm<2>(face.Surface, 1);
  std::vector<std::pair<double, TrimmedLoop>> loops;
  double gap = 0.0;
  for (const std::vector<UseInWire>& wire : work.Wires)
  {
    auto& [area, loop] = loops.emplace_back();
    area = std::abs(this->AreaOfWire(wire));
    for (const UseInWire& use : wire)
    {
      const auto e = static_cast<std::size_t>(use.Edge - 1);
      TrimmingCurve curve;
      curve.Curve = this->Unified[e].Curve;
      curve.UV = this->Uses[e][use.Use].UV;
      curve.Reversed = use.Reversed;
      int& number = this->NumberOfEdge[e];
      number = number < 0 ? model.NumEdges++ : number;
      curve.Edge = number;
      TopoDS_Vertex ends[2];
      TopExp::Vertices(TopoDS::Edge(this->Edges(use.Edge)), ends[0], ends[1]);
      for (std::size_t end = 0; end < 2; ++end)
      {
        if (ends[end].IsNull())
        {
          return { ErrorCode::InvalidTopology, "an edge has no vertex" };
        }
        const auto v = static_cast<std::size_t>(this->Vertices.Add(ends[end]) - 1);
        this->NumberOfVertex.resize(static_cast<std::size_t>(this->Vertices.Extent()), -1);
        int& vertex = this->NumberOfVertex[v];
        vertex = vertex < 0 ? model.NumVertices++ : vertex;
        curve.Vertices[end] = vertex;
      }
      const auto samples = SampleEdge(curve.Curve, curve.ParameterCurve(), form);
      if (!samples)
      {
        return samples.Status;
      }
      gap = std::max(gap, samples->MaxGap());
      loop.Curves.push_back(std::move(curve));
    }
  }
  std::stable_sort(
    loops.begin(), loops.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  for (auto& loop : loops)
  {
    face.Loops.push_back(std::move(loop.second));
  }
  TrimmedModel alone;
  alone.NumEdges = model.NumEdges;
  alone.NumVertices = model.NumVertices;
  alone.Faces.push_back(face);
  if (Status status = alone.Check(); !status)
  {
    return status;
  }
  this->Contents.MaxGap = std::max(this->Contents.MaxGap, gap);
  model.Faces.push_back(std::move(face));
  return {};
}

void BodyReader::Read()
{
  std::vector<FaceInWork> work(this->Faces.size());
  std::vector<Status> states(this->Faces.size());
  const auto attempt = [](const auto& body) -> Status
  {
    try
    {
      return body();
    }
    catch (const Standard_Failure&)
    {
      return { ErrorCode::InvalidFormat, FailureOfOpenCASCADE };
    }
  };
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    states[f] = attempt([&] { return this->CollectFace(this->Faces[f].Face, work[f]); });
  }
  const Status edges = attempt([&] { return this->UnifyEdges(); });
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    if (states[f])
    {
      states[f] = edges ? attempt([&] { return this->MakeFace(this->Faces[f], work[f]); }) : edges;
    }
    if (!states[f])
    {
      this->Contents.LeftOut.push_back(this->PlaceOf(f) + " is left out: " + states[f].Detail);
    }
  }
}
}

void AppendBody(
  const std::vector<CADFace>& faces, int body, double tolerance, CADContents& contents)
{
  BodyReader(faces, body, tolerance, contents).Read();
}
}
