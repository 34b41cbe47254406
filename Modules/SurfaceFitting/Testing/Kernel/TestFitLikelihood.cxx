// SPDX-License-Identifier: BSD-3-Clause
#include "FitLikelihood.h"

#include "CloudCases.h"

#include <gtest/gtest.h>

namespace knotwork
{
namespace
{
FitPoints WithDistances(const std::vector<double>& distances)
{
  FitPoints points;
  points.Distance.assign(distances.begin(), distances.end());
  points.U.resize(distances.size());
  points.Base.assign(distances.size(), 1.0);
  return points;
}
}

TEST(FitLikelihood, CauchyDistances_ExactOracle)
{
  // the quantiles of a Cauchy distribution, a t-distribution with one degree of freedom
  std::vector<double> distances;
  const int n = 100000;
  for (int i = 0; i < n; ++i)
  {
    distances.push_back(0.003 * std::tan(clouds::Pi * ((i + 0.5) / n - 0.5)));
  }
  const TDistribution t = FitTDistribution(WithDistances(distances), 2);
  // classes are 1/16 wide; the cut tail of the quantiles is worth less
  EXPECT_NEAR(t.DegreesOfFreedom, 1.0, 0.01);
  EXPECT_NEAR(t.Scale, 0.003, 0.003 * 0.01);
  // entropy of the distribution is log(4 pi scale)
  EXPECT_NEAR(t.LogLikelihood / n, -std::log(4.0 * clouds::Pi * 0.003), 0.002);
}

TEST(FitLikelihood, NormalDistances_ExactOracle)
{
  std::vector<double> distances;
  clouds::Random random(3);
  double squares = 0.0;
  const int n = 200000;
  for (int i = 0; i < n; ++i)
  {
    distances.push_back(0.5 * random.Normal());
    squares += distances.back() * distances.back();
  }
  const TDistribution t = FitTDistribution(WithDistances(distances), 1);
  EXPECT_GT(t.DegreesOfFreedom, 80.0);
  const double normal = -0.5 * n * (std::log(2.0 * clouds::Pi * squares / n) + 1.0);
  EXPECT_NEAR(t.LogLikelihood / normal, 1.0, 1e-3);
}

TEST(FitLikelihood, WeightZeroDoesNotCount_PropertyOracle)
{
  FitPoints points = WithDistances({ 0.1, -0.2, 0.3, 1e6 });
  points.Base[3] = 0.0;
  EXPECT_EQ(FitTDistribution(points, 1).LogLikelihood,
    FitTDistribution(WithDistances({ 0.1, -0.2, 0.3 }), 1).LogLikelihood);
  EXPECT_EQ(FitTDistribution(WithDistances({}), 1).LogLikelihood, 0.0);
}

TEST(FitLikelihood, TheUnitDoesNotMatter_PropertyOracle)
{
  std::vector<double> distances;
  clouds::Random random(11);
  for (int i = 0; i < 5000; ++i)
  {
    distances.push_back(0.01 * random.Normal() / (0.1 + std::fabs(random.Normal())));
  }
  const TDistribution metre = FitTDistribution(WithDistances(distances), 1);
  for (const int octaves : { -300, -40, 40, 180 })
  {
    std::vector<double> other = distances;
    for (double& distance : other)
    {
      distance = std::ldexp(distance, octaves);
    }
    const TDistribution t = FitTDistribution(WithDistances(other), 1);
    EXPECT_NEAR(
      t.DegreesOfFreedom, metre.DegreesOfFreedom, 1e-9); // sums in other units round alike
    EXPECT_NEAR(std::ldexp(t.Scale, -octaves), metre.Scale, 1e-9 * metre.Scale);
    EXPECT_NEAR(t.LogLikelihood, metre.LogLikelihood - 5000 * octaves * std::log(2.0), 1e-6);
  }
}
}
