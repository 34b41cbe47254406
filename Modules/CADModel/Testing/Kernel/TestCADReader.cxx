// SPDX-License-Identifier: BSD-3-Clause
// Files of Knotwork and of OpenCASCADE as trimmed models.
#include "CADCases.h"
#include "OutputFile.h"
#include "SameSpline.h"
#include <knotwork/CADModel/CADExchange.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Writer.hxx>
#include <TopoDS_Compound.hxx>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
const char* const Endings[] = { ".step", ".igs" };

CADContents ReadBack(const TrimmedModel& model, const std::string& name)
{
  const Status written = WriteCAD(model, OutputFile(name));
  EXPECT_TRUE(written) << written.Message();
  auto contents = ReadCAD(OutputFile(name));
  EXPECT_TRUE(contents) << contents.Status.Message();
  for (const auto* sentences : { &contents->Warnings, &contents->LeftOut })
  {
    for (const std::string& sentence : *sentences)
    {
      ADD_FAILURE() << sentence;
    }
  }
  return std::move(contents.Value);
}

/// A file as OpenCASCADE writes it by itself.
std::string FileWith(const TopoDS_Shape& shape, const std::string& name)
{
  Message::DefaultMessenger()->ChangePrinters().Clear();
  if (name.size() > 5 && name.substr(name.size() - 5) == ".brep")
  {
    EXPECT_TRUE(BRepTools::Write(shape, OutputFile(name).c_str()));
    return OutputFile(name);
  }
  STEPControl_Writer writer;
  EXPECT_EQ(writer.Transfer(shape, STEPControl_AsIs), IFSelect_RetDone);
  EXPECT_EQ(writer.Write(OutputFile(name).c_str()), IFSelect_RetDone);
  return OutputFile(name);
}
}

TEST(CADReader, SplinesComeBackBitForBit_ExactOracle)
{
  for (const char* ending : Endings)
  {
    const TrimmedModel model = SheetWithHoles(5, 0.3, 2, 12, 3.7);
    const CADContents read = ReadBack(model, std::string("sheet") + ending);
    ASSERT_EQ(read.Model.Faces.size(), 1u);
    const TrimmedFace& face = read.Model.Faces[0];
    EXPECT_TRUE(SameSpline(face.Surface, model.Faces[0].Surface));
    EXPECT_EQ(read.NumRefitted, 0);
    EXPECT_EQ(read.Model.NumEdges, 6);
    EXPECT_EQ(read.Model.NumVertices, 6);
    ASSERT_EQ(face.Loops.size(), 3u);
    ASSERT_EQ(face.Loops[0].Curves.size(), 4u); // the outer one first
    for (std::size_t l = 0; l < 3; ++l)
    {
      for (const TrimmingCurve& curve : face.Loops[l].Curves)
      {
        // loops and their curves may begin elsewhere
        int found = 0;
        for (const TrimmedLoop& loop : model.Faces[0].Loops)
        {
          for (const TrimmingCurve& other : loop.Curves)
          {
            found += SameSpline(curve.Curve, other.Curve) && curve.UV == other.UV &&
                curve.Reversed == other.Reversed
              ? 1
              : 0;
          }
        }
        EXPECT_EQ(found, 1) << ending << " loop " << l;
      }
    }
    // OpenCASCADE takes fewer samples
    const double tolerance = CheckCAD(OutputFile(std::string("sheet") + ending))->MaxEdgeTolerance;
    EXPECT_LE(tolerance, 1.05 * read.MaxGap);
    EXPECT_GE(tolerance, 0.5 * read.MaxGap);
  }
}

TEST(CADReader, NamesAndColoursComeBack_ExactOracle)
{
  ShapeParams params;
  params.Kind = ShapeKind::Disc;
  TrimmedModel model = NaturalFaces(params);
  for (std::size_t f = 0; f < 4; ++f)
  {
    model.Faces[f].Name = "F" + std::to_string(f);
    model.Faces[f].HasColor = f > 0;
    model.Faces[f].Color = { 0.25, 0.5, 0.2 * static_cast<double>(f) };
  }
  for (const char* ending : Endings)
  {
    SCOPED_TRACE(ending);
    const CADContents read = ReadBack(model, std::string("named") + ending);
    ASSERT_EQ(read.Model.Faces.size(), 5u);
    for (const TrimmedFace& face : read.Model.Faces)
    {
      // the face with the same surface
      std::size_t f = 0;
      while (f < 5 && !SameSpline(face.Surface, model.Faces[f].Surface))
      {
        ++f;
      }
      ASSERT_LT(f, 5u);
      EXPECT_EQ(face.Name, model.Faces[f].Name);
      EXPECT_EQ(face.HasColor, model.Faces[f].HasColor);
      for (std::size_t c = 0; c < 3 && face.HasColor; ++c)
      {
        EXPECT_NEAR(face.Color[c], model.Faces[f].Color[c], 1e-6); // single precision
      }
    }
  }
}

TEST(CADReader, WritingWhatWasReadChangesNothing_PropertyOracle)
{
  struct Case
  {
    const char* Name;
    ShapeKind Kind;
    double Angle;
  };
  for (const Case& c : { Case{ "tube", ShapeKind::CylinderSurface, 360.0 },
         Case{ "quarter", ShapeKind::CylinderSurface, 90.0 },
         Case{ "sphere", ShapeKind::SphereSurface, 360.0 },
         Case{ "polar", ShapeKind::PolarSphereSurface, 360.0 },
         Case{ "torus", ShapeKind::TorusSurface, 360.0 }, Case{ "disc", ShapeKind::Disc, 360.0 } })
  {
    for (const char* ending : Endings)
    {
      SCOPED_TRACE(std::string(c.Name) + ending);
      ShapeParams params;
      params.Kind = c.Kind;
      params.Angle = c.Angle;
      const CADContents first = ReadBack(NaturalFaces(params), std::string(c.Name) + ending);
      const auto once = CheckCAD(OutputFile(std::string(c.Name) + ending));
      const CADContents second = ReadBack(first.Model, std::string("again_") + c.Name + ending);
      const auto twice = CheckCAD(OutputFile(std::string("again_") + c.Name + ending));
      ASSERT_TRUE(once && twice);
      EXPECT_TRUE(twice->Valid);
      EXPECT_EQ(twice->NumFaces, once->NumFaces);
      EXPECT_EQ(twice->NumEdges, once->NumEdges);
      EXPECT_EQ(twice->NumVertices, once->NumVertices);
      EXPECT_EQ(twice->NumFreeLoops, once->NumFreeLoops);
      EXPECT_EQ(twice->NumSolids, once->NumSolids);
      EXPECT_NEAR(twice->Area, once->Area, 1e-6 * once->Area);
      EXPECT_NEAR(twice->Volume, once->Volume, 1e-6 * once->Area);
      EXPECT_LE(twice->MaxEdgeTolerance, 2e-7);
      EXPECT_EQ(first.NumRefitted, 0);
      EXPECT_LE(first.MaxGap, 1e-9);
      EXPECT_EQ(second.Model.NumEdges, first.Model.NumEdges);
      EXPECT_EQ(second.Model.NumVertices, first.Model.NumVertices);
    }
  }
}

TEST(CADReader, AnalyticSolidsHaveTheirAreaAndVolume_ExactOracle)
{
  struct Case
  {
    const char* Name;
    TopoDS_Shape Shape;
    double Area, Volume;
    std::size_t Faces;
  };
  const double slant = std::sqrt(1.0 + 9.0);
  const Case cases[] = {
    { "box", BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape(), 22.0, 6.0, 6 },
    { "sphere", BRepPrimAPI_MakeSphere(2.0).Shape(), 16 * Pi, 32.0 / 3.0 * Pi, 1 },
    { "half", BRepPrimAPI_MakeSphere(2.0, 0.0, 0.5 * Pi).Shape(), 12 * Pi, 16.0 / 3.0 * Pi, 2 },
    { "torus", BRepPrimAPI_MakeTorus(3.0, 1.0).Shape(), 12 * Pi * Pi, 6 * Pi * Pi, 1 },
    { "cylinder", BRepPrimAPI_MakeCylinder(1.0, 3.0).Shape(), 8 * Pi, 3 * Pi, 3 },
    { "cone", BRepPrimAPI_MakeCone(2.0, 1.0, 3.0).Shape(), (5.0 + 3.0 * slant) * Pi, 7 * Pi, 3 },
    { "tip", BRepPrimAPI_MakeCone(1.0, 0.0, 3.0).Shape(), (1.0 + slant) * Pi, Pi, 2 },
    { "drilled",
      BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(gp_Pnt(-2, -2, 0), gp_Pnt(2, 2, 1)).Shape(),
        BRepPrimAPI_MakeCylinder(1.0, 1.0).Shape())
        .Shape(),
      48.0, 16.0 - Pi, 7 },
    { "torus_part", BRepPrimAPI_MakeTorus(3.0, 1.0, 0.5 * Pi).Shape(), 3 * Pi * Pi + 2 * Pi,
      1.5 * Pi * Pi, 3 },
    { "nurbs", BRepBuilderAPI_NurbsConvert(BRepPrimAPI_MakeCylinder(1.0, 3.0).Shape()).Shape(),
      8 * Pi, 3 * Pi, 3 },
  };
  for (std::size_t i = 0; i < 2 * std::size(cases); ++i)
  {
    const Case& c = cases[i / 2];
    const char* ending = i % 2 == 0 ? ".step" : ".brep";
    SCOPED_TRACE(std::string(c.Name) + ending);
    const auto read = ReadCAD(FileWith(c.Shape, c.Name + std::string(ending)));
    ASSERT_TRUE(read) << read.Status.Message();
    for (const std::string& warning : read->Warnings)
    {
      ADD_FAILURE() << warning;
    }
    EXPECT_EQ(read->Model.Faces.size(), c.Faces);
    EXPECT_LE(read->MaxGap, 1e-11);
    EXPECT_LE(read->NumRefitted, 2); // degenerate edges at poles: not linear in the parameter
    const std::string again = OutputFile(std::string("own_") + c.Name + ".step");
    const Status written = WriteCAD(read->Model, again);
    ASSERT_TRUE(written) << written.Message();
    const auto summary = CheckCAD(again);
    EXPECT_TRUE(summary->Valid) << (summary->Defects.empty() ? "" : summary->Defects[0]);
    EXPECT_EQ(summary->NumSolids, 1);
    EXPECT_NEAR(summary->Area, c.Area, 1e-5 * c.Area);
    EXPECT_NEAR(summary->Volume, c.Volume, 1e-5 * c.Area);
    EXPECT_LE(summary->MaxEdgeTolerance, 2e-5);
  }
}

TEST(CADReader, CurvesWithoutACommonFormAreRefitted_PropertyOracle)
{
  // two cylinders that cross: the intersection is approximated by OpenCASCADE, its pcurves on the
  // cylinders are functions of angles
  const TopoDS_Shape cross = BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(2.0, 8.0).Shape(),
    BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(-5, 0, 4), gp_Dir(1, 0, 0)), 1.0, 10.0).Shape())
                               .Shape();
  const std::string file = FileWith(cross, "cross.step");
  const auto original = CheckCAD(file);
  ASSERT_TRUE(original->Valid);
  double last = 1.0;
  for (double tolerance : { 1e-3, 1e-5 })
  {
    CADReadParams params;
    params.Tolerance = tolerance;
    const auto read = ReadCAD(file, params);
    ASSERT_TRUE(read) << read.Status.Message();
    EXPECT_EQ(read->Warnings.size(), 0u);
    EXPECT_EQ(read->LeftOut.size(), 0u);
    EXPECT_GT(read->NumRefitted, 0);
    // that of the refitting, and what the file itself leaves between curve and pcurve
    EXPECT_LE(read->MaxGap, 2.0 * tolerance + original->MaxEdgeTolerance);
    EXPECT_LE(read->MaxGap, last);
    last = read->MaxGap;
    const std::string again = OutputFile("own_cross.step");
    ASSERT_TRUE(WriteCAD(read->Model, again));
    const auto summary = CheckCAD(again);
    EXPECT_TRUE(summary->Valid) << (summary->Defects.empty() ? "" : summary->Defects[0]);
    EXPECT_EQ(summary->NumSolids, 1);
    // the cut edges are 25 long
    const double allowed = 25.0 * (2.0 * tolerance + original->MaxEdgeTolerance);
    EXPECT_NEAR(summary->Area, original->Area, allowed);
    EXPECT_NEAR(summary->Volume, original->Volume, allowed);
    EXPECT_LE(summary->MaxEdgeTolerance, 2.0 * tolerance + original->MaxEdgeTolerance);
  }
}

TEST(CADReader, PlacedPartsAndSeveralBodiesAreResolved_ExactOracle)
{
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(1.0, 1.0, 1.0).Shape();
  for (int i = 0; i < 3; ++i)
  {
    gp_Trsf move;
    move.SetTranslation(gp_Vec(2.0 * i, 0.0, 0.0));
    builder.Add(compound, box.Moved(TopLoc_Location(move)));
  }
  CADReadParams params;
  params.Unit = LengthUnit::Centimetre;
  const auto read = ReadCAD(FileWith(compound, "three.step"), params);
  ASSERT_TRUE(read) << read.Status.Message();
  EXPECT_EQ(read->Model.Faces.size(), 18u);
  EXPECT_EQ(read->Model.NumEdges, 36);
  EXPECT_EQ(read->Model.NumVertices, 24);
  EXPECT_EQ(read->Model.Faces.back().Body, 2);
  double reach = 0.0;
  for (const TrimmedFace& face : read->Model.Faces)
  {
    reach = std::max(reach, face.Surface.ControlPoints.col(0).maxCoeff());
  }
  EXPECT_NEAR(reach, 0.5, 1e-12); // 5 mm
}

TEST(CADReader, DamagedFilesAreRefused_PropertyOracle)
{
  for (const char* ending : Endings)
  {
    const std::string good = OutputFile(std::string("good") + ending);
    const std::string bad = OutputFile(std::string("bad") + ending);
    ASSERT_TRUE(WriteCAD(SheetWithHoles(2, 0.1, 1, 8), good));
    std::ifstream stream(good, std::ios::binary);
    const std::string text{ std::istreambuf_iterator<char>(stream), {} };
    const auto code = [&](const std::string& content)
    {
      std::ofstream(bad, std::ios::binary) << content;
      return ReadCAD(bad).Status.Code;
    };
    EXPECT_EQ(code(text), ErrorCode::Ok);
    EXPECT_EQ(code(""), ErrorCode::EmptyInput);
    EXPECT_EQ(code("hello world\n"), ErrorCode::InvalidFormat);
    EXPECT_EQ(code(text.substr(0, text.size() / 3)), ErrorCode::InvalidFormat);
    std::remove(bad.c_str());
    EXPECT_EQ(ReadCAD(bad).Status.Code, ErrorCode::FileError);
  }
  CADReadParams params;
  params.Tolerance = -1.0;
  EXPECT_EQ(ReadCAD(OutputFile("good.step"), params).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(ReadCAD(OutputFile("good.txt")).Status.Code, ErrorCode::InvalidParameter);
}

/// Lengths of a BREP file are millimetres; the area counts with the square of the unit.
TEST(CADReader, BREPHasMillimetresAndIsNotWritten_ExactOracle)
{
  const std::string good = FileWith(BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape(), "box_mm.brep");
  for (const auto& [unit, scale] : { std::pair(LengthUnit::Millimetre, 1.0),
         std::pair(LengthUnit::Centimetre, 0.1), std::pair(LengthUnit::Micrometre, 1000.0) })
  {
    const auto summary = CheckCAD(good, unit);
    ASSERT_TRUE(summary) << summary.Status.Message();
    EXPECT_NEAR(summary->Area, 22.0 * scale * scale, 1e-9 * scale * scale);
    EXPECT_TRUE(summary->Valid);
    CADReadParams params;
    params.Unit = unit;
    const auto read = ReadCAD(good, params);
    ASSERT_TRUE(read) << read.Status.Message();
    double largest = 0.0;
    for (const TrimmedFace& face : read->Model.Faces)
    {
      largest = std::max(largest, face.Surface.ControlPoints.cwiseAbs().maxCoeff());
    }
    EXPECT_NEAR(largest, 3.0 * scale, 1e-9 * scale);
  }
  const auto read = ReadCAD(good);
  const Status written = WriteCAD(read->Model, OutputFile("own_box.brep"));
  EXPECT_EQ(written.Code, ErrorCode::InvalidParameter);
  EXPECT_NE(written.Detail.find(".step, .stp, .iges or .igs"), std::string::npos);

  std::ifstream stream(good, std::ios::binary);
  const std::string text{ std::istreambuf_iterator<char>(stream), {} };
  const std::string bad = OutputFile("bad.brep");
  const auto code = [&](const std::string& content)
  {
    std::ofstream(bad, std::ios::binary) << content;
    return ReadCAD(bad).Status.Code;
  };
  EXPECT_EQ(code(""), ErrorCode::EmptyInput);
  EXPECT_EQ(code("hello world\n"), ErrorCode::InvalidFormat);
  EXPECT_EQ(code(text.substr(0, text.size() / 3)), ErrorCode::InvalidFormat);
  EXPECT_EQ(code(text.substr(0, text.rfind("TShapes")) + "\n+1 0\n"), ErrorCode::InvalidFormat);
  std::remove(bad.c_str());
  EXPECT_EQ(ReadCAD(bad).Status.Code, ErrorCode::FileError);
}

TEST(CADReader, AStatementThatStandsTwiceIsNamedInOurWords_ExactOracle)
{
  const std::string file = OutputFile("twice.step");
  ASSERT_TRUE(WriteCAD(SheetWithHoles(2, 0.1, 1, 8), file));
  std::ifstream stream(file, std::ios::binary);
  std::string text{ std::istreambuf_iterator<char>(stream), {} };
  stream.close();
  const std::size_t word = text.find("= ORIENTED_EDGE(");
  ASSERT_NE(word, std::string::npos);
  const std::size_t begin = text.rfind('#', word);
  text.insert(begin, text.substr(begin, text.find(";\n", word) + 2 - begin));
  std::ofstream(file, std::ios::binary) << text;
  const Status status = ReadCAD(file).Status;
  EXPECT_EQ(status.Code, ErrorCode::InvalidFormat);
  EXPECT_NE(status.Detail.find("its references cannot be followed"), std::string::npos)
    << status.Detail;
  EXPECT_EQ(status.Detail.find("Exception"), std::string::npos) << status.Detail;
}
