// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceRemesh.h"

#include "EdgeSizes.h"
#include "FarthestDistance.h"
#include "SimpleSolids.h"
#include "SolidOracle.h"
#include "SoupTopology.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace knotwork;

namespace
{
/// A cylinder of radius 1 from z = 0 to 2 about the axis, with plane ends, of long triangles.
TriangleMesh Cylinder(int sides)
{
  TriangleMesh mesh;
  mesh.Points.resize(2 * sides + 2, 3);
  for (int i = 0; i < sides; ++i)
  {
    const double angle = 2.0 * M_PI * i / sides;
    mesh.Points.row(i) << std::cos(angle), std::sin(angle), 0.0;
    mesh.Points.row(sides + i) << std::cos(angle), std::sin(angle), 2.0;
  }
  mesh.Points.row(2 * sides) << 0.0, 0.0, 0.0;
  mesh.Points.row(2 * sides + 1) << 0.0, 0.0, 2.0;
  for (int i = 0; i < sides; ++i)
  {
    const int j = (i + 1) % sides;
    mesh.Triangles.push_back({ i, j, sides + j });
    mesh.Triangles.push_back({ i, sides + j, sides + i });
    mesh.Triangles.push_back({ j, i, 2 * sides });
    mesh.Triangles.push_back({ sides + i, sides + j, 2 * sides + 1 });
  }
  return mesh;
}

/// A plane square of [0, n]^2 without the unit square in its middle, n odd.
TriangleMesh SquareWithHole(int n)
{
  TriangleMesh mesh;
  mesh.Points.resize((n + 1) * (n + 1), 3);
  for (int i = 0; i < mesh.Points.rows(); ++i)
  {
    mesh.Points.row(i) << i % (n + 1), i / (n + 1), 0.0;
  }
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      const int a = j * (n + 1) + i;
      if (i != n / 2 || j != n / 2)
      {
        mesh.Triangles.push_back({ a, a + 1, a + n + 2 });
        mesh.Triangles.push_back({ a, a + n + 2, a + n + 1 });
      }
    }
  }
  return mesh;
}

SurfaceRemesh Remeshed(const TriangleMesh& mesh, const SurfaceRemeshParams& params)
{
  const auto result = RemeshSurface(mesh, params);
  EXPECT_TRUE(result) << result.Status.Message();
  return result.Value;
}

SurfaceRemesh Remeshed(const TriangleMesh& mesh, double size)
{
  SurfaceRemeshParams params;
  params.Size = size;
  return Remeshed(mesh, params);
}

/// What holds of every result.
void ExpectKept(const SurfaceRemesh& result)
{
  EXPECT_EQ(result.After.Euler, result.Before.Euler);
  EXPECT_EQ(result.After.Parts, result.Before.Parts);
  EXPECT_EQ(result.Intersections, 0);
  EXPECT_TRUE(FindDefects(result.Mesh.Triangles, result.Mesh.Points.rows()).IsManifold());
  EXPECT_EQ(EulerNumber(result.Mesh.Triangles), result.After.Euler);
}

double LengthOf(const TriangleMesh& mesh, const std::array<int, 2>& line)
{
  return (mesh.Points.row(line[0]) - mesh.Points.row(line[1])).norm();
}
}

TEST(FarthestFrom, SliversAboveAPlane_ExactOracle)
{
  // a fan of slivers at a slope over one large triangle: farthest at its highest corner
  constexpr int n = 200;
  PointMatrix fan(n + 2, 3);
  std::vector<MeshTriangle> slivers;
  fan.row(0) << 0.0, 0.0, 0.0;
  for (int i = 0; i <= n; ++i)
  {
    const double angle = 0.5 * M_PI * i / n;
    fan.row(i + 1) << std::cos(angle), std::sin(angle), 0.25 * i / n;
    if (i > 0)
    {
      slivers.push_back({ 0, i, i + 1 });
    }
  }
  PointMatrix plane(3, 3);
  plane << -9.0, -9.0, 0.0, 9.0, -9.0, 0.0, 0.0, 9.0, 0.0;
  const TriangleIndex<3> below(plane, { { 0, 1, 2 } });
  EXPECT_DOUBLE_EQ(FarthestFrom(below, fan, slivers, 1e-6).Value, 0.25);
  EXPECT_GT(FarthestFrom(below, fan, slivers, 1e-6, 0.1).Value, 0.1);
  // from the plane: the far corners of the triangle
  const LargestDistance back =
    FarthestFrom(TriangleIndex<3>(fan, slivers), plane, below.Triangles(), 1e-3);
  double farthest = 0.0;
  for (const Eigen::Index i : { 0, 1, 2 })
  {
    const TriangleFoot foot = TriangleIndex<3>(fan, slivers).Nearest(plane.row(i).data());
    farthest = std::max(farthest, std::sqrt(foot.SquaredDistance));
  }
  EXPECT_GE(back.Value, farthest);
  EXPECT_LE(back.Value, farthest + 1e-3);
}

TEST(SurfaceRemesh, CubeStaysACube_ExactOracle)
{
  for (const double size : { 0.4, 0.1, 0.05 })
  {
    SCOPED_TRACE(size);
    const SurfaceRemesh result = Remeshed(Box(), size);
    ExpectKept(result);
    EXPECT_EQ(WhyNoSolid(result.Mesh), "");
    EXPECT_NEAR(result.After.Volume, 1.0, 1e-12);
    EXPECT_NEAR(result.After.Area, 6.0, 1e-12);
    EXPECT_EQ(result.Corners.size(), 8U);
    double sharp = 0.0; // length of lines, all of them on edges of the cube
    for (const auto& line : result.Lines)
    {
      sharp += LengthOf(result.Mesh, line);
      int onSides = 0;
      for (Eigen::Index d = 0; d < 3; ++d)
      {
        const double a = result.Mesh.Points(line[0], d);
        onSides += a == result.Mesh.Points(line[1], d) && (a == 0.0 || a == 1.0) ? 1 : 0;
      }
      EXPECT_EQ(onSides, 2);
    }
    EXPECT_NEAR(sharp, 12.0, 1e-12);
    EXPECT_GT(result.FittingEdges, 0.9);
    EXPECT_GT(result.After.LeastAngle, 25.0);
    EXPECT_NEAR(result.After.MeanEdge, size, 0.15 * size);
  }
}

TEST(SurfaceRemesh, BallConvergesWithTheSquareOfTheLength_ExactOracle)
{
  // on the mesh of a ball with 100 rings, which is nearer to it than what is made
  double last = 0.0;
  for (const double size : { 0.4, 0.2, 0.1 })
  {
    SCOPED_TRACE(size);
    SurfaceRemeshParams params;
    params.Size = size;
    params.Limit = 0.02;
    const SurfaceRemesh result = Remeshed(Ball(100), params);
    ExpectKept(result);
    EXPECT_GT(result.FittingEdges, 0.9);
    EXPECT_GT(result.After.LeastAngle, 25.0);
    const double error = 1.0 - result.After.Volume / (4.0 * M_PI / 3.0);
    EXPECT_GT(error, 0.0);
    if (last > 0.0)
    {
      EXPECT_NEAR(last / error, 4.0, 1.2);
    }
    EXPECT_NEAR(result.After.Area, 4.0 * M_PI, 0.5 * size * size * 4.0 * M_PI);
    last = error;
  }
}

TEST(SurfaceRemesh, PolesOfABallBecomeOrdinary_PropertyOracle)
{
  const SurfaceRemesh result = Remeshed(Ball(40), 0.08);
  ExpectKept(result);
  EXPECT_LT(result.Before.LeastAngle, 5.0);
  EXPECT_GT(result.After.LeastAngle, 25.0);
}

TEST(SurfaceRemesh, DistancesAreNotBelowSamples_CrossOracle)
{
  const TriangleMesh ball = Ball(20);
  SurfaceRemeshParams params;
  params.Size = 0.3;
  params.Limit = 0.02;
  const SurfaceRemesh result = Remeshed(ball, params);
  const double tolerance = 2e-3 * result.Diagonal;
  const double from = SampledDistance(result.Mesh, ball);
  const double to = SampledDistance(ball, result.Mesh);
  EXPECT_GE(result.DistanceFromInput, from * (1.0 - 1e-9));
  EXPECT_LE(result.DistanceFromInput, from + 2.0 * tolerance);
  EXPECT_GE(result.DistanceToInput, to * (1.0 - 1e-9));
  EXPECT_LE(result.DistanceToInput, to + 2.0 * tolerance);
}

TEST(SurfaceRemesh, CirclesStaySharp_ExactOracle)
{
  const int sides = 100;
  const SurfaceRemesh result = Remeshed(Cylinder(sides), 0.1);
  ExpectKept(result);
  EXPECT_EQ(WhyNoSolid(result.Mesh), "");
  EXPECT_EQ(result.Corners.size(), 0U);
  double lengths = 0.0;
  for (const auto& line : result.Lines)
  {
    const double z = result.Mesh.Points(line[0], 2);
    EXPECT_TRUE(z == 0.0 || z == 2.0);
    EXPECT_EQ(z, result.Mesh.Points(line[1], 2));
    // chords of the circle's chords
    EXPECT_NEAR(result.Mesh.Points.row(line[0]).head<2>().norm(), 1.0, 5e-4);
    lengths += LengthOf(result.Mesh, line);
  }
  EXPECT_NEAR(lengths, 4.0 * M_PI, 4.0 * M_PI * 0.1 * 0.1 / 12.0);
  EXPECT_NEAR(result.After.Volume, result.Before.Volume, 0.01 * result.Before.Volume);
}

TEST(SurfaceRemesh, RimsStay_ExactOracle)
{
  const SurfaceRemesh result = Remeshed(SquareWithHole(5), 0.2);
  ExpectKept(result);
  EXPECT_EQ(result.After.Euler, 0);
  EXPECT_EQ(result.Corners.size(), 8U);
  EXPECT_NEAR(result.After.Area, 24.0, 1e-11);
  EXPECT_LT(result.DistanceToInput, 2e-3 * result.Diagonal);
  EXPECT_GT(result.After.LeastAngle, 25.0);
  const auto rims =
    TraceRims(result.Mesh.Triangles, FindDefects(result.Mesh.Triangles, result.Mesh.Points.rows()));
  EXPECT_EQ(rims.size(), 2U);
}

TEST(SurfaceRemesh, LengthsOfPointsAreKept_ExactOracle)
{
  // growing from 0.2 to 1.2 along x
  const TriangleMesh mesh = SquareWithHole(11);
  SurfaceRemeshParams params;
  params.Sizing = EdgeSizing::PerPoint;
  for (Eigen::Index i = 0; i < mesh.Points.rows(); ++i)
  {
    params.Sizes.push_back(0.2 + mesh.Points(i, 0) / 11.0);
  }
  const SurfaceRemesh result = Remeshed(mesh, params);
  ExpectKept(result);
  EXPECT_GT(result.FittingEdges, 0.85);
  for (Eigen::Index i = 0; i < result.Mesh.Points.rows(); ++i)
  {
    EXPECT_NEAR(
      result.Sizes[static_cast<std::size_t>(i)], 0.2 + result.Mesh.Points(i, 0) / 11.0, 0.05);
  }
  // mean edges at both sides
  for (const auto& ends : { std::pair(0.0, 1.0), std::pair(9.0, 11.0) })
  {
    const double low = ends.first, high = ends.second;
    double length = 0.0;
    int count = 0;
    ForEachEdge(SortedSides(result.Mesh.Triangles),
      [&](const SoupSide* begin, const SoupSide*)
      {
        const double x =
          0.5 * (result.Mesh.Points(begin->First, 0) + result.Mesh.Points(begin->Second, 0));
        if (x >= low && x <= high)
        {
          length += LengthOf(result.Mesh, { begin->First, begin->Second });
          ++count;
        }
      });
    const double wanted = 0.2 + 0.5 * (low + high) / 11.0;
    EXPECT_NEAR(length / count, wanted, 0.15 * wanted);
  }
}

TEST(SurfaceRemesh, LengthsGrowByHalfTheDistance_PropertyOracle)
{
  const auto surface = CheckSurface(SquareWithHole(11));
  ASSERT_TRUE(surface);
  std::vector<double> sizes(static_cast<std::size_t>(surface->NumPoints()), 100.0);
  sizes[0] = 0.01;
  LimitGrowth(surface.Value, sizes);
  for (int i = 0; i < surface->NumPoints(); ++i)
  {
    const double size = sizes[static_cast<std::size_t>(i)];
    const double distance = (surface->Point(i) - surface->Point(0)).norm();
    EXPECT_GE(size, 0.01 + 0.5 * distance - 1e-12);
    EXPECT_LE(size, 0.01 + 0.5 * std::sqrt(2.0) * distance + 1e-12); // along sides and diagonals
  }
}

TEST(SurfaceRemesh, CurvatureOfBallsAndCylinders_ExactOracle)
{
  for (const TriangleMesh& mesh : { Ball(40), Cylinder(100) })
  {
    const auto surface = CheckSurface(mesh);
    const auto features = FindMeshFeatures(surface.Value);
    const auto curvatures = LargestCurvatures(surface.Value, features.Value);
    // the middles of the cylinder's ends are flat
    const auto curved = static_cast<std::size_t>(mesh.Points.rows()) - 2;
    for (std::size_t i = 2; i < curved; ++i)
    {
      EXPECT_NEAR(curvatures[i], 1.0, 0.05) << i;
    }
  }
  const TriangleMesh cylinder = Cylinder(100);
  const auto surface = CheckSurface(cylinder);
  const auto features = FindMeshFeatures(surface.Value);
  EXPECT_NEAR(LargestCurvatures(surface.Value, features.Value).back(), 0.0, 1e-9);
}

TEST(SurfaceRemesh, CurvatureGivesTheTolerance_PropertyOracle)
{
  SurfaceRemeshParams params;
  params.Sizing = EdgeSizing::Curvature;
  for (const double tolerance : { 2e-3, 5e-4 })
  {
    params.Tolerance = tolerance;
    const SurfaceRemesh ball = Remeshed(Ball(60), params);
    ExpectKept(ball);
    // a chord's height grows with the square of its length, and edges are up to 4/3 longer
    const double bound = tolerance * ball.Diagonal;
    EXPECT_LT(SampledDistance(ball.Mesh, Ball(60)), 16.0 / 9.0 * bound);
    EXPECT_GT(SampledDistance(ball.Mesh, Ball(60)), 0.5 * bound);
    EXPECT_NEAR(ball.After.MeanEdge, ChordOf(1.0, bound), 0.15 * ChordOf(1.0, bound));
  }
  // flat where it can be: long edges within the ends of a cylinder
  params.Tolerance = 1e-3;
  const SurfaceRemesh cylinder = Remeshed(Cylinder(60), params);
  ExpectKept(cylinder);
  const auto [least, most] = std::minmax_element(cylinder.Sizes.begin(), cylinder.Sizes.end());
  EXPECT_GT(*most, 1.5 * *least);
}

TEST(SurfaceRemesh, PartsStayApart_ExactOracle)
{
  TriangleMesh both = Box();
  const TriangleMesh other = Box({ 1.01, 0.0, 0.0 }, { 2.0, 1.0, 1.0 });
  both.Points.conservativeResize(16, 3);
  both.Points.bottomRows(8) = other.Points;
  for (const auto& [a, b, c] : other.Triangles)
  {
    both.Triangles.push_back({ a + 8, b + 8, c + 8 });
  }
  const SurfaceRemesh result = Remeshed(both, 0.2);
  ExpectKept(result);
  EXPECT_EQ(result.After.Parts, 2);
  EXPECT_EQ(result.After.Euler, 4);
  EXPECT_NEAR(result.After.Volume, 3.0, 1e-12);
  EXPECT_EQ(*std::max_element(result.RegionIds.begin(), result.RegionIds.end()), 11);
  for (std::size_t t = 0; t < result.PartIds.size(); ++t)
  {
    EXPECT_EQ(result.PartIds[t], result.TriangleIds[t] < 12 ? 0 : 1);
  }
}

TEST(SurfaceRemesh, CommutesWithScaling_PropertyOracle)
{
  TriangleMesh mesh = Ball(16);
  const SurfaceRemesh one = Remeshed(mesh, 0.25);
  mesh.Points *= 1024.0;
  const SurfaceRemesh other = Remeshed(mesh, 256.0);
  ASSERT_EQ(one.Mesh.Triangles, other.Mesh.Triangles);
  EXPECT_EQ(1024.0 * one.Mesh.Points, other.Mesh.Points);
}

TEST(SurfaceRemesh, EveryFailureIsReachable)
{
  const auto expect = [](const TriangleMesh& mesh, const SurfaceRemeshParams& params,
                        ErrorCode code, const std::string& words)
  {
    const auto result = RemeshSurface(mesh, params);
    EXPECT_EQ(result.Status.Code, code) << result.Status.Message();
    EXPECT_NE(result.Status.Detail.find(words), std::string::npos) << result.Status.Message();
  };
  SurfaceRemeshParams params;
  expect({}, params, ErrorCode::EmptyInput, "no triangles");
  TriangleMesh bad = Box();
  bad.Points(3, 1) = std::numeric_limits<double>::quiet_NaN();
  expect(bad, params, ErrorCode::NonFiniteInput, "3");
  bad = Box();
  bad.Triangles.push_back(bad.Triangles[0]);
  expect(bad, params, ErrorCode::InvalidTopology, "repair the mesh first (job repair)");
  params.Size = 1e-5;
  expect(Box(), params, ErrorCode::TooLarge, "ask for longer edges");
  params.Size = -1.0;
  expect(Box(), params, ErrorCode::InvalidParameter, "Size is the length of edges");
  params = {};
  params.Limit = 0.0;
  expect(Box(), params, ErrorCode::InvalidParameter, "Limit is a share of the diagonal");
  params = {};
  params.Iterations = 0;
  expect(Box(), params, ErrorCode::InvalidParameter, "1 to 1000 iterations");
  params = {};
  params.Features.SharpAngle = 0.0;
  expect(Box(), params, ErrorCode::InvalidParameter, "");
  params = {};
  params.Sizing = EdgeSizing::PerPoint;
  params.Sizes = { 1.0 };
  expect(Box(), params, ErrorCode::SizeMismatch, "1 lengths of edges for 8 points");
  params.Sizes.assign(8, 1.0);
  params.Sizes[5] = 0.0;
  expect(Box(), params, ErrorCode::InvalidParameter, "length of edges at point 5 is 0");
  params = {};
  params.Limit = 1e-6; // the distance is known to 1e-4 of the diagonal at best
  params.Size = 0.5;
  expect(Ball(6), params, ErrorCode::NotConverged, "raise Limit");
  params = {};
  params.Progress = [](double done) { return done < 0.5; };
  expect(Ball(6), params, ErrorCode::Aborted, "");
}
