// SPDX-License-Identifier: BSD-3-Clause
#include "DomainCases.h"
#include "DomainMeasure.h"
#include "ParameterMetrics.h"
#include <knotwork/DomainParameterization/DomainParameterization.h>
#include <knotwork/SplineCore/BezierForm.h>

#include <gtest/gtest.h>

namespace knotwork
{
namespace
{
/// Boundary rows of the map are the compatible sides, bit for bit.
template <int Dim>
void ExpectBoundaryBits(const DomainParameterization<Dim>& result)
{
  const DomainBoundary<Dim> sides = cases::SidesOf<Dim>(result.Map);
  for (std::size_t s = 0; s < 2 * Dim; ++s)
  {
    EXPECT_TRUE(sides.Sides[s].ControlPoints == result.Boundary.Sides[s].ControlPoints);
    if (result.Boundary.IsRational())
    {
      EXPECT_TRUE(sides.Sides[s].Weights == result.Boundary.Sides[s].Weights);
    }
  }
}

/// The certificate is checked by the second, simpler verifier.
template <int Dim>
void ExpectConfirmed(const DomainParameterization<Dim>& result)
{
  const CertificateCheck check =
    VerifyCertificate(MakeBernsteinCells<Dim>(MakeBezierForm<Dim>(result.Map)), result.Certificate);
  EXPECT_EQ(check.Refuted, 0) << check.FirstRefuted;
  EXPECT_GT(check.Confirmed, 0);
}

/// A bay cut into the south side, so deep that the first maps fold.
DomainBoundary<2> Bay(double depth, int elements = 8)
{
  DomainBoundary<2> boundary = cases::Square();
  const KnotVector knots = KnotVector::Uniform(3, elements);
  std::vector<std::array<double, 2>> south, north;
  for (int i = 0; i < knots.NumFunctions(); ++i)
  {
    const double u = knots.Greville(i);
    const double bump = std::exp(-40.0 * (u - 0.5) * (u - 0.5));
    south.push_back({ u, i == 0 || i + 1 == knots.NumFunctions() ? 0.0 : depth * bump });
    north.push_back({ u, 1.0 });
  }
  boundary.Sides[2] = cases::Curve(knots, south);
  boundary.Sides[3] = cases::Curve(knots, north);
  boundary.Sides[0] =
    InsertKnots<1>(ElevateDegree<1>(boundary.Sides[0], 0, 2).Value, 0, { 0.25, 0.5, 0.75 }).Value;
  return boundary;
}

TEST(ParameterizeDomain, SquareStaysTheIdentity_ExactOracle)
{
  DomainBoundary<2> boundary = cases::Square();
  boundary.Sides[0] =
    InsertKnots<1>(ElevateDegree<1>(boundary.Sides[0], 0, 2).Value, 0, { 0.3, 0.6 }).Value;
  boundary.Sides[2] = ElevateDegree<1>(boundary.Sides[2], 0, 1).Value;
  const auto result = ParameterizeDomain<2>(boundary);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result->Certificate.Verdict, Verdict::Valid);
  EXPECT_NEAR(result->Metrics.MinDet, 1.0, 1e-6);
  EXPECT_NEAR(result->Metrics.MaxDet, 1.0, 1e-6);
  EXPECT_NEAR(result->Metrics.MeanConditionNumber, 2.0, 1e-9);
  EXPECT_NEAR(result->Metrics.MinScaledJacobian, 1.0, 1e-9);
  EXPECT_EQ(result->Metrics.Samples, 501);
  EXPECT_LE(result->MinDetLower, 1.0);
  EXPECT_GE(result->MaxDetUpper, 1.0 - 1e-12);
  ExpectBoundaryBits<2>(result.Value);
  ExpectConfirmed<2>(result.Value);
}

TEST(ParameterizeDomain, BayIsUnfoldedAndCertified_PropertyOracle)
{
  for (double depth : { 0.3, 0.6, 0.8 })
  {
    SCOPED_TRACE("depth " + std::to_string(depth));
    for (FoldoverRemoval removal :
      { FoldoverRemoval::Automatic, FoldoverRemoval::Penalty, FoldoverRemoval::Relu })
    {
      for (InitialMapMethod first :
        { InitialMapMethod::Coons, InitialMapMethod::Spring, InitialMapMethod::Harmonic })
      {
        DomainParams params;
        params.Foldover = removal;
        params.InitialMap = first;
        const auto result = ParameterizeDomain<2>(Bay(depth), params);
        ASSERT_TRUE(result) << result.Status.Message();
        EXPECT_EQ(result->UsedInitialMap, first);
        ASSERT_EQ(result->Certificate.Verdict, Verdict::Valid)
          << (result->Messages.empty() ? "" : result->Messages.front());
        EXPECT_GT(result->MinDetLower, 0.0);
        EXPECT_LE(result->MinDetLower, result->Metrics.MinDet);
        EXPECT_GE(result->MaxDetUpper, result->Metrics.MaxDet);
        EXPECT_TRUE(result->Messages.empty());
        ExpectBoundaryBits<2>(result.Value);
      }
    }
  }
}

TEST(ParameterizeDomain, HistoryFallsWithinEveryStage_PropertyOracle)
{
  const auto result = ParameterizeDomain<2>(Bay(0.6));
  ASSERT_TRUE(result) << result.Status.Message();
  ASSERT_GT(result->History.size(), 5u);
  EXPECT_EQ(result->History.front().Stage, DomainStage::Initial);
  for (std::size_t i = 1; i < result->History.size(); ++i)
  {
    const DomainIteration& row = result->History[i];
    if (row.Iteration > 0)
    {
      EXPECT_LE(row.Energy, result->History[i - 1].Energy);
    }
    if (row.Stage == DomainStage::Quality)
    {
      EXPECT_GT(row.MinDet, 0.0);
    }
  }
  EXPECT_GT(result->Iterations, 0);
  EXPECT_GE(result->Evaluations, result->Iterations);
}

TEST(ParameterizeDomain, ResultDoesNotDependOnThreads_PropertyOracle)
{
  DomainParams params;
  params.Threads = 1;
  const auto one = ParameterizeDomain<2>(Bay(0.6), params);
  params.Threads = 3;
  const auto three = ParameterizeDomain<2>(Bay(0.6), params);
  EXPECT_TRUE(one->Map.ControlPoints == three->Map.ControlPoints);
  EXPECT_EQ(one->MinDetLower, three->MinDetLower);
  EXPECT_EQ(one->Metrics.MeanConditionNumber, three->Metrics.MeanConditionNumber);
}

TEST(ParameterizeDomain, CommutesWithSimilarities_PropertyOracle)
{
  const auto plain = ParameterizeDomain<2>(Bay(0.5));
  DomainBoundary<2> moved = Bay(0.5);
  constexpr double scale = 1000.0;
  for (Spline<1>& side : moved.Sides) // turned by 90 degrees, scaled, shifted
  {
    PointMatrix points(side.ControlPoints.rows(), 2);
    points.col(0) = (-scale * side.ControlPoints.col(1)).array() + 5e4;
    points.col(1) = (scale * side.ControlPoints.col(0)).array() - 3e4;
    side.ControlPoints = points;
  }
  const auto result = ParameterizeDomain<2>(moved);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result->Certificate.Verdict, Verdict::Valid);
  // iterations stop within the energy tolerance of each other
  EXPECT_NEAR(result->Metrics.MinDetOverArea, plain->Metrics.MinDetOverArea, 5e-3);
  EXPECT_NEAR(result->Metrics.MaxDetOverArea, plain->Metrics.MaxDetOverArea, 5e-3);
}

TEST(ParameterizeDomain, FoldedCornerIsNamed_GoldenOracle)
{
  // the south curve leaves (0, 0) into the left of the west curve: v x u < 0 at that corner
  DomainBoundary<2> boundary = cases::Square();
  boundary.Sides[2] =
    cases::Curve(KnotVector::Uniform(3, 1), { { 0, 0 }, { -0.3, 0.2 }, { 0.5, -0.6 }, { 1, 0 } });
  const auto result = ParameterizeDomain<2>(boundary);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result->Certificate.Verdict, Verdict::Invalid);
  EXPECT_TRUE(result->IsImpossible());
  ASSERT_EQ(result->Folds.size(), 1u);
  EXPECT_EQ(result->Folds[0].Parameters[0], 0.0);
  EXPECT_EQ(result->Folds[0].Parameters[1], 0.0);
  // tangents (-0.9, 0.6) and (0, 1): det -0.9, scaled -0.9 / |(-0.9, 0.6)| = -0.832050
  EXPECT_NEAR(result->Folds[0].Det, -0.9, 1e-13);
  ASSERT_FALSE(result->Messages.empty());
  EXPECT_NE(result->Messages[0].find("corner (u = 0, v = 0)"), std::string::npos);
  EXPECT_NE(result->Messages[0].find("side 0 and side 2"), std::string::npos);
  EXPECT_NE(result->Messages[0].find("-0.83205"), std::string::npos) << result->Messages[0];
  ExpectBoundaryBits<2>(result.Value);
}

TEST(ParameterizeDomain, AnnulusSectorIsExactWithAndWithoutWeights_PropertyOracle)
{
  for (WeightMode mode : { WeightMode::Fixed, WeightMode::Optimized, WeightMode::Automatic })
  {
    DomainParams params;
    params.Weights = mode;
    const auto result = ParameterizeDomain<2>(cases::AnnulusSector(), params);
    ASSERT_TRUE(result) << result.Status.Message();
    EXPECT_EQ(result->Certificate.Verdict, Verdict::Valid);
    EXPECT_NEAR(result->Metrics.Area, 3 * cases::Pi / 4, 1e-12);
    ExpectBoundaryBits<2>(result.Value);
    EXPECT_EQ(result->WeightsOptimized, mode == WeightMode::Optimized);
  }
}

TEST(ParameterizeDomain, FacesOfABentBarAreFilledAndCertified_PropertyOracle)
{
  const Spline<3> bar = cases::GrevilleMap<3>(
    { KnotVector::Uniform(2, 6), KnotVector::Uniform(2, 2), KnotVector::Uniform(2, 2) },
    [](const std::array<double, 3>& u)
    {
      const double a = 1.5 * cases::Pi * u[0];
      const double r = 2.0 - u[1];
      return std::array<double, 3>{ r * std::sin(a), -r * std::cos(a), u[2] };
    });
  const DomainBoundary<3> faces = cases::SidesOf<3>(bar);
  const auto result = ParameterizeDomain<3>(faces);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result->Certificate.Verdict, Verdict::Valid);
  EXPECT_EQ(result->Metrics.Samples, 51);
  EXPECT_GT(result->MinDetLower, 0.0);
  EXPECT_LE(result->MinDetLower, result->Metrics.MinDet);
  ExpectBoundaryBits<3>(result.Value);
}

TEST(ParameterizeDomain, LetterGIsValidOrSaysOtherwise_PropertyOracle)
{
  for (double skew : { 0.0, 0.05, 0.1 })
  {
    for (double width : { 0.4, 0.7 })
    {
      SCOPED_TRACE("skew " + std::to_string(skew) + " width " + std::to_string(width));
      const auto result = ParameterizeDomain<3>(cases::LetterG(20, 2, 2, width, skew));
      ASSERT_TRUE(result) << result.Status.Message();
      EXPECT_EQ(result->Certificate.Verdict, Verdict::Valid);
      EXPECT_EQ(result->Metrics.NonPositive, 0);
      // wide enough, the straight end runs into the beginning of the arc
      EXPECT_EQ(result->Crossings.size(), width > 0.65 ? 1u : 0u);
      EXPECT_EQ(result->Injectivity.Verdict == InjectivityVerdict::NotInjective, width > 0.65);
      EXPECT_EQ(result->Messages.empty(), result->IsValid());
      if (result->Map.Space->Kind == SpaceKind::Tensor)
      {
        ExpectBoundaryBits<3>(result.Value);
      }
    }
  }
}

TEST(ParameterizeDomain, LetterGThatFoldsAtAnEdgeSaysSo_PropertyOracle)
{
  // half the width is more than the turn's radius: the inner faces run backwards
  const auto result = ParameterizeDomain<3>(cases::LetterG(20, 2, 2, 1.3, 0.0));
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_NE(result->Certificate.Verdict, Verdict::Valid);
  EXPECT_TRUE(result->IsImpossible());
  ASSERT_FALSE(result->Messages.empty());
  EXPECT_NE(result->Messages[0].find("no interior makes the map valid"), std::string::npos);
}

TEST(ParameterizeDomain, NewtonEndsWhereLbfgsEnds_CrossOracle)
{
  DomainParams params;
  params.EnergyTolerance = 1e-9;
  params.Optimizer = DomainOptimizer::Lbfgs;
  const auto first = ParameterizeDomain<2>(Bay(0.6), params);
  params.Optimizer = DomainOptimizer::Newton;
  const auto second = ParameterizeDomain<2>(Bay(0.6), params);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(second->Certificate.Verdict, Verdict::Valid);
  // energies agree to the tolerance, extremes of det J to its square root and some
  EXPECT_NEAR(first->History.back().Energy, second->History.back().Energy, 1e-6);
  EXPECT_NEAR(first->Metrics.MinDetOverArea, second->Metrics.MinDetOverArea, 1e-3);
  EXPECT_NEAR(first->Metrics.MaxDetOverArea, second->Metrics.MaxDetOverArea, 1e-3);
  EXPECT_LT(second->Iterations, first->Iterations);

  const DomainBoundary<3> bar = cases::LetterG(8, 2, 2, 0.5, 0.05);
  params.Optimizer = DomainOptimizer::Lbfgs;
  const auto third = ParameterizeDomain<3>(bar, params);
  params.Optimizer = DomainOptimizer::Newton;
  const auto fourth = ParameterizeDomain<3>(bar, params);
  ASSERT_TRUE(third && fourth);
  EXPECT_NEAR(third->History.back().Energy, fourth->History.back().Energy, 1e-5);
}

TEST(ParameterizeDomain, WeightsMakeATallBiteValid_PropertyOracle)
{
  for (double height : { 4.0, 6.0 })
  {
    SCOPED_TRACE("height " + std::to_string(height));
    const DomainBoundary<2> boundary = cases::Bite(0.49, 0.5, height, 2);
    DomainParams params;
    params.MaxRefinements = 0;
    params.Weights = WeightMode::Fixed;
    const auto fixed = ParameterizeDomain<2>(boundary, params);
    ASSERT_TRUE(fixed) << fixed.Status.Message();
    EXPECT_NE(fixed->Certificate.Verdict, Verdict::Valid);
    EXPECT_FALSE(fixed->Messages.empty());
    for (WeightMode mode : { WeightMode::Optimized, WeightMode::Automatic })
    {
      params.Weights = mode;
      const auto result = ParameterizeDomain<2>(boundary, params);
      ASSERT_TRUE(result) << result.Status.Message();
      EXPECT_EQ(result->Certificate.Verdict, Verdict::Valid);
      EXPECT_TRUE(result->WeightsOptimized);
      EXPECT_GT(result->Map.Weights.minCoeff(), 0.0);
      ExpectBoundaryBits<2>(result.Value);
      ExpectConfirmed<2>(result.Value);
    }
  }
}

TEST(ParameterizeDomain, WeightsLowerTheEnergy_PropertyOracle)
{
  const auto last = [](const DomainParameterization<2>& result)
  { return result.History.back().Energy; };
  DomainParams params;
  params.MaxRefinements = 0;
  for (double at : { 0.5, 0.35 })
  {
    params.Weights = WeightMode::Fixed;
    const auto fixed = ParameterizeDomain<2>(cases::BumpedSector(0.9, at, 8, 3), params);
    ASSERT_TRUE(fixed) << fixed.Status.Message();
    params.Weights = WeightMode::Optimized;
    const auto moved = ParameterizeDomain<2>(cases::BumpedSector(0.9, at, 8, 3), params);
    ASSERT_TRUE(moved) << moved.Status.Message();
    EXPECT_EQ(moved->Certificate.Verdict, Verdict::Valid);
    EXPECT_LT(last(moved.Value), last(fixed.Value));
    ExpectBoundaryBits<2>(moved.Value);
  }
}

// Points, weights, points, ...: whether the first map folds or not, weights have their turn after
// the first minimization, not after other ways to a valid map.
TEST(ParameterizeDomain, PointsAndWeightsAlternateFromTheStart_PropertyOracle)
{
  for (const auto removal :
    { FoldoverRemoval::Automatic, FoldoverRemoval::Relu, FoldoverRemoval::Penalty })
  {
    for (const auto weights : { InitialWeights::Blended, InitialWeights::Ones })
    {
      for (const double height : { 0.6, 3.0 })
      {
        DomainParams params;
        params.InitialMap = InitialMapMethod::Coons;
        params.Weights = WeightMode::Optimized;
        params.FirstWeights = weights;
        params.Foldover = removal;
        params.MaxRefinements = 0;
        const auto result = ParameterizeDomain<2>(cases::Bite(0.46, 0.5, height, 3), params);
        ASSERT_TRUE(result) << result.Status.Message();
        EXPECT_TRUE(result->WeightsOptimized);
        EXPECT_TRUE(result->IsValid());
        std::vector<DomainStage> turns;
        for (const DomainIteration& row : result->History)
        {
          if (turns.empty() || turns.back() != row.Stage || row.Iteration == 0)
          {
            turns.push_back(row.Stage);
          }
        }
        turns.erase(std::remove_if(turns.begin(), turns.end(),
                      [](DomainStage stage)
                      { return stage == DomainStage::Initial || stage == DomainStage::Foldover; }),
          turns.end());
        ASSERT_GE(turns.size(), 3u);
        for (std::size_t k = 0; k < 3; ++k)
        {
          EXPECT_EQ(turns[k], k % 2 ? DomainStage::Weights : DomainStage::Quality) << k;
        }
      }
    }
  }
}

TEST(ParameterizeDomain, PoorSpacesAreRefinedLocally_PropertyOracle)
{
  // bilinear across: no inner control points at all
  DomainBoundary<2> boundary = cases::Bite(0.4, 0.5, 0.5, 1);
  DomainParams params;
  params.MaxRefinements = 0;
  const auto poor = ParameterizeDomain<2>(boundary, params);
  ASSERT_TRUE(poor) << poor.Status.Message();
  EXPECT_EQ(poor->Certificate.Verdict, Verdict::Invalid);
  EXPECT_FALSE(poor->IsImpossible());
  params.MaxRefinements = 3;
  const auto result = ParameterizeDomain<2>(boundary, params);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result->Certificate.Verdict, Verdict::Valid);
  EXPECT_GT(result->Refinements, 0);
  EXPECT_EQ(result->Map.Space->Kind, SpaceKind::Hierarchical);
  EXPECT_LT(result->Map.Space->NumFunctions, 100);
  EXPECT_TRUE(result->Messages.empty());
  ExpectConfirmed<2>(result.Value);
  // the boundary is the same curve: compared with the tensor-product map's boundary
  const BezierForm<2> refined = MakeBezierForm<2>(result->Map);
  const BezierForm<2> plain = MakeBezierForm<2>(poor->Map);
  PointMatrix edge(200, 2);
  for (int i = 0; i < 50; ++i)
  {
    const double t = i / 49.0;
    edge.row(4 * i) << 0.0, t;
    edge.row(4 * i + 1) << 1.0, t;
    edge.row(4 * i + 2) << t, 0.0;
    edge.row(4 * i + 3) << t, 1.0;
  }
  EvaluationBatch a, b;
  ASSERT_TRUE(EvaluateParameters<2>(refined, edge, {}, a));
  ASSERT_TRUE(EvaluateParameters<2>(plain, edge, {}, b));
  EXPECT_LE((a.Values - b.Values).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(ParameterizeDomain, CircleOfFourArcsIsDegenerateAtItsCornersOnly_ExactOracle)
{
  DomainBoundary<2> boundary;
  for (int quarter = 0; quarter < 4; ++quarter)
  {
    const double begin = quarter * cases::Pi / 2;
    boundary.Sides.push_back(
      InsertKnots<1>(cases::Arc(1.0, begin, begin + cases::Pi / 2), 0, { 0.25, 0.5, 0.75 }).Value);
  }
  const auto result = ParameterizeDomain<2>(boundary);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_TRUE(result->Folds.empty());
  EXPECT_EQ(result->Certificate.Verdict, Verdict::Valid);
  EXPECT_EQ(result->Certificate.NumDegenerate, 4);
  EXPECT_NEAR(result->Metrics.Area, cases::Pi, 1e-12);
  EXPECT_LT(result->Metrics.MeanConditionNumber, 3.0); // the four corners do not count
  EXPECT_LE(std::abs(result->Metrics.MinDet), 1e-14);
  ExpectBoundaryBits<2>(result.Value);
}

TEST(ParameterizeDomain, ARingOfMoreThanAFullTurnIsRegularButNotOneToOne_ExactOracle)
{
  // a spiral strip on a circle, 504 degrees: every point of 144 degrees has two preimages
  const int elements = 12;
  const KnotVector knots = KnotVector::Uniform(3, elements);
  DomainBoundary<2> ring;
  for (const double radius : { 1.0, 2.0 })
  {
    std::vector<std::array<double, 2>> points;
    for (int i = 0; i < knots.NumFunctions(); ++i)
    {
      const double a = 504 * cases::Pi / 180 * knots.Greville(i);
      points.push_back({ radius * std::cos(a), radius * std::sin(a) });
    }
    ring.Sides.push_back(cases::Curve(knots, points));
  }
  for (const Eigen::Index row : { Eigen::Index(0), Eigen::Index(knots.NumFunctions() - 1) })
  {
    const auto begin = ring.Sides[0].ControlPoints.row(row);
    const auto end = ring.Sides[1].ControlPoints.row(row);
    ring.Sides.push_back(cases::Segment({ begin[0], begin[1] }, { end[0], end[1] }));
  }
  const auto result = ParameterizeDomain<2>(ring);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result->Certificate.Verdict, Verdict::Valid);
  EXPECT_EQ(result->Injectivity.Verdict, InjectivityVerdict::NotInjective);
  EXPECT_FALSE(result->IsValid());
  EXPECT_TRUE(result->IsImpossible());
  ASSERT_EQ(result->Crossings.size(), 1u);
  const auto& at = result->Crossings[0].Position;
  EXPECT_GT(std::hypot(at[0], at[1]), 0.9);
  EXPECT_LT(std::hypot(at[0], at[1]), 2.1);
  ASSERT_EQ(result->Messages.size(), 1u);
  EXPECT_NE(result->Messages[0].find("regular, but not one-to-one"), std::string::npos);
}

TEST(ParameterizeDomain, EveryRegularMapSaysWhetherItIsOneToOne_PropertyOracle)
{
  const auto result = ParameterizeDomain<2>(Bay(0.6));
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result->Injectivity.Verdict, InjectivityVerdict::Injective);
  EXPECT_TRUE(result->IsValid());
}

TEST(ParameterizeDomain, EffortEndsARunAtOnePlace_PropertyOracle)
{
  DomainParams params;
  params.MaxRefinements = 0;
  const auto whole = ParameterizeDomain<2>(Bay(0.8), params);
  ASSERT_TRUE(whole) << whole.Status.Message();
  EXPECT_EQ(whole->Stop, DomainStop::Finished);
  EXPECT_GT(whole->Work, 0.0);
  EXPECT_LT(whole->Work, params.Effort);
  int stopped = 0;
  for (double share : { 0.01, 0.1, 0.3, 0.6, 0.9 })
  {
    SCOPED_TRACE("share " + std::to_string(share));
    params.Effort = share * whole->Work;
    params.Threads = 1;
    const auto one = ParameterizeDomain<2>(Bay(0.8), params);
    params.Threads = 3;
    const auto three = ParameterizeDomain<2>(Bay(0.8), params);
    ASSERT_TRUE(one && three);
    EXPECT_EQ(one->Stop, DomainStop::Effort);
    EXPECT_EQ(one->Evaluations, three->Evaluations);
    EXPECT_TRUE(one->Map.ControlPoints == three->Map.ControlPoints);
    EXPECT_LT(one->Evaluations, whole->Evaluations);
    ASSERT_FALSE(one->Messages.empty());
    EXPECT_NE(one->Messages.back().find("the effort was used up"), std::string::npos);
    ExpectBoundaryBits<2>(one.Value);
    stopped += one->Certificate.Verdict == Verdict::Valid;
  }
  EXPECT_GE(stopped, 1); // the last ones have their certificate already
}

TEST(ParameterizeDomain, TimeLimitEndsARunWithTheBestSoFar_PropertyOracle)
{
  DomainParams params;
  params.TimeLimit = 1e-9;
  const auto result = ParameterizeDomain<2>(Bay(0.8), params);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result->Stop, DomainStop::Time);
  EXPECT_LE(result->Iterations, 1);
  ASSERT_FALSE(result->Messages.empty());
  EXPECT_NE(result->Messages.back().find("the time limit was reached"), std::string::npos);
  ExpectBoundaryBits<2>(result.Value);
  params.TimeLimit = 3600.0;
  const auto enough = ParameterizeDomain<2>(Bay(0.8), params);
  ASSERT_TRUE(enough) << enough.Status.Message();
  EXPECT_EQ(enough->Stop, DomainStop::Finished);
  EXPECT_TRUE(enough->IsValid());
}

TEST(ParameterizeDomain, LeastJacobianIsLargerWhenAskedFor_PropertyOracle)
{
  // no interior makes det J larger than it is at the corners, where the sides alone decide
  const auto atCorners = [](const DomainParameterization<2>& result)
  {
    PointMatrix corners(4, 2);
    corners << 0, 0, 1, 0, 0, 1, 1, 1;
    EvaluationParams params;
    params.Derivatives = 1;
    EvaluationBatch batch;
    EXPECT_TRUE(EvaluateParameters<2>(MakeBezierForm<2>(result.Map), corners, params, batch));
    double least = 1e300;
    for (int i = 0; i < 4; ++i)
    {
      least = std::min(
        least, batch.First(i, 0) * batch.First(i, 3) - batch.First(i, 1) * batch.First(i, 2));
    }
    return least / result.Metrics.Area;
  };
  for (double depth : { 0.3, 0.6, 0.8 })
  {
    SCOPED_TRACE("depth " + std::to_string(depth));
    const auto winslow = ParameterizeDomain<2>(Bay(depth));
    DomainParams params;
    params.Objective = DomainObjective::LeastJacobian;
    const auto least = ParameterizeDomain<2>(Bay(depth), params);
    ASSERT_TRUE(winslow && least);
    EXPECT_TRUE(least->IsValid());
    EXPECT_GT(least->Metrics.MinDetOverArea, 1.1 * winslow->Metrics.MinDetOverArea);
    EXPECT_LE(least->Metrics.MinDetOverArea, atCorners(least.Value) + 1e-12);
    ExpectBoundaryBits<2>(least.Value);
    ExpectConfirmed<2>(least.Value);
  }
  DomainParams params;
  params.Objective = DomainObjective::LeastJacobian;
  const DomainBoundary<3> bar = cases::LetterG(8, 2, 2, 0.5, 0.05);
  const auto winslow = ParameterizeDomain<3>(bar);
  const auto least = ParameterizeDomain<3>(bar, params);
  ASSERT_TRUE(winslow && least);
  EXPECT_EQ(least->Certificate.Verdict, Verdict::Valid);
  EXPECT_GT(least->Metrics.MinDetOverArea, winslow->Metrics.MinDetOverArea);
}

TEST(ParameterizeDomain, ProgressAborts)
{
  int calls = 0;
  double last = -1.0;
  const auto result = ParameterizeDomain<2>(Bay(0.6), {},
    [&](double share)
    {
      EXPECT_GE(share, last);
      EXPECT_LE(share, 1.0);
      last = share;
      return ++calls < 4;
    });
  EXPECT_EQ(result.Status.Code, ErrorCode::Aborted);
  EXPECT_EQ(calls, 4);
}

TEST(ParameterizeDomain, AbortIsHeededWhereverItComes_PropertyOracle)
{
  int total = 0;
  const auto whole = ParameterizeDomain<2>(Bay(0.8), {},
    [&](double)
    {
      ++total;
      return true;
    });
  ASSERT_TRUE(whole) << whole.Status.Message();
  ASSERT_GT(total, 50);
  for (int last = 1; last <= total; last += 1 + total / 40)
  {
    int calls = 0;
    const auto result = ParameterizeDomain<2>(Bay(0.8), {}, [&](double) { return ++calls < last; });
    EXPECT_EQ(result.Status.Code, ErrorCode::Aborted) << last << " of " << total;
    EXPECT_EQ(calls, last);
  }
}

TEST(ParameterizeDomain, OptionsOutsideTheirRangeAreNamed)
{
  const auto code = [](auto&& change)
  {
    DomainParams params;
    change(params);
    const auto result = ParameterizeDomain<2>(cases::Square(), params);
    EXPECT_EQ(result.Status.Detail.empty(), static_cast<bool>(result));
    return result.Status.Code;
  };
  using P = DomainParams;
  for (const auto& change :
    std::vector<std::function<void(P&)>>{ [](P& p) { p.UniformityWeight = -1.0; },
      [](P& p) { p.FoldoverMargin = 0.0; }, [](P& p) { p.WinslowEpsilon = 0.0; },
      [](P& p) { p.AlternationTolerance = 0.0; }, [](P& p) { p.MaxAlternations = 0; },
      [](P& p) { p.MaxIterations = 0; }, [](P& p) { p.EnergyTolerance = 0.0; },
      [](P& p) { p.MaxRefinements = 11; }, [](P& p) { p.MetricSamples = 1; },
      [](P& p) { p.Effort = 0.0; }, [](P& p) { p.TimeLimit = -1.0; },
      [](P& p) { p.CertificateGap = 0.0; }, [](P& p) { p.MaxBoxes = 0; },
      [](P& p) { p.Threads = -1; }, [](P& p) { p.GapTolerance = 0.2; },
      [](P& p) { p.MaxFunctions = 0; } })
  {
    EXPECT_EQ(code(change), ErrorCode::InvalidParameter);
  }
  EXPECT_EQ(ParameterizeDomain<2>({}).Status.Code, ErrorCode::EmptyInput);
  // as many as the map has are allowed, one less is not
  const int functions = ParameterizeDomain<2>(cases::Square())->Map.Space->NumFunctions;
  for (const int limit : { functions, functions - 1 })
  {
    const bool fits = limit == functions;
    EXPECT_EQ(
      code([limit](P& p) { p.MaxFunctions = limit; }), fits ? ErrorCode::Ok : ErrorCode::TooLarge);
  }
  DomainParams many; // in space every sample counts in three directions
  many.MetricSamples = 302;
  const KnotVector knots = KnotVector::Uniform(1, 1);
  const DomainBoundary<3> cube = cases::SidesOf<3>(cases::GrevilleMap<3>(
    { knots, knots, knots }, [](const std::array<double, 3>& u) { return u; }));
  EXPECT_EQ(ParameterizeDomain<3>(cube, many).Status.Code, ErrorCode::InvalidParameter);
}
}
}
