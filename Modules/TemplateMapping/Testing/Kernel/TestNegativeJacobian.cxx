// SPDX-License-Identifier: BSD-3-Clause
#include "MapCases.h"
#include <knotwork/SplineCore/TensorSpace.h>
#include <knotwork/TemplateMapping/NegativeJacobian.h>

#include <gtest/gtest.h>

#include <random>

using namespace knotwork;

namespace
{
Spline<2> MapOn(const KnotVector& u, const KnotVector& v)
{
  Spline<2> map;
  map.Space = MakeTensorSpace<2>({ u, v }).Value;
  map.ControlPoints = GrevillePoints(*map.Space);
  return map;
}
}

TEST(NegativeJacobian, AgreesWithEvaluatingAMillionPoints_CrossOracle)
{
  double total = 0.0;
  for (unsigned seed = 1; seed <= 4; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(-1.0, 1.0);
    Spline<2> map = MapOn(KnotVector::Uniform(static_cast<int>(seed), 5, -1.0, 2.0),
      KnotVector::Create(3, { 0, 0, 0, 0, 0.1, 0.5, 0.5, 0.77, 1, 1, 1, 1 }).Value);
    map.ControlPoints +=
      0.2 * PointMatrix::NullaryExpr(map.ControlPoints.rows(), 2, [&] { return real(random); });
    const BezierForm<2> form = MakeBezierForm(map);
    PointMatrix grid(1000 * 1000, 2);
    for (int j = 0; j < 1000; ++j)
    {
      for (int i = 0; i < 1000; ++i)
      {
        grid.row(j * 1000 + i) << -1.0 + 3.0 * i / 999, double(j) / 999;
      }
    }
    EvaluationBatch batch;
    ASSERT_TRUE(EvaluateParameters(form, grid, { 1, 0 }, batch));
    int negative = 0;
    for (Eigen::Index i = 0; i < grid.rows(); ++i)
    {
      const auto d = batch.First.row(i);
      negative += d(0) * d(3) - d(1) * d(2) < 0.0;
    }
    const Result<double> share = NegativeJacobianShare(form, 1000);
    ASSERT_TRUE(share);
    // Both are exact up to points where |det J| is within rounding of zero; at degree 1 the
    // derivative jumps at element boundaries, which take the element on the right in both.
    EXPECT_NEAR(share.Value * 1e6, negative, 1.5);
    EXPECT_EQ(NegativeJacobianShare(form, 1000, 1).Value, share.Value);
    total += share.Value;
  }
  EXPECT_GT(total, 0.01); // the maps do fold
}

TEST(NegativeJacobian, InSpaceItAgreesWithEvaluatingAllPoints_CrossOracle)
{
  double total = 0.0;
  for (unsigned seed = 1; seed <= 3; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Spline<3> map = cases::IdentityMap<3>(static_cast<int>(seed), 3);
    cases::Shake(map, 0.2, seed, true);
    const BezierForm<3> form = MakeBezierForm(map);
    const Eigen::VectorXd values = cases::Determinants(form, cases::GridOver<3>(40));
    const Result<double> share = NegativeJacobianShare(form, 40);
    ASSERT_TRUE(share);
    // As above: points within rounding of zero.
    EXPECT_NEAR(share.Value * 64000, static_cast<double>((values.array() < 0.0).count()), 1.5);
    EXPECT_EQ(NegativeJacobianShare(form, 40, 1).Value, share.Value);
    total += share.Value;
  }
  EXPECT_GT(total, 0.01); // the maps do fold
  Spline<3> mirrored = cases::IdentityMap<3>(2, 2);
  EXPECT_EQ(NegativeJacobianShare(MakeBezierForm(mirrored), 30).Value, 0.0);
  mirrored.ControlPoints.col(2) *= -1.0;
  EXPECT_EQ(NegativeJacobianShare(MakeBezierForm(mirrored), 30).Value, 1.0);
  EXPECT_EQ(
    NegativeJacobianShare(MakeBezierForm(mirrored), 2001).Status.Code, ErrorCode::InvalidParameter);
}

TEST(NegativeJacobian, KnownShares_ExactOracle)
{
  const KnotVector knots = KnotVector::Uniform(2, 7);
  Spline<2> map = MapOn(knots, knots);
  EXPECT_EQ(NegativeJacobianShare(MakeBezierForm(map), 1000).Value, 0.0);
  map.ControlPoints.col(0) *= -1.0;
  EXPECT_EQ(NegativeJacobianShare(MakeBezierForm(map), 1000).Value, 1.0);
  map.ControlPoints.col(0).setZero(); // collapsed: zero is not negative
  EXPECT_EQ(NegativeJacobianShare(MakeBezierForm(map), 1000).Value, 0.0);
  map.ControlPoints.col(0) = 0.3 * map.ControlPoints.col(1); // onto a slanted line, by rounding
  EXPECT_EQ(NegativeJacobianShare(MakeBezierForm(map), 1000).Value, 0.0);

  // x = (u - 1/2)^2 as a quadratic: det J = 2 (u - 1/2), negative for the points with u < 1/2.
  map = MapOn(KnotVector::Uniform(2, 1), KnotVector::Uniform(2, 1));
  for (int j = 0; j < 3; ++j)
  {
    map.ControlPoints(3 * j + 0, 0) = 0.25;
    map.ControlPoints(3 * j + 1, 0) = -0.25;
    map.ControlPoints(3 * j + 2, 0) = 0.25;
  }
  EXPECT_DOUBLE_EQ(NegativeJacobianShare(MakeBezierForm(map), 1000).Value, 0.5);
  EXPECT_DOUBLE_EQ(NegativeJacobianShare(MakeBezierForm(map), 5).Value, 2.0 / 5); // 0 at the middle
}

TEST(NegativeJacobian, EveryFailureIsReachable)
{
  const KnotVector knots = KnotVector::Uniform(2, 2);
  Spline<2> map = MapOn(knots, knots);
  EXPECT_EQ(NegativeJacobianShare(MakeBezierForm(map), 1).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(
    NegativeJacobianShare(MakeBezierForm(map), 100001).Status.Code, ErrorCode::InvalidParameter);
  EXPECT_EQ(NegativeJacobianShare(BezierForm<2>{}, 10).Status.Code, ErrorCode::DimensionMismatch);
  map.Weights = Eigen::VectorXd::Ones(map.ControlPoints.rows());
  EXPECT_EQ(
    NegativeJacobianShare(MakeBezierForm(map), 10).Status.Code, ErrorCode::DimensionMismatch);
}
