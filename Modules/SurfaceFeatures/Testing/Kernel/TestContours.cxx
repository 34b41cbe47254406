// SPDX-License-Identifier: BSD-3-Clause
#include "ContourCases.h"
#include <knotwork/SplineCore/BezierSpace.h>
#include <knotwork/SurfaceFeatures/ContourCurves.h>

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
  EXPECT_LE(LargestBreak(form, contours), 1e-9); // points nearer than 1e-10 of an element are one
  if (surface.Space->HasDomain())
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
        InsertSegments(surface.Space, RandomSegments(random, surface.Space, 10), 0).Value, 1,
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

namespace
{
/// A torus of radii 2 and 1 around the z axis as a rational biquadratic surface.
Spline<2> Torus()
{
  const double s = std::sqrt(0.5);
  const double x[9] = { 1, 1, 0, -1, -1, -1, 0, 1, 1 };
  const double y[9] = { 0, 1, 1, 1, 0, -1, -1, -1, 0 };
  std::vector<double> knots{ 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4 };
  const KnotVector k = KnotVector::Create(2, knots).Value;
  Spline<2> torus;
  torus.Space = MakeTensorSpace<2>({ k, k }).Value;
  torus.ControlPoints.resize(81, 3);
  torus.Weights.resize(81);
  for (int j = 0, n = 0; j < 9; ++j)
  {
    for (int i = 0; i < 9; ++i, ++n)
    {
      const double r = 2.0 + x[j];
      torus.ControlPoints.row(n) << r * x[i], r * y[i], y[j];
      torus.Weights[n] = (i % 2 ? s : 1.0) * (j % 2 ? s : 1.0);
    }
  }
  return torus;
}
}

TEST(Contours, ClosedSurfacesHaveClosedContours_ExactOracle)
{
  const Spline<2> torus = Torus();
  const BezierForm<2> form = MakeBezierForm(torus);
  ContourParams params;
  params.NumSpaceComponents = 3;
  params.Tolerance = 1e-5;
  // z: two circles; x: two loops outside of the hole, one loop above the waist; near its saddles
  const std::vector<std::pair<int, std::vector<std::pair<double, int>>>> cases{
    { 2, { { 0.5, 2 }, { -0.999, 2 }, { 0.0, 2 } } },
    { 0, { { 0.3, 2 }, { 0.999999, 2 }, { 1.000001, 1 }, { 2.9, 1 }, { -1.5, 1 } } }
  };
  for (const auto& [component, levels] : cases)
  {
    for (const auto& [level, count] : levels)
    {
      SCOPED_TRACE(std::to_string(component) + " = " + std::to_string(level));
      params.Component = component;
      params.Levels = { level };
      params.JoinSeams = true;
      const auto joined = TraceContours(form, params);
      ASSERT_TRUE(joined) << joined.Status.Message();
      EXPECT_EQ(joined->NumComponents[0], count);
      EXPECT_EQ(joined->NumClosed[0], count);
      EXPECT_LE(SampledError(form, joined.Value, component), 1e-5);
      EXPECT_LE(LargestBreak(form, joined.Value), 1e-9);
      params.JoinSeams = false;
      const auto open = TraceContours(form, params);
      ASSERT_TRUE(open);
      EXPECT_GT(open->NumComponents[0], open->NumClosed[0]);
    }
  }
}

TEST(Contours, ContoursEndAtJumps_ExactOracle)
{
  // value = u on [0, 1) and u + 1 on [1, 2], times v-independent: one line a level, none between
  const KnotVector u = KnotVector::Create(1, { 0, 0, 1, 1, 2, 2 }).Value;
  const KnotVector v = KnotVector::Create(1, { 0, 0, 1, 1 }).Value;
  Spline<2> surface;
  surface.Space = MakeTensorSpace<2>({ u, v }).Value;
  surface.ControlPoints.resize(8, 3);
  const double x[4] = { 0, 1, 1, 2 };
  // slanted on the left, so that the level 0.5 meets the jump
  const double left[2][4] = { { 0, 1, 2, 3 }, { -1, 0, 2, 3 } };
  for (int j = 0; j < 2; ++j)
  {
    for (int i = 0; i < 4; ++i)
    {
      surface.ControlPoints.row(4 * j + i) << x[i], j, left[j][i];
    }
  }
  const BezierForm<2> form = MakeBezierForm(surface);
  ContourParams params;
  params.Levels = { 0.5, 1.5, 2.5 };
  params.Tolerance = 1e-6;
  const auto contours = TraceContours(form, params);
  ASSERT_TRUE(contours) << contours.Status.Message();
  EXPECT_EQ(contours->NumComponents, (std::vector<int>{ 1, 0, 1 }));
  EXPECT_EQ(contours->NumClosed, (std::vector<int>{ 0, 0, 0 }));
  const ContourComponent& first = contours->Components[0];
  std::set<double> ends{ contours->Parameters(0, 0),
    contours->Parameters(static_cast<Eigen::Index>(first.NumPoints) - 1, 0) };
  EXPECT_EQ(*ends.rbegin(), 1.0);
}

TEST(Contours, ChordsKeepNearTheSurfaceInSpace_PropertyOracle)
{
  const BezierForm<2> form = MakeBezierForm(Torus());
  ContourParams params;
  params.NumSpaceComponents = 3;
  params.Component = 2;
  params.Levels = { 0.3 };
  params.Tolerance = 0.1;
  const auto coarse = TraceContours(form, params);
  params.ChordTolerance = 1e-4;
  const auto fine = TraceContours(form, params);
  ASSERT_TRUE(coarse && fine);
  for (const bool isFine : { false, true })
  {
    const ContourSet& contours = isFine ? fine.Value : coarse.Value;
    EvaluationBatch ends[3];
    const PointMatrix middle = 0.5 * (contours.Local + contours.PieceEnds);
    ASSERT_TRUE(EvaluateElements<2>(form, contours.Elements, contours.Local, {}, ends[0]));
    ASSERT_TRUE(EvaluateElements<2>(form, contours.Elements, contours.PieceEnds, {}, ends[1]));
    ASSERT_TRUE(EvaluateElements<2>(form, contours.Elements, middle, {}, ends[2]));
    const double distance =
      (0.5 * (ends[0].Values + ends[1].Values) - ends[2].Values).rowwise().norm().maxCoeff();
    EXPECT_EQ(distance <= 1e-4, isFine) << distance;
  }
}

TEST(Contours, SplineCurvesKeepTheTolerance_PropertyOracle)
{
  const auto check = [](const Spline<2>& surface, int component, double level, double space)
  {
    const BezierForm<2> form = MakeBezierForm(surface);
    ContourParams params;
    params.NumSpaceComponents = 3;
    params.Component = component;
    params.Levels = { level };
    params.Tolerance = 1e-5;
    params.ChordTolerance = space;
    const auto contours = TraceContours(form, params);
    ASSERT_TRUE(contours) << contours.Status.Message();
    const auto curves = FitContourCurves(form, contours.Value, params);
    ASSERT_TRUE(curves);
    ASSERT_EQ(curves->size(), contours->Components.size());
    std::size_t pieces = 0;
    for (const ContourCurve& curve : curves.Value)
    {
      ASSERT_TRUE(curve.Curve.Check());
      EXPECT_LE(curve.MaxError, 1e-5);
      const BezierForm<1> line = MakeBezierForm(curve.Curve);
      pieces += static_cast<std::size_t>(curve.Curve.Space->NumElements());
      std::vector<int> elements;
      std::vector<double> local;
      for (int e = 0; e < curve.Curve.Space->NumElements(); ++e)
      {
        for (int k = 0; k <= 16; ++k)
        {
          elements.push_back(e);
          local.push_back(k / 16.0);
        }
      }
      EvaluationBatch on;
      const Eigen::Map<const PointMatrix> at(
        local.data(), static_cast<Eigen::Index>(local.size()), 1);
      ASSERT_TRUE(EvaluateElements<1>(line, elements, at, {}, on));
      const ParametricBox<2> box = surface.Space->Domain();
      PointMatrix uv = on.Values.leftCols(2);
      for (Eigen::Index i = 0; i < uv.size(); ++i)
      {
        const std::size_t d = static_cast<std::size_t>(i % 2);
        uv.data()[i] = std::clamp(uv.data()[i], box.Lower[d], box.Upper[d]);
      }
      EvaluationBatch there;
      ASSERT_TRUE(EvaluateParameters<2>(form, uv, {}, there));
      EXPECT_LE(
        (there.Values.col(component).array() - level).abs().maxCoeff(), curve.MaxError + 1e-12);
      const double distance =
        (there.Values.leftCols(3) - on.Values.rightCols(3)).rowwise().norm().maxCoeff();
      EXPECT_LE(distance, curve.SpaceDistance + 1e-12);
      if (contours->Components[static_cast<std::size_t>(curve.Component)].Closed)
      {
        EXPECT_EQ(curve.Curve.ControlPoints.row(0).tail(3),
          curve.Curve.ControlPoints.bottomRows(1).row(0).tail(3));
      }
    }
    EXPECT_LT(2 * pieces, contours->Elements.size()); // worth it
  };
  check(OverMesh(SquareSurface(Circle(0.1, 0.2, 0.3)), MeshKind::LocallyRefined), 2, 0.0, 0.0);
  check(
    OverMesh(SquareSurface(Circle(0.1, 0.2, 0.0) * Circle(-0.3, 0.2, 0.0)), MeshKind::Hierarchical),
    2, 0.01, 0.0);
  check(Torus(), 2, 0.3, 1e-4);
  check(Torus(), 0, 1.1, 1e-4);
}

TEST(Contours, AFlatMaximumOnTheLevelStaysUndecided_ExactOracle)
{
  // -(x + y / 2 - 0.1)^2 = 0 is a line; a strip of width 2^-22 would take 4 million cells
  const Spline<2> surface = SquareSurface(Conic(-1.0, -1.0, -0.25, 0.2, 0.1, -0.01));
  ContourParams params;
  params.Levels = { 0.0 };
  params.Tolerance = 1e-4;
  params.MaxCells = 512;
  const auto contours = TraceContours(MakeBezierForm(surface), params);
  ASSERT_TRUE(contours);
  ASSERT_FALSE(contours->Undecided.empty());
  for (const UndecidedBox& box : contours->Undecided)
  {
    // the line passes every box that is left
    const double low = box.Box.Lower[0] + 0.5 * box.Box.Lower[1] - 0.1;
    const double high = box.Box.Upper[0] + 0.5 * box.Box.Upper[1] - 0.1;
    EXPECT_LE(low, 1e-6);
    EXPECT_GE(high, -1e-6);
  }
  params.Levels = { -1e-4 };
  params.MaxCells = 65536;
  EXPECT_TRUE(TraceContours(MakeBezierForm(surface), params)->Undecided.empty());
}

TEST(Contours, MorePointsThanTheLimitAreRefusedForAnyThreads_PropertyOracle)
{
  const BezierForm<2> form = MakeBezierForm(SquareSurface(Circle(0.0, 0.0, 0.5)));
  ContourParams params;
  params.Levels = { -0.2, -0.1, 0.0, 0.1, 0.2 };
  params.Tolerance = 1e-7;
  const auto all = TraceContours(form, params);
  ASSERT_TRUE(all);
  const auto count = static_cast<int>(all->Parameters.rows());
  EXPECT_GE(count, 1000);
  // ends of paths on sides of elements are counted twice
  for (const int percent : { 1, 50, 95, 100, 105, 200 })
  {
    params.MaxPoints = count * percent / 100;
    params.Threads = 1;
    const Status one = TraceContours(form, params).Status;
    for (const int threads : { 2, 4 })
    {
      params.Threads = threads;
      EXPECT_EQ(TraceContours(form, params).Status.Message(), one.Message()) << percent;
    }
    EXPECT_EQ(one.Code, percent < 100 ? ErrorCode::TooLarge : one.Code) << percent;
    EXPECT_TRUE(percent < 200 || one) << one.Message();
  }
  // what would take hours and all memory ends at once
  params.Tolerance = 1e-12;
  params.ChordTolerance = 1e-14;
  params.Levels = ContourLevels({ -0.2, 0.3 }, 10000);
  params.MaxPoints = 20000;
  EXPECT_EQ(TraceContours(form, params).Status.Code, ErrorCode::TooLarge);
}

TEST(Contours, EveryFailureIsReachable_ExactOracle)
{
  const Spline<2> surface = SquareSurface(Circle(0.0, 0.0, 0.5));
  const BezierForm<2> form = MakeBezierForm(surface);
  const auto code = [](const BezierForm<2>& f, const ContourParams& params)
  { return TraceContours(f, params).Status.Code; };
  const auto with = [&](const std::function<void(ContourParams&)>& change)
  {
    ContourParams params;
    change(params);
    return code(form, params);
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code({}, {}), ErrorCode::EmptyInput);
  EXPECT_EQ(with([](ContourParams&) {}), ErrorCode::Ok);
  EXPECT_EQ(with([](ContourParams& p) { p.Component = 3; }), ErrorCode::DimensionMismatch);
  EXPECT_EQ(with([](ContourParams& p) { p.NumSpaceComponents = 4; }), ErrorCode::DimensionMismatch);
  EXPECT_EQ(with([](ContourParams& p) { p.Levels = { nan }; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](ContourParams& p) { p.NumLevels = 0; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](ContourParams& p) { p.Tolerance = -1.0; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](ContourParams& p) { p.Tolerance = nan; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](ContourParams& p) { p.Tolerance = 1e-15; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](ContourParams& p) { p.ChordTolerance = -1.0; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](ContourParams& p) { p.MaxCells = 1; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](ContourParams& p) { p.MaxPoints = 0; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](ContourParams& p) { p.MaxPoints = 1; }), ErrorCode::TooLarge);
  for (int stop = 0; stop < 5; ++stop)
  {
    int calls = 0;
    EXPECT_EQ(with([&](ContourParams& p) { p.Progress = [&](double) { return calls++ < stop; }; }),
      stop < 4 ? ErrorCode::Aborted : ErrorCode::Ok)
      << stop;
  }
  BezierForm<2> bad = form;
  bad.Data[20] = nan;
  EXPECT_EQ(code(bad, {}), ErrorCode::NonFiniteInput);
  bad.Data[20] = 1e300;
  EXPECT_EQ(code(bad, {}), ErrorCode::NonFiniteInput);
  const auto set = TraceContours(form, {});
  ContourParams params;
  params.Component = 7;
  EXPECT_EQ(FitContourCurves(form, set.Value, params).Status.Code, ErrorCode::DimensionMismatch);
}

TEST(Contours, LevelsDivideTheRangeOfTheCorners_GoldenOracle)
{
  const BezierForm<2> form =
    MakeBezierForm(SquareSurface(Conic(0.0, 0.0, 0.0, 1.0, 2.0, 0.0))); // -3 to 3
  EXPECT_EQ(CornerRange(form, 2), (std::array<double, 2>{ -3.0, 3.0 }));
  EXPECT_EQ(ContourLevels({ -3.0, 3.0 }, 3), (std::vector<double>{ -1.5, 0.0, 1.5 }));
  ContourParams params;
  params.NumLevels = 3;
  EXPECT_EQ(TraceContours(form, params)->Levels, (std::vector<double>{ -1.5, 0.0, 1.5 }));
  EXPECT_EQ(TraceContours(form, params)->Tolerance, 1e-4 * 6.0);
}
