// SPDX-License-Identifier: BSD-3-Clause
#include "TemplateCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/TensorSpace.h>
#include <knotwork/TemplateMapping/PatchGeometry.h>
#include <knotwork/TemplateMapping/TemplateMap.h>

#include <gtest/gtest.h>

#include <limits>
#include <random>

using namespace knotwork;
using cases::CircleTemplate;
using cases::LobedTarget;

namespace
{
constexpr TemplateMapMethod Methods[] = { TemplateMapMethod::Fixed, TemplateMapMethod::Pdm,
  TemplateMapMethod::Tdm };

TemplateMapParams<2> With(TemplateMapMethod method)
{
  TemplateMapParams<2> params;
  params.Method = method;
  params.Guard = false; // as published
  return params;
}

PointMatrix Values(const Spline<2>& map, const PointMatrix& parameters)
{
  EvaluationBatch batch;
  EXPECT_TRUE(EvaluateParameters(MakeBezierForm(map), parameters, {}, batch));
  return batch.Values;
}

struct Published
{
  TemplateMapMethod Method;
  double SquaredError;
  double NegativePercent;
  double GuardedError; ///< the page's numbers with the guard
  double GuardedBound;
};
}

// The square with a circle to the square with a skewed curve of five lobes, 20 iterations: values
// of an independent implementation, rounded as given.
TEST(TemplateMap, FiveLobes_GoldenOracle)
{
  for (const Published& expected :
    { Published{ TemplateMapMethod::Fixed, 3.530e-05, 1.59, 7.33e-05, 0.0012 },
      Published{ TemplateMapMethod::Pdm, 1.985e-05, 0.483, 2.10e-07, 0.060 },
      Published{ TemplateMapMethod::Tdm, 8.715e-06, 0.000, 8.715e-06, 0.362 } })
  {
    const auto result = MapTemplate(CircleTemplate(), LobedTarget(), With(expected.Method));
    ASSERT_TRUE(result) << result.Status.Message();
    const TemplateMapIteration& last = result->History.back();
    EXPECT_EQ(last.Iteration, 20);
    EXPECT_EQ(last.Functions, 225);
    EXPECT_NEAR(last.SquaredError, expected.SquaredError, 0.03 * expected.SquaredError);
    EXPECT_NEAR(
      100.0 * last.NegativeShare, expected.NegativePercent, 0.03 * expected.NegativePercent);
    RecordProperty("seconds", std::to_string(last.Seconds));

    TemplateMapParams<2> params = With(expected.Method);
    params.Guard = true;
    const auto guarded = MapTemplate(CircleTemplate(), LobedTarget(), params);
    ASSERT_TRUE(guarded) << guarded.Status.Message();
    // Which elements are held follows from signs: rounding moves the result by more than a digit's
    // half.
    EXPECT_NEAR(
      guarded->History.back().SquaredError, expected.GuardedError, 0.1 * expected.GuardedError);
    EXPECT_NEAR(guarded->MinJacobianBound, expected.GuardedBound, 0.1 * expected.GuardedBound);
    EXPECT_EQ(guarded->History.back().NegativeShare, 0.0);
  }
}

TEST(TemplateMap, OntoItselfIsTheIdentity_ExactOracle)
{
  const Skeleton<2> skeleton = CircleTemplate(201);
  for (TemplateMapMethod method : Methods)
  {
    TemplateMapParams<2> params = With(method);
    params.Iterations = 3;
    const auto result = MapTemplate(skeleton, skeleton, params);
    ASSERT_TRUE(result);
    const PointMatrix identity = GrevillePoints(*result->Map.Space);
    const double tol = 64 * std::numeric_limits<double>::epsilon(); // rounding at unit size
    EXPECT_LE((result->Map.ControlPoints - identity).cwiseAbs().maxCoeff(), tol);
    EXPECT_LE(result->History.back().SquaredError, 1000 * tol * tol);
    EXPECT_LE(result->History.back().MaxError, tol);
    EXPECT_EQ(result->History.back().NegativeShare, 0.0);
  }
}

TEST(TemplateMap, AffineTargetIsReached_ExactOracle)
{
  Skeleton<2> skeleton = CircleTemplate(401);
  Skeleton<2> target = skeleton;
  Eigen::Matrix2d matrix;
  matrix << 1.3, 0.4, -0.2, 0.8;
  for (SkeletonPatch<2>& patch : target)
  {
    patch.Points = (patch.Points * matrix.transpose()).rowwise() + Eigen::RowVector2d(3.0, -1.0);
  }
  for (TemplateMapMethod method : { TemplateMapMethod::Fixed, TemplateMapMethod::Pdm })
  {
    TemplateMapParams<2> params = With(method);
    params.InnerKnots = { 1, 1 };
    params.TikhonovWeight = 1e-9;
    params.Iterations = 5;
    const auto result = MapTemplate(skeleton, target, params);
    ASSERT_TRUE(result);
    // What is left belongs to the proximal term, whose share falls from step to step.
    EXPECT_LE(result->History.back().MaxError, 1e-7);
    EXPECT_LT(result->History.back().SquaredError, result->History.front().SquaredError);
    const PointMatrix mapped = Values(result->Map, skeleton[4].Points);
    EXPECT_LE((mapped - target[4].Points).rowwise().norm().maxCoeff(), 1e-6);
  }
}

TEST(TemplateMap, ReportedErrorsAreThoseOfTheMap_CrossOracle)
{
  const Skeleton<2> skeleton = CircleTemplate(2001);
  const Skeleton<2> target = LobedTarget();
  for (TemplateMapMethod method : Methods)
  {
    TemplateMapParams<2> params = With(method);
    params.Iterations = 5;
    const auto result = MapTemplate(skeleton, target, params);
    ASSERT_TRUE(result);
    double squared = 0.0;
    double largest = 0.0;
    std::vector<double> inElement(result->ElementErrors.size(), 0.0);
    double local[2];
    const auto note = [&](const Eigen::RowVector2d& place, double error)
    {
      double& e =
        inElement[static_cast<std::size_t>(result->Map.Space->Locate(place.data(), local))];
      e = std::max(e, error);
    };
    for (std::size_t k = 0; k < target.size(); ++k)
    {
      const PatchCurve curve(skeleton[k].Points, Eigen::VectorXd::LinSpaced(2001, 0.0, 1.0));
      PointMatrix places(target[k].Points.rows(), 2);
      for (Eigen::Index i = 0; i < places.rows(); ++i)
      {
        curve.Evaluate(result->Places[k](i), places.row(i).data(), nullptr);
      }
      const PointMatrix feet = Values(result->Map, places);
      const Eigen::VectorXd errors = (feet - target[k].Points).rowwise().norm();
      EXPECT_LE((errors - result->SampleErrors[k]).cwiseAbs().maxCoeff(), 1e-14);
      squared += errors.squaredNorm();

      // Both ways by trying everything: samples to mapped samples, mapped samples to segments.
      const PointMatrix mapped = Values(result->Map, skeleton[k].Points);
      EXPECT_LE((mapped - result->Skeleton[k].Points).cwiseAbs().maxCoeff(), 1e-14);
      for (Eigen::Index i = 0; i < places.rows(); ++i)
      {
        note(places.row(i), errors(i));
        largest = std::max(
          largest, (mapped.rowwise() - target[k].Points.row(i)).rowwise().norm().minCoeff());
      }
      for (Eigen::Index j = 0; j < mapped.rows(); ++j)
      {
        double nearest = 1e300;
        for (Eigen::Index s = 0; s + 1 < target[k].Points.rows(); ++s)
        {
          const Eigen::RowVector2d a = target[k].Points.row(s);
          const Eigen::RowVector2d d = target[k].Points.row(s + 1) - target[k].Points.row(s);
          const double t = (mapped.row(j) - a).dot(d) / d.squaredNorm();
          nearest =
            std::min(nearest, (mapped.row(j) - a - std::min(std::max(t, 0.0), 1.0) * d).norm());
        }
        EXPECT_NEAR(result->Skeleton[k].Distances(j), nearest, 1e-14);
        note(skeleton[k].Points.row(j), nearest);
        largest = std::max(largest, nearest);
      }
    }
    const TemplateMapIteration& last = result->History.back();
    EXPECT_NEAR(last.SquaredError, squared, 1e-12 * squared);
    // Dense samples are 1e-3 apart: their nearest is farther than the foot by at most the square of
    // half of that over twice the distance, and never nearer.
    EXPECT_LE(last.MaxError, largest + 1e-14);
    EXPECT_GE(last.MaxError, largest - 5e-6);
    for (std::size_t e = 0; e < inElement.size(); ++e)
    {
      EXPECT_NEAR(result->ElementErrors[e], inElement[e], 1e-13);
    }
  }
}

TEST(TemplateMap, ThreadsDoNotChangeABit_PropertyOracle)
{
  for (TemplateMapMethod method : Methods)
  {
    TemplateMapParams<2> params = With(method);
    params.Iterations = 4;
    params.Threads = 1;
    const auto one = MapTemplate(CircleTemplate(), LobedTarget(), params);
    params.Threads = 2;
    const auto two = MapTemplate(CircleTemplate(), LobedTarget(), params);
    ASSERT_TRUE(one);
    ASSERT_TRUE(two);
    EXPECT_EQ(one->Map.ControlPoints, two->Map.ControlPoints);
    EXPECT_EQ(one->ElementErrors, two->ElementErrors);
    for (std::size_t i = 0; i < one->History.size(); ++i)
    {
      EXPECT_EQ(one->History[i].SquaredError, two->History[i].SquaredError);
      EXPECT_EQ(one->History[i].MaxError, two->History[i].MaxError);
      EXPECT_EQ(one->History[i].NegativeShare, two->History[i].NegativeShare);
    }
    for (std::size_t k = 0; k < one->Places.size(); ++k)
    {
      EXPECT_EQ(one->Places[k], two->Places[k]);
      EXPECT_EQ(one->Skeleton[k].Distances, two->Skeleton[k].Distances);
    }
  }
}

TEST(TemplateMap, MovesWithSimilarities_PropertyOracle)
{
  // Template and target scaled by 8 and shifted: the map is scaled, E by 64. Powers of two keep the
  // arithmetic but for the shift's rounding, which the iterations may amplify.
  Skeleton<2> skeleton = CircleTemplate(1001);
  Skeleton<2> target = LobedTarget();
  TemplateMapParams<2> params = With(TemplateMapMethod::Tdm);
  params.Iterations = 5;
  const auto plain = MapTemplate(skeleton, target, params);
  for (Skeleton<2>* s : { &skeleton, &target })
  {
    for (SkeletonPatch<2>& patch : *s)
    {
      patch.Points = (8.0 * patch.Points).rowwise() + Eigen::RowVector2d(16.0, -32.0);
    }
  }
  const auto moved = MapTemplate(skeleton, target, params);
  ASSERT_TRUE(plain);
  ASSERT_TRUE(moved);
  const double expected = 64.0 * plain->History.back().SquaredError;
  EXPECT_NEAR(moved->History.back().SquaredError, expected, 1e-6 * expected);
  EXPECT_NEAR(moved->History.back().NegativeShare, plain->History.back().NegativeShare, 3e-6);
}

TEST(TemplateMap, FreePatchesFollow_PropertyOracle)
{
  Skeleton<2> target = LobedTarget();
  target.erase(target.begin()); // edge 0 is free; the rest in another order
  std::swap(target[0], target[3]);
  TemplateMapParams<2> params = With(TemplateMapMethod::Tdm);
  const auto result = MapTemplate(CircleTemplate(), target, params);
  ASSERT_TRUE(result);
  ASSERT_EQ(result->Skeleton.size(), 5u);
  EXPECT_TRUE(result->Skeleton[0].Free);
  EXPECT_EQ(result->Skeleton[0].Distances.maxCoeff(), -1.0);
  EXPECT_EQ(result->Skeleton[0].Points.rows(), 10001);
  for (std::size_t k = 1; k < 5; ++k)
  {
    EXPECT_EQ(result->Skeleton[k].Id, static_cast<int>(k));
    EXPECT_FALSE(result->Skeleton[k].Free);
    EXPECT_GE(result->Skeleton[k].Distances.minCoeff(), 0.0);
    EXPECT_LE(result->Skeleton[k].Distances.maxCoeff(), result->History.back().MaxError + 1e-15);
  }
  EXPECT_LE(result->History.back().SquaredError, 1e-4);
}

TEST(TemplateMap, EveryOptionHasItsEffect_PropertyOracle)
{
  const Skeleton<2> skeleton = CircleTemplate(401);
  const Skeleton<2> target = LobedTarget();
  TemplateMapParams<2> params = With(TemplateMapMethod::Pdm);
  params.Iterations = 3;
  const auto base = MapTemplate(skeleton, target, params);
  ASSERT_TRUE(base);
  const auto errorWith = [&](auto change)
  {
    TemplateMapParams<2> changed = params;
    change(changed);
    const auto result = MapTemplate(skeleton, target, changed);
    EXPECT_TRUE(result) << result.Status.Message();
    return result->History.back();
  };
  const double before = base->History.back().SquaredError;
  EXPECT_LT(errorWith([](auto& p) { p.Iterations = 6; }).SquaredError, before);
  EXPECT_EQ(errorWith([](auto& p) { p.Degree = 2; }).Functions, 14 * 14);
  EXPECT_EQ(errorWith([](auto& p) { p.InnerKnots = { 4, 7 }; }).Functions, 8 * 11);
  EXPECT_GT(errorWith([](auto& p) { p.InnerKnots = { 2, 2 }; }).SquaredError, before);
  EXPECT_GT(errorWith([](auto& p) { p.TikhonovWeight = 1.0; }).SquaredError, before);
  EXPECT_GT(errorWith([](auto& p) { p.NewtonSteps = 0; }).SquaredError, before);
  EXPECT_NE(
    errorWith([](auto& p) { p.TemplateSamples = 77; }).MaxError, base->History.back().MaxError);
  EXPECT_NE(errorWith(
              [](auto& p) {
                p.Domain = ParametricBox<2>{ { -1, -1 }, { 2, 2 } };
              })
              .SquaredError,
    before);
  EXPECT_LT(errorWith([&](auto& p) { p.InitialMap = base->Map; }).SquaredError, before);
}

TEST(TemplateMap, GivenParametersAreUsed_ExactOracle)
{
  // The curve is the circle itself, its samples bunched; with the right parameters even Fixed is
  // exact, without them it is not.
  const Skeleton<2> skeleton = CircleTemplate(4001);
  Skeleton<2> target{ skeleton[4] };
  target[0].Points.resize(50, 2);
  target[0].Parameters.resize(50, 1);
  for (int i = 0; i < 50; ++i)
  {
    const int k = static_cast<int>(4000 * std::pow(i / 49.0, 2));
    target[0].Points.row(i) = skeleton[4].Points.row(k);
    target[0].Parameters(i, 0) = k / 4000.0;
  }
  TemplateMapParams<2> params = With(TemplateMapMethod::Fixed);
  params.Iterations = 1;
  EXPECT_LE(MapTemplate(skeleton, target, params)->History.back().SquaredError, 1e-28);
  target[0].Parameters.resize(0, 1);
  EXPECT_GT(MapTemplate(skeleton, target, params)->History.back().SquaredError, 1e-3);

  // The same in another unit of the parameter.
  Skeleton<2> rescaled = skeleton;
  rescaled[4].Parameters = Eigen::VectorXd::LinSpaced(4001, -100.0, 300.0);
  target[0].Parameters.resize(50, 1);
  for (int i = 0; i < 50; ++i)
  {
    target[0].Parameters(i, 0) =
      -100.0 + 400.0 * (static_cast<int>(4000 * std::pow(i / 49.0, 2)) / 4000.0);
  }
  EXPECT_LE(MapTemplate(rescaled, target, params)->History.back().SquaredError, 1e-24);
}

TEST(TemplateMap, ProgressRisesAndAborts_ExactOracle)
{
  TemplateMapParams<2> params = With(TemplateMapMethod::Pdm);
  params.Iterations = 4;
  std::vector<double> seen;
  params.Progress = [&](double share)
  {
    seen.push_back(share);
    return true;
  };
  ASSERT_TRUE(MapTemplate(CircleTemplate(101), LobedTarget(), params));
  EXPECT_EQ(seen, (std::vector<double>{ 0.0, 0.25, 0.5, 0.75, 1.0 }));
  params.Progress = [&](double share) { return share < 0.5; };
  const auto aborted = MapTemplate(CircleTemplate(101), LobedTarget(), params);
  EXPECT_EQ(aborted.Status.Code, ErrorCode::Aborted);
  EXPECT_EQ(aborted.Status.Detail, "before iteration 3");
  params.Progress = [&](double share) { return share < 1.0; };
  const auto late = MapTemplate(CircleTemplate(101), LobedTarget(), params);
  EXPECT_EQ(late.Status.Code, ErrorCode::Aborted);
  EXPECT_EQ(late.Status.Detail, "after the last iteration");
}

TEST(TemplateMap, EveryFailureIsReachable)
{
  const Skeleton<2> skeleton = CircleTemplate(101);
  const Skeleton<2> target = LobedTarget({}, 50);
  const auto expect = [&](ErrorCode code, const std::string& words, auto change)
  {
    TemplateMapParams<2> params;
    change(params);
    const auto result = MapTemplate(skeleton, target, params);
    EXPECT_EQ(result.Status.Code, code) << words;
    EXPECT_NE(result.Status.Detail.find(words), std::string::npos) << result.Status.Message();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect(ErrorCode::InvalidParameter, "iterations", [](auto& p) { p.Iterations = 0; });
  expect(ErrorCode::InvalidParameter, "template samples", [](auto& p) { p.TemplateSamples = 1; });
  expect(ErrorCode::InvalidParameter, "Newton steps", [](auto& p) { p.NewtonSteps = -1; });
  expect(ErrorCode::InvalidParameter, "Tikhonov", [](auto& p) { p.TikhonovWeight = -1e-9; });
  expect(ErrorCode::InvalidParameter, "Tikhonov", [&](auto& p) { p.TikhonovWeight = nan; });
  expect(ErrorCode::InvalidParameter, "uniformity weight of the initial map",
    [](auto& p) { p.InitialUniformityWeight = 0.0; });
  expect(ErrorCode::InvalidParameter, "uniformity weight of the initial map",
    [&](auto& p) { p.InitialUniformityWeight = nan; });
  expect(ErrorCode::InvalidDegree, "degree 10", [](auto& p) { p.Degree = 10; });
  expect(ErrorCode::InvalidParameter, "inner knots", [](auto& p) { p.InnerKnots = { 3, -1 }; });
  expect(ErrorCode::SingularSystem, "iteration 1", [](auto& p) { p.TikhonovWeight = 0.0; });
  expect(ErrorCode::InvalidParameter, "outside the domain in direction 1",
    [](auto& p) {
      p.Domain = ParametricBox<2>{ { 0, 0 }, { 1, 0.9 } };
    });
  expect(ErrorCode::InvalidParameter, "domain is empty in direction 0",
    [](auto& p) {
      p.Domain = ParametricBox<2>{ { 1, 0 }, { 0, 1 } };
    });
  const auto start = MapTemplate(skeleton, target).Value.Map;
  expect(ErrorCode::DimensionMismatch, "initial map", [](auto& p) { p.InitialMap.emplace(); });
  expect(ErrorCode::DimensionMismatch, "initial map",
    [&](auto& p)
    {
      p.InitialMap = start;
      p.InitialMap->Weights = Eigen::VectorXd::Ones(start.ControlPoints.rows());
    });
  expect(ErrorCode::NonFiniteInput, "initial map",
    [&](auto& p)
    {
      p.InitialMap = start;
      p.InitialMap->ControlPoints(3, 1) = nan;
    });

  Skeleton<2> line{ skeleton[0] };
  EXPECT_EQ(MapTemplate(line, line).Status.Code, ErrorCode::InvalidParameter); // no area
  EXPECT_EQ(MapTemplate(line, target).Status.Code, ErrorCode::InvalidTopology);
}
