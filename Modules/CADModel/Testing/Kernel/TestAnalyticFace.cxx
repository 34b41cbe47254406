// SPDX-License-Identifier: BSD-3-Clause
// Faces of planes, cylinders, spheres, cones and tori through files.
#include "AnalyticFace.h"
#include "CADCases.h"
#include "OutputFile.h"
#include "ProfiledMeshes.h"
#include <knotwork/CADModel/CADExchange.h>
#include <knotwork/SurfaceTrimming/RegionModel.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

using namespace knotwork;
using knotwork::testing::Pi;

namespace
{
using Types = std::array<int, NumSurfaceTypes>;

struct Solid
{
  const char* Name;
  TriangleMesh Mesh;
  Types Faces; ///< planes, cylinders, spheres, cones, tori, free form
  double Area;
  double Volume;
  std::vector<const char*> Words; ///< of a STEP file
};

/// Half profiles, turned; arcs have 16 chords a quarter.
std::vector<Solid> Solids()
{
  constexpr int sides = 64;
  const double slant = std::sqrt(5.0);
  return {
    { "drum", Turned({ 0, 0 }, { { { 1, 0 } }, { { 1, 2 } }, { { 0, 2 } } }, sides),
      { 2, 1, 0, 0, 0, 0 }, 6.0 * Pi, 2.0 * Pi, { "PLANE", "CYLINDRICAL_SURFACE" } },
    { "tip", Turned({ 0, 0 }, { { { 1, 0 } }, { { 0, 2 } } }, sides), { 1, 0, 0, 1, 0, 0 },
      Pi * (1.0 + slant), 2.0 * Pi / 3.0, { "PLANE", "CONICAL_SURFACE" } },
    { "frustum", Turned({ 0, 0 }, { { { 2, 0 } }, { { 1, 2 } }, { { 0, 2 } } }, sides),
      { 2, 0, 0, 1, 0, 0 }, Pi * (5.0 + 3.0 * slant), 14.0 * Pi / 3.0,
      { "PLANE", "CONICAL_SURFACE" } },
    { "ball", Turned({ 0, -1 }, { { { 0, 1 }, { 0, 0 }, 32 } }, sides), { 0, 0, 1, 0, 0, 0 },
      4.0 * Pi, 4.0 * Pi / 3.0, { "SPHERICAL_SURFACE" } },
    { "half a ball", Turned({ 0, 0 }, { { { 1, 0 } }, { { 0, 1 }, { 0, 0 }, 16 } }, sides),
      { 1, 0, 1, 0, 0, 0 }, 3.0 * Pi, 2.0 * Pi / 3.0, { "PLANE", "SPHERICAL_SURFACE" } },
    { "ring",
      Turned({ 4, 0 },
        { { { 3, 1 }, { 3, 0 }, 16 }, { { 2, 0 }, { 3, 0 }, 16 }, { { 3, -1 }, { 3, 0 }, 16 },
          { { 4, 0 }, { 3, 0 }, 16 } },
        128),
      { 0, 0, 0, 0, 1, 0 }, 12.0 * Pi * Pi, 6.0 * Pi * Pi, { "TOROIDAL_SURFACE" } },
    { "pipe", Turned({ 1, 0 }, { { { 2, 0 } }, { { 2, 3 } }, { { 1, 3 } }, { { 1, 0 } } }, sides),
      { 2, 2, 0, 0, 0, 0 }, 24.0 * Pi, 9.0 * Pi, { "PLANE", "CYLINDRICAL_SURFACE" } },
    { "rounded drum", // outside of the torus
      Turned(
        { 0, 0 }, { { { 2, 0 } }, { { 2, 1 } }, { { 1, 2 }, { 1, 1 }, 16 }, { { 0, 2 } } }, sides),
      { 2, 1, 0, 0, 1, 0 }, Pi * (4.0 + 4.0 + 1.0 + Pi + 2.0),
      Pi * (4.0 + 1.0 + 0.5 * Pi + 2.0 / 3.0),
      { "PLANE", "CYLINDRICAL_SURFACE", "TOROIDAL_SURFACE" } },
    { "fluted drum", // inside of the torus
      Turned({ 0, 0 },
        { { { 3, 0 } }, { { 3, 1 } }, { { 2, 1 } }, { { 1, 2 }, { 2, 2 }, 16 }, { { 1, 2.5 } },
          { { 1, 3 } }, { { 0, 3 } } },
        sides),
      { 3, 2, 0, 0, 1, 0 }, Pi * (9.0 + 6.0 + 5.0 + 2.0 * (Pi - 1.0) + 2.0 + 1.0),
      Pi * (9.0 + 4.0 - Pi + 2.0 / 3.0 + 1.0),
      { "PLANE", "CYLINDRICAL_SURFACE", "TOROIDAL_SURFACE" } },
  };
}

TrimmedModel ModelOf(const TriangleMesh& mesh)
{
  RecognitionParams recognition;
  recognition.MaximumSag = 30.0;
  auto model = ModelMesh(mesh, recognition);
  EXPECT_TRUE(model) << model.Status.Message();
  return std::move(model->Model);
}

Types TypesOf(const TrimmedModel& model)
{
  Types count{};
  for (const TrimmedFace& face : model.Faces)
  {
    ++count[static_cast<std::size_t>(face.Type)];
  }
  return count;
}

std::string TextOf(const std::string& file)
{
  std::ifstream stream(file);
  return { std::istreambuf_iterator<char>(stream), {} };
}

std::string Written(const TrimmedModel& model, const std::string& name)
{
  std::string file = OutputFile(name);
  std::replace(file.begin(), file.end(), ' ', '_');
  const Status written = WriteCAD(model, file);
  EXPECT_TRUE(written) << written.Message();
  const auto found = CheckWrittenCAD(model, file);
  EXPECT_TRUE(found) << found.Status.Message();
  EXPECT_TRUE(found->Valid);
  for (const std::string& defect : found->Defects)
  {
    ADD_FAILURE() << name << ": " << defect;
  }
  return file;
}
}

TEST(AnalyticFace, TypesGoThroughFiles_CrossOracle)
{
  for (const Solid& solid : Solids())
  {
    const TrimmedModel model = ModelOf(solid.Mesh);
    ASSERT_EQ(TypesOf(model), solid.Faces) << solid.Name;
    for (std::size_t f = 0; f < model.Faces.size(); ++f)
    {
      EXPECT_TRUE(AnalyticFace::Find(model.Faces[f])) << solid.Name << ", face " << f;
    }
    for (const char* ending : { ".step", ".igs" })
    {
      SCOPED_TRACE(std::string(solid.Name) + ending);
      const std::string file = Written(model, solid.Name + std::string(ending));
      const auto summary = CheckCAD(file);
      ASSERT_TRUE(summary) << summary.Status.Message();
      EXPECT_TRUE(summary->Closed);
      EXPECT_EQ(summary->NumSolids, 1);
      EXPECT_NEAR(summary->Area, solid.Area, 1e-6 * solid.Area);
      EXPECT_NEAR(summary->Volume, solid.Volume, 1e-6 * solid.Volume);
      const auto read = ReadCAD(file);
      ASSERT_TRUE(read) << read.Status.Message();
      EXPECT_TRUE(read->LeftOut.empty());
      EXPECT_EQ(TypesOf(read->Model), solid.Faces);
      const std::string text = TextOf(file);
      EXPECT_EQ(text.find("B_SPLINE_SURFACE"), std::string::npos);
      for (const char* word : solid.Words)
      {
        EXPECT_TRUE(ending[1] == 'i' || text.find(word) != std::string::npos) << word;
      }
    }
  }
}

/// Waves, extruded and turned. Oracle of the volume: its integral.
TEST(AnalyticFace, ProfilesGoThroughFiles_CrossOracle)
{
  for (const bool turns : { false, true })
  {
    const auto made = ModelMesh(turns ? Vase(48, 64) : WavyBar(48, 2.0), {});
    ASSERT_TRUE(made) << made.Status.Message();
    const TrimmedModel& model = made->Model;
    const Types wanted = turns ? Types{ 2, 0, 0, 0, 0, 0, 0, 1 } : Types{ 5, 0, 0, 0, 0, 0, 1, 0 };
    ASSERT_EQ(TypesOf(model), wanted);
    for (const TrimmedFace& face : model.Faces)
    {
      EXPECT_TRUE(AnalyticFace::Find(face));
    }
    for (const char* ending : { ".step", ".igs" })
    {
      SCOPED_TRACE(std::string(turns ? "vase" : "bar") + ending);
      const std::string file = Written(model, std::string(turns ? "vase" : "bar") + ending);
      const auto summary = CheckCAD(file);
      ASSERT_TRUE(summary) << summary.Status.Message();
      EXPECT_TRUE(summary->Closed);
      EXPECT_EQ(summary->NumSolids, 1);
      const double volume = turns ? Pi * WaveSquares() : 2.0 * WaveArea();
      EXPECT_NEAR(summary->Volume, volume, 1e-3 * volume);
      const auto read = ReadCAD(file);
      ASSERT_TRUE(read) << read.Status.Message();
      EXPECT_EQ(TypesOf(read->Model), wanted);
      const std::string text = TextOf(file);
      EXPECT_EQ(text.find("B_SPLINE_SURFACE"), std::string::npos);
      const char* word = turns ? "SURFACE_OF_REVOLUTION" : "SURFACE_OF_LINEAR_EXTRUSION";
      EXPECT_TRUE(ending[1] == 'i' || text.find(word) != std::string::npos);
    }
    // sheared across, the profile is across the axis no more, and about it turned no more
    TrimmedModel sheared = model;
    for (TrimmedFace& face : sheared.Faces)
    {
      face.Surface.ControlPoints.col(0) += 0.2 * face.Surface.ControlPoints.col(1);
      EXPECT_EQ(AnalyticFace::Find(face).has_value(), face.Type == SurfaceType::Plane);
    }
  }
}

/// Splines that are not what the type says stay splines; planes are planes however they are scaled.
TEST(AnalyticFace, OtherShapesStaySplines_CrossOracle)
{
  const TrimmedModel drum =
    ModelOf(Turned({ 0, 0 }, { { { 1, 0 } }, { { 1, 2 } }, { { 0, 2 } } }, 64));
  for (const double scale : { 1.0 + 1e-12, 1.0 + 1e-6, 1.3 })
  {
    SCOPED_TRACE(scale);
    const bool isRound = scale - 1.0 < 1e-9;
    TrimmedModel model = drum;
    for (TrimmedFace& face : model.Faces)
    {
      face.Surface.ControlPoints.col(0) *= scale;
      for (TrimmedLoop& loop : face.Loops)
      {
        for (TrimmingCurve& use : loop.Curves)
        {
          use.Curve.ControlPoints.col(0) *= scale;
        }
      }
      EXPECT_EQ(AnalyticFace::Find(face).has_value(), isRound || face.Type == SurfaceType::Plane);
    }
    const Types wanted = isRound ? Types{ 2, 1, 0, 0, 0, 0 } : Types{ 2, 0, 0, 0, 0, 1 };
    for (const char* ending : { ".step", ".igs" })
    {
      const std::string file = Written(model, std::string("scaled") + ending);
      const auto read = ReadCAD(file);
      ASSERT_TRUE(read) << read.Status.Message();
      EXPECT_EQ(TypesOf(read->Model), wanted);
      const auto summary = CheckCAD(file);
      ASSERT_TRUE(summary) << summary.Status.Message();
      EXPECT_NEAR(summary->Volume, 2.0 * Pi * scale, 1e-6);
    }
  }
}

/// A quarter of a torus from its outer equator on. Its spline goes on beyond the equator: as a
/// whole it has parameters on both sides.
TEST(AnalyticFace, WhatTheFaceUsesOfATorusCounts_Exact)
{
  TrimmedModel model = ModelOf(
    Turned({ 0, 0 }, { { { 2, 0 } }, { { 2, 1 } }, { { 1, 2 }, { 1, 1 }, 16 }, { { 0, 2 } } }, 64));
  for (TrimmedFace& face : model.Faces)
  {
    if (face.Type == SurfaceType::Torus)
    {
      EXPECT_TRUE(AnalyticFace::Find(face));
      face.Loops.clear(); // the whole spline
      EXPECT_FALSE(AnalyticFace::Find(face));
    }
  }
}

TEST(AnalyticFace, LinesAndCirclesAreFound_Exact)
{
  const TrimmedModel drum =
    ModelOf(Turned({ 0, 0 }, { { { 1, 0 } }, { { 1, 2 } }, { { 0, 2 } } }, 64));
  int lines = 0;
  int circles = 0;
  for (const TrimmedFace& face : drum.Faces)
  {
    for (const TrimmedLoop& loop : face.Loops)
    {
      for (const TrimmingCurve& use : loop.Curves)
      {
        const auto found = FindAnalyticCurve(use.Curve, 1e-7);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->First, 0.0);
        const bool isCircle = found->Curve->IsPeriodic();
        circles += isCircle ? 1 : 0;
        lines += isCircle ? 0 : 1;
        EXPECT_NEAR(found->Last, isCircle ? 2.0 * Pi : 2.0, 1e-7);
      }
    }
  }
  EXPECT_EQ(lines, 2);   // the seam, twice
  EXPECT_EQ(circles, 4); // two, of two faces each
  Spline<1> bent = drum.Faces[0].Loops[0].Curves[0].Curve;
  bent.ControlPoints.col(1) *= 1.2;
  EXPECT_FALSE(FindAnalyticCurve(bent, 1e-7));
}
