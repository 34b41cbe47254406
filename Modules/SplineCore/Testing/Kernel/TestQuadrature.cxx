// SPDX-License-Identifier: BSD-3-Clause
#include "SplineOracle.h"
#include <knotwork/SplineCore/Quadrature.h>

#include <gtest/gtest.h>

#include <cmath>

using knotwork::GaussLegendre;
using oracle::Epsilon;

TEST(Quadrature, ClosedForms_ExactOracle)
{
  const auto two = GaussLegendre(2);
  EXPECT_NEAR(two.Nodes[0], 0.5 - 0.5 / std::sqrt(3.0), Epsilon);
  EXPECT_NEAR(two.Weights[0], 0.5, Epsilon);
  const auto three = GaussLegendre(3);
  EXPECT_NEAR(three.Nodes[2], 0.5 + 0.5 * std::sqrt(0.6), Epsilon);
  EXPECT_EQ(three.Nodes[1], 0.5);
  EXPECT_NEAR(three.Weights[1], 4.0 / 9.0, Epsilon);
  const auto five = GaussLegendre(5);
  EXPECT_NEAR(five.Nodes[4], 0.5 + std::sqrt(5.0 + 2.0 * std::sqrt(10.0 / 7.0)) / 6.0, Epsilon);
  EXPECT_NEAR(five.Weights[0], (322.0 - 13.0 * std::sqrt(70.0)) / 1800.0, Epsilon);
}

TEST(Quadrature, MonomialsUpToTwiceTheSizeLessOne_ExactOracle)
{
  for (int n = 1; n <= 64; ++n)
  {
    const auto rule = GaussLegendre(n);
    ASSERT_EQ(rule.Nodes.size(), static_cast<std::size_t>(n));
    for (int k = 0; k < 2 * n; ++k)
    {
      oracle::Real sum = 0;
      for (int i = 0; i < n; ++i)
      {
        sum += rule.Weights[i] * std::pow(static_cast<oracle::Real>(rule.Nodes[i]), k);
      }
      // rounding of a node moves the integral of k x^(k-1) by at most eps / 2, of the weights too
      ASSERT_NEAR(static_cast<double>(sum), 1.0 / (k + 1), 2 * Epsilon) << n << " points, x^" << k;
    }
  }
}

TEST(Quadrature, FirstPowerThatIsNotExact_ExactOracle)
{
  for (int n = 1; n <= 6; ++n)
  {
    const auto rule = GaussLegendre(n);
    double sum = 0.0;
    for (int i = 0; i < n; ++i)
    {
      sum += rule.Weights[i] * std::pow(rule.Nodes[i], 2 * n);
    }
    // error term (n!)^4 / ((2n + 1) ((2n)!)^2)
    const double ratio = std::tgamma(n + 1.0) * std::tgamma(n + 1.0) / std::tgamma(2 * n + 1.0);
    const double error = ratio * ratio / (2 * n + 1);
    EXPECT_NEAR(1.0 / (2 * n + 1) - sum, error, 4 * Epsilon);
  }
}

TEST(Quadrature, NodesAscendMirroredWithPositiveWeights_PropertyOracle)
{
  for (int n = 1; n <= 64; ++n)
  {
    const auto rule = GaussLegendre(n);
    double previous = 0.0;
    for (int i = 0; i < n; ++i)
    {
      ASSERT_GT(rule.Nodes[i], previous);
      ASSERT_GT(rule.Weights[i], 0.0);
      ASSERT_NEAR(rule.Nodes[i], 1.0 - rule.Nodes[n - 1 - i], Epsilon);
      ASSERT_EQ(rule.Weights[i], rule.Weights[n - 1 - i]);
      previous = rule.Nodes[i];
    }
    ASSERT_LT(previous, 1.0);
  }
}

TEST(Quadrature, TensorRule_ExactOracle)
{
  const auto rule = knotwork::MakeElementQuadrature<3>({ 2, 3, 4 });
  ASSERT_EQ(rule.Local.rows(), 24);
  EXPECT_EQ(rule.Local(0, 0), GaussLegendre(2).Nodes[0]);
  EXPECT_EQ(rule.Local(1, 0), GaussLegendre(2).Nodes[1]); // first direction fastest
  EXPECT_EQ(rule.Local(2, 1), GaussLegendre(3).Nodes[1]);
  EXPECT_EQ(rule.Local(6, 2), GaussLegendre(4).Nodes[1]);
  double sum = 0.0;
  for (int i = 0; i < 24; ++i)
  {
    sum += rule.Weights[i] * std::pow(rule.Local(i, 0), 3) * std::pow(rule.Local(i, 1), 5) *
      std::pow(rule.Local(i, 2), 7);
  }
  EXPECT_NEAR(sum, 1.0 / (4 * 6 * 8), 4 * Epsilon);
  EXPECT_NEAR(rule.Weights.sum(), 1.0, 8 * Epsilon);
  EXPECT_EQ(knotwork::MakeElementQuadrature<1>({ 5 }).Local.rows(), 5);
  EXPECT_EQ(knotwork::MakeElementQuadrature<2>({ 5, 2 }).Local.rows(), 10);
}
