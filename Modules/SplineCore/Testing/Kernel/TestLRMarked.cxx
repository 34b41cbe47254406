// SPDX-License-Identifier: BSD-3-Clause
// Steps of refinement by LR B-splines: what is halved, how far the lines reach.
#include "LRCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/LRDependence.h>
#include <knotwork/SplineCore/Refinement.h>

#include <numeric>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
constexpr int Elements = 8;              // a direction
constexpr int Marked = 3 * Elements + 3; // far enough from the boundary
constexpr int Functions = Elements + 2;  // a direction, biquadratic

Spline<2> Surface(bool rational = false)
{
  Random random(3);
  const KnotVector knots = KnotVector::Uniform(2, Elements);
  return RandomSpline(random, MakeTensorSpace<2>({ knots, knots }).Value, 3, rational);
}

LRRefinementParams Params(
  LRStrategy strategy, std::array<bool, 2> directions = { true, true }, bool byFunction = false)
{
  LRRefinementParams params;
  params.Segments = { strategy, directions };
  params.ByFunction = byFunction;
  return params;
}

double WorstDifference(const Spline<2>& a, const Spline<2>& b)
{
  Random random(1);
  const PointMatrix points = RandomParameters(random, *a.Space, 500);
  EvaluationBatch x, y;
  EXPECT_TRUE(EvaluateParameters(MakeBezierForm(a), points, {}, x));
  EXPECT_TRUE(EvaluateParameters(MakeBezierForm(b), points, {}, y));
  return (x.Values - y.Values).cwiseAbs().maxCoeff();
}

std::array<int, 2> Counts(const LRRefinementParams& params)
{
  const auto refined = RefineMarkedLR(Surface(), { Marked }, params);
  EXPECT_TRUE(refined) << refined.Status.Message();
  const SplineSpace<2>& space = *refined->Value.Space;
  return { space.NumElements(), space.NumFunctions };
}
}

TEST(RefineMarkedLR, LinesReachAsFarAsTheStrategySays_GoldenOracle)
{
  const int elements = Elements * Elements;
  const int functions = Functions * Functions;
  using Pair = std::array<int, 2>;
  // the functions on an element meet 5 of a row: 3 functions lie within them, 1 within 3 elements
  EXPECT_EQ(
    Counts(Params(LRStrategy::FullSpan, { true, false })), (Pair{ elements + 5, functions + 3 }));
  EXPECT_EQ(Counts(Params(LRStrategy::MinimumSpan, { false, true })),
    (Pair{ elements + 3, functions + 1 }));
  // lines of both directions cross in the element
  EXPECT_EQ(Counts(Params(LRStrategy::FullSpan))[0], elements + 11);
  EXPECT_EQ(Counts(Params(LRStrategy::MinimumSpan))[0], elements + 7);
  // one function of 3 x 3 elements: all of its spans halved, or the longest of each direction
  EXPECT_EQ(Counts(Params(LRStrategy::StructuredMesh))[0], elements + 27);
  EXPECT_EQ(Counts(Params(LRStrategy::StructuredMesh, { true, true }, true))[0], elements + 27);
  EXPECT_EQ(Counts(Params(LRStrategy::MinimumSpan, { true, true }, true))[0], elements + 7);
  // of that function the one span that holds the element; all of equal length, by function
  EXPECT_EQ(Counts(Params(LRStrategy::RestrictedMesh))[0], elements + 7);
  EXPECT_EQ(Counts(Params(LRStrategy::RestrictedMesh, { true, false })),
    (Pair{ elements + 3, functions + 1 }));
  EXPECT_EQ(Counts(Params(LRStrategy::RestrictedMesh, { true, true }, true))[0], elements + 27);
}

// Knots written out: spans of one function, some with marked elements, some too short.
TEST(LRStrategies, RestrictedMeshHalvesLongSpansWithMarkedElements_GoldenOracle)
{
  // one biquadratic function on [0, 3] x [0, 5], whose spans in v are 1, 3 and 1
  const auto u = KnotVector::Create(2, { 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 3.0 });
  const auto v = KnotVector::Create(2, { 0.0, 0.0, 0.0, 1.0, 4.0, 5.0, 5.0, 5.0 });
  const auto tensor = MakeTensorSpace<2>({ u.Value, v.Value });
  ASSERT_TRUE(tensor);
  auto basis = LRBasisOfTensor(*tensor.Value);
  ASSERT_TRUE(basis);
  const auto space = MakeLRSpace(basis.Value, 1);
  ASSERT_TRUE(space);
  const auto values = [&](const std::vector<int>& elements, int d)
  {
    const auto found = SegmentsForElements(
      *space.Value, elements, { LRStrategy::RestrictedMesh, { d == 0, d == 1 } });
    EXPECT_TRUE(found);
    std::vector<double> lines;
    for (const LRSegment& segment : found.Value)
    {
      lines.push_back(segment.Value);
    }
    std::sort(lines.begin(), lines.end());
    lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
    return lines;
  };
  // elements 3 j + i; the smallest function on an element in a corner has its knots at that end
  EXPECT_EQ(values({ 0 }, 1), std::vector<double>({ 0.5 }));
  // in the middle the smallest functions have the span of length 3 in v; element 4 is in it alone
  EXPECT_EQ(values({ 4 }, 1), std::vector<double>({ 2.5 }));
  EXPECT_EQ(values({ 4 }, 0), std::vector<double>({ 1.5 }));
  // element 1, at the lower end of v: its smallest function has spans 0, 0 and 1 there
  EXPECT_EQ(values({ 1 }, 1), std::vector<double>({ 0.5 }));
  // by function: of all spans those longer than half the longest; knots 0 1 4 5 of the function in
  // the middle
  const auto middle = SegmentsForFunctions(
    *space.Value, { 2 * 5 + 2 }, { LRStrategy::RestrictedMesh, { false, true } });
  ASSERT_TRUE(middle);
  ASSERT_EQ(middle->size(), 1U);
  EXPECT_EQ(middle.Value[0].Value, 2.5);
  EXPECT_EQ(middle.Value[0].Start, 0.0);
  EXPECT_EQ(middle.Value[0].End, 3.0);
  const auto along = SegmentsForFunctions(
    *space.Value, { 2 * 5 + 2 }, { LRStrategy::RestrictedMesh, { true, false } });
  ASSERT_TRUE(along);
  EXPECT_EQ(along->size(), 3U);
}

TEST(RefineMarkedLR, AllMarkedIsTheTensorProduct_CrossOracle)
{
  const Spline<2> surface = Surface();
  std::vector<int> all(Elements * Elements);
  std::iota(all.begin(), all.end(), 0);
  const auto tensor = RefineAllElements(surface);
  for (const auto& params : { Params(LRStrategy::FullSpan), Params(LRStrategy::MinimumSpan),
         Params(LRStrategy::StructuredMesh), Params(LRStrategy::RestrictedMesh),
         Params(LRStrategy::RestrictedMesh, { true, true }, true),
         Params(LRStrategy::FullSpan, { true, true }, true),
         Params(LRStrategy::StructuredMesh, { true, true }, true) })
  {
    const auto refined = RefineMarkedLR(surface, all, params);
    ASSERT_TRUE(refined) << refined.Status.Message();
    EXPECT_EQ(refined->Value.Space->Kind, SpaceKind::LocallyRefined);
    EXPECT_EQ(refined->Value.Space->NumFunctions, tensor->Value.Space->NumFunctions);
    EXPECT_EQ(refined->Parents, tensor->Parents);
    EXPECT_LE(
      (refined->Value.ControlPoints - tensor->Value.ControlPoints).cwiseAbs().maxCoeff(), 1e-13);
  }
}

TEST(RefineMarkedLR, MapStays_PropertyOracle)
{
  for (const bool rational : { false, true })
  {
    const Spline<2> surface = Surface(rational);
    for (const LRStrategy strategy : { LRStrategy::FullSpan, LRStrategy::MinimumSpan,
           LRStrategy::StructuredMesh, LRStrategy::RestrictedMesh })
    {
      for (const bool byFunction : { false, true })
      {
        LRRefinementParams params = Params(strategy, { true, true }, byFunction);
        params.KeepIndependent = true;
        Spline<2> refined = surface;
        for (const int e : { Marked, Marked + 1, Marked + 9, 0 })
        {
          const auto next = RefineMarkedLR(refined, { e, e + 2 }, params);
          ASSERT_TRUE(next) << next.Status.Message();
          EXPECT_GT(next->Value.Space->NumFunctions, refined.Space->NumFunctions);
          for (int child = 0; child < next->Value.Space->NumElements(); ++child)
          {
            const auto& box = next->Value.Space->Elements[child].Box;
            const auto& outer = refined.Space->Elements[next->Parents[child]].Box;
            EXPECT_TRUE(box.Lower[0] >= outer.Lower[0] && box.Upper[0] <= outer.Upper[0] &&
              box.Lower[1] >= outer.Lower[1] && box.Upper[1] <= outer.Upper[1]);
          }
          refined = next->Value;
        }
        // points up to 10 and a few dozen insertions
        EXPECT_LE(WorstDifference(surface, refined), 1e-12);
        EXPECT_EQ(DecideDependence(*refined.Space)->Verdict, LRVerdict::Independent);
      }
    }
  }
}

TEST(RefineMarkedLR, DependenceGoes_CrossOracle)
{
  const Spline<2> surface = DependentSurface();
  LRRefinementParams params;
  const auto same = RefineMarkedLR(surface, {}, params);
  ASSERT_TRUE(same) << same.Status.Message();
  EXPECT_EQ(same->Value.Space, surface.Space);
  params.KeepIndependent = true;
  const auto resolved = RefineMarkedLR(surface, {}, params);
  ASSERT_TRUE(resolved) << resolved.Status.Message();
  EXPECT_EQ(DecideDependence(*resolved->Value.Space)->Verdict, LRVerdict::Independent);
  EXPECT_LE(WorstDifference(surface, resolved->Value), 1e-12);
  EXPECT_EQ(resolved->Parents.size(), resolved->Value.Space->Elements.size());
}

TEST(RefineMarkedLR, Failures_ExactOracle)
{
  const Spline<2> surface = Surface();
  EXPECT_EQ(
    RefineMarkedLR(surface, { Elements * Elements }).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(RefineMarkedLR(surface, { -1 }).Status.Code, ErrorCode::InvalidParameter);
  const auto hierarchical = RefineMarkedElements(surface, { Marked });
  EXPECT_EQ(RefineMarkedLR(hierarchical->Value, { 0 }).Status.Code, ErrorCode::DimensionMismatch);
}
