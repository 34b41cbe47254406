// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SurfaceFitting/PlaneParameters.h>
#include <knotwork/SurfaceFitting/PointLayers.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace knotwork;

namespace
{
/// Points of a wave over a rectangle of 4 x 2 in its own frame, tilted and far from the origin.
PointMatrix TiltedWave(unsigned seed, int n, PointMatrix& plane)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()));
  PointMatrix points(n, 3);
  plane.resize(n, 2);
  for (int i = 0; i < n; i += 2)
  {
    const double u = 2.0 * unit(random);
    const double v = unit(random);
    const double z = 0.1 * std::sin(3.0 * u) * std::sin(2.0 * v); // odd: the plane is exact
    for (int side = 0; side < 2; ++side)
    {
      // with its mirror images the covariance is diagonal in the frame
      const Eigen::Vector3d local(side == 0 ? u : -u, v, side == 0 ? z : -z);
      plane.row(i + side) = local.head<2>().transpose();
      points.row(i + side) = (turn * local + Eigen::Vector3d(100.0, -50.0, 20.0)).transpose();
    }
  }
  return points;
}
}

TEST(PlaneParameters, AreDistancesInThePlane_ExactOracle)
{
  // Points of a plane: distances of parameters are distances in space.
  for (unsigned seed = 1; seed <= 10; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    PointMatrix plane;
    PointMatrix points = TiltedWave(seed, 200, plane);
    const Eigen::Vector3d a(0.6, 0.0, 0.8);
    const Eigen::Vector3d b(0.0, 1.0, 0.0);
    points = plane.col(0) * a.transpose() + plane.col(1) * b.transpose();
    const auto uv = PlaneParameters(points);
    ASSERT_TRUE(uv) << uv.Status.Message();
    for (Eigen::Index i = 1; i < points.rows(); ++i)
    {
      // round-off of rotating vectors of length 5
      EXPECT_NEAR(
        (uv->row(i) - uv->row(0)).norm(), (points.row(i) - points.row(0)).norm(), 1e-14 * 5 * 8);
    }
  }
}

TEST(PlaneParameters, FindTheFrameOfAWave_PropertyOracle)
{
  PointMatrix plane;
  const PointMatrix points = TiltedWave(3, 20000, plane);
  const auto uv = PlaneParameters(points);
  ASSERT_TRUE(uv) << uv.Status.Message();
  // The long side comes first, and the normal is found up to the tilt of the sample's moments.
  const Eigen::RowVector2d size = uv->colwise().maxCoeff() - uv->colwise().minCoeff();
  EXPECT_NEAR(size[0], 4.0, 0.1);
  EXPECT_NEAR(size[1], 2.0, 0.1);
  EXPECT_GT(size[1], 1.9);
}

TEST(PlaneParameters, MovePointsAndFrameMoves_PropertyOracle)
{
  PointMatrix plane;
  const PointMatrix points = TiltedWave(4, 1000, plane);
  const PointMatrix moved = points.rowwise() + Eigen::RowVector3d(3.0, 4.0, 5.0);
  const auto first = PlaneParameters(points);
  const auto second = PlaneParameters(moved);
  ASSERT_TRUE(first && second);
  // rounding of coordinates of some hundred
  EXPECT_LE((first.Value - second.Value).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(PlaneParameters, LinesAndStripsAreToldApart_ExactOracle)
{
  // Any direction, any place: a line is one up to the rounding of its coordinates (2^-53 of them),
  // a strip 1e6 times as long as wide keeps its width.
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (const double offset : { 0.0, 1.0, 1e3, 1e6 })
  {
    for (int repeat = 0; repeat < 20; ++repeat)
    {
      SCOPED_TRACE("offset " + std::to_string(offset) + ", repeat " + std::to_string(repeat));
      const Eigen::RowVector3d a = Eigen::RowVector3d(unit(random), unit(random), unit(random));
      const Eigen::RowVector3d b = a.cross(Eigen::RowVector3d(unit(random), 1.0, unit(random)));
      PointMatrix line(500, 3);
      PointMatrix strip(500, 3);
      Eigen::VectorXd sides(500);
      for (Eigen::Index i = 0; i < 500; ++i)
      {
        sides[i] = i % 2 == 0 ? 1.0 : -1.0;
        line.row(i) = offset * Eigen::RowVector3d(1.0, -0.7, 0.3) + unit(random) * a.normalized();
        strip.row(i) = line.row(i) + 1e-6 * sides[i] * b.normalized();
      }
      EXPECT_EQ(PlaneParameters(line).Status.Code, ErrorCode::SingularSystem);
      if (offset <= 1.0)
      {
        const auto uv = PlaneParameters(strip);
        ASSERT_TRUE(uv) << uv.Status.Message();
        const double sign = uv->coeff(0, 1) > 0.0 ? 1.0 : -1.0;
        // the best plane turns by the correlation of side and place, some 0.1 of the width
        EXPECT_LE((sign * uv->col(1) - 1e-6 * sides).cwiseAbs().maxCoeff(), 3e-7);
      }
    }
  }
}

TEST(PlaneParameters, EveryFailureIsReachable_ExactOracle)
{
  PointMatrix plane;
  const PointMatrix points = TiltedWave(5, 4000, plane);
  EXPECT_EQ(PlaneParameters(points.topRows(2)).Status.Code, ErrorCode::EmptyInput);
  PointMatrix bad = points;
  bad(7, 1) = std::numeric_limits<double>::quiet_NaN();
  const auto nan = PlaneParameters(bad);
  EXPECT_EQ(nan.Status.Code, ErrorCode::NonFiniteInput);
  EXPECT_EQ(nan.Status.Detail, "point 7");
  PointMatrix line = points;
  line.col(1) = 2.0 * line.col(0);
  line.col(2) = -line.col(0);
  EXPECT_EQ(PlaneParameters(line).Status.Code, ErrorCode::SingularSystem);
  EXPECT_EQ(PlaneParameters(PointMatrix::Ones(5, 3)).Status.Code, ErrorCode::SingularSystem);
  PointMatrix sphere = points.rowwise() - points.colwise().mean();
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (Eigen::Index i = 0; i < sphere.rows(); ++i)
  {
    sphere.row(i) << normal(random), normal(random), normal(random);
    sphere.row(i).normalize();
  }
  const auto projected = PlaneParameters(sphere);
  ASSERT_TRUE(projected) << projected.Status.Message();
  const Status folded = CheckLayers(projected.Value, sphere, "their plane of least squares");
  EXPECT_EQ(folded.Code, ErrorCode::NotInSpace);
  EXPECT_NE(folded.Detail.find("layers over their plane"), std::string::npos);
}
