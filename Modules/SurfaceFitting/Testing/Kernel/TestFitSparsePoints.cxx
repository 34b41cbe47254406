// SPDX-License-Identifier: BSD-3-Clause
#include "CloudFits.h"

namespace knotwork
{
namespace
{
/// A grid of 301 x 301 places of the unit square.
PointCloud Grid()
{
  constexpr int n = 301;
  PointCloud grid;
  grid.Parameters.resize(n * n, 2);
  grid.Values.setZero(n * n, 1);
  for (int i = 0; i < n * n; ++i)
  {
    grid.Parameters.row(i) << (i % n) / (n - 1.0), (i / n) / (n - 1.0);
  }
  return grid;
}

/// Expects a surface over the unit square that hardly leaves the range of the points.
void ExpectNoSpikes(const PointCloud& cloud, const SurfaceFit& fit, double share)
{
  const double lowest = cloud.Values.col(0).minCoeff();
  const double highest = cloud.Values.col(0).maxCoeff();
  double most = 0.0; // outside the range
  for (const double minusHeight : Measure(Grid(), fit.Surface, 1))
  {
    most = std::max({ most, lowest + minusHeight, -minusHeight - highest });
  }
  EXPECT_LE(most, share * (highest - lowest));
}
}

TEST(SurfaceFit, AGapIsBridged_PropertyOracle)
{
  // a slope without points on the right half of the square
  PointCloud cloud = clouds::HeightField(4000, 12, [](double x, double y) { return x - 2.0 * y; });
  cloud.Parameters.col(0) *= 0.4;
  for (Eigen::Index i = 0; i < cloud.Values.rows(); ++i)
  {
    cloud.Values(i, 0) = cloud.Parameters(i, 0) - 2.0 * cloud.Parameters(i, 1);
  }
  FitParams params = WithTolerance(1e-4);
  params.Domain = { { 0.0, 0.0 }, { 1.0, 1.0 } };
  const SurfaceFit fit = Fit(cloud, params);
  ExpectWithin(cloud, fit);
  // Without points the surface bends little: it goes on as the plane, five times as far as the
  // tolerance would reach along a line from the points' width to the domain's (0.4 to 1).
  const PointCloud grid = Grid();
  const std::vector<double> minusHeights = Measure(grid, fit.Surface, 1);
  for (std::size_t i = 0; i < minusHeights.size(); ++i)
  {
    const auto at = grid.Parameters.row(static_cast<Eigen::Index>(i));
    ASSERT_NEAR(-minusHeights[i], at(0) - 2.0 * at(1), 5e-3) << at;
  }
}

TEST(SurfaceFit, SparsePointsGiveNoSpikes_PropertyOracle)
{
  // undamped, the surfaces leave the range of these points by 1.5 to 200 times its size
  const clouds::Terrain terrain;
  const PointCloud sparse = clouds::HeightField(1813, 32, terrain);
  PointCloud lines = clouds::HeightField(10000, 33, terrain);
  PointCloud hole = clouds::HeightField(50000, 34, terrain);
  PointCloud clusters = clouds::HeightField(5000, 35, terrain);
  const auto move = [&](PointCloud& cloud, const auto& place)
  {
    for (Eigen::Index i = 0; i < cloud.Values.rows(); ++i)
    {
      double& x = cloud.Parameters(i, 0);
      double& y = cloud.Parameters(i, 1);
      place(i, x, y);
      cloud.Values(i, 0) = terrain(x, y);
    }
  };
  move(lines, [](Eigen::Index i, double&, double& y) { y = static_cast<double>(i % 20) / 19.0; });
  move(hole,
    [](Eigen::Index, double& x, double& y)
    {
      const double r = std::hypot(x - 0.5, y - 0.5);
      const double factor = r < 0.25 ? (0.25 + 0.5 * r) / r : 1.0;
      x = 0.5 + factor * (x - 0.5);
      y = 0.5 + factor * (y - 0.5);
    });
  move(clusters,
    [](Eigen::Index i, double& x, double& y)
    {
      const double k = static_cast<double>(i % 7);
      x = 0.1 + 0.13 * k + 0.06 * (x - 0.5);
      y = 0.5 + 0.4 * std::sin(3.0 * k) + 0.06 * (y - 0.5);
    });
  const std::pair<PointCloud, double> cases[] = { { sparse, 0.001 }, { lines, 0.005 },
    { hole, 0.01 }, { clusters, 0.002 }, { clouds::TerrainCloud(), 0.01 } };
  for (const auto& [cloud, tolerance] : cases)
  {
    for (const FitSpace space : { FitSpace::LocallyRefined, FitSpace::Hierarchical })
    {
      SCOPED_TRACE("points: " + std::to_string(cloud.Values.rows()));
      FitParams params = WithTolerance(tolerance);
      params.Space = space;
      params.Domain = { { 0.0, 0.0 }, { 1.0, 1.0 } };
      const SurfaceFit fit = Fit(cloud, params);
      ExpectNoSpikes(cloud, fit, 0.2);
      ExpectWithin(cloud, fit);
    }
  }
}

TEST(SurfaceFit, ErrorBetweenScatteredPoints_PropertyOracle)
{
  // a quadratic of points at their spacing h is off by about h^3 / 6 times the third derivative
  const PointCloud cloud = clouds::HeightField(2000, 31, Wave);
  const double limited = std::pow(2000.0, -1.5) / 6.0 * 0.3 * 7.0 * 7.0 * 7.0;
  const PointCloud grid = Grid();
  for (const double tolerance : { 1e-4, 1e-6 })
  {
    for (const FitSpace space : { FitSpace::LocallyRefined, FitSpace::Hierarchical })
    {
      FitParams params = WithTolerance(tolerance);
      params.Space = space;
      params.Domain = { { 0.0, 0.0 }, { 1.0, 1.0 } };
      const std::vector<double> heights = Measure(grid, Fit(cloud, params).Surface, 1);
      double squares = 0.0;
      double most = 0.0;
      for (std::size_t i = 0; i < heights.size(); ++i)
      {
        const auto row = static_cast<Eigen::Index>(i);
        const double error = Wave(grid.Parameters(row, 0), grid.Parameters(row, 1)) + heights[i];
        squares += error * error;
        most = std::max(most, std::fabs(error));
      }
      EXPECT_LE(std::sqrt(squares / static_cast<double>(heights.size())), limited);
      EXPECT_LE(most, 20.0 * limited); // in the corners, where it is extrapolated
    }
  }
}

TEST(SurfaceFit, NoiseTakesNoMoreFunctionsThanAllowed_PropertyOracle)
{
  PointCloud cloud = clouds::HeightField(5000, 36, Wave);
  clouds::Random noise(37);
  for (Eigen::Index i = 0; i < cloud.Values.rows(); ++i)
  {
    cloud.Values(i, 0) += 0.05 * noise.Normal();
  }
  for (const FitSpace space : { FitSpace::LocallyRefined, FitSpace::Hierarchical })
  {
    FitParams params = WithTolerance(0.01);
    params.Space = space;
    params.Domain = { { 0.0, 0.0 }, { 1.0, 1.0 } };
    params.MaxFunctions = 5000;
    const SurfaceFit fit = Fit(cloud, params);
    EXPECT_FALSE(fit.WithinTolerance);
    EXPECT_EQ(fit.End, FitEnd::Functions);
    EXPECT_LE(fit.Final.NumFunctions, 5000);
    EXPECT_GT(fit.Final.NumFunctions, 3000);
    EXPECT_LT(fit.Iterations.size(), 20U);
    ExpectNoSpikes(cloud, fit, 0.5);
  }
}
}
