// SPDX-License-Identifier: BSD-3-Clause
#include "CloudFits.h"

namespace knotwork
{
namespace
{
/// Adds 0.1 to 0.5 up or down to a share of the points. @return the rows.
std::vector<bool> Disturb(PointCloud& cloud, double share, unsigned seed)
{
  clouds::Random random(seed);
  std::vector<bool> labels;
  for (Eigen::Index i = 0; i < cloud.Values.rows(); ++i)
  {
    labels.push_back(random.Uniform() < share);
    const double size = 0.1 + 0.4 * random.Uniform();
    const double sign = random.Uniform() < 0.5 ? 1.0 : -1.0;
    const double noise = 0.001 * random.Normal();
    cloud.Values(i, 0) += labels.back() ? sign * size : noise;
  }
  return labels;
}
}

TEST(SurfaceFit, OutliersAreFoundAndFeaturesAreNot_CrossOracle)
{
  std::vector<std::uint8_t> labels;
  const PointCloud cloud = clouds::NoisyPeaksCloud(labels);
  FitParams params = WithTolerance(0.01);
  params.FindOutliers = true;
  const SurfaceFit fit = Fit(cloud, params);
  ExpectWithin(cloud, fit);
  ASSERT_EQ(fit.Outliers.size(), labels.size());
  std::size_t found = 0;
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < labels.size(); ++i)
  {
    found += fit.Outliers[i] != 0 && labels[i] != 0 ? 1 : 0;
    wrong += fit.Outliers[i] != 0 && labels[i] == 0 ? 1 : 0;
  }
  EXPECT_GE(found, 508U); // 95 % of 534
  EXPECT_LE(wrong, 10U);  // 2 %
  EXPECT_EQ(fit.Final.NumOutliers, found + wrong);
  PointCloud truth = cloud;
  for (Eigen::Index i = 0; i < truth.Values.rows(); ++i)
  {
    truth.Values(i, 0) = clouds::Peaks(truth.Parameters(i, 0), truth.Parameters(i, 1));
  }
  double squares = 0.0;
  for (const double d : Measure(truth, fit.Surface, 1))
  {
    squares += d * d;
  }
  EXPECT_LE(std::sqrt(squares / static_cast<double>(labels.size())), 5.9e-4);
}

// Three values in five are 0, the others +-1: their deviation is 0.63, that of the median 0. So
// with three standard deviations the values of +-1 are none, with medians many are.
TEST(SurfaceFit, OutliersByTheStandardDeviation_ExactOracle)
{
  clouds::Random random(65);
  PointCloud cloud;
  cloud.Parameters.resize(3600, 2);
  cloud.Values.resize(3600, 1);
  std::vector<std::uint8_t> planted(3600, 0);
  for (int i = 0; i < 3600; ++i)
  {
    cloud.Parameters.row(i) << (i % 60) / 60.0, (i / 60) / 60.0;
    const double which = random.Uniform();
    cloud.Values(i, 0) = which < 0.6 ? 0.0 : (which < 0.8 ? 1.0 : -1.0);
    if (i % 60 % 12 == 6 && i / 60 % 12 == 6)
    {
      planted[static_cast<std::size_t>(i)] = 1;
      cloud.Values(i, 0) = i % 24 == 6 ? 10.0 : -10.0;
    }
  }
  FitParams params = WithTolerance(0.5);
  params.FindOutliers = true;
  params.OutlierScale = 3.0;
  params.NumInitialElements = { 1, 1 };
  params.MaxIterations = 0;
  params.OutlierDeviation = FitDeviation::Standard;
  EXPECT_EQ(Fit(cloud, params).Outliers, planted);
  params.OutlierDeviation = FitDeviation::Robust;
  EXPECT_GT(Fit(cloud, params).Final.NumOutliers, 200U);
  // four standard deviations of a normal distribution: hardly one in 15,000 is beyond
  for (Eigen::Index i = 0; i < 3600; ++i)
  {
    cloud.Values(i, 0) = planted[static_cast<std::size_t>(i)] != 0 ? 10.0 : random.Normal();
  }
  params.OutlierDeviation = FitDeviation::Standard;
  params.OutlierScale = 5.0;
  EXPECT_EQ(Fit(cloud, params).Outliers, planted);
}

TEST(SurfaceFit, OutliersNearACliffAndManyOfThem_CrossOracle)
{
  // the terrain has a cliff 0.001 wide, a fifth of the points' spacing
  const std::pair<PointCloud, double> cases[] = {
    { clouds::HeightField(40000, 5, clouds::Terrain()), 0.005 },
    { clouds::HeightField(40000, 6, clouds::Peaks), 0.05 }
  };
  for (auto [cloud, share] : cases)
  {
    SCOPED_TRACE(share);
    const std::vector<bool> labels = Disturb(cloud, share, 64);
    FitParams params = WithTolerance(0.01);
    params.FindOutliers = true;
    const SurfaceFit fit = Fit(cloud, params);
    ExpectWithin(cloud, fit);
    double all = 0.0;
    double found = 0.0;
    for (std::size_t i = 0; i < labels.size(); ++i)
    {
      all += labels[i] ? 1.0 : 0.0;
      found += labels[i] && fit.Outliers[i] != 0 ? 1.0 : 0.0;
    }
    EXPECT_GE(found, 0.95 * all);
    EXPECT_LE(static_cast<double>(fit.Final.NumOutliers) - found, 0.02 * all);
  }
}

TEST(SurfaceFit, OutliersInSpace_CrossOracle)
{
  // where the surface is steep in one coordinate, an outlier is off in the others, too
  const PointCloud flat = clouds::HeightField(20000, 65, Wave);
  PointCloud cloud = flat;
  cloud.Values.resize(20000, 3);
  clouds::Random random(66);
  std::vector<bool> labels;
  for (Eigen::Index i = 0; i < 20000; ++i)
  {
    const double u = 2.0 * clouds::Pi * cloud.Parameters(i, 0);
    const double v = clouds::Pi * (cloud.Parameters(i, 1) - 0.5);
    cloud.Values.row(i) << std::cos(u) * std::cos(v), std::sin(u) * std::cos(v), std::sin(v);
    labels.push_back(random.Uniform() < 0.01);
    for (Eigen::Index c = 0; c < 3; ++c)
    {
      cloud.Values(i, c) += 0.001 * random.Normal() + (labels.back() ? random.Normal() : 0.0);
    }
  }
  FitParams params = WithTolerance(0.006);
  params.NumMeasured = 3;
  params.FindOutliers = true;
  const SurfaceFit fit = Fit(cloud, params);
  ExpectWithin(cloud, fit, 3);
  std::size_t missed = 0;
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < labels.size(); ++i)
  {
    missed += labels[i] && fit.Outliers[i] == 0 ? 1 : 0;
    wrong += !labels[i] && fit.Outliers[i] != 0 ? 1 : 0;
  }
  EXPECT_LE(missed, 2U); // of 200; nearer than the tolerance by chance
  EXPECT_LE(wrong, 2U);
}

TEST(SurfaceFit, ACliffIsNoOutlier_PropertyOracle)
{
  // a fifth of the points' spacing wide: those half way up are alone
  const PointCloud cloud = clouds::HeightField(40000, 5, clouds::Terrain());
  FitParams params = WithTolerance(0.01);
  params.FindOutliers = true;
  for (const int iterations : { 6, 30 })
  {
    params.MaxIterations = iterations;
    EXPECT_LE(Fit(cloud, params).Final.NumOutliers, 4U);
  }
}

TEST(SurfaceFit, ANarrowRidgeIsNoOutlier_PropertyOracle)
{
  // 0.004 wide at a mean spacing of 0.005, while the elements are still wide: without the nearest
  // points' say more than 400 points of it are taken for outliers
  const PointCloud cloud = clouds::HeightField(
    40000, 5, [](double x, double y) { return 0.3 * std::exp(-std::pow((x - y) / 0.004, 2)); });
  FitParams params = WithTolerance(0.01);
  params.FindOutliers = true;
  params.MaxIterations = 3;
  const SurfaceFit fit = Fit(cloud, params);
  EXPECT_GT(fit.Final.NumOutside, 1000U);
  EXPECT_LE(fit.Final.NumOutliers, 40U);
}
}
