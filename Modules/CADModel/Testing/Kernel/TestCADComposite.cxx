// SPDX-License-Identifier: BSD-3-Clause
// Composites, faces split by curves, and operations as words.
#include "PartFiles.h"
#include <knotwork/CADModel/CADComposite.h>
#include <knotwork/CADModel/CADModify.h>
#include <knotwork/CADModel/CADOperationText.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <BRep_Builder.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Trsf.hxx>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>

using namespace knotwork;

namespace
{
constexpr double Pi = 3.14159265358979323846;

std::vector<CADOperation> Operations(const std::vector<std::string>& texts)
{
  std::vector<CADOperation> operations;
  for (const std::string& text : texts)
  {
    auto parsed = ParseCADOperation(text);
    EXPECT_TRUE(parsed) << parsed.Status.Message();
    operations.push_back(parsed.Value);
  }
  return operations;
}

Spline<1> Polyline(const std::vector<Eigen::Vector3d>& points)
{
  const auto spans = static_cast<int>(points.size()) - 1;
  Spline<1> curve;
  curve.Space = MakeTensorSpace<1>({ KnotVector::Uniform(1, spans, 0.0, spans) }).Value;
  curve.ControlPoints.resize(spans + 1, 3);
  for (int i = 0; i <= spans; ++i)
  {
    curve.ControlPoints.row(i) = points[static_cast<std::size_t>(i)].transpose();
  }
  return curve;
}

std::vector<CADStep> Modified(
  const std::string& file, const std::vector<CADOperation>& operations, const char* output)
{
  auto result = ModifyCAD(file, OutputFile(output), operations);
  EXPECT_TRUE(result) << result.Status.Message();
  return std::move(result.Value);
}

/// Names of all faces of a file.
std::vector<std::string> Names(const std::string& file)
{
  const auto read = ReadCAD(OutputFile(file));
  std::vector<std::string> names;
  for (const TrimmedFace& face : read->Model.Faces)
  {
    names.push_back(face.Name);
  }
  return names;
}

CADOperation SplitBy(int face, const std::vector<Spline<1>>& curves)
{
  CADOperation split;
  split.Kind = CADOperationKind::SplitByCurve;
  split.Faces = { face };
  split.Curves = curves;
  return split;
}
}

TEST(CADComposite, NamesComeApartAndTogether_ExactOracle)
{
  for (const char* name : { "", "Top", "composite:1", "composite:1/Top", "composite:a b/c/d" })
  {
    EXPECT_EQ(FormatCompositeName(ParseCompositeName(name)), name);
  }
  EXPECT_EQ(ParseCompositeName("composite:12/Top/x").Group, "12");
  EXPECT_EQ(ParseCompositeName("composite:12/Top/x").Name, "Top/x");
  EXPECT_EQ(CompositeIds({ "", "composite:b", "composite:a/x", "composite:b/y", "composite" }),
    (std::vector<int>{ -1, 0, 1, 0, -1 }));
}

TEST(CADComposite, PartsOfASideBecomeOneAgain_ExactOracle)
{
  const std::string file = STEPFile(BoxAt({ 0, 0, 0 }, 3, 2, 1));
  // the side becomes four, and these are one again
  const auto cut =
    Modified(file, Operations({ "split-iso 0 u 0.5", "split-iso 0,1 v 0.5" }), "four.step");
  std::vector<int> parts;
  for (int id : cut[0].NewFaces[0])
  {
    for (int part : cut[1].NewFaces[static_cast<std::size_t>(id)])
    {
      parts.push_back(part);
    }
  }
  ASSERT_EQ(parts.size(), 4u);
  EXPECT_EQ(cut[1].After.Faces, 9);
  std::string list;
  for (int id : parts)
  {
    list += (list.empty() ? "" : ",") + std::to_string(id);
  }
  const auto steps =
    Modified(OutputFile("four.step"), Operations({ "composite " + list }), "one.step");
  EXPECT_EQ(steps[0].After.Faces, 6);
  EXPECT_EQ(steps[0].Composite.Name, "");
  ASSERT_EQ(steps[0].Composite.Faces.size(), 1u);
  EXPECT_NEAR(CheckCAD(OutputFile("one.step"))
                ->FaceAreas[static_cast<std::size_t>(steps[0].Composite.Faces[0])],
    2.0, 1e-9);
  for (int id : parts)
  {
    EXPECT_EQ(steps[0].NewFaces[static_cast<std::size_t>(id)], steps[0].Composite.Faces);
  }
  // of two of them only these are one
  const auto& half = cut[1].NewFaces[static_cast<std::size_t>(cut[0].NewFaces[0][0])];
  const auto pair = Modified(OutputFile("four.step"),
    Operations({ "composite " + std::to_string(half[0]) + "," + std::to_string(half[1]) }),
    "pair.step");
  EXPECT_EQ(pair[0].After.Faces, 8);
}

TEST(CADComposite, OtherFacesAreAGroupThatTravels_ExactOracle)
{
  const std::string file = STEPFile(BoxAt({ 0, 0, 0 }, 3, 2, 1));
  const auto faces = Operations({ "composite 0,2" });
  const auto steps = Modified(file, faces, "group.step");
  EXPECT_EQ(steps[0].After.Faces, 6);
  EXPECT_EQ(steps[0].Composite.Name, "1");
  EXPECT_EQ(steps[0].Composite.Faces, (std::vector<int>{ 0, 2 }));
  const auto names = Names("group.step");
  EXPECT_EQ(CompositeIds(names), (std::vector<int>{ 0, -1, 0, -1, -1, -1 }));
  // a second one beside it; what is cut later stays in it; a part of it in one plane is joined
  const auto more = Modified(OutputFile("group.step"),
    Operations({ "composite 1,4", "cut-plane 1.5 0 0 1 0 0" }), "more.step");
  EXPECT_EQ(more[0].Composite.Name, "2");
  const auto cut = Names("more.step");
  const auto ids = CompositeIds(cut);
  EXPECT_EQ(std::set<int>(ids.begin(), ids.end()).size(), 3u);
  for (std::size_t f = 0; f < 6; ++f)
  {
    for (int id : more[1].NewFaces[f])
    {
      const std::string group = f == 0 || f == 2 ? "1" : f == 1 || f == 4 ? "2" : "";
      EXPECT_EQ(ParseCompositeName(cut[static_cast<std::size_t>(id)]).Group, group);
    }
  }
}

TEST(CADComposite, GroupsAreOfOneInstance_ExactOracle)
{
  // the same box at two places of an assembly: OpenCASCADE writes one product
  const TopoDS_Shape box = BoxAt({ 0, 0, 0 }, 3, 2, 1);
  TopoDS_Compound both;
  const BRep_Builder builder;
  builder.MakeCompound(both);
  builder.Add(both, box);
  gp_Trsf move;
  move.SetRotation(gp_Ax1({ 1, 2, 3 }, { 0, 0, 1 }), 0.5);
  move.SetTranslationPart({ 9, 0, 0 });
  builder.Add(both, box.Moved(TopLoc_Location(move)));
  Modified(STEPFile(both), Operations({ "composite 6,8" }), "second.step");
  const auto ids = CompositeIds(Names("second.step"));
  EXPECT_EQ(ids, (std::vector<int>{ -1, -1, -1, -1, -1, -1, 0, -1, 0, -1, -1, -1 }));
}

TEST(CADComposite, CurvesSplitPlanesAndCylinders_ExactOracle)
{
  const std::string box = STEPFile(BoxAt({ 0, 0, 0 }, 3, 2, 1), "box.step");
  // a bent line above the top: 1 x 1.25 of 3 x 2 lie on one side of it
  int top = -1;
  const auto model = ReadCAD(box);
  for (int f = 0; f < 6; ++f)
  {
    const PointMatrix& points =
      model->Model.Faces[static_cast<std::size_t>(f)].Surface.ControlPoints;
    top = points.col(2).minCoeff() > 0.5 ? f : top;
  }
  const auto steps = Modified(box,
    { SplitBy(top, { Polyline({ { 1, -1, 5 }, { 1, 1.25, 5 }, { -1, 1.25, 5 } }) }) }, "bent.step");
  EXPECT_EQ(steps[0].After.Faces, 7);
  EXPECT_EQ(steps[0].After.Edges, 12 + 2 + 2);
  const auto halves = CheckCAD(OutputFile("bent.step"));
  std::multiset<double> areas;
  for (int id : steps[0].NewFaces[static_cast<std::size_t>(top)])
  {
    areas.insert(halves->FaceAreas[static_cast<std::size_t>(id)]);
  }
  ASSERT_EQ(areas.size(), 2u);
  EXPECT_NEAR(*areas.begin(), 1.25, 1e-8);
  EXPECT_NEAR(*areas.rbegin(), 4.75, 1e-8);
  // a straight line across a cylinder's side, which it does not touch: projected to a half circle
  const std::string rod = STEPFile(CylinderAt({ 0, 0, 0 }, { 0, 0, 1 }, 2, 5), "rod.step");
  std::vector<Eigen::Vector3d> circle;
  for (int i = 0; i <= 16; ++i)
  {
    circle.emplace_back(3.0 * std::cos(Pi * i / 8), 3.0 * std::sin(Pi * i / 8), 1.25);
  }
  int side = -1;
  const auto round = ReadCAD(rod);
  for (int f = 0; f < 3; ++f)
  {
    side = round->Model.Faces[static_cast<std::size_t>(f)].Type == SurfaceType::Cylinder ? f : side;
  }
  const auto rings = Modified(rod, { SplitBy(side, { Polyline(circle) }) }, "rings.step");
  const auto ringAreas = CheckCAD(OutputFile("rings.step"))->FaceAreas;
  areas.clear();
  for (int id : rings[0].NewFaces[static_cast<std::size_t>(side)])
  {
    areas.insert(ringAreas[static_cast<std::size_t>(id)]);
  }
  ASSERT_EQ(areas.size(), 2u);
  EXPECT_NEAR(*areas.begin(), 4 * Pi * 1.25, 1e-6);
  EXPECT_NEAR(*areas.rbegin(), 4 * Pi * 3.75, 1e-6);
}

TEST(CADComposite, EveryFailureIsReachable)
{
  const std::string file = STEPFile(BoxAt({ 0, 0, 0 }, 3, 2, 1));
  const auto failure = [&](const std::vector<CADOperation>& operations, const char* output)
  {
    const auto result = ModifyCAD(file, OutputFile(output), operations);
    EXPECT_FALSE(result);
    EXPECT_FALSE(std::ifstream(OutputFile(output)).good());
    return result.Status;
  };
  for (const char* text : { "composite 1", "composite 1,1", "composite 0,6", "composite 0,1" })
  {
    EXPECT_EQ(failure(Operations({ text }), "never.step").Code, ErrorCode::InvalidParameter)
      << text;
  }
  EXPECT_EQ(failure(Operations({ "composite 0,2", "composite 0,4" }), "never.step").Code,
    ErrorCode::InvalidParameter); // it is in one
  EXPECT_EQ(
    failure(Operations({ "composite 0,2" }), "never.brep").Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(failure({ SplitBy(0, {}) }, "never.step").Code, ErrorCode::EmptyInput);
  const Spline<1> line = Polyline({ { 9, 9, 9 }, { 9, 9, 10 } });
  EXPECT_EQ(failure({ SplitBy(9, { line }) }, "never.step").Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(failure({ SplitBy(0, { line }) }, "never.step").Code, ErrorCode::OutsideDomain);
  Spline<1> flat = line;
  flat.ControlPoints = PointMatrix::Zero(2, 2);
  EXPECT_EQ(failure({ SplitBy(0, { flat }) }, "never.step").Code, ErrorCode::DimensionMismatch);
  Spline<1> nan = line;
  nan.ControlPoints(0, 0) = std::nan("");
  EXPECT_EQ(failure({ SplitBy(0, { nan }) }, "never.step").Code, ErrorCode::NonFiniteInput);
  EXPECT_EQ(ParseCADOperation("  ").Status.Code, ErrorCode::EmptyInput);
  for (const char* text :
    { "cut", "imprint 1", "cut-plane 1 2 3 4 5", "cut-plane 1 2 3 4 5 6,5", "cut-face x",
      "split-iso 1 w 0.5", "composite 1,", "composite -1,2", "heal", "heal 1e-3x" })
  {
    EXPECT_EQ(ParseCADOperation(text).Status.Code, ErrorCode::InvalidParameter) << text;
  }
}

TEST(CADComposite, WordsGiveTheOperation_GoldenOracle)
{
  const auto cylinder = ParseCADOperation("cut-cylinder 1 2 3  4 5 -6e-1 7");
  ASSERT_TRUE(cylinder);
  EXPECT_EQ(cylinder->Kind, CADOperationKind::CutByCylinder);
  EXPECT_EQ(cylinder->Point, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(cylinder->Direction, Eigen::Vector3d(4, 5, -0.6));
  EXPECT_EQ(cylinder->Radius, 7.0);
  const auto iso = ParseCADOperation("split-iso 3,5 v 0.25");
  ASSERT_TRUE(iso);
  EXPECT_EQ(iso->Faces, (std::vector<int>{ 3, 5 }));
  EXPECT_EQ(iso->IsoDirection, 1);
  EXPECT_EQ(iso->Share, 0.25);
  for (CADOperationKind kind : { CADOperationKind::Imprint, CADOperationKind::CutByPlane,
         CADOperationKind::CutByFace, CADOperationKind::SplitByCurve, CADOperationKind::Composite,
         CADOperationKind::Heal, CADOperationKind::SplitByPlane })
  {
    std::string text = NameOf(kind);
    text += kind == CADOperationKind::Imprint  ? ""
      : kind == CADOperationKind::CutByPlane   ? " 0 0 0 0 0 1"
      : kind == CADOperationKind::SplitByPlane ? " 1 0 0 0 0 0 1"
                                               : " 1";
    const auto parsed = ParseCADOperation(text);
    ASSERT_TRUE(parsed) << text;
    EXPECT_EQ(parsed->Kind, kind);
  }
}

TEST(CADComposite, WordsOfAnOperationGiveItAgain_ExactOracle)
{
  for (const char* text :
    { "imprint", "cut-plane 0.1 -2 3e-05 0 0.7071067811865476 1", "cut-face 7",
      "cut-cylinder 1 2 3 4 5 -0.6 7", "split-plane 3,5 1 2 3 0 0 1", "split-iso 3,5 v 0.25",
      "split-iso 2 u 0.1", "split-curve 4", "composite 1,2,3", "heal 0.001" })
  {
    const auto operation = ParseCADOperation(text);
    ASSERT_TRUE(operation) << operation.Status.Message();
    EXPECT_EQ(TextOf(operation.Value), text);
  }
}
