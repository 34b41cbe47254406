// SPDX-License-Identifier: BSD-3-Clause
#include "MapCases.h"
#include "RegularityGuard.h"

#include <gtest/gtest.h>

using namespace knotwork;

namespace
{
/// A map with samples on a grid that are to move, and what a guard needs.
template <int Dim>
struct Case
{
  Spline<Dim> Map = cases::IdentityMap<Dim>(2, 4);
  BezierForm<Dim> Form = MakeBezierForm(this->Map);
  FitSystem<Dim> System{ this->Map.Space, false };
  FitSamples<Dim> Samples;
  FitWeights Weights;
  RegularityGuard<Dim> Guard{ 0 };

  /// @param move  displacement of a sample at x.
  template <typename Move>
  explicit Case(const Move& move)
  {
    this->Samples.Parameters = cases::GridOver<Dim>(9);
    this->Samples.Residuals.resize(this->Samples.Parameters.rows(), Dim);
    for (Eigen::Index i = 0; i < this->Samples.Parameters.rows(); ++i)
    {
      this->Samples.Residuals.row(i) = move(this->Samples.Parameters.row(i));
    }
    this->Weights.Point = 1.0;
    this->Weights.Proximal = 1e-3;
    EXPECT_TRUE(this->Guard.Begin(this->Form));
  }

  typename RegularityGuard<Dim>::Outcome Step(double share = 1.0, bool giveUp = false)
  {
    const auto outcome = this->Guard.Step(
      this->System, this->Samples, this->Weights, this->Map, this->Form,
      [share](const PointMatrix&) { return share; }, giveUp);
    EXPECT_TRUE(outcome);
    return outcome.Value;
  }
  bool IsRegular() const { return MeasureRegularity(this->Form, 1.0, 1000000, 0)->IsRegular(); }
};

template <typename Row>
Eigen::Matrix<double, 1, Eigen::Dynamic> Slightly(const Row& x)
{
  Eigen::Matrix<double, 1, Eigen::Dynamic> move = 0.02 * x;
  move(0) *= x(1);
  return move;
}

/// Turns what is near the middle around: the map asked for folds.
template <typename Row>
Eigen::Matrix<double, 1, Eigen::Dynamic> Reversed(const Row& x)
{
  const Eigen::Matrix<double, 1, Eigen::Dynamic> out = x.array() - 0.5;
  Eigen::Matrix<double, 1, Eigen::Dynamic> move = 0.0 * out;
  move(0) = out.norm() < 0.3 ? -2.5 * out(0) : 0.0;
  return move;
}

template <int Dim>
void ExpectHeld()
{
  Case<Dim> endangered([](const auto& x) { return Reversed(x); });
  const double before = endangered.Samples.Residuals.squaredNorm();
  const auto outcome = endangered.Step();
  EXPECT_TRUE(outcome.IsEndangered);
  EXPECT_GT(outcome.Held, 0);
  EXPECT_GT(outcome.Length, 0.0);
  EXPECT_LE(outcome.Length, 1.0);
  EXPECT_TRUE(endangered.IsRegular());
  EXPECT_TRUE(endangered.Guard.IsRegular());
  // The form is the map's, and the step did some of what was asked for.
  EXPECT_EQ(MakeBezierForm(endangered.Map).Data, endangered.Form.Data);
  EvaluationBatch batch;
  ASSERT_TRUE(EvaluateParameters(endangered.Form, endangered.Samples.Parameters, {}, batch));
  const PointMatrix left =
    endangered.Samples.Residuals - (batch.Values - endangered.Samples.Parameters);
  EXPECT_LT(left.squaredNorm(), before);

  Case<Dim> folded([](const auto& x) { return Reversed(x); });
  folded.Map.ControlPoints +=
    folded.System.Step(folded.Samples, folded.Weights, folded.Map.ControlPoints).Value;
  folded.Form = MakeBezierForm(folded.Map);
  EXPECT_FALSE(folded.IsRegular()); // without the guard
}

template <int Dim>
void ExpectWhole()
{
  Case<Dim> harmless([](const auto& x) { return Slightly(x); });
  const PointMatrix before = harmless.Map.ControlPoints;
  const PointMatrix step = harmless.System.Step(harmless.Samples, harmless.Weights, before).Value;
  const auto outcome = harmless.Step();
  EXPECT_FALSE(outcome.IsEndangered);
  EXPECT_EQ(outcome.Held, 0);
  EXPECT_EQ(outcome.Length, 1.0);
  EXPECT_EQ(harmless.Map.ControlPoints, before + step);
}
}

TEST(RegularityGuard, StepsThatWouldFoldAreHeldBack_PropertyOracle)
{
  ExpectHeld<2>();
  ExpectHeld<3>();
}

TEST(RegularityGuard, HarmlessStepsAreTakenWhole_ExactOracle)
{
  ExpectWhole<2>();
  ExpectWhole<3>();
}

TEST(RegularityGuard, StepsAreShortenedAsAsked_ExactOracle)
{
  Case<2> test([](const auto& x) { return Slightly(x); });
  const PointMatrix before = test.Map.ControlPoints;
  PointMatrix step = test.System.Step(test.Samples, test.Weights, before).Value;
  step *= 0.25;
  EXPECT_EQ(test.Step(0.25).Length, 0.25);
  EXPECT_EQ(test.Map.ControlPoints, before + step);
}

TEST(RegularityGuard, GivingUpLeavesTheMapAlone_ExactOracle)
{
  Case<2> test([](const auto& x) { return Reversed(x); });
  const PointMatrix before = test.Map.ControlPoints;
  const auto outcome = test.Step(1.0, true);
  EXPECT_TRUE(outcome.IsEndangered);
  EXPECT_EQ(outcome.Length, 0.0);
  EXPECT_EQ(test.Map.ControlPoints, before);
}

TEST(RegularityGuard, HeldElementsAreLetGo_PropertyOracle)
{
  Case<2> test([](const auto& x) { return Reversed(x); });
  EXPECT_GT(test.Step().Held, 0);
  test.Samples.Residuals.setZero();
  int held = 0;
  for (int i = 0; i < 12; ++i)
  {
    held = test.Step().Held;
  }
  EXPECT_EQ(held, 0);
}
