// SPDX-License-Identifier: BSD-3-Clause
// STEP and IGES files as OpenCASCADE reads them with its default settings.
#include "CADCases.h"
#include "OutputFile.h"
#include <knotwork/CADModel/CADExchange.h>

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <iterator>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
CADSummary Checked(
  const TrimmedModel& model, const std::string& name, const CADWriteParams& params = {})
{
  const std::string file = OutputFile(name);
  const Status written = WriteCAD(model, file, params);
  EXPECT_TRUE(written) << written.Message();
  const auto summary = CheckCAD(file, params.Unit);
  EXPECT_TRUE(summary) << summary.Status.Message();
  for (const std::string& defect : summary->Defects)
  {
    ADD_FAILURE() << name << ": " << defect;
  }
  EXPECT_TRUE(summary->Valid);
  return summary.Value;
}

const char* const Endings[] = { ".step", ".igs" };
}

TEST(CADWriter, SheetWithHolesIsOneFace_ExactOracle)
{
  for (const char* ending : Endings)
  {
    const TrimmedModel model = SheetWithHoles(4, 0.0, 3, 16);
    const CADSummary summary = Checked(model, std::string("sheet") + ending);
    EXPECT_EQ(summary.NumFaces, 1);
    EXPECT_EQ(summary.NumWires, 4);
    EXPECT_EQ(summary.NumEdges, 7);
    EXPECT_EQ(summary.NumVertices, 7);
    EXPECT_EQ(summary.NumFreeLoops, 4);
    EXPECT_EQ(summary.NumSolids, 0);
    // cubic circles of 16 elements: radius right to 1e-5
    EXPECT_NEAR(summary.Area, 1.0 - 3.0 * Pi * 0.06 * 0.06, 1e-5);
    EXPECT_LE(summary.MaxEdgeTolerance, 1.1e-7); // flat: the curves lie in it
    EXPECT_LE(summary.MaxVertexTolerance, 1.1e-7);
    EXPECT_LE(summary.BoxLower[0], 1e-6);
    EXPECT_GE(summary.BoxUpper[1], 1.0 - 1e-6);
  }
}

TEST(CADWriter, TolerancesAreTheGapsOfTheCurves_PropertyOracle)
{
  // a bump of 0.3: curves of few elements leave it by what falls with the fourth power
  double last = 1.0;
  for (int elements : { 8, 16, 32, 64 })
  {
    const CADSummary summary = Checked(SheetWithHoles(6, 0.3, 2, elements), "bump.step");
    const double tolerance = std::max(summary.MaxEdgeTolerance, summary.MaxVertexTolerance);
    EXPECT_LT(tolerance, std::max(0.3 * last, 1.1e-7)) << elements; // 1e-7: the least there is
    last = tolerance;
  }
  EXPECT_LT(last, 1e-6);
}

TEST(CADWriter, SharedEdgesMakeAShell_ExactOracle)
{
  // two unit squares in planes at a right angle; the edge between them has one number
  TrimmedModel model;
  model.NumEdges = 7;
  model.NumVertices = 6;
  const KnotVector knots = KnotVector::Uniform(2, 2);
  for (int f = 0; f < 2; ++f)
  {
    TrimmedFace face;
    face.Surface.Space = MakeTensorSpace<2>({ knots, knots }).Value;
    const PointMatrix uv = GrevillePoints<2>(*face.Surface.Space);
    face.Surface.ControlPoints.setZero(uv.rows(), 3);
    face.Surface.ControlPoints.col(1) = uv.col(1);
    face.Surface.ControlPoints.col(f == 0 ? 0 : 2) = uv.col(0);
    // common edge: u = 0, v from 0 to 1, number 0 between vertices 0 and 1
    const Eigen::Vector2d corners[4] = { { 0, 1 }, { 0, 0 }, { 1, 0 }, { 1, 1 } };
    const int vertices[4] = { 1, 0, 2 + 2 * f, 3 + 2 * f };
    TrimmedLoop loop;
    TrimmingCurve common =
      CurveOnSurface(face.Surface, Segment(corners[1], corners[0]), 1, 0, 0, 1);
    common.Reversed = true;
    loop.Curves.push_back(common);
    for (int s = 1; s < 4; ++s)
    {
      loop.Curves.push_back(CurveOnSurface(face.Surface, Segment(corners[s], corners[(s + 1) % 4]),
        1, 3 * f + s, vertices[s], vertices[(s + 1) % 4]));
    }
    face.Loops.push_back(loop);
    model.Faces.push_back(face);
  }
  for (const char* ending : Endings)
  {
    for (int turned = 0; turned < 2; ++turned) // the writer turns faces that disagree
    {
      model.Faces[1].Reversed = turned == 1;
      const CADSummary summary = Checked(model, std::string("shell") + ending);
      EXPECT_EQ(summary.NumShells, ending[1] == 's' ? 1 : summary.NumShells);
      EXPECT_EQ(summary.NumFaces, 2);
      EXPECT_EQ(summary.NumEdges, 7);
      EXPECT_EQ(summary.NumVertices, 6);
      EXPECT_EQ(summary.NumFreeLoops, 1);
      EXPECT_NEAR(summary.Area, 2.0, 1e-9);
    }
  }
  model.Faces[1].Body = 1; // not sewn
  const CADSummary summary = Checked(model, "two_bodies.step");
  EXPECT_EQ(summary.NumShells, 2);
  EXPECT_EQ(summary.NumEdges, 8);
  EXPECT_EQ(summary.NumFreeLoops, 2);
}

TEST(CADWriter, NaturalFacesOfShapesAreSewn_ExactOracle)
{
  struct Case
  {
    const char* Name;
    ShapeKind Kind;
    double Angle;
    double Area;
    double Volume; ///< 0: open
    int Faces, Edges, FreeLoops;
  };
  // OuterRadius 1, InnerRadius 0.5, Height 1
  const Case cases[] = {
    { "quarter", ShapeKind::CylinderSurface, 90.0, Pi / 2, 0.0, 1, 4, 1 },
    { "tube", ShapeKind::CylinderSurface, 360.0, 2 * Pi, 0.0, 1, 3, 2 },
    { "sphere", ShapeKind::SphereSurface, 360.0, 4 * Pi, 4 * Pi / 3, 6, 12, 0 },
    { "polar", ShapeKind::PolarSphereSurface, 360.0, 4 * Pi, 4 * Pi / 3, 1, 1, 0 },
    { "half_polar", ShapeKind::PolarSphereSurface, 180.0, 2 * Pi, 0.0, 1, 2, 1 },
    { "torus", ShapeKind::TorusSurface, 360.0, 2 * Pi * Pi, Pi * Pi / 2, 1, 2, 0 },
    { "half_torus", ShapeKind::TorusSurface, 180.0, Pi * Pi, 0.0, 1, 3, 2 },
    { "disc", ShapeKind::Disc, 90.0, Pi, 0.0, 5, 12, 1 },
    { "plate", ShapeKind::PlateWithHole, 90.0, 4.0 - Pi / 4, 0.0, 4, 12, 2 },
  };
  for (const Case& c : cases)
  {
    for (const char* ending : Endings)
    {
      SCOPED_TRACE(std::string(c.Name) + ending);
      ShapeParams params;
      params.Kind = c.Kind;
      params.Angle = c.Angle;
      params.Size = { 2.0, 2.0, 2.0 };
      const CADSummary summary = Checked(NaturalFaces(params), std::string(c.Name) + ending);
      EXPECT_EQ(summary.NumFaces, c.Faces);
      EXPECT_EQ(summary.NumFreeLoops, c.FreeLoops);
      EXPECT_EQ(summary.NumSolids, c.Volume > 0.0 ? 1 : 0);
      EXPECT_NEAR(summary.Area, c.Area, 1e-6 * c.Area);
      EXPECT_NEAR(summary.Volume, c.Volume, 1e-6);
      EXPECT_LE(summary.MaxEdgeTolerance, 2e-7);
      EXPECT_LE(summary.MaxVertexTolerance, 2e-7);
      EXPECT_EQ(summary.NumEdges, c.Edges);
    }
  }
}

TEST(CADWriter, LargeFaceIsValidAndQuick_PropertyOracle)
{
  // 203 x 203 control points, 27 holes, 31 pcurves of 500 elements
  const TrimmedModel model = SheetWithHoles(200, 30.0, 27, 500, 100.0);
  for (const char* ending : Endings)
  {
    const auto start = std::chrono::steady_clock::now();
    const CADSummary summary = Checked(model, std::string("large") + ending);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_EQ(summary.NumFreeLoops, 28);
    EXPECT_LE(summary.MaxEdgeTolerance, 1e-5); // of a size of 100
    EXPECT_LE(summary.MaxVertexTolerance, 1e-5);
    EXPECT_LT(seconds.count(), 30.0); // 1.3 measured
  }
}

TEST(CADWriter, PatchesOfABoxMakeASolid_ExactOracle)
{
  // six biquadratic Bezier patches of the box 1 x 2 x 3, their normals at random
  TrimmedModel model;
  const KnotVector knots = KnotVector::Uniform(2, 1);
  const Eigen::Vector3d size(1.0, 2.0, 3.0);
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int side = 0; side < 2; ++side)
    {
      TrimmedFace face;
      face.Surface.Space = MakeTensorSpace<2>({ knots, knots }).Value;
      const PointMatrix uv = GrevillePoints<2>(*face.Surface.Space);
      face.Surface.ControlPoints.setZero(uv.rows(), 3);
      face.Surface.ControlPoints.col(axis).setConstant(side * size[axis]);
      const int other[2] = { (axis + 1 + side) % 3, (axis + 2 - side) % 3 };
      for (int d = 0; d < 2; ++d)
      {
        face.Surface.ControlPoints.col(other[d]) = uv.col(d) * size[other[d]];
      }
      face.Reversed = axis == 1;
      model.Faces.push_back(face);
    }
  }
  for (const char* ending : Endings)
  {
    const CADSummary summary = Checked(model, std::string("box") + ending);
    EXPECT_EQ(summary.NumSolids, 1);
    EXPECT_EQ(summary.NumFaces, 6);
    EXPECT_EQ(summary.NumEdges, 12);
    EXPECT_EQ(summary.NumVertices, 8);
    EXPECT_TRUE(summary.Closed);
    EXPECT_NEAR(summary.Volume, 6.0, 1e-9);
    EXPECT_NEAR(summary.Area, 22.0, 1e-9);
    const auto withoutVolume =
      CheckCAD(OutputFile(std::string("box") + ending), LengthUnit::Millimetre, false);
    EXPECT_EQ(withoutVolume->Volume, 0.0);
    EXPECT_EQ(withoutVolume->Area, summary.Area);
    for (std::size_t d = 0; d < 3; ++d)
    {
      EXPECT_NEAR(summary.BoxLower[d], 0.0, 1e-6);
      EXPECT_NEAR(summary.BoxUpper[d], size[static_cast<Eigen::Index>(d)], 1e-6);
    }
  }
}

TEST(CADWriter, CavitiesOfABodyBelongToItsSolid_ExactOracle)
{
  // spheres of radius 2 and 1: the inner one turned inward is a cavity, else a body by itself
  ShapeParams params;
  params.Kind = ShapeKind::SphereSurface;
  params.OuterRadius = 2.0;
  TrimmedModel model = NaturalFaces(params);
  params.OuterRadius = 1.0;
  const TrimmedModel inner = NaturalFaces(params);
  model.Faces.insert(model.Faces.end(), inner.Faces.begin(), inner.Faces.end());
  for (std::size_t f = 6; f < 12; ++f)
  {
    model.Faces[f].Reversed = true;
  }
  CADSummary summary = Checked(model, "hollow.step");
  EXPECT_EQ(summary.NumSolids, 1);
  EXPECT_EQ(summary.NumShells, 2);
  EXPECT_NEAR(summary.Volume, 4.0 / 3.0 * Pi * 7.0, 1e-5);
  for (std::size_t f = 6; f < 12; ++f)
  {
    model.Faces[f].Body = 1;
  }
  summary = Checked(model, "two_balls.step");
  EXPECT_EQ(summary.NumSolids, 2);
  EXPECT_NEAR(summary.Volume, 4.0 / 3.0 * Pi * 9.0, 1e-5);
}

TEST(CADWriter, WhatLiesBesideABodyIsNoCavity_ExactOracle)
{
  // a sphere turned inward in the hole of a torus, in its box: a solid by itself
  ShapeParams params;
  params.Kind = ShapeKind::TorusSurface;
  params.Angle = 360.0;
  params.OuterRadius = 3.0;
  params.InnerRadius = 1.0;
  TrimmedModel model = NaturalFaces(params);
  params.Kind = ShapeKind::SphereSurface;
  params.OuterRadius = 0.5;
  for (TrimmedFace& face : NaturalFaces(params).Faces)
  {
    face.Reversed = true;
    model.Faces.push_back(face);
  }
  const CADSummary summary = Checked(model, "ball_in_a_ring.step");
  EXPECT_EQ(summary.NumSolids, 2);
  EXPECT_NEAR(summary.Volume, 6.0 * Pi * Pi + Pi / 6.0, 1e-4);
}

TEST(CADWriter, UnclampedKnotsGiveTheSameFace_CrossOracle)
{
  // periodic-looking knots 0, 1, ... 9 of degree 3: the domain is [3, 6]
  TrimmedModel model;
  TrimmedFace face;
  std::vector<double> values(10);
  for (std::size_t i = 0; i < 10; ++i)
  {
    values[i] = static_cast<double>(i);
  }
  const KnotVector unclamped = KnotVector::Create(3, values).Value;
  face.Surface.Space = MakeTensorSpace<2>({ unclamped, KnotVector::Uniform(2, 2) }).Value;
  const PointMatrix uv = GrevillePoints<2>(*face.Surface.Space);
  face.Surface.ControlPoints.setZero(uv.rows(), 3);
  face.Surface.ControlPoints.leftCols(2) = uv; // the map is the identity on [3, 6] x [0, 1]
  model.Faces.push_back(face);
  const CADSummary summary = Checked(model, "unclamped.step");
  EXPECT_NEAR(summary.Area, 3.0, 1e-9);
  EXPECT_NEAR(summary.BoxLower[0], 3.0, 1e-6);
  EXPECT_NEAR(summary.BoxUpper[0], 6.0, 1e-6);
}

TEST(CADWriter, UnitsAreThoseOfTheFile_ExactOracle)
{
  const TrimmedModel model = SheetWithHoles(2, 0.0, 0, 1, 2.0);
  CADWriteParams params;
  params.Unit = LengthUnit::Inch;
  for (const char* ending : Endings)
  {
    const std::string file = OutputFile(std::string("inch") + ending);
    ASSERT_TRUE(WriteCAD(model, file, params));
    EXPECT_NEAR(CheckCAD(file, LengthUnit::Inch)->Area, 4.0, 1e-9);
    EXPECT_NEAR(CheckCAD(file)->Area, 4.0 * 25.4 * 25.4, 1e-6);
    EXPECT_NEAR(CheckCAD(file, LengthUnit::Metre)->Area, 4.0 * 0.0254 * 0.0254, 1e-12);
  }
}

TEST(CADWriter, NamesAndColoursAreInTheFile_PropertyOracle)
{
  ShapeParams params;
  params.Kind = ShapeKind::Disc;
  TrimmedModel model = NaturalFaces(params);
  model.Faces[0].Name = "core";
  model.Faces[0].HasColor = true;
  model.Faces[0].Color = { 0.25, 0.5, 0.75 };
  for (STEPSchema schema : { STEPSchema::AP214, STEPSchema::AP242 })
  {
    CADWriteParams write;
    write.Schema = schema;
    write.Name = "a disc";
    Checked(model, "named.step", write);
    std::ifstream stream(OutputFile("named.step"));
    const std::string text{ std::istreambuf_iterator<char>(stream), {} };
    EXPECT_NE(text.find("ADVANCED_FACE('core'"), std::string::npos);
    EXPECT_NE(text.find("COLOUR_RGB("), std::string::npos);
    EXPECT_NE(text.find("PRODUCT('a disc'"), std::string::npos);
    EXPECT_NE(
      text.find(schema == STEPSchema::AP242 ? "AP242" : "AUTOMOTIVE_DESIGN"), std::string::npos);
  }
}

TEST(CADWriter, FailuresSayWhatIsWrong_PropertyOracle)
{
  const TrimmedModel good = SheetWithHoles(2, 0.1, 1, 8);
  const auto expect =
    [](const TrimmedModel& model, const std::string& file, ErrorCode code, const char* words)
  {
    const Status status = WriteCAD(model, file);
    EXPECT_EQ(status.Code, code) << status.Message();
    EXPECT_NE(status.Detail.find(words), std::string::npos) << status.Message();
  };
  const std::string file = OutputFile("wrong.step");
  std::remove(file.c_str());
  expect(good, OutputFile("wrong.obj"), ErrorCode::InvalidParameter, ".step");
  expect(good, OutputFile("no/such/folder/a.step"), ErrorCode::FileError, "No such file");
  expect(good, OutputFile("no/such/folder/a.igs"), ErrorCode::FileError, "No such file");
  expect({}, file, ErrorCode::EmptyInput, "faces");

  TrimmedModel model = good;
  model.Faces[0].Loops[1].Curves[0].UV.array() += 0.9;
  expect(model, file, ErrorCode::OutsideDomain, "edge 4");

  model = good;
  model.Faces[0].Loops[1].Curves[0].Edge = 0;
  expect(model, file, ErrorCode::InvalidTopology, "edge 0");

  model = good;
  model.Faces[0].Surface.Space =
    MakeTensorSpace<2>({ KnotVector::Uniform(2, 2, 0.0, 1.0, 3), KnotVector::Uniform(1, 1) }).Value;
  model.Faces[0].Surface.ControlPoints.setRandom(12, 3);
  expect(model, file, ErrorCode::InvalidKnots, "jumps at the knot 0.5");

  CADWriteParams params;
  params.SewTolerance = 0.0;
  EXPECT_EQ(WriteCAD(good, file, params).Code, ErrorCode::InvalidParameter);
  EXPECT_FALSE(std::ifstream(file)); // nothing is left behind
  EXPECT_FALSE(std::ifstream(OutputFile("wrong-writing.step")));
}

TEST(CADWriter, WhatExistsStaysWhenWritingFails_PropertyOracle)
{
  const std::string file = OutputFile("kept.step");
  ASSERT_TRUE(WriteCAD(SheetWithHoles(2, 0.0, 1, 8), file));
  EXPECT_FALSE(WriteCAD({}, file));
  EXPECT_EQ(CheckCAD(file)->NumFreeLoops, 2);
  ASSERT_TRUE(WriteCAD(SheetWithHoles(2, 0.0, 2, 8), file)); // and is replaced else
  EXPECT_EQ(CheckCAD(file)->NumFreeLoops, 3);
}

TEST(CADCheck, DamagedFilesAreRefused_PropertyOracle)
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
      return CheckCAD(bad).Status.Code;
    };
    EXPECT_EQ(code(text), ErrorCode::Ok);
    EXPECT_EQ(code(""), ErrorCode::EmptyInput);
    EXPECT_EQ(code("hello world\n"), ErrorCode::InvalidFormat);
    EXPECT_EQ(code(std::string(100000, '\0')), ErrorCode::InvalidFormat);
    EXPECT_EQ(code(text.substr(0, text.size() / 2)), ErrorCode::InvalidFormat);
    std::string garbage = text;
    for (std::size_t i = garbage.size() / 4; i < garbage.size() / 2; ++i)
    {
      garbage[i] = static_cast<char>(33 + (i * 7919) % 90);
    }
    EXPECT_NE(code(garbage), ErrorCode::Ok);
    std::remove(bad.c_str());
    EXPECT_EQ(CheckCAD(bad).Status.Code, ErrorCode::FileError);
  }
  EXPECT_EQ(CheckCAD(KNOTWORK_OUTPUT_DIR).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(CheckCAD(OutputFile("x.txt")).Status.Code, ErrorCode::InvalidParameter);
}
