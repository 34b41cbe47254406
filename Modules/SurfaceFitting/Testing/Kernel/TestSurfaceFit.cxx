// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceFit.h"

#include "BasisEvaluation.h"
#include "BezierForm.h"
#include "CloudCases.h"
#include "LRDependence.h"

#include <gtest/gtest.h>

#include <limits>

namespace knotwork
{
namespace
{
/// Distances of a result's surface, evaluated by the code for all splines.
std::vector<double> Measure(const PointCloud& cloud, const Spline<2>& surface, int measured)
{
  EvaluationBatch batch;
  const Status status =
    EvaluateParameters<2>(MakeBezierForm<2>(surface), cloud.Parameters, {}, batch);
  EXPECT_TRUE(status) << status.Message();
  std::vector<double> distances;
  for (Eigen::Index i = 0; i < cloud.Values.rows(); ++i)
  {
    const auto difference =
      (cloud.Values.row(i).head(measured) - batch.Values.row(i).head(measured)).eval();
    distances.push_back(measured == 1 ? difference(0) : difference.norm());
  }
  return distances;
}

/// Reported and measured distances are the same and within the tolerances.
void ExpectWithin(const PointCloud& cloud, const SurfaceFit& fit, int measured = 1)
{
  EXPECT_TRUE(fit.WithinTolerance);
  EXPECT_EQ(fit.Final.NumOutside, 0U);
  ASSERT_TRUE(fit.Surface.Check());
  const std::vector<double> distances = Measure(cloud, fit.Surface, measured);
  const double rounding = 1e-13 * (1.0 + fit.Surface.ControlPoints.cwiseAbs().maxCoeff());
  double most = 0.0;
  for (std::size_t i = 0; i < distances.size(); ++i)
  {
    if (!fit.Outliers.empty() && fit.Outliers[i] != 0)
    {
      continue;
    }
    ASSERT_NEAR(distances[i], fit.Distances[i], rounding) << "point " << i;
    ASSERT_LE(std::fabs(distances[i]), fit.Tolerances[i] + rounding) << "point " << i;
    most = std::max(most, std::fabs(distances[i]));
  }
  EXPECT_NEAR(most, fit.Final.MaxError, rounding);
}

SurfaceFit Fit(const PointCloud& cloud, const FitParams& params)
{
  auto fit = FitSurface(cloud, params);
  EXPECT_TRUE(fit) << fit.Status.Message();
  return std::move(fit.Value);
}

FitParams WithTolerance(double tolerance)
{
  FitParams params;
  params.Tolerance = tolerance;
  return params;
}

double Wave(double x, double y)
{
  return 0.3 * std::sin(7.0 * x) * std::cos(5.0 * y) + 0.1 * x;
}

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

TEST(SurfaceFit, PeaksNeedAtMost490Functions_CrossOracle)
{
  const PointCloud cloud = clouds::PeaksCloud();
  const SurfaceFit fit = Fit(cloud, WithTolerance(0.002));
  ExpectWithin(cloud, fit);
  EXPECT_LE(fit.Surface.Space->NumFunctions, 490);
}

TEST(SurfaceFit, AMillionPointsNeedAtMost523Functions_CrossOracle)
{
  const PointCloud cloud = clouds::LargePeaksCloud();
  const SurfaceFit fit = Fit(cloud, WithTolerance(0.002));
  ExpectWithin(cloud, fit);
  EXPECT_LE(fit.Surface.Space->NumFunctions, 523);
}

TEST(SurfaceFit, TheCliffNeedsAtMost12394Functions_CrossOracle)
{
  const PointCloud cloud = clouds::TerrainCloud();
  const SurfaceFit fit = Fit(cloud, WithTolerance(0.01));
  ExpectWithin(cloud, fit);
  EXPECT_LE(fit.Surface.Space->NumFunctions, 12394);
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

TEST(SurfaceFit, ThreadsDoNotMatter_ExactOracle)
{
  std::vector<std::uint8_t> labels;
  const PointCloud cloud = clouds::NoisyPeaksCloud(labels);
  for (const FitSpace space : { FitSpace::LocallyRefined, FitSpace::Hierarchical })
  {
    for (const FitMethod method :
      { FitMethod::LeastSquares, FitMethod::MultilevelApproximation, FitMethod::Combined })
    {
      FitParams params = WithTolerance(0.01);
      params.Space = space;
      params.Method = method;
      params.SwitchIteration = 2;
      params.FindOutliers = true;
      params.Threads = 1;
      const SurfaceFit one = Fit(cloud, params);
      ExpectWithin(cloud, one);
      for (const int threads : { 2, 4 })
      {
        params.Threads = threads;
        const SurfaceFit other = Fit(cloud, params);
        EXPECT_EQ(one.Surface.ControlPoints, other.Surface.ControlPoints);
        EXPECT_EQ(one.Distances, other.Distances);
        EXPECT_EQ(one.Outliers, other.Outliers);
        EXPECT_EQ(one.Final.LogLikelihood, other.Final.LogLikelihood);
      }
    }
  }
}

TEST(SurfaceFit, LeastSquaresSolveTheNormalEquations_CrossOracle)
{
  const PointCloud cloud = clouds::HeightField(600, 11, Wave);
  for (const IntArray<2> degree : { IntArray<2>{ 2, 2 }, { 3, 3 }, { 1, 4 } })
  {
    for (const FitSpace space : { FitSpace::LocallyRefined, FitSpace::Hierarchical })
    {
      // a tolerance that a split of the whole mesh does not reach, and a precise solution for it
      FitParams params = WithTolerance(1e-9);
      params.Space = space;
      params.Degree = degree;
      params.NumInitialElements = { 3, 2 };
      params.MaxIterations = 1;
      params.Smoothing = 0.0;
      const SurfaceFit fit = Fit(cloud, params);
      const auto matrix = CollocationMatrix<2>(*fit.Surface.Space, cloud.Parameters, 0);
      ASSERT_TRUE(matrix);
      const Eigen::MatrixXd dense = matrix.Value;
      const Eigen::VectorXd residual =
        cloud.Values.col(0) - dense * fit.Surface.ControlPoints.col(0);
      // the coefficients' accuracy times a row of the Gram matrix (its sum is a column's sum)
      EXPECT_LE((dense.transpose() * residual).cwiseAbs().maxCoeff(),
        1e-9 * dense.colwise().sum().maxCoeff());
      EXPECT_GT(residual.cwiseAbs().maxCoeff(), 1e-7);
    }
  }
}

TEST(SurfaceFit, OneMultilevelStepPassesThroughASinglePoint_GoldenOracle)
{
  // bilinear on one element, a point at (1/4, 1/2): w = (3, 1, 3, 1) / 8, sum w^2 = 20 / 64, so
  // from height 0 on, coefficients are 4 w / sum w^2 = (4.8, 1.6, 4.8, 1.6)
  PointCloud cloud;
  cloud.Parameters.resize(1, 2);
  cloud.Parameters << 0.25, 0.5;
  cloud.Values.resize(1, 1);
  cloud.Values << 4.0;
  FitParams params = WithTolerance(1e-6);
  params.Method = FitMethod::MultilevelApproximation;
  params.Smoothing = 0.0;
  params.Degree = { 1, 1 };
  params.NumInitialElements = { 1, 1 };
  params.Domain = { { 0.0, 0.0 }, { 1.0, 1.0 } };
  const SurfaceFit fit = Fit(cloud, params);
  ASSERT_EQ(fit.Surface.ControlPoints.rows(), 4);
  const double expected[4] = { 4.8, 1.6, 4.8, 1.6 };
  for (int i = 0; i < 4; ++i)
  {
    EXPECT_NEAR(fit.Surface.ControlPoints(i, 0), expected[i], 1e-14);
  }
}

TEST(SurfaceFit, PolynomialsAreReproduced_ExactOracle)
{
  const auto quadric = [](double x, double y) { return 1.0 - 2.0 * x + 3.0 * x * y + y * y; };
  const PointCloud cloud = clouds::HeightField(2000, 3, quadric);
  const SurfaceFit fit = Fit(cloud, WithTolerance(1e-6));
  ExpectWithin(cloud, fit);
  EXPECT_EQ(fit.Iterations.size(), 1U);
}

TEST(SurfaceFit, DomainPointsAreTheDomain_ExactOracle)
{
  const PointCloud cloud = clouds::HeightField(20000, 4, clouds::Peaks);
  for (const FitSpace space : { FitSpace::LocallyRefined, FitSpace::Hierarchical })
  {
    FitParams params = WithTolerance(0.005);
    params.Space = space;
    const SurfaceFit fit = Fit(cloud, params);
    ASSERT_GT(fit.Iterations.size(), 2U);
    Spline<2> plane;
    plane.Space = fit.Surface.Space;
    plane.ControlPoints = fit.DomainPoints;
    EvaluationBatch batch;
    ASSERT_TRUE(EvaluateParameters<2>(MakeBezierForm<2>(plane), cloud.Parameters, {}, batch));
    EXPECT_LE((batch.Values - cloud.Parameters).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(SurfaceFit, SurfacesInSpaceWithAFurtherChannel_CrossOracle)
{
  // half a torus, and a temperature that is fitted along
  clouds::Random random(21);
  PointCloud cloud;
  cloud.Parameters.resize(30000, 2);
  cloud.Values.resize(30000, 4);
  for (Eigen::Index i = 0; i < cloud.Values.rows(); ++i)
  {
    const double u = random.Uniform();
    const double v = 2.0 * random.Uniform();
    const double r = 2.0 + std::cos(2.0 * clouds::Pi * u);
    cloud.Parameters.row(i) << u, v;
    cloud.Values.row(i) << r * std::cos(0.5 * clouds::Pi * v), r * std::sin(0.5 * clouds::Pi * v),
      std::sin(2.0 * clouds::Pi * u), 20.0 + v;
  }
  for (const FitMethod method : { FitMethod::LeastSquares, FitMethod::MultilevelApproximation })
  {
    FitParams params = WithTolerance(0.001);
    params.NumMeasured = 3;
    params.Method = method;
    const SurfaceFit fit = Fit(cloud, params);
    ExpectWithin(cloud, fit, 3);
    PointCloud channel = cloud;
    channel.Values = cloud.Values.col(3);
    Spline<2> along = fit.Surface;
    along.ControlPoints = fit.Surface.ControlPoints.col(3).eval();
    for (const double d : Measure(channel, along, 1))
    {
      ASSERT_LE(std::fabs(d), method == FitMethod::LeastSquares ? 0.001 : 0.05);
    }
  }
}

TEST(SurfaceFit, EveryPointHasItsTolerance_PropertyOracle)
{
  const PointCloud cloud = clouds::HeightField(20000, 6, clouds::Peaks);
  FitParams params = WithTolerance(0.02);
  const int loose = Fit(cloud, params).Surface.Space->NumFunctions;

  params.ToleranceBoxes = { { { { 0.5, 0.5 }, { 0.7, 0.7 } }, 0.002 },
    { { { 0.55, 0.55 }, { 0.6, 0.6 } }, 0.001 } };
  const SurfaceFit boxes = Fit(cloud, params);
  ExpectWithin(cloud, boxes);
  EXPECT_GT(boxes.Surface.Space->NumFunctions, loose);
  for (Eigen::Index i = 0; i < cloud.Parameters.rows(); ++i)
  {
    const double x = cloud.Parameters(i, 0);
    const double y = cloud.Parameters(i, 1);
    const bool outer = x >= 0.5 && x <= 0.7 && y >= 0.5 && y <= 0.7;
    const bool inner = x >= 0.55 && x <= 0.6 && y >= 0.55 && y <= 0.6;
    ASSERT_EQ(
      boxes.Tolerances[static_cast<std::size_t>(i)], inner ? 0.001 : (outer ? 0.002 : 0.02));
  }

  params.ToleranceBoxes.clear();
  params.Tolerance = 0.001;
  params.Distance = FitDistance::Point;
  params.DistanceSlope = 0.05;
  params.DistanceCentre = { 0.3, 0.8 };
  const SurfaceFit distance = Fit(cloud, params);
  ExpectWithin(cloud, distance);
  EXPECT_NEAR(distance.Tolerances[7],
    0.001 + 0.05 * std::hypot(cloud.Parameters(7, 0) - 0.3, cloud.Parameters(7, 1) - 0.8), 1e-15);

  params.Distance = FitDistance::Value;
  const SurfaceFit value = Fit(cloud, params);
  ExpectWithin(cloud, value);
  EXPECT_NEAR(value.Tolerances[7], 0.001 + 0.05 * std::fabs(cloud.Values(7, 0)), 1e-15);

  PointCloud own = cloud;
  own.Tolerances.setConstant(cloud.Values.rows(), 0.05);
  own.Tolerances[12] = 0.0005;
  const SurfaceFit points = Fit(own, WithTolerance(1.0));
  ExpectWithin(own, points);
  EXPECT_EQ(points.Tolerances[12], 0.0005);
  EXPECT_EQ(points.Tolerances[13], 0.05);
}

TEST(SurfaceFit, OneSidedSurfacesStayOnTheirSide_PropertyOracle)
{
  const PointCloud cloud = clouds::HeightField(20000, 8, clouds::Peaks);
  for (const FitSide side : { FitSide::Above, FitSide::Below })
  {
    const double sign = side == FitSide::Above ? 1.0 : -1.0;
    FitParams params = WithTolerance(0.005);
    params.Side = side;
    const SurfaceFit fit = Fit(cloud, params);
    ExpectWithin(cloud, fit);
    for (const double d : Measure(cloud, fit.Surface, 1))
    {
      ASSERT_LE(sign * d, 1e-14);
    }
    params.MaxIterations = 1; // far from the tolerance
    const SurfaceFit coarse = Fit(cloud, params);
    EXPECT_FALSE(coarse.WithinTolerance);
    for (const double d : Measure(cloud, coarse.Surface, 1))
    {
      ASSERT_LE(sign * d, -1e-15); // other evaluators round differently
    }
  }
}

TEST(SurfaceFit, OneSidedSurfacesWithTolerancesAtRandom_PropertyOracle)
{
  PointCloud cloud = clouds::HeightField(4000, 62, Wave);
  clouds::Random random(63);
  cloud.Tolerances.resize(cloud.Values.rows());
  for (double& tolerance : cloud.Tolerances)
  {
    tolerance = std::pow(10.0, -1.0 - 3.0 * random.Uniform()); // 1e-4 to 0.1
  }
  for (const FitSide side : { FitSide::Above, FitSide::Below })
  {
    FitParams params;
    params.Side = side;
    const SurfaceFit fit = Fit(cloud, params);
    ExpectWithin(cloud, fit);
    EXPECT_LT(fit.Final.NumFunctions, 4000);
    for (const double d : Measure(cloud, fit.Surface, 1))
    {
      ASSERT_LE(side == FitSide::Above ? d : -d, 0.0);
    }
  }
}

TEST(SurfaceFit, SignificantPointsAreMetBetter_PropertyOracle)
{
  PointCloud cloud = clouds::HeightField(5000, 9, Wave);
  clouds::Random noise(10);
  for (Eigen::Index i = 0; i < cloud.Values.rows(); ++i)
  {
    cloud.Values(i, 0) += 0.01 * noise.Normal();
  }
  FitParams params = WithTolerance(1e-6);
  params.MaxIterations = 0;
  params.SignificantWeight = 100.0;
  const auto sum = [&](const SurfaceFit& fit)
  {
    double squares = 0.0;
    for (std::size_t i = 0; i < 50; ++i)
    {
      squares += fit.Distances[i] * fit.Distances[i];
    }
    return squares;
  };
  const double before = sum(Fit(cloud, params));
  cloud.Significant.assign(5000, 0);
  std::fill_n(cloud.Significant.begin(), 50, std::uint8_t{ 1 });
  EXPECT_LT(sum(Fit(cloud, params)), 0.8 * before);
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
  EXPECT_LE(fit.Surface.ControlPoints.cwiseAbs().maxCoeff(), 10.0);
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

TEST(SurfaceFit, PointsApartAreAllMet_CrossOracle)
{
  // heights at random: functions of degree 2 cannot do with as many as there are points
  for (const int n : { 2, 6, 10, 500 })
  {
    PointCloud cloud = clouds::HeightField(n, 60, Wave);
    clouds::Random heights(61);
    for (Eigen::Index i = 0; i < n; ++i)
    {
      cloud.Values(i, 0) = heights.Normal();
    }
    for (const FitSpace space : { FitSpace::LocallyRefined, FitSpace::Hierarchical })
    {
      SCOPED_TRACE(n);
      FitParams params = WithTolerance(0.001);
      params.Space = space;
      const SurfaceFit fit = Fit(cloud, params);
      ExpectWithin(cloud, fit);
      EXPECT_EQ(fit.End, FitEnd::Tolerance);
    }
  }
}

TEST(SurfaceFit, TolerancesFarApartAreMet_CrossOracle)
{
  // with a constant threshold, 30 iterations leave the cliff to the loose points for good
  const PointCloud all = clouds::TerrainCloud();
  PointCloud cloud;
  cloud.Parameters = all.Parameters.topRows(10000);
  cloud.Values = all.Values.topRows(10000);
  cloud.Tolerances.setConstant(10000, 0.1);
  for (Eigen::Index i = 0; i < 10000; i += 100)
  {
    cloud.Tolerances[i] = 1e-6;
  }
  const SurfaceFit fit = Fit(cloud, {});
  ExpectWithin(cloud, fit);
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

TEST(SurfaceFit, PointsThatContradictEachOtherAreLeft_CrossOracle)
{
  // ten pairs in the same place, 0.1 apart: no surface is nearer than 0.05 to both of a pair
  const PointCloud all = clouds::HeightField(20000, 38, Wave);
  PointCloud cloud = all;
  for (Eigen::Index i = 0; i < 10; ++i)
  {
    cloud.Parameters.row(i) = cloud.Parameters.row(10000 + i);
    cloud.Values(i, 0) = cloud.Values(10000 + i, 0) + 0.1;
  }
  const SurfaceFit fit = Fit(cloud, WithTolerance(0.001));
  EXPECT_FALSE(fit.WithinTolerance);
  EXPECT_EQ(fit.End, FitEnd::Resolution);
  EXPECT_LT(fit.Iterations.size(), 20U);
  for (std::size_t i = 0; i < fit.Distances.size(); ++i)
  {
    if (i % 10000 >= 10)
    {
      ASSERT_LE(std::fabs(fit.Distances[i]), fit.Tolerances[i]) << "point " << i;
    }
  }
  EXPECT_GE(fit.Final.NumOutside, 10U);
  EXPECT_LE(fit.Final.NumOutside, 20U);
}

TEST(SurfaceFit, DirectionsFollowTheError_PropertyOracle)
{
  const PointCloud cloud =
    clouds::HeightField(20000, 13, [](double x, double) { return std::tanh((x - 0.43) / 0.01); });
  FitParams params = WithTolerance(0.01);
  const SurfaceFit byError = Fit(cloud, params);
  ExpectWithin(cloud, byError);
  params.Directions = FitDirections::Both;
  const SurfaceFit both = Fit(cloud, params);
  ExpectWithin(cloud, both);
  params.Directions = FitDirections::Alternating;
  const SurfaceFit alternating = Fit(cloud, params);
  ExpectWithin(cloud, alternating);
  EXPECT_LT(2 * byError.Surface.Space->NumFunctions, both.Surface.Space->NumFunctions);
}

TEST(SurfaceFit, StrategiesAndThresholdsReachTheTolerance_CrossOracle)
{
  const PointCloud cloud = clouds::HeightField(20000, 14, clouds::Peaks);
  for (const LRStrategy strategy :
    { LRStrategy::FullSpan, LRStrategy::MinimumSpan, LRStrategy::StructuredMesh })
  {
    for (const FitThreshold threshold :
      { FitThreshold::All, FitThreshold::LargestErrors, FitThreshold::MostPoints })
    {
      FitParams params = WithTolerance(0.005);
      params.Strategy = strategy;
      params.Threshold = threshold;
      ExpectWithin(cloud, Fit(cloud, params));
    }
  }
}

TEST(SurfaceFit, IndependentFunctions_CrossOracle)
{
  // cliffs across the elements: short lines cross near one another
  const auto cliffs = [](double x, double y)
  { return std::tanh((x - y) / 0.01) + std::tanh((x * x + y * y - 0.5) / 0.01); };
  const PointCloud cloud = clouds::HeightField(3000, 3, cliffs);
  FitParams params = WithTolerance(0.05);
  params.Degree = { 3, 3 };
  params.Directions = FitDirections::Both;
  params.Strategy = LRStrategy::MinimumSpan;
  params.Independent = true;
  const auto verdict = [&]
  {
    const SurfaceFit fit = Fit(cloud, params);
    ExpectWithin(cloud, fit);
    const auto decided = DecideDependence(*fit.Surface.Space);
    EXPECT_TRUE(decided);
    return decided.Value.Verdict;
  };
  EXPECT_EQ(verdict(), LRVerdict::Independent);
  params.Independent = false;
  EXPECT_EQ(verdict(), LRVerdict::Dependent); // the option has had something to do
}

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

TEST(SurfaceFit, FeatureGridsCountThePoints_CrossOracle)
{
  const PointCloud cloud = clouds::HeightField(20000, 19, Wave);
  FitParams params = WithTolerance(0.002);
  params.FeatureGridSize = 7;
  const SurfaceFit fit = Fit(cloud, params);
  const FitFeatures& features = fit.Features;
  ASSERT_EQ(features.Size, 7);
  ASSERT_EQ(features.Height.size(), 49U);
  int count = 0;
  for (const int n : features.NumPoints)
  {
    count += n;
  }
  EXPECT_EQ(count, 20000);
  EXPECT_EQ(
    *std::max_element(features.MaxError.begin(), features.MaxError.end()), fit.Final.MaxError);
  const ParametricBox<2> domain = fit.Surface.Space->Domain();
  for (int k = 0; k < 49; ++k)
  {
    const auto at = static_cast<std::size_t>(k);
    const double x = domain.Lower[0] + (k % 7 + 0.5) / 7.0 * (domain.Upper[0] - domain.Lower[0]);
    const double y = domain.Lower[1] + (k / 7 + 0.5) / 7.0 * (domain.Upper[1] - domain.Lower[1]);
    EXPECT_NEAR(features.Height[at], Wave(x, y), 0.002);
    EXPECT_NEAR(features.Slope[at],
      std::hypot(2.1 * std::cos(7.0 * x) * std::cos(5.0 * y) + 0.1,
        -1.5 * std::sin(7.0 * x) * std::sin(5.0 * y)),
      0.2);
    EXPECT_GT(features.ElementSize[at], 0.0);
    EXPECT_LE(features.Roughness[at], features.MaxError[at]);
  }
}

TEST(SurfaceFit, EveryFailureIsReachable_ExactOracle)
{
  const PointCloud good = clouds::HeightField(100, 20, Wave);
  const auto code = [](const PointCloud& cloud, const FitParams& params)
  {
    const auto fit = FitSurface(cloud, params);
    EXPECT_FALSE(fit.Status.Detail.empty());
    return fit.Status.Code;
  };
  EXPECT_EQ(code({}, {}), ErrorCode::EmptyInput);
  PointCloud bad = good;
  bad.Values.resize(99, 1);
  EXPECT_EQ(code(bad, {}), ErrorCode::SizeMismatch);
  bad = good;
  bad.Tolerances.setOnes(3);
  EXPECT_EQ(code(bad, {}), ErrorCode::SizeMismatch);
  bad = good;
  bad.Significant.assign(3, 1);
  EXPECT_EQ(code(bad, {}), ErrorCode::SizeMismatch);
  bad = good;
  bad.Values(17, 0) = std::numeric_limits<double>::quiet_NaN();
  const auto status = FitSurface(bad, {}).Status;
  EXPECT_EQ(status.Code, ErrorCode::NonFiniteInput);
  EXPECT_NE(status.Detail.find("17"), std::string::npos);
  bad = good;
  bad.Values(17, 0) = 1e61;
  EXPECT_EQ(code(bad, {}), ErrorCode::TooLarge);
  bad = good;
  bad.Tolerances.setOnes(100);
  bad.Tolerances[5] = 0.0;
  EXPECT_EQ(code(bad, {}), ErrorCode::InvalidParameter);
  FitParams params;
  params.Domain = { { 0.0, 0.0 }, { 0.5, 0.5 } };
  EXPECT_EQ(code(good, params), ErrorCode::OutsideDomain);
  const auto with = [&](const auto& change)
  {
    FitParams changed;
    change(changed);
    return code(good, changed);
  };
  EXPECT_EQ(with([](FitParams& p) { p.Degree = { 2, 10 }; }), ErrorCode::InvalidDegree);
  EXPECT_EQ(with([](FitParams& p) { p.Degree = { 0, 2 }; }), ErrorCode::InvalidDegree);
  const ErrorCode option = ErrorCode::InvalidParameter;
  EXPECT_EQ(with([](FitParams& p) { p.NumInitialElements = { -1, 0 }; }), option);
  EXPECT_EQ(with([](FitParams& p) { p.NumMeasured = 2; }), option);
  EXPECT_EQ(with([](FitParams& p) { p.SwitchIteration = -1; }), option);
  EXPECT_EQ(with([](FitParams& p) { p.Smoothing = -1.0; }), option);
  EXPECT_EQ(with([](FitParams& p) { p.SignificantWeight = 0.5; }), option);
  EXPECT_EQ(with([](FitParams& p) { p.Tolerance = -1.0; }), option);
  EXPECT_EQ(with([](FitParams& p) { p.Tolerance = std::nan(""); }), option);
  EXPECT_EQ(with([](FitParams& p) { p.ToleranceBoxes = { {} }; }), option);
  EXPECT_EQ(with([](FitParams& p) { p.DistanceSlope = -1.0; }), option);
  EXPECT_EQ(with([](FitParams& p) { p.DistanceCentre = { 0.0, std::nan("") }; }), option);
  EXPECT_EQ(with([](FitParams& p) { p.Tolerance = 1e61; }), option);
  EXPECT_EQ(with([](FitParams& p) { p.OutlierScale = 0.0; }), option);
  EXPECT_EQ(with([](FitParams& p) { p.MaxIterations = -1; }), option);
  EXPECT_EQ(with([](FitParams& p) { p.MaxFunctions = -1; }), option);
  EXPECT_EQ(with([](FitParams& p) { p.MaxSeconds = -1.0; }), option);
  EXPECT_EQ(with([](FitParams& p) { p.ThresholdShare = 2.0; }), option);
  EXPECT_EQ(with([](FitParams& p) { p.MinElementSize = 0.0; }), option);
  EXPECT_EQ(with([](FitParams& p) { p.FeatureGridSize = -1; }), option);
  EXPECT_EQ(with([](FitParams& p) { p.FeatureGridSize = 4097; }), option);
  EXPECT_EQ(with([](FitParams& p) { p.Threads = -1; }), option);
}

TEST(SurfaceFit, DegenerateCloudsGiveSurfaces_PropertyOracle)
{
  const auto cloud = [](std::initializer_list<std::array<double, 3>> rows)
  {
    PointCloud made;
    made.Parameters.resize(static_cast<Eigen::Index>(rows.size()), 2);
    made.Values.resize(static_cast<Eigen::Index>(rows.size()), 1);
    Eigen::Index i = 0;
    for (const auto& row : rows)
    {
      made.Parameters.row(i) << row[0], row[1];
      made.Values(i++, 0) = row[2];
    }
    return made;
  };
  // one point, points on a line, the same parameters twice (no surface meets both values)
  for (const PointCloud& some : { cloud({ { 3.0, 4.0, 5.0 } }),
         cloud({ { 0.0, 1.0, 0.0 }, { 1.0, 1.0, 1.0 }, { 2.0, 1.0, 0.0 } }),
         cloud({ { 0.0, 0.0, 7.0 }, { 1.0, 1e-9, 7.0 } }) })
  {
    const SurfaceFit fit = Fit(some, {});
    ExpectWithin(some, fit);
  }
  const PointCloud twice =
    cloud({ { 0.0, 0.0, 0.0 }, { 1.0, 1.0, 0.0 }, { 0.5, 0.5, 0.0 }, { 0.5, 0.5, 1.0 } });
  const SurfaceFit fit = Fit(twice, WithTolerance(0.01));
  EXPECT_FALSE(fit.WithinTolerance);
  EXPECT_NEAR(fit.Final.MaxError, 0.5, 0.1);
}
}
