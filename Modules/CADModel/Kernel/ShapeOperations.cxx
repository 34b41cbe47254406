// SPDX-License-Identifier: BSD-3-Clause
#include "ShapeOperations.h"

#include "CADGeometry.h"
#include "ShapeComposite.h"
#include "ShapeHealing.h"

#include <knotwork/SplineCore/ClampedSpline.h>
#include <knotwork/SplineCore/DisjointSets.h>

#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_BuilderAlgo.hxx>
#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Section.hxx>
#include <BRepAlgoAPI_Splitter.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRepOffsetAPI_NormalProjection.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Geom_Surface.hxx>
#include <Precision.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <gp_Ax3.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Pln.hxx>

#include <cmath>
#include <map>

namespace knotwork
{
namespace
{
constexpr double Pi = 3.14159265358979323846;

struct Ball
{
  gp_Pnt Centre;
  double Radius = 0.0; ///< 0: nothing
};

Ball BallAround(const ModelBodies& model)
{
  Bnd_Box box;
  for (const ModelBody& body : model.Bodies)
  {
    if (IsSolid(body))
    {
      BRepBndLib::Add(body.Shape, box, false);
    }
  }
  if (box.IsVoid())
  {
    return {};
  }
  const gp_Pnt low = box.CornerMin();
  const gp_Pnt high = box.CornerMax();
  return { gp_Pnt(0.5 * (low.XYZ() + high.XYZ())), 0.5 * low.Distance(high) };
}

gp_Pnt ToPoint(const Eigen::Vector3d& p)
{
  return { p.x(), p.y(), p.z() };
}

std::string InText(const Eigen::Vector3d& p)
{
  std::string text = "(";
  for (int i = 0; i < 3; ++i)
  {
    std::string number(32, '\0');
    number.resize(
      static_cast<std::size_t>(std::snprintf(number.data(), number.size(), "%g", p(i))));
    text += (i > 0 ? ", " : "") + number;
  }
  return text + ")";
}

/// A plane's face that leaves the ball.
TopoDS_Face Extended(const gp_Pln& plane, const Ball& ball)
{
  const gp_Ax3& frame = plane.Position();
  const gp_Vec way(frame.Location(), ball.Centre);
  const gp_Vec normal(frame.Direction());
  gp_Ax3 centred = frame;
  centred.SetLocation(ball.Centre.Translated(-way.Dot(normal) * normal));
  const double half = 1.5 * ball.Radius;
  return BRepBuilderAPI_MakeFace(gp_Pln(centred), -half, half, -half, half).Face();
}

TopoDS_Face Extended(const gp_Cylinder& cylinder, const Ball& ball)
{
  const gp_Vec way(cylinder.Location(), ball.Centre);
  const double at = way.Dot(gp_Vec(cylinder.Position().Direction()));
  const double half = 1.5 * ball.Radius;
  return BRepBuilderAPI_MakeFace(cylinder, 0.0, 2.0 * Pi, at - half, at + half).Face();
}

Status CheckFrame(const CADOperation& operation)
{
  if (!operation.Point.allFinite() || !operation.Direction.allFinite())
  {
    return { ErrorCode::NonFiniteInput, "point and direction must be finite numbers" };
  }
  const double length = operation.Direction.stableNorm();
  if (!(length > 0.0) || !std::isfinite(length))
  {
    return { ErrorCode::InvalidParameter,
      "the direction has the length 0 or one that is no number; give three numbers such as 0 0 1" };
  }
  return {};
}

/// The plane or cylinder of an operation, through the ball.
Result<TopoDS_Face> ToolFace(const CADOperation& operation, const Ball& ball)
{
  if (Status status = CheckFrame(operation); !status)
  {
    return status;
  }
  const bool isCylinder = operation.Kind == CADOperationKind::CutByCylinder;
  if (isCylinder && !(operation.Radius > 0.0 && std::isfinite(operation.Radius)))
  {
    return { ErrorCode::InvalidParameter, "the radius of a cylinder must be a number above 0" };
  }
  const Eigen::Vector3d unit = operation.Direction.stableNormalized();
  const Eigen::Vector3d centre(ball.Centre.X(), ball.Centre.Y(), ball.Centre.Z());
  const Eigen::Vector3d way = centre - operation.Point;
  const double along = way.dot(unit);
  const double beside = (way - along * unit).stableNorm();
  const double distance = isCylinder ? std::abs(beside - operation.Radius) : std::abs(along);
  if (!(distance < ball.Radius))
  {
    return { ErrorCode::OutsideDomain,
      std::string(isCylinder ? "the cylinder around " : "the plane through ") +
        InText(operation.Point) + " misses the solids, which lie around " + InText(centre) +
        " within " + std::to_string(ball.Radius) + "; move it there" };
  }
  const gp_Dir direction(unit.x(), unit.y(), unit.z());
  // at the foot of the centre: what is far off costs digits
  const gp_Pnt foot =
    ToPoint(isCylinder ? (operation.Point + along * unit).eval() : operation.Point);
  const gp_Ax3 frame(foot, direction);
  return isCylinder ? Extended(gp_Cylinder(frame, operation.Radius), ball)
                    : Extended(gp_Pln(frame), ball);
}

Result<TopoDS_Face> ToolOfFace(int id, const std::vector<FacePlace>& faces, const Ball& ball)
{
  if (Status status = CheckId(id, faces); !status)
  {
    return status;
  }
  const BRepAdaptor_Surface surface(faces[static_cast<std::size_t>(id)].Face);
  switch (surface.GetType())
  {
    case GeomAbs_Plane:
      return Extended(surface.Plane(), ball);
    case GeomAbs_Cylinder:
      return Extended(surface.Cylinder(), ball);
    case GeomAbs_Sphere:
      return BRepBuilderAPI_MakeFace(surface.Sphere()).Face();
    case GeomAbs_Torus:
      return BRepBuilderAPI_MakeFace(surface.Torus()).Face();
    default:
      return { ErrorCode::InvalidParameter,
        "face " + std::to_string(id) +
          " cannot be extended: it is no plane, cylinder, sphere or torus; cut by a plane or a "
          "cylinder beside it" };
  }
}

/// Solids that share edges or vertices are one group: they are cut together and stay conforming.
/// Others do not see each other.
std::vector<std::vector<std::size_t>> GroupsOf(const ModelBodies& model)
{
  DisjointSets sets(static_cast<int>(model.Bodies.size()));
  NCollection_DataMap<TopoDS_Shape, int, TopTools_ShapeMapHasher> first;
  for (std::size_t b = 0; b < model.Bodies.size(); ++b)
  {
    if (!IsSolid(model.Bodies[b]))
    {
      continue;
    }
    TopTools_IndexedMapOfShape vertices;
    TopExp::MapShapes(model.Bodies[b].Shape, TopAbs_VERTEX, vertices);
    for (int i = 1; i <= vertices.Extent(); ++i)
    {
      if (const int* other = first.Seek(vertices(i)))
      {
        sets.Unite(*other, static_cast<int>(b));
      }
      else
      {
        first.Bind(vertices(i), static_cast<int>(b));
      }
    }
  }
  std::map<int, std::vector<std::size_t>> groups;
  for (std::size_t b = 0; b < model.Bodies.size(); ++b)
  {
    if (IsSolid(model.Bodies[b]))
    {
      groups[sets.Find(static_cast<int>(b))].push_back(b);
    }
  }
  std::vector<std::vector<std::size_t>> result;
  for (auto& group : groups)
  {
    result.push_back(std::move(group.second));
  }
  return result;
}

/// Runs general fuse or splitter on a group of bodies.
Status Fuse(const ModelBodies& model, const std::vector<std::size_t>& group,
  const std::vector<TopoDS_Shape>& tools, Images& images)
{
  TopTools_ListOfShape arguments;
  for (std::size_t b : group)
  {
    arguments.Append(model.Bodies[b].Shape);
  }
  BRepAlgoAPI_BuilderAlgo fuse;
  BRepAlgoAPI_Splitter splitter;
  BRepAlgoAPI_BuilderAlgo& algorithm = tools.empty() ? fuse : splitter;
  algorithm.SetArguments(arguments);
  algorithm.SetNonDestructive(true);
  algorithm.SetRunParallel(false);
  if (!tools.empty())
  {
    TopTools_ListOfShape list;
    for (const TopoDS_Shape& tool : tools)
    {
      list.Append(tool);
    }
    splitter.SetTools(list);
  }
  algorithm.Build();
  if (!algorithm.IsDone() || algorithm.HasErrors())
  {
    return {
      ErrorCode::InvalidTopology,
      "OpenCASCADE cannot intersect the solids; look for edges that nearly touch and move the cut"
    };
  }
  TopTools_MapOfShape taken;
  for (std::size_t b : group)
  {
    const TopoDS_Shape& old = model.Bodies[b].Shape;
    std::vector<TopoDS_Shape>& pieces = images.OfBody[b];
    const auto take = [&](const TopoDS_Shape& piece)
    {
      if (taken.Add(piece))
      {
        pieces.push_back(piece);
      }
      else
      {
        images.Overlap += VolumeOf(piece);
      }
    };
    const TopTools_ListOfShape& modified = algorithm.Modified(old);
    if (modified.IsEmpty())
    {
      take(old);
    }
    for (const TopoDS_Shape& piece : modified)
    {
      take(piece);
    }
    for (TopExp_Explorer face(old, TopAbs_FACE); face.More(); face.Next())
    {
      std::vector<TopoDS_Shape> parts;
      for (const TopoDS_Shape& part : algorithm.Modified(face.Current()))
      {
        parts.push_back(part);
      }
      if (!parts.empty())
      {
        images.OfFace.Bind(face.Current(), parts);
      }
    }
  }
  return {};
}

/// Where a plane meets a face.
TopoDS_Shape LinesOfPlane(const TopoDS_Face& face, const TopoDS_Face& plane)
{
  BRepAlgoAPI_Section section(face, plane, false);
  section.Build();
  return section.Shape();
}

/// The iso-line of an operation, within the face.
TopoDS_Shape LinesOfParameter(const TopoDS_Face& face, const CADOperation& operation)
{
  double range[2][2];
  BRepTools::UVBounds(face, range[0][0], range[0][1], range[1][0], range[1][1]);
  const int d = operation.IsoDirection;
  const double at = range[d][0] + operation.Share * (range[d][1] - range[d][0]);
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
  const TopoDS_Edge edge = BRepBuilderAPI_MakeEdge(
    d == 0 ? surface->UIso(at) : surface->VIso(at), range[1 - d][0], range[1 - d][1]);
  return BRepAlgoAPI_Common(edge, face).Shape();
}

/// A curve between the knots where it may have corners.
std::vector<Handle(Geom_BSplineCurve)> SmoothPieces(const Handle(Geom_BSplineCurve) & curve)
{
  std::vector<Handle(Geom_BSplineCurve)> pieces;
  int first = curve->FirstUKnotIndex();
  const int end = curve->LastUKnotIndex();
  for (int k = first + 1; k <= end; ++k)
  {
    if (k == end || curve->Multiplicity(k) >= curve->Degree())
    {
      const Handle(Geom_BSplineCurve) piece = Handle(Geom_BSplineCurve)::DownCast(curve->Copy());
      piece->Segment(curve->Knot(first), curve->Knot(k));
      pieces.push_back(piece);
      first = k;
    }
  }
  return pieces;
}

/// A curve with clamped knots in space.
Result<Spline<1>> ReadyCurve(const Spline<1>& curve)
{
  if (!curve.Space || curve.Space->Kind != SpaceKind::Tensor)
  {
    return { ErrorCode::InvalidParameter, "it is no B-spline; give B-splines or polylines" };
  }
  if (Status status = curve.Check(); !status)
  {
    return status;
  }
  if (curve.ControlPoints.cols() != 3)
  {
    return { ErrorCode::DimensionMismatch, "its control points must have three coordinates" };
  }
  const Status status = CheckContinuity(curve, "its knots");
  return status ? Clamped(curve) : Result<Spline<1>>(status);
}

/// Curves as smooth edges, in the unit of the model.
Result<TopoDS_Shape> EdgesOf(const std::vector<Spline<1>>& curves, double scale)
{
  std::vector<TopoDS_Shape> edges;
  for (const Spline<1>& curve : curves)
  {
    auto ready = ReadyCurve(curve);
    if (!ready)
    {
      return { ready.Status.Code, "a curve: " + ready.Status.Detail };
    }
    ready->ControlPoints *= scale;
    for (const Handle(Geom_BSplineCurve) & piece : SmoothPieces(ToOpenCASCADE(ready.Value)))
    {
      const bool isLine = piece->Degree() == 1;
      if (isLine && piece->StartPoint().IsEqual(piece->EndPoint(), Precision::Confusion()))
      {
        continue; // points that are there twice
      }
      edges.push_back(isLine ? BRepBuilderAPI_MakeEdge(piece->StartPoint(), piece->EndPoint())
                             : BRepBuilderAPI_MakeEdge(piece));
    }
  }
  return TopoDS_Shape(Together(edges));
}

/// Normal projections of curves, within the face.
TopoDS_Shape LinesOfCurves(const TopoDS_Face& face, const TopoDS_Shape& curves)
{
  std::vector<TopoDS_Shape> lines;
  for (TopExp_Explorer curve(curves, TopAbs_EDGE); curve.More(); curve.Next())
  {
    BRepOffsetAPI_NormalProjection projection(face);
    projection.Add(curve.Current());
    projection.SetParams(1e-6, 1e-6, GeomAbs_C1, 14, 64);
    projection.Build();
    if (projection.IsDone() && !projection.Projection().IsNull())
    {
      lines.push_back(projection.Projection());
    }
  }
  return Together(lines);
}

/// Curves on chosen faces.
Result<std::vector<TopoDS_Shape>> CurvesOn(const CADOperation& operation, double scale,
  const std::vector<FacePlace>& faces, const Ball& ball)
{
  if (operation.Faces.empty())
  {
    return { ErrorCode::EmptyInput, "no face is chosen; give the ids of those to split" };
  }
  const bool isPlane = operation.Kind == CADOperationKind::SplitByPlane;
  const bool isCurve = operation.Kind == CADOperationKind::SplitByCurve;
  TopoDS_Shape tool;
  if (isPlane)
  {
    const auto made = ToolFace(operation, ball);
    if (!made)
    {
      return made.Status;
    }
    tool = made.Value;
  }
  else if (isCurve)
  {
    if (operation.Curves.empty())
    {
      return { ErrorCode::EmptyInput, "there is no curve to split by; give one or more" };
    }
    const auto made = EdgesOf(operation.Curves, scale);
    if (!made)
    {
      return made.Status;
    }
    tool = made.Value;
  }
  else if ((operation.IsoDirection != 0 && operation.IsoDirection != 1) ||
    !(operation.Share > 0.0 && operation.Share < 1.0))
  {
    return { ErrorCode::InvalidParameter,
      "the direction of an iso-line must be 0 or 1 and its share lie between 0 and 1" };
  }
  std::vector<TopoDS_Shape> curves;
  for (int id : operation.Faces)
  {
    if (Status status = CheckId(id, faces); !status)
    {
      return status;
    }
    const TopoDS_Face& face = faces[static_cast<std::size_t>(id)].Face;
    const TopoDS_Shape lines = isPlane ? LinesOfPlane(face, TopoDS::Face(tool))
      : isCurve                        ? LinesOfCurves(face, tool)
                                       : LinesOfParameter(face, operation);
    bool found = false;
    for (TopExp_Explorer edge(lines, TopAbs_EDGE); edge.More(); edge.Next())
    {
      curves.push_back(edge.Current());
      found = true;
    }
    if (!found)
    {
      return { ErrorCode::OutsideDomain,
        "the " +
          std::string(isPlane ? "plane"
              : isCurve       ? "curve"
                              : "iso-line") +
          " does not cross face " + std::to_string(id) + "; move it or choose another face" };
    }
  }
  return curves;
}
}

CADCounts CountBodies(const ModelBodies& model)
{
  CADCounts counts;
  const TopoDS_Compound all = Together(model);
  const auto count = [&all](TopAbs_ShapeEnum kind)
  {
    TopTools_IndexedMapOfShape shapes;
    TopExp::MapShapes(all, kind, shapes);
    int number = 0;
    for (int i = 1; i <= shapes.Extent(); ++i)
    {
      number += kind == TopAbs_EDGE && BRep_Tool::Degenerated(TopoDS::Edge(shapes(i))) ? 0 : 1;
    }
    return number;
  };
  counts.Solids = count(TopAbs_SOLID);
  counts.Faces = count(TopAbs_FACE);
  counts.Edges = count(TopAbs_EDGE);
  counts.Vertices = count(TopAbs_VERTEX);
  counts.FaceIds = static_cast<int>(FacesOf(model).size());
  for (const ModelBody& body : model.Bodies)
  {
    counts.Volume += IsSolid(body) ? VolumeOf(body.Shape) : 0.0;
  }
  return counts;
}

Status CheckBodies(const ModelBodies& model)
{
  for (std::size_t b = 0; b < model.Bodies.size(); ++b)
  {
    if (!BRepCheck_Analyzer(model.Bodies[b].Shape).IsValid())
    {
      return { ErrorCode::InvalidTopology,
        "body " + std::to_string(b) + " is not valid for OpenCASCADE" };
    }
  }
  return {};
}

namespace
{
/// What OpenCASCADE calls valid can be written and worked on; else what is left says why not.
Status CheckHealed(const ModelBodies& model, const CADStep& step)
{
  const Status valid = CheckBodies(model);
  if (valid)
  {
    return valid;
  }
  std::string text = valid.Detail + " after healing";
  for (const std::string& one : step.Healing.Unmended)
  {
    text += "; " + one;
  }
  return { valid.Code, text + "; try another tolerance" };
}

Status RunScaled(const CADOperation& operation, double scale, ModelBodies& model, CADStep& step)
{
  step = {};
  step.Kind = operation.Kind;
  step.Before = CountBodies(model);
  if (operation.Kind == CADOperationKind::Heal)
  {
    if (!(operation.Tolerance > 0.0 && std::isfinite(operation.Tolerance)))
    {
      return { ErrorCode::InvalidParameter,
        "the tolerance of healing must be a number above 0; give the width of gaps to close" };
    }
    Heal(operation.Tolerance, scale, model, step);
    step.After = CountBodies(model);
    return CheckHealed(model, step);
  }
  if (step.Before.Solids == 0)
  {
    return { ErrorCode::EmptyInput,
      "there is no solid; heal the part, so that its faces become solids" };
  }
  if (operation.Kind == CADOperationKind::Composite)
  {
    if (Status status = Compose(operation.Faces, model, step); !status)
    {
      return status;
    }
    step.After = CountBodies(model);
    return CheckBodies(model);
  }
  const Ball ball = BallAround(model);
  const std::vector<FacePlace> faces = FacesOf(model);
  Images images(model);
  std::vector<TopoDS_Shape> tools;
  std::vector<std::vector<std::size_t>> groups;
  switch (operation.Kind)
  {
    case CADOperationKind::Imprint:
      groups.emplace_back();
      for (std::size_t b = 0; b < model.Bodies.size(); ++b)
      {
        if (IsSolid(model.Bodies[b]))
        {
          groups[0].push_back(b);
        }
      }
      if (groups[0].size() < 2)
      {
        return { ErrorCode::InvalidParameter,
          "there is one solid, which has no neighbour; imprint needs two or more" };
      }
      break;
    case CADOperationKind::CutByPlane:
    case CADOperationKind::CutByCylinder:
    case CADOperationKind::CutByFace:
    {
      const auto tool = operation.Kind == CADOperationKind::CutByFace
        ? ToolOfFace(operation.Tool, faces, ball)
        : ToolFace(operation, ball);
      if (!tool)
      {
        return tool.Status;
      }
      tools.push_back(tool.Value);
      groups = GroupsOf(model);
      break;
    }
    case CADOperationKind::Heal: // done
    case CADOperationKind::Composite:
      break;
    case CADOperationKind::SplitByPlane:
    case CADOperationKind::SplitByParameter:
    case CADOperationKind::SplitByCurve:
    {
      const auto curves = CurvesOn(operation, scale, faces, ball);
      if (!curves)
      {
        return curves.Status;
      }
      tools = curves.Value;
      groups = GroupsOf(model);
      break;
    }
  }
  for (const std::vector<std::size_t>& group : groups)
  {
    if (Status status = Fuse(model, group, tools, images); !status)
    {
      return status;
    }
  }
  step.Overlap = images.Overlap;
  Replace(images, model, step);
  step.After = CountBodies(model);
  const bool isCut = operation.Kind == CADOperationKind::CutByPlane ||
    operation.Kind == CADOperationKind::CutByFace ||
    operation.Kind == CADOperationKind::CutByCylinder;
  if (isCut && step.After.Solids == step.Before.Solids)
  {
    return { ErrorCode::OutsideDomain,
      "the cut divides no solid; move it so that it leaves pieces on both sides" };
  }
  if (operation.Kind != CADOperationKind::Imprint && step.After.FaceIds == step.Before.FaceIds)
  {
    return { ErrorCode::OutsideDomain,
      "no face is divided: the curve ends inside of the face or runs along its edges; move it" };
  }
  return CheckBodies(model);
}
}

Status RunOperation(const CADOperation& operation, double scale, ModelBodies& model, CADStep& step)
{
  CADOperation scaled = operation;
  scaled.Point *= scale;
  scaled.Radius *= scale;
  scaled.Tolerance *= scale;
  const Status status = RunScaled(scaled, scale, model, step);
  const double kept = step.Before.Volume - step.Overlap;
  step.VolumeChange = kept != 0.0 ? std::abs(step.After.Volume / kept - 1.0) : 0.0;
  const double cube = 1.0 / (scale * scale * scale);
  for (double* volume : { &step.Before.Volume, &step.After.Volume, &step.Overlap })
  {
    *volume *= cube;
  }
  return status;
}
}
