// SPDX-License-Identifier: BSD-3-Clause
// Fits of values in space: against dense equations, published steps, and uniform spaces.
#include "CloudCases.h"
#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/LRDependence.h>
#include <knotwork/SurfaceFitting/VolumeFit.h>

#include <gtest/gtest.h>

#include <Eigen/QR>

#include <limits>

using namespace knotwork;

namespace
{
/// A gentle wave, and two peaks of a width of 0.04.
double Peaks(double x, double y, double z)
{
  const auto peak = [&](double a, double b, double c)
  {
    const double square = (x - a) * (x - a) + (y - b) * (y - b) + (z - c) * (z - c);
    return std::exp(-square / (2.0 * 0.04 * 0.04));
  };
  return 0.2 * std::sin(2.0 * x + y) * z + peak(0.31, 0.42, 0.57) - 0.5 * peak(0.7, 0.6, 0.2);
}

template <typename Function>
VolumeCloud Sampled(std::size_t n, std::uint64_t seed, const Function& f)
{
  clouds::Random random(seed);
  VolumeCloud cloud;
  cloud.Points.resize(static_cast<Eigen::Index>(n), 3);
  cloud.Values.resize(static_cast<Eigen::Index>(n), 1);
  for (Eigen::Index i = 0; i < cloud.Points.rows(); ++i)
  {
    for (Eigen::Index d = 0; d < 3; ++d)
    {
      cloud.Points(i, d) = random.Uniform();
    }
    cloud.Values(i, 0) = f(cloud.Points(i, 0), cloud.Points(i, 1), cloud.Points(i, 2));
  }
  return cloud;
}

VolumeFitParams UnitCube()
{
  VolumeFitParams params;
  params.Domain = { { 0.0, 0.0, 0.0 }, { 1.0, 1.0, 1.0 } };
  return params;
}

/// Largest difference of the fit from the cloud, by another evaluator.
double LargestDifference(const VolumeFit& fit, const VolumeCloud& cloud)
{
  const auto matrix = CollocationMatrix<3>(*fit.Volume.Space, cloud.Points, 0);
  EXPECT_TRUE(matrix) << matrix.Status.Message();
  return (matrix.Value * fit.Volume.ControlPoints - cloud.Values).cwiseAbs().maxCoeff();
}
}

TEST(VolumeFit, ATenthOfTheUniformFunctions_CrossOracle)
{
  const VolumeCloud cloud = Sampled(60000, 5, Peaks);
  VolumeFitParams params = UnitCube();
  params.Tolerance = 0.01;
  const auto fit = FitVolume(cloud, params);
  ASSERT_TRUE(fit) << fit.Status.Message();
  EXPECT_TRUE(fit->WithinTolerance);
  EXPECT_LE(LargestDifference(fit.Value, cloud), 0.01 + 1e-12);
  EXPECT_EQ(DecideDependence(*fit->Volume.Space)->Verdict, LRVerdict::Independent);
  // uniform spaces of up to ten times as many functions do not do
  const int functions = fit->Volume.Space->NumFunctions;
  const auto most = static_cast<int>(std::cbrt(10.0 * functions)) - 2;
  for (const int n : { most / 2, most - 1, most })
  {
    VolumeFitParams plain = params;
    plain.NumInitialElements = { n, n, n };
    plain.MaxIterations = 0;
    const auto other = FitVolume(cloud, plain);
    ASSERT_TRUE(other) << other.Status.Message();
    EXPECT_LE(other->Volume.Space->NumFunctions, 10 * functions);
    EXPECT_FALSE(other->WithinTolerance);
  }
}

/// Least squares are those of the dense equations of another evaluator.
TEST(VolumeFit, LeastSquaresSolveTheNormalEquations_CrossOracle)
{
  for (const FitSpace space : { FitSpace::LocallyRefined, FitSpace::Hierarchical })
  {
    const VolumeCloud cloud = Sampled(4000, 7, Peaks);
    VolumeFitParams params = UnitCube();
    params.Space = space;
    params.NumInitialElements = { 3, 2, 2 };
    params.Tolerance = 1e-7; // the accuracy of the coefficients is a hundredth of it
    params.Smoothing = 1e-14;
    params.MaxIterations = 2;
    params.MaxFunctions = 500;
    const auto fit = FitVolume(cloud, params);
    ASSERT_TRUE(fit) << fit.Status.Message();
    EXPECT_FALSE(fit->WithinTolerance);
    const auto matrix = CollocationMatrix<3>(*fit->Volume.Space, cloud.Points, 0);
    const Eigen::MatrixXd dense(matrix.Value);
    const Eigen::VectorXd expected = dense.completeOrthogonalDecomposition().solve(cloud.Values);
    const Eigen::VectorXd difference = dense * expected - dense * fit->Volume.ControlPoints.col(0);
    EXPECT_LE(difference.cwiseAbs().maxCoeff(), 1e-5);
    EXPECT_GT((dense * expected - cloud.Values).cwiseAbs().maxCoeff(), 1e-3);
  }
}

/// From zero, one step passes through a single point: w^3 r / (sum of w^2) / w^2 times w, summed.
TEST(VolumeFit, OneMultilevelStepPassesThroughASinglePoint_GoldenOracle)
{
  VolumeCloud cloud;
  cloud.Points = PointMatrix::Constant(1, 3, 0.4);
  cloud.Values.resize(1, 2);
  cloud.Values << 3.0, -1.0;
  VolumeFitParams params = UnitCube();
  params.Method = FitMethod::MultilevelApproximation;
  params.MultilevelSteps = 1;
  params.NumInitialElements = { 3, 4, 5 };
  params.Tolerance = 1e-12;
  params.MaxIterations = 0;
  const auto fit = FitVolume(cloud, params);
  ASSERT_TRUE(fit) << fit.Status.Message();
  EXPECT_TRUE(fit->WithinTolerance);
  EXPECT_LE(LargestDifference(fit.Value, cloud), 1e-14 * 10);
}

/// A coefficient of a step by the formula of the paper, function by function.
TEST(VolumeFit, MultilevelStepsAverageOverManyPoints_CrossOracle)
{
  const VolumeCloud cloud = Sampled(500, 9, Peaks);
  VolumeFitParams params = UnitCube();
  params.Method = FitMethod::MultilevelApproximation;
  params.MultilevelSteps = 1;
  params.NumInitialElements = { 2, 3, 2 };
  params.MaxIterations = 0;
  const auto fit = FitVolume(cloud, params);
  ASSERT_TRUE(fit) << fit.Status.Message();
  const Eigen::MatrixXd w(CollocationMatrix<3>(*fit->Volume.Space, cloud.Points, 0).Value);
  for (Eigen::Index f = 0; f < w.cols(); ++f)
  {
    double above = 0.0;
    double below = 0.0;
    for (Eigen::Index i = 0; i < w.rows(); ++i)
    {
      above += std::pow(w(i, f), 3) * cloud.Values(i, 0) / w.row(i).squaredNorm();
      below += w(i, f) * w(i, f);
    }
    EXPECT_NEAR(fit->Volume.ControlPoints(f, 0), below > 0.0 ? above / below : 0.0, 1e-12);
  }
}

TEST(VolumeFit, PolynomialsAndTheDomainAreReproduced_ExactOracle)
{
  const auto f = [](double x, double y, double z) { return x * x - 2.0 * y * z + 0.5 * x - 1.0; };
  const VolumeCloud cloud = Sampled(3000, 3, f);
  for (const FitSpace space : { FitSpace::LocallyRefined, FitSpace::Hierarchical })
  {
    VolumeFitParams params = UnitCube();
    params.Space = space;
    params.Smoothing = 1e-13;
    params.Tolerance = 1e-8;
    const auto fit = FitVolume(cloud, params);
    ASSERT_TRUE(fit) << fit.Status.Message();
    EXPECT_TRUE(fit->WithinTolerance);
    EXPECT_LE(LargestDifference(fit.Value, cloud), 1e-8);
    // a refined space: its domain points are its parameters
    params.Tolerance = 0.1;
    const VolumeCloud peaks = Sampled(20000, 4, Peaks);
    const auto refined = FitVolume(peaks, params);
    EXPECT_TRUE(refined->WithinTolerance);
    EXPECT_GT(refined->Iterations.size(), 1U);
    const auto matrix = CollocationMatrix<3>(*refined->Volume.Space, peaks.Points, 0);
    EXPECT_LE(
      (matrix.Value * refined->DomainPoints - peaks.Points).cwiseAbs().maxCoeff(), 1e-13 * 10);
  }
}

TEST(VolumeFit, MethodsAndStrategiesReachTheTolerance_PropertyOracle)
{
  const VolumeCloud cloud = Sampled(20000, 11, Peaks);
  const auto check = [&](FitMethod method, LRStrategy strategy)
  {
    SCOPED_TRACE(
      std::to_string(static_cast<int>(method)) + std::to_string(static_cast<int>(strategy)));
    VolumeFitParams params = UnitCube();
    params.Method = method;
    params.SwitchIteration = 2;
    params.Strategy = strategy;
    params.Tolerance = 0.1;
    const auto fit = FitVolume(cloud, params);
    ASSERT_TRUE(fit) << fit.Status.Message();
    EXPECT_TRUE(fit->WithinTolerance) << fit->Volume.Space->NumFunctions;
    EXPECT_NEAR(LargestDifference(fit.Value, cloud), fit->Iterations.back().MaxError, 1e-12);
  };
  for (const LRStrategy strategy : { LRStrategy::FullSpan, LRStrategy::MinimumSpan,
         LRStrategy::StructuredMesh, LRStrategy::RestrictedMesh })
  {
    check(FitMethod::LeastSquares, strategy);
  }
  check(FitMethod::MultilevelApproximation, LRStrategy::FullSpan);
  check(FitMethod::Combined, LRStrategy::FullSpan);
}

TEST(VolumeFit, ThreadsDoNotMatter_ExactOracle)
{
  const VolumeCloud cloud = Sampled(20000, 13, Peaks);
  for (const FitMethod method : { FitMethod::LeastSquares, FitMethod::Combined })
  {
    VolumeFitParams params = UnitCube();
    params.Method = method;
    params.SwitchIteration = 2;
    params.Tolerance = 0.03;
    params.Threads = 1;
    const auto one = FitVolume(cloud, params);
    params.Threads = 3;
    const auto three = FitVolume(cloud, params);
    EXPECT_EQ(one->Volume.ControlPoints, three->Volume.ControlPoints);
    EXPECT_EQ(one->Distances, three->Distances);
  }
}

TEST(VolumeFit, EveryFailureIsReachable_ExactOracle)
{
  const VolumeCloud good = Sampled(200, 17, Peaks);
  const auto code = [&good](auto&& change)
  {
    VolumeCloud cloud = good;
    VolumeFitParams params;
    change(cloud, params);
    const auto fit = FitVolume(cloud, params);
    EXPECT_EQ(fit.Status.Code == ErrorCode::Ok, static_cast<bool>(fit));
    return fit.Status.Code;
  };
  using C = VolumeCloud&;
  using P = VolumeFitParams&;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code([](C, P) {}), ErrorCode::Ok);
  EXPECT_EQ(code([](C c, P) { c.Points.resize(0, 3); }), ErrorCode::EmptyInput);
  EXPECT_EQ(code([](C c, P) { c.Values.resize(3, 1); }), ErrorCode::SizeMismatch);
  EXPECT_EQ(code([](C c, P) { c.Values.resize(200, 0); }), ErrorCode::SizeMismatch);
  EXPECT_EQ(code([nan](C c, P) { c.Points(7, 1) = nan; }), ErrorCode::NonFiniteInput);
  EXPECT_EQ(code([nan](C c, P) { c.Values(7, 0) = nan; }), ErrorCode::NonFiniteInput);
  EXPECT_EQ(code([](C c, P) { c.Points(3, 0) = 1e200; }), ErrorCode::TooLarge);
  EXPECT_EQ(code([](C c, P) { c.Points.setConstant(1e99); }), ErrorCode::InvalidParameter);
  EXPECT_EQ(code([](C, P p) { p.MultilevelSteps = 0; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(code([](C, P p) { p.Degree = 0; }), ErrorCode::InvalidDegree);
  EXPECT_EQ(code([](C, P p) { p.NumInitialElements[1] = -1; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(code([](C, P p) { p.Smoothing = 0.0; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(code([](C, P p) { p.Tolerance = -1.0; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(code([](C, P p) { p.MaxIterations = -1; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(code([](C, P p) { p.ThresholdShare = 2.0; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(code([](C, P p) { p.MinElementSize = 0.0; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(code(
              [](C, P p) {
                p.Domain = { { 0, 0, 0 }, { 1, 0, 1 } };
              }),
    ErrorCode::InvalidParameter);
  EXPECT_EQ(code(
              [](C, P p) {
                p.Domain = { { 0, 0, 0 }, { 1, 0.5, 1 } };
              }),
    ErrorCode::OutsideDomain);
  EXPECT_EQ(code(
              [](C, P p)
              {
                p.Tolerance = 1e-9;
                p.Progress = [](double) { return false; };
              }),
    ErrorCode::Aborted);
  // limits end a fit, with what was reached
  VolumeFitParams params;
  params.Tolerance = 1e-9;
  params.MaxIterations = 1;
  EXPECT_EQ(FitVolume(good, params)->End, FitEnd::Iterations);
  params.MaxIterations = 20;
  params.MaxFunctions = 60;
  EXPECT_EQ(FitVolume(good, params)->End, FitEnd::Functions);
  params.MaxFunctions = 100000;
  params.MinElementSize = 0.4;
  EXPECT_EQ(FitVolume(good, params)->End, FitEnd::Resolution);
  // a flat cloud, and one place
  VolumeCloud flat = good;
  flat.Points.col(2).setConstant(0.3);
  params = {};
  EXPECT_TRUE(FitVolume(flat, params));
  flat.Points.setConstant(0.3);
  flat.Values.setConstant(2.0);
  EXPECT_TRUE(FitVolume(flat, params)->WithinTolerance);
}
