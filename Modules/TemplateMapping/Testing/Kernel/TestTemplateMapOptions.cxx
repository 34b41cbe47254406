// SPDX-License-Identifier: BSD-3-Clause
// What each option of MapTemplate does.
#include "MapCases.h"
#include "TemplateCases.h"
#include <knotwork/SplineCore/QualityFunctionals.h>
#include <knotwork/TemplateMapping/Regularity.h>
#include <knotwork/TemplateMapping/TemplateMap.h>

#include <gtest/gtest.h>

#include <limits>

using namespace knotwork;
using cases::CircleTemplate;
using cases::LobedCurve;
using cases::LobedTarget;

namespace
{
template <typename Change>
TemplateMapResult<2> Map(
  const Skeleton<2>& skeleton, const Skeleton<2>& target, const Change& change)
{
  TemplateMapParams<2> params;
  change(params);
  auto result = MapTemplate(skeleton, target, params);
  EXPECT_TRUE(result) << result.Status.Message();
  return std::move(result.Value);
}

template <typename Change>
TemplateMapResult<2> FiveLobes(const Change& change)
{
  return Map(CircleTemplate(1001), LobedTarget(), change);
}

/// Curves at which plain TDM folds, and the row of the table on the module's page.
struct SkewedCase
{
  LobedCurve Curve;
  double PlainError;
  double PlainNegative; ///< share of the Jacobian
  double GuardedError;
  double GuardedBound; ///< of det J
};
const SkewedCase Skewed[] = { { { 0.3, 6, 0.8, 0.0 }, 4.61e-4, 0.0687, 2.39e-6, 0.0025 },
  { { 0.3, 6, 0.8, 0.3 }, 2.01e-3, 0.1374, 3.72e-6, 0.00029 },
  { { 0.3, 5, 0.8, 0.5 }, 7.79e-5, 0.1567, 1.00e-7, 0.073 } };

int LargestLevel(const SplineSpace<2>& space)
{
  int level = 0;
  for (const auto& element : space.Elements)
  {
    level = std::max(level, element.Level);
  }
  return level;
}
}

TEST(TemplateMapOptions, WeightedIsBothMethods_ExactOracle)
{
  const auto pdm = FiveLobes([](auto& p) { p.Method = TemplateMapMethod::Pdm; });
  const auto tdm = FiveLobes([](auto& p) { p.Method = TemplateMapMethod::Tdm; });
  const auto weighted = [](double point, double tangent)
  {
    return FiveLobes(
      [&](auto& p)
      {
        p.Method = TemplateMapMethod::Weighted;
        p.PdmWeight = point;
        p.TdmWeight = tangent;
      });
  };
  // Coordinates are solved together or by themselves: rounding, amplified by 20 iterations.
  const auto distance = [](const auto& a, const auto& b)
  { return (a.Map.ControlPoints - b.Map.ControlPoints).cwiseAbs().maxCoeff(); };
  EXPECT_LE(distance(weighted(1.0, 0.0), pdm), 1e-6);
  EXPECT_LE(distance(weighted(0.0, 1.0), tdm), 1e-6);
  const auto both = weighted(0.1, 1.0);
  EXPECT_GT(distance(both, pdm), 1e-4);
  EXPECT_GT(distance(both, tdm), 1e-4);
  EXPECT_LT(both.History.back().SquaredError, tdm.History.back().SquaredError);
}

TEST(TemplateMapOptions, EveryFunctionalFallsWithItsWeight_PropertyOracle)
{
  struct Functional
  {
    QualityKind Kind;
    double TemplateMapParams<2>::*Weight;
    double Value;
  };
  using P = TemplateMapParams<2>;
  const auto plain = FiveLobes([](auto&) {});
  for (const Functional& f : { Functional{ QualityKind::Uniformity, &P::UniformityWeight, 1e-5 },
         Functional{ QualityKind::Length, &P::LengthWeight, 1e-3 },
         Functional{ QualityKind::Orthogonality, &P::OrthogonalityWeight, 1e-2 },
         Functional{ QualityKind::Skewness, &P::SkewnessWeight, 1e-2 },
         Functional{ QualityKind::Eccentricity, &P::EccentricityWeight, 1e-5 },
         Functional{ QualityKind::Area, &P::AreaWeight, 1e-2 },
         Functional{ QualityKind::SelfIntersection, &P::SelfIntersectionWeight, 1e-5 } })
  {
    SCOPED_TRACE(static_cast<int>(f.Kind));
    const auto weighted = FiveLobes([&](auto& p) { p.*f.Weight = f.Value; });
    const double before = QualityValue(MakeBezierForm(plain.Map), f.Kind);
    const double after = QualityValue(MakeBezierForm(weighted.Map), f.Kind);
    EXPECT_LT(after, 0.999 * before);
    EXPECT_GT(weighted.MinJacobianBound, 0.0);
  }
}

TEST(TemplateMapOptions, TheGuardKeepsSkewedTargetsRegular_PropertyOracle)
{
  for (const SkewedCase& skewed : Skewed)
  {
    const LobedCurve& curve = skewed.Curve;
    SCOPED_TRACE(std::to_string(curve.Lobes) + ", " + std::to_string(curve.Shift));
    const Skeleton<2> skeleton = CircleTemplate(10001);
    const Skeleton<2> target = LobedTarget(curve);
    const auto plain = Map(skeleton, target, [](auto& p) { p.Guard = false; });
    EXPECT_GT(plain.History.back().NegativeShare, 0.01); // the paper's method folds
    // Half a digit of the page's numbers.
    EXPECT_NEAR(plain.History.back().SquaredError, skewed.PlainError, 5e-3 * skewed.PlainError);
    EXPECT_NEAR(plain.History.back().NegativeShare, skewed.PlainNegative, 5e-5);
    EXPECT_LT(plain.MinJacobianBound, 0.0);
    EXPECT_NE(plain.Certificate.Verdict, Verdict::Valid);
    EXPECT_NE(plain.Injectivity.Verdict, InjectivityVerdict::Injective);
    for (const auto method : { TemplateMapMethod::Tdm, TemplateMapMethod::Pdm })
    {
      const auto guarded = Map(skeleton, target, [&](auto& p) { p.Method = method; });
      EXPECT_EQ(guarded.Certificate.Verdict, Verdict::Valid);
      if (method == TemplateMapMethod::Tdm)
      {
        // Which elements are held follows from signs: rounding moves the result by more than a
        // digit's half.
        EXPECT_NEAR(
          guarded.History.back().SquaredError, skewed.GuardedError, 0.1 * skewed.GuardedError);
        EXPECT_NEAR(guarded.MinJacobianBound, skewed.GuardedBound, 0.1 * skewed.GuardedBound);
      }
      EXPECT_GT(guarded.MinJacobianBound, 0.0);
      EXPECT_EQ(guarded.Injectivity.Verdict, InjectivityVerdict::Injective);
      EXPECT_LE(guarded.History.back().SquaredError, plain.History.back().SquaredError);
      const PointMatrix grid = cases::GridOver<2>(200);
      EXPECT_GT(cases::Determinants(MakeBezierForm(guarded.Map), grid).minCoeff(), 0.0);
      for (const TemplateMapIteration& record : guarded.History)
      {
        EXPECT_EQ(record.NegativeShare, 0.0);
        EXPECT_GE(record.StepLength, 0.0);
        EXPECT_LE(record.StepLength, 1.0);
      }
    }
  }
}

TEST(TemplateMapOptions, TheGuardChangesNothingWhereNothingFolds_ExactOracle)
{
  const auto with = FiveLobes([](auto&) {});
  const auto without = FiveLobes([](auto& p) { p.Guard = false; });
  EXPECT_EQ(with.Map.ControlPoints, without.Map.ControlPoints);
  EXPECT_EQ(with.History.back().HeldElements, 0);
}

TEST(TemplateMapOptions, BoundsOfElementsAreThoseOfTheMap_CrossOracle)
{
  const auto result = FiveLobes([](auto& p) { p.Refinement = TemplateRefinement::Local; });
  const BezierForm<2> form = MakeBezierForm(result.Map);
  const auto& elements = result.Map.Space->Elements;
  ASSERT_EQ(result.ElementMinJacobian.size(), elements.size());
  ASSERT_EQ(result.ElementMaxJacobian.size(), elements.size());
  ASSERT_EQ(result.ElementErrors.size(), elements.size());
  constexpr int n = 21; // samples a direction
  double least = HUGE_VAL;
  for (std::size_t e = 0; e < elements.size(); ++e)
  {
    SCOPED_TRACE("element " + std::to_string(e));
    PointMatrix local(n * n, 2);
    for (int i = 0; i < n * n; ++i)
    {
      local.row(i) << (i % n) / (n - 1.0), (i / n) / (n - 1.0);
    }
    EvaluationBatch batch;
    ASSERT_TRUE(
      EvaluateElements<2>(form, std::vector<int>(n * n, static_cast<int>(e)), local, { 1 }, batch));
    const Eigen::ArrayXd det = (batch.First.col(0).cwiseProduct(batch.First.col(3)) -
      batch.First.col(1).cwiseProduct(batch.First.col(2)))
                                 .array();
    // Bounds hold, and are no farther than a tenth of their size from what samples find (a curve
    // between samples a twentieth apart adds little).
    constexpr double rounding = 1e-12; // of the samples, whose derivatives are about 1
    const double lower = result.ElementMinJacobian[e];
    const double upper = result.ElementMaxJacobian[e];
    EXPECT_LE(lower, det.minCoeff() + rounding);
    EXPECT_GE(upper, det.maxCoeff() - rounding);
    EXPECT_GE(lower, det.minCoeff() - 0.15 * std::abs(det.minCoeff()));
    EXPECT_LE(upper, det.maxCoeff() + 0.15 * std::abs(det.maxCoeff()));
    least = std::min(least, lower);
  }
  EXPECT_EQ(result.MinJacobianBound, least);
  // An element's error is at least that of every target sample in it, and the largest is MaxError.
  for (std::size_t p = 0; p < result.Places.size(); ++p)
  {
    for (Eigen::Index i = 0; i < result.Places[p].rows(); ++i)
    {
      EXPECT_LE(result.SampleErrors[p](i), result.History.back().MaxError);
    }
  }
  EXPECT_EQ(*std::max_element(result.ElementErrors.begin(), result.ElementErrors.end()),
    result.History.back().MaxError);
}

TEST(TemplateMapOptions, InjectivityIsLeftOutWhenNotAskedFor_ExactOracle)
{
  EXPECT_EQ(FiveLobes([](auto& p) { p.Injectivity = false; }).Injectivity.Verdict,
    InjectivityVerdict::Undecided);
  EXPECT_EQ(FiveLobes([](auto&) {}).Injectivity.Verdict, InjectivityVerdict::Injective);
}

TEST(TemplateMapOptions, AccuracyEndsIterations_ExactOracle)
{
  const auto all = FiveLobes([](auto&) {});
  const auto early = FiveLobes([&](auto& p) { p.Accuracy = all.History[5].MaxError; });
  ASSERT_LT(early.History.size(), all.History.size());
  EXPECT_LE(early.History.back().MaxError, all.History[5].MaxError);
  for (std::size_t i = 0; i + 1 < early.History.size(); ++i)
  {
    EXPECT_GT(early.History[i].MaxError, all.History[5].MaxError);
    EXPECT_EQ(early.History[i].SquaredError, all.History[i].SquaredError);
  }
}

TEST(TemplateMapOptions, IrregularIteratesAreNotKept_PropertyOracle)
{
  const Skeleton<2> skeleton = CircleTemplate(1001);
  const Skeleton<2> target = LobedTarget({ 0.2, 5, 0.35, 0.0 });
  const auto free = [](auto& p)
  {
    p.Method = TemplateMapMethod::Fixed;
    p.Guard = false;
  };
  const auto all = Map(skeleton, target, free);
  const double limit = 0.5 * all.History.back().NegativeShare;
  ASSERT_GT(limit, 0.0);
  ASSERT_LE(all.History.front().NegativeShare, limit);
  const auto ended = Map(skeleton, target,
    [&](auto& p)
    {
      free(p);
      p.MaxIrregularShare = limit;
    });
  ASSERT_LT(ended.History.size(), all.History.size());
  EXPECT_LE(ended.History.back().NegativeShare, limit);
  EXPECT_GT(all.History[ended.History.size()].NegativeShare, limit);
  // The result is the iterate of the last record.
  const auto same = Map(skeleton, target,
    [&](auto& p)
    {
      free(p);
      p.Iterations = static_cast<int>(ended.History.size());
    });
  EXPECT_EQ(ended.Map.ControlPoints, same.Map.ControlPoints);
  EXPECT_EQ(ended.SampleErrors, same.SampleErrors);
  // A first iterate that folds is the last one too.
  const auto turned = Map(skeleton, LobedTarget({ 0.3, 6, 0.8, 0.3 }),
    [&](auto& p)
    {
      free(p);
      p.MaxIrregularShare = 1e-3;
    });
  ASSERT_EQ(turned.History.size(), 1u);
  EXPECT_GT(turned.History[0].NegativeShare, 1e-3);
}

TEST(TemplateMapOptions, GlobalRefinementHalvesCells_ExactOracle)
{
  const auto result = FiveLobes(
    [](auto& p)
    {
      p.Refinement = TemplateRefinement::Global;
      p.RefineEvery = 2;
      p.Iterations = 5;
    });
  const int expected[] = { 225, 225, 729, 729, 2601 };
  for (std::size_t i = 0; i < 5; ++i)
  {
    EXPECT_EQ(result.History[i].Functions, expected[i]);
  }
  EXPECT_EQ(result.Map.Space->NumFunctions, 2601);
  EXPECT_LT(result.History[2].SquaredError, 0.1 * result.History[1].SquaredError);
}

// Published: four iterations and three refinements of every cell end with 9801 functions.
TEST(TemplateMapOptions, LocalRefinementNeedsATenthOfTheFunctions_GoldenOracle)
{
  const Skeleton<2> skeleton = CircleTemplate();
  const auto everywhere = Map(skeleton, LobedTarget(),
    [](auto& p)
    {
      p.Refinement = TemplateRefinement::Global;
      p.Iterations = 4;
    });
  EXPECT_EQ(everywhere.History.back().Functions, 9801);
  EXPECT_NEAR(everywhere.History.back().SquaredError, 7.25e-11, 0.03 * 7.25e-11);
  for (const int extension : { 1, 2 })
  {
    const auto local = Map(skeleton, LobedTarget(),
      [&](auto& p)
      {
        p.Refinement = TemplateRefinement::Local;
        p.RefineThreshold = 5e-6;
        p.Extension = extension;
        p.Iterations = 8;
      });
    EXPECT_LE(local.History.back().SquaredError, 7.3e-11);
    EXPECT_LE(local.History.back().Functions, 980);
    EXPECT_EQ(local.History.back().NegativeShare, 0.0);
    EXPECT_GT(local.MinJacobianBound, 0.0);
  }
}

TEST(TemplateMapOptions, LocalRefinementNeedsLessForAHigherThreshold_GoldenOracle)
{
  // The page's numbers; which cells are refined hangs on thresholds, hence some slack.
  const struct
  {
    double Threshold;
    int Extension;
    int Functions;
    double SquaredError;
  } rows[] = { { 5e-6, 1, 477, 4.37e-11 }, { 5e-6, 2, 871, 2.58e-11 }, { 1e-5, 1, 415, 3.88e-10 } };
  for (const auto& row : rows)
  {
    const auto local = Map(CircleTemplate(), LobedTarget(),
      [&](auto& p)
      {
        p.Refinement = TemplateRefinement::Local;
        p.RefineThreshold = row.Threshold;
        p.Extension = row.Extension;
        p.Iterations = 8;
      });
    EXPECT_NEAR(local.History.back().Functions, row.Functions, 0.02 * row.Functions);
    EXPECT_NEAR(local.History.back().SquaredError, row.SquaredError, 0.02 * row.SquaredError);
  }
}

TEST(TemplateMapOptions, LocalRefinementIsSteered_PropertyOracle)
{
  const auto run = [](const auto& change)
  {
    return FiveLobes(
      [&](auto& p)
      {
        p.Refinement = TemplateRefinement::Local;
        p.Iterations = 5;
        change(p);
      });
  };
  const auto functions = [](const auto& result) { return result.History.back().Functions; };
  const auto base = run([](auto&) {});
  EXPECT_GT(functions(base), 225);
  EXPECT_LT(functions(base), 729);
  EXPECT_LT(base.History.back().SquaredError, 1e-6);

  // Higher thresholds mark less, one above all errors nothing.
  EXPECT_GT(functions(run([](auto& p) { p.RefineThreshold = 1e-7; })), functions(base));
  EXPECT_LT(functions(run([](auto& p) { p.RefineThreshold = 1e-3; })), functions(base));
  EXPECT_EQ(functions(run([](auto& p) { p.RefineThreshold = 1.0; })), 225);
  // A share of samples raises the threshold; all samples reach every error.
  const auto all = run([](auto& p) { p.RefineThreshold = 0.0; });
  const auto some = run(
    [](auto& p)
    {
      p.RefineThreshold = 0.0;
      p.RefineShare = 0.01;
    });
  EXPECT_LT(functions(some), functions(all));
  EXPECT_EQ(functions(run(
              [](auto& p)
              {
                p.RefineThreshold = 0.0;
                p.RefineShare = 1.0;
              })),
    functions(all));
  // Extensions widen what is refined.
  EXPECT_LT(functions(run([](auto& p) { p.Extension = 0; })), functions(base));
  EXPECT_GT(functions(run([](auto& p) { p.Extension = 3; })), functions(base));
  // Bounds of depth and of number.
  EXPECT_GT(LargestLevel(*all.Map.Space), 1);
  EXPECT_EQ(LargestLevel(*run(
              [](auto& p)
              {
                p.RefineThreshold = 0.0;
                p.MaxLevel = 1;
              }).Map.Space),
    1);
  EXPECT_LE(
    functions(run([&](auto& p) { p.MaxFunctions = functions(base) - 1; })), functions(base) - 1);
  EXPECT_EQ(functions(run([](auto& p) { p.MaxFunctions = 225; })), 225);
  // When: every third time; never again after the last iteration.
  const auto third = run([](auto& p) { p.RefineEvery = 3; });
  EXPECT_EQ(third.History[2].Functions, 225);
  EXPECT_GT(third.History[3].Functions, 225);
  EXPECT_EQ(third.History[4].Functions, third.History[3].Functions);
}

TEST(TemplateMapOptions, StagnationRefines_PropertyOracle)
{
  const auto run = [](double ratio)
  {
    return FiveLobes(
      [&](auto& p)
      {
        p.Refinement = TemplateRefinement::Local;
        p.RefineEvery = 0;
        p.StagnationRatio = ratio;
        p.Iterations = 12;
      });
  };
  for (const double ratio : { 0.05, 0.5 })
  {
    const auto result = run(ratio);
    int refinements = 0;
    for (std::size_t i = 1; i + 1 < result.History.size(); ++i)
    {
      const TemplateMapIteration& row = result.History[i];
      const TemplateMapIteration& before = result.History[i - 1];
      const bool grows = result.History[i + 1].Functions > row.Functions;
      const bool stagnates =
        row.Functions == before.Functions && row.SquaredError > (1.0 - ratio) * before.SquaredError;
      EXPECT_LE(grows, stagnates) << i; // nothing may be left to refine
      refinements += grows;
    }
    EXPECT_GT(refinements, 0) << ratio;
  }
  const auto lateFirst = [](const auto& result)
  {
    std::size_t i = 0;
    while (i < result.History.size() && result.History[i].Functions == 225)
    {
      ++i;
    }
    return i;
  };
  EXPECT_GT(lateFirst(run(0.05)), lateFirst(run(0.9)));
}

TEST(TemplateMapOptions, MovedStartIsNearer_PropertyOracle)
{
  Skeleton<2> target = LobedTarget();
  for (SkeletonPatch<2>& patch : target)
  {
    patch.Points.rowwise() += Eigen::RowVector2d(3.0, -2.0);
  }
  const auto first = [&](TemplateInitialMap start)
  {
    return Map(CircleTemplate(1001), target,
      [&](auto& p)
      {
        p.Start = start;
        p.Iterations = 1;
        p.TikhonovWeight = 1.0;
      })
      .History[0]
      .SquaredError;
  };
  EXPECT_LT(first(TemplateInitialMap::Moved), 0.5 * first(TemplateInitialMap::Identity));
}

TEST(TemplateMapOptions, AGivenMapIsContinued_PropertyOracle)
{
  const auto half = FiveLobes([](auto& p) { p.Iterations = 10; });
  const auto whole = FiveLobes(
    [&](auto& p)
    {
      p.Iterations = 5;
      p.InitialMap = half.Map;
      p.Degree = 7; // not read
    });
  EXPECT_LT(whole.History.back().SquaredError, half.History.back().SquaredError);
  EXPECT_EQ(whole.Map.Space->NumFunctions, 225);
}

TEST(TemplateMapOptions, FoldsOfAGivenMapAreRemoved_PropertyOracle)
{
  Spline<2> folded = FiveLobes([](auto& p) { p.Iterations = 1; }).Map;
  const PointMatrix places = GrevillePoints(*folded.Space);
  for (Eigen::Index i = 0; i < places.rows(); ++i)
  {
    if ((places.row(i).array() - 0.5).matrix().norm() < 0.15)
    {
      folded.ControlPoints.row(i) = 1.5 * Eigen::RowVector2d(0.5, 0.5) - 0.5 * places.row(i);
    }
  }
  ASSERT_FALSE(MeasureRegularity(MakeBezierForm(folded), 1.0, 100000, 0)->IsRegular());
  const auto with = FiveLobes([&](auto& p) { p.InitialMap = folded; });
  EXPECT_GT(with.MinJacobianBound, 0.0);
  EXPECT_LT(with.History.back().SquaredError, 1e-4);
  EXPECT_LT(FiveLobes(
              [&](auto& p)
              {
                p.InitialMap = folded;
                p.Guard = false;
                p.Iterations = 1;
              })
              .MinJacobianBound,
    0.0);
  folded.ControlPoints.col(0) *= -1.0; // no moving of inner points helps
  TemplateMapParams<2> params;
  params.InitialMap = folded;
  const auto refused = MapTemplate(CircleTemplate(101), LobedTarget(), params);
  EXPECT_EQ(refused.Status.Code, ErrorCode::InvalidParameter);
  EXPECT_NE(refused.Status.Detail.find("folds"), std::string::npos);
}

TEST(TemplateMapOptions, ADomainIsKept_ExactOracle)
{
  const auto result = FiveLobes(
    [](auto& p) {
      p.Domain = ParametricBox<2>{ { -0.5, -1.0 }, { 2.0, 1.5 } };
    });
  EXPECT_EQ(result.Map.Space->Domain().Lower[1], -1.0);
  EXPECT_EQ(result.Map.Space->Domain().Upper[0], 2.0);
  EXPECT_GT(result.MinJacobianBound, 0.0);
}

TEST(TemplateMapOptions, EveryRangeIsChecked)
{
  const Skeleton<2> skeleton = CircleTemplate(101);
  const Skeleton<2> target = LobedTarget({}, 50);
  const auto expect = [&](const std::string& words, const auto& change)
  {
    TemplateMapParams<2> params;
    change(params);
    const auto result = MapTemplate(skeleton, target, params);
    EXPECT_EQ(result.Status.Code, ErrorCode::InvalidParameter) << words;
    EXPECT_NE(result.Status.Detail.find(words), std::string::npos) << result.Status.Message();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  using P = TemplateMapParams<2>;
  const std::pair<const char*, double P::*> weights[] = { { "Tikhonov weight", &P::TikhonovWeight },
    { "uniformity weight", &P::UniformityWeight }, { "length weight", &P::LengthWeight },
    { "orthogonality weight", &P::OrthogonalityWeight }, { "skewness weight", &P::SkewnessWeight },
    { "eccentricity weight", &P::EccentricityWeight }, { "area weight", &P::AreaWeight },
    { "self-intersection weight", &P::SelfIntersectionWeight }, { "accuracy", &P::Accuracy },
    { "refinement threshold", &P::RefineThreshold } };
  for (const auto& [name, member] : weights)
  {
    for (const double value : { -1e-9, nan, infinity })
    {
      expect(name, [member = member, value](auto& p) { p.*member = value; });
    }
  }
  const std::pair<const char*, double P::*> shares[] = { { "share of irregular points",
                                                           &P::MaxIrregularShare },
    { "refined share", &P::RefineShare }, { "stagnation ratio", &P::StagnationRatio } };
  for (const auto& [name, member] : shares)
  {
    for (const double value : { -1e-9, 1.1, nan })
    {
      expect(name, [member = member, value](auto& p) { p.*member = value; });
    }
  }
  for (const double value : { -1.0, nan, infinity, 0.0 })
  {
    expect("weight",
      [&](auto& p)
      {
        p.Method = TemplateMapMethod::Weighted;
        p.PdmWeight = value;
        p.TdmWeight = 0.0;
      });
  }
  expect("stagnation ratio", [](auto& p) { p.StagnationRatio = 0.0; });
  expect("stagnation ratio", [](auto& p) { p.StagnationRatio = 1.0; });
  expect("iterations between", [](auto& p) { p.RefineEvery = -1; });
  expect("extension", [](auto& p) { p.Extension = -1; });
  expect("extension", [](auto& p) { p.Extension = 101; });
  expect("largest level", [](auto& p) { p.MaxLevel = 25; });
  expect("number of functions", [](auto& p) { p.MaxFunctions = 0; });
}
