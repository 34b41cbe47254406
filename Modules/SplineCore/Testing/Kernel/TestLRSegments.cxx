// SPDX-License-Identifier: BSD-3-Clause
// Mesh line segments as a user has them: in any order, in parts, twice.
#include "LRCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/LRDependence.h>
#include <knotwork/SplineCore/Refinement.h>

#include <algorithm>
#include <limits>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
constexpr int NoLimit = std::numeric_limits<int>::max();

/// The segments in a random order, some twice, some in parts that overlap or touch.
std::vector<LRSegment> Disordered(Random& random, const std::vector<LRSegment>& segments)
{
  std::vector<LRSegment> parts;
  for (const LRSegment& segment : segments)
  {
    const double choice = random.Unit();
    if (choice < 0.4)
    {
      LRSegment first = segment;
      LRSegment second = segment;
      const double length = segment.End - segment.Start;
      second.Start += random.In(0.2, 0.5) * length;
      first.End = choice < 0.2 ? second.Start : segment.End - random.In(0.2, 0.4) * length;
      parts.insert(parts.end(), { first, second });
      continue;
    }
    parts.insert(parts.end(), choice < 0.6 ? 2 : 1, segment);
  }
  for (std::size_t i = parts.size(); i > 1; --i)
  {
    std::swap(
      parts[i - 1], parts[static_cast<std::size_t>(random.Int(0, static_cast<int>(i) - 1))]);
  }
  return parts;
}

double WorstDifference(Random& random, const Spline<2>& a, const Spline<2>& b)
{
  const PointMatrix points = RandomParameters(random, *a.Space, 50);
  EvaluationBatch x, y;
  EXPECT_TRUE(EvaluateParameters(MakeBezierForm(a), points, {}, x));
  EXPECT_TRUE(EvaluateParameters(MakeBezierForm(b), points, {}, y));
  return (x.Values - y.Values).cwiseAbs().maxCoeff();
}
}

/// A thousand orders. The functions are those of the one order in which each segment was legal when
/// it was made.
TEST(InsertAllSegments, EveryOrderMakesTheSameSpace_PropertyOracle)
{
  int numOrders = 0;
  int multiple = 0;
  for (unsigned seed = 1; seed <= 100; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Spline<2> tensor =
      RandomClampedSurface(random, seed % 7 == 0 ? 9 : 4, 4, 2, seed % 3 == 0);
    const std::vector<LRSegment> segments = RandomSegments(random, tensor.Space, random.Int(1, 14));
    const auto ordered = InsertSegments(tensor, segments, 0);
    ASSERT_TRUE(ordered) << ordered.Status.Message();
    const auto first = InsertAllSegments(tensor, segments, NoLimit, 0);
    ASSERT_TRUE(first) << first.Status.Message();
    const LRBasis& expected = ordered->Space->LocallyRefined->Basis;
    const LRBasis& found = first->Space->LocallyRefined->Basis;
    EXPECT_EQ(found.Knots, expected.Knots);
    EXPECT_EQ(found.Lines, expected.Lines);
    EXPECT_EQ(found.LocalKnots, expected.LocalKnots);
    // points up to 10, a few dozen insertions
    EXPECT_LE(WorstDifference(random, tensor, first.Value), 1e-12);
    multiple += std::any_of(segments.begin(), segments.end(),
                  [](const LRSegment& segment) { return segment.Multiplicity > 1; })
      ? 1
      : 0;
    for (int turn = 0; turn < 10; ++turn, ++numOrders)
    {
      const auto other =
        InsertAllSegments(tensor, Disordered(random, segments), NoLimit, 1 + turn % 2);
      ASSERT_TRUE(other) << other.Status.Message();
      EXPECT_TRUE(other->Space->LocallyRefined->Basis == found);
      EXPECT_EQ(other->ControlPoints, first->ControlPoints);
      EXPECT_EQ(other->Weights, first->Weights);
    }
  }
  EXPECT_EQ(numOrders, 1000);
  EXPECT_GT(multiple, 30);
}

/// Half a segment traverses no function, both halves together do.
TEST(InsertAllSegments, PartsOfALineAreOne_ExactOracle)
{
  Random random(2);
  const KnotVector knots = KnotVector::Uniform(2, 4);
  const Spline<2> surface =
    RandomSpline(random, MakeTensorSpace<2>({ knots, knots }).Value, 3, false);
  const LRSegment whole{ 0, 0.375, 0.0, 0.75, 1 };
  const LRSegment lower{ 0, 0.375, 0.0, 0.5, 1 };
  const LRSegment upper{ 0, 0.375 + 1e-14, 0.5, 0.75, 1 }; // one knot within rounding
  EXPECT_EQ(InsertSegments(surface, { upper }, 0).Status.Code, ErrorCode::InvalidTopology);
  const auto expected = InsertSegments(surface, { whole }, 0);
  for (const auto& segments : { std::vector<LRSegment>{ upper, lower }, { lower, upper } })
  {
    const auto found = InsertAllSegments(surface, segments, NoLimit, 0);
    ASSERT_TRUE(found) << found.Status.Message();
    EXPECT_EQ(found->ControlPoints, expected->ControlPoints);
    EXPECT_TRUE(found->Space->LocallyRefined->Basis == expected->Space->LocallyRefined->Basis);
  }
}

TEST(InsertAllSegments, EveryFailureIsReachable_ExactOracle)
{
  Random random(2);
  const KnotVector knots = KnotVector::Uniform(2, 4);
  const Spline<2> surface =
    RandomSpline(random, MakeTensorSpace<2>({ knots, knots }).Value, 3, false);
  const LRSegment legal{ 0, 0.375, 0.0, 0.75, 1 };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Failure
  {
    LRSegment Segment;
    ErrorCode Code;
  };
  for (const Failure& failure : {
         Failure{ { 2, 0.375, 0.0, 0.75, 1 }, ErrorCode::InvalidParameter },
         Failure{ { 0, 0.375, 0.0, 0.75, 0 }, ErrorCode::InvalidParameter },
         Failure{ { 0, 0.375, 0.0, 0.75, 4 }, ErrorCode::InvalidParameter },
         Failure{ { 0, 0.375, 0.75, 0.75, 1 }, ErrorCode::InvalidParameter },
         Failure{ { 0, nan, 0.0, 0.75, 1 }, ErrorCode::NonFiniteInput },
         Failure{ { 0, 1.5, 0.0, 0.75, 1 }, ErrorCode::OutsideDomain },
         Failure{ { 1, 0.3, 0.0, 0.7, 1 }, ErrorCode::InvalidTopology },  // no line ends it
         Failure{ { 0, 0.3, 0.5, 0.75, 1 }, ErrorCode::InvalidTopology }, // too short
       })
  {
    const auto found = InsertAllSegments(surface, { legal, failure.Segment }, NoLimit, 0);
    EXPECT_EQ(found.Status.Code, failure.Code) << found.Status.Message();
    EXPECT_EQ(found.Status.Detail.find("segment 1: "), 0u) << found.Status.Message();
  }
  const auto large = InsertAllSegments(surface, { legal }, surface.Space->NumFunctions, 0);
  EXPECT_EQ(large.Status.Code, ErrorCode::TooLarge) << large.Status.Message();
  const auto hierarchical = RefineMarkedElements(surface, { 5 });
  EXPECT_EQ(RefineBySegments(hierarchical->Value, { legal }, NoLimit).Status.Code,
    ErrorCode::DimensionMismatch);
}

/// A refinement by segments names the elements that its own come from, and leaves no dependence
/// where that is wanted: the five segments of a known one, disordered.
TEST(RefineBySegments, ParentsHoldTheirElements_PropertyOracle)
{
  const Spline<2> dependent = DependentSurface();
  LRRefinementParams params;
  params.KeepIndependent = true;
  const auto refined = RefineBySegments(dependent, KnownSegments(), NoLimit, params);
  ASSERT_TRUE(refined) << refined.Status.Message();
  EXPECT_EQ(DecideDependence(*refined->Value.Space)->Verdict, LRVerdict::Independent);
  const SplineSpace<2>& space = *refined->Value.Space;
  ASSERT_EQ(refined->Parents.size(), space.Elements.size());
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const auto& box = space.Elements[e].Box;
    const auto& outer = dependent.Space->Elements[refined->Parents[e]].Box;
    EXPECT_TRUE(box.Lower[0] >= outer.Lower[0] && box.Upper[0] <= outer.Upper[0] &&
      box.Lower[1] >= outer.Lower[1] && box.Upper[1] <= outer.Upper[1]);
  }
}
