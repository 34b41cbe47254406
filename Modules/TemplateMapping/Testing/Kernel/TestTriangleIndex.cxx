// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceCases.h"
#include <knotwork/SplineCore/TriangleIndex.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace knotwork;

namespace
{
using Row = Eigen::RowVector3d;

TriangleFoot Closest(const Row& a, const Row& b, const Row& c, const Row& p)
{
  return ClosestOnTriangle<3>(a.data(), b.data(), c.data(), p.data());
}
}

TEST(TriangleIndex, ClosestPointsOfOneTriangle_ExactOracle)
{
  const Row a(0, 0, 0);
  const Row b(4, 0, 0);
  const Row c(0, 4, 0);
  const auto expect = [&](const Row& p, double second, double third, double squared)
  {
    SCOPED_TRACE(testing::Message() << p);
    const TriangleFoot foot = Closest(a, b, c, p);
    EXPECT_DOUBLE_EQ(foot.Second, second);
    EXPECT_DOUBLE_EQ(foot.Third, third);
    EXPECT_DOUBLE_EQ(foot.SquaredDistance, squared);
  };
  expect({ 1, 2, 3 }, 0.25, 0.5, 9); // inside
  expect({ 1, -2, 0 }, 0.25, 0, 4);  // edges
  expect({ -1, 1, 2 }, 0, 0.25, 5);
  expect({ 4, 4, 0 }, 0.5, 0.5, 8);
  expect({ -3, -4, 0 }, 0, 0, 25); // corners
  expect({ 6, 0, 0 }, 1, 0, 4);
  expect({ -1, 5, 1 }, 0, 1, 3);

  // Degenerate: a segment with the third corner inside, and a point.
  const TriangleFoot segment = Closest({ 0, 0, 0 }, { 1, 0, 0 }, { 4, 0, 0 }, { 3, 2, 0 });
  EXPECT_DOUBLE_EQ(segment.SquaredDistance, 4.0);
  EXPECT_DOUBLE_EQ(segment.Second + 4.0 * segment.Third, 3.0);
  EXPECT_DOUBLE_EQ(Closest(b, b, b, { 4, 3, 4 }).SquaredDistance, 25.0);
}

TEST(TriangleIndex, NoCornerIsNearerThanTheFoot_PropertyOracle)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> real(-1.0, 1.0);
  const auto any = [&] { return Row(real(random), real(random), real(random)); };
  for (int trial = 0; trial < 3000; ++trial)
  {
    SCOPED_TRACE(trial);
    const Row a = any();
    const Row b = any();
    // Well shaped, needles and flat obtuse ones down to nothing.
    const double height = std::pow(10.0, -(trial % 20));
    const Row c = a + 1.5 * real(random) * (b - a) + height * any();
    const Row p = trial % 3 == 0 ? Row(a + 0.5 * (c - a) + 1e-3 * any()) : any();
    const TriangleFoot foot = Closest(a, b, c, p);
    EXPECT_GE(foot.Second, 0.0);
    EXPECT_GE(foot.Third, 0.0);
    EXPECT_LE(foot.Second + foot.Third, 1.0 + 1e-15);
    const Row q = PointOfTriangle<3>(a.data(), b.data(), c.data(), foot.Second, foot.Third);
    EXPECT_NEAR((p - q).norm(), std::sqrt(foot.SquaredDistance), 1e-15);
    // q is the closest point of a convex set exactly when no corner lies on p's side of it; else
    // the squared distance is too large by at most twice the largest of these products: rounding.
    for (const Row& corner : { a, b, c })
    {
      EXPECT_LE((p - q).dot(corner - q), 1e-14);
    }
  }
}

TEST(TriangleIndex, NeedlesOfRoundingAreSegments_CrossOracle)
{
  // Corners on a line but for the last digits: the distance is that to the line's part.
  std::mt19937 random(6);
  std::uniform_real_distribution<double> real(-1.0, 1.0);
  const auto any = [&] { return Row(real(random), real(random), real(random)); };
  for (int trial = 0; trial < 3000; ++trial)
  {
    const Row start = any();
    const Row along = any();
    std::array<double, 3> places{ real(random), real(random), real(random) };
    const Row a = start + places[0] * along;
    const Row b = start + places[1] * along;
    const Row c = start + places[2] * along;
    const Row p = any();
    std::sort(places.begin(), places.end());
    const double t =
      std::clamp((p - start).dot(along) / along.squaredNorm(), places.front(), places.back());
    EXPECT_NEAR(std::sqrt(Closest(a, b, c, p).SquaredDistance), (p - start - t * along).norm(),
      1e-14); // rounding of the corners
  }
}

TEST(TriangleIndex, FlatBoxesHideNothing_PropertyOracle)
{
  // The corners' box has no height; feet must not be rounded out of it, or the tree, asked for
  // exactly the distance of the foot, prunes the triangle.
  SkeletonPatch<3> plate = cases::Plate(5);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> real(0.2, 0.8);
  for (const double height : { 0.1, 0.3, 0.7 })
  {
    plate.Points.col(2).setConstant(height);
    const TriangleIndex<3> index(plate.Points, plate.Simplices);
    for (int q = 0; q < 1000; ++q)
    {
      const Row p(real(random), real(random), real(random));
      const TriangleFoot found = index.Nearest(p.data());
      EXPECT_EQ(found.SquaredDistance, (p.z() - height) * (p.z() - height));
      EXPECT_EQ(index.Nearest(p.data(), found.SquaredDistance).Triangle, found.Triangle);
    }
  }
}

TEST(TriangleIndex, AgreesWithTryingAllTriangles_CrossOracle)
{
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> real(0.0, 1.0);
    SkeletonPatch<3> mesh = cases::Sphere(static_cast<int>(seed) % 4);
    TriangleIndex<3> index(mesh.Points, mesh.Simplices);
    if (seed > 3) // moved: a crumpled sphere
    {
      mesh.Points +=
        PointMatrix::NullaryExpr(mesh.Points.rows(), 3, [&] { return 0.3 * (real(random) - 0.5); });
      index.Move(mesh.Points);
    }
    for (int q = 0; q < 200; ++q)
    {
      const Row p(real(random), real(random), real(random));
      TriangleFoot expected;
      for (std::size_t t = 0; t < mesh.Simplices.size(); ++t)
      {
        const TriangleFoot foot = index.Foot(static_cast<int>(t), p.data());
        expected = foot.SquaredDistance < expected.SquaredDistance ? foot : expected;
      }
      const TriangleFoot found = index.Nearest(p.data());
      EXPECT_EQ(found.Triangle, expected.Triangle);
      EXPECT_EQ(found.SquaredDistance, expected.SquaredDistance);
      EXPECT_EQ(index.Nearest(p.data(), expected.SquaredDistance).Triangle, expected.Triangle);
      EXPECT_EQ(index.Nearest(p.data(), 0.999 * expected.SquaredDistance).Triangle,
        expected.SquaredDistance > 0.0 ? -1 : expected.Triangle);
    }
  }
}

TEST(TriangleIndex, SliversAgreeWithTryingAllTriangles_CrossOracle)
{
  // a twisted ribbon of slivers from one end to the other, aslant to all axes, then moved
  constexpr int n = 300;
  PointMatrix points(2 * n, 3);
  std::vector<MeshTriangle> triangles;
  for (int i = 0; i < n; ++i)
  {
    const double angle = 3.0 * i / n;
    points.row(i) << std::cos(angle), std::sin(angle), 0.1 * angle;
    points.row(n + i) << -2.0 * std::cos(angle), -std::sin(angle), 1.0 + 0.3 * angle;
    if (i > 0)
    {
      triangles.push_back({ i - 1, i, n + i });
      triangles.push_back({ i - 1, n + i, n + i - 1 });
    }
  }
  TriangleIndex<3> index(points, triangles);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> real(-1.0, 1.0);
  for (int q = 0; q < 600; ++q)
  {
    SCOPED_TRACE(q);
    if (q == 300)
    {
      points.col(0) += 0.7 * points.col(2);
      points.col(1) *= -3.0;
      index.Move(points);
    }
    const int t = static_cast<int>(random() % triangles.size());
    const double share = 0.5 + 0.5 * real(random);
    const Row on = index.PointAt(t, share, 0.5 * (1.0 - share));
    const double away = q % 3 == 0 ? 0.0 : std::pow(10.0, -(q % 7));
    const Row p = on + away * Row(real(random), real(random), real(random));
    TriangleFoot expected;
    for (std::size_t other = 0; other < triangles.size(); ++other)
    {
      const TriangleFoot foot = index.Foot(static_cast<int>(other), p.data());
      expected = foot.SquaredDistance < expected.SquaredDistance ? foot : expected;
    }
    const TriangleFoot found = index.Nearest(p.data());
    EXPECT_EQ(found.Triangle, expected.Triangle);
    EXPECT_EQ(found.SquaredDistance, expected.SquaredDistance);
    EXPECT_EQ(index.Nearest(p.data(), expected.SquaredDistance).Triangle, expected.Triangle);
  }
}

TEST(TriangleIndex, NeighboursShareAnEdge_ExactOracle)
{
  const cases::Triangles fan{ { 0, 1, 2 }, { 2, 1, 3 }, { 4, 5, 6 }, { 0, 2, 7 }, { 7, 2, 0 } };
  const auto neighbours = TriangleNeighbours(fan);
  const std::vector<MeshTriangle> expected{ { -1, 1, -1 }, // the edge (2, 0) has three triangles
    { 0, -1, -1 }, { -1, -1, -1 }, { -1, 4, 4 }, { 3, -1, 3 } };
  EXPECT_EQ(neighbours[0], expected[0]);
  EXPECT_EQ(neighbours[1], expected[1]);
  EXPECT_EQ(neighbours[2], expected[2]);
  EXPECT_EQ(neighbours[3][1], 4);
  const SkeletonPatch<3> sphere = cases::Sphere(2);
  for (const MeshTriangle& t : TriangleNeighbours(sphere.Simplices))
  {
    EXPECT_TRUE(t[0] >= 0 && t[1] >= 0 && t[2] >= 0);
  }

  PointMatrix points(5, 2);
  points << 0, 0, 1, 0, 0, 0, 1, -0.0, 1, 0;
  EXPECT_EQ(FirstOfEqualPoints(points), (std::vector<int>{ 0, 1, 0, 1, 1 }));
  EXPECT_EQ(
    ReplaceCorners({ { 2, 1, 0 } }, { 5, 6, 7 }), (std::vector<MeshTriangle>{ { 7, 6, 5 } }));
}

TEST(TriangleIndex, GroupsFindWhatSingleQueriesFind_CrossOracle)
{
  // A plate with bumps, slivers across it that several boxes hold, and triangles twice: of equally
  // near ones the first is found either way.
  SkeletonPatch<3> plate = cases::Plate(12);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> real(0.0, 1.0);
  for (Eigen::Index i = 0; i < plate.Points.rows(); ++i)
  {
    plate.Points(i, 2) = 0.05 * real(random);
  }
  std::vector<MeshTriangle> triangles = plate.Simplices;
  const auto last = static_cast<int>(plate.Points.rows()) - 1;
  triangles.push_back({ 0, 1, last });
  triangles.push_back({ last, last - 1, 0 });
  triangles.insert(triangles.end(), plate.Simplices.begin(), plate.Simplices.end());
  const TriangleIndex<3> index(plate.Points, triangles);
  const auto expectSame = [&](const PointMatrix& queries)
  {
    std::vector<TriangleFoot> feet;
    index.Nearest(queries, feet);
    ASSERT_EQ(static_cast<Eigen::Index>(feet.size()), queries.rows());
    for (Eigen::Index i = 0; i < queries.rows(); ++i)
    {
      const TriangleFoot one = index.Nearest(queries.row(i).data());
      const TriangleFoot& foot = feet[static_cast<std::size_t>(i)];
      ASSERT_EQ(foot.Triangle, one.Triangle) << i;
      ASSERT_EQ(foot.SquaredDistance, one.SquaredDistance) << i;
      ASSERT_EQ(foot.Second, one.Second) << i;
      ASSERT_EQ(foot.Third, one.Third) << i;
      for (std::size_t t = 0; i % 7 == 0 && t < triangles.size(); ++t)
      {
        ASSERT_GE(index.Foot(static_cast<int>(t), queries.row(i).data()).SquaredDistance,
          foot.SquaredDistance);
      }
    }
  };
  expectSame(plate.Points); // corners are equally near to all triangles around
  PointMatrix rows(3000, 3);
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
  {
    const double t = static_cast<double>(i) / static_cast<double>(rows.rows());
    rows.row(i) << t, std::fmod(40.0 * t, 1.0), 0.1 * real(random) - 0.03;
  }
  expectSame(rows);
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
  {
    rows.row(i) << 3.0 * real(random) - 1.0, 3.0 * real(random) - 1.0, real(random);
  }
  expectSame(rows); // in any order, near and far
  expectSame(PointMatrix(0, 3));
}
