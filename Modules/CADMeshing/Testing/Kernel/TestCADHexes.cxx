// SPDX-License-Identifier: BSD-3-Clause
// Hexahedra of solids whose volumes are known: all valid, conforming, with their boundary on the
// part.
#include "PartFiles.h"
#include <knotwork/CADMeshing/CADHexes.h>
#include <knotwork/CADModel/CADModify.h>

#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeHalfSpace.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>
#include <gp_Pln.hxx>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

using namespace knotwork;

namespace
{
constexpr double Pi = 3.14159265358979323846;

TopoDS_Shape Together(const std::vector<TopoDS_Shape>& shapes)
{
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const TopoDS_Shape& shape : shapes)
  {
    builder.Add(compound, shape);
  }
  return compound;
}

/// The model of solids that share what they touch each other with.
CADTopology Imprinted(const std::vector<TopoDS_Shape>& shapes)
{
  EXPECT_TRUE(
    ModifyCAD(STEPFile(Together(shapes)), OutputFile("imprinted.brep"), { CADOperation() }));
  return TopologyOf(OutputFile("imprinted.brep"));
}

using Facet = std::array<int, 4>;

/// Corners of the six sides of a hexahedron, sorted.
std::vector<Facet> FacetsOf(const int* c)
{
  std::vector<Facet> facets{ { c[0], c[1], c[2], c[3] }, { c[4], c[5], c[6], c[7] },
    { c[0], c[1], c[4], c[5] }, { c[2], c[3], c[6], c[7] }, { c[0], c[2], c[4], c[6] },
    { c[1], c[3], c[5], c[7] } };
  for (Facet& facet : facets)
  {
    std::sort(facet.begin(), facet.end());
  }
  return facets;
}

/// Every side of a hexahedron belongs to two of them, or lies in a face of the part; and no two
/// points are at one place.
void ExpectConforming(const CADHexes& made, double diagonal)
{
  std::map<Facet, int> facets;
  for (int c = 0; c < made.Mesh.NumCells(); ++c)
  {
    for (const Facet& facet : FacetsOf(made.Mesh.Cell(c)))
    {
      ++facets[facet];
    }
  }
  for (const auto& [facet, count] : facets)
  {
    ASSERT_LE(count, 2);
    for (const int corner : facet)
    {
      ASSERT_TRUE(count == 2 || made.PointDimension[static_cast<std::size_t>(corner)] < 3);
    }
  }
  std::set<std::array<long, 3>> places;
  for (Eigen::Index p = 0; p < made.Points.rows(); ++p)
  {
    std::array<long, 3> place{};
    for (Eigen::Index d = 0; d < 3; ++d)
    {
      place[static_cast<std::size_t>(d)] = std::lround(made.Points(p, d) / (1e-6 * diagonal));
    }
    ASSERT_TRUE(places.insert(place).second) << "point " << p << " is there twice";
  }
}

/// Independent of the mesher: OpenCASCADE's distance from the shape.
void ExpectBoundaryOnShape(const TopoDS_Shape& shape, const CADHexes& made, double diagonal)
{
  BRep_Builder builder;
  TopoDS_Compound faces;
  builder.MakeCompound(faces);
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next())
  {
    builder.Add(faces, face.Current());
  }
  for (Eigen::Index p = 0; p < made.Points.rows(); ++p)
  {
    if (made.PointDimension[static_cast<std::size_t>(p)] < 3)
    {
      const gp_Pnt point(made.Points(p, 0), made.Points(p, 1), made.Points(p, 2));
      const BRepExtrema_DistShapeShape distance(BRepBuilderAPI_MakeVertex(point).Vertex(), faces);
      ASSERT_LE(distance.Value(), 1e-7 * diagonal);
    }
  }
}

CADHexes Mesh(const CADTopology& model, const CADHexesParams& params = {})
{
  auto made = MeshHexes(model, params);
  EXPECT_TRUE(made) << made.Status.Message();
  if (made)
  {
    EXPECT_EQ(made->Quality.Certificate.Verdict, Verdict::Valid);
    ExpectConforming(made.Value, model.Diagonal);
  }
  return std::move(made.Value);
}

struct Solid
{
  const char* Name;
  TopoDS_Shape Shape;
  double Volume;          ///< exact
  double VolumeTolerance; ///< share: chords of 30 degrees and less
  double LeastJacobian;
};

std::vector<Solid> Solids()
{
  const gp_Dir up(0, 0, 1);
  const TopoDS_Shape tube =
    BRepAlgoAPI_Cut(CylinderAt(gp_Pnt(0, 0, 0), up, 2, 5), CylinderAt(gp_Pnt(0, 0, -1), up, 1, 7))
      .Shape();
  const TopoDS_Shape angle =
    BRepAlgoAPI_Cut(BoxAt(gp_Pnt(0, 0, 0), 3, 3, 1), BoxAt(gp_Pnt(1, 1, -1), 3, 3, 3)).Shape();
  // half of a ball on a cylinder: its end is one face with a pole and a seam
  const TopoDS_Shape dome = BRepAlgoAPI_Common(
    CylinderAt(gp_Pnt(0, 0, 0), up, 1, 9), BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 0), 3).Shape())
                              .Shape();
  const double cap = 3.0 - std::sqrt(8.0); // of the ball above the cylinder's rim
  return { { "cylinder", CylinderAt(gp_Pnt(0, 0, 0), up, 1, 3), 3 * Pi, 0.05, 0.4 },
    { "tube", tube, 15 * Pi, 0.05, 0.5 },
    { "plate", PlateWithHoles(), 60 - 6 * 0.36 * Pi, 0.01, 0.4 }, { "angle", angle, 5, 1e-9, 0.4 },
    { "cone", BRepPrimAPI_MakeCone(2, 1, 3).Shape(), 7 * Pi, 0.05, 0.3 },
    { "half torus", BRepPrimAPI_MakeTorus(3, 1, Pi).Shape(), 3 * Pi * Pi, 0.08, 0.3 },
    { "dome", dome, Pi * std::sqrt(8.0) + Pi * cap * cap * (9.0 - cap) / 3, 0.06, 0.3 } };
}
}

TEST(CADHexes, ABoxIsAGrid)
{
  const CADTopology model = TopologyOf(STEPFile(BoxAt(gp_Pnt(0, 0, 0), 1, 2, 3)));
  CADHexesParams params;
  params.Faces.EdgeLength = 0.5;
  const CADHexes made = Mesh(model, params);
  EXPECT_EQ(made.Mesh.NumCells(), 2 * 4 * 6);
  EXPECT_EQ(made.Mesh.NumPoints, 3 * 5 * 7);
  EXPECT_NEAR(made.Quality.Volume, 6.0, 1e-12);
  EXPECT_NEAR(made.Quality.LeastScaledJacobian, 1.0, 1e-9);
  std::array<int, 4> counts{};
  for (const int dimension : made.PointDimension)
  {
    ++counts[static_cast<std::size_t>(dimension)];
  }
  EXPECT_EQ(counts[0], 8);
  EXPECT_EQ(counts[1], 4 * (1 + 3 + 5));
  EXPECT_EQ(counts[3], 1 * 3 * 5);
}

TEST(CADHexes, SolidsAreValidWithTheirVolume)
{
  for (const Solid& solid : Solids())
  {
    SCOPED_TRACE(solid.Name);
    const CADTopology model = TopologyOf(BREPFile(solid.Shape));
    for (const double length : { 0.0, model.Diagonal / 8 })
    {
      CADHexesParams params;
      params.Faces.EdgeLength = length;
      const CADHexes made = Mesh(model, params);
      EXPECT_NEAR(made.Quality.Volume, solid.Volume, solid.Volume * solid.VolumeTolerance);
      EXPECT_GT(made.Quality.LeastScaledJacobian, solid.LeastJacobian);
      ExpectBoundaryOnShape(solid.Shape, made, model.Diagonal);
    }
  }
}

namespace
{
/// What lies below a plane of a shape.
TopoDS_Shape CutOff(const TopoDS_Shape& shape, const gp_Pnt& place, const gp_Dir& normal)
{
  const gp_Pln plane(place, normal);
  const gp_Pnt above = place.Translated(gp_Vec(normal));
  return BRepAlgoAPI_Cut(
    shape, BRepPrimAPI_MakeHalfSpace(BRepBuilderAPI_MakeFace(plane).Face(), above).Solid())
    .Shape();
}

/// With edges rounded that a rule chooses by both their ends.
template <typename Rule>
TopoDS_Shape Rounded(const TopoDS_Shape& shape, double radius, const Rule& rule)
{
  BRepFilletAPI_MakeFillet fillet(shape);
  std::set<std::size_t> known;
  for (TopExp_Explorer edge(shape, TopAbs_EDGE); edge.More(); edge.Next())
  {
    gp_Pnt lower(1e9, 1e9, 1e9);
    for (TopExp_Explorer vertex(edge.Current(), TopAbs_VERTEX); vertex.More(); vertex.Next())
    {
      const gp_Pnt point = BRep_Tool::Pnt(TopoDS::Vertex(vertex.Current()));
      lower.SetZ(std::min(lower.Z(), point.Z()));
    }
    if (rule(lower.Z()))
    {
      fillet.Add(radius, TopoDS::Edge(edge.Current()));
    }
  }
  return fillet.Shape();
}
}

/// Solids three of whose faces meet at each corner: as many grids as corners, half a side's
/// segments in every direction.
TEST(CADHexes, SolidsWithThreeFacesAtEachCornerAreGridsAtTheCorners_ExactOracle)
{
  const TopoDS_Shape cube = BoxAt(gp_Pnt(0, 0, 0), 2, 2, 2);
  const gp_Dir diagonal(1, 1, 1);
  struct Case
  {
    const char* Name;
    TopoDS_Shape Shape;
    int Corners;
    double Volume;
    double VolumeTolerance;
  };
  const std::vector<Case> cases{ { "tetrahedron", CutOff(cube, gp_Pnt(2, 0, 0), diagonal), 4,
                                   8.0 / 6, 1e-9 },
    { "cube without a corner", CutOff(cube, gp_Pnt(2, 2, 1), diagonal), 10, 8 - 1.0 / 6, 1e-9 },
    { "eighth of a ball", BRepPrimAPI_MakeSphere(1, 0, Pi / 2, Pi / 2).Shape(), 4, Pi / 6, 0.02 },
    { "quarter of a cone", BRepPrimAPI_MakeCone(2, 0, 2, Pi / 2).Shape(), 4, 2 * Pi / 3, 0.02 } };
  for (const Case& one : cases)
  {
    SCOPED_TRACE(one.Name);
    const CADTopology model = TopologyOf(BREPFile(one.Shape));
    CADHexesParams params;
    params.Faces.EdgeLength = 100.0;
    params.Faces.Curvature = 90.0;
    params.Faces.MinDivisions = 12;
    const CADHexes made = Mesh(model, params);
    EXPECT_EQ(made.Mesh.NumCells(), one.Corners * 6 * 6 * 6);
    EXPECT_NEAR(made.Quality.Volume, one.Volume, one.Volume * one.VolumeTolerance);
    EXPECT_GT(made.Quality.LeastScaledJacobian, 0.2);
    ExpectBoundaryOnShape(one.Shape, made, model.Diagonal);
    ASSERT_EQ(made.Solids.size(), 1u);
    EXPECT_TRUE(made.Solids[0].Source.empty() && made.Solids[0].Target.empty());
    EXPECT_EQ(made.Solids[0].Hexahedra, made.Mesh.NumCells());
  }
  // a face that a grid at a corner has is one for the neighbour, too
  const TopoDS_Shape below = BRepAlgoAPI_Common(BoxAt(gp_Pnt(0, 0, -1), 2, 2, 1),
    CutOff(BoxAt(gp_Pnt(0, 0, -1), 4, 4, 4), gp_Pnt(2, 0, 0), gp_Dir(1, 1, 0)))
                               .Shape();
  const CADHexes both = Mesh(Imprinted({ cases[0].Shape, below }));
  EXPECT_EQ(both.Solids.size(), 2u);
  EXPECT_NEAR(both.Quality.Volume, 8.0 / 6 + 2.0, 1e-9);
}

TEST(CADHexes, SmoothRimsGetALayer_PropertyOracle)
{
  const auto above = [](double height) { return [height](double z) { return z > height; }; };
  const TopoDS_Shape box = BoxAt(gp_Pnt(0, 0, 0), 4, 3, 1);
  const double corner = 1.0 - Pi / 4; // of a square about a circle's quarter
  struct Case
  {
    const char* Name;
    TopoDS_Shape Shape;
    double Volume;
    double Least; ///< scaled Jacobian; without a layer 0.2 and less
  };
  // a rounded cube: straight parts, quarters of cylinders, a ball
  const double round =
    1.4 * 1.4 * 1.4 + 6 * 1.4 * 1.4 * 0.3 + 3 * Pi * 0.09 * 1.4 + 4.0 / 3 * Pi * 0.027;
  const std::vector<Case> cases{
    { "box with a rounded top", Rounded(box, 0.2, above(0.9)),
      12 - 0.04 * corner * (2 * 4 + 2 * 3) + 4 * 0.008 * (5.0 / 3 - Pi / 2), 0.4 },
    { "cube, all edges rounded", Rounded(BoxAt(gp_Pnt(0, 0, 0), 2, 2, 2), 0.3, above(-1)), round,
      0.3 },
    { "cylinder with a rounded rim",
      Rounded(CylinderAt(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1), 2, 1), 0.3, above(0.9)),
      Pi * 4 - 2 * Pi * 0.09 * (corner * 2 - (5.0 / 6 - Pi / 4) * 0.3), 0.3 }
  };
  for (const Case& one : cases)
  {
    SCOPED_TRACE(one.Name);
    const CADTopology model = TopologyOf(BREPFile(one.Shape));
    const CADHexes made = Mesh(model);
    EXPECT_GT(made.PaddedHexes, 0);
    EXPECT_GT(made.Quality.LeastScaledJacobian, one.Least);
    EXPECT_NEAR(made.Quality.Volume, one.Volume, 0.01 * one.Volume);
    ExpectBoundaryOnShape(one.Shape, made, model.Diagonal);
    EXPECT_EQ(made.Solids[0].Hexahedra, made.Mesh.NumCells());
  }
  CADHexesParams stopped; // while the points of the layer move
  stopped.Faces.Progress = [](double done) { return done < 0.81; };
  EXPECT_EQ(
    MeshHexes(TopologyOf(BREPFile(cases[0].Shape)), stopped).Status.Code, ErrorCode::Aborted);
  // nothing where rims are edges
  EXPECT_EQ(
    Mesh(TopologyOf(BREPFile(CylinderAt(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1), 1, 1)))).PaddedHexes, 0);
}

TEST(CADHexes, SolidsThatShareFacesConform)
{
  const gp_Dir up(0, 0, 1);
  const TopoDS_Shape cube = BoxAt(gp_Pnt(0, 0, 0), 10, 10, 10);
  struct Assembly
  {
    const char* Name;
    std::vector<TopoDS_Shape> Shapes;
    double Volume;
    double VolumeTolerance;
  };
  const std::vector<Assembly> assemblies{ { "cylinder on a cube",
                                            { cube, CylinderAt(gp_Pnt(5, 5, 10), up, 3, 4) },
                                            1000 + 36 * Pi, 0.01 },
    { "small cube on a cube", { cube, BoxAt(gp_Pnt(3, 3, 10), 4, 4, 4) }, 1064, 1e-9 },
    { "cubes on two sides",
      { cube, BoxAt(gp_Pnt(0, 0, 10), 10, 10, 5), BoxAt(gp_Pnt(10, 0, 0), 5, 10, 10) }, 2000,
      1e-9 },
    { "cylinder through plates",
      { BRepAlgoAPI_Cut(BoxAt(gp_Pnt(0, 0, 0), 8, 8, 1), CylinderAt(gp_Pnt(4, 4, -1), up, 2, 9))
          .Shape(),
        BRepAlgoAPI_Cut(BoxAt(gp_Pnt(0, 0, 1), 8, 8, 1), CylinderAt(gp_Pnt(4, 4, -1), up, 2, 9))
          .Shape(),
        CylinderAt(gp_Pnt(4, 4, 0), up, 2, 2) },
      128, 0.01 },
    { "columns above and below",
      { cube, CylinderAt(gp_Pnt(5, 5, 10), up, 3, 4), CylinderAt(gp_Pnt(5, 5, -4), up, 3, 4) },
      1000 + 72 * Pi, 0.01 } };
  for (const Assembly& assembly : assemblies)
  {
    SCOPED_TRACE(assembly.Name);
    const CADHexes made = Mesh(Imprinted(assembly.Shapes));
    EXPECT_EQ(made.Solids.size(), assembly.Shapes.size());
    EXPECT_NEAR(made.Quality.Volume, assembly.Volume, assembly.Volume * assembly.VolumeTolerance);
    EXPECT_GT(made.Quality.LeastScaledJacobian, 0.3);
  }
}

TEST(CADHexes, WhatCannotBeSweptNamesTheFaces)
{
  const auto failure = [](const CADTopology& model)
  {
    const auto made = MeshHexes(model);
    EXPECT_EQ(made.Status.Code, ErrorCode::InvalidTopology);
    return made.Status.Detail;
  };
  const gp_Dir up(0, 0, 1);
  const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(2).Shape();
  EXPECT_NE(failure(TopologyOf(BREPFile(ball))).find("solid 0 is neither mapped nor swept"),
    std::string::npos);
  // bored along and across: what is around one bore has the other one in it
  const TopoDS_Shape crossed = BRepAlgoAPI_Cut(
    BRepAlgoAPI_Cut(BoxAt(gp_Pnt(0, 0, 0), 4, 4, 4), CylinderAt(gp_Pnt(2, 2, -1), up, 0.5, 6))
      .Shape(),
    CylinderAt(gp_Pnt(-1, 2, 2), gp_Dir(1, 0, 0), 0.5, 6))
                                 .Shape();
  const std::string detail = failure(TopologyOf(BREPFile(crossed)));
  EXPECT_NE(detail.find("what prevents it is face "), std::string::npos) << detail;
  TopExp_Explorer face(BoxAt(gp_Pnt(0, 0, 0), 1, 1, 1), TopAbs_FACE);
  EXPECT_NE(
    failure(TopologyOf(BREPFile(face.Current()))).find("body 0 is no solid"), std::string::npos);
  // other circles above than below
  const CADTopology different = Imprinted({ BoxAt(gp_Pnt(0, 0, 0), 10, 10, 10),
    CylinderAt(gp_Pnt(3, 3, 10), up, 2, 4), CylinderAt(gp_Pnt(7, 7, -4), up, 2, 4) });
  EXPECT_FALSE(failure(different).empty());
}

TEST(CADHexes, OptionsOutsideTheirRangesAreErrors)
{
  const CADTopology model = TopologyOf(BREPFile(BoxAt(gp_Pnt(0, 0, 0), 1, 2, 3)));
  const auto code = [&](const CADHexesParams& params)
  { return MeshHexes(model, params).Status.Code; };
  CADHexesParams params;
  params.MaxHexahedra = 0;
  EXPECT_EQ(code(params), ErrorCode::InvalidParameter);
  params.MaxHexahedra = 10;
  EXPECT_EQ(code(params), ErrorCode::TooLarge);
  params = {};
  params.Faces.Curvature = 0.0;
  EXPECT_EQ(code(params), ErrorCode::InvalidParameter);
  params = {};
  params.Faces.Progress = [](double) { return false; };
  EXPECT_EQ(code(params), ErrorCode::Aborted);
  EXPECT_EQ(MeshHexes(CADTopology()).Status.Code, ErrorCode::EmptyInput);
}

TEST(CADHexes, APistonIsFourSweptSolids)
{
  CADOperation crown;
  crown.Kind = CADOperationKind::CutByPlane;
  crown.Point = { 0.0, 0.0, 46.0 };
  CADOperation halves = crown;
  halves.Direction = Eigen::Vector3d::UnitX();
  const std::string file = OutputFile("piston.brep");
  ASSERT_TRUE(
    ModifyCAD(std::string(KNOTWORK_DATA_DIR) + "/Parts/piston.step", file, { crown, halves }));
  const CADTopology model = TopologyOf(file);
  for (const double length : { 0.0, 4.0, 12.0 })
  {
    CADHexesParams params;
    params.Faces.EdgeLength = length;
    const CADHexes made = Mesh(model, params);
    ASSERT_EQ(made.Solids.size(), 4u);
    int bent = 0; // halves of the skirt, swept from its outer to its inner side or back
    for (const CADSolidHexes& solid : made.Solids)
    {
      bent += model.Faces[static_cast<std::size_t>(solid.Source[0])].IsPlane ? 0 : 1;
    }
    EXPECT_EQ(bent, 2);
    EXPECT_NEAR(made.Quality.Volume, 131458.91, 0.02 * 131458.91);
    EXPECT_GT(made.Quality.LeastScaledJacobian, 0.5);
  }
}
