// SPDX-License-Identifier: BSD-3-Clause
#include "CADSuggest.h"

#include "ModelDocument.h"
#include "ShapeOperations.h"
#include <knotwork/SplineCore/DisjointSets.h>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Geom2d_Curve.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Pln.hxx>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace knotwork
{
namespace
{
constexpr double Pi = 3.14159265358979323846;
constexpr int NumSamples = 5; ///< on an edge

/// Lengths here are those of the model until the end.
struct EdgePlace
{
  TopoDS_Edge Edge;
  int Faces[2] = {}; ///< ids
  double Length = 0.0;
  gp_Pnt Middle;
  double Angle = 0.0; ///< largest one between the normals
  bool IsConcave = false;
};

std::vector<TopoDS_Face> FacesOf(const ModelBodies& model)
{
  std::vector<TopoDS_Face> faces;
  for (const ModelBody& body : model.Bodies)
  {
    for (TopExp_Explorer face(body.Shape, TopAbs_FACE); face.More(); face.Next())
    {
      faces.push_back(TopoDS::Face(face.Current()));
    }
  }
  return faces;
}

Eigen::Vector3d ToVector(const gp_XYZ& p)
{
  return { p.X(), p.Y(), p.Z() };
}

double LengthOf(const TopoDS_Shape& shape)
{
  GProp_GProps properties;
  BRepGProp::LinearProperties(shape, properties);
  return properties.Mass();
}

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
void MeasureAngle(const std::vector<TopoDS_Face>& faces, double tolerance, EdgePlace& place)
{
  const TopoDS_Face& face = faces[static_cast<std::size_t>(place.Faces[0])];
  const TopoDS_Face& other = faces[static_cast<std::size_t>(place.Faces[1])];
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

/// Edges between two different faces of a body, and, if asked for, all others without an angle.
std::vector<EdgePlace> EdgesOf(
  const ModelBodies& model, const std::vector<TopoDS_Face>& faces, double tolerance, bool all)
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

struct SweepCounts
{
  int Solids = 0;
  int Swept = 0;
  int Mapped = 0;
  int ConcaveEdges = 0;
};

TopTools_IndexedMapOfShape PartsOf(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind)
{
  TopTools_IndexedMapOfShape parts;
  TopExp::MapShapes(shape, kind, parts);
  return parts;
}

/// Whether a solid is a prism by its faces, edges and vertices.
bool IsSwept(const TopoDS_Shape& solid, const TopoDS_Shape& source, const TopoDS_Shape& target)
{
  const auto a = PartsOf(source, TopAbs_VERTEX);
  const auto b = PartsOf(target, TopAbs_VERTEX);
  const auto rimA = PartsOf(source, TopAbs_EDGE);
  const auto rimB = PartsOf(target, TopAbs_EDGE);
  if (a.Extent() != b.Extent() || rimA.Extent() != rimB.Extent() ||
    PartsOf(source, TopAbs_WIRE).Extent() != PartsOf(target, TopAbs_WIRE).Extent())
  {
    return false;
  }
  const auto vertices = PartsOf(solid, TopAbs_VERTEX);
  for (int i = 1; i <= vertices.Extent(); ++i)
  {
    if (a.Contains(vertices(i)) == b.Contains(vertices(i)))
    {
      return false;
    }
  }
  const auto edges = PartsOf(solid, TopAbs_EDGE);
  for (int i = 1; i <= edges.Extent(); ++i)
  {
    if (rimA.Contains(edges(i)) || rimB.Contains(edges(i)))
    {
      continue;
    }
    TopoDS_Vertex tips[2];
    TopExp::Vertices(TopoDS::Edge(edges(i)), tips[0], tips[1]);
    if (tips[0].IsNull() || tips[1].IsNull() || a.Contains(tips[0]) == a.Contains(tips[1]))
    {
      return false;
    }
  }
  for (TopExp_Explorer face(solid, TopAbs_FACE); face.More(); face.Next())
  {
    if (face.Current().IsSame(source) || face.Current().IsSame(target))
    {
      continue;
    }
    bool touches[2] = {};
    for (TopExp_Explorer edge(face.Current(), TopAbs_EDGE); edge.More(); edge.Next())
    {
      touches[0] = touches[0] || rimA.Contains(edge.Current());
      touches[1] = touches[1] || rimB.Contains(edge.Current());
    }
    if (!touches[0] || !touches[1])
    {
      return false;
    }
  }
  return true;
}

SweepCounts CountSwept(const ModelBodies& model, double tolerance)
{
  SweepCounts counts;
  const std::vector<EdgePlace> edges = EdgesOf(model, FacesOf(model), tolerance, false);
  counts.ConcaveEdges = static_cast<int>(
    std::count_if(edges.begin(), edges.end(), [](const EdgePlace& e) { return e.IsConcave; }));
  for (const ModelBody& body : model.Bodies)
  {
    if (body.Shape.ShapeType() != TopAbs_SOLID)
    {
      continue;
    }
    ++counts.Solids;
    const auto faces = PartsOf(body.Shape, TopAbs_FACE);
    TopTools_IndexedDataMapOfShapeListOfShape around;
    TopExp::MapShapesAndAncestors(body.Shape, TopAbs_EDGE, TopAbs_FACE, around);
    // a face at an end touches all others but the one at the other end
    std::vector<int> atEnds;
    for (int f = 1; f <= faces.Extent(); ++f)
    {
      TopTools_IndexedMapOfShape neighbours;
      for (TopExp_Explorer edge(faces(f), TopAbs_EDGE); edge.More(); edge.Next())
      {
        for (const TopoDS_Shape& face : around.FindFromKey(edge.Current()))
        {
          neighbours.Add(face);
        }
      }
      if (neighbours.Extent() == faces.Extent() - 1)
      {
        atEnds.push_back(f);
      }
    }
    bool isSwept = false;
    bool isMapped = false;
    for (std::size_t i = 0; i < atEnds.size() && !isMapped; ++i)
    {
      for (std::size_t j = i + 1; j < atEnds.size() && !isMapped; ++j)
      {
        if (IsSwept(body.Shape, faces(atEnds[i]), faces(atEnds[j])))
        {
          isSwept = true;
          isMapped = faces.Extent() == 6 && PartsOf(faces(atEnds[i]), TopAbs_EDGE).Extent() == 4;
        }
      }
    }
    counts.Swept += isSwept ? 1 : 0;
    counts.Mapped += isMapped ? 1 : 0;
  }
  return counts;
}

/// Of the rectangle with the face's area and perimeter.
double WidthOf(const TopoDS_Face& face)
{
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(face, properties);
  const double area = std::abs(properties.Mass());
  const double half = 0.5 * LengthOf(face);
  const double root = half * half - 4.0 * area;
  // the smaller root without cancellation
  return root > 0.0 ? 2.0 * area / (half + std::sqrt(root)) : std::sqrt(area);
}

gp_Pnt PointOn(const TopoDS_Face& face)
{
  GProp_GProps properties;
  BRepGProp::LinearProperties(face, properties);
  return properties.CentreOfMass();
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

double SizeOf(const ModelBodies& model)
{
  Bnd_Box box;
  for (const ModelBody& body : model.Bodies)
  {
    BRepBndLib::Add(body.Shape, box, false);
  }
  return box.IsVoid() ? 0.0 : std::sqrt(box.SquareExtent());
}

void AddChains(
  const std::vector<EdgePlace>& edges, int numFaces, double tolerance, CADSuggestions& found)
{
  DisjointSets sets(numFaces);
  for (const EdgePlace& edge : edges)
  {
    if (edge.Angle <= tolerance)
    {
      sets.Unite(edge.Faces[0], edge.Faces[1]);
    }
  }
  std::map<int, CADSuggestion> chains;
  for (int id = 0; id < numFaces; ++id)
  {
    chains[sets.Find(id)].Faces.push_back(id);
  }
  for (const EdgePlace& edge : edges)
  {
    CADSuggestion& chain = chains[sets.Find(edge.Faces[0])];
    if (edge.Angle <= tolerance && edge.Angle * 180.0 / Pi >= chain.Size)
    {
      chain.Size = edge.Angle * 180.0 / Pi;
      chain.Point = ToVector(edge.Middle.XYZ());
    }
  }
  std::map<int, CADSuggestion> ordered;
  for (auto& [root, chain] : chains)
  {
    if (chain.Faces.size() > 1)
    {
      chain.Kind = CADSuggestionKind::TangentFaces;
      ordered[chain.Faces.front()] = chain;
    }
  }
  for (auto& [face, chain] : ordered)
  {
    found.List.push_back(chain);
  }
}

/// Tries extended faces at concave edges.
void AddCuts(const ModelBodies& model, const std::vector<TopoDS_Face>& faces,
  std::vector<EdgePlace> edges, double size, double tolerance, int most, CADSuggestions& found)
{
  edges.erase(std::remove_if(
                edges.begin(), edges.end(), [](const EdgePlace& edge) { return !edge.IsConcave; }),
    edges.end());
  std::stable_sort(edges.begin(), edges.end(),
    [](const EdgePlace& a, const EdgePlace& b) { return a.Length > b.Length; });
  std::vector<std::pair<int, gp_Pnt>> tools;
  for (const EdgePlace& edge : edges)
  {
    for (int id : edge.Faces)
    {
      const TopoDS_Face& face = faces[static_cast<std::size_t>(id)];
      const bool isKnown = std::any_of(tools.begin(), tools.end(),
        [&](const auto& tool)
        {
          return tool.first == id ||
            AreSame(faces[static_cast<std::size_t>(tool.first)], face, 1e-7 * size);
        });
      if (!isKnown && CanBeExtended(face))
      {
        tools.emplace_back(id, edge.Middle);
      }
    }
  }
  std::vector<CADSuggestion> cuts;
  for (std::size_t i = 0; i < tools.size(); ++i)
  {
    if (static_cast<int>(i) >= most)
    {
      found.UntriedCuts = static_cast<int>(tools.size() - i);
      break;
    }
    CADOperation operation;
    operation.Kind = CADOperationKind::CutByFace;
    operation.Tool = tools[i].first;
    ModelBodies pieces = model;
    CADStep step;
    try
    {
      if (!RunOperation(operation, 1.0, pieces, step) ||
        !(step.VolumeChange <= CADModifyParams().VolumeTolerance))
      {
        continue;
      }
    }
    catch (const Standard_Failure&)
    {
      continue; // a cut that OpenCASCADE cannot make is none
    }
    const SweepCounts counts = CountSwept(pieces, tolerance);
    CADSuggestion cut;
    cut.Kind = CADSuggestionKind::Cut;
    cut.Faces = { operation.Tool };
    cut.Point = ToVector(tools[i].second.XYZ());
    cut.Solids = counts.Solids;
    cut.Swept = counts.Swept;
    cut.Mapped = counts.Mapped;
    cut.ConcaveEdges = counts.ConcaveEdges;
    cuts.push_back(cut);
  }
  std::stable_sort(cuts.begin(), cuts.end(),
    [](const CADSuggestion& a, const CADSuggestion& b)
    {
      return std::tuple(a.Solids - a.Swept, a.ConcaveEdges, a.Solids) <
        std::tuple(b.Solids - b.Swept, b.ConcaveEdges, b.Solids);
    });
  found.List.insert(found.List.end(), cuts.begin(), cuts.end());
}

/// Lengths in the model's unit.
void Suggest(
  const ModelBodies& model, double given, const CADSuggestParams& params, CADSuggestions& found)
{
  const double tolerance = params.TangentAngle * Pi / 180.0;
  const double size = SizeOf(model);
  const std::vector<TopoDS_Face> faces = FacesOf(model);
  const std::vector<EdgePlace> edges = EdgesOf(model, faces, tolerance, true);
  const SweepCounts counts = CountSwept(model, tolerance);
  found.Counts = CountBodies(model);
  found.Size = given > 0.0 ? given : 0.01 * size;
  found.Swept = counts.Swept;
  found.Mapped = counts.Mapped;
  found.ConcaveEdges = counts.ConcaveEdges;
  std::vector<CADSuggestion> small;
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    const double width = WidthOf(faces[f]);
    if (width < found.Size)
    {
      small.push_back({ CADSuggestionKind::Sliver, { static_cast<int>(f) }, width,
        ToVector(PointOn(faces[f]).XYZ()) });
    }
  }
  for (const EdgePlace& edge : edges)
  {
    if (edge.Length < found.Size)
    {
      CADSuggestion tiny;
      tiny.Kind = CADSuggestionKind::TinyEdge;
      tiny.Faces.push_back(edge.Faces[0]);
      if (edge.Faces[1] != edge.Faces[0])
      {
        tiny.Faces.push_back(edge.Faces[1]);
      }
      tiny.Size = edge.Length;
      tiny.Point = ToVector(edge.Middle.XYZ());
      small.push_back(tiny);
    }
  }
  std::stable_sort(small.begin(), small.end(),
    [](const CADSuggestion& a, const CADSuggestion& b)
    { return std::tie(a.Kind, a.Size) < std::tie(b.Kind, b.Size); });
  found.List = std::move(small);
  AddChains(edges, static_cast<int>(faces.size()), tolerance, found);
  AddCuts(model, faces, edges, size, tolerance, params.MaxCuts, found);
}
}

Result<CADSuggestions> SuggestCADOperations(const std::string& file, const CADSuggestParams& params)
{
  const std::string place = "'" + file + "'";
  if (FormatOfFile(file) != CADFormat::STEP)
  {
    return { ErrorCode::InvalidParameter, place + ": the ending must be .step or .stp" };
  }
  if (!(params.Size >= 0.0) || !std::isfinite(params.Size) || !(params.TangentAngle > 0.0) ||
    !(params.TangentAngle <= 45.0) || params.MaxCuts < 0)
  {
    return { ErrorCode::InvalidParameter,
      place +
        ": Size and MaxCuts must be 0 or more, and TangentAngle above 0 and at most 45 degrees" };
  }
  CADSuggestions found;
  CADSession session(params.Unit);
  session.SetDefaultsOfReading();
  const Status status = session.Run(place,
    [&]() -> Status
    {
      Handle(TDocStd_Document) document;
      LengthUnit unit = LengthUnit::Millimetre;
      if (Status loaded = LoadModel(session, file, document, unit); !loaded)
      {
        return loaded;
      }
      const ModelBodies model = ModelDocument(document).Take();
      const double scale = Millimetres(params.Unit) / Millimetres(unit);
      if (Status valid = CheckBodies(model); !valid)
      {
        return { valid.Code, place + ": " + valid.Detail + "; heal it first" };
      }
      if (CountBodies(model).Solids == 0)
      {
        return { ErrorCode::EmptyInput,
          place + ": there is no solid; sew the faces to solids first" };
      }
      Suggest(model, params.Size * scale, params, found);
      found.Size /= scale;
      found.Counts.Volume /= scale * scale * scale;
      for (CADSuggestion& one : found.List)
      {
        one.Point /= scale;
        one.Size /= one.Kind == CADSuggestionKind::TangentFaces ? 1.0 : scale;
      }
      return {};
    });
  return status ? Result<CADSuggestions>(std::move(found)) : Result<CADSuggestions>(status);
}
}
