// SPDX-License-Identifier: BSD-3-Clause
#include "ShapeHealing.h"

#include "CADFile.h"
#include <knotwork/SplineCore/DisjointSets.h>

#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <Message_ListOfMsg.hxx>
#include <Message_Msg.hxx>
#include <Precision.hxx>
#include <ShapeAnalysis_Wire.hxx>
#include <ShapeBuild_ReShape.hxx>
#include <ShapeExtend_DataMapOfShapeListOfMsg.hxx>
#include <ShapeExtend_MsgRegistrator.hxx>
#include <ShapeFix_FixSmallFace.hxx>
#include <ShapeFix_Shape.hxx>
#include <ShapeFix_Solid.hxx>
#include <ShapeFix_Wireframe.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>

#include <algorithm>
#include <map>
#include <sstream>

namespace knotwork
{
namespace
{
/// Defects of a shape that are counted before and after.
struct EdgeDefects
{
  std::vector<TopoDS_Edge> Free;  ///< of one face; seams and poles are none
  std::vector<TopoDS_Edge> Small; ///< shorter than the tolerance
  int Multiple = 0;               ///< of more than two faces
};

EdgeDefects FindEdges(const TopoDS_Shape& shape, double tolerance)
{
  EdgeDefects found;
  TopTools_IndexedDataMapOfShapeListOfShape faces; // a seam's face stands there twice
  TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces);
  for (int i = 1; i <= faces.Extent(); ++i)
  {
    const TopoDS_Edge& edge = TopoDS::Edge(faces.FindKey(i));
    if (BRep_Tool::Degenerated(edge) || faces(i).IsEmpty())
    {
      continue;
    }
    if (faces(i).Extent() == 1)
    {
      found.Free.push_back(edge);
    }
    found.Multiple += faces(i).Extent() > 2 ? 1 : 0;
    const BRepAdaptor_Curve curve(edge);
    if (GCPnts_AbscissaPoint::Length(curve) < tolerance)
    {
      found.Small.push_back(edge);
    }
  }
  return found;
}

/// Joints of loops whose curves lie further apart than a length.
int CountGaps(const TopoDS_Shape& shape, double length)
{
  int gaps = 0;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next())
  {
    for (TopExp_Explorer loop(face.Current(), TopAbs_WIRE); loop.More(); loop.Next())
    {
      ShapeAnalysis_Wire wire(TopoDS::Wire(loop.Current()), TopoDS::Face(face.Current()), length);
      for (int i = 1; wire.IsLoaded() && i <= wire.NbEdges(); ++i)
      {
        wire.CheckGap3d(i);
        gaps += wire.MinDistance3d() > length ? 1 : 0;
      }
    }
  }
  return gaps;
}

gp_Pnt MiddleOf(const TopoDS_Edge& edge)
{
  const BRepAdaptor_Curve curve(edge);
  return curve.Value(0.5 * (curve.FirstParameter() + curve.LastParameter()));
}

std::string At(const gp_Pnt& point, double unit)
{
  std::ostringstream text;
  text << "at (" << point.X() / unit << ", " << point.Y() / unit << ", " << point.Z() / unit << ")";
  return text.str();
}

std::string Counted(std::size_t number, const char* what)
{
  return std::to_string(number) + " " + what + (number == 1 ? "" : "s");
}

/// What is left in a body, one sentence each.
/// @param free  of all bodies.
void AddUnmended(const TopoDS_Shape& shape, std::size_t body, const std::vector<TopoDS_Edge>& free,
  double tolerance, double unit, std::vector<std::string>& list)
{
  const std::string place = "body " + std::to_string(body) + ": ";
  for (const std::string& defect : DefectsOf(shape))
  {
    list.push_back(place + defect);
  }
  const EdgeDefects edges = FindEdges(shape, tolerance);
  if (!edges.Free.empty())
  {
    const TopoDS_Edge& first = edges.Free.front();
    std::vector<TopoDS_Shape> others;
    for (const TopoDS_Edge& edge : free)
    {
      if (!edge.IsSame(first))
      {
        others.push_back(edge);
      }
    }
    std::ostringstream text;
    text << place << Counted(edges.Free.size(), "edge") << " of one face only, the first "
         << At(MiddleOf(first), unit);
    if (!others.empty()) // measured from the middle: the ends touch their neighbours
    {
      const TopoDS_Shape middle = BRepBuilderAPI_MakeVertex(MiddleOf(first)).Shape();
      const BRepExtrema_DistShapeShape distance(middle, Together(others));
      text << ", " << distance.Value() / unit << " from the next such edge";
    }
    list.push_back(text.str());
  }
  if (edges.Multiple > 0)
  {
    list.push_back(place + Counted(static_cast<std::size_t>(edges.Multiple), "edge") +
      " of more than two faces");
  }
  if (!edges.Small.empty())
  {
    list.push_back(place + Counted(edges.Small.size(), "edge") +
      " shorter than the tolerance, the first " + At(MiddleOf(edges.Small.front()), unit));
  }
}

/// Faces of a shape and what they became, through all steps.
class Traces
{
public:
  explicit Traces(const std::vector<FacePlace>& faces) : Now(faces.size())
  {
    for (std::size_t f = 0; f < faces.size(); ++f)
    {
      this->Now[f].push_back(faces[f].Face);
    }
  }

  /// @param of  null shape: the face is gone; a face; or a compound of faces.
  template <typename Image>
  void Follow(const Image& of)
  {
    for (std::vector<TopoDS_Shape>& images : this->Now)
    {
      std::vector<TopoDS_Shape> next;
      for (const TopoDS_Shape& image : images)
      {
        const TopoDS_Shape made = of(image);
        if (made.IsNull())
        {
          continue;
        }
        for (TopExp_Explorer face(made, TopAbs_FACE); face.More(); face.Next())
        {
          next.push_back(face.Current());
        }
      }
      images = next;
    }
  }

  std::vector<std::vector<TopoDS_Shape>> Now;
};

/// Joins the faces of bodies that have free edges: a solid's by itself, all others together.
/// @param joined  result: bodies that were sewn together.
/// @return a shape a body; that of the first of those holds all of them, and the others nothing.
std::vector<TopoDS_Shape> Sew(
  double tolerance, const ModelBodies& model, Traces& traces, std::vector<std::size_t>& joined)
{
  std::vector<TopoDS_Shape> shapes;
  std::vector<std::vector<std::size_t>> groups(1);
  for (std::size_t b = 0; b < model.Bodies.size(); ++b)
  {
    shapes.push_back(model.Bodies[b].Shape);
    if (FindEdges(model.Bodies[b].Shape, 0.0).Free.empty())
    {
      continue;
    }
    if (IsSolid(model.Bodies[b]))
    {
      groups.push_back({ b });
    }
    else
    {
      groups.front().push_back(b);
    }
  }
  for (const std::vector<std::size_t>& group : groups)
  {
    BRepBuilderAPI_Sewing sewing(tolerance);
    for (std::size_t b : group)
    {
      for (TopExp_Explorer face(model.Bodies[b].Shape, TopAbs_FACE); face.More(); face.Next())
      {
        sewing.Add(face.Current());
      }
    }
    sewing.Perform();
    if (group.empty() || sewing.SewedShape().IsNull())
    {
      continue;
    }
    for (std::size_t b : group)
    {
      shapes[b] = Together(std::vector<TopoDS_Shape>());
    }
    shapes[group.front()] = sewing.SewedShape();
    traces.Follow([&sewing](const TopoDS_Shape& face)
      { return sewing.IsModified(face) ? sewing.Modified(face) : face; });
  }
  joined = groups.front();
  return shapes;
}

void AddMessages(const ShapeExtend_MsgRegistrator& registrator, CADHealing& healing)
{
  for (ShapeExtend_DataMapOfShapeListOfMsg::Iterator of(registrator.MapShape()); of.More();
       of.Next())
  {
    for (const Message_Msg& message : of.Value())
    {
      TCollection_AsciiString text(Message_Msg(message).Get(), '?');
      ++healing.Messages[text.ToCString()];
    }
  }
}

/// Small edges and faces, gaps, orientation, and what else ShapeFix knows of.
TopoDS_Shape Fix(double tolerance, double fine, const TopoDS_Shape& shape,
  const Handle(ShapeBuild_ReShape) & context, CADHealing& healing)
{
  const Handle(ShapeExtend_MsgRegistrator) messages = new ShapeExtend_MsgRegistrator;
  const auto prepare = [&](const Handle(ShapeFix_Root) & fix, double precision)
  {
    fix->SetContext(context);
    fix->SetMsgRegistrator(messages);
    fix->SetPrecision(precision);
    fix->SetMaxTolerance(std::max(tolerance, precision));
  };
  const Handle(ShapeFix_Wireframe) wireframe = new ShapeFix_Wireframe(shape);
  prepare(wireframe, tolerance);
  wireframe->ModeDropSmallEdges() = true;
  wireframe->FixSmallEdges();
  wireframe->SetPrecision(fine); // wider gaps are closed, up to the tolerance
  wireframe->FixWireGaps();
  const Handle(ShapeFix_FixSmallFace) small = new ShapeFix_FixSmallFace;
  prepare(small, tolerance);
  small->Init(context->Apply(shape));
  small->Perform();
  small->FixShape();
  const Handle(ShapeFix_Shape) all = new ShapeFix_Shape(context->Apply(shape));
  prepare(all, fine);
  all->Perform();
  AddMessages(*messages, healing);
  return context->Apply(shape);
}

/// Solids, and shells and faces outside of them; shells that are closed become solids.
std::vector<TopoDS_Shape> PiecesOf(const TopoDS_Shape& shape, int& numNewSolids)
{
  std::vector<TopoDS_Shape> pieces;
  for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next())
  {
    pieces.push_back(solid.Current());
  }
  for (TopExp_Explorer shell(shape, TopAbs_SHELL, TopAbs_SOLID); shell.More(); shell.Next())
  {
    if (FindEdges(shell.Current(), 0.0).Free.empty())
    {
      ShapeFix_Solid fix;
      pieces.push_back(fix.SolidFromShell(TopoDS::Shell(shell.Current())));
      ++numNewSolids;
      continue;
    }
    pieces.push_back(shell.Current());
  }
  for (TopExp_Explorer face(shape, TopAbs_FACE, TopAbs_SHELL); face.More(); face.Next())
  {
    pieces.push_back(face.Current());
  }
  return pieces;
}

using OrientationOfFaces =
  NCollection_DataMap<TopoDS_Shape, TopAbs_Orientation, TopTools_ShapeMapHasher>;

/// Compares orientations before and after. Which side of an open shell is the outer one nobody
/// says: it is turned so that fewer faces change.
void CountTurned(const std::vector<FacePlace>& before,
  const std::vector<std::vector<TopoDS_Shape>>& now, std::vector<TopoDS_Shape>& pieces,
  CADHealing& healing)
{
  OrientationOfFaces old;
  for (std::size_t f = 0; f < before.size(); ++f)
  {
    for (const TopoDS_Shape& image : now[f])
    {
      old.Bind(image, before[f].Face.Orientation());
    }
  }
  for (TopoDS_Shape& piece : pieces)
  {
    int turned = 0;
    int known = 0;
    for (TopExp_Explorer face(piece, TopAbs_FACE); face.More(); face.Next())
    {
      if (const TopAbs_Orientation* was = old.Seek(face.Current()))
      {
        ++known;
        turned += face.Current().Orientation() != *was ? 1 : 0;
      }
    }
    const bool isSolid = piece.ShapeType() == TopAbs_SOLID;
    if (!isSolid && 2 * turned > known)
    {
      piece.Reverse();
      turned = known - turned;
    }
    if (isSolid && turned == known && known > 0)
    {
      ++healing.TurnedSolids;
      continue;
    }
    healing.TurnedFaces += turned;
  }
}

/// Pieces of bodies that were sewn together belong to the first of those that their faces come
/// from, others to the body that they were.
/// @param origins  bodies of the pieces, or the first of those that were sewn together.
void Distribute(const std::vector<FacePlace>& faces, const Traces& traces,
  const std::vector<std::size_t>& joined, const std::vector<TopoDS_Shape>& pieces,
  const std::vector<std::size_t>& origins, Images& images)
{
  NCollection_DataMap<TopoDS_Shape, int, TopTools_ShapeMapHasher> bodies;
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    if (std::binary_search(joined.begin(), joined.end(), faces[f].Body))
    {
      for (const TopoDS_Shape& image : traces.Now[f])
      {
        bodies.Bind(image, static_cast<int>(faces[f].Body));
      }
    }
  }
  std::vector<int> owners;
  DisjointSets sets(static_cast<int>(images.Holder.size()));
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    int owner = -1;
    const bool isJoined = std::binary_search(joined.begin(), joined.end(), origins[i]);
    for (TopExp_Explorer face(pieces[i], TopAbs_FACE); isJoined && face.More(); face.Next())
    {
      if (const int* body = bodies.Seek(face.Current()))
      {
        owner = owner < 0 ? *body : owner;
        sets.Unite(owner, *body);
      }
    }
    owners.push_back(owner < 0 ? static_cast<int>(origins[i]) : owner);
  }
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    images.OfBody[static_cast<std::size_t>(sets.Find(owners[i]))].push_back(pieces[i]);
  }
  for (std::size_t b : joined)
  {
    images.Holder[b] = static_cast<std::size_t>(sets.Find(static_cast<int>(b)));
  }
}
}

void Heal(double tolerance, double unit, ModelBodies& model, CADStep& step)
{
  CADHealing& healing = step.Healing;
  const std::vector<FacePlace> faces = FacesOf(model);
  const TopoDS_Compound before = Together(model);
  // no shorter than what OpenCASCADE takes as one place
  const double fine = std::min(Precision::Confusion(), tolerance);
  const EdgeDefects old = FindEdges(before, tolerance);
  const int oldGaps = CountGaps(before, fine);
  Images images(model);
  Traces traces(faces);
  std::vector<std::size_t> joined;
  const std::vector<TopoDS_Shape> sewn = Sew(tolerance, model, traces, joined);
  const Handle(ShapeBuild_ReShape) context = new ShapeBuild_ReShape;
  // in one compound: what bodies share they share afterwards
  Fix(tolerance, fine, Together(sewn), context, healing);
  traces.Follow([&context](const TopoDS_Shape& face) { return context->Apply(face); });
  std::vector<TopoDS_Shape> pieces;
  std::vector<std::size_t> origins; ///< a body each
  for (std::size_t b = 0; b < sewn.size(); ++b)
  {
    const TopoDS_Shape mended = context->Apply(sewn[b]);
    if (!mended.IsNull())
    {
      const auto found = PiecesOf(mended, healing.NewSolids);
      pieces.insert(pieces.end(), found.begin(), found.end());
      origins.resize(pieces.size(), b);
    }
  }
  CountTurned(faces, traces.Now, pieces, healing);
  Distribute(faces, traces, joined, pieces, origins, images);
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    images.OfFace.Bind(faces[f].Face, traces.Now[f]);
    healing.RemovedFaces += traces.Now[f].empty() ? 1 : 0;
  }
  Replace(images, model, step);
  const TopoDS_Compound after = Together(model);
  const EdgeDefects left = FindEdges(after, tolerance);
  healing.SewnEdges = static_cast<int>(old.Free.size()) - static_cast<int>(left.Free.size());
  healing.RemovedEdges = static_cast<int>(old.Small.size()) - static_cast<int>(left.Small.size());
  healing.ClosedGaps = oldGaps - CountGaps(after, fine);
  for (std::size_t b = 0; b < model.Bodies.size(); ++b)
  {
    AddUnmended(model.Bodies[b].Shape, b, left.Free, tolerance, unit, healing.Unmended);
  }
}
}
