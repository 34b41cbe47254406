// SPDX-License-Identifier: BSD-3-Clause
#include "EdgePlaces.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Geom2d_Curve.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Pln.hxx>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace knotwork
{
namespace
{
constexpr double Pi = 3.14159265358979323846;
constexpr int NumSamples = 5; ///< on an edge
}

double SizeOf(const ModelBodies& model)
{
  Bnd_Box box;
  for (const ModelBody& body : model.Bodies)
  {
    BRepBndLib::Add(body.Shape, box, false);
  }
  return box.IsVoid() ? 0.0 : std::sqrt(box.SquareExtent());
}

double LengthOf(const TopoDS_Shape& shape)
{
  GProp_GProps properties;
  BRepGProp::LinearProperties(shape, properties);
  return properties.Mass();
}

namespace
{
/// Outward normal of a face at a point of its edge; zero where there is none.
gp_Vec NormalAt(const TopoDS_Edge& edge, const TopoDS_Face& face, double share)
{
  double ends[2];
  const Handle(Geom2d_Curve) pcurve = BRep_Tool::CurveOnSurface(edge, face, ends[0], ends[1]);
  if (pcurve.IsNull())
  {
    return {};
  }
  const gp_Pnt2d uv = pcurve->Value(ends[0] + share * (ends[1] - ends[0]));
  gp_Pnt point;
  gp_Vec first[2];
  BRepAdaptor_Surface(face, false).D1(uv.X(), uv.Y(), point, first[0], first[1]);
  gp_Vec normal = first[0].Crossed(first[1]);
  const double length = normal.Magnitude();
  if (!(length > 1e-12 * first[0].Magnitude() * first[1].Magnitude()))
  {
    return {};
  }
  normal /= face.Orientation() == TopAbs_REVERSED ? -length : length;
  return normal;
}

/// Compares the normals along an edge.
void MeasureAngle(const std::vector<FacePlace>& faces, double tolerance, EdgePlace& place)
{
  const TopoDS_Face& face = faces[static_cast<std::size_t>(place.Faces[0])].Face;
  const TopoDS_Face& other = faces[static_cast<std::size_t>(place.Faces[1])].Face;
  const BRepAdaptor_Curve curve(place.Edge);
  int numConcave = 0;
  for (int i = 0; i < NumSamples; ++i)
  {
    const double share = (i + 0.5) / NumSamples;
    const gp_Vec a = NormalAt(place.Edge, face, share);
    const gp_Vec b = NormalAt(place.Edge, other, share);
    gp_Pnt point;
    gp_Vec along;
    curve.D1(curve.FirstParameter() + share * (curve.LastParameter() - curve.FirstParameter()),
      point, along);
    if (a.Magnitude() == 0.0 || b.Magnitude() == 0.0 || along.Magnitude() == 0.0)
    {
      continue;
    }
    if (place.Edge.Orientation() == TopAbs_REVERSED)
    {
      along.Reverse();
    }
    const double angle = a.Angle(b);
    place.Angle = std::max(place.Angle, angle);
    // into the face, which lies to the left of its edges
    numConcave += angle > tolerance && b.Dot(a.Crossed(along)) > 0.0 ? 1 : 0;
  }
  place.IsConcave = 2 * numConcave > NumSamples;
}
}

std::vector<EdgePlace> EdgesOf(
  const ModelBodies& model, const std::vector<FacePlace>& faces, double tolerance, bool all)
{
  std::vector<EdgePlace> edges;
  int first = 0;
  for (const ModelBody& body : model.Bodies)
  {
    struct Use
    {
      TopoDS_Edge Edge;
      int Face;
    };
    TopTools_IndexedMapOfShape known;
    std::vector<std::vector<Use>> uses;
    int id = first;
    for (TopExp_Explorer face(body.Shape, TopAbs_FACE); face.More(); face.Next(), ++id)
    {
      for (TopExp_Explorer edge(face.Current(), TopAbs_EDGE); edge.More(); edge.Next())
      {
        if (!BRep_Tool::Degenerated(TopoDS::Edge(edge.Current())))
        {
          const auto index = static_cast<std::size_t>(known.Add(edge.Current()));
          uses.resize(std::max(uses.size(), index));
          uses[index - 1].push_back({ TopoDS::Edge(edge.Current()), id });
        }
      }
    }
    first = id;
    for (const std::vector<Use>& of : uses)
    {
      const bool isBetween = of.size() == 2 && of[0].Face != of[1].Face;
      if (!isBetween && !all)
      {
        continue;
      }
      EdgePlace place;
      place.Edge = of[0].Edge;
      place.Faces[0] = of.front().Face;
      place.Faces[1] = of.back().Face;
      place.Length = LengthOf(place.Edge);
      const BRepAdaptor_Curve curve(place.Edge);
      place.Middle = curve.Value(0.5 * (curve.FirstParameter() + curve.LastParameter()));
      if (isBetween)
      {
        MeasureAngle(faces, tolerance, place);
      }
      else
      {
        place.Angle = Pi;
      }
      edges.push_back(place);
    }
  }
  return edges;
}

bool AreSame(const TopoDS_Face& a, const TopoDS_Face& b, double nearness)
{
  constexpr double turned = 1e-9;
  const BRepAdaptor_Surface first(a, false);
  const BRepAdaptor_Surface second(b, false);
  if (first.GetType() != second.GetType())
  {
    return false;
  }
  if (first.GetType() == GeomAbs_Plane)
  {
    return first.Plane().Axis().IsParallel(second.Plane().Axis(), turned) &&
      first.Plane().Distance(second.Plane().Location()) < nearness;
  }
  return first.GetType() == GeomAbs_Cylinder &&
    first.Cylinder().Axis().IsParallel(second.Cylinder().Axis(), turned) &&
    gp_Lin(first.Cylinder().Axis()).Distance(second.Cylinder().Location()) < nearness &&
    std::abs(first.Cylinder().Radius() - second.Cylinder().Radius()) < nearness;
}

namespace
{
bool CanBeExtended(const TopoDS_Face& face)
{
  switch (BRepAdaptor_Surface(face, false).GetType())
  {
    case GeomAbs_Plane:
    case GeomAbs_Cylinder:
    case GeomAbs_Sphere:
    case GeomAbs_Torus:
      return true;
    default:
      return false;
  }
}
}

std::vector<CutTool> CutTools(
  const std::vector<EdgePlace>& edges, const std::vector<FacePlace>& faces, double size)
{
  std::vector<EdgePlace> concave;
  std::copy_if(edges.begin(), edges.end(), std::back_inserter(concave),
    [](const EdgePlace& edge) { return edge.IsConcave; });
  std::stable_sort(concave.begin(), concave.end(),
    [](const EdgePlace& a, const EdgePlace& b) { return a.Length > b.Length; });
  std::vector<CutTool> tools;
  for (const EdgePlace& edge : concave)
  {
    for (const int id : edge.Faces)
    {
      const TopoDS_Face& face = faces[static_cast<std::size_t>(id)].Face;
      const bool isKnown = std::any_of(tools.begin(), tools.end(),
        [&](const CutTool& tool)
        {
          return tool.Face == id ||
            AreSame(faces[static_cast<std::size_t>(tool.Face)].Face, face, 1e-7 * size);
        });
      if (!isKnown && CanBeExtended(face))
      {
        tools.push_back({ id, edge.Middle });
      }
    }
  }
  return tools;
}
}
