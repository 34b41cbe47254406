// SPDX-License-Identifier: BSD-3-Clause
// What a mesher is told of parts whose faces, edges and lengths are known.
#include "PartFiles.h"
#include <knotwork/CADModel/CADModify.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>

#include <Eigen/Geometry>

#include <cmath>

using namespace knotwork;

namespace
{
constexpr double Pi = 3.14159265358979323846;
constexpr double Exact = 1e-9; // of sizes near 1

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Two boxes side by side, a unit cube and one that shares its side x = 1.
TopoDS_Shape TwoBoxes()
{
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  builder.Add(compound, BoxAt(gp_Pnt(0, 0, 0), 1, 1, 1));
  builder.Add(compound, BoxAt(gp_Pnt(1, 0, 0), 2, 1, 1));
  return compound;
}
}

TEST(CADTopology, CylinderHasTwoCirclesASeamAndLoopsInItsParameters)
{
  const CADTopology model =
    TopologyOf(BREPFile(CylinderAt(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1), 2.0, 3.0)));
  ASSERT_EQ(model.Faces.size(), 3u);
  ASSERT_EQ(model.Edges.size(), 3u);
  ASSERT_EQ(model.Vertices.size(), 2u);
  ASSERT_EQ(model.Bodies.size(), 1u);
  EXPECT_TRUE(model.Bodies[0].IsSolid);
  int circles = 0;
  for (std::size_t e = 0; e < 3; ++e)
  {
    const bool closed = model.Edges[e].Vertices[0] == model.Edges[e].Vertices[1];
    circles += closed ? 1 : 0;
    EXPECT_NEAR(model.Edges[e].Length, closed ? 4.0 * Pi : 3.0, Exact);
    EXPECT_NEAR(model.Edges[e].Turning, closed ? 2.0 * Pi : 0.0, 1e-9);
  }
  EXPECT_EQ(circles, 2);
  for (std::size_t f = 0; f < 3; ++f)
  {
    const CADTopologyFace& face = model.Faces[f];
    const auto& loop = face.Loops.at(0);
    EXPECT_EQ(face.IsPlane, loop.size() == 1);
    double area = 0.0; // of the loop in the parameters: it runs anticlockwise there
    for (int u = 0; u < static_cast<int>(loop.size()); ++u)
    {
      for (int i = 0; i < 16; ++i)
      {
        const Eigen::Vector2d a = model.UseParameters(static_cast<int>(f), 0, u, i / 16.0);
        const Eigen::Vector2d b = model.UseParameters(static_cast<int>(f), 0, u, (i + 1) / 16.0);
        area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
        const double share = loop[At(u)].Reversed ? 1.0 - i / 16.0 : i / 16.0;
        EXPECT_LT(
          (model.FacePoint(static_cast<int>(f), a) - model.EdgePoint(loop[At(u)].Edge, share))
            .norm(),
          Exact);
        // normals lead away from the middle of the solid
        EXPECT_GT(model.FaceNormal(static_cast<int>(f), a)
                    .dot(model.FacePoint(static_cast<int>(f), a) - Eigen::Vector3d(0, 0, 1.5)),
          0.0);
      }
    }
    EXPECT_GT(area, 0.0);
    EXPECT_NEAR(
      model.FaceCurvature(static_cast<int>(f), { 0.3, 0.4 }), loop.size() == 1 ? 0.0 : 0.5, Exact);
  }
}

TEST(CADTopology, ProjectionFindsTheFootOnACylinder)
{
  const CADTopology model =
    TopologyOf(BREPFile(CylinderAt(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1), 2.0, 3.0)));
  int side = 0;
  while (model.Faces[At(side)].IsPlane)
  {
    ++side;
  }
  const Eigen::Vector3d point(1.0, 1.5, 0.7);
  const CADPlace place = model.Project(side, point, { 0.2, 1.0 });
  Eigen::Vector3d foot = point;
  foot.head(2) *= 2.0 / point.head(2).norm();
  EXPECT_LT((place.Point - foot).norm(), 1e-10);
}

TEST(CADTopology, TipOfAConeIsAPoleWithoutNormal)
{
  const CADTopology model = TopologyOf(BREPFile(BRepPrimAPI_MakeCone(1.0, 0.0, 2.0).Shape()));
  ASSERT_EQ(model.Faces.size(), 2u);
  int poles = 0;
  for (std::size_t f = 0; f < 2; ++f)
  {
    for (int u = 0; u < static_cast<int>(model.Faces[f].Loops[0].size()); ++u)
    {
      if (model.Faces[f].Loops[0][At(u)].Edge < 0)
      {
        ++poles;
        const auto face = static_cast<int>(f);
        const Eigen::Vector2d tip = model.UseParameters(face, 0, u, 0.5);
        EXPECT_LT((model.FacePoint(face, tip) - Eigen::Vector3d(0, 0, 2)).norm(), Exact);
        EXPECT_EQ(model.FaceNormal(face, tip).norm(), 0.0);
      }
    }
  }
  EXPECT_EQ(poles, 1);
}

TEST(CADTopology, SolidsThatTouchShareFacesEdgesAndVerticesWhenImprinted)
{
  const std::string apart = STEPFile(TwoBoxes());
  for (const char* name : { "shared.brep", "shared.step" })
  {
    CADOperation imprint;
    ASSERT_TRUE(ModifyCAD(apart, OutputFile(name), { imprint }));
    const CADTopology model = TopologyOf(OutputFile(name));
    // of two cubes: 12 - 1 faces, 24 - 4 edges, 16 - 4 vertices
    EXPECT_EQ(model.Faces.size(), 11u) << name;
    EXPECT_EQ(model.Edges.size(), 20u) << name;
    EXPECT_EQ(model.Vertices.size(), 12u) << name;
    ASSERT_EQ(model.Bodies.size(), 2u) << name;
    int shared = 0;
    for (const CADTopologyFace& face : model.Faces)
    {
      if (face.Bodies.size() == 2)
      {
        ++shared;
        EXPECT_EQ(face.Bodies, std::vector<int>({ 0, 1 }));
        EXPECT_LT(face.Ids[0], 6);
        EXPECT_GE(face.Ids[1], 6);
      }
    }
    EXPECT_EQ(shared, 1) << name;
    int reversed = 0;
    for (const CADTopologySide& side : model.Bodies[1].Sides)
    {
      reversed += side.Reversed ? 1 : 0;
    }
    EXPECT_EQ(reversed, 1) << name;
  }
}

namespace
{
std::vector<std::array<int, 2>> TouchingOf(std::initializer_list<TopoDS_Shape> solids)
{
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const TopoDS_Shape& solid : solids)
  {
    builder.Add(compound, solid);
  }
  return TopologyOf(STEPFile(compound)).TouchingSolids().Value;
}
}

TEST(CADTopology, SolidsThatTouchInPartsOfFacesAreFound_ExactOracle)
{
  using Pairs = std::vector<std::array<int, 2>>;
  const TopoDS_Shape box = BoxAt(gp_Pnt(0, 0, 0), 1, 1, 1);
  EXPECT_EQ(TouchingOf({ box, BoxAt(gp_Pnt(1, 0, 0), 2, 1, 1) }), Pairs()); // share that face
  EXPECT_EQ(TouchingOf({ box, BoxAt(gp_Pnt(1, 0.5, 0.5), 2, 1, 1) }), (Pairs{ { 0, 1 } }));
  EXPECT_EQ(TouchingOf({ box, BoxAt(gp_Pnt(1, 1, 0), 1, 1, 1) }), Pairs()); // along an edge
  EXPECT_EQ(TouchingOf({ box, BoxAt(gp_Pnt(1.01, 0, 0), 1, 1, 1) }), Pairs());
  EXPECT_EQ(TouchingOf({ box, BoxAt(gp_Pnt(0.2, 0.2, 1), 0.3, 0.3, 0.3),
              BoxAt(gp_Pnt(3, 0, 0), 1, 1, 1), BoxAt(gp_Pnt(2, 0.2, 0.2), 1, 0.5, 0.5) }),
    (Pairs{ { 0, 1 }, { 2, 3 } }));
  // a pin in a bore, of which it sticks out on both sides
  const gp_Ax2 axis(gp_Pnt(0.5, 0.5, -0.5), gp_Dir(0, 0, 1));
  const TopoDS_Shape pin = BRepPrimAPI_MakeCylinder(axis, 0.2, 2.0).Shape();
  EXPECT_EQ(TouchingOf({ BRepAlgoAPI_Cut(box, pin).Shape(), pin }), (Pairs{ { 0, 1 } }));
}

TEST(CADTopology, UnitIsThatOfTheModel)
{
  const std::string file = STEPFile(BoxAt(gp_Pnt(0, 0, 0), 1, 2, 2));
  const auto metres = CADTopology::Read(file, LengthUnit::Metre);
  ASSERT_TRUE(metres);
  EXPECT_NEAR(metres->Diagonal, 0.003, 1e-6); // boxes hold the tolerances too
  EXPECT_NEAR(TopologyOf(file).Diagonal, 3.0, 1e-6);
}

TEST(CADTopology, FilesWithoutFacesAreErrors)
{
  const auto edge =
    CADTopology::Read(BREPFile(BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(1, 0, 0)).Shape()));
  EXPECT_EQ(edge.Status.Code, ErrorCode::EmptyInput) << edge.Status.Message();
  EXPECT_NE(edge.Status.Detail.find("part.brep"), std::string::npos);
  const auto missing = CADTopology::Read(OutputFile("missing.step"));
  EXPECT_EQ(missing.Status.Code, ErrorCode::FileError) << missing.Status.Message();
}
