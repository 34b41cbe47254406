// SPDX-License-Identifier: BSD-3-Clause
#include "CADSuggest.h"

#include "EdgePlaces.h"
#include "ModelDocument.h"
#include "ShapeOperations.h"
#include <knotwork/SplineCore/DisjointSets.h>

#include <BRepGProp.hxx>
#include <GProp_GProps.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace knotwork
{
namespace
{
constexpr double Pi = 3.14159265358979323846;
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
void AddCuts(const ModelBodies& model, const std::vector<FacePlace>& faces,
  const std::vector<EdgePlace>& edges, double size, double tolerance, int most,
  CADSuggestions& found)
{
  const std::vector<CutTool> tools = CutTools(edges, faces, size);
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
    operation.Tool = tools[i].Face;
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
    cut.Point = ToVector(tools[i].Place.XYZ());
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
  const std::vector<FacePlace> faces = FacesOf(model);
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
    const double width = WidthOf(faces[f].Face);
    if (width < found.Size)
    {
      small.push_back({ CADSuggestionKind::Sliver, { static_cast<int>(f) }, width,
        ToVector(PointOn(faces[f].Face).XYZ()) });
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
