// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/MeshParameterization/PolygonTriangles.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

namespace knotwork
{
namespace
{
using Plane = std::vector<std::array<double, 2>>;

double AreaOf(
  const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& c)
{
  return 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
}

/// The polygon in a plane that is turned in space and shifted.
PointMatrix InSpace(const Plane& polygon)
{
  const Eigen::RowVector3d u = Eigen::RowVector3d(2, 1, 2) / 3.0;
  const Eigen::RowVector3d v = Eigen::RowVector3d(-2, 2, 1) / 3.0;
  PointMatrix points(static_cast<Eigen::Index>(polygon.size()), 3);
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    points.row(static_cast<Eigen::Index>(i)) =
      polygon[i][0] * u + polygon[i][1] * v + Eigen::RowVector3d(5, -3, 1);
  }
  return points;
}

/// n - 2 triangles of positive area whose sides cancel but for those of the polygon, and whose
/// areas add up to that of the polygon: they fill it once.
void ExpectDivided(const Plane& polygon)
{
  const auto triangles = DividePolygon(InSpace(polygon));
  const std::size_t n = polygon.size();
  ASSERT_EQ(triangles.size(), n - 2);
  std::map<std::array<int, 2>, int> sides;
  double sum = 0.0;
  for (const auto& [a, b, c] : triangles)
  {
    const auto corner = [&](int i) { return polygon[static_cast<std::size_t>(i)]; };
    const double area = AreaOf(corner(a), corner(b), corner(c));
    EXPECT_GT(area, -1e-13); // rounding into space and back, of coordinates up to 10
    sum += area;
    for (const std::array<int, 2>& side :
      { std::array<int, 2>{ a, b }, std::array<int, 2>{ b, c }, std::array<int, 2>{ c, a } })
    {
      ++sides[side];
      --sides[{ side[1], side[0] }];
    }
  }
  double whole = 0.0;
  for (std::size_t i = 0; i < n; ++i)
  {
    const auto from = static_cast<int>(i);
    const auto to = static_cast<int>((i + 1) % n);
    whole += AreaOf({ 0.0, 0.0 }, polygon[i], polygon[(i + 1) % n]);
    EXPECT_EQ((sides[{ from, to }]), 1);
    sides[{ from, to }] = 0;
    sides[{ to, from }] = 0;
  }
  for (const auto& [side, uses] : sides)
  {
    EXPECT_EQ(uses, 0) << side[0] << " to " << side[1];
  }
  EXPECT_NEAR(sum, whole, 1e-12 * (1.0 + whole));
}

TEST(PolygonTriangles, FillPolygonsOnce_PropertyOracle)
{
  ExpectDivided({ { 0, 0 }, { 4, 0 }, { 4, 1 }, { 1, 1 }, { 1, 4 }, { 0, 4 } });
  // a straight corner; three of them on one side
  ExpectDivided({ { 0, 0 }, { 1, 0 }, { 2, 0 }, { 2, 2 }, { 0, 2 } });
  ExpectDivided({ { 0, 0 }, { 1, 0 }, { 2, 0 }, { 3, 0 }, { 4, 0 }, { 1, 5 } });
  // reflex corners a thousandth from the side that goes on, as unions and differences leave them
  ExpectDivided({ { 0.93, 0.95 }, { -10, -9.98 }, { 10, -10.02 }, { 10.01, -6.004 },
    { -5.02, -6.0041 }, { 2.01, 0.02 } });
  ExpectDivided({ { -6.004, 10.01 }, { -10.02, 10 }, { -10.01, 6 }, { -6.004, 6.005 },
    { -6.0039, 6.024 }, { -5.999, 6.0241 } });
  for (unsigned seed = 1; seed <= 200; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> part(0.0, 1.0);
    const int n = 3 + static_cast<int>(random() % 60);
    Plane star; // around 0, with spikes down to a thousandth
    for (int i = 0; i < n; ++i)
    {
      const double angle = 2.0 * std::acos(-1.0) * (i + 0.9 * part(random)) / n;
      const double radius = random() % 4 == 0 ? 1e-3 * (1.0 + part(random)) : 1.0 + part(random);
      star.push_back({ radius * std::cos(angle), radius * std::sin(angle) });
    }
    ExpectDivided(star);
  }
}

// A square with a square hole whose rim is reached and left along one side.
TEST(PolygonTriangles, MayTouchThemselves_PropertyOracle)
{
  const Plane polygon{ { 0, 0 }, { 4, 0 }, { 4, 4 }, { 0, 4 }, { 0, 0 }, { 1, 1 }, { 1, 3 },
    { 3, 3 }, { 3, 1 }, { 1, 1 } };
  const auto triangles = DividePolygon(InSpace(polygon));
  ASSERT_EQ(triangles.size(), 8u);
  double sum = 0.0;
  for (const auto& [a, b, c] : triangles)
  {
    const double area = AreaOf(polygon[static_cast<std::size_t>(a)],
      polygon[static_cast<std::size_t>(b)], polygon[static_cast<std::size_t>(c)]);
    EXPECT_GT(area, 0.0);
    sum += area;
  }
  EXPECT_NEAR(sum, 12.0, 1e-12);
}

TEST(PolygonTriangles, CannotDivideWhatCrossesItselfOrHasNoArea)
{
  EXPECT_TRUE(DividePolygon(InSpace({ { 0, 0 }, { 1, 0 } })).empty());
  EXPECT_TRUE(DividePolygon(InSpace({ { 0, 0 }, { 1, 0 }, { 2, 0 }, { 3, 0 } })).empty());
  EXPECT_TRUE(DividePolygon(InSpace({ { 1, 1 }, { 1, 1 }, { 1, 1 }, { 1, 1 } })).empty());
  EXPECT_TRUE(DividePolygon(InSpace({ { 0, 0 }, { 2, 2 }, { 2, 0 }, { 0, 1 } })).empty());
  Plane pentagram;
  for (int i = 0; i < 5; ++i)
  {
    const double angle = 4.0 * std::acos(-1.0) * i / 5;
    pentagram.push_back({ std::cos(angle), std::sin(angle) });
  }
  EXPECT_TRUE(DividePolygon(InSpace(pentagram)).empty());
  Plane infinite{ { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
  infinite[2][0] = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(DividePolygon(InSpace(infinite)).empty());
}
}
}
