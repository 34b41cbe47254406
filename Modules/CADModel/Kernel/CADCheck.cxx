// SPDX-License-Identifier: BSD-3-Clause
#include "CADExchange.h"
#include "CADFile.h"
#include "CADSession.h"
#include <knotwork/SplineCore/DisjointSets.h>

#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepCheck.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepCheck_ListOfStatus.hxx>
#include <BRepGProp.hxx>
#include <BRepTools.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <IGESControl_Reader.hxx>
#include <STEPControl_Reader.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>

#include <algorithm>
#include <sstream>

namespace knotwork
{
namespace
{
constexpr std::size_t MaxDefects = 10;
constexpr double QuadratureTolerance = 1e-7; ///< relative
/// Of shapes with a face of so many spans, whose quadrature takes long. OpenCASCADE's fixed
/// quadrature, the one without a tolerance, is quicker and up to a third wrong where such a face is
/// trimmed.
constexpr int ManySpans = 100;
constexpr double CoarseQuadratureTolerance = 1e-2;

const char* InWords(BRepCheck_Status status)
{
  switch (status)
  {
    case BRepCheck_InvalidPointOnCurve:
      return "vertex off its curve";
    case BRepCheck_InvalidPointOnCurveOnSurface:
      return "vertex off its pcurve";
    case BRepCheck_InvalidPointOnSurface:
      return "vertex off its surface";
    case BRepCheck_No3DCurve:
      return "no curve in space";
    case BRepCheck_Multiple3DCurve:
      return "several curves in space";
    case BRepCheck_Invalid3DCurve:
      return "invalid curve in space";
    case BRepCheck_NoCurveOnSurface:
      return "no pcurve";
    case BRepCheck_InvalidCurveOnSurface:
      return "pcurve off its curve";
    case BRepCheck_InvalidCurveOnClosedSurface:
      return "pcurve off its curve on a closed surface";
    case BRepCheck_InvalidSameRangeFlag:
      return "curve and pcurve of different ranges";
    case BRepCheck_InvalidSameParameterFlag:
      return "curve and pcurve of different parameters";
    case BRepCheck_InvalidDegeneratedFlag:
      return "invalid mark of degeneration";
    case BRepCheck_FreeEdge:
      return "free edge";
    case BRepCheck_InvalidMultiConnexity:
      return "edge of more than two faces";
    case BRepCheck_InvalidRange:
      return "invalid range of parameters";
    case BRepCheck_EmptyWire:
      return "empty wire";
    case BRepCheck_RedundantEdge:
      return "redundant edge";
    case BRepCheck_SelfIntersectingWire:
      return "wire that intersects itself";
    case BRepCheck_NoSurface:
      return "no surface";
    case BRepCheck_InvalidWire:
      return "invalid wire";
    case BRepCheck_RedundantWire:
      return "redundant wire";
    case BRepCheck_IntersectingWires:
      return "wires that intersect";
    case BRepCheck_InvalidImbricationOfWires:
      return "wrongly nested wires";
    case BRepCheck_EmptyShell:
      return "empty shell";
    case BRepCheck_RedundantFace:
      return "redundant face";
    case BRepCheck_UnorientableShape:
      return "faces that cannot agree on an orientation";
    case BRepCheck_NotClosed:
      return "not closed";
    case BRepCheck_NotConnected:
      return "not connected";
    case BRepCheck_BadOrientation:
    case BRepCheck_BadOrientationOfSubshape:
      return "wrong orientation";
    case BRepCheck_InvalidToleranceValue:
      return "tolerance out of range";
    case BRepCheck_InvalidPolygonOnTriangulation:
      return "polygon off its triangulation";
    case BRepCheck_EnclosedRegion:
      return "enclosed region";
    default:
      return "other defect";
  }
}

const char* NameOfKind(TopAbs_ShapeEnum kind)
{
  constexpr const char* Names[] = { "compound", "compound of solids", "solid", "shell", "face",
    "wire", "edge", "vertex", "shape" };
  return Names[kind];
}

/// All places and kinds of defects, kind of shape by kind.
std::vector<std::string> FindDefects(const TopoDS_Shape& shape, const BRepCheck_Analyzer& analyzer)
{
  std::vector<std::string> defects;
  for (int k = TopAbs_VERTEX; k >= TopAbs_COMPOUND; --k)
  {
    const auto kind = static_cast<TopAbs_ShapeEnum>(k);
    TopTools_IndexedMapOfShape shapes;
    TopExp::MapShapes(shape, kind, shapes);
    for (int i = 1; i <= shapes.Extent() && defects.size() < MaxDefects; ++i)
    {
      const Handle(BRepCheck_Result) result = analyzer.Result(shapes(i));
      if (result.IsNull())
      {
        continue;
      }
      const auto add = [&](const BRepCheck_ListOfStatus& list, const std::string& where)
      {
        for (const BRepCheck_Status status : list)
        {
          if (status != BRepCheck_NoError && defects.size() < MaxDefects)
          {
            defects.push_back(std::string(NameOfKind(kind)) + " " + std::to_string(i) + where +
              ": " + InWords(status));
          }
        }
      };
      add(result->Status(), "");
      for (result->InitContextIterator(); result->MoreShapeInContext();
           result->NextShapeInContext())
      {
        add(result->StatusOnShape(),
          std::string(" in a ") + NameOfKind(result->ContextualShape().ShapeType()));
      }
    }
  }
  return defects;
}

int CountShapes(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind)
{
  TopTools_IndexedMapOfShape shapes;
  TopExp::MapShapes(shape, kind, shapes);
  return shapes.Extent();
}

/// Edges of a single face, joined at vertices.
void CountFreeLoops(const TopoDS_Shape& shape, CADSummary& summary)
{
  TopTools_IndexedDataMapOfShapeListOfShape facesOfEdge;
  TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, facesOfEdge);
  TopTools_IndexedMapOfShape vertices;
  TopExp::MapShapes(shape, TopAbs_VERTEX, vertices);
  DisjointSets loops(vertices.Extent() + 1);
  std::vector<int> ends;
  for (int i = 1; i <= facesOfEdge.Extent(); ++i)
  {
    const TopoDS_Edge& edge = TopoDS::Edge(facesOfEdge.FindKey(i));
    // a seam is in the list once a use
    if (BRep_Tool::Degenerated(edge) || facesOfEdge(i).Extent() != 1 ||
      BRep_Tool::IsClosed(edge, TopoDS::Face(facesOfEdge(i).First())))
    {
      continue;
    }
    TopoDS_Vertex first;
    TopoDS_Vertex last;
    TopExp::Vertices(edge, first, last);
    if (!first.IsNull() && !last.IsNull())
    {
      loops.Unite(vertices.FindIndex(first), vertices.FindIndex(last));
      ends.push_back(vertices.FindIndex(first));
    }
  }
  std::transform(
    ends.begin(), ends.end(), ends.begin(), [&](int vertex) { return loops.Find(vertex); });
  std::sort(ends.begin(), ends.end());
  summary.NumFreeLoops = static_cast<int>(std::unique(ends.begin(), ends.end()) - ends.begin());
  summary.Closed = summary.NumFreeLoops == 0;
}

/// Whether the adaptive quadrature would take long.
bool HasLargeFace(const TopoDS_Shape& shape)
{
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next())
  {
    const auto surface =
      Handle(Geom_BSplineSurface)::DownCast(BRep_Tool::Surface(TopoDS::Face(face.Current())));
    if (!surface.IsNull() && (surface->NbUKnots() - 1) * (surface->NbVKnots() - 1) >= ManySpans)
    {
      return true;
    }
  }
  return false;
}

double QuadratureToleranceOf(const TopoDS_Shape& shape)
{
  return HasLargeFace(shape) ? CoarseQuadratureTolerance : QuadratureTolerance;
}

/// The same shape with splines in the place of extrusions: OpenCASCADE's quadrature of these does
/// not know their spans, and is a thousandth off whatever the tolerance.
TopoDS_Shape WithoutExtrusions(const TopoDS_Shape& shape)
{
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next())
  {
    if (!Handle(Geom_SurfaceOfLinearExtrusion)::DownCast(
          BRep_Tool::Surface(TopoDS::Face(face.Current())))
           .IsNull())
    {
      return BRepBuilderAPI_NurbsConvert(shape, true).Shape();
    }
  }
  return shape;
}

double AreaOf(const TopoDS_Shape& face)
{
  GProp_GProps content;
  BRepGProp::SurfaceProperties(WithoutExtrusions(face), content, QuadratureToleranceOf(face));
  return content.Mass();
}

double VolumeOf(const TopoDS_Shape& solid)
{
  GProp_GProps content;
  BRepGProp::VolumeProperties(WithoutExtrusions(solid), content, QuadratureToleranceOf(solid));
  return content.Mass();
}

CADSummary Summarize(const TopoDS_Shape& shape, bool volume)
{
  CADSummary summary;
  const BRepCheck_Analyzer analyzer(shape);
  summary.Valid = analyzer.IsValid();
  if (!summary.Valid)
  {
    summary.Defects = FindDefects(shape, analyzer);
  }
  summary.NumSolids = CountShapes(shape, TopAbs_SOLID);
  summary.NumShells = CountShapes(shape, TopAbs_SHELL);
  summary.NumFaces = CountShapes(shape, TopAbs_FACE);
  summary.NumWires = CountShapes(shape, TopAbs_WIRE);
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  for (int i = 1; i <= edges.Extent(); ++i)
  {
    const TopoDS_Edge& edge = TopoDS::Edge(edges(i));
    summary.NumEdges += BRep_Tool::Degenerated(edge) ? 0 : 1;
    summary.MaxEdgeTolerance = std::max(summary.MaxEdgeTolerance, BRep_Tool::Tolerance(edge));
  }
  TopTools_IndexedMapOfShape vertices;
  TopExp::MapShapes(shape, TopAbs_VERTEX, vertices);
  summary.NumVertices = vertices.Extent();
  for (int i = 1; i <= vertices.Extent(); ++i)
  {
    summary.MaxVertexTolerance =
      std::max(summary.MaxVertexTolerance, BRep_Tool::Tolerance(TopoDS::Vertex(vertices(i))));
  }
  CountFreeLoops(shape, summary);
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next())
  {
    summary.FaceAreas.push_back(AreaOf(face.Current()));
    summary.Area += summary.FaceAreas.back();
  }
  for (TopExp_Explorer solid(shape, TopAbs_SOLID); volume && solid.More(); solid.Next())
  {
    summary.Volume += VolumeOf(solid.Current());
  }
  Bnd_Box box;
  BRepBndLib::Add(shape, box, false);
  if (!box.IsVoid())
  {
    const gp_Pnt lower = box.CornerMin();
    const gp_Pnt upper = box.CornerMax();
    summary.BoxLower = { lower.X(), lower.Y(), lower.Z() };
    summary.BoxUpper = { upper.X(), upper.Y(), upper.Z() };
  }
  return summary;
}
}

std::vector<std::string> DefectsOf(const TopoDS_Shape& shape)
{
  const BRepCheck_Analyzer analyzer(shape);
  return analyzer.IsValid() ? std::vector<std::string>() : FindDefects(shape, analyzer);
}

Status CheckSTEPText(const std::string& text, CADSummary& summary)
{
  std::istringstream stream(text);
  STEPControl_Reader reader;
  if (reader.ReadStream("Knotwork", stream) != IFSelect_RetDone)
  {
    return { ErrorCode::InvalidFormat, "OpenCASCADE does not read what it wrote" };
  }
  reader.TransferRoots();
  if (reader.NbShapes() > 0)
  {
    summary = Summarize(reader.OneShape(), false);
  }
  return {};
}

namespace
{
/// Area of a face by its surface at the points of a raster that lie in it.
double AreaOnRaster(const TopoDS_Face& face)
{
  constexpr double nearness = 1e-9; ///< of the classifier, of the parameters' size
  constexpr int enough = 20000;     ///< points in the face: its boundary is less than 0.3 % then
  double u[2];
  double v[2];
  BRepTools::UVBounds(face, u[0], u[1], v[0], v[1]);
  BRepTopAdaptor_FClass2d classifier(face, nearness * std::max(u[1] - u[0], v[1] - v[0]));
  const BRepAdaptor_Surface surface(face, false);
  double area = 0.0;
  int numInside = 0;
  for (int n = 256; n <= 1024 && numInside < enough; n *= 2)
  {
    area = 0.0;
    numInside = 0;
    const double du = (u[1] - u[0]) / n;
    const double dv = (v[1] - v[0]) / n;
    for (int i = 0; i < n * n; ++i)
    {
      const gp_Pnt2d at(u[0] + (i % n + 0.5) * du, v[0] + (i / n + 0.5) * dv);
      if (classifier.Perform(at) != TopAbs_IN)
      {
        continue;
      }
      gp_Pnt point;
      gp_Vec first[2];
      surface.D1(at.X(), at.Y(), point, first[0], first[1]);
      area += first[0].Crossed(first[1]).Magnitude() * du * dv;
      ++numInside;
    }
  }
  return area;
}

/// Areas of faces, measured again.
void MeasureAgain(
  const TopoDS_Shape& shape, const std::vector<std::size_t>& faces, CADSummary& summary)
{
  std::size_t number = 0;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next(), ++number)
  {
    if (std::find(faces.begin(), faces.end(), number) != faces.end())
    {
      const double area = AreaOnRaster(TopoDS::Face(face.Current()));
      summary.Area += area - summary.FaceAreas[number];
      summary.FaceAreas[number] = area;
    }
  }
}

/// @param use  Status of the shape that OpenCASCADE reads with its default settings.
template <typename Use>
Status ReadShape(const std::string& file, LengthUnit unit, const Use& use)
{
  const std::string place = "'" + file + "'";
  const CADFormat format = FormatOfFile(file);
  CADSession session(unit);
  session.SetDefaultsOfReading();
  return session.Run(place,
    [&]() -> Status
    {
      if (format == CADFormat::BREP)
      {
        TopoDS_Shape shape;
        const Status loaded = LoadBREP(file, unit, shape);
        return loaded ? use(shape) : loaded;
      }
      STEPControl_Reader step;
      IGESControl_Reader iges;
      XSControl_Reader& reader =
        format == CADFormat::IGES ? static_cast<XSControl_Reader&>(iges) : step;
      int numMended = 0;
      if (Status loaded = LoadCAD(reader, format, file, numMended); !loaded)
      {
        return loaded;
      }
      reader.TransferRoots();
      if (reader.NbShapes() == 0)
      {
        return { ErrorCode::EmptyInput, place + ": there is no shape in it" };
      }
      return use(reader.OneShape());
    });
}
}

Result<CADSummary> CheckCAD(const std::string& file, LengthUnit unit, bool volume)
{
  CADSummary summary;
  const Status status = ReadShape(file, unit,
    [&](const TopoDS_Shape& shape)
    {
      summary = Summarize(shape, volume);
      return Status();
    });
  return status ? Result<CADSummary>(summary) : Result<CADSummary>(status);
}

Result<CADSummary> CheckWrittenCAD(const TrimmedModel& model, const std::string& file)
{
  CADSummary summary;
  const Status status = ReadShape(file, LengthUnit::Millimetre,
    [&](const TopoDS_Shape& shape)
    {
      summary = Summarize(shape, false);
      std::vector<std::size_t> others;
      Status compared = CompareCAD(model, summary, &others);
      if (!others.empty())
      {
        MeasureAgain(shape, others, summary);
        compared = CompareCAD(model, summary);
      }
      return compared;
    });
  return status ? Result<CADSummary>(summary) : Result<CADSummary>(status);
}
}
