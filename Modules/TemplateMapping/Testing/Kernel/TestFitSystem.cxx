// SPDX-License-Identifier: BSD-3-Clause
#include "BezierForm.h"
#include "FitSystem.h"
#include "TensorSpace.h"

#include <gtest/gtest.h>

#include <random>

using namespace knotwork;

namespace
{
struct Case
{
  Spline<2> Map;
  PointMatrix Points;
  FitSamples<2> Samples;

  explicit Case(unsigned seed, int samples = 120)
  {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(0.0, 1.0);
    const KnotVector u = KnotVector::Uniform(3, 5);
    const KnotVector v = KnotVector::Uniform(3, 4, 0.0, 2.0);
    this->Map.Space = MakeTensorSpace<2>({ u, v }).Value;
    this->Map.ControlPoints = GrevillePoints(*this->Map.Space);
    const auto draw = [&] { return real(random); };
    this->Samples.Parameters = PointMatrix::NullaryExpr(samples, 2, draw);
    this->Points = this->Samples.Parameters + 0.1 * PointMatrix::NullaryExpr(samples, 2, draw);
    this->Samples.Normals = (PointMatrix::NullaryExpr(samples, 2, draw).array() - 0.5).matrix();
    this->Samples.Normals.rowwise().normalize();
    this->Refresh();
  }
  PointMatrix Values(const PointMatrix& controlPoints) const
  {
    Spline<2> map = this->Map;
    map.ControlPoints = controlPoints;
    EvaluationBatch batch;
    EvaluateParameters(MakeBezierForm(map), this->Samples.Parameters, {}, batch);
    return batch.Values;
  }
  void Refresh() { this->Samples.Residuals = this->Points - this->Values(this->Map.ControlPoints); }

  /// The functional itself, from evaluations of the map: nothing of the system is used.
  double Functional(const PointMatrix& controlPoints, const FitWeights& weights) const
  {
    const PointMatrix gap = this->Values(controlPoints) - this->Points;
    return weights.Point * gap.squaredNorm() +
      weights.Normal * (gap.cwiseProduct(this->Samples.Normals)).rowwise().sum().squaredNorm() +
      weights.Proximal * (controlPoints - this->Map.ControlPoints).squaredNorm();
  }
};

const FitWeights TermsOfMethods[] = { { 1.0, 0.0, 2e-2 }, { 0.0, 1.0, 2e-2 }, { 0.3, 0.7, 1e-3 } };
}

TEST(FitSystem, GradientOfTheFunctionalVanishes_CrossOracle)
{
  for (const FitWeights& weights : TermsOfMethods)
  {
    Case c(5);
    FitSystem<2> system(c.Map.Space, weights.Normal > 0);
    const Result<PointMatrix> step = system.Step(c.Samples, weights, c.Map.ControlPoints);
    ASSERT_TRUE(step);
    const PointMatrix at = c.Map.ControlPoints + step.Value;
    // Central differences are exact for a quadratic functional up to the rounding of its values
    // (size below 2) over the difference 2 h.
    const double h = 1e-3;
    double largest = 0.0;
    double before = 0.0;
    for (Eigen::Index k = 0; k < at.size(); ++k)
    {
      const auto slope = [&](PointMatrix x)
      {
        x.data()[k] += h;
        const double up = c.Functional(x, weights);
        x.data()[k] -= 2 * h;
        return (up - c.Functional(x, weights)) / (2 * h);
      };
      largest = std::max(largest, std::abs(slope(at)));
      before = std::max(before, std::abs(slope(c.Map.ControlPoints)));
    }
    EXPECT_LE(largest, 1e-11);
    EXPECT_GT(before, 1e-2);
    EXPECT_LT(c.Functional(at, weights), c.Functional(c.Map.ControlPoints, weights));
  }
}

TEST(FitSystem, ASystemIsUsedAgain_CrossOracle)
{
  Case first(1);
  Case second(2, 300);
  FitSystem<2> system(first.Map.Space, true);
  ASSERT_TRUE(system.Step(first.Samples, TermsOfMethods[1], first.Map.ControlPoints));
  const Result<PointMatrix> used =
    system.Step(second.Samples, TermsOfMethods[1], second.Map.ControlPoints);
  const Result<PointMatrix> fresh =
    FitSystem<2>(first.Map.Space, true)
      .Step(second.Samples, TermsOfMethods[1], second.Map.ControlPoints);
  EXPECT_EQ(used.Value, fresh.Value);
}

TEST(FitSystem, CoupledAndPlainSystemsAgreeOnPoints_CrossOracle)
{
  Case c(9);
  const Result<PointMatrix> plain =
    FitSystem<2>(c.Map.Space, false).Step(c.Samples, TermsOfMethods[0], c.Map.ControlPoints);
  const Result<PointMatrix> coupled =
    FitSystem<2>(c.Map.Space, true).Step(c.Samples, TermsOfMethods[0], c.Map.ControlPoints);
  ASSERT_TRUE(plain);
  ASSERT_TRUE(coupled);
  EXPECT_LE((plain.Value - coupled.Value).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(FitSystem, NothingToCorrectIsNoStep_ExactOracle)
{
  Case c(4);
  c.Samples.Residuals.setZero();
  EXPECT_EQ(FitSystem<2>(c.Map.Space, true)
              .Step(c.Samples, TermsOfMethods[1], c.Map.ControlPoints)
              .Value.norm(),
    0.0);
}

TEST(FitSystem, EveryFailureIsReachable)
{
  Case c(3);
  FitSystem<2> system(c.Map.Space, false);
  // Samples reach v <= 1 of [0, 2]: the other control points are free.
  const Result<PointMatrix> singular =
    system.Step(c.Samples, { 1.0, 0.0, 0.0 }, c.Map.ControlPoints);
  EXPECT_EQ(singular.Status.Code, ErrorCode::SingularSystem);
  EXPECT_NE(singular.Status.Detail.find("Tikhonov"), std::string::npos);
  Case huge(3);
  huge.Samples.Residuals.setConstant(1e308);
  const Result<PointMatrix> overflow =
    system.Step(huge.Samples, { 1.0, 0.0, 1.0 }, huge.Map.ControlPoints);
  EXPECT_EQ(overflow.Status.Code, ErrorCode::SingularSystem);
  EXPECT_EQ(overflow.Status.Detail, "the step is not finite");
  c.Samples.Parameters(7, 0) = 1.5;
  const Result<PointMatrix> outside =
    system.Step(c.Samples, { 1.0, 0.0, 1.0 }, c.Map.ControlPoints);
  EXPECT_EQ(outside.Status.Code, ErrorCode::OutsideDomain);
  EXPECT_EQ(outside.Status.Detail, "sample 7");
}
