// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SurfaceFitting/PlaneParameters.h>
#include <knotwork/SurfaceFitting/PointLayers.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

using namespace knotwork;

namespace
{
class Numbers
{
public:
  explicit Numbers(unsigned seed) : Random(seed) {}
  double Unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(this->Random); }
  double Normal() { return std::normal_distribution<double>()(this->Random); }
  bool Chance(double share) { return this->Unit() < share; }

private:
  std::mt19937 Random;
};

/// Heights over random points of the unit square.
PointMatrix Cloud(
  unsigned seed, int n, const std::function<double(double, double, Numbers&)>& height)
{
  Numbers numbers(seed);
  PointMatrix points(n, 3);
  for (int i = 0; i < n; ++i)
  {
    const double x = numbers.Unit();
    const double y = numbers.Unit();
    points.row(i) << x, y, height(x, y, numbers);
  }
  return points;
}

/// The same over the points of a grid.
PointMatrix Grid(int n, const std::function<double(double, double)>& height)
{
  PointMatrix points(n * n, 3);
  for (int i = 0; i < n * n; ++i)
  {
    const double x = static_cast<double>(i % n) / n;
    const double y = static_cast<double>(i / n) / n;
    points.row(i) << x, y, height(x, y);
  }
  return points;
}

PointMatrix Sphere(unsigned seed, int n, double noise, const Eigen::RowVector3d& radii)
{
  Numbers numbers(seed);
  PointMatrix points(n, 3);
  for (int i = 0; i < n; ++i)
  {
    Eigen::RowVector3d p(numbers.Normal(), numbers.Normal(), numbers.Normal());
    points.row(i) = p.normalized().cwiseProduct(radii);
    points.row(i) +=
      noise * Eigen::RowVector3d(numbers.Normal(), numbers.Normal(), numbers.Normal());
  }
  return points;
}

PointMatrix Torus(unsigned seed, int n)
{
  const double pi = std::acos(-1.0);
  Numbers numbers(seed);
  PointMatrix points(n, 3);
  for (int i = 0; i < n; ++i)
  {
    const double a = 2.0 * pi * numbers.Unit();
    const double b = 2.0 * pi * numbers.Unit();
    const double r = 2.0 + 0.7 * std::cos(b);
    points.row(i) << r * std::cos(a), r * std::sin(a), 0.7 * std::sin(b);
  }
  return points;
}

Status OverXY(const PointMatrix& points)
{
  return CheckLayers(points.leftCols(2), points.col(2), "x and y");
}

void ExpectLayers(const char* name, const PointMatrix& points)
{
  SCOPED_TRACE(name);
  const Status status = OverXY(points);
  EXPECT_EQ(status.Code, ErrorCode::NotInSpace)
    << FindLayers(points.leftCols(2), points.col(2)).Share;
  EXPECT_NE(status.Detail.find("over x and y"), std::string::npos);
  EXPECT_NE(status.Detail.find("`trim`"), std::string::npos);
  // parameters by projection and all three coordinates as values
  EXPECT_EQ(CheckLayers(points.leftCols(2), points, "a plane").Code, ErrorCode::NotInSpace);
}

void ExpectNone(const char* name, const PointMatrix& points)
{
  SCOPED_TRACE(name);
  EXPECT_TRUE(OverXY(points)) << OverXY(points).Message();
  EXPECT_TRUE(CheckLayers(points.leftCols(2), points, "a plane"));
}
}

TEST(PointLayers, ClosedObjectsAreRefused_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 5; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    ExpectLayers("sphere", Sphere(seed, 2000, 0.0, { 1.0, 1.0, 1.0 }));
    ExpectLayers("few points", Sphere(seed, 400, 0.0, { 1.0, 1.0, 1.0 }));
    ExpectLayers("many points", Sphere(seed, 100000, 0.0, { 5.0, 5.0, 5.0 }));
    ExpectLayers("noise", Sphere(seed, 2000, 0.05, { 1.0, 1.0, 1.0 }));
    ExpectLayers("flat", Sphere(seed, 2000, 0.0, { 1.0, 0.6, 0.03 }));
    ExpectLayers("heights in other units", Sphere(seed, 2000, 0.0, { 1.0, 1.0, 1000.0 }));
    ExpectLayers("torus", Torus(seed, 3000));
  }
}

TEST(PointLayers, TwoLayersAreRefused_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 5; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    ExpectLayers("planes",
      Cloud(seed, 3000,
        [](double, double, Numbers& numbers) { return numbers.Chance(0.5) ? 1.0 : 0.0; }));
    ExpectLayers("one of few points",
      Cloud(seed, 3000,
        [](double, double, Numbers& numbers) { return numbers.Chance(0.3) ? 0.5 : 0.0; }));
    ExpectLayers("slopes and noise",
      Cloud(seed, 3000,
        [](double x, double y, Numbers& numbers)
        { return x + 2.0 * y + (numbers.Chance(0.5) ? 0.4 : 0.0) + 0.02 * numbers.Normal(); }));
    ExpectLayers("three",
      Cloud(seed, 3000,
        [](double x, double, Numbers& numbers)
        { return 0.1 * std::sin(5.0 * x) + std::floor(3.0 * numbers.Unit()); }));
  }
}

TEST(PointLayers, SurfacesWithNoiseAreNone_PropertyOracle)
{
  const auto hills = [](double x, double y) { return std::sin(9.0 * x) * std::cos(7.0 * y); };
  for (unsigned seed = 1; seed <= 5; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    for (const double noise : { 0.0, 0.01, 0.2, 1.0, 100.0 })
    {
      ExpectNone("terrain",
        Cloud(seed, 4000,
          [&](double x, double y, Numbers& numbers)
          { return hills(x, y) + noise * numbers.Normal(); }));
    }
    ExpectNone("uniform noise",
      Cloud(seed, 4000, [&](double, double, Numbers& numbers) { return numbers.Unit(); }));
    for (const double share : { 0.05, 0.1, 0.3 })
    {
      ExpectNone("outliers",
        Cloud(seed, 4000,
          [&](double x, double y, Numbers& numbers)
          { return hills(x, y) + (numbers.Chance(share) ? 5.0 : 0.01) * numbers.Normal(); }));
    }
    ExpectNone("outliers above",
      Cloud(seed, 4000,
        [&](double x, double y, Numbers& numbers)
        { return hills(x, y) + (numbers.Chance(0.1) ? 5.0 * numbers.Unit() : 0.0); }));
    ExpectNone("rounded heights",
      Cloud(seed, 4000,
        [&](double x, double y, Numbers& numbers)
        { return std::round(8.0 * hills(x, y) + 0.3 * numbers.Normal()); }));
    ExpectNone("many points",
      Cloud(seed, 200000,
        [&](double x, double y, Numbers& numbers)
        { return hills(x, y) + 0.1 * numbers.Normal(); }));
  }
}

TEST(PointLayers, RoundedHeightsAreNone_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 5; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    for (const double noise : { 0.35, 0.6, 1.0, 3.0 })
    {
      SCOPED_TRACE("noise " + std::to_string(noise));
      ExpectNone("flat",
        Cloud(seed, 10000,
          [&](double, double, Numbers& numbers)
          { return std::round(101.5 + noise * numbers.Normal()); }));
      ExpectNone("gentle slope",
        Cloud(seed, 10000,
          [&](double x, double, Numbers& numbers)
          { return 0.25 * std::round(4.0 * (10.0 + 0.9 * x) + noise * numbers.Normal()); }));
      // two of them, some steps apart
      ExpectLayers("rounded layers",
        Cloud(seed, 10000,
          [&](double, double, Numbers& numbers)
          {
            return std::round(noise * numbers.Normal()) +
              std::round(8.0 * std::max(1.0, noise)) * (numbers.Chance(0.5) ? 1.0 : 0.0);
          }));
    }
  }
}

/// Ribs that are well sampled, of many points: places are as wide as those of a small part of them.
TEST(PointLayers, LargeCloudsAreJudgedAsTheirParts_PropertyOracle)
{
  Numbers numbers(3);
  const double pi = std::acos(-1.0);
  const auto phase = [](double x) { return std::fmod(1000.0 * x, 20.0) / 20.0; };
  ExpectNone("square ribs",
    Grid(500,
      [&](double x, double) { return (phase(x) < 0.5 ? 1.0 : 0.0) + 0.01 * numbers.Normal(); }));
  ExpectNone("trapezoid ribs",
    Grid(500,
      [&](double x, double)
      {
        return std::clamp(0.5 + 1.2 * std::sin(2.0 * pi * phase(x)), 0.0, 1.0) +
          0.01 * numbers.Normal();
      }));
  ExpectLayers("ribs in both layers",
    Grid(500,
      [&](double x, double)
      { return 0.1 * phase(x) + (numbers.Chance(0.5) ? 1.0 : 0.0) + 0.01 * numbers.Normal(); }));
}

TEST(PointLayers, APointOfTheFirstPlaceIsNamed_ExactOracle)
{
  const PointMatrix half = Cloud(5, 50000,
    [](double x, double, Numbers& numbers) { return x > 0.6 && numbers.Chance(0.5) ? 1.0 : 0.0; });
  const LayeredPlaces places = FindLayers(half.leftCols(2), half.col(2));
  // the places over x > 0.6, but for those where one layer has hardly any points
  EXPECT_GT(places.Share, 0.3);
  EXPECT_LT(places.Share, 0.41);
  ASSERT_GE(places.Point, 0);
  EXPECT_GT(half(places.Point, 0), 0.59);
  const std::string at = "around point " + std::to_string(places.Point) + " at " +
    PointText(half.row(places.Point).data(), 2) + ")";
  EXPECT_NE(OverXY(half).Detail.find(at), std::string::npos) << OverXY(half).Detail;
  EXPECT_EQ(FindLayers(half.leftCols(2), half.leftCols(1)).Point, -1);
}

TEST(PointLayers, SteepSurfacesAreNone_PropertyOracle)
{
  ExpectNone("cliff",
    Cloud(1, 4000, [](double x, double, Numbers&) { return 50.0 * std::tanh(40.0 * (x - 0.5)); }));
  ExpectNone("step",
    Cloud(2, 4000, [](double x, double y, Numbers&) { return x + 0.3 * y > 0.6 ? 10.0 : 0.0; }));
  ExpectNone(
    "slope", Cloud(3, 4000, [](double x, double y, Numbers&) { return 1000.0 * x + 300.0 * y; }));
  ExpectNone("peak",
    Cloud(4, 4000,
      [](double x, double y, Numbers&)
      { return 100.0 * std::exp(-500.0 * ((x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5))); }));
  ExpectNone("blocks",
    Cloud(5, 8000,
      [](double x, double y, Numbers&)
      { return std::fmod(std::floor(8.0 * x) + std::floor(8.0 * y), 2.0); }));
  ExpectNone(
    "waves", Cloud(6, 4000, [](double x, double, Numbers&) { return 5.0 * std::sin(60.0 * x); }));
  ExpectNone("slope of a grid", Grid(60, [](double x, double) { return 3.0 * x; }));
  ExpectNone("hills of a grid",
    Grid(60, [](double x, double y) { return std::sin(12.0 * x) * std::sin(9.0 * y); }));
  ExpectNone("steps of a grid",
    Grid(60,
      [](double x, double y) { return std::floor(8.0 * std::sin(3.0 * x) * std::sin(4.0 * y)); }));
  ExpectNone("flat", Grid(60, [](double x, double y) { return 0.3 + 1e-17 * x * y; }));
  ExpectNone("a row of points",
    Cloud(7, 100, [](double, double, Numbers&) { return 0.0; }) *
      Eigen::Matrix3d(Eigen::Vector3d(1.0, 0.0, 0.0).asDiagonal()));
}

TEST(PointLayers, OtherParametersOfAClosedObjectAreAccepted_PropertyOracle)
{
  // a sphere by longitude and latitude, and by x and y
  const PointMatrix sphere = Sphere(3, 4000, 0.01, { 1.0, 1.0, 1.0 });
  PointMatrix angles(sphere.rows(), 2);
  for (Eigen::Index i = 0; i < sphere.rows(); ++i)
  {
    angles.row(i) << std::atan2(sphere(i, 1), sphere(i, 0)),
      std::atan2(sphere(i, 2), std::hypot(sphere(i, 0), sphere(i, 1)));
  }
  EXPECT_TRUE(CheckLayers(angles, sphere, "angles"));
  EXPECT_FALSE(CheckLayers(sphere.leftCols(2), sphere, "x and y"));
}

TEST(PointLayers, ThinObjectsAreRefusedOverTheirPlane_PropertyOracle)
{
  const PointMatrix thin = Sphere(4, 3000, 0.0, { 3.0, 2.0, 0.05 });
  const auto plane = PlaneParameters(thin);
  ASSERT_TRUE(plane) << plane.Status.Message(); // less rough than its cells are wide
  EXPECT_EQ(CheckLayers(plane.Value, thin, "a plane").Code, ErrorCode::NotInSpace);
}

TEST(PointLayers, WhatCannotBeJudgedIsAccepted_ExactOracle)
{
  EXPECT_EQ(FindLayers(PointMatrix(0, 2), PointMatrix(0, 1)).Share, 0.0);
  PointMatrix sphere = Sphere(1, 1000, 0.0, { 1.0, 1.0, 1.0 });
  EXPECT_EQ(FindLayers(sphere.topRows(11).leftCols(2), sphere.topRows(11).col(2)).Share, 0.0);
  sphere(7, 2) = std::numeric_limits<double>::quiet_NaN(); // is refused by name later
  EXPECT_TRUE(OverXY(sphere));
  EXPECT_TRUE(OverXY(PointMatrix::Ones(100, 3)));
}

TEST(PointLayers, UnitsOfParametersAndHeightsDoNotMatter_PropertyOracle)
{
  const PointMatrix sphere = Sphere(2, 3000, 0.02, { 1.0, 1.0, 1.0 });
  const double share = FindLayers(sphere.leftCols(2), sphere.col(2)).Share;
  EXPECT_GT(share, 0.4);
  EXPECT_EQ(FindLayers(1024.0 * sphere.leftCols(2), sphere.col(2)).Share, share);
  EXPECT_EQ(FindLayers(sphere.leftCols(2), 1024.0 * sphere.col(2)).Share, share);
}
