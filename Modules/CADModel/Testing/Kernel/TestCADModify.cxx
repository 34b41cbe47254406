// SPDX-License-Identifier: BSD-3-Clause
// Modified files have the solids, faces, volumes, names and colours that they must have.
#include "OutputFile.h"
#include <knotwork/CADModel/CADModify.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Builder.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Writer.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <set>

using namespace knotwork;

namespace
{
constexpr double Pi = 3.14159265358979323846;

std::string FileWith(const std::vector<TopoDS_Shape>& shapes, const std::string& name)
{
  Message::DefaultMessenger()->ChangePrinters().Clear();
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const TopoDS_Shape& shape : shapes)
  {
    builder.Add(compound, shape);
  }
  STEPControl_Writer writer;
  EXPECT_EQ(
    writer.Transfer(shapes.size() == 1 ? shapes[0] : TopoDS_Shape(compound), STEPControl_AsIs),
    IFSelect_RetDone);
  EXPECT_EQ(writer.Write(OutputFile(name).c_str()), IFSelect_RetDone);
  return OutputFile(name);
}

TopoDS_Shape Box(double x, double y, double z, double a, double b, double c)
{
  return BRepPrimAPI_MakeBox(gp_Pnt(x, y, z), a, b, c).Shape();
}

TopoDS_Shape Cylinder(gp_Pnt at, gp_Dir way, double radius, double height)
{
  return BRepPrimAPI_MakeCylinder(gp_Ax2(at, way), radius, height).Shape();
}

CADOperation Plane(double x, double y, double z, double a, double b, double c)
{
  CADOperation operation;
  operation.Kind = CADOperationKind::CutByPlane;
  operation.Point = { x, y, z };
  operation.Direction = { a, b, c };
  return operation;
}

std::vector<CADStep> Modify(
  const std::string& file, const std::string& output, const std::vector<CADOperation>& operations)
{
  auto result = ModifyCAD(file, OutputFile(output), operations);
  EXPECT_TRUE(result) << result.Status.Message();
  return std::move(result.Value);
}

Status Failure(const std::string& file, const std::vector<CADOperation>& operations)
{
  const std::string output = OutputFile("never.step");
  const auto result = ModifyCAD(file, output, operations);
  EXPECT_FALSE(result);
  EXPECT_FALSE(std::ifstream(output).good()); // all or nothing
  return result.Status;
}

/// A cap and a skirt around a bore, with a hole for a pin: lengths of a small piston.
TopoDS_Shape Piston()
{
  const TopoDS_Shape outer = Cylinder({ 0, 0, 0 }, { 0, 0, 1 }, 40, 60);
  const TopoDS_Shape inner = Cylinder({ 0, 0, 0 }, { 0, 0, 1 }, 30, 45);
  const TopoDS_Shape pin = Cylinder({ -50, 0, 20 }, { 1, 0, 0 }, 10, 100);
  return BRepAlgoAPI_Cut(BRepAlgoAPI_Cut(outer, inner).Shape(), pin).Shape();
}
}

TEST(CADModify, CylinderOnACubeSharesItsDisc_ExactOracle)
{
  const std::string file = FileWith(
    { Box(0, 0, 0, 10, 10, 10), Cylinder({ 5, 5, 10 }, { 0, 0, 1 }, 3, 4) }, "stacked.step");
  EXPECT_EQ(CheckCAD(file)->NumFaces, 9);
  const auto steps = Modify(file, "imprinted.step", { CADOperation() });
  ASSERT_EQ(steps.size(), 1u);
  // 6 + 3 faces, 12 + 3 edges, 8 + 2 vertices; the top of the cube becomes a ring and the disc,
  // which is the bottom of the cylinder, and the circle with its vertex are one
  EXPECT_EQ(steps[0].Before.Faces, 9);
  EXPECT_EQ(steps[0].Before.Edges, 15);
  EXPECT_EQ(steps[0].Before.Vertices, 10);
  EXPECT_EQ(steps[0].After.Solids, 2);
  EXPECT_EQ(steps[0].After.Faces, 9);
  EXPECT_EQ(steps[0].After.FaceIds, 10);
  EXPECT_EQ(steps[0].After.Edges, 15);
  EXPECT_EQ(steps[0].After.Vertices, 10);
  EXPECT_EQ(steps[0].Overlap, 0.0);
  EXPECT_NEAR(steps[0].After.Volume, 1000 + 36 * Pi, 1e-9 * 1113);
  // every new id comes from one old one, of the same body; one face became two
  std::multiset<int> ids;
  int divided = 0;
  for (const std::vector<int>& parts : steps[0].NewFaces)
  {
    ids.insert(parts.begin(), parts.end());
    divided += parts.size() == 2 ? 1 : 0;
  }
  EXPECT_EQ(divided, 1);
  EXPECT_EQ(ids.size(), 10u);
  EXPECT_EQ(std::set<int>(ids.begin(), ids.end()).size(), 10u);
  // a STEP file has what is shared once for each solid, a BREP file once
  const auto apart = CheckCAD(OutputFile("imprinted.step"));
  EXPECT_TRUE(apart->Valid);
  EXPECT_EQ(apart->NumSolids, 2);
  EXPECT_EQ(apart->NumFaces, 10);
  Modify(file, "imprinted.brep", { CADOperation() });
  const auto shared = CheckCAD(OutputFile("imprinted.brep"));
  EXPECT_TRUE(shared->Valid);
  EXPECT_EQ(shared->NumSolids, 2);
  EXPECT_EQ(shared->NumFaces, 9);
  EXPECT_EQ(shared->NumEdges, 15);
  EXPECT_EQ(shared->NumVertices, 10);
  // the disc has the same area in both
  int discs = 0;
  for (double area : apart->FaceAreas)
  {
    discs += std::abs(area - 9 * Pi) < 1e-9 ? 1 : 0;
  }
  EXPECT_EQ(discs, 3); // and the top of the cylinder
}

TEST(CADModify, OverlapBelongsToTheFirst_ExactOracle)
{
  const std::string file =
    FileWith({ Box(0, 0, 0, 2, 1, 1), Box(1, 0, 0, 2, 1, 1) }, "overlap.step");
  const auto steps = Modify(file, "no_overlap.step", { CADOperation() });
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_EQ(steps[0].After.Solids, 3);
  EXPECT_NEAR(steps[0].Overlap, 1.0, 1e-12);
  EXPECT_NEAR(steps[0].After.Volume, 3.0, 1e-12);
  EXPECT_EQ(steps[0].After.Faces, 16); // three boxes that share two faces
}

TEST(CADModify, PlanesCutABoxIntoBoxes_ExactOracle)
{
  const std::string file = FileWith({ Box(0, 0, 0, 3, 2, 1), Box(3, 0, 0, 1, 1, 1) }, "box.step");
  const auto steps =
    Modify(file, "boxes.step", { Plane(1, 0, 0, 1, 0, 0), Plane(0, 1.5, 0, 0, 5, 0) });
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[0].After.Solids, 3);
  EXPECT_EQ(steps[0].After.FaceIds, 18);
  EXPECT_EQ(steps[0].After.Faces, 17);
  // the neighbour, which is not imprinted, stays as it is
  EXPECT_EQ(steps[1].After.Solids, 5);
  // 2 x 2 boxes share 4 of 24 faces
  EXPECT_EQ(steps[1].After.Faces, 20 + 6);
  EXPECT_EQ(steps[1].After.Edges, 33 + 12);
  EXPECT_EQ(steps[1].After.Vertices, 18 + 8);
  EXPECT_NEAR(steps[1].After.Volume, 7.0, 7e-9);
  const auto found = CheckCAD(OutputFile("boxes.step"));
  EXPECT_EQ(found->NumSolids, 5);
  EXPECT_EQ(found->NumFaces, 30);
}

TEST(CADModify, APistonBecomesCrownSkirtAndMore_ExactOracle)
{
  const std::string file = FileWith({ Piston() }, "piston.step");
  CADOperation cylinder = Plane(0, 0, 0, 0, 0, 1);
  cylinder.Kind = CADOperationKind::CutByCylinder;
  cylinder.Radius = 30;
  const auto steps = Modify(file, "pieces.step", { Plane(0, 0, 45, 0, 0, 1), cylinder });
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[0].After.Solids, 2); // crown and skirt
  EXPECT_EQ(steps[1].After.Solids, 3); // the crown's middle and ring, the skirt
  EXPECT_NEAR(steps[1].After.Volume, steps[0].Before.Volume, 1e-9 * steps[0].Before.Volume);
  EXPECT_EQ(CheckCAD(OutputFile("pieces.step"))->NumSolids, 3);
}

TEST(CADModify, VolumeIsWatched_PropertyOracle)
{
  const std::string file = FileWith({ Piston() }, "watched.step");
  CADModifyParams params;
  const auto kept = ModifyCAD(file, OutputFile("kept.step"), { Plane(0, 0, 45, 0, 0, 1) }, params);
  ASSERT_TRUE(kept) << kept.Status.Message();
  EXPECT_EQ(kept->front().VolumeChange,
    std::abs(kept->front().After.Volume / kept->front().Before.Volume - 1.0));
  // below what quadrature and curves of intersection allow
  const CADOperation oblique = Plane(0, 0, 30, 0.3, 0.2, 1);
  const auto changed =
    ModifyCAD(file, OutputFile("changed.step"), { oblique }, { params.Unit, 1.0 });
  ASSERT_TRUE(changed) << changed.Status.Message();
  const double change = changed->front().VolumeChange;
  EXPECT_GT(change, 0.0);
  EXPECT_LT(change, 1e-9);
  const auto refused =
    ModifyCAD(file, OutputFile("refused.step"), { oblique }, { params.Unit, 0.5 * change });
  EXPECT_EQ(refused.Status.Code, ErrorCode::InvalidTopology);
  EXPECT_FALSE(std::ifstream(OutputFile("refused.step")).good());
}

TEST(CADModify, AFaceExtendedCuts_ExactOracle)
{
  // an L: the step's face cuts it into two boxes
  const std::string file =
    FileWith({ BRepAlgoAPI_Cut(Box(0, 0, 0, 4, 1, 4), Box(2, 0, 1, 2, 1, 3)).Shape() }, "l.step");
  const auto model = ReadCAD(file);
  ASSERT_TRUE(model);
  CADOperation cut;
  cut.Kind = CADOperationKind::CutByFace;
  int done = 0;
  for (int id = 0; id < static_cast<int>(model->Model.Faces.size()); ++id)
  {
    cut.Tool = id;
    const auto result = ModifyCAD(file, OutputFile("l_cut.step"), { cut });
    if (result)
    {
      ++done;
      EXPECT_EQ(result->front().After.Solids, 2);
      EXPECT_EQ(result->front().After.Faces, 12); // of two boxes, one of them divided, one shared
      EXPECT_NEAR(result->front().After.Volume, 10.0, 1e-8);
    }
    else
    {
      EXPECT_EQ(result.Status.Code, ErrorCode::OutsideDomain);
    }
  }
  EXPECT_EQ(done, 2); // those of the notch
}

TEST(CADModify, FacesAreSplit_ExactOracle)
{
  const std::string file = FileWith({ Box(0, 0, 0, 2, 2, 2) }, "cube.step");
  for (int kind = 0; kind < 3; ++kind)
  {
    SCOPED_TRACE(kind);
    CADOperation split = Plane(1, 1, 1, 1, 1, 0.2);
    split.Kind = kind == 0 ? CADOperationKind::SplitByPlane : CADOperationKind::SplitByParameter;
    split.IsoDirection = kind == 2 ? 1 : 0;
    split.Share = 0.25;
    split.Faces = { 0 };
    const auto steps = Modify(file, "split.step", { split });
    ASSERT_EQ(steps.size(), 1u);
    EXPECT_EQ(steps[0].After.Solids, 1);
    EXPECT_EQ(steps[0].After.Faces, 7);
    EXPECT_EQ(steps[0].After.Edges, 15); // two of the cube's are halved
    EXPECT_EQ(steps[0].After.Vertices, 10);
    EXPECT_EQ(steps[0].NewFaces[0].size(), 2u);
    EXPECT_NEAR(steps[0].After.Volume, 8.0, 8e-9);
    const auto read = CheckCAD(OutputFile("split.step"));
    double parts = 0.0;
    for (int id : steps[0].NewFaces[0])
    {
      parts += read->FaceAreas[static_cast<std::size_t>(id)];
    }
    EXPECT_NEAR(parts, 4.0, 1e-9); // ids of the report are those of the file
  }
}

TEST(CADModify, AssemblyNamesColoursAndUnitStay_ExactOracle)
{
  // a cube twice and a bar, in metres; a face of the cube is red and named
  Message::DefaultMessenger()->ChangePrinters().Clear();
  const TopoDS_Shape cube = Box(0, 0, 0, 1, 1, 1);
  const TopoDS_Shape bar = Box(0, 0, 0, 5, 1, 1);
  Handle(TDocStd_Document) document = new TDocStd_Document("Test");
  XCAFDoc_DocumentTool::Set(document->Main(), false);
  const Handle(XCAFDoc_ShapeTool) tool = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const Handle(XCAFDoc_ColorTool) colors = XCAFDoc_DocumentTool::ColorTool(document->Main());
  const TDF_Label cubes = tool->AddShape(cube, false);
  const TDF_Label bars = tool->AddShape(bar, false);
  TDataStd_Name::Set(cubes, "Cube");
  TDataStd_Name::Set(bars, "Bar");
  colors->SetColor(bars, Quantity_Color(0, 0, 1, Quantity_TOC_sRGB), XCAFDoc_ColorGen);
  const TDF_Label face = tool->AddSubShape(cubes, TopExp_Explorer(cube, TopAbs_FACE).Current());
  TDataStd_Name::Set(face, "Left");
  colors->SetColor(face, Quantity_Color(1, 0, 0, Quantity_TOC_sRGB), XCAFDoc_ColorSurf);
  const TDF_Label all = tool->NewShape();
  TDataStd_Name::Set(all, "All");
  for (int i = 0; i < 3; ++i)
  {
    gp_Trsf move;
    move.SetTranslation(gp_Vec(i == 2 ? 0 : 4 * i, 0, i == 2 ? 0 : 1));
    const TDF_Label part = tool->AddComponent(all, i == 2 ? bars : cubes, TopLoc_Location(move));
    TDataStd_Name::Set(part, i == 2 ? "The bar" : i == 1 ? "Second" : "First");
  }
  tool->UpdateAssemblies();
  STEPCAFControl_Writer writer;
  Interface_Static::SetCVal("write.step.unit", "M");
  Interface_Static::SetIVal("write.stepcaf.subshapes.name", 1);
  ASSERT_TRUE(writer.Transfer(document));
  const std::string file = OutputFile("assembly.step");
  ASSERT_EQ(writer.Write(file.c_str()), IFSelect_RetDone);
  Interface_Static::SetCVal("write.step.unit", "MM");
  Interface_Static::SetIVal("write.stepcaf.subshapes.name", 0);

  const auto steps =
    Modify(file, "assembly_cut.step", { CADOperation(), Plane(0.25, 0, 0, 1, 0, 0) });
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[0].After.Faces, 18);          // the top of the bar becomes three, two are shared
  EXPECT_EQ(steps[1].After.Solids, 5);          // the first cube and the bar
  EXPECT_NEAR(steps[1].After.Volume, 7e9, 7.0); // cubic millimetres
  std::ifstream stream(OutputFile("assembly_cut.step"));
  const std::string text{ std::istreambuf_iterator<char>(stream), {} };
  for (const char* word : { "'All'", "'Cube'", "'Bar'", "'First'", "'Second'", "'The bar'",
         "'Left'", "SI_UNIT($,.METRE.)", "NEXT_ASSEMBLY_USAGE_OCCURRENCE" })
  {
    EXPECT_NE(text.find(word), std::string::npos) << word;
  }
  const auto found = CheckCAD(OutputFile("assembly_cut.step"), LengthUnit::Metre);
  EXPECT_NEAR(found->Volume, 7.0, 7e-9);
  const auto before = ReadCAD(file);
  const auto after = ReadCAD(OutputFile("assembly_cut.step"));
  ASSERT_TRUE(before && after);
  ASSERT_EQ(before->Model.Faces.size(), steps[0].NewFaces.size());
  for (std::size_t f = 0; f < before->Model.Faces.size(); ++f)
  {
    for (int middle : steps[0].NewFaces[f])
    {
      for (int id : steps[1].NewFaces[static_cast<std::size_t>(middle)])
      {
        const TrimmedFace& now = after->Model.Faces[static_cast<std::size_t>(id)];
        EXPECT_EQ(now.Name, before->Model.Faces[f].Name);
        EXPECT_EQ(now.HasColor, before->Model.Faces[f].HasColor);
        EXPECT_NEAR(now.Color[0], before->Model.Faces[f].Color[0], 1e-6);
        EXPECT_NEAR(now.Color[2], before->Model.Faces[f].Color[2], 1e-6);
      }
    }
  }
}

TEST(CADModify, EveryFailureIsReachable)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string file = FileWith({ Box(0, 0, 0, 1, 1, 1) }, "one.step");
  EXPECT_EQ(Failure(file, {}).Code, ErrorCode::EmptyInput);
  EXPECT_EQ(Failure(OutputFile("is_not_there.step"), { Plane(0, 0, 0, 1, 0, 0) }).Code,
    ErrorCode::FileError);
  std::ofstream(OutputFile("empty.step")) << "";
  EXPECT_EQ(
    Failure(OutputFile("empty.step"), { Plane(0, 0, 0, 1, 0, 0) }).Code, ErrorCode::EmptyInput);
  std::ofstream(OutputFile("damaged.step")) << "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n#1=";
  EXPECT_EQ(Failure(OutputFile("damaged.step"), { Plane(0, 0, 0, 1, 0, 0) }).Code,
    ErrorCode::InvalidFormat);
  EXPECT_EQ(
    Failure(OutputFile("x.igs"), { Plane(0, 0, 0, 1, 0, 0) }).Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(Failure(file, { CADOperation() }).Code, ErrorCode::InvalidParameter); // one solid
  EXPECT_EQ(Failure(file, { Plane(nan, 0, 0, 1, 0, 0) }).Code, ErrorCode::NonFiniteInput);
  EXPECT_EQ(Failure(file, { Plane(0, 0, 0, 0, 0, 0) }).Code, ErrorCode::InvalidParameter);
  for (double far : { 2.0, 1e10, 1e300 })
  {
    const Status status = Failure(file, { Plane(far, 0, 0, 1, 0, 0) });
    EXPECT_EQ(status.Code, ErrorCode::OutsideDomain);
    EXPECT_NE(status.Detail.find("operation 1"), std::string::npos) << status.Detail;
  }
  EXPECT_EQ(Failure(file, { Plane(1, 0, 0, 1, 0, 0) }).Code, ErrorCode::OutsideDomain); // a side
  for (double tolerance : { -1.0, 2.0, nan })
  {
    EXPECT_EQ(ModifyCAD(file, OutputFile("never.step"), { Plane(0.5, 0, 0, 1, 0, 0) },
                { LengthUnit::Millimetre, tolerance })
                .Status.Code,
      ErrorCode::InvalidParameter);
  }
  CADOperation operation = Plane(0.5, 0.5, 0, 0, 0, 1);
  operation.Kind = CADOperationKind::CutByCylinder;
  for (double radius : { 0.0, -1.0, nan })
  {
    operation.Radius = radius;
    EXPECT_EQ(Failure(file, { operation }).Code, ErrorCode::InvalidParameter);
  }
  operation.Radius = 1e300;
  EXPECT_EQ(Failure(file, { operation }).Code, ErrorCode::OutsideDomain);
  operation.Kind = CADOperationKind::CutByFace;
  for (int id : { -1, 6, 1000000000 })
  {
    operation.Tool = id;
    const Status status = Failure(file, { Plane(0.5, 0, 0, 1, 0, 0), operation });
    EXPECT_EQ(status.Code, id == 6 ? ErrorCode::OutsideDomain : ErrorCode::InvalidParameter);
    EXPECT_NE(status.Detail.find("operation 2"), std::string::npos) << status.Detail;
  }
  operation.Kind = CADOperationKind::SplitByPlane;
  EXPECT_EQ(Failure(file, { operation }).Code, ErrorCode::EmptyInput); // no faces
  operation.Faces = { 6 };
  EXPECT_EQ(Failure(file, { operation }).Code, ErrorCode::InvalidParameter);
  operation.Kind = CADOperationKind::SplitByParameter;
  operation.Faces = { 0 };
  for (double share : { 0.0, 1.0, nan })
  {
    operation.Share = share;
    EXPECT_EQ(Failure(file, { operation }).Code, ErrorCode::InvalidParameter);
  }
}
