// SPDX-License-Identifier: BSD-3-Clause
#include "CloudFits.h"

namespace knotwork
{
TEST(SurfaceFit, ACriterionKeepsAFitThatMeetsItsTolerance_PropertyOracle)
{
  const PointCloud cloud = clouds::HeightField(20000, 21, clouds::Peaks);
  for (const FitCriterion criterion : { FitCriterion::AIC, FitCriterion::BIC })
  {
    FitParams params = WithTolerance(0.005); // no noise: every refinement explains more
    params.Criterion = criterion;
    const SurfaceFit fit = Fit(cloud, params);
    EXPECT_GT(fit.Iterations.size(), 2U);
    ExpectWithin(cloud, fit);
    params.MaxIterations = 2; // ended by a limit: the last iteration is the result
    const SurfaceFit limited = Fit(cloud, params);
    EXPECT_EQ(limited.Iterations.size(), 3U);
    EXPECT_EQ(limited.Final.NumFunctions, limited.Surface.Space->NumFunctions);
    EXPECT_EQ(limited.Final.Iteration, 2);
  }
}

TEST(SurfaceFit, ElementsKeepTheirLeastSize_PropertyOracle)
{
  // a step along a line of the mesh and noise along the other direction
  clouds::Random random(5);
  PointCloud cloud =
    clouds::HeightField(20000, 31, [](double x, double) { return x < 0.5 ? 0 : 1; });
  for (Eigen::Index i = 0; i < cloud.Values.rows(); ++i)
  {
    cloud.Values(i, 0) += 0.01 * random.Normal() * (cloud.Parameters(i, 1) < 0.5 ? 1.0 : 0.0);
  }
  for (const FitSpace space : { FitSpace::LocallyRefined, FitSpace::Hierarchical })
  {
    for (const FitDirections directions :
      { FitDirections::Both, FitDirections::Alternating, FitDirections::ByError })
    {
      FitParams params = WithTolerance(0.001);
      params.Space = space;
      params.Directions = directions;
      params.Domain = { { 0.0, 0.0 }, { 1.0, 1.0 } };
      params.NumInitialElements = { 32, 8 };
      params.MinElementSize = 1.0 / 64.0;
      const SurfaceFit fit = Fit(cloud, params);
      RealArray<2> least{ 1.0, 1.0 };
      for (const auto& element : fit.Surface.Space->Elements)
      {
        for (std::size_t d = 0; d < 2; ++d)
        {
          least[d] = std::min(least[d], element.Box.Upper[d] - element.Box.Lower[d]);
        }
      }
      EXPECT_EQ(least[0], 1.0 / 64.0);
      if (space == FitSpace::Hierarchical)
      {
        EXPECT_GE(least[1], 1.0 / 64.0);
      }
      else
      {
        EXPECT_LE(least[1], 1.0 / 64.0); // goes on where the first direction is exhausted
      }
    }
  }
}

TEST(SurfaceFit, LimitsAreKept_ExactOracle)
{
  const PointCloud cloud = clouds::HeightField(20000, 16, clouds::Peaks);
  FitParams params = WithTolerance(0.0005);
  params.MaxFunctions = 250;
  const SurfaceFit functions = Fit(cloud, params);
  EXPECT_FALSE(functions.WithinTolerance);
  EXPECT_EQ(functions.End, FitEnd::Functions);
  EXPECT_LE(functions.Surface.Space->NumFunctions, 250);
  EXPECT_GT(functions.Surface.Space->NumFunctions, 225);
  EXPECT_EQ(functions.Final.NumFunctions, functions.Surface.Space->NumFunctions);

  params.MaxFunctions = 20;
  EXPECT_LE(Fit(cloud, params).Surface.Space->NumFunctions, 20);

  params.MaxFunctions = 0;
  params.MaxIterations = 2;
  const SurfaceFit iterations = Fit(cloud, params);
  EXPECT_EQ(iterations.Iterations.size(), 3U);
  EXPECT_EQ(iterations.End, FitEnd::Iterations);

  params.MaxIterations = 30;
  params.MaxSeconds = 1e-9;
  const SurfaceFit seconds = Fit(cloud, params);
  EXPECT_EQ(seconds.Iterations.size(), 1U);
  EXPECT_EQ(seconds.End, FitEnd::Seconds);

  params.MaxSeconds = 0.0;
  int calls = 0;
  double last = 0.0;
  params.Progress = [&](double share)
  {
    EXPECT_GE(share, last);
    EXPECT_LE(share, 1.0);
    last = share;
    return ++calls < 6;
  };
  EXPECT_EQ(FitSurface(cloud, params).Status.Code, ErrorCode::Aborted);
  EXPECT_EQ(calls, 6);
}

TEST(SurfaceFit, InformationCriteriaStopBeforeTheNoiseIsFitted_PropertyOracle)
{
  PointCloud cloud = clouds::HeightField(20000, 17, Wave);
  clouds::Random noise(18);
  for (Eigen::Index i = 0; i < cloud.Values.rows(); ++i)
  {
    cloud.Values(i, 0) += 0.01 * noise.Normal();
  }
  for (const FitCriterion criterion : { FitCriterion::AIC, FitCriterion::BIC })
  {
    FitParams params = WithTolerance(0.005); // half a standard deviation
    params.NumInitialElements = { 4, 4 };
    params.Threshold = FitThreshold::All;
    params.Criterion = criterion;
    const SurfaceFit fit = Fit(cloud, params);
    EXPECT_FALSE(fit.WithinTolerance);
    EXPECT_EQ(fit.End, FitEnd::Criterion);
    const auto value = [&](const FitIteration& row)
    { return criterion == FitCriterion::AIC ? row.AIC : row.BIC; };
    ASSERT_GE(fit.Iterations.size(), 3U);
    for (const FitIteration& row : fit.Iterations)
    {
      EXPECT_GE(value(row) + 1e-9 * std::fabs(value(row)), value(fit.Final));
    }
    EXPECT_EQ(fit.Final.NumFunctions, fit.Surface.Space->NumFunctions);
    EXPECT_NEAR(fit.Final.RmsError, 0.01, 0.0003);
  }
}
}
