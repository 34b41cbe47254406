// SPDX-License-Identifier: BSD-3-Clause
// Parts whose slivers, tiny edges, tangent faces, concave edges and sweeps are known.
#include "OutputFile.h"
#include <knotwork/CADModel/CADSuggest.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Writer.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace knotwork;

namespace
{
constexpr double Pi = 3.14159265358979323846;

std::string FileWith(const TopoDS_Shape& shape, const std::string& name)
{
  Message::DefaultMessenger()->ChangePrinters().Clear();
  STEPControl_Writer writer;
  EXPECT_EQ(writer.Transfer(shape, STEPControl_AsIs), IFSelect_RetDone);
  EXPECT_EQ(writer.Write(OutputFile(name).c_str()), IFSelect_RetDone);
  return OutputFile(name);
}

CADSuggestions SuggestFor(const TopoDS_Shape& shape, const CADSuggestParams& params = {})
{
  const auto found = SuggestCADOperations(FileWith(shape, "suggest.step"), params);
  EXPECT_TRUE(found) << found.Status.Message();
  return found.Value;
}

std::vector<CADSuggestion> Of(const CADSuggestions& found, CADSuggestionKind kind)
{
  std::vector<CADSuggestion> list;
  std::copy_if(found.List.begin(), found.List.end(), std::back_inserter(list),
    [kind](const CADSuggestion& one) { return one.Kind == kind; });
  return list;
}

TopoDS_Shape Cylinder(double x, double y, double z, double radius, double height)
{
  return BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(x, y, z), gp_Dir(0, 0, 1)), radius, height).Shape();
}
}

TEST(CADSuggest, SweptSolidsAreCounted_ExactOracle)
{
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(4, 3, 2).Shape();
  const struct
  {
    TopoDS_Shape Shape;
    int Swept;
    int Mapped;
  } cases[] = { { box, 1, 1 }, { Cylinder(0, 0, 0, 1, 2), 1, 0 },
    { BRepAlgoAPI_Cut(box, Cylinder(2, 1.5, -1, 1, 4)).Shape(), 1, 0 }, // through: a frame
    { BRepAlgoAPI_Cut(box, Cylinder(2, 1.5, 1, 1, 4)).Shape(), 0, 0 },  // blind
    { BRepPrimAPI_MakeSphere(1.0).Shape(), 0, 0 } };
  for (const auto& one : cases)
  {
    const CADSuggestions found = SuggestFor(one.Shape);
    EXPECT_EQ(found.Counts.Solids, 1);
    EXPECT_EQ(found.Swept, one.Swept);
    EXPECT_EQ(found.Mapped, one.Mapped);
  }
}

TEST(CADSuggest, AStudIsCutFromItsPlate_ExactOracle)
{
  const TopoDS_Shape part =
    BRepAlgoAPI_Fuse(BRepPrimAPI_MakeBox(4, 4, 1).Shape(), Cylinder(2, 2, 0.5, 1, 3)).Shape();
  const CADSuggestions found = SuggestFor(part);
  EXPECT_EQ(found.ConcaveEdges, 1); // the circle at the stud's foot
  EXPECT_EQ(found.Swept, 0);
  const auto cuts = Of(found, CADSuggestionKind::Cut);
  ASSERT_EQ(cuts.size(), 2u); // along the plate, and down the stud
  for (const CADSuggestion& cut : cuts)
  {
    // along the plate the stud is swept, and the disc divides the plate's top; down the stud the
    // frame is swept, and the plate's top divides the rod's side
    EXPECT_EQ(cut.Solids, 2);
    EXPECT_EQ(cut.Swept, 1);
    EXPECT_EQ(cut.ConcaveEdges, 0);
    CADOperation operation;
    operation.Kind = CADOperationKind::CutByFace;
    operation.Tool = cut.Faces.front();
    const auto steps =
      ModifyCAD(OutputFile("suggest.step"), OutputFile("suggested.step"), { operation });
    ASSERT_TRUE(steps) << steps.Status.Message();
    EXPECT_EQ(steps->front().After.Solids, cut.Solids);
    EXPECT_NEAR(steps->front().After.Volume, 16 + 2.5 * Pi, 1e-8);
  }
  CADSuggestParams none;
  none.MaxCuts = 0;
  const CADSuggestions untried = SuggestFor(part, none);
  EXPECT_TRUE(Of(untried, CADSuggestionKind::Cut).empty());
  EXPECT_EQ(untried.UntriedCuts, 2);
}

TEST(CADSuggest, SmallFacesAndEdgesHaveTheirSizes_ExactOracle)
{
  CADSuggestParams params;
  params.Size = 0.5;
  for (LengthUnit unit : { LengthUnit::Millimetre, LengthUnit::Centimetre })
  {
    params.Unit = unit;
    const double scale = unit == LengthUnit::Centimetre ? 10 : 1;
    const CADSuggestions found =
      SuggestFor(BRepPrimAPI_MakeBox(4 * scale, 3 * scale, 0.25 * scale).Shape(), params);
    const auto slivers = Of(found, CADSuggestionKind::Sliver);
    const auto tiny = Of(found, CADSuggestionKind::TinyEdge);
    EXPECT_EQ(slivers.size(), 4u);
    EXPECT_EQ(tiny.size(), 4u);
    EXPECT_EQ(found.List.size(), 8u);
    for (const CADSuggestion& one : found.List)
    {
      EXPECT_NEAR(one.Size, 0.25, 1e-9);
      EXPECT_NEAR(one.Point.z(), 0.125, 1e-9);
    }
    EXPECT_NEAR(found.Counts.Volume, 3, 1e-9);
    EXPECT_EQ(found.Size, 0.5);
  }
}

TEST(CADSuggest, FilletsAreChains_ExactOracle)
{
  // a fillet along one edge hangs together with the two sides beside it
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(4, 3, 2).Shape();
  BRepFilletAPI_MakeFillet fillet(box);
  fillet.Add(0.5, TopoDS::Edge(TopExp_Explorer(box, TopAbs_EDGE).Current()));
  const CADSuggestions found = SuggestFor(fillet.Shape());
  ASSERT_EQ(found.List.size(), 1u);
  EXPECT_EQ(found.List[0].Kind, CADSuggestionKind::TangentFaces);
  EXPECT_EQ(found.List[0].Faces.size(), 3u);
  EXPECT_LT(found.List[0].Size, 1e-5);
  EXPECT_EQ(found.ConcaveEdges, 0);
  EXPECT_EQ(found.Swept, 1);
}

TEST(CADSuggest, EveryFailureIsReachable)
{
  const std::string file = FileWith(BRepPrimAPI_MakeBox(1, 1, 1).Shape(), "sound.step");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto code = [&](CADSuggestParams params)
  { return SuggestCADOperations(file, params).Status.Code; };
  const LengthUnit unit = LengthUnit::Millimetre;
  for (double size : { -1.0, nan, std::numeric_limits<double>::infinity() })
  {
    EXPECT_EQ(code({ unit, size, 1, 1 }), ErrorCode::InvalidParameter);
  }
  for (double angle : { 0.0, -1.0, 46.0, nan })
  {
    EXPECT_EQ(code({ unit, 0, angle, 1 }), ErrorCode::InvalidParameter);
  }
  EXPECT_EQ(code({ unit, 0, 1, -1 }), ErrorCode::InvalidParameter);
  EXPECT_EQ(SuggestCADOperations(OutputFile("part.iges")).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(SuggestCADOperations(OutputFile("missing.step")).Status.Code, ErrorCode::FileError);
  const TopoDS_Shape face =
    TopExp_Explorer(BRepPrimAPI_MakeBox(1, 1, 1).Shape(), TopAbs_FACE).Current();
  EXPECT_EQ(SuggestCADOperations(FileWith(face, "face.step")).Status.Code, ErrorCode::EmptyInput);
}
