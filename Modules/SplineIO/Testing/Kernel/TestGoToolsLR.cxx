// SPDX-License-Identifier: BSD-3-Clause
#include "FileCases.h"
#include "LRCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/LRDependence.h>
#include <knotwork/SplineIO/GoToolsG2.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
// Bilinear on [0, 2]^2 with unit elements and the line u = 1/2 for v in [0, 1]; coefficients are
// the functions' middle knots along u, so the surface is (u, v) -> u. Records in any order.
const std::string HandWritten = "293 1 0 0\n0 1e-08\n"
                                "4 0 0.5 1 2\n3 0 1 2\n"
                                "4\n1  0 2\n2  0 1  1 0\n1  0 1\n1  0 2\n"
                                "3\n1  0 2\n1  0 1\n1  0 2\n"
                                "10\n"
                                "1 0\n1 1 1\n3 1 2 3\n3 0 0 1\n"
                                "1 0\n0 1 1\n3 0 0 1\n3 0 0 1\n"
                                "1 0\n2 1 1\n3 2 3 3\n3 0 0 1\n"
                                "1 0\n0.5 1 1\n3 0 1 2\n3 0 0 1\n"
                                "1 0\n0 1 1\n3 0 0 2\n3 0 1 2\n"
                                "1 0\n1 1 1\n3 0 2 3\n3 0 1 2\n"
                                "1 0\n2 1 1\n3 2 3 3\n3 0 1 2\n"
                                "1 0\n2 1 1\n3 2 3 3\n3 1 2 2\n"
                                "1 0\n1 1 1\n3 0 2 3\n3 1 2 2\n"
                                "1 0\n0 1 1\n3 0 0 2\n3 1 2 2\n\n";

bool Same(const Spline<2>& a, const Spline<2>& b)
{
  return a.Space->LocallyRefined->Basis == b.Space->LocallyRefined->Basis &&
    a.ControlPoints == b.ControlPoints && a.Weights == b.Weights;
}

ErrorCode CodeOf(const std::string& text)
{
  return ReadG2(text).Status.Code;
}

std::string Replaced(std::string text, const std::string& from, const std::string& to)
{
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string CaseText(const std::string& name)
{
  const char* folder = std::getenv("KNOTWORK_LR_CASES");
  std::ifstream file(std::string(folder ? folder : "") + "/oracle/" + name);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}
}

TEST(GoToolsLR, HandWrittenSurface_GoldenOracle)
{
  const Result<SplineFile> file = ReadG2(HandWritten);
  ASSERT_TRUE(file) << file.Status.Message();
  const auto& surface = std::get<Spline<2>>(file->Splines[0]);
  PointMatrix points(10, 1);
  points << 0, 0.5, 1, 2, 0, 1, 2, 0, 1, 2;
  EXPECT_EQ(surface.ControlPoints, points);
  EXPECT_EQ(surface.Space->NumElements(), 5);
  const auto knots = KnotVector::Uniform(1, 2, 0.0, 2.0);
  Spline<2> same;
  same.Space = MakeTensorSpace<2>({ knots, knots }).Value;
  same.ControlPoints = PointMatrix(9, 1);
  same.ControlPoints << 0, 1, 2, 0, 1, 2, 0, 1, 2;
  EXPECT_TRUE(Same(surface, InsertSegments(same, { { 0, 0.5, 0.0, 1.0 } }, 0).Value));
}

TEST(GoToolsLR, RoundTripsAreExact_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 40; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Spline<2> tensor = RandomClampedSurface(random, 4, 4, random.Int(1, 4), seed % 2 == 0);
    const auto segments = RandomSegments(random, tensor.Space, 8);
    const Result<Spline<2>> surface = InsertSegments(tensor, segments, 0);
    ASSERT_TRUE(surface) << surface.Status.Message();
    const Result<std::string> text = WriteG2({ surface.Value });
    ASSERT_TRUE(text) << text.Status.Message();
    EXPECT_TRUE(LooksLikeG2(text.Value));
    const Result<SplineFile> again = ReadG2(text.Value);
    ASSERT_TRUE(again) << again.Status.Message();
    EXPECT_TRUE(Same(surface.Value, std::get<Spline<2>>(again->Splines[0])));
    EXPECT_EQ(WriteG2(again->Splines).Value, text.Value);
  }
}

TEST(GoToolsLR, BadTextsAreRefused_ExactOracle)
{
  Random random(3);
  const auto knots = KnotVector::Uniform(2, 3, 0.0, 3.0);
  Spline<2> surface;
  surface.Space = MakeTensorSpace<2>({ knots, knots }).Value;
  surface.ControlPoints = PointMatrix::Ones(25, 1);
  surface = InsertSegments(surface, { { 0, 0.5, 0.0, 2.0 } }, 0).Value;
  const std::string good = WriteG2({ surface }).Value;
  ASSERT_EQ(CodeOf(good), ErrorCode::Ok);
  const std::string knotLine = "5 0 0.5 1 2 3\n4 0 1 2 3\n";
  EXPECT_EQ(
    CodeOf(Replaced(good, knotLine, "5 0 1 0.5 2 3\n4 0 1 2 3\n")), ErrorCode::InvalidKnots);
  EXPECT_EQ(CodeOf(Replaced(good, knotLine, "999999999 0 0.5 1 2 3\n4 0 1 2 3\n")),
    ErrorCode::InvalidFormat);
  EXPECT_EQ(CodeOf(Replaced(good, "2  0 1  2 0\n", "2  0 1  7 0\n")), ErrorCode::InvalidFormat);
  EXPECT_EQ(CodeOf(Replaced(good, "2  0 1  2 0\n", "2  1 1  2 0\n")), ErrorCode::InvalidFormat);
  EXPECT_EQ(CodeOf(Replaced(good, "2  0 1  2 0\n", "1  0 0\n")), ErrorCode::InvalidTopology);
  EXPECT_EQ(CodeOf(Replaced(good, "1 1 1\n", "1 0 1\n")), ErrorCode::InvalidWeight);
  EXPECT_EQ(CodeOf(Replaced(good, "1 1 1\n", "1 nan 1\n")), ErrorCode::NonFiniteInput);
  EXPECT_EQ(CodeOf(Replaced(good, "1 1 1\n4 0", "1 1 1\n5 0 0")), ErrorCode::InvalidFormat);
  for (std::size_t size = good.find("293"); size + 4 < good.size(); size += 7)
  {
    EXPECT_NE(CodeOf(good.substr(0, size)), ErrorCode::Ok) << "cut after " << size;
  }
}

/// The surfaces of the reference implementation with its own values at 50 points.
TEST(GoToolsLR, ReferenceSurfaces_GoldenOracle)
{
  for (const char* name : { "lr1_function_biquadratic", "lr2_3d_deg3x2_double_lines",
         "lr3_rational_cylinder_tp", "lr4_rational_cylinder_local", "lr5_linearly_dependent" })
  {
    SCOPED_TRACE(name);
    const std::string text = CaseText(std::string(name) + ".g2");
    if (text.empty())
    {
      GTEST_SKIP() << "KNOTWORK_LR_CASES does not name the folder of the LR cases";
    }
    const Result<SplineFile> file = ReadG2(text);
    ASSERT_TRUE(file) << file.Status.Message();
    const auto& surface = std::get<Spline<2>>(file->Splines[0]);
    EXPECT_EQ(surface.Space->Kind, SpaceKind::LocallyRefined);
    std::istringstream lines(CaseText(std::string(name) + ".eval.txt"));
    int points = 0;
    const BezierForm<2> form = MakeBezierForm(surface);
    for (std::string line; std::getline(lines, line);)
    {
      PointMatrix u(1, 2);
      double x[3];
      if (std::istringstream(line) >> u(0, 0) >> u(0, 1) >> x[0] >> x[1] >> x[2])
      {
        EvaluationBatch batch;
        ASSERT_TRUE(EvaluateParameters(form, u, {}, batch));
        const int c = surface.NumComponents();
        for (int i = 0; i < c; ++i)
        {
          EXPECT_NEAR(batch.Values(0, i), x[c == 1 ? 2 : i], 1e-13) << line;
        }
        ++points;
      }
    }
    EXPECT_GE(points, 50);
    const bool dependent = std::string(name) == "lr5_linearly_dependent";
    const auto resolved = ResolveDependence(surface, MaxResolvingSegments, 0);
    ASSERT_TRUE(resolved) << resolved.Status.Message();
    EXPECT_EQ(resolved->Segments.empty(), !dependent);
    EXPECT_EQ(DecideDependence(*resolved->Value.Space)->Verdict, LRVerdict::Independent);
    Random random(7);
    const PointMatrix some = RandomParameters(random, *surface.Space, 50);
    EvaluationBatch before, after;
    ASSERT_TRUE(EvaluateParameters(form, some, {}, before));
    ASSERT_TRUE(EvaluateParameters(MakeBezierForm(resolved->Value), some, {}, after));
    EXPECT_LE((before.Values - after.Values).cwiseAbs().maxCoeff(), 1e-14);
    const Result<std::string> written = WriteG2(file->Splines);
    ASSERT_TRUE(written) << written.Status.Message();
    const Result<SplineFile> again = ReadG2(written.Value);
    ASSERT_TRUE(again) << again.Status.Message();
    EXPECT_TRUE(Same(surface, std::get<Spline<2>>(again->Splines[0])));
  }
}
