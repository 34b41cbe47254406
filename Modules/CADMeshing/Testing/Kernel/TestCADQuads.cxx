// SPDX-License-Identifier: BSD-3-Clause
// Meshes of solids: counts, Euler numbers and areas that are known, every side between two
// quadrilaterals, every point on its entity.
#include "PartFiles.h"
#include <knotwork/CADMeshing/CADQuads.h>
#include <knotwork/CADModel/CADModify.h>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepPrimAPI_MakeWedge.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Vertex.hxx>
#include <gp_Lin.hxx>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

using namespace knotwork;

namespace
{
constexpr double Pi = 3.14159265358979323846;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

CADQuads Mesh(const CADTopology& model, const CADQuadsParams& params = {})
{
  auto made = MeshQuads(model, params);
  EXPECT_TRUE(made) << made.Status.Message();
  return std::move(made.Value);
}

/// Every directed side of the quadrilaterals of a body stands there once, and once the other way.
void ExpectClosedBodies(const CADTopology& model, const CADQuads& made)
{
  for (const CADTopologyBody& body : model.Bodies)
  {
    std::map<std::pair<int, int>, int> sides;
    for (const CADTopologySide& side : body.Sides)
    {
      for (std::size_t q = 0; q < made.Mesh.Quads.size(); ++q)
      {
        for (std::size_t i = 0; made.Mesh.QuadFace[q] == side.Face && i < 4; ++i)
        {
          const int a = made.Mesh.Quads[q][i];
          const int b = made.Mesh.Quads[q][(i + 1) % 4];
          ++sides[side.Reversed ? std::make_pair(b, a) : std::make_pair(a, b)];
        }
      }
    }
    for (const auto& [side, count] : sides)
    {
      ASSERT_EQ(count, 1);
      ASSERT_EQ(sides.count({ side.second, side.first }), 1u);
    }
  }
}

/// Outward: twice the sum of these is an area, a third of their moments a volume.
double Volume(const CADQuads& made)
{
  double volume = 0.0;
  for (const auto& quad : made.Mesh.Quads)
  {
    const auto& p = made.Mesh.Points;
    for (const auto& [b, c] : { std::pair<int, int>{ quad[1], quad[2] }, { quad[2], quad[3] } })
    {
      volume += p[At(quad[0])].dot(p[At(b)].cross(p[At(c)])) / 6.0;
    }
  }
  return volume;
}

double Area(const CADQuads& made)
{
  double area = 0.0;
  for (const auto& quad : made.Mesh.Quads)
  {
    const auto& p = made.Mesh.Points;
    area += 0.5 * (p[At(quad[2])] - p[At(quad[0])]).cross(p[At(quad[3])] - p[At(quad[1])]).norm();
  }
  return area;
}

/// Independent of the mesher: OpenCASCADE's distance of all points from the shape.
void ExpectOnShape(const TopoDS_Shape& shape, const CADTopology& model, const CADQuads& made)
{
  BRep_Builder builder;
  TopoDS_Compound faces;
  builder.MakeCompound(faces);
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next())
  {
    builder.Add(faces, face.Current());
  }
  for (const Eigen::Vector3d& point : made.Mesh.Points)
  {
    const BRepExtrema_DistShapeShape distance(
      BRepBuilderAPI_MakeVertex(gp_Pnt(point.x(), point.y(), point.z())).Vertex(), faces);
    ASSERT_LE(distance.Value(), 1e-7 * model.Diagonal);
  }
}

struct Solid
{
  const char* Name;
  TopoDS_Shape Shape;
  int Euler;
  int Mapped;
  double Volume;          ///< exact
  double VolumeTolerance; ///< share: chords of 30 degrees and less lie inside
};

std::vector<Solid> Solids()
{
  TopoDS_Shape rounded = BoxAt(gp_Pnt(0, 0, 0), 2, 2, 2);
  BRepFilletAPI_MakeFillet fillet(rounded);
  for (TopExp_Explorer edge(rounded, TopAbs_EDGE); edge.More(); edge.Next())
  {
    fillet.Add(0.3, TopoDS::Edge(edge.Current()));
  }
  // straight parts, quarters of cylinders, a ball
  const double round =
    1.4 * 1.4 * 1.4 + 6 * 1.4 * 1.4 * 0.3 + 3 * Pi * 0.09 * 1.4 + 4.0 / 3 * Pi * 0.027;
  const TopoDS_Shape bored = BRepAlgoAPI_Cut(
    BRepPrimAPI_MakeSphere(2).Shape(), CylinderAt(gp_Pnt(0, -3, 0), gp_Dir(0, 1, 0), 0.5, 6))
                               .Shape();
  const double ring = 4.0 / 3 * Pi * std::pow(4 - 0.25, 1.5); // what is left of a bored ball
  return { { "cylinder", CylinderAt(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1), 1, 3), 2, 3, 3 * Pi, 0.03 },
    { "plate", PlateWithHoles(), 2 - 2 * 6, 10, 60 - 6 * 0.36 * Pi, 0.01 },
    { "sphere", BRepPrimAPI_MakeSphere(1).Shape(), 2, 0, 4.0 / 3 * Pi, 0.05 },
    { "cone", BRepPrimAPI_MakeCone(1, 0, 2).Shape(), 2, 1, 2.0 / 3 * Pi, 0.05 },
    { "torus", BRepPrimAPI_MakeTorus(3, 1).Shape(), 0, 1, 6 * Pi * Pi, 0.08 },
    { "octant", BRepPrimAPI_MakeSphere(1, 0, Pi / 2, Pi / 2).Shape(), 2, 4, Pi / 6, 0.05 },
    { "cavity",
      BRepAlgoAPI_Cut(BoxAt(gp_Pnt(0, 0, 0), 2, 2, 2), BoxAt(gp_Pnt(0.5, 0.5, 0.5), 1, 1, 1))
        .Shape(),
      4, 12, 7, 1e-9 },
    { "wedge", BRepPrimAPI_MakeWedge(2, 2, 2, 0.0).Shape(), 2, 5, 4, 1e-9 },
    { "rounded cube", fillet.Shape(), 2, 26, round, 0.02 },
    { "bored ball", bored, 0, 1, ring, 0.03 } };
}
}

TEST(CADQuads, BoxHasTheGridsThatItsEdgesAskFor)
{
  const CADTopology model = TopologyOf(STEPFile(BoxAt(gp_Pnt(0, 0, 0), 1, 2, 3)));
  CADQuadsParams params;
  params.EdgeLength = 0.5; // 2, 4 and 6 segments
  const CADQuads made = Mesh(model, params);
  EXPECT_EQ(made.Mesh.Quads.size(), 2u * (2 * 4 + 4 * 6 + 2 * 6));
  EXPECT_EQ(made.Mesh.Points.size(), made.Mesh.Quads.size() + 2);
  EXPECT_EQ(made.EulerNumber, 2);
  EXPECT_TRUE(made.Closed);
  EXPECT_EQ(made.ExtraordinaryPoints, 8);
  EXPECT_NEAR(made.LeastScaledJacobian, 1.0, 1e-9);
  EXPECT_NEAR(Area(made), 22.0, 1e-9);
  EXPECT_NEAR(Volume(made), 6.0, 1e-9);
  std::array<int, 3> counts{};
  for (const int dimension : made.Mesh.PointDimension)
  {
    ++counts[At(dimension)];
  }
  EXPECT_EQ(counts[0], 8);
  EXPECT_EQ(counts[1], 4 * (1 + 3 + 5));
  ExpectClosedBodies(model, made);
}

TEST(CADQuads, SolidsAreClosedWithTheirEulerNumberAndVolume)
{
  for (const Solid& solid : Solids())
  {
    SCOPED_TRACE(solid.Name);
    const CADTopology model = TopologyOf(BREPFile(solid.Shape));
    for (const double length : { 0.0, model.Diagonal / 8 })
    {
      CADQuadsParams params;
      params.EdgeLength = length;
      const CADQuads made = Mesh(model, params);
      EXPECT_EQ(made.EulerNumber, solid.Euler);
      EXPECT_TRUE(made.Closed);
      EXPECT_GT(made.LeastScaledJacobian, 0.1);
      int mapped = 0;
      for (const CADFaceQuads& face : made.Faces)
      {
        mapped += face.Mapped ? 1 : 0;
      }
      EXPECT_EQ(mapped, solid.Mapped);
      EXPECT_NEAR(Volume(made), solid.Volume,
        solid.Volume * (solid.VolumeTolerance < 1e-6 ? 1e-9 : 3 * solid.VolumeTolerance));
      if (length == 0.0)
      {
        EXPECT_NEAR(Volume(made), solid.Volume, solid.Volume * solid.VolumeTolerance);
        ExpectOnShape(solid.Shape, model, made);
      }
      ExpectClosedBodies(model, made);
    }
  }
}

TEST(CADQuads, UnstructuredFacesOfABoxAreGood)
{
  const CADTopology model = TopologyOf(BREPFile(BoxAt(gp_Pnt(0, 0, 0), 1, 2, 3)));
  CADQuadsParams params;
  params.Method = CADQuadMethod::Unstructured;
  const CADQuads made = Mesh(model, params);
  EXPECT_EQ(made.EulerNumber, 2);
  EXPECT_GT(made.LeastScaledJacobian, 0.5);
  EXPECT_NEAR(Area(made), 22.0, 1e-9);
  ExpectClosedBodies(model, made);
}

TEST(CADQuads, NoQuadrilateralHasTwoSidesOnASmoothRim)
{
  // a plate of which the upright edges are rounded: the rims of top and bottom are smooth all along
  const TopoDS_Shape plate = BoxAt(gp_Pnt(0, 0, 0), 12, 8, 2);
  BRepFilletAPI_MakeFillet fillet(plate);
  for (TopExp_Explorer edge(plate, TopAbs_EDGE); edge.More(); edge.Next())
  {
    const BRepAdaptor_Curve curve(TopoDS::Edge(edge.Current()));
    if (std::abs(curve.Line().Direction().Z()) > 0.5)
    {
      fillet.Add(0.6, TopoDS::Edge(edge.Current()));
    }
  }
  const CADTopology model = TopologyOf(BREPFile(fillet.Shape()));
  for (const double length : { 0.7, 0.9, 1.2, 1.7, 2.5 })
  {
    SCOPED_TRACE(length);
    CADQuadsParams params;
    params.Method = CADQuadMethod::Unstructured;
    params.EdgeLength = length;
    const CADQuads made = Mesh(model, params);
    EXPECT_GT(made.LeastScaledJacobian, 0.25);
    std::map<std::pair<int, int>, int> quadsAt; // face and point of its rim
    for (std::size_t q = 0; q < made.Mesh.Quads.size(); ++q)
    {
      const int face = made.Mesh.QuadFace[q];
      for (const int point : made.Mesh.Quads[q])
      {
        const bool isLevel = std::abs(model.FaceNormal(face, { 0.5, 0.5 })[2]) > 0.5;
        if (isLevel && model.Faces[At(face)].IsPlane && made.Mesh.PointDimension[At(point)] < 2)
        {
          ++quadsAt[{ face, point }];
        }
      }
    }
    ASSERT_GT(quadsAt.size(), 40U);
    for (const auto& [place, count] : quadsAt)
    {
      EXPECT_GE(count, 2) << "face " << place.first << ", point " << place.second;
    }
  }
}

TEST(CADQuads, ImprintedSolidsConformAndOthersDoNot)
{
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  builder.Add(compound, BoxAt(gp_Pnt(0, 0, 0), 10, 10, 10));
  builder.Add(compound, CylinderAt(gp_Pnt(5, 5, 10), gp_Dir(0, 0, 1), 3, 4));
  const std::string apart = STEPFile(compound);
  for (const char* name : { "shared.brep", "shared.step" })
  {
    ASSERT_TRUE(ModifyCAD(apart, OutputFile(name), { CADOperation() }));
    const CADTopology model = TopologyOf(OutputFile(name));
    const CADQuads made = Mesh(model);
    ExpectClosedBodies(model, made);
    // a ball of cells with an inner wall: two spheres with a disc in common
    EXPECT_EQ(made.EulerNumber, 2 + 2 - 1) << name;
    EXPECT_TRUE(made.Closed);
    EXPECT_EQ(made.Faces.size(), 9u);
    // two spheres, each with the disc
    CADQuadsParams params;
    params.SolidsApart = true;
    const auto apartSolids = MeshQuads(model, params);
    ASSERT_TRUE(apartSolids) << apartSolids.Status.Message();
    EXPECT_EQ(apartSolids->EulerNumber, 2 + 2);
    EXPECT_TRUE(apartSolids->Closed);
    const int second =
      int(std::count(apartSolids->BodyOfFace.begin(), apartSolids->BodyOfFace.end(), 1));
    EXPECT_GT(second, 0);
    EXPECT_EQ(apartSolids->Mesh.Quads.size(), made.Mesh.Quads.size() + std::size_t(second));
    std::map<std::array<int, 2>, int> sides;
    for (const auto& quad : apartSolids->Mesh.Quads)
    {
      for (std::size_t i = 0; i < 4; ++i)
      {
        ++sides[{ quad[i], quad[(i + 1) % 4] }];
      }
    }
    for (const auto& [side, count] : sides)
    {
      EXPECT_EQ(count, 1);
      EXPECT_EQ(sides.count({ side[1], side[0] }), 1u);
    }
  }
  const CADTopology model = TopologyOf(apart);
  EXPECT_EQ(Mesh(model).EulerNumber, 2 + 2);
}

TEST(CADQuads, LoopsMayTouch)
{
  // a cylinder on a box whose circle touches one edge, two edges, or another cylinder's circle
  const std::vector<std::vector<gp_Pnt>> cases{ { gp_Pnt(3, 5, 10) }, { gp_Pnt(3, 3, 10) },
    { gp_Pnt(3, 5, 10), gp_Pnt(7, 5, 10) } };
  for (const std::vector<gp_Pnt>& places : cases)
  {
    SCOPED_TRACE(places.front().Y() + static_cast<double>(places.size()));
    const double radius = places.size() == 1 ? 3.0 : 2.0;
    BRep_Builder builder;
    TopoDS_Compound compound;
    builder.MakeCompound(compound);
    builder.Add(compound, BoxAt(gp_Pnt(0, 0, 0), 10, 10, 10));
    for (const gp_Pnt& place : places)
    {
      builder.Add(compound, CylinderAt(place, gp_Dir(0, 0, 1), radius, 4));
    }
    const std::string file = OutputFile("touching.brep");
    ASSERT_TRUE(ModifyCAD(STEPFile(compound), file, { CADOperation() }));
    const CADTopology model = TopologyOf(file);
    const CADQuads made = Mesh(model);
    ExpectClosedBodies(model, made);
    EXPECT_EQ(made.EulerNumber, 2 + static_cast<int>(places.size()));
    EXPECT_TRUE(made.Closed);
    EXPECT_GT(made.LeastScaledJacobian, 0.0);
    double top = 0.0; // of the box: what is not under a cylinder
    for (std::size_t q = 0; q < made.Mesh.Quads.size(); ++q)
    {
      const auto& quad = made.Mesh.Quads[q];
      const auto at = [&](int i) { return made.Mesh.Points[At(quad[At(i)])]; };
      const Eigen::Vector3d normal = 0.5 * (at(2) - at(0)).cross(at(3) - at(1));
      top += std::abs(at(0)[2] - 10.0) < 1e-9 && std::abs(normal[2]) > 0.5 * normal.norm()
        ? std::abs(normal[2])
        : 0.0;
    }
    EXPECT_NEAR(top, 100.0, 1e-9);
  }
}

TEST(CADQuads, OneFaceIsOpen)
{
  TopExp_Explorer face(BoxAt(gp_Pnt(0, 0, 0), 1, 1, 1), TopAbs_FACE);
  const CADQuads made = Mesh(TopologyOf(BREPFile(face.Current())));
  EXPECT_FALSE(made.Closed);
  EXPECT_EQ(made.EulerNumber, 1);
  EXPECT_EQ(made.ExtraordinaryPoints, 0);
}

TEST(CADQuads, LinesOfAGridAreNotLongerThanItsSidesSay)
{
  // between two holes a ball is wider than at them
  const TopoDS_Shape shape = BRepAlgoAPI_Cut(
    BRepPrimAPI_MakeSphere(2).Shape(), CylinderAt(gp_Pnt(0, 0, -3), gp_Dir(0, 0, 1), 0.5, 6))
                               .Shape();
  const CADTopology model = TopologyOf(BREPFile(shape));
  CADQuadsParams params;
  params.EdgeLength = 0.4;
  const CADQuads made = Mesh(model, params);
  for (const auto& quad : made.Mesh.Quads)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      EXPECT_LT((made.Mesh.Points[At(quad[i])] - made.Mesh.Points[At(quad[(i + 1) % 4])]).norm(),
        1.5 * params.EdgeLength);
    }
  }
}

TEST(CADQuads, OptionsOutsideTheirRangesAreErrors)
{
  const CADTopology model = TopologyOf(BREPFile(BoxAt(gp_Pnt(0, 0, 0), 1, 2, 3)));
  const auto code = [&](const std::function<void(CADQuadsParams&)>& change)
  {
    CADQuadsParams params;
    change(params);
    const auto made = MeshQuads(model, params);
    return made.Status.Code;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code([](auto& p) { p.EdgeLength = -1; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(code([&](auto& p) { p.EdgeLength = nan; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(code([](auto& p) { p.Curvature = 0; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(code([&](auto& p) { p.Curvature = nan; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(code([](auto& p) { p.MinDivisions = 0; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(code([](auto& p) { p.MaxQuads = 0; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(code([](auto& p) { p.EdgeLength = 1e-9; }), ErrorCode::TooLarge);
  EXPECT_EQ(code([](auto& p) { p.MaxQuads = 100; }), ErrorCode::TooLarge);
  EXPECT_EQ(code([](auto& p) { p.Progress = [](double) { return false; }; }), ErrorCode::Aborted);
}

TEST(CADQuads, FaceThatIsNotMappedIsNamed)
{
  CADQuadsParams params;
  params.Method = CADQuadMethod::Mapped;
  const auto plate = MeshQuads(TopologyOf(BREPFile(PlateWithHoles())), params);
  EXPECT_EQ(plate.Status.Code, ErrorCode::InvalidTopology);
  EXPECT_NE(plate.Status.Detail.find("face 2 is not mapped"), std::string::npos)
    << plate.Status.Message();
  const CADTopology box = TopologyOf(BREPFile(BoxAt(gp_Pnt(0, 0, 0), 1, 2, 3)));
  EXPECT_TRUE(MeshQuads(box, params));
}

namespace
{
TopoDS_Shape PrismOf(int corners)
{
  BRepBuilderAPI_MakePolygon polygon;
  for (int i = 0; i < corners; ++i)
  {
    const double angle = 2.0 * Pi * i / corners;
    polygon.Add(gp_Pnt(std::cos(angle), std::sin(angle), 0));
  }
  polygon.Close();
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(polygon.Wire()).Face(), gp_Vec(0, 0, 1))
    .Shape();
}

/// What quadrilaterals at z = 0 have.
struct BottomFace
{
  int Quads = 0;
  double Area = 0.0;
  std::vector<int> Valences; ///< of points inside where other than four meet
};

BottomFace BottomOf(const CADQuads& made)
{
  BottomFace bottom;
  std::map<int, int> valences;
  for (const auto& quad : made.Mesh.Quads)
  {
    const auto at = [&](std::size_t i) { return made.Mesh.Points[At(quad[i])]; };
    if (std::abs(at(0)[2]) + std::abs(at(1)[2]) + std::abs(at(2)[2]) < 1e-9)
    {
      ++bottom.Quads;
      bottom.Area += 0.5 * (at(2) - at(0)).cross(at(3) - at(1)).norm();
      for (const int corner : quad)
      {
        ++valences[corner];
      }
    }
  }
  for (const auto& [point, valence] : valences)
  {
    if (made.Mesh.PointDimension[At(point)] == 2 && valence != 4)
    {
      bottom.Valences.push_back(valence);
    }
  }
  return bottom;
}
}

TEST(CADQuads, FacesThatAreNoRectanglesAreSeveralGrids_ExactOracle)
{
  struct Case
  {
    const char* Name;
    TopoDS_Shape Shape;
    int Divisions; ///< of every edge
    int Quads;     ///< of the face at z = 0
    std::vector<int> Valences;
    double Area;
  };
  const auto polygonArea = [](int sides, double radius)
  { return 0.5 * sides * radius * radius * std::sin(2.0 * Pi / sides); };
  const TopoDS_Shape cylinder = CylinderAt(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1), 1, 1);
  const std::vector<Case> cases{
    // at each corner a grid of half of a side's segments both ways
    { "triangle", PrismOf(3), 6, 3 * 9, { 3 }, polygonArea(3, 1) },
    { "pentagon", PrismOf(5), 8, 5 * 16, { 5 }, polygonArea(5, 1) },
    { "hexagon", PrismOf(6), 4, 6 * 4, { 6 }, polygonArea(6, 1) },
    // 4 x 4 in the middle, a row around
    { "disc", cylinder, 16, 16 + 16, { 3, 3, 3, 3 }, polygonArea(16, 1) },
    // 4 x 2 in the middle of the straight side, two rows around its other three sides
    { "half a disc", BRepAlgoAPI_Cut(cylinder, BoxAt(gp_Pnt(-2, -2, -1), 4, 2, 4)).Shape(), 8,
      8 + 2 * 8, { 3, 3 }, 0.5 * polygonArea(16, 1) },
    // as many across as edges have at least
    { "ring",
      BRepAlgoAPI_Cut(cylinder, CylinderAt(gp_Pnt(0, 0, -1), gp_Dir(0, 0, 1), 0.6, 3)).Shape(), 16,
      16 * 16, {}, polygonArea(16, 1) - polygonArea(16, 0.6) },
  };
  for (const Case& one : cases)
  {
    SCOPED_TRACE(one.Name);
    const CADTopology model = TopologyOf(BREPFile(one.Shape));
    CADQuadsParams params;
    params.Method = CADQuadMethod::Mapped;
    params.EdgeLength = 10.0;
    params.Curvature = 90.0;
    params.MinDivisions = one.Divisions;
    const CADQuads made = Mesh(model, params);
    const BottomFace bottom = BottomOf(made);
    EXPECT_EQ(bottom.Quads, one.Quads);
    EXPECT_EQ(bottom.Valences, one.Valences);
    EXPECT_NEAR(bottom.Area, one.Area, 1e-9);
    EXPECT_GT(made.LeastScaledJacobian, 0.5);
    ExpectClosedBodies(model, made);
    ExpectOnShape(one.Shape, model, made);
  }
}

TEST(CADQuads, GridsThatWouldBeTooLargeAreRefusedBeforeTheyAreMade)
{
  CADQuadsParams params;
  params.EdgeLength = 1e-4; // 240,000 segments, 2.2e9 quadrilaterals
  for (const TopoDS_Shape& shape : { BoxAt(gp_Pnt(0, 0, 0), 1, 2, 3),
         CylinderAt(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1), 1, 1), PrismOf(3),
         BRepAlgoAPI_Cut(CylinderAt(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1), 1, 1),
           CylinderAt(gp_Pnt(0, 0, -1), gp_Dir(0, 0, 1), 0.6, 3))
           .Shape() })
  {
    const auto made = MeshQuads(TopologyOf(BREPFile(shape)), params);
    EXPECT_EQ(made.Status.Code, ErrorCode::TooLarge);
    EXPECT_NE(made.Status.Detail.find("MaximumQuads"), std::string::npos) << made.Status.Message();
  }
}
