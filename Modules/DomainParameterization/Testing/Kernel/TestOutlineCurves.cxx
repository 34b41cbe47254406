// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/DomainParameterization/DomainParameterization.h>
#include <knotwork/DomainParameterization/OutlineCurves.h>
#include <knotwork/SplineCore/BezierForm.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

using namespace knotwork;

namespace
{
using Point = Eigen::RowVector2d;

PointMatrix Rows(const std::vector<Point>& points)
{
  PointMatrix rows(static_cast<Eigen::Index>(points.size()), 2);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    rows.row(static_cast<Eigen::Index>(i)) = points[i];
  }
  return rows;
}

/// Points along the corners' polygon, at most a step apart, the first again at the end.
std::vector<Point> Polygon(const std::vector<Point>& corners, double step)
{
  std::vector<Point> points;
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    const Point& a = corners[i];
    const Point& b = corners[(i + 1) % corners.size()];
    const int count = std::max(1, static_cast<int>(std::ceil((b - a).norm() / step)));
    for (int k = 0; k < count; ++k)
    {
      points.push_back(a + (b - a) * k / count);
    }
  }
  points.push_back(corners.front());
  return points;
}

std::vector<Point> Shaken(std::vector<Point> points, double noise, unsigned seed)
{
  std::mt19937 random(seed);
  std::normal_distribution<double> shake(0.0, noise);
  for (Point& point : points)
  {
    point += Point(shake(random), shake(random));
  }
  return points;
}

PointMatrix Sampled(const Spline<1>& curve, int count)
{
  PointMatrix at(count, 1);
  at.col(0).setLinSpaced(0.0, 1.0);
  EvaluationBatch found;
  EXPECT_TRUE(EvaluateParameters<1>(MakeBezierForm<1>(curve, 1), at, {}, found));
  return found.Values;
}

/// Sides that follow each other meet in the same numbers.
void ExpectClosed(const std::vector<Spline<1>>& sides)
{
  for (std::size_t s = 0; s < sides.size(); ++s)
  {
    const auto& next = sides[(s + 1) % sides.size()];
    EXPECT_EQ(
      sides[s].ControlPoints.row(sides[s].ControlPoints.rows() - 1), next.ControlPoints.row(0));
  }
}
}

TEST(OutlineCurves, PolygonBecomesItsSides_ExactOracle)
{
  for (const double step : { 10.0, 0.01 }) // corners alone, and points between them
  {
    const auto outline =
      FitOutline({ Rows(Polygon({ { 0, 0 }, { 3, 0 }, { 3, 2 }, { 0, 2 } }, step)) });
    ASSERT_TRUE(outline) << outline.Status.Detail;
    ASSERT_EQ(outline.Value.Sides.size(), 4U);
    EXPECT_EQ(outline.Value.NumCorners, 4);
    EXPECT_EQ(outline.Value.NumLines, 4);
    EXPECT_LT(outline.Value.MaxDistance, 1e-14);
    ExpectClosed(outline.Value.Sides);
    const PointMatrix& first = outline.Value.Sides[0].ControlPoints;
    ASSERT_EQ(first.rows(), 2);
    EXPECT_EQ(Point(first.row(0)), Point(0, 0));
    EXPECT_EQ(Point(first.row(1)), Point(3, 0));
  }
}

TEST(OutlineCurves, CornersOfAShakenOutlineAreWhereTheyWere_PropertyOracle)
{
  const std::vector<Point> corners{ { 0, 0 }, { 3, 0.5 }, { 2.5, 2 }, { -0.5, 1.5 } };
  for (unsigned seed = 1; seed <= 20; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const double noise = 0.003;
    OutlineParams params;
    params.Tolerance = 0.01;
    const auto outline = FitOutline({ Rows(Shaken(Polygon(corners, 0.02), noise, seed)) }, params);
    ASSERT_TRUE(outline) << outline.Status.Detail;
    EXPECT_EQ(outline.Value.NumCorners, 4);
    for (const Spline<1>& side : outline.Value.Sides)
    {
      double nearest = 10.0;
      for (const Point& corner : corners)
      {
        nearest = std::min(nearest, (Point(side.ControlPoints.row(0)) - corner).norm());
      }
      EXPECT_LT(nearest, 0.05); // a few points beside it, and the noise
    }
  }
}

TEST(OutlineCurves, FlatCornersAreTakenBeforeSidesAreHalved_ExactOracle)
{
  OutlineParams params;
  params.CornerAngle = 95.0; // the corners turn by 90, 99.5, 80.5 and 90 degrees
  const auto flat =
    FitOutline({ Rows(Polygon({ { 0, 0 }, { 4, 0 }, { 3.5, 3 }, { 0, 3 } }, 0.01)) }, params);
  ASSERT_TRUE(flat) << flat.Status.Detail;
  EXPECT_EQ(flat.Value.NumLines, 4);
  EXPECT_TRUE(flat.Value.Messages.empty());
}

TEST(OutlineCurves, ArcsAreExactCircles_ExactOracle)
{
  // half a disc's rim, three straight sides
  std::vector<Point> points{ { -1, 0 }, { -1, -1 }, { 1, -1 } };
  for (int k = 0; k <= 200; ++k)
  {
    const double angle = M_PI * k / 200.0;
    points.emplace_back(std::cos(angle), std::sin(angle));
  }
  points.back() = points.front();
  OutlineParams params;
  params.CornerAngle = 60.0; // the rim is smooth with its neighbours: a side must be chosen
  std::vector<PointMatrix> lines{ Rows({ { -1, 0 }, { -1, -1 } }), Rows({ { -1, -1 }, { 1, -1 } }),
    Rows({ { 1, -1 }, { 1, 0 } }), Rows(std::vector<Point>(points.begin() + 3, points.end())) };
  const auto outline = FitOutline(lines, params);
  ASSERT_TRUE(outline) << outline.Status.Detail;
  EXPECT_EQ(outline.Value.NumArcs, 1);
  EXPECT_EQ(outline.Value.NumLines, 3);
  const Spline<1>& arc = outline.Value.Sides[3];
  ASSERT_TRUE(arc.IsRational());
  const PointMatrix sampled = Sampled(arc, 101);
  for (Eigen::Index i = 0; i < sampled.rows(); ++i)
  {
    EXPECT_NEAR(sampled.row(i).norm(), 1.0, 1e-13);
  }
}

TEST(OutlineCurves, SmoothSidesAreWithinTheTolerance_IndependentOracle)
{
  std::vector<Point> points;
  const auto wave = [](double x) { return 0.15 * std::sin(7.0 * x) + 0.1 * x * x; };
  for (int k = 0; k < 400; ++k)
  {
    const double x = 2.0 * k / 400.0;
    points.emplace_back(x, wave(x));
  }
  for (const Point& corner : std::vector<Point>{ { 2, wave(2.0) }, { 2, 2 }, { 0, 2 }, { 0, 0 } })
  {
    points.push_back(corner);
  }
  for (const double tolerance : { 1e-2, 1e-3, 1e-5 })
  {
    OutlineParams params;
    params.Tolerance = tolerance;
    const auto outline = FitOutline({ Rows(points) }, params);
    ASSERT_TRUE(outline) << outline.Status.Detail;
    const double size = std::hypot(2.0, 2.0 - (-0.15));
    EXPECT_LE(outline.Value.MaxDistance, tolerance * size * 1.1);
    EXPECT_EQ(outline.Value.NumCurves, 1);
    double largest = 0.0;
    const PointMatrix sampled = Sampled(outline.Value.Sides[0], 2001);
    for (Eigen::Index i = 0; i < sampled.rows(); ++i)
    {
      largest = std::max(largest, std::abs(sampled(i, 1) - wave(sampled(i, 0))));
    }
    EXPECT_LT(largest, 3.0 * tolerance * size + 1e-4); // between the points, along y
  }
}

TEST(OutlineCurves, MoreAndFewerThanFourCorners_PropertyOracle)
{
  // an L: five convex corners, one concave; the four that turn most are ends, two lie within sides
  const auto ell = FitOutline(
    { Rows(Polygon({ { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } }, 0.02)) });
  ASSERT_TRUE(ell) << ell.Status.Detail;
  EXPECT_EQ(ell.Value.NumCorners, 6);
  EXPECT_EQ(ell.Value.Sides.size(), 4U);
  EXPECT_EQ(ell.Value.NumLines, 6);
  EXPECT_TRUE(ell.Value.Messages.empty());
  ExpectClosed(ell.Value.Sides);
  // with a layout every corner is an end
  OutlineParams all;
  all.NumSides = 0;
  const auto every = FitOutline(
    { Rows(Polygon({ { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } }, 0.02)) }, all);
  ASSERT_TRUE(every);
  EXPECT_EQ(every.Value.Sides.size(), 6U);
  // a triangle of three points
  const auto triangle = FitOutline({ Rows({ { 0, 0 }, { 2, 0 }, { 1, 2 }, { 0, 0 } }) });
  ASSERT_TRUE(triangle) << triangle.Status.Detail;
  EXPECT_EQ(triangle.Value.NumCorners, 3);
  EXPECT_EQ(triangle.Value.NumLines, 4);
  ExpectClosed(triangle.Value.Sides);
  std::vector<Point> circle;
  for (int k = 0; k <= 400; ++k)
  {
    circle.emplace_back(std::cos(2 * M_PI * k / 400.0), std::sin(2 * M_PI * k / 400.0));
  }
  const auto round = FitOutline({ Rows(circle) });
  ASSERT_TRUE(round) << round.Status.Detail;
  EXPECT_EQ(round.Value.NumCorners, 0);
  EXPECT_EQ(round.Value.NumArcs, 4);
  ASSERT_EQ(round.Value.Messages.size(), 1U);
  EXPECT_NE(round.Value.Messages[0].find("0 corners"), std::string::npos);
  ExpectClosed(round.Value.Sides);
}

TEST(OutlineCurves, DrawnOutlinesAreParameterized_PropertyOracle)
{
  std::vector<Point> points = Polygon({ { 0, 0 }, { 3, 0.2 }, { 2.8, 2.2 }, { -0.2, 1.8 } }, 0.01);
  for (Point& point : points)
  {
    point.y() += 0.2 * std::sin(2.0 * point.x());
  }
  OutlineParams drawn;
  drawn.Tolerance = 5e-3;
  const auto outline = FitOutline({ Rows(Shaken(points, 1e-3, 3)) }, drawn);
  ASSERT_TRUE(outline) << outline.Status.Detail;
  const auto map = ParameterizeDomain<2>({ outline.Value.Sides });
  ASSERT_TRUE(map) << map.Status.Detail;
  EXPECT_EQ(std::string(ToString(map.Value.Certificate.Verdict)), "valid");
}

TEST(OutlineCurves, EveryFailureNamesItsPlace)
{
  const auto fails = [](const std::vector<PointMatrix>& lines, ErrorCode code,
                       const std::string& words, const OutlineParams& params = {})
  {
    const auto outline = FitOutline(lines, params);
    EXPECT_EQ(outline.Status.Code, code) << outline.Status.Detail;
    EXPECT_NE(outline.Status.Detail.find(words), std::string::npos) << outline.Status.Detail;
  };
  const PointMatrix square = Rows(Polygon({ { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } }, 0.1));
  fails({}, ErrorCode::EmptyInput, "no line");
  fails({ Rows({ { 0, 0 }, { 1, std::nan("") } }) }, ErrorCode::NonFiniteInput, "line 0: point 1");
  fails({ PointMatrix::Zero(4, 3) }, ErrorCode::SizeMismatch, "line 0");
  fails({ square, Rows({ { 0, 0 }, { 0, 0 } }) }, ErrorCode::EmptyInput, "line 1");
  fails({ Rows({ { 0, 0 }, { 1, 0 }, { 1, 1 } }) }, ErrorCode::InvalidTopology, "close it");
  fails({ square, square }, ErrorCode::InvalidTopology, "2 lines");
  fails({ Rows({ { 0, 0 }, { 1, 0 } }), Rows({ { 1, 0 }, { 1, 1 } }), Rows({ { 1, 1 }, { 0, 1 } }),
          Rows({ { 0, 1 }, { 0, 0.5 } }) },
    ErrorCode::InvalidTopology, "line 0 begins");
  OutlineParams params;
  params.CornerAngle = 200.0;
  fails({ square }, ErrorCode::InvalidParameter, "corner angle", params);
  OutlineParams fine;
  fine.Tolerance = 1e-7;
  std::vector<Point> noise =
    Shaken(Polygon({ { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } }, 0.0005), 1e-3, 5);
  noise.back() = noise.front();
  fails({ Rows(noise) }, ErrorCode::NotConverged, "raise the outline's tolerance", fine);
}
