// SPDX-License-Identifier: BSD-3-Clause
// Cubes with one known defect become cubes again, and the defect is counted.
#include "PartFiles.h"
#include <knotwork/CADModel/CADModify.h>

#include <BRepAlgoAPI_BuilderAlgo.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>

using namespace knotwork;

namespace
{
constexpr double Side = 10.0;

/// Faces of a cube: some turned, the last one moved up.
std::vector<TopoDS_Shape> CubeFaces(const std::vector<int>& turned, bool apart, double gap)
{
  std::vector<TopoDS_Shape> faces;
  const TopoDS_Shape cube = BoxAt({ 0, 0, 0 }, Side, Side, Side);
  for (TopExp_Explorer explorer(cube, TopAbs_FACE); explorer.More(); explorer.Next())
  {
    const auto id = static_cast<int>(faces.size());
    TopoDS_Shape face = explorer.Current();
    if (std::find(turned.begin(), turned.end(), id) != turned.end())
    {
      face.Reverse();
    }
    gp_Trsf move;
    move.SetTranslation(gp_Vec(0, 0, id == 5 ? gap : 0.0));
    faces.push_back(apart ? BRepBuilderAPI_Transform(face, move, true).Shape() : face);
  }
  return faces;
}

enum class Kind
{
  Solid,
  Shell,
  Faces
};

TopoDS_Shape Together(const std::vector<TopoDS_Shape>& faces, Kind kind)
{
  const BRep_Builder builder;
  TopoDS_Shell shell;
  builder.MakeShell(shell);
  TopoDS_Compound loose;
  builder.MakeCompound(loose);
  for (const TopoDS_Shape& face : faces)
  {
    builder.Add(shell, face);
    builder.Add(loose, face);
  }
  TopoDS_Solid solid;
  builder.MakeSolid(solid);
  builder.Add(solid, shell);
  return kind == Kind::Solid ? TopoDS_Shape(solid)
    : kind == Kind::Shell    ? TopoDS_Shape(shell)
                             : TopoDS_Shape(loose);
}

CADOperation Healing(double tolerance)
{
  CADOperation heal;
  heal.Kind = CADOperationKind::Heal;
  heal.Tolerance = tolerance;
  return heal;
}

CADStep Healed(const TopoDS_Shape& shape, double tolerance)
{
  const std::string output = OutputFile("healed.step");
  const auto result = ModifyCAD(STEPFile(shape), output, { Healing(tolerance) });
  EXPECT_TRUE(result) << result.Status.Message();
  if (!result)
  {
    return {};
  }
  const auto found = CheckCAD(output);
  EXPECT_TRUE(found && found->Valid);
  EXPECT_EQ(found->NumSolids, result->front().After.Solids);
  EXPECT_EQ(found->NumFaces, result->front().After.FaceIds);
  return result->front();
}

void ExpectCube(const CADStep& step, double volume, double tolerance)
{
  EXPECT_EQ(step.After.Solids, 1);
  EXPECT_EQ(step.After.Faces, 6);
  EXPECT_EQ(step.After.Edges, 12);
  EXPECT_EQ(step.After.Vertices, 8);
  EXPECT_NEAR(step.After.Volume, volume, tolerance);
  EXPECT_TRUE(step.Healing.Unmended.empty()) << step.Healing.Unmended.front();
}
}

TEST(CADHealing, ACubeStaysAsItIs_ExactOracle)
{
  const CADStep step = Healed(BoxAt({ 0, 0, 0 }, Side, Side, Side), 0.1);
  ExpectCube(step, 1000.0, 1e-9);
  const CADHealing& healing = step.Healing;
  EXPECT_EQ(healing.TurnedFaces + healing.TurnedSolids + healing.SewnEdges + healing.NewSolids +
      healing.RemovedEdges + healing.RemovedFaces + healing.ClosedGaps,
    0);
  EXPECT_TRUE(healing.Messages.empty());
  for (int id = 0; id < 6; ++id)
  {
    EXPECT_EQ(step.NewFaces[static_cast<std::size_t>(id)], std::vector<int>{ id });
  }
}

TEST(CADHealing, TurnedFacesAreTurnedBack_ExactOracle)
{
  for (const std::vector<int>& turned : { std::vector<int>{ 0 }, { 4 }, { 1, 3 } })
  {
    for (Kind kind : { Kind::Solid, Kind::Shell })
    {
      SCOPED_TRACE(turned.size() * 10 + static_cast<std::size_t>(kind));
      const CADStep step = Healed(Together(CubeFaces(turned, false, 0.0), kind), 1e-3);
      ExpectCube(step, 1000.0, 1e-9);
      EXPECT_EQ(step.Healing.TurnedFaces, static_cast<int>(turned.size()));
      EXPECT_EQ(step.Healing.TurnedSolids, 0);
      EXPECT_EQ(step.Healing.NewSolids, kind == Kind::Shell ? 1 : 0);
      EXPECT_FALSE(step.Healing.Messages.empty());
    }
  }
}

TEST(CADHealing, ASolidThatIsInsideOutIsTurned_ExactOracle)
{
  const CADStep step = Healed(BoxAt({ 0, 0, 0 }, Side, Side, Side).Reversed(), 1e-3);
  ExpectCube(step, 1000.0, 1e-9);
  EXPECT_EQ(step.Healing.TurnedSolids, 1);
  EXPECT_EQ(step.Healing.TurnedFaces, 0);
}

TEST(CADHealing, FacesThatAreNotSewnBecomeASolid_ExactOracle)
{
  constexpr double Gap = 0.01;
  for (Kind kind : { Kind::Solid, Kind::Shell, Kind::Faces })
  {
    SCOPED_TRACE(static_cast<int>(kind));
    const TopoDS_Shape shape = Together(CubeFaces({ 3 }, true, Gap), kind);
    const CADStep step = Healed(shape, 0.1);
    // the cover lies somewhere in the gap
    ExpectCube(step, 1000.0 + 0.5 * Gap * Side * Side, 0.5 * Gap * Side * Side + 1e-9);
    EXPECT_EQ(step.Before.Edges, 24);
    EXPECT_EQ(step.Healing.SewnEdges, 24);
    EXPECT_EQ(step.Healing.NewSolids, 1);
    EXPECT_EQ(step.Healing.TurnedFaces, 1);
    for (const std::vector<int>& ids : step.NewFaces)
    {
      EXPECT_EQ(ids.size(), 1u);
    }
  }
}

TEST(CADHealing, AGapAboveTheToleranceIsNamed_ExactOracle)
{
  constexpr double Gap = 0.25;
  const CADStep step = Healed(Together(CubeFaces({}, true, Gap), Kind::Shell), 0.01);
  EXPECT_EQ(step.After.Solids, 0);
  EXPECT_EQ(step.Healing.SewnEdges, 16); // of five faces
  ASSERT_FALSE(step.Healing.Unmended.empty());
  EXPECT_NE(step.Healing.Unmended.front().find("0.25 from the next such edge"), std::string::npos)
    << step.Healing.Unmended.front();
  EXPECT_NE(step.Healing.Unmended.front().find("4 edges of one face only"), std::string::npos);
}

TEST(CADHealing, ATinyEdgeGoes_ExactOracle)
{
  // an edge of a cube in two parts
  BRepAlgoAPI_BuilderAlgo divide;
  TopTools_ListOfShape parts;
  parts.Append(BoxAt({ 0, 0, 0 }, Side, Side, Side));
  parts.Append(BRepBuilderAPI_MakeVertex(gp_Pnt(1e-3, 0, 0)).Shape());
  divide.SetArguments(parts);
  divide.Build();
  const CADStep step = Healed(TopExp_Explorer(divide.Shape(), TopAbs_SOLID).Current(), 0.01);
  EXPECT_EQ(step.Before.Edges, 13);
  ExpectCube(step, 1000.0, 0.1);
  EXPECT_EQ(step.Healing.RemovedEdges, 1);
  EXPECT_EQ(step.Healing.RemovedFaces, 0);
}

TEST(CADHealing, ASliverGoesWithItsTinyEdges_ExactOracle)
{
  BRepBuilderAPI_MakePolygon polygon;
  for (const auto& [x, y] :
    { std::pair{ 0.0, 0.0 }, { Side, 0.0 }, { Side, Side }, { Side - 1e-3, Side }, { 0.0, Side } })
  {
    polygon.Add(gp_Pnt(x, y, 0.0));
  }
  polygon.Close();
  const TopoDS_Shape prism =
    BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(polygon.Wire()).Shape(), gp_Vec(0, 0, Side))
      .Shape();
  const CADStep step = Healed(prism, 0.01);
  EXPECT_EQ(step.Before.Faces, 7);
  ExpectCube(step, 1000.0, 0.1);
  EXPECT_EQ(step.Healing.RemovedEdges, 2);
  EXPECT_EQ(step.Healing.RemovedFaces, 1);
  int gone = 0;
  for (const std::vector<int>& ids : step.NewFaces)
  {
    gone += ids.empty() ? 1 : 0;
  }
  EXPECT_EQ(gone, 1);
}

TEST(CADHealing, OtherOperationsFollow_ExactOracle)
{
  const std::string file = STEPFile(Together(CubeFaces({ 2 }, true, 0.0), Kind::Faces));
  CADOperation cut;
  cut.Kind = CADOperationKind::CutByPlane;
  cut.Point = { 4, 0, 0 };
  cut.Direction = { 1, 0, 0 };
  const auto steps = ModifyCAD(file, OutputFile("cut.step"), { Healing(1e-3), cut });
  ASSERT_TRUE(steps) << steps.Status.Message();
  EXPECT_EQ(steps->back().After.Solids, 2);
  EXPECT_NEAR(steps->back().After.Volume, 1000.0, 1e-6);
  EXPECT_EQ(ModifyCAD(file, OutputFile("cut.step"), { cut }).Status.Code, ErrorCode::EmptyInput);
}

TEST(CADHealing, EveryFailureIsReachable)
{
  const std::string file = STEPFile(BoxAt({ 0, 0, 0 }, 1, 1, 1));
  const double infinity = std::numeric_limits<double>::infinity();
  for (double tolerance : { 0.0, -1.0, infinity, std::numeric_limits<double>::quiet_NaN() })
  {
    const auto result = ModifyCAD(file, OutputFile("never.step"), { Healing(tolerance) });
    EXPECT_EQ(result.Status.Code, ErrorCode::InvalidParameter);
    EXPECT_FALSE(std::ifstream(OutputFile("never.step")).good());
  }
}
