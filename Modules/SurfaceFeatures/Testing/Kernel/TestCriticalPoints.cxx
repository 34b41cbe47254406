// SPDX-License-Identifier: BSD-3-Clause
#include "CriticalCases.h"
#include "MergeTrees.h"
#include "ScalarPieces.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/BezierSpace.h>

#include <map>

namespace knotwork::testing
{
namespace
{
/// Random coefficients in a random space: in turn tensor product, hierarchical, locally refined
/// with lines of any multiplicity (slits included); one in three rational.
Spline<2> RandomFunction(Random& random, unsigned family)
{
  const bool rational = random.Int(0, 2) == 0;
  if (family % 3 == 0)
  {
    return RandomSpline<2>(random, RandomTensorSpace<2>(random, 4, 6), 1, rational);
  }
  if (family % 3 == 1)
  {
    return RandomSpline<2>(random, RandomHierarchicalSpace<2>(random, 4, 4, 2), 1, rational);
  }
  const Spline<2> clamped = RandomClampedSurface(random, 4, 4, 1, false);
  const SplineSpacePtr<2> space =
    InsertSegments(clamped.Space, RandomSegments(random, clamped.Space, 8), 0).Value;
  return RandomSpline<2>(random, space, 1, rational);
}

/// Index of a point from values on a small ring about it: 1 - (characteristic of where f is
/// lower).
int RingIndex(const BezierForm<2>& form, const CriticalPoint& point)
{
  const std::vector<int> signs = RingAround(form, point).Signs;
  const int n = static_cast<int>(signs.size());
  int lower = 0;
  int runs = 0;
  for (int i = 0; i < n; ++i)
  {
    const int sign = signs[static_cast<std::size_t>(i)];
    lower += sign < 0 ? 1 : 0;
    runs += sign < 0 && signs[static_cast<std::size_t>((i + n - 1) % n)] >= 0 ? 1 : 0;
  }
  return lower == n ? 1 : 1 - runs;
}
}

TEST(CriticalPoints, RandomSplinesHaveTheIndexOfTheirDomain_PropertyOracle)
{
  std::array<int, 5> places{};
  for (unsigned seed = 1; seed <= 300; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const CriticalPoints found = Find(RandomFunction(random, seed));
    for (const CriticalPoint& point : found.Points)
    {
      ++places[static_cast<std::size_t>(point.Place)];
    }
    EXPECT_TRUE(found.Proved) << Summary(found);
    EXPECT_EQ(found.IndexSum, found.EulerCharacteristic) << Summary(found);
  }
  // all places occur, on smooth edges by chance never
  EXPECT_GT(places[0], 1000);
  EXPECT_GT(places[2], 100);
  EXPECT_GT(places[3], 100);
  EXPECT_GT(places[4], 100);
}

TEST(CriticalPoints, KindsAreThoseOfValuesAround_CrossOracle)
{
  for (unsigned seed = 1; seed <= 40; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Spline<2> f = RandomFunction(random, seed % 2);
    const BezierForm<2> form = MakeBezierForm(f);
    for (const CriticalPoint& point : Find(f).Points)
    {
      EXPECT_EQ(RingIndex(form, point), point.Index)
        << point.Parameters[0] << ", " << point.Parameters[1] << " kind "
        << static_cast<int>(point.Kind) << " place " << static_cast<int>(point.Place);
    }
  }
}

TEST(CriticalPoints, BoxesHoldTheirPointAlone_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 30; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Spline<2> f = RandomFunction(random, seed % 2);
    const BezierForm<2> form = MakeBezierForm(f);
    const CriticalPoints found = Find(f);
    for (const CriticalPoint& a : found.Points)
    {
      for (const CriticalPoint& b : found.Points)
      {
        bool holds = true;
        for (std::size_t d = 0; d < 2; ++d)
        {
          holds = holds && a.Box.Lower[d] <= b.Enclosure.Lower[d] &&
            b.Enclosure.Upper[d] <= a.Box.Upper[d];
        }
        EXPECT_EQ(holds, &a == &b);
      }
      PointMatrix at(1, 2);
      at << a.Parameters[0], a.Parameters[1];
      EvaluationBatch batch;
      ASSERT_TRUE(EvaluateParameters<2>(form, at, {}, batch));
      EXPECT_LE(a.ValueBounds[0], batch.Values(0, 0) + 1e-14);
      EXPECT_GE(a.ValueBounds[1], batch.Values(0, 0) - 1e-14);
      // 64 (p + q + 2) units of 10 and the curvature over the enclosure, twice when rational
      EXPECT_LE(a.ValueBounds[1] - a.ValueBounds[0], 1e-9);
    }
  }
}

TEST(CriticalPoints, JoinsOfSimpleKnotsAreSmooth_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 40; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const int degree = random.Int(2, 5);
    const std::vector<double> breaks{ 0.0, 0.7, 1.1, 2.5, 3.0 };
    SplineSpacePtr<2> space =
      MakeTensorSpace<2>({ BreakKnots(degree, breaks), BreakKnots(2, breaks) }).Value;
    if (seed % 2 == 0)
    {
      for (int step = 0; step < 4; ++step)
      {
        const int e = random.Int(0, space->NumElements() - 1);
        space = RefineElements<2>(space, { e }, { 1, 0, 24 }).Value;
      }
    }
    else
    {
      std::vector<LRSegment> segments = RandomSegments(random, space, 10);
      space = InsertSegments(space, {}, 0).Value;
      for (LRSegment& segment : segments)
      {
        segment.Multiplicity = 1;
        const auto next = InsertSegments(space, { segment }, 0);
        space = next ? next.Value : space; // some needed the multiplicity of others
      }
    }
    Spline<2> f = RandomSpline<2>(random, space, 1, seed % 3 == 0);
    f.ControlPoints.array() += seed % 4 == 0 ? 1e5 : 0.0;
    const auto made = MakeScalarPieces(f, 0, 1);
    ASSERT_TRUE(made);
    double boundary = 0.0;
    for (const PieceJoin& join : made.Value.Joins)
    {
      EXPECT_NE(join.Kind, JoinKind::Crease);
      boundary += join.Kind == JoinKind::Boundary ? join.Along.Width() : 0.0;
    }
    EXPECT_NEAR(boundary, 12.0, 1e-12);
  }
}

TEST(CriticalPoints, LocalRefinementChangesNothing_PropertyOracle)
{
  const Spline<2> coarse =
    PolynomialOn(-2.0, 2.0, 4, 4, { { 0.25, 4, 0 }, { -0.5, 2, 0 }, { 0.5, 0, 2 } });
  const SplineSpacePtr<2> hierarchical =
    RefineElements<2>(coarse.Space, { 5, 6 }, { 2, 0, 24 }).Value;
  const std::vector<LRSegment> segments = { { 0, 0.5, -2.0, 2.0, 1 }, { 1, 0.0, -2.0, 2.0, 2 } };
  for (const Spline<2>& f : { TransferToRefined<2>(coarse, hierarchical).Value,
         InsertSegments(InsertSegments(coarse, {}, 0).Value, segments, 0).Value })
  {
    ASSERT_GT(f.Space->NumElements(), 16);
    const CriticalPoints found = Find(f);
    EXPECT_TRUE(found.Proved) << Summary(found);
    EXPECT_EQ(found.Points.size(), 15u) << Summary(found);
    ExpectPoint(found, 1.0, 0.0, CriticalKind::Minimum, CriticalPlace::Edge, 1);
    ExpectPoint(found, 0.0, 0.0, CriticalKind::Saddle, CriticalPlace::Edge, -1);
    ExpectPoint(found, 2.0, 0.0, CriticalKind::Saddle, CriticalPlace::Boundary, 0);
  }
}

TEST(CriticalPoints, ScalesDoNotMatter_PropertyOracle)
{
  Random random(7);
  const Spline<2> f = RandomSpline<2>(random, RandomTensorSpace<2>(random, 3, 5), 1, false);
  const CriticalPoints expected = Find(f);
  ASSERT_TRUE(expected.Proved);
  const auto compare = [&](const CriticalPoints& found, double size)
  {
    ASSERT_EQ(found.Points.size(), expected.Points.size());
    for (std::size_t i = 0; i < found.Points.size(); ++i)
    {
      EXPECT_EQ(found.Points[i].Kind, expected.Points[i].Kind);
      EXPECT_NEAR(found.Points[i].Parameters[0] / size, expected.Points[i].Parameters[0], 1e-9);
    }
  };
  for (const double scale : { 1e-50, 1e-9, 1e9, 1e50 })
  {
    SCOPED_TRACE(scale);
    Spline<2> g = f;
    g.ControlPoints *= scale;
    compare(Find(g), 1.0);
    std::array<KnotVector, 2> knots;
    for (std::size_t d = 0; d < 2; ++d)
    {
      std::vector<double> t = f.Space->Knots[d].Knots();
      for (double& x : t)
      {
        x *= scale;
      }
      knots[d] = KnotVector::Create(f.Space->Knots[d].Degree(), t).Value;
    }
    g = f;
    g.Space = MakeTensorSpace<2>(knots).Value;
    compare(Find(g), scale);
  }
  Spline<2> high = f; // heights of 1e6 + 10
  high.ControlPoints.array() += 1e6;
  compare(Find(high), 1.0);
}

TEST(CriticalPoints, RationalFormOfAPolynomial_ExactOracle)
{
  // f = u^2 + v^2 / 2 - u v / 4 over the weight 1 + u / 4 + v / 5
  const std::vector<Monomial> weight{ { 1.0, 0, 0 }, { 0.25, 1, 0 }, { 0.2, 0, 1 } };
  const std::vector<Monomial> terms{ { 1.0, 2, 0 }, { 0.5, 0, 2 }, { -0.25, 1, 1 } };
  std::vector<Monomial> product;
  for (const Monomial& a : weight)
  {
    for (const Monomial& b : terms)
    {
      product.push_back({ a.C * b.C, a.A + b.A, a.B + b.B });
    }
  }
  for (const int elements : { 1, 2, 3 })
  {
    SCOPED_TRACE(elements);
    Spline<2> f = PolynomialOn(-1.0, 1.0, 3, elements, product);
    f.Weights = PolynomialOn(-1.0, 1.0, 3, elements, weight).ControlPoints.col(0);
    f.ControlPoints.col(0).array() /= f.Weights.array();
    const CriticalPoints found = Find(f);
    EXPECT_TRUE(found.Proved) << Summary(found);
    ExpectPoint(found, 0.0, 0.0, CriticalKind::Minimum,
      elements == 2 ? CriticalPlace::Edge : CriticalPlace::Interior, 1);
    const CriticalPoint* minimum = At(found, 0.0, 0.0, 1e-12);
    ASSERT_NE(minimum, nullptr);
    EXPECT_NEAR(minimum->Value, 0.0, 1e-13);
    const double radius = std::hypot(0.5, 0.25);
    EXPECT_NEAR(minimum->Eigenvalues[0], 1.5 - radius, 1e-10);
    EXPECT_NEAR(minimum->Eigenvalues[1], 1.5 + radius, 1e-10);
    EXPECT_EQ(found.IndexSum, 1);
  }
}

TEST(CriticalPoints, BezierElementsAreLaidOut_CrossOracle)
{
  // elements of a spline on whole knots without their knots, every other one turned
  Random random(3);
  const KnotVector knots = BreakKnots(3, { 0.0, 1.0, 2.0, 3.0 });
  const Spline<2> f = RandomSpline<2>(random, MakeTensorSpace<2>({ knots, knots }).Value, 1, false);
  const BezierForm<2> form = MakeBezierForm(f);
  std::vector<int> ids;
  PointMatrix points(100, 1);
  for (int e = 0; e < 9; ++e)
  {
    for (int j = 0; j < 4; ++j)
    {
      for (int i = 0; i < 4; ++i)
      {
        const int a = e % 2 == 0 ? i : j;
        const int b = e % 2 == 0 ? j : 3 - i;
        const int id = 3 * (e % 3) + a + 10 * (3 * (e / 3) + b);
        ids.push_back(id);
        points(id, 0) = form.Block(e)[a + 4 * b];
      }
    }
  }
  Spline<2> bezier;
  bezier.Space = MakeBezierSpace<2>(std::vector<IntArray<2>>(9, { 3, 3 }), ids, 100).Value;
  bezier.ControlPoints = points;
  const CriticalPoints expected = Find(f);
  const CriticalPoints found = Find(bezier);
  EXPECT_TRUE(found.Proved) << Summary(found);
  ASSERT_EQ(found.Points.size(), expected.Points.size());
  for (std::size_t i = 0; i < found.Points.size(); ++i)
  {
    const CriticalPoint& point = found.Points[i];
    const int e = point.Element;
    const double s = point.Parameters[0];
    const double t = point.Parameters[1];
    const CriticalPoint* same =
      At(expected, e % 3 + (e % 2 == 0 ? s : t), e / 3 + (e % 2 == 0 ? t : 1.0 - s), 1e-11);
    ASSERT_NE(same, nullptr);
    EXPECT_EQ(same->Kind, point.Kind);
    EXPECT_EQ(same->Place, point.Place);
    EXPECT_LE(point.Box.Lower[0], s);
    EXPECT_GE(point.Box.Upper[1], t);
  }
}

TEST(CriticalPoints, AnyNumberOfThreads_PropertyOracle)
{
  Random random(11);
  const Spline<2> f = RandomSpline<2>(random, RandomHierarchicalSpace<2>(random, 3, 9, 3), 1, true);
  CriticalPointParams params;
  params.Threads = 1;
  const CriticalPoints one = Find(f, params);
  for (const int threads : { 2, 4 })
  {
    params.Threads = threads;
    const CriticalPoints many = Find(f, params);
    ASSERT_EQ(one.Points.size(), many.Points.size());
    EXPECT_EQ(one.NumTested, many.NumTested);
    for (std::size_t i = 0; i < one.Points.size(); ++i)
    {
      EXPECT_EQ(one.Points[i].Parameters, many.Points[i].Parameters);
      EXPECT_EQ(one.Points[i].Box.Lower, many.Points[i].Box.Lower);
      EXPECT_EQ(one.Points[i].Value, many.Points[i].Value);
    }
  }
}

TEST(CriticalPoints, EveryFailureIsReachable_ExactOracle)
{
  const Spline<2> f = PolynomialOn(0.0, 1.0, 2, 2, { { 1.0, 2, 0 }, { 1.0, 0, 1 } });
  const auto code = [](const Spline<2>& spline, const CriticalPointParams& params)
  { return FindCriticalPoints(spline, params).Status.Code; };
  CriticalPointParams params;
  params.Component = 1;
  EXPECT_EQ(code(f, params), ErrorCode::InvalidParameter);
  params = {};
  params.MaxDepth = 51;
  EXPECT_EQ(code(f, params), ErrorCode::InvalidParameter);
  params = {};
  params.MaxBoxes = 3;
  EXPECT_EQ(code(f, params), ErrorCode::InvalidParameter);
  params = {};
  params.Progress = [](double) { return false; };
  EXPECT_EQ(code(f, params), ErrorCode::Aborted);
  Spline<2> bad = f;
  bad.ControlPoints(3, 0) = std::nan("");
  EXPECT_EQ(code(bad, {}), ErrorCode::NonFiniteInput);
  bad = f;
  bad.ControlPoints.conservativeResize(3, 1);
  EXPECT_EQ(code(bad, {}), ErrorCode::SizeMismatch);
  // four bilinear elements in a ring: 0 1 | 2 3 | 4 5 | 6 7
  Spline<2> tube;
  tube.Space = MakeBezierSpace<2>(
    std::vector<IntArray<2>>(4, { 1, 1 }), { 0, 2, 1, 3, 2, 4, 3, 5, 4, 6, 5, 7, 6, 0, 7, 1 }, 8)
                 .Value;
  tube.ControlPoints = PointMatrix::Random(8, 1);
  EXPECT_EQ(code(tube, {}), ErrorCode::InvalidTopology);
}
}
