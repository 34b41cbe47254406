// SPDX-License-Identifier: BSD-3-Clause
#include "TrimCases.h"
#include <knotwork/SplineCore/TrimmedRegion.h>

#include <gtest/gtest.h>

namespace knotwork
{
namespace
{
using testing::Polygon;

TrimmedRegion MakeRegion(const std::vector<TrimmedLoop>& loops)
{
  auto region = TrimmedRegion::Create(loops);
  EXPECT_TRUE(region) << region.Status.Message();
  return region.Value;
}

Polygon Reversed(Polygon polygon)
{
  std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

TEST(TrimmedRegion, StarsWithHoles_CrossOracle)
{
  oracle::Random random(1);
  for (int run = 0; run < 40; ++run)
  {
    const Polygon outer = testing::StarPolygon(random, random.Int(3, 200), 0.3, -0.2, 0.5, 1.0);
    const Polygon hole = testing::StarPolygon(random, random.Int(3, 20), 0.3, -0.2, 0.02, 0.2);
    const TrimmedRegion region =
      MakeRegion({ testing::PolygonLoop(outer), testing::PolygonLoop(Reversed(hole)) });
    for (int k = 0; k < 200; ++k)
    {
      const RealArray<2> point{ 0.3 + random.In(-1.1, 1.1), -0.2 + random.In(-1.1, 1.1) };
      const bool inside = testing::IsInside(outer, point) && !testing::IsInside(hole, point);
      // random points are farther from the curves than rounding
      ASSERT_EQ(region.Contains(point), inside ? RegionPlace::Inside : RegionPlace::Outside)
        << "run " << run << " at " << point[0] << " " << point[1];
    }
  }
}

TEST(TrimmedRegion, RayThroughCornersAndAlongEdges_ExactOracle)
{
  // heights of corners and of horizontal edges: every crossing rule that errs does so here
  const TrimmedRegion region = MakeRegion({ testing::PolygonLoop({ { 0, 0 }, { 4, 0 }, { 4, 2 },
    { 3, 2 }, { 3, 1 }, { 2, 1 }, { 2, 2 }, { 1, 1 }, { 0, 2 } }) });
  for (double u : { 0.25, 0.5, 1.5, 1.875 })
  {
    EXPECT_EQ(region.Contains({ u, 0.5 }), RegionPlace::Inside);
  }
  EXPECT_EQ(region.Contains({ 0.5, 1.0 }), RegionPlace::Inside);
  EXPECT_EQ(region.Contains({ 3.5, 1.0 }), RegionPlace::Inside);
  EXPECT_EQ(region.Contains({ 1.0, 1.5 }), RegionPlace::Outside);
  EXPECT_EQ(region.Contains({ 2.5, 2.0 }), RegionPlace::Outside);
  EXPECT_EQ(region.Contains({ 2.5, 1.5 }), RegionPlace::Outside);
  EXPECT_EQ(region.Contains({ -1.0, 0.0 }), RegionPlace::Outside);
  EXPECT_EQ(region.Contains({ -1.0, 1.0 }), RegionPlace::Outside);
  EXPECT_EQ(region.Contains({ -1.0, 2.0 }), RegionPlace::Outside);
  EXPECT_EQ(region.Contains({ 5.0, 0.0 }), RegionPlace::Outside);
  EXPECT_EQ(region.Contains({ 2.5, 1.0 }), RegionPlace::Boundary);
  EXPECT_EQ(region.Contains({ 4.0, 2.0 }), RegionPlace::Boundary);
}

TEST(TrimmedRegion, RationalCircle_ExactOracle)
{
  for (bool counterclockwise : { true, false }) // a lone loop that runs clockwise encloses as well
  {
    const TrimmedRegion region =
      MakeRegion({ testing::CircleLoop(0.5, -0.25, 0.75, counterclockwise) });
    for (int k = 0; k < 100; ++k)
    {
      const double angle = 2.0 * M_PI * k / 100;
      const auto at = [&](double radius) {
        return region.Contains(
          { 0.5 + radius * std::cos(angle), -0.25 + radius * std::sin(angle) });
      };
      // 1e-11: a thousand times what rounding can move
      ASSERT_EQ(at(0.75 * (1.0 - 1e-11)), RegionPlace::Inside) << k;
      ASSERT_EQ(at(0.75 * (1.0 + 1e-11)), RegionPlace::Outside) << k;
      ASSERT_EQ(at(0.75), RegionPlace::Boundary) << k;
    }
    bool onCurve = false;
    EXPECT_EQ(region.WindingNumber({ 0.5, -0.25 }, onCurve), counterclockwise ? 1 : -1);
    EXPECT_FALSE(onCurve);
  }
}

TEST(TrimmedRegion, CurvesOfDegreeNine_CrossOracle)
{
  oracle::Random random(2);
  for (int run = 0; run < 10; ++run)
  {
    const int elements = random.Int(1, 6);
    const KnotVector knots = KnotVector::Uniform(9, elements);
    Polygon points = testing::StarPolygon(random, knots.NumFunctions() - 1, 0.0, 0.0, 0.5, 1.0);
    points.push_back(points.front());
    std::vector<double> weights;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      weights.push_back(random.In(0.5, 2.0));
    }
    const TrimmingCurve curve = testing::MakeTrimmingCurve(knots, points, weights);
    const TrimmedRegion region = MakeRegion({ { { curve } } });
    Polygon fine;
    for (int k = 0; k < 600; ++k)
    {
      const auto p = oracle::Evaluate<1>(curve.ParameterCurve(), { k / 600.0 });
      fine.push_back({ p[0], p[1] });
    }
    for (int k = 0; k < 200; ++k)
    {
      const RealArray<2> point{ random.In(-1.0, 1.0), random.In(-1.0, 1.0) };
      if (testing::DistanceTo(fine, point) > 1e-3) // sagitta of the 600 chords is about 1e-4
      {
        ASSERT_EQ(region.Contains(point),
          testing::IsInside(fine, point) ? RegionPlace::Inside : RegionPlace::Outside);
      }
    }
  }
}

TEST(TrimmedRegion, BoxesAreProvedAndNotLeftOpen_PropertyOracle)
{
  oracle::Random random(3);
  int count[3] = {};
  for (int run = 0; run < 20; ++run)
  {
    const Polygon outer = testing::StarPolygon(random, 30, 0.0, 0.0, 0.5, 1.0);
    const TrimmedRegion region = MakeRegion({ testing::PolygonLoop(outer) });
    for (int k = 0; k < 200; ++k)
    {
      const double size = std::pow(10.0, random.In(-3.0, 0.0));
      const RealArray<2> lower{ random.In(-1.2, 1.2), random.In(-1.2, 1.2) };
      const RealArray<2> upper{ lower[0] + size, lower[1] + size };
      const RegionPlace place = region.Classify(lower, upper);
      ++count[static_cast<int>(place) + 1];
      double nearest = 1e300;
      for (int i = 0; i <= 8; ++i)
      {
        for (int j = 0; j <= 8; ++j)
        {
          const RealArray<2> point{ lower[0] + size * i / 8, lower[1] + size * j / 8 };
          nearest = std::min(nearest, testing::DistanceTo(outer, point));
          if (place != RegionPlace::Boundary)
          {
            ASSERT_EQ(testing::IsInside(outer, point), place == RegionPlace::Inside);
          }
        }
      }
      // farther from the samples than their half diagonal and an eighth of the box: not left open
      if (nearest > 0.25 * size)
      {
        ASSERT_NE(place, RegionPlace::Boundary);
      }
    }
  }
  for (int c : count)
  {
    EXPECT_GT(c, 100); // the test sees all three
  }
}

TEST(TrimmedRegion, ReversedCurvesAndGaps_ExactOracle)
{
  // four sides, one stored backwards, one ends 1e-3 short of the corner
  const auto side = [](double u0, double v0, double u1, double v1, bool reversed)
  {
    const Polygon points =
      reversed ? Polygon{ { u1, v1 }, { u0, v0 } } : Polygon{ { u0, v0 }, { u1, v1 } };
    TrimmingCurve curve = testing::MakeTrimmingCurve(KnotVector::Uniform(1, 1), points);
    curve.Reversed = reversed;
    return curve;
  };
  const TrimmedRegion region = MakeRegion({ { { side(0, 0, 1, 0, false), side(1, 0, 1, 0.999, true),
    side(1, 1, 0, 1, false), side(0, 1, 0, 0, true) } } });
  bool onCurve = false;
  EXPECT_EQ(region.WindingNumber({ 0.5, 0.5 }, onCurve), 1);
  EXPECT_EQ(region.WindingNumber({ 0.5, 0.9995 }, onCurve), 1); // its ray leaves through the gap
  EXPECT_EQ(region.WindingNumber({ -0.5, 0.9995 }, onCurve), 0);
  EXPECT_FALSE(onCurve);
  EXPECT_EQ(region.Contains({ 1.0, 0.9995 }), RegionPlace::Boundary);
  EXPECT_EQ(region.Classify({ 0.9, 0.9992 }, { 1.1, 0.9998 }), RegionPlace::Boundary);
}

TEST(TrimmedRegion, WithoutLoopsEverythingIsInside_ExactOracle)
{
  const TrimmedRegion region = MakeRegion({});
  EXPECT_TRUE(region.IsWholePlane());
  EXPECT_EQ(region.Contains({ 1e9, -1e9 }), RegionPlace::Inside);
  EXPECT_EQ(region.Classify({ -1, -1 }, { 1, 1 }), RegionPlace::Inside);
}

TEST(TrimmedRegion, FarFromTheOrigin_ExactOracle)
{
  const TrimmedRegion region = MakeRegion({ testing::CircleLoop(1e6, -1e6, 1.0) });
  EXPECT_EQ(region.Contains({ 1e6 + 0.999, -1e6 }), RegionPlace::Inside);
  EXPECT_EQ(region.Contains({ 1e6 + 1.001, -1e6 }), RegionPlace::Outside);
}

TEST(TrimmedRegion, Errors_ExactOracle)
{
  const TrimmedLoop good = testing::RectangleLoop(0, 1, 0, 1);
  EXPECT_EQ(TrimmedRegion::Create({ good, {} }).Status.Code, ErrorCode::EmptyInput);
  TrimmedLoop bad = good;
  bad.Curves[0].UV(1, 0) = std::nan("");
  auto region = TrimmedRegion::Create({ good, bad });
  EXPECT_EQ(region.Status.Code, ErrorCode::NonFiniteInput);
  EXPECT_NE(region.Status.Detail.find("loop 1, curve 0"), std::string::npos);
  bad = good;
  bad.Curves[0].UV = PointMatrix::Zero(5, 3);
  EXPECT_EQ(TrimmedRegion::Create({ bad }).Status.Code, ErrorCode::DimensionMismatch);
  bad.Curves[0].UV = PointMatrix::Zero(4, 2);
  EXPECT_EQ(TrimmedRegion::Create({ bad }).Status.Code, ErrorCode::SizeMismatch);
}
}
}
