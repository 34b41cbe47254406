// SPDX-License-Identifier: BSD-3-Clause
// Parameters that are wrong are corrected: the surface is compared with the shape that the points
// lie on.
#include "CloudFits.h"

namespace knotwork
{
namespace
{
constexpr double Tolerance = 1e-3;

/// Points of a piece of a cylinder of radius 1 with parameters that are off by up to a share of the
/// domain.
PointCloud Cylinder(std::size_t n, double error)
{
  clouds::Random random(71);
  PointCloud cloud;
  const auto rows = static_cast<Eigen::Index>(n);
  cloud.Parameters.resize(rows, 2);
  cloud.Values.resize(rows, 3);
  for (Eigen::Index i = 0; i < rows; ++i)
  {
    const double u = random.Uniform();
    const double v = random.Uniform();
    cloud.Values.row(i) << std::cos(2.0 * u), std::sin(2.0 * u), v;
    cloud.Parameters(i, 0) = std::clamp(u + error * (2.0 * random.Uniform() - 1.0), 0.0, 1.0);
    cloud.Parameters(i, 1) = std::clamp(v + error * (2.0 * random.Uniform() - 1.0), 0.0, 1.0);
  }
  return cloud;
}

FitParams InSpace()
{
  FitParams params = WithTolerance(Tolerance);
  params.NumMeasured = 3;
  params.Domain = { { 0.0, 0.0 }, { 1.0, 1.0 } };
  params.CorrectParameters = true;
  return params;
}
}

TEST(ParameterCorrection, WrongParametersStillGiveTheShape_CrossOracle)
{
  const PointCloud cloud = Cylinder(4000, 0.03);
  for (const FitSpace space : { FitSpace::LocallyRefined, FitSpace::Hierarchical })
  {
    FitParams params = InSpace();
    params.Space = space;
    const SurfaceFit fit = Fit(cloud, params);
    EXPECT_TRUE(fit.WithinTolerance);
    ASSERT_EQ(fit.Parameters.rows(), 4000);
    // reported distances are those at the reported parameters, and no place of a fine grid is
    // nearer
    PointCloud corrected = cloud;
    corrected.Parameters = fit.Parameters;
    ExpectWithin(corrected, fit, 3);
    PointCloud grid;
    grid.Parameters.resize(150 * 150, 2);
    for (int i = 0; i < 150 * 150; ++i)
    {
      grid.Parameters.row(i) << (i % 150) / 149.0, (i / 150) / 149.0;
    }
    EvaluationBatch batch;
    ASSERT_TRUE(EvaluateParameters<2>(MakeBezierForm<2>(fit.Surface), grid.Parameters, {}, batch));
    for (Eigen::Index i = 0; i < 4000; i += 40)
    {
      const double nearest = std::sqrt(
        (batch.Values.rowwise() - cloud.Values.row(i)).rowwise().squaredNorm().minCoeff());
      EXPECT_LE(fit.Distances[static_cast<std::size_t>(i)], nearest + 1e-12);
    }
    // between the points the surface lies on the cylinder, too
    const Eigen::VectorXd radius =
      (batch.Values.col(0).array().square() + batch.Values.col(1).array().square()).sqrt();
    EXPECT_LE((radius.array() - 1.0).abs().maxCoeff(), 2.0 * Tolerance);
    // the errors of the parameters are not fitted
    params.CorrectParameters = false;
    const SurfaceFit plain = Fit(cloud, params);
    EXPECT_GT(plain.Final.NumFunctions, 20 * fit.Final.NumFunctions);
    EXPECT_EQ(plain.Parameters.rows(), 0);
  }
}

TEST(ParameterCorrection, RightParametersStay_CrossOracle)
{
  // a plane: closest points of points beside it are their feet
  clouds::Random random(72);
  PointCloud cloud = clouds::HeightField(2000, 73, [](double, double) { return 0.0; });
  cloud.Values.resize(2000, 3);
  for (Eigen::Index i = 0; i < 2000; ++i)
  {
    cloud.Values.row(i) << 3.0 * cloud.Parameters(i, 0), 2.0 * cloud.Parameters(i, 1),
      0.5 * Tolerance * (2.0 * random.Uniform() - 1.0);
  }
  const SurfaceFit fit = Fit(cloud, InSpace());
  EXPECT_TRUE(fit.WithinTolerance);
  // the surface is a plane up to the noise
  EXPECT_LE((fit.Parameters - cloud.Parameters).cwiseAbs().maxCoeff(), 2.0 * Tolerance);
}

TEST(ParameterCorrection, WithOutliersCriteriaAndAStart_PropertyOracle)
{
  PointCloud cloud = Cylinder(4000, 0.02);
  for (Eigen::Index i = 0; i < 4000; i += 400)
  {
    cloud.Values.row(i).head(2) *= 1.3; // far outside of the cylinder
  }
  FitParams params = InSpace();
  params.FindOutliers = true;
  const SurfaceFit outliers = Fit(cloud, params);
  EXPECT_TRUE(outliers.WithinTolerance);
  for (std::size_t i = 0; i < 4000; i += 400)
  {
    EXPECT_NE(outliers.Outliers[i], 0) << i;
  }
  EXPECT_LE(outliers.Final.NumOutliers, 10U + 40U); // one point in a hundred, beyond the borders
  params.FindOutliers = false;
  params.Criterion = FitCriterion::BIC;
  const PointCloud clean = Cylinder(4000, 0.02);
  const SurfaceFit criterion = Fit(clean, params);
  PointCloud corrected = clean;
  corrected.Parameters = criterion.Parameters;
  const std::vector<double> distances = Measure(corrected, criterion.Surface, 3);
  for (std::size_t i = 0; i < distances.size(); ++i)
  {
    ASSERT_NEAR(distances[i], criterion.Distances[i], 1e-13);
  }
  params = InSpace();
  params.Start = FitStart{ outliers.Surface, outliers.DomainPoints, {} };
  params.Tolerance = 0.3 * Tolerance;
  const SurfaceFit update = Fit(clean, params);
  EXPECT_TRUE(update.WithinTolerance);
  params.CorrectParameters = false;
  EXPECT_LE(10 * update.Final.NumFunctions, Fit(clean, params).Final.NumFunctions);
}

TEST(ParameterCorrection, ThreadsDoNotMatter_ExactOracle)
{
  const PointCloud cloud = Cylinder(3000, 0.03);
  FitParams params = InSpace();
  params.Threads = 1;
  const SurfaceFit one = Fit(cloud, params);
  params.Threads = 3;
  const SurfaceFit other = Fit(cloud, params);
  EXPECT_EQ(one.Surface.ControlPoints, other.Surface.ControlPoints);
  EXPECT_EQ(one.Parameters, other.Parameters);
}

TEST(ParameterCorrection, HeightsHaveNone_ExactOracle)
{
  FitParams params = WithTolerance(Tolerance);
  params.CorrectParameters = true;
  const Status status = FitSurface(clouds::HeightField(100, 74, clouds::Peaks), params).Status;
  EXPECT_EQ(status.Code, ErrorCode::InvalidParameter);
  EXPECT_NE(status.Detail.find("CorrectParameters"), std::string::npos);
}
}
