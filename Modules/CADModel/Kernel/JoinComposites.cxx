// SPDX-License-Identifier: BSD-3-Clause
#include "CADComposite.h"
#include "CADTopologyShapes.h"

#include <knotwork/SplineCore/DisjointSets.h>

#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <Standard_Failure.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>

#include <limits>

namespace knotwork
{
namespace
{
constexpr double Sag = 1e-4;  ///< of triangles, share of the composite's size
constexpr double Angle = 0.1; ///< between their normals, radians

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// A use of an edge by a face.
struct UsePlace
{
  int Face = 0;
  int Loop = 0;
  int Use = 0;
};

/// Nodes of a use's triangles along its edge, in the order of the curve's parameters.
struct UseNodes
{
  std::vector<int> Nodes;
  std::vector<double> Parameters;
};

/// The faces of one composite that become one.
class Joining
{
public:
  Joining(const CADTopology& model, const std::vector<TopologyFaceShape>& shapes,
    std::vector<int> faces, const std::vector<bool>& isInner)
    : Model(model), Shapes(shapes), Faces(std::move(faces)), IsInner(isInner)
  {
  }

  Status Run(const CADFlattening& flatten);

  CADTopologyFace Made;
  TopologyFaceShape Shape;

private:
  const CADTopologyFace& FaceOf(int member) const
  {
    return this->Model.Faces[At(this->Faces[At(member)])];
  }
  const TopologyFaceShape& ShapeOf(int member) const
  {
    return this->Shapes[At(this->Faces[At(member)])];
  }
  Status Triangulate();
  Result<UseNodes> NodesOf(int member, int loop, int use) const;
  Status Glue();
  Status Flatten(const CADFlattening& flatten);
  Status FindLoops();

  const CADTopology& Model;
  const std::vector<TopologyFaceShape>& Shapes;
  std::vector<int> Faces;
  const std::vector<bool>& IsInner; ///< of edges
  std::vector<Handle(Poly_Triangulation)> Parts;
  std::vector<int> First; ///< node of a part
  DisjointSets Same;
  std::vector<int> Points; ///< of nodes
  PointMatrix Places;
  std::shared_ptr<JoinedFaces> Joined;
};

Status Joining::Triangulate()
{
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  double size = 0.0;
  for (int member = 0; member < static_cast<int>(this->Faces.size()); ++member)
  {
    builder.Add(compound, this->ShapeOf(member).Face);
    size = std::max(size, this->ShapeOf(member).Size);
  }
  BRepTools::Clean(compound); // triangles of the file may not fit each other
  const BRepMesh_IncrementalMesh mesher(compound, Sag * size, false, Angle);
  int count = 0;
  for (int member = 0; member < static_cast<int>(this->Faces.size()); ++member)
  {
    TopLoc_Location location;
    const Handle(Poly_Triangulation) part =
      BRep_Tool::Triangulation(this->ShapeOf(member).Face, location);
    if (part.IsNull() || !part->HasUVNodes())
    {
      return { ErrorCode::LibraryError, "OpenCASCADE cannot triangulate one of them" };
    }
    this->Parts.push_back(part);
    this->First.push_back(count);
    count += part->NbNodes();
  }
  this->Same = DisjointSets(count);
  return {};
}

Result<UseNodes> Joining::NodesOf(int member, int loop, int use) const
{
  const UseShape& shape = this->ShapeOf(member).Loops[At(loop)][At(use)];
  const Handle(Poly_Triangulation)& part = this->Parts[At(member)];
  TopLoc_Location location;
  BRep_Tool::Triangulation(this->ShapeOf(member).Face, location);
  UseNodes nodes;
  double nearest = std::numeric_limits<double>::infinity();
  // a seam has two lines of nodes, and which one belongs to which use is told by their places
  for (const TopAbs_Orientation side : { TopAbs_FORWARD, TopAbs_REVERSED })
  {
    const Handle(Poly_PolygonOnTriangulation) line =
      BRep_Tool::PolygonOnTriangulation(TopoDS::Edge(shape.Edge.Oriented(side)), part, location);
    if (line.IsNull() || line->Parameters().IsNull())
    {
      return Status{ ErrorCode::LibraryError, "OpenCASCADE cannot triangulate one of them" };
    }
    const int middle = (1 + line->NbNodes()) / 2;
    const double distance = part->UVNode(line->Nodes().Value(middle))
                              .Distance(shape.Curve->Value(line->Parameters()->Value(middle)));
    if (distance >= nearest)
    {
      continue;
    }
    nearest = distance;
    nodes = {};
    for (int i = 1; i <= line->NbNodes(); ++i)
    {
      nodes.Nodes.push_back(this->First[At(member)] + line->Nodes().Value(i) - 1);
      nodes.Parameters.push_back(line->Parameters()->Value(i));
    }
  }
  return nodes;
}

/// Triangles of neighbours share the points of inner edges.
Status Joining::Glue()
{
  std::map<int, UseNodes> known; ///< of inner edges
  for (int member = 0; member < static_cast<int>(this->Faces.size()); ++member)
  {
    const auto& loops = this->FaceOf(member).Loops;
    for (int loop = 0; loop < static_cast<int>(loops.size()); ++loop)
    {
      for (int use = 0; use < static_cast<int>(loops[At(loop)].size()); ++use)
      {
        const int edge = loops[At(loop)][At(use)].Edge;
        if (edge < 0)
        {
          return { ErrorCode::InvalidTopology, "one of them has a pole" };
        }
        if (!this->IsInner[At(edge)])
        {
          continue;
        }
        const auto nodes = this->NodesOf(member, loop, use);
        if (!nodes)
        {
          return nodes.Status;
        }
        const auto [other, isFirst] = known.emplace(edge, nodes.Value);
        if (isFirst)
        {
          continue;
        }
        if (other->second.Parameters != nodes->Parameters)
        {
          return { ErrorCode::InvalidTopology, "their triangles do not fit each other" };
        }
        for (std::size_t i = 0; i < nodes->Nodes.size(); ++i)
        {
          this->Same.Unite(other->second.Nodes[i], nodes->Nodes[i]);
        }
      }
    }
  }
  return {};
}

Status Joining::Flatten(const CADFlattening& flatten)
{
  const int count = this->Same.Size();
  this->Points.assign(At(count), -1);
  int numPoints = 0;
  for (int node = 0; node < count; ++node)
  {
    const int same = this->Same.Find(node); // the smallest
    this->Points[At(node)] = same == node ? numPoints++ : this->Points[At(same)];
  }
  PointMatrix points(numPoints, 3);
  std::vector<MeshTriangle> triangles;
  std::vector<int> faces;
  std::vector<std::array<Eigen::Vector2d, 3>> parameters;
  for (int member = 0; member < static_cast<int>(this->Faces.size()); ++member)
  {
    const Handle(Poly_Triangulation)& part = this->Parts[At(member)];
    const auto place = [&](int node)
    {
      const gp_Pnt2d uv = part->UVNode(node);
      return Eigen::Vector2d(uv.X(), uv.Y());
    };
    for (int node = 1; node <= part->NbNodes(); ++node)
    {
      const Eigen::Vector2d uv = place(node);
      points.row(this->Points[At(this->First[At(member)] + node - 1)]) =
        ToEigen(this->ShapeOf(member).Adaptor->Value(uv[0], uv[1])).transpose();
    }
    for (int t = 1; t <= part->NbTriangles(); ++t)
    {
      std::array<int, 3> corners{};
      part->Triangle(t).Get(corners[0], corners[1], corners[2]);
      if (this->FaceOf(member).Reversed)
      {
        std::swap(corners[1], corners[2]);
      }
      MeshTriangle triangle{};
      std::array<Eigen::Vector2d, 3> ofTriangle;
      for (std::size_t i = 0; i < 3; ++i)
      {
        triangle[i] = this->Points[At(this->First[At(member)] + corners[i] - 1)];
        ofTriangle[i] = place(corners[i]);
      }
      triangles.push_back(triangle);
      faces.push_back(member);
      parameters.push_back(ofTriangle);
    }
  }
  auto flat = flatten(points, triangles);
  if (!flat)
  {
    return flat.Status;
  }
  this->Places = std::move(flat.Value);
  const auto area = [&](const MeshTriangle& triangle)
  {
    const Eigen::RowVector2d a =
      this->Places.row(triangle[1]).head<2>() - this->Places.row(triangle[0]).head<2>();
    const Eigen::RowVector2d b =
      this->Places.row(triangle[2]).head<2>() - this->Places.row(triangle[0]).head<2>();
    return a[0] * b[1] - a[1] * b[0];
  };
  double sum = 0.0;
  for (const MeshTriangle& triangle : triangles)
  {
    sum += area(triangle);
  }
  if (sum < 0.0)
  {
    this->Places.col(0) *= -1.0;
  }
  for (const MeshTriangle& triangle : triangles)
  {
    if (!(area(triangle) > 0.0))
    {
      return { ErrorCode::InvalidTopology, "they do not lie in the plane without folds" };
    }
  }
  this->Joined = std::make_shared<JoinedFaces>(JoinedFaces{
    { this->Places, std::move(triangles), std::move(faces), std::move(parameters) }, {}, {}, {} });
  return {};
}

/// The outline runs with the composite to its left: edges of members whose normals are turned run
/// the other way.
Status Joining::FindLoops()
{
  struct Way
  {
    CADTopologyUse Use;
    OutlineUse Outline;
    int End = 0; ///< point
  };
  std::map<int, Way> ways; ///< by the point where they begin
  for (int member = 0; member < static_cast<int>(this->Faces.size()); ++member)
  {
    const CADTopologyFace& face = this->FaceOf(member);
    for (int loop = 0; loop < static_cast<int>(face.Loops.size()); ++loop)
    {
      const auto& uses = face.Loops[At(loop)];
      for (int use = 0; use < static_cast<int>(uses.size()); ++use)
      {
        if (this->IsInner[At(uses[At(use)].Edge)])
        {
          continue;
        }
        auto nodes = this->NodesOf(member, loop, use);
        if (!nodes)
        {
          return nodes.Status;
        }
        const UseShape& shape = this->ShapeOf(member).Loops[At(loop)][At(use)];
        Way way;
        way.Use = uses[At(use)];
        bool backward = shape.Backward;
        if (face.Reversed)
        {
          backward = !backward;
          way.Use.Reversed = !way.Use.Reversed;
          way.Use.Vertex = uses[(At(use) + 1) % uses.size()].Vertex;
        }
        const MeasuredCurve& curve = *shape.Measure;
        for (const double parameter : nodes->Parameters)
        {
          way.Outline.Shares.push_back(
            GCPnts_AbscissaPoint::Length(curve.Curve, curve.First, parameter) / curve.Length);
        }
        way.Outline.Shares.front() = 0.0;
        way.Outline.Shares.back() = 1.0;
        if (backward)
        {
          std::reverse(nodes->Nodes.begin(), nodes->Nodes.end());
          std::reverse(way.Outline.Shares.begin(), way.Outline.Shares.end());
          for (double& share : way.Outline.Shares)
          {
            share = 1.0 - share;
          }
        }
        for (const int node : nodes->Nodes)
        {
          way.Outline.Places.emplace_back(
            this->Places.row(this->Points[At(node)]).head<2>().transpose());
        }
        way.End = this->Points[At(nodes->Nodes.back())];
        if (!ways.emplace(this->Points[At(nodes->Nodes.front())], std::move(way)).second)
        {
          return { ErrorCode::InvalidTopology, "their outline touches itself" };
        }
      }
    }
  }
  struct Loop
  {
    std::vector<CADTopologyUse> Uses;
    std::vector<OutlineUse> Outlines;
    double Area = 0.0;
  };
  std::vector<Loop> loops;
  while (!ways.empty())
  {
    Loop loop;
    const int begin = ways.begin()->first;
    int at = begin;
    do
    {
      const auto next = ways.find(at);
      if (next == ways.end())
      {
        return { ErrorCode::InvalidTopology, "their outline is not closed" };
      }
      at = next->second.End;
      const auto& places = next->second.Outline.Places;
      for (std::size_t i = 1; i < places.size(); ++i)
      {
        loop.Area += places[i - 1][0] * places[i][1] - places[i - 1][1] * places[i][0];
      }
      loop.Uses.push_back(next->second.Use);
      loop.Outlines.push_back(std::move(next->second.Outline));
      ways.erase(next);
    } while (at != begin);
    loops.push_back(std::move(loop));
  }
  std::stable_sort(loops.begin(), loops.end(),
    [](const Loop& a, const Loop& b) { return std::abs(a.Area) > std::abs(b.Area); });
  for (Loop& loop : loops)
  {
    this->Made.Loops.push_back(std::move(loop.Uses));
    this->Joined->Loops.push_back(std::move(loop.Outlines));
  }
  return {};
}

Status Joining::Run(const CADFlattening& flatten)
{
  for (Status (Joining::*step)() : { &Joining::Triangulate, &Joining::Glue })
  {
    if (Status status = (this->*step)(); !status)
    {
      return status;
    }
  }
  if (Status status = this->Flatten(flatten); !status)
  {
    return status;
  }
  const CADTopologyFace& first = this->FaceOf(0);
  this->Made.Ids = first.Ids;
  this->Made.Bodies = first.Bodies;
  this->Made.Name = first.Name;
  if (Status status = this->FindLoops(); !status)
  {
    return status;
  }
  for (int member = 0; member < static_cast<int>(this->Faces.size()); ++member)
  {
    this->Made.Joined.push_back(this->FaceOf(member).Ids.front());
    this->Joined->Faces.push_back(this->ShapeOf(member));
    this->Joined->Reversed.push_back(this->FaceOf(member).Reversed);
    this->Shape.Size = std::max(this->Shape.Size, this->ShapeOf(member).Size);
  }
  this->Shape.Joined = this->Joined;
  return {};
}

/// Edges between two faces of one composite, and of no other face.
std::vector<bool> InnerEdges(const CADTopology& model, const std::vector<int>& composites)
{
  std::vector<std::vector<UsePlace>> uses(model.Edges.size());
  for (int f = 0; f < static_cast<int>(model.Faces.size()); ++f)
  {
    const auto& loops = model.Faces[At(f)].Loops;
    for (int l = 0; l < static_cast<int>(loops.size()); ++l)
    {
      for (int u = 0; u < static_cast<int>(loops[At(l)].size()); ++u)
      {
        if (loops[At(l)][At(u)].Edge >= 0)
        {
          uses[At(loops[At(l)][At(u)].Edge)].push_back({ f, l, u });
        }
      }
    }
  }
  std::vector<bool> isInner;
  for (const auto& ofEdge : uses)
  {
    const auto faceOf = [&](int i) -> const CADTopologyFace&
    { return model.Faces[At(ofEdge[At(i)].Face)]; };
    const auto turned = [&](int i)
    {
      const UsePlace& place = ofEdge[At(i)];
      return faceOf(i).Loops[At(place.Loop)][At(place.Use)].Reversed != faceOf(i).Reversed;
    };
    isInner.push_back(ofEdge.size() == 2 && ofEdge[0].Face != ofEdge[1].Face &&
      composites[At(ofEdge[0].Face)] >= 0 &&
      composites[At(ofEdge[0].Face)] == composites[At(ofEdge[1].Face)] &&
      faceOf(0).Bodies == faceOf(1).Bodies && turned(0) != turned(1));
  }
  return isInner;
}
}

std::vector<std::string> CADTopology::JoinComposites(const CADFlattening& flatten)
{
  std::vector<std::string> names;
  for (const CADTopologyFace& face : this->Faces)
  {
    names.push_back(face.Name);
  }
  const std::vector<int> composites = CompositeIds(names);
  const std::vector<bool> isInner = InnerEdges(*this, composites);
  DisjointSets sets(static_cast<int>(this->Faces.size()));
  std::vector<int> faceOfEdge(this->Edges.size(), -1);
  for (int f = 0; f < sets.Size(); ++f)
  {
    for (const auto& loop : this->Faces[At(f)].Loops)
    {
      for (const CADTopologyUse& use : loop)
      {
        if (use.Edge >= 0 && isInner[At(use.Edge)])
        {
          int& other = faceOfEdge[At(use.Edge)];
          if (other >= 0)
          {
            sets.Unite(other, f);
          }
          other = f;
        }
      }
    }
  }
  std::map<int, std::vector<int>> parts; ///< by their first faces
  std::map<int, int> partsOfComposites;
  for (int f = 0; f < sets.Size(); ++f)
  {
    parts[sets.Find(f)].push_back(f);
    partsOfComposites[composites[At(f)]] += sets.Find(f) == f ? 1 : 0;
  }

  std::vector<std::string> messages;
  const auto say = [&](int face, const std::string& what)
  {
    messages.push_back("composite " + ParseCompositeName(names[At(face)]).Group + " (face " +
      std::to_string(this->Faces[At(face)].Ids.front()) + " and others) " + what);
  };
  std::vector<CADTopologyFace> faces;
  std::vector<TopologyFaceShape> shapes;
  std::vector<int> images(this->Faces.size(), -1);
  for (const auto& [first, part] : parts)
  {
    if (composites[At(first)] >= 0 && partsOfComposites[composites[At(first)]] > 1)
    {
      say(first,
        "is several faces: it borders other faces within, or its faces do not hang together");
      partsOfComposites[composites[At(first)]] = 0; // said once
    }
    Joining joining(*this, this->Impl->Faces, part, isInner);
    Status joined{ ErrorCode::InvalidTopology, "" };
    if (part.size() > 1)
    {
      try
      {
        joined = joining.Run(flatten);
      }
      catch (const Standard_Failure& failure)
      {
        joined = { ErrorCode::LibraryError,
          std::string("OpenCASCADE: ") + failure.GetMessageString() };
      }
      if (!joined)
      {
        say(first, "stays in its faces: " + joined.Detail);
      }
    }
    for (const int f : part)
    {
      if (!joined || f == first)
      {
        faces.push_back(joined ? std::move(joining.Made) : this->Faces[At(f)]);
        shapes.push_back(joined ? std::move(joining.Shape) : this->Impl->Faces[At(f)]);
      }
      images[At(f)] = static_cast<int>(faces.size()) - 1;
    }
  }
  this->Faces = std::move(faces);
  this->Impl->Faces = std::move(shapes);

  // what no loop has any more goes
  std::vector<int> edges(this->Edges.size(), -1);
  std::vector<int> vertices(this->Vertices.size(), -1);
  for (const CADTopologyFace& face : this->Faces)
  {
    for (const auto& loop : face.Loops)
    {
      for (const CADTopologyUse& use : loop)
      {
        vertices[At(use.Vertex)] = 0;
        if (use.Edge >= 0)
        {
          edges[At(use.Edge)] = 0;
        }
      }
    }
  }
  const auto compact = [](std::vector<int>& kept, auto& values)
  {
    int count = 0;
    for (std::size_t i = 0; i < kept.size(); ++i)
    {
      if (kept[i] >= 0)
      {
        kept[i] = count++;
        values[At(kept[i])] = values[i];
      }
    }
    values.resize(At(count));
  };
  std::vector<int> edgesOfShapes = edges;
  compact(edges, this->Edges);
  compact(edgesOfShapes, this->Impl->Edges);
  compact(vertices, this->Vertices);
  for (CADTopologyEdge& edge : this->Edges)
  {
    edge.Vertices = { vertices[At(edge.Vertices[0])], vertices[At(edge.Vertices[1])] };
  }
  for (CADTopologyFace& face : this->Faces)
  {
    for (auto& loop : face.Loops)
    {
      for (CADTopologyUse& use : loop)
      {
        use.Vertex = vertices[At(use.Vertex)];
        use.Edge = use.Edge < 0 ? -1 : edges[At(use.Edge)];
      }
    }
  }
  for (CADTopologyBody& body : this->Bodies)
  {
    std::vector<CADTopologySide> sides;
    std::vector<bool> seen(this->Faces.size(), false);
    for (const CADTopologySide& side : body.Sides)
    {
      const int image = images[At(side.Face)];
      if (!seen[At(image)])
      {
        seen[At(image)] = true;
        sides.push_back({ image, side.Reversed });
      }
    }
    body.Sides = std::move(sides);
  }
  return messages;
}
}
