// SPDX-License-Identifier: BSD-3-Clause
#include "ConstrainedDelaunay.h"
#include "FlipTriangulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <random>
#include <set>

using namespace knotwork;

namespace
{
/// Whole coordinates small enough for 64-bit integers to be exact to the fourth degree.
std::vector<PlanarPoint> RandomPoints(unsigned seed, int n, int size)
{
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> in(-size, size);
  std::set<PlanarPoint> distinct;
  while (static_cast<int>(distinct.size()) < n)
  {
    distinct.insert({ static_cast<double>(in(random)), static_cast<double>(in(random)) });
  }
  std::vector<PlanarPoint> points(distinct.begin(), distinct.end());
  std::shuffle(points.begin(), points.end(), random);
  return points;
}

std::int64_t Cross(const PlanarPoint& a, const PlanarPoint& b, const PlanarPoint& c)
{
  const auto x = [](double p, double q) { return static_cast<std::int64_t>(p - q); };
  return x(a[0], c[0]) * x(b[1], c[1]) - x(a[1], c[1]) * x(b[0], c[0]);
}

/// Positive when d lies inside the circle through a, b, c (counterclockwise).
std::int64_t InCircle(
  const PlanarPoint& a, const PlanarPoint& b, const PlanarPoint& c, const PlanarPoint& d)
{
  std::int64_t m[3][3];
  const PlanarPoint* rows[3] = { &a, &b, &c };
  for (int i = 0; i < 3; ++i)
  {
    m[i][0] = static_cast<std::int64_t>((*rows[i])[0] - d[0]);
    m[i][1] = static_cast<std::int64_t>((*rows[i])[1] - d[1]);
    m[i][2] = m[i][0] * m[i][0] + m[i][1] * m[i][1];
  }
  return m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]) -
    m[1][2] * (m[0][0] * m[2][1] - m[0][1] * m[2][0]) +
    m[2][2] * (m[0][0] * m[1][1] - m[0][1] * m[1][0]);
}

/// Do segments have a common point that is not an end of both? By parameters, in rationals.
bool MeetSlow(const std::vector<PlanarPoint>& points, PlanarSegment s, PlanarSegment t)
{
  const auto on = [&](int p, PlanarSegment segment)
  {
    const PlanarPoint& a = points[segment[0]];
    const PlanarPoint& b = points[segment[1]];
    const PlanarPoint& c = points[p];
    return Cross(a, b, c) == 0 && (c[0] - a[0]) * (c[0] - b[0]) <= 0.0 &&
      (c[1] - a[1]) * (c[1] - b[1]) <= 0.0;
  };
  for (int i = 0; i < 2; ++i) // an end on the other segment that is not its end
  {
    if ((on(s[i], t) && s[i] != t[0] && s[i] != t[1]) ||
      (on(t[i], s) && t[i] != s[0] && t[i] != s[1]))
    {
      return true;
    }
  }
  const bool same = std::minmax(s[0], s[1]) == std::minmax(t[0], t[1]);
  const auto sign = [&](int a, int b, int c)
  {
    const std::int64_t area = Cross(points[a], points[b], points[c]);
    return area > 0 ? 1 : (area < 0 ? -1 : 0);
  };
  return same ||
    (sign(s[0], s[1], t[0]) * sign(s[0], s[1], t[1]) < 0 &&
      sign(t[0], t[1], s[0]) * sign(t[0], t[1], s[1]) < 0);
}

/// Twice the area of the convex hull.
std::int64_t HullArea(std::vector<PlanarPoint> points)
{
  std::sort(points.begin(), points.end());
  std::int64_t area = 0;
  for (int side = 0; side < 2; ++side) // lower and upper chain
  {
    std::vector<PlanarPoint> chain;
    for (const PlanarPoint& p : points)
    {
      while (chain.size() > 1 && Cross(chain[chain.size() - 2], chain.back(), p) <= 0)
      {
        chain.pop_back();
      }
      chain.push_back(p);
    }
    for (std::size_t i = 0; i + 1 < chain.size(); ++i)
    {
      area += Cross(chain[i], chain[i + 1], points.front());
    }
    for (PlanarPoint& p : points)
    {
      p = { -p[0], -p[1] };
    }
    std::reverse(points.begin(), points.end());
  }
  return area;
}

/// Segments between random points, none of which cross.
std::vector<PlanarSegment> RandomSegments(
  unsigned seed, const std::vector<PlanarPoint>& points, int tries)
{
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> in(0, static_cast<int>(points.size()) - 1);
  std::vector<PlanarSegment> segments;
  for (int k = 0; k < tries; ++k)
  {
    const PlanarSegment segment{ in(random), in(random) };
    bool good = segment[0] != segment[1];
    for (std::size_t p = 0; p < points.size() && good; ++p) // no points on it
    {
      const PlanarSegment point{ static_cast<int>(p), static_cast<int>(p) };
      good = point[0] == segment[0] || point[0] == segment[1] || !MeetSlow(points, segment, point);
    }
    for (const PlanarSegment& other : segments)
    {
      good = good && !MeetSlow(points, segment, other);
    }
    if (good)
    {
      segments.push_back(segment);
    }
  }
  return segments;
}
}

TEST(PlanarRegion, OrientationIsExact_ExactOracle)
{
  // Nearly collinear points near the largest coordinates: products differ in their last bits.
  for (int k = 1; k < 200; ++k)
  {
    const double x = PlanarGridSize - 4096.0 * k;
    const double y = PlanarGridSize - 8192.0 - 3.0 * k;
    const PlanarPoint a{ -x, -y };
    const PlanarPoint b{ x, y };
    EXPECT_EQ(Orientation(a, b, { 0.0, 0.0 }), 0);
    EXPECT_EQ(Orientation(a, { x, y + 1.0 }, { 0.0, 0.0 }), -1);
    EXPECT_EQ(Orientation(a, { x + 1.0, y }, { 0.0, 0.0 }), 1);
    EXPECT_EQ(Orientation({ x + 1.0, y }, a, { 0.0, 0.0 }), -1);
  }
}

TEST(PlanarRegion, CrossingsAreAllFound_CrossOracle)
{
  for (unsigned seed = 1; seed <= 30; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    // A small grid: many collinear and touching segments.
    const std::vector<PlanarPoint> points = RandomPoints(seed, 40, seed % 2 == 0 ? 5 : 50);
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> in(0, 39);
    std::vector<PlanarSegment> segments;
    for (int k = 0; k < 40; ++k)
    {
      segments.push_back({ in(random), in(random) });
    }
    std::vector<std::array<int, 2>> expected;
    for (int s = 0; s < 40; ++s)
    {
      if (segments[s][0] == segments[s][1])
      {
        expected.push_back({ s, s });
      }
      for (int t = s + 1; t < 40; ++t)
      {
        if (MeetSlow(points, segments[s], segments[t]))
        {
          expected.push_back({ s, t });
        }
      }
    }
    EXPECT_EQ(FindCrossings(points, segments), expected);
  }
}

TEST(PlanarRegion, InsidePolygonsCountsSegments_ExactOracle)
{
  // A square with a diamond as its hole.
  const std::vector<PlanarPoint> points{ { 0, 0 }, { 20, 0 }, { 20, 20 }, { 0, 20 }, { 10, 4 },
    { 4, 10 }, { 10, 16 }, { 16, 10 } };
  const std::vector<PlanarSegment> segments{ { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 }, { 4, 5 },
    { 5, 6 }, { 6, 7 }, { 7, 4 } };
  std::vector<PlanarPoint> queries;
  std::vector<bool> expected;
  for (int x = -3; x < 24; ++x)
  {
    for (int y = -3; y < 24; ++y)
    {
      const int diamond = std::abs(x - 10) + std::abs(y - 10);
      const bool onRim = diamond == 6 || ((x == 0 || x == 20) && y >= 0 && y <= 20) ||
        ((y == 0 || y == 20) && x >= 0 && x <= 20);
      if (!onRim)
      {
        queries.push_back({ static_cast<double>(x), static_cast<double>(y) });
        expected.push_back(x > 0 && x < 20 && y > 0 && y < 20 && diamond > 6);
      }
    }
  }
  EXPECT_EQ(InsidePolygons(points, segments, queries), expected);
}

using Triangulator = Result<std::vector<std::array<int, 3>>> (*)(
  const std::vector<PlanarPoint>&, const std::vector<PlanarSegment>&);

/// That of the build, and our own.
class Triangulations : public ::testing::TestWithParam<Triangulator>
{
};
INSTANTIATE_TEST_SUITE_P(Both, Triangulations,
  ::testing::Values(&ConstrainedDelaunay, &FlipTriangulation),
  [](const auto& param) { return param.index == 0 ? "ConstrainedDelaunay" : "FlipTriangulation"; });

TEST_P(Triangulations, CoversTheHullOnce_ExactOracle)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const std::vector<PlanarPoint> points = RandomPoints(seed, 60, 2000);
    const auto segments = RandomSegments(seed, points, 40);
    ASSERT_GE(segments.size(), 5u);
    const auto triangles = GetParam()(points, segments);
    ASSERT_TRUE(triangles) << triangles.Status.Message();
    std::int64_t area = 0;
    std::set<std::array<int, 2>> edges;
    for (const auto& t : triangles.Value)
    {
      const std::int64_t one = Cross(points[t[0]], points[t[1]], points[t[2]]);
      EXPECT_GT(one, 0);
      area += one;
      for (int i = 0; i < 3; ++i)
      {
        EXPECT_TRUE(edges.insert({ t[i], t[(i + 1) % 3] }).second);
      }
    }
    EXPECT_EQ(area, HullArea(points));
    for (const PlanarSegment& s : segments)
    {
      EXPECT_EQ(edges.count({ s[0], s[1] }) + edges.count({ s[1], s[0] }) > 0, true);
    }
  }
}

TEST_P(Triangulations, CirclesAreEmpty_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const std::vector<PlanarPoint> points = RandomPoints(seed, 60, 2000);
    const auto segments = RandomSegments(seed, points, 40);
    std::set<std::array<int, 2>> fixed;
    for (const PlanarSegment& s : segments)
    {
      fixed.insert({ s[0], s[1] });
      fixed.insert({ s[1], s[0] });
    }
    const auto triangles = GetParam()(points, segments);
    ASSERT_TRUE(triangles) << triangles.Status.Message();
    std::map<std::array<int, 2>, int> apex;
    for (const auto& t : triangles.Value)
    {
      for (int i = 0; i < 3; ++i)
      {
        apex[{ t[i], t[(i + 1) % 3] }] = t[(i + 2) % 3];
      }
    }
    for (const auto& [edge, top] : apex) // locally Delaunay is Delaunay
    {
      const auto other = apex.find({ edge[1], edge[0] });
      if (other != apex.end() && fixed.count(edge) == 0)
      {
        EXPECT_LE(
          InCircle(points[edge[0]], points[edge[1]], points[top], points[other->second]), 0);
      }
    }
  }
}

TEST_P(Triangulations, OrderOfSegmentsDoesNotMatter_PropertyOracle)
{
  // Cocircular points everywhere: a grid with a polygon.
  std::vector<PlanarPoint> points;
  for (int i = 0; i < 100; ++i)
  {
    points.push_back({ static_cast<double>(i % 10), static_cast<double>(i / 10) });
  }
  auto segments = RandomSegments(1, points, 60);
  ASSERT_GE(segments.size(), 5u);
  const auto first = GetParam()(points, segments);
  ASSERT_TRUE(first) << first.Status.Message();
  std::reverse(segments.begin(), segments.end());
  EXPECT_EQ(GetParam()(points, segments).Value, first.Value);
}

TEST_P(Triangulations, EveryFailureIsReachable)
{
  const std::vector<PlanarPoint> line{ { 0, 0 }, { 1, 1 }, { 2, 2 } };
  EXPECT_EQ(GetParam()(line, {}).Status.Code, ErrorCode::InvalidTopology);
  const std::vector<PlanarPoint> twice{ { 0, 0 }, { 4, 0 }, { 0, 4 }, { 0, 0 } };
  EXPECT_EQ(GetParam()(twice, { { 0, 3 } }).Status.Code, ErrorCode::InvalidTopology);
}

TEST(FlipTriangulation, AgreesWithTheBuildsOwn_CrossOracle)
{
  // In general position and with the largest coordinates there is one constrained Delaunay
  // triangulation.
  for (unsigned seed = 1; seed <= 10; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::vector<PlanarPoint> points = RandomPoints(seed, 400, 100000);
    const auto segments = RandomSegments(seed, points, 100);
    for (PlanarPoint& p : points)
    {
      p = { p[0] * 8388608.0, p[1] * 8388608.0 }; // times 2^23: crossings stay crossings
    }
    const auto flips = FlipTriangulation(points, segments);
    ASSERT_TRUE(flips) << flips.Status.Message();
    EXPECT_EQ(flips.Value, ConstrainedDelaunay(points, segments).Value);
  }
}

TEST(PlanarRegion, SelectsWhatLiesToTheLeft_ExactOracle)
{
  const std::vector<PlanarPoint> points{ { 0, 0 }, { 9, 0 }, { 9, 9 }, { 0, 9 }, { 3, 3 }, { 3, 6 },
    { 6, 6 }, { 6, 3 } };
  std::vector<PlanarSegment> segments{ { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 }, { 4, 5 }, { 5, 6 },
    { 6, 7 }, { 7, 4 } };
  const auto triangles = ConstrainedDelaunay(points, segments);
  ASSERT_TRUE(triangles);
  const auto area = [&](const PlanarRegion& region)
  {
    std::int64_t sum = 0;
    for (const auto& t : region.Triangles)
    {
      sum += Cross(points[t[0]], points[t[1]], points[t[2]]);
    }
    return sum;
  };
  const PlanarRegion region = SelectRegion(points.size(), triangles.Value, segments);
  EXPECT_TRUE(region.Misplaced.empty());
  EXPECT_EQ(area(region), 2 * (81 - 9));
  // The hole turned around encloses an island in the region: both loops are misplaced.
  for (std::size_t s = 4; s < 8; ++s)
  {
    std::swap(segments[s][0], segments[s][1]);
  }
  EXPECT_FALSE(SelectRegion(points.size(), triangles.Value, segments).Misplaced.empty());
  // The outer loop turned around has nothing to its left.
  for (std::size_t s = 0; s < 4; ++s)
  {
    std::swap(segments[s][0], segments[s][1]);
  }
  EXPECT_EQ(SelectRegion(points.size(), triangles.Value, { segments.begin(), segments.begin() + 4 })
              .Misplaced.size(),
    4u);
}
