// SPDX-License-Identifier: BSD-3-Clause
// Profiles of extrusions and revolutions, and their surfaces next to points.
#include <knotwork/SplineCore/CurveInterpolation.h>
#include <knotwork/SplineCore/FitProfileSurface.h>
#include <knotwork/SplineCore/SurfaceProfile.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace knotwork;

namespace
{
constexpr double Pi = 3.14159265358979323846;

/// y = x^2 over [-1, 1], parameter x.
SurfaceProfile Parabola()
{
  Spline<1> curve;
  curve.Space = MakeTensorSpace<1>({ KnotVector::Uniform(2, 1, -1.0, 1.0) }).Value;
  curve.ControlPoints.resize(3, 2);
  curve.ControlPoints << -1.0, 1.0, 0.0, -1.0, 1.0, 1.0;
  return { curve, Eigen::Vector3d::UnitX() };
}

/// An S of two arcs in a plane: x, y over a share in [0, 1].
Eigen::Vector2d PointOfS(double share)
{
  const double angle = 1.2 * Pi * (share - 0.5);
  return { 1.5 * angle, std::sin(angle) };
}

struct Strips
{
  std::vector<Eigen::Vector3d> Points;
  std::vector<std::array<int, 2>> Edges;
  std::vector<FlatPiece> Pieces;
  std::vector<char> Straight() const { return std::vector<char>(this->Edges.size(), 0); }
};

/// Rows of points along a profile: an extrusion, or turned by half a turn.
Strips StripsOf(SurfaceType type, int count, int rows, double noise)
{
  Strips strips;
  std::mt19937 random(5);
  const Eigen::AngleAxisd tilt(0.8, Eigen::Vector3d(1, -2, 1).normalized());
  for (int j = 0; j < rows; ++j)
  {
    for (int i = 0; i <= count; ++i)
    {
      const Eigen::Vector2d at = PointOfS(static_cast<double>(i) / count);
      const double share = static_cast<double>(j) / (rows - 1);
      const Eigen::Vector3d point = type == SurfaceType::Extrusion
        ? Eigen::Vector3d(at[0], at[1], 2.0 * share)
        : Eigen::AngleAxisd(Pi * share, Eigen::Vector3d::UnitX()) *
          Eigen::Vector3d(at[0], 3.0 + at[1], 0.0);
      Eigen::Vector3d moved = tilt * point;
      for (int d = 0; d < 3; ++d)
      {
        moved[d] += noise * (static_cast<double>(random()) / 2147483648.0 - 1.0);
      }
      strips.Points.push_back(moved);
    }
  }
  const int width = count + 1;
  for (int j = 0; j + 1 < rows; ++j)
  {
    for (int i = 0; i < count; ++i)
    {
      const int a = j * width + i;
      const std::array<int, 4> corners{ a, a + 1, a + 1 + width, a + width };
      Eigen::Vector3d centre = Eigen::Vector3d::Zero();
      const auto at = [&](std::size_t k)
      { return strips.Points[static_cast<std::size_t>(corners[k])]; };
      for (std::size_t k = 0; k < 4; ++k)
      {
        strips.Edges.push_back({ corners[k], corners[(k + 1) % 4] });
        centre += at(k) / 4.0;
      }
      strips.Pieces.push_back({ centre, (at(2) - at(0)).cross(at(3) - at(1)).normalized() });
    }
  }
  return strips;
}
}

/// Oracle: the nearest of many points, 1e-5 apart: no distance is below 0.005.
TEST(SurfaceProfile, NearestPoints_IndependentOracle)
{
  const SurfaceProfile profile = Parabola();
  std::mt19937 random(3);
  for (int trial = 0; trial < 50; ++trial)
  {
    const auto draw = [&]() { return static_cast<double>(random()) / 2147483648.0 - 1.0; };
    const Eigen::Vector2d point(1.5 * draw(), 0.4 + 0.6 * draw());
    double least = HUGE_VAL;
    double place = 0.0;
    for (int i = -200000; i <= 200000; ++i) // a fifth of the way goes on straight on either side
    {
      const double x = i * 1e-5;
      const double inside = std::min(std::max(x, -1.0), 1.0);
      const Eigen::Vector2d at(x, inside * inside + (x - inside) * 2.0 * inside);
      if ((at - point).squaredNorm() < least)
      {
        least = (at - point).squaredNorm();
        place = x;
      }
    }
    EXPECT_NEAR(std::abs(profile.Distance(point)), std::sqrt(least), 1e-8) << point.transpose();
    if (std::abs(point[0]) > 0.1) // two points of the parabola are as near there
    {
      EXPECT_NEAR(profile.Nearest(point), place, 1e-4) << point.transpose();
    }
    const bool isBelow = point[1] < place * place || std::abs(place) > 1.0;
    if (std::abs(place) < 1.0)
    {
      EXPECT_EQ(profile.Distance(point) > 0.0, isBelow); // to the right of the curve
      EXPECT_EQ(profile.Normal(point)[1] < 0.0, true);
    }
  }
  EXPECT_GE(profile.MaxCurvature(), 2.0); // that of the vertex
}

TEST(SurfaceProfile, PartsAreTheCurve_Exact)
{
  const SurfaceProfile profile = Parabola();
  const Spline<1> part = profile.Part(-0.25, 0.75);
  EXPECT_EQ(part.Space->Knots[0].Begin(), -0.25);
  EXPECT_EQ(part.Space->Knots[0].End(), 0.75);
  PointMatrix at(1, 1);
  for (const double x : { -0.25, 0.1, 0.75 })
  {
    at(0, 0) = x;
    const PointMatrix point = CurvePoints(part, at);
    EXPECT_NEAR(point(0, 0), x, 1e-14);
    EXPECT_NEAR(point(0, 1), x * x, 1e-14);
  }
}

/// Axis and distances; the axis of a revolution is that about which the strips were turned.
TEST(FitProfileSurface, SurfacesOfStrips_Exact)
{
  const Eigen::AngleAxisd tilt(0.8, Eigen::Vector3d(1, -2, 1).normalized());
  for (const SurfaceType type : { SurfaceType::Extrusion, SurfaceType::Revolution })
  {
    const bool turns = type == SurfaceType::Revolution;
    const Eigen::Vector3d axis =
      tilt * (turns ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ()).eval();
    const Strips strips = StripsOf(type, 40, 12, 0.0);
    AnalyticSurface found;
    ASSERT_TRUE(FitProfileSurface(
      type, strips.Points, strips.Edges, strips.Straight(), strips.Pieces, 1e-6, found))
      << ToString(type);
    EXPECT_EQ(found.Type, type);
    EXPECT_LT(MaxDistance(strips.Points, found), 1e-4) << ToString(type); // of 5.7 long
    EXPECT_LT(found.Axis.cross(axis).norm(), 1e-5) << ToString(type);
    if (turns)
    {
      EXPECT_LT(found.Point.cross(axis).norm(), 1e-4);
    }
    // wrong by far where the points are not
    EXPECT_GT(
      std::abs(found.Distance(strips.Points[20] + 0.1 * found.Normal(strips.Points[20]))), 0.099);
  }
}

/// With noise the largest distance is that of the noise, and the axis about as right.
TEST(FitProfileSurface, SurfacesOfNoisyStrips_Property)
{
  constexpr double Noise = 1e-3;
  for (const SurfaceType type : { SurfaceType::Extrusion, SurfaceType::Revolution })
  {
    const Strips strips = StripsOf(type, 40, 12, Noise);
    AnalyticSurface found;
    ASSERT_TRUE(FitProfileSurface(
      type, strips.Points, strips.Edges, strips.Straight(), strips.Pieces, Noise, found));
    EXPECT_LT(MaxDistance(strips.Points, found), 2.0 * std::sqrt(3.0) * Noise) << ToString(type);
  }
}

TEST(FitProfileSurface, EveryFailureIsReachable)
{
  const Strips strips = StripsOf(SurfaceType::Extrusion, 40, 12, 0.0);
  AnalyticSurface found;
  const auto fit = [&](SurfaceType type, const Strips& of)
  { return FitProfileSurface(type, of.Points, of.Edges, of.Straight(), of.Pieces, 1e-6, found); };
  EXPECT_FALSE(fit(SurfaceType::Cylinder, strips));
  EXPECT_FALSE(fit(SurfaceType::FreeForm, strips));
  Strips few = StripsOf(SurfaceType::Extrusion, 3, 2, 0.0);
  EXPECT_FALSE(fit(SurfaceType::Extrusion, few));
  Strips apart = strips;
  apart.Edges.resize(10);
  EXPECT_FALSE(fit(SurfaceType::Extrusion, apart));
  Strips flat = strips;
  for (std::size_t i = 0; i < flat.Points.size(); ++i)
  {
    flat.Points[i][2] = 0.0;
  }
  for (FlatPiece& piece : flat.Pieces)
  {
    piece.Normal = Eigen::Vector3d::UnitZ();
  }
  EXPECT_FALSE(fit(SurfaceType::Extrusion, flat));
  EXPECT_FALSE(fit(SurfaceType::Revolution, strips)); // normals of an extrusion have no axis
}
