// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SurfaceFitting/SurfaceFit.h>

#include "CloudFits.h"
#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/LRDependence.h>

#include <limits>

namespace knotwork
{
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

// Lee, Wolberg, Shin 1997, equations (3) to (5), with hat functions written out: every point asks
// for the smallest coefficients that pass through it, and a coefficient is the mean of what the
// points around it ask for, weighted by the squares of its function.
TEST(SurfaceFit, MultilevelStepsAverageOverManyPoints_CrossOracle)
{
  constexpr int nodes[2] = { 4, 3 }; // of hat functions on 3 x 2 elements of the unit square
  const PointCloud cloud = clouds::HeightField(60, 21, Wave);
  const auto hat = [&](int d, int k, double x)
  { return std::max(0.0, 1.0 - std::fabs((nodes[d] - 1) * x - k)); };
  Eigen::MatrixXd values(cloud.Values.rows(), nodes[0] * nodes[1]); // point x function
  for (Eigen::Index i = 0; i < values.rows(); ++i)
  {
    for (int f = 0; f < nodes[0] * nodes[1]; ++f)
    {
      values(i, f) =
        hat(0, f % nodes[0], cloud.Parameters(i, 0)) * hat(1, f / nodes[0], cloud.Parameters(i, 1));
    }
  }
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(values.cols());
  for (int step = 0; step < 2; ++step) // an iteration makes two
  {
    const Eigen::VectorXd residual = cloud.Values.col(0) - values * expected;
    for (Eigen::Index f = 0; f < values.cols(); ++f)
    {
      double sum = 0.0;
      double weights = 0.0;
      for (Eigen::Index i = 0; i < values.rows(); ++i)
      {
        const double w = values(i, f);
        sum += w * w * (w * residual(i) / values.row(i).squaredNorm());
        weights += w * w;
      }
      expected(f) += sum / weights;
    }
  }
  FitParams params = WithTolerance(1e-6);
  params.Method = FitMethod::MultilevelApproximation;
  params.Smoothing = 0.0;
  params.Degree = { 1, 1 };
  params.NumInitialElements = { nodes[0] - 1, nodes[1] - 1 };
  params.Domain = { { 0.0, 0.0 }, { 1.0, 1.0 } };
  params.MaxIterations = 0;
  const SurfaceFit fit = Fit(cloud, params);
  const auto collocation = CollocationMatrix<2>(*fit.Surface.Space, cloud.Parameters, 0);
  ASSERT_TRUE(collocation);
  // compared as values at the points: functions may be numbered in another order
  const Eigen::VectorXd found = collocation.Value * fit.Surface.ControlPoints.col(0);
  EXPECT_LE((found - values * expected).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_GT((found - cloud.Values.col(0)).cwiseAbs().maxCoeff(), 1e-3); // not an interpolation
}

TEST(SurfaceFit, AnotherStrategyFromAnIterationOn_ExactOracle)
{
  const PointCloud cloud = clouds::HeightField(20000, 66, clouds::Peaks);
  FitParams params = WithTolerance(0.002);
  params.Strategy = LRStrategy::StructuredMesh;
  const SurfaceFit first = Fit(cloud, params);
  params.Strategy = LRStrategy::MinimumSpan;
  const SurfaceFit later = Fit(cloud, params);
  params.Strategy = LRStrategy::StructuredMesh;
  params.LaterStrategy = LRStrategy::MinimumSpan;
  EXPECT_EQ(Fit(cloud, params).Surface.ControlPoints, first.Surface.ControlPoints);
  params.StrategySwitch = 1; // the first refinement
  EXPECT_EQ(Fit(cloud, params).Surface.ControlPoints, later.Surface.ControlPoints);
  params.StrategySwitch = 3;
  const SurfaceFit both = Fit(cloud, params);
  ExpectWithin(cloud, both);
  ASSERT_GT(first.Iterations.size(), 4U);
  for (std::size_t i = 0; i < 3; ++i) // spaces 0 to 2 are made by the first strategy
  {
    EXPECT_EQ(both.Iterations[i].NumFunctions, first.Iterations[i].NumFunctions);
  }
  EXPECT_LT(both.Iterations[3].NumFunctions, first.Iterations[3].NumFunctions);
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
  for (const LRStrategy strategy : { LRStrategy::FullSpan, LRStrategy::MinimumSpan,
         LRStrategy::StructuredMesh, LRStrategy::RestrictedMesh })
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
  // cliffs across the elements: short lines cross near one another, and in one cloud in four or
  // so functions become dependent
  const auto cliffs = [](double x, double y)
  { return std::tanh((x - y) / 0.01) + std::tanh((x * x + y * y - 0.5) / 0.01); };
  int numDependent = 0;
  for (std::uint64_t seed = 3; seed < 100 && numDependent == 0; ++seed)
  {
    SCOPED_TRACE(seed);
    const PointCloud cloud = clouds::HeightField(3000, seed, cliffs);
    FitParams params = WithTolerance(0.05);
    params.Degree = { 3, 3 };
    params.Directions = FitDirections::Both;
    params.Strategy = LRStrategy::MinimumSpan;
    const auto verdict = [&]
    {
      const SurfaceFit fit = Fit(cloud, params);
      ExpectWithin(cloud, fit);
      const auto decided = DecideDependence(*fit.Surface.Space);
      EXPECT_TRUE(decided) << decided.Status.Message();
      return decided.Value.Verdict;
    };
    numDependent += verdict() == LRVerdict::Dependent ? 1 : 0;
    params.Independent = true;
    EXPECT_EQ(verdict(), LRVerdict::Independent);
  }
  EXPECT_EQ(numDependent, 1); // the option has had something to do
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
  EXPECT_EQ(with([](FitParams& p) { p.StrategySwitch = -1; }), option);
  EXPECT_EQ(with([](FitParams& p) { p.ToleranceFactorAbove = 0.0; }), option);
  EXPECT_EQ(with([](FitParams& p) { p.ToleranceFactorBelow = -1.0; }), option);
  EXPECT_EQ(with(
              [](FitParams& p)
              {
                p.ToleranceFactorBelow = 2.0;
                p.Side = FitSide::Above;
              }),
    option);
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
