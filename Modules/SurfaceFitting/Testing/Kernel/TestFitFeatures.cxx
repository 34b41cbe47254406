// SPDX-License-Identifier: BSD-3-Clause
// Features of elements and grid cells: sums over all points of a box, as the definitions say.
#include "CloudFits.h"

#include <limits>

namespace knotwork
{
namespace
{
/// The points in a box of a partition of a domain: its upper sides belong to it at the domain's
/// end.
std::vector<std::size_t> PointsIn(
  const PointCloud& cloud, const ParametricBox<2>& box, const ParametricBox<2>& domain)
{
  std::vector<std::size_t> found;
  for (Eigen::Index i = 0; i < cloud.Parameters.rows(); ++i)
  {
    bool isInside = true;
    for (std::size_t d = 0; d < 2; ++d)
    {
      const double x = cloud.Parameters(i, static_cast<Eigen::Index>(d));
      isInside =
        isInside && x >= box.Lower[d] && (x < box.Upper[d] || box.Upper[d] >= domain.Upper[d]);
    }
    if (isInside)
    {
      found.push_back(static_cast<std::size_t>(i));
    }
  }
  return found;
}

/// Mean, largest, range and standard deviation, by two passes.
std::array<double, 4> Statistics(const std::vector<double>& x)
{
  if (x.empty())
  {
    return {};
  }
  const Eigen::Map<const Eigen::ArrayXd> v(x.data(), static_cast<Eigen::Index>(x.size()));
  return { v.mean(), v.maxCoeff(), v.maxCoeff() - v.minCoeff(),
    std::sqrt((v - v.mean()).square().mean()) };
}

void ExpectPointFeatures(const FitFeatures& features, Eigen::Index k,
  const std::vector<std::size_t>& rows, const PointCloud& cloud, const SurfaceFit& fit)
{
  std::vector<double> distances, sizes, above, below, heights;
  std::array<int, 2> outside{};
  for (const std::size_t i : rows)
  {
    if (!fit.Outliers.empty() && fit.Outliers[i] != 0)
    {
      continue;
    }
    const double d = fit.Distances[i];
    distances.push_back(d);
    sizes.push_back(std::fabs(d));
    (d > 0.0 ? above : below).push_back(std::fabs(d));
    heights.push_back(cloud.Values(static_cast<Eigen::Index>(i), 0));
    outside[d > 0.0 ? 0 : 1] += std::fabs(d) > fit.Tolerances[i] ? 1 : 0;
  }
  const auto expect = [&](FitFeature feature, double value)
  {
    EXPECT_NEAR(features.Of(feature)[k], value, 1e-13)
      << k << " " << FitFeatureNames[static_cast<int>(feature)];
  };
  const auto [meanSize, maxSize, sizeRange, sizeDeviation] = Statistics(sizes);
  const auto [mean, largest, range, deviation] = Statistics(distances);
  const auto [meanAbove, maxAbove, rangeAbove, deviationAbove] = Statistics(above);
  const auto [meanBelow, maxBelow, rangeBelow, deviationBelow] = Statistics(below);
  const auto [meanHeight, maxHeight, heightRange, heightDeviation] = Statistics(heights);
  expect(FitFeature::NumPoints, static_cast<double>(sizes.size()));
  expect(FitFeature::NumAbove, static_cast<double>(above.size()));
  expect(FitFeature::NumBelow, static_cast<double>(below.size()));
  expect(FitFeature::NumOutside, outside[0] + outside[1]);
  expect(FitFeature::NumOutsideAbove, outside[0]);
  expect(FitFeature::NumOutsideBelow, outside[1]);
  expect(FitFeature::MaxError, maxSize);
  expect(FitFeature::MeanError, meanSize);
  expect(FitFeature::Roughness, deviation);
  expect(FitFeature::DistanceRange, range);
  expect(FitFeature::MaxAbove, maxAbove);
  expect(FitFeature::MeanAbove, meanAbove);
  expect(FitFeature::DeviationAbove, deviationAbove);
  expect(FitFeature::MaxBelow, maxBelow);
  expect(FitFeature::MeanBelow, meanBelow);
  expect(FitFeature::DeviationBelow, deviationBelow);
  expect(FitFeature::MeanPointHeight, meanHeight);
  expect(FitFeature::PointHeightRange, heightRange);
  expect(FitFeature::PointHeightDeviation, heightDeviation);
}
}

TEST(FitFeatures, PointsOfElementsAndCells_CrossOracle)
{
  std::vector<std::uint8_t> labels;
  const PointCloud all = clouds::NoisyPeaksCloud(labels);
  PointCloud cloud;
  cloud.Parameters = all.Parameters.topRows(6000);
  cloud.Values = all.Values.topRows(6000);
  for (const FitSpace space : { FitSpace::LocallyRefined, FitSpace::Hierarchical })
  {
    FitParams params = WithTolerance(0.004);
    params.Space = space;
    params.MaxIterations = 2; // some points are outside
    params.FindOutliers = true;
    params.ToleranceFactorAbove = 1.5;
    params.FeatureGridSize = 7;
    params.ElementFeatures = true;
    const SurfaceFit fit = Fit(cloud, params);
    ASSERT_GT(fit.Final.NumOutside, 0U);
    ASSERT_GT(fit.Final.NumOutliers, 0U);
    const SplineSpace<2>& splines = *fit.Surface.Space;
    const ParametricBox<2> domain = splines.Domain();
    ASSERT_EQ(fit.ElementFeatures.size(), 1U);
    const FitFeatures& elements = fit.ElementFeatures[0];
    ASSERT_EQ(elements.Values.rows(), splines.NumElements());
    for (int e = 0; e < splines.NumElements(); ++e)
    {
      const ParametricBox<2>& box = splines.Elements[static_cast<std::size_t>(e)].Box;
      EXPECT_EQ(elements.Boxes[static_cast<std::size_t>(e)].Lower, box.Lower);
      EXPECT_EQ(elements.Boxes[static_cast<std::size_t>(e)].Upper, box.Upper);
      ExpectPointFeatures(elements, e, PointsIn(cloud, box, domain), cloud, fit);
      EXPECT_EQ(elements.Of(FitFeature::ElementSize)[e],
        (box.Upper[0] - box.Lower[0]) * (box.Upper[1] - box.Lower[1]));
    }
    ASSERT_EQ(fit.GridFeatures.size(), 1U);
    const FitFeatures& grid = fit.GridFeatures[0];
    ASSERT_EQ(grid.Values.rows(), 49);
    for (int k = 0; k < 49; ++k)
    {
      ParametricBox<2> box;
      for (std::size_t d = 0; d < 2; ++d)
      {
        const double step = (domain.Upper[d] - domain.Lower[d]) / 7.0;
        const int i = d == 0 ? k % 7 : k / 7;
        box.Lower[d] = domain.Lower[d] + i * step;
        box.Upper[d] = i == 6 ? domain.Upper[d] : domain.Lower[d] + (i + 1) * step;
      }
      ExpectPointFeatures(grid, k, PointsIn(cloud, box, domain), cloud, fit);
      int count = 0;
      for (const auto& element : splines.Elements)
      {
        count += element.Box.Lower[0] < box.Upper[0] - 1e-9 &&
            element.Box.Upper[0] > box.Lower[0] + 1e-9 &&
            element.Box.Lower[1] < box.Upper[1] - 1e-9 && element.Box.Upper[1] > box.Lower[1] + 1e-9
          ? 1
          : 0;
      }
      EXPECT_EQ(grid.Of(FitFeature::NumElements)[k], count);
    }
  }
}

TEST(FitFeatures, SurfaceOfAQuadric_ExactOracle)
{
  // z = 1 - 2 x + 3 x y + 2 y^2: gradient (3 y - 2, 3 x + 4 y), Laplacian 4
  const auto height = [](double x, double y) { return 1.0 - 2.0 * x + 3.0 * x * y + 2.0 * y * y; };
  const PointCloud cloud = clouds::HeightField(5000, 81, height);
  FitParams params = WithTolerance(1e-6);
  params.Domain = { { 0.0, 0.0 }, { 1.0, 1.0 } };
  params.FeatureGridSize = 5;
  params.Smoothing = 0.0;
  const SurfaceFit fit = Fit(cloud, params);
  ASSERT_EQ(fit.GridFeatures.size(), 1U);
  EXPECT_TRUE(fit.ElementFeatures.empty());
  const FitFeatures& grid = fit.GridFeatures[0];
  for (int k = 0; k < 25; ++k)
  {
    double mean = 0.0;
    double slope = 0.0;
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (int place = 0; place < 9; ++place)
    {
      const double x = (k % 5 + (2 * (place % 3) + 1) / 6.0) / 5.0;
      const double y = (k / 5 + (2 * (place / 3) + 1) / 6.0) / 5.0;
      mean += height(x, y) / 9.0;
      least = std::min(least, height(x, y));
      most = std::max(most, height(x, y));
      slope += std::hypot(3.0 * y - 2.0, 3.0 * x + 4.0 * y) / 9.0;
      if (place == 4)
      {
        EXPECT_NEAR(grid.Of(FitFeature::Height)[k], height(x, y), 1e-7);
        EXPECT_NEAR(
          grid.Of(FitFeature::Slope)[k], std::hypot(3.0 * y - 2.0, 3.0 * x + 4.0 * y), 1e-5);
      }
    }
    // the equations are solved to some 1e-8; a derivative on elements of 1/8 is ten times worse
    EXPECT_NEAR(grid.Of(FitFeature::MeanHeight)[k], mean, 1e-7);
    EXPECT_NEAR(grid.Of(FitFeature::HeightRange)[k], most - least, 1e-7);
    EXPECT_NEAR(grid.Of(FitFeature::MeanSlope)[k], slope, 1e-5);
    EXPECT_NEAR(grid.Of(FitFeature::Laplacian)[k], 4.0, 1e-3);
  }
}

TEST(FitFeatures, EveryIterationHasItsOwn_CrossOracle)
{
  const PointCloud cloud = clouds::HeightField(10000, 82, clouds::Peaks);
  for (const FitSide side : { FitSide::Both, FitSide::Above })
  {
    FitParams params = WithTolerance(0.004);
    params.Side = side;
    params.FeatureGridSize = 6;
    params.ElementFeatures = true;
    params.FeatureIterations = true;
    const SurfaceFit fit = Fit(cloud, params);
    ASSERT_GT(fit.Iterations.size(), 3U);
    ASSERT_EQ(fit.ElementFeatures.size(), fit.Iterations.size());
    ASSERT_EQ(fit.GridFeatures.size(), fit.Iterations.size());
    for (std::size_t k = 0; k < fit.Iterations.size(); ++k)
    {
      const FitIteration& row = fit.Iterations[k];
      EXPECT_EQ(fit.ElementFeatures[k].Values.rows(), row.NumElements);
      for (const FitFeatures* features : { &fit.ElementFeatures[k], &fit.GridFeatures[k] })
      {
        const auto number = features->Of(FitFeature::NumPoints);
        EXPECT_EQ(number.sum(), 10000.0);
        EXPECT_EQ(features->Of(FitFeature::NumOutside).sum(), static_cast<double>(row.NumOutside));
        EXPECT_EQ(features->Of(FitFeature::MaxError).maxCoeff(), row.MaxError);
        EXPECT_NEAR(
          features->Of(FitFeature::MeanError).dot(number) / 10000.0, row.MeanError, 1e-13);
      }
    }
    // the last ones are those of the result alone
    params.FeatureIterations = false;
    const SurfaceFit result = Fit(cloud, params);
    ASSERT_EQ(result.ElementFeatures.size(), 1U);
    EXPECT_EQ(result.ElementFeatures[0].Values, fit.ElementFeatures.back().Values);
    EXPECT_EQ(result.GridFeatures[0].Values, fit.GridFeatures.back().Values);
  }
}
}
