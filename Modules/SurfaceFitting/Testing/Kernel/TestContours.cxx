// SPDX-License-Identifier: BSD-3-Clause
#include "BezierSpace.h"
#include "ContourCases.h"

#include <limits>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
ContourSet Trace(const Spline<2>& surface, const std::vector<double>& levels, double tolerance)
{
  ContourParams params;
  params.Levels = levels;
  params.Tolerance = tolerance;
  const BezierForm<2> form = MakeBezierForm(surface);
  const auto result = TraceContours(form, params);
  EXPECT_TRUE(result) << result.Status.Message();
  const ContourSet& contours = result.Value;
  EXPECT_TRUE(contours.Undecided.empty()) << contours.Undecided.size();
  EXPECT_LE(contours.MaxError, tolerance);
  EXPECT_LE(SampledError(form, contours), contours.MaxError + 1e-15);
  if (surface.Space->HasDomain)
  {
    EXPECT_TRUE(EndsOnBorder(*surface.Space, contours));
  }
  return contours;
}

/// Expects the number of components and of closed ones over meshes of every kind.
void ExpectCounts(const SquarePolynomial& f, double level, int components, int closed,
  double tolerance = 1e-4, const std::vector<MeshKind>& kinds = MeshKinds)
{
  for (MeshKind kind : kinds)
  {
    for (unsigned seed = 1; seed <= 3; ++seed)
    {
      SCOPED_TRACE("mesh " + std::to_string(static_cast<int>(kind)) + " seed " +
        std::to_string(seed) + " level " + std::to_string(level));
      const ContourSet contours =
        Trace(OverMesh(SquareSurface(f), kind, seed), { level }, tolerance);
      EXPECT_EQ(contours.NumComponents[0], components);
      EXPECT_EQ(contours.NumClosed[0], closed);
    }
  }
}
}

TEST(Contours, ACircleIsOneLoop_ExactOracle)
{
  const SquarePolynomial f = Circle(0.1, -0.2, 0.5);
  ExpectCounts(f, 0.0, 1, 1);
  for (MeshKind kind : MeshKinds)
  {
    const Spline<2> surface = OverMesh(SquareSurface(f), kind);
    const ContourSet contours = Trace(surface, { 0.0 }, 1e-6);
    const BezierForm<2> form = MakeBezierForm(surface);
    EvaluationBatch batch;
    ASSERT_TRUE(EvaluateElements<2>(form, contours.Elements, contours.Local, {}, batch));
    // area of the polygon: the circle's but for what the tolerance allows; the upper set (outside)
    // on the left means a negative sign. |f - level| <= 1e-6 is a distance of 1e-6 / 0.9.
    double area = 0.0;
    const Eigen::Index n = batch.Values.rows();
    for (Eigen::Index i = 0; i < n; ++i)
    {
      const auto a = batch.Values.row(i);
      const auto b = batch.Values.row((i + 1) % n);
      area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    }
    EXPECT_NEAR(area, -M_PI * 0.25, 1.2e-6 * M_PI) << static_cast<int>(kind);
  }
}

TEST(Contours, LoopsSmallerThanAnElementAreFound_ExactOracle)
{
  for (double radius : { 1e-1, 1e-2, 1e-3, 1e-4, 1e-5 })
  {
    ExpectCounts(Circle(0.123456, -0.3217, radius), 0.0, 1, 1);
    if (radius >= 1e-3) // else the product is rounding
    {
      ExpectCounts(
        Circle(0.123456, -0.3217, radius) * Circle(0.123456 + 3.0 * radius, -0.3217, radius), 0.0,
        2, 2);
    }
    // its centre is a corner of elements, then the middle of a side
    ExpectCounts(Circle(0.5, -0.5, radius), 0.0, 1, 1);
    ExpectCounts(Circle(0.5, -0.25, radius), 0.0, 1, 1);
  }
}

TEST(Contours, SaddlesSeparateOnTheRightSide_ExactOracle)
{
  const SquarePolynomial straight = Conic(0.0, 1.0, 0.0, 0.0, 0.0, 0.0);
  const SquarePolynomial shifted = Conic(0.0, 1.0, 0.0, -0.217, 0.331, -0.217 * 0.331);
  for (double level : { 1e-3, 1e-6, 1e-9, 1e-12, -1e-12, -1e-9, -1e-6 })
  {
    for (const SquarePolynomial& f : { straight, shifted })
    {
      ExpectCounts(f, level, 2, 0);
    }
    // the branches of xy = level lie in quadrants one and three, or two and four
    const ContourSet contours = Trace(SquareSurface(straight), { level }, 1e-14 + 1e-4);
    for (Eigen::Index i = 0; i < contours.Parameters.rows(); ++i)
    {
      EXPECT_GT(contours.Parameters(i, 0) * contours.Parameters(i, 1) * level, 0.0);
    }
  }
}

TEST(Contours, WhatLiesOnTheLevelIsAbove_ExactOracle)
{
  // a saddle on the level joins the upper quadrants: two branches in the lower ones
  ExpectCounts(Conic(0.0, 1.0, 0.0, 0.0, 0.0, 0.0), 0.0, 2, 0);
  const ContourSet saddle = Trace(SquareSurface(Conic(0, 1, 0, 0, 0, 0)), { 0.0 }, 1e-4);
  for (Eigen::Index i = 0; i < saddle.Parameters.rows(); ++i)
  {
    EXPECT_LT(saddle.Parameters(i, 0) * saddle.Parameters(i, 1), 0.0);
  }
  // an isolated minimum is nothing, an isolated maximum a tiny loop
  ExpectCounts(Circle(0.0, 0.0, 0.0), 0.0, 0, 0);
  ExpectCounts(Circle(0.317, 0.218, 0.0), 0.0, 0, 0);
  ExpectCounts(Conic(-1.0, 0.0, -1.0, 0.0, 0.0, 0.0), 0.0, 1, 1);
  // the whole surface on the level: above, no contour
  ExpectCounts(Conic(0.0, 0.0, 0.0, 0.0, 0.0, 0.5), 0.5, 0, 0);
  ExpectCounts(Conic(0.0, 0.0, 0.0, 0.0, 0.0, 0.1), 0.1, 0, 0);
  // a level along lines between elements
  ExpectCounts(Conic(0.0, 0.0, 0.0, 1.0, 0.0, 0.0), 0.0, 1, 0);
  ExpectCounts(Conic(0.0, 0.0, 0.0, 1.0, 1.0, 0.0), 0.0, 1, 0);
  ExpectCounts(Conic(0.0, 0.0, 0.0, 1.0, 0.0, 0.0), -1.0, 0, 0);
  // a circle that touches the border from inside, and one through the corners
  ExpectCounts(Circle(0.0, 0.0, 1.0), 0.0, 1, 1);
  ExpectCounts(Conic(-1.0, 0.0, -1.0, 0.0, 0.0, 1.0), 0.0, 4, 0);
  ExpectCounts(Circle(0.0, 0.0, std::sqrt(2.0)), 1e-9, 0, 0);
  ExpectCounts(Circle(0.0, 0.0, std::sqrt(2.0)), -1e-9, 4, 0);
}

TEST(Contours, CassiniOvalsAroundTheCriticalLevel_ExactOracle)
{
  // |z - a|^2 |z + a|^2 = a^4 + level: one oval above, two below
  const double a = 0.5;
  const SquarePolynomial f = Circle(a, 0.0, 0.0) * Circle(-a, 0.0, 0.0);
  const double critical = a * a * a * a;
  for (double distance : { 1e-2, 1e-5, 1e-8, 1e-11 })
  {
    ExpectCounts(f, critical + distance, 1, 1);
    ExpectCounts(f, critical - distance, 2, 2);
  }
}

TEST(Contours, FourLeavesAndRings_ExactOracle)
{
  // (x^2 + y^2)^3 - 4 r x^2 y^2: four leaves that meet in the origin
  const SquarePolynomial square = Circle(0.0, 0.0, 0.0);
  SquarePolynomial leaves = square * square * square;
  const SquarePolynomial cross = Conic(0.0, 1.0, 0.0, 0.0, 0.0, 0.0);
  const SquarePolynomial flat = cross * cross; // of degree 4
  const std::vector<double> raised = BernsteinElevate<2>(flat.Degree, flat.Coefficients, { 6, 6 });
  for (std::size_t k = 0; k < raised.size(); ++k)
  {
    leaves.Coefficients[k] -= 2.0 * raised[k];
  }
  ExpectCounts(leaves, -1e-4, 4, 4);
  ExpectCounts(leaves, -1e-8, 4, 4);
  ExpectCounts(leaves, 1e-6, 1, 1);
  const SquarePolynomial rings = Circle(0.0, 0.0, 0.5) * Circle(0.0, 0.0, 0.502) *
    Circle(0.0, 0.0, 0.3) * Circle(0.02, 0.01, 0.1);
  ExpectCounts(rings, 0.0, 4, 4, 1e-6);
}

TEST(Contours, SeveralLevelsAreTheOnesAlone_PropertyOracle)
{
  const Spline<2> surface = OverMesh(SquareSurface(Circle(0.3, 0.2, 0.0)), MeshKind::Hierarchical);
  const std::vector<double> levels{ 0.5, 0.01, 0.1, 0.1, 1e-7 };
  const ContourSet together = Trace(surface, levels, 1e-5);
  EXPECT_EQ(together.Levels, (std::vector<double>{ 1e-7, 0.01, 0.1, 0.5 }));
  std::size_t points = 0;
  for (double level : together.Levels)
  {
    const ContourSet alone = Trace(surface, { level }, 1e-5);
    for (Eigen::Index i = 0; i < alone.Local.rows(); ++i)
    {
      EXPECT_EQ(alone.Local.row(i), together.Local.row(static_cast<Eigen::Index>(points) + i));
    }
    points += alone.Elements.size();
  }
  EXPECT_EQ(points, together.Elements.size());
}

TEST(Contours, RandomSplinesHaveTheContoursOfADenseGrid_CrossOracle)
{
  int compared = 0;
  for (unsigned seed = 1; seed <= 60; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    Spline<2> surface;
    const bool rational = seed % 3 == 0;
    if (seed % 2 == 0)
    {
      surface = RandomSpline<2>(random, RandomHierarchicalSpace<2>(random, 4, 5, 2), 1, rational);
    }
    else
    {
      surface = RandomClampedSurface(random, 4, 4, 1, rational);
      surface = RandomSpline<2>(random,
        InsertSegments(surface.Space, RandomSegments(random, surface.Space, 10)).Value, 1,
        rational);
    }
    bool jumps = false;
    const BezierForm<2> form = MakeBezierForm(surface);
    if (surface.Space->LocallyRefined)
    {
      for (int d = 0; d < 2; ++d)
      {
        for (const LRLine& line :
          surface.Space->LocallyRefined->Basis.Lines[static_cast<std::size_t>(d)])
        {
          for (const LRPiece& piece : line)
          {
            jumps |= piece.Multiplicity >
                surface.Space->LocallyRefined->Basis.Degree[static_cast<std::size_t>(d)] &&
              &line !=
                &surface.Space->LocallyRefined->Basis.Lines[static_cast<std::size_t>(d)].front() &&
              &line !=
                &surface.Space->LocallyRefined->Basis.Lines[static_cast<std::size_t>(d)].back();
          }
        }
      }
    }
    const double level = seed % 5 == 0 ? surface.ControlPoints(0, 0) : random.In(-5.0, 5.0);
    ContourParams params;
    params.Levels = { level };
    params.Tolerance = 1e-3;
    const auto result = TraceContours(form, params);
    ASSERT_TRUE(result) << result.Status.Message();
    EXPECT_TRUE(result->Undecided.empty());
    EXPECT_LE(result->MaxError, 1e-3);
    EXPECT_LE(SampledError(form, result.Value), result->MaxError * (1 + 1e-9));
    if (jumps)
    {
      continue;
    }
    EXPECT_TRUE(EndsOnBorder(*surface.Space, result.Value));
    const int coarse = CountGridContours(GridValues(form, 201), level);
    const int fine = CountGridContours(GridValues(form, 403), level);
    if (coarse == fine)
    {
      ++compared;
      EXPECT_EQ(result->NumComponents[0], fine);
    }
  }
  EXPECT_GE(compared, 30);
}

TEST(Contours, ThreadsDoNotMatter_PropertyOracle)
{
  Random random(7);
  const Spline<2> surface =
    RandomSpline<2>(random, RandomHierarchicalSpace<2>(random, 3, 12, 5), 3, true);
  const BezierForm<2> form = MakeBezierForm(surface);
  ContourParams params;
  params.NumLevels = 7;
  params.Threads = 1;
  const auto one = TraceContours(form, params);
  ASSERT_TRUE(one);
  EXPECT_GT(one->Elements.size(), 100u);
  for (int threads : { 2, 4, 0 })
  {
    params.Threads = threads;
    const auto more = TraceContours(form, params);
    ASSERT_TRUE(more);
    EXPECT_EQ(one->Local, more->Local);
    EXPECT_EQ(one->Elements, more->Elements);
    EXPECT_EQ(one->NumComponents, more->NumComponents);
    EXPECT_EQ(one->MaxError, more->MaxError);
  }
}
