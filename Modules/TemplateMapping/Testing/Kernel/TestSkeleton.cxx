// SPDX-License-Identifier: BSD-3-Clause
#include "TemplateCases.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

using namespace knotwork;

namespace
{
struct Cases
{
  Skeleton<2> Template = cases::CircleTemplate(101);
  Skeleton<2> Target = cases::LobedTarget({}, 20);
};

Status StatusAfter(const std::function<void(Cases&)>& damage)
{
  Cases cases;
  damage(cases);
  return CheckSkeletons(cases.Template, cases.Target);
}

void ExpectError(
  ErrorCode code, const std::string& words, const std::function<void(Cases&)>& damage)
{
  SCOPED_TRACE(words);
  const Status status = StatusAfter(damage);
  EXPECT_EQ(status.Code, code);
  EXPECT_NE(status.Detail.find(words), std::string::npos) << status.Message();
}
}

TEST(Skeleton, EveryFaultIsNamed)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(StatusAfter([](Cases&) {}));
  ExpectError(ErrorCode::EmptyInput, "template", [](Cases& c) { c.Template.clear(); });
  ExpectError(ErrorCode::EmptyInput, "target", [](Cases& c) { c.Target.clear(); });
  ExpectError(ErrorCode::InvalidTopology, "two patches of the template have the id 2",
    [](Cases& c) { c.Template[1].Id = 2; });
  ExpectError(ErrorCode::InvalidTopology, "two patches of the target have the id 3",
    [](Cases& c) { c.Target[0].Id = 3; });
  ExpectError(ErrorCode::InvalidTopology, "target patches 17, 23",
    [](Cases& c)
    {
      c.Target[1].Id = 23;
      c.Target[2].Id = 17;
    });
  ExpectError(ErrorCode::InvalidTopology, "target patch 1 has 1 points",
    [](Cases& c) { c.Target[1].Points.conservativeResize(1, 2); });
  ExpectError(ErrorCode::InvalidTopology, "template patch 4 has 0 points",
    [](Cases& c) { c.Template[4].Points.resize(0, 2); });
  ExpectError(ErrorCode::InvalidTopology, "target patch 2 is a single point",
    [](Cases& c) { c.Target[2].Points.setConstant(0.5); });
  ExpectError(ErrorCode::DimensionMismatch, "template patch 0 has points of 3 coordinates",
    [](Cases& c) { c.Template[0].Points = PointMatrix::Random(9, 3); });
  ExpectError(ErrorCode::NonFiniteInput, "target patch 3, point 7",
    [&](Cases& c) { c.Target[3].Points(7, 1) = nan; });
  ExpectError(ErrorCode::NonFiniteInput, "target patch 4, normal 5",
    [&](Cases& c) { c.Target[4].Normals(5, 0) = nan; });
  ExpectError(ErrorCode::NonFiniteInput, "template patch 4, parameter 0",
    [&](Cases& c) { c.Template[4].Parameters = PointMatrix::Constant(101, 1, nan); });
  ExpectError(ErrorCode::SizeMismatch, "target patch 4 has 20 points but 19",
    [](Cases& c) { c.Target[4].Normals.conservativeResize(19, 2); });
  ExpectError(ErrorCode::InvalidParameter, "target patch 4, normal 6 is zero",
    [](Cases& c) { c.Target[4].Normals.row(6).setZero(); });
  ExpectError(ErrorCode::InvalidParameter, "template patch 4, point 50",
    [](Cases& c)
    {
      c.Template[4].Parameters = Eigen::VectorXd::LinSpaced(101, 0.0, 1.0);
      c.Template[4].Parameters(50) = c.Template[4].Parameters(49);
    });
  ExpectError(ErrorCode::InvalidParameter, "target patch 1, point 19",
    [](Cases& c) { c.Target[1].Parameters = Eigen::VectorXd::LinSpaced(20, 0.0, 1.01); });
  // An id without a target is a free patch, not a fault; orders need not agree.
  EXPECT_TRUE(StatusAfter(
    [](Cases& c)
    {
      c.Target.erase(c.Target.begin() + 1);
      std::swap(c.Target[0], c.Target[3]);
    }));
}

TEST(Skeleton, NormalsOfPolylines_ExactOracle)
{
  // A regular polygon has normals through its centre at every vertex, at the seam too.
  SkeletonPatch<2> polygon;
  polygon.Points = cases::Polyline(
    13, [](double t) { return 2.0 + std::cos(2 * cases::Pi * t); },
    [](double t) { return -1.0 + std::sin(2 * cases::Pi * t); });
  const PointMatrix normals = UnitNormals(polygon);
  const PointMatrix radial = polygon.Points.rowwise() - Eigen::RowVector2d(2.0, -1.0);
  EXPECT_LE((normals - radial).cwiseAbs().maxCoeff(), 1e-14); // rounding of unit vectors

  // Open: the end pieces' own normals; a repeated point takes its neighbours'.
  SkeletonPatch<2> corner;
  corner.Points.resize(4, 2);
  corner.Points << 0, 0, 2, 0, 2, 0, 2, 2;
  const double half = std::sqrt(0.5);
  PointMatrix expected(4, 2);
  expected << 0, -1, half, -half, half, -half, 1, 0;
  EXPECT_LE((UnitNormals(corner) - expected).cwiseAbs().maxCoeff(), 1e-15);

  // A spike has no mean direction: that of the way in. Given normals are scaled to length 1.
  SkeletonPatch<2> spike;
  spike.Points.resize(3, 2);
  spike.Points << 0, 0, 1, 0, 0, 0;
  EXPECT_TRUE(UnitNormals(spike).allFinite());
  spike.Normals = PointMatrix::Constant(3, 2, -4.0);
  EXPECT_LE((UnitNormals(spike).array() + half).abs().maxCoeff(), 1e-15);
}

TEST(Skeleton, PatchIsLinearBetweenItsPoints_ExactOracle)
{
  PointMatrix points(3, 2);
  points << 0, 0, 1, 2, 5, 2;
  const PatchCurve curve(points, Eigen::Vector3d(1.0, 1.5, 3.5));
  const auto expect = [&](double t, double x, double y, double dx, double dy)
  {
    double position[2];
    double along[2];
    curve.Evaluate(t, position, along);
    EXPECT_DOUBLE_EQ(position[0], x) << t;
    EXPECT_DOUBLE_EQ(position[1], y) << t;
    EXPECT_DOUBLE_EQ(along[0], dx) << t;
    EXPECT_DOUBLE_EQ(along[1], dy) << t;
  };
  expect(1.0, 0, 0, 2, 4);
  expect(1.25, 0.5, 1, 2, 4);
  expect(1.5, 1, 2, 2, 0);
  expect(2.5, 3, 2, 2, 0);
  expect(3.5, 5, 2, 2, 0);
  expect(0.0, 0, 0, 2, 4); // clamped
  expect(9.0, 5, 2, 2, 0);
  EXPECT_EQ(curve.SampleParameters(0), Eigen::Vector3d(1.0, 1.5, 3.5));
  EXPECT_EQ(curve.SampleParameters(3), Eigen::Vector3d(1.0, 2.25, 3.5));
}
