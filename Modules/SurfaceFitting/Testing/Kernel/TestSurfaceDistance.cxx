// SPDX-License-Identifier: BSD-3-Clause
#include "LRCases.h"
#include <knotwork/SplineCore/LROperations.h>
#include <knotwork/SplineCore/Refinement.h>
#include <knotwork/SplineCore/Shapes.h>
#include <knotwork/SurfaceFitting/SurfaceDistance.h>

#include <gtest/gtest.h>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
constexpr std::array<SpaceKind, 3> Kinds{ SpaceKind::Tensor, SpaceKind::Hierarchical,
  SpaceKind::LocallyRefined };

/// z = 2 + x y / 4 on [0, 2] x [0, 3], exactly, in spaces of every kind.
Spline<2> Saddle(SpaceKind kind, double turn = 0.0)
{
  Spline<2> surface;
  surface.Space =
    MakeTensorSpace<2>({ KnotVector::Uniform(2, 4, 0, 2), KnotVector::Uniform(3, 3, 0, 3) }).Value;
  const PointMatrix at = GrevillePoints(*surface.Space);
  surface.ControlPoints.resize(at.rows(), 3);
  for (Eigen::Index i = 0; i < at.rows(); ++i)
  {
    // turned about z by an angle, height with the surface; x y is bilinear: its blossom at Greville
    // points
    surface.ControlPoints.row(i) << std::cos(turn) * at(i, 0) - std::sin(turn) * at(i, 1),
      std::sin(turn) * at(i, 0) + std::cos(turn) * at(i, 1), 2 + 0.25 * at(i, 0) * at(i, 1);
  }
  if (kind == SpaceKind::LocallyRefined)
  {
    surface = InsertSegments(surface, { { 0, 0.7, 0, 3, 1 } }, 0).Value;
  }
  return kind == SpaceKind::Tensor ? surface : RefineMarkedElements(surface, { 0, 5 }).Value.Value;
}

PointMatrix PointsAbove(Random& random, int n, std::vector<double>& offsets)
{
  PointMatrix points(n, 3);
  for (int i = 0; i < n; ++i)
  {
    const double x = random.In(0, 2);
    const double y = random.In(0, 3);
    offsets.push_back(random.In(-1, 1));
    points.row(i) << x, y, 2 + 0.25 * x * y + offsets.back();
  }
  return points;
}
}

TEST(SurfaceDistance, FarFromTheOriginOutsideIsOutside_ExactOracle)
{
  // turned, so no height field; coordinates as of maps in metres
  Spline<2> surface = Saddle(SpaceKind::Tensor, 0.3);
  const Eigen::RowVector3d shift(5e6, 4e5, 0);
  const auto place = [&](double x, double y) -> Eigen::RowVector3d
  {
    return Eigen::RowVector3d(
             std::cos(0.3) * x - std::sin(0.3) * y, std::sin(0.3) * x + std::cos(0.3) * y, 1.0) +
      shift;
  };
  surface.ControlPoints.rowwise() += shift;
  PointMatrix points(3, 3);
  points.row(0) = place(1.0, 1e-4);
  points.row(1) = place(1.0, -1e-4);
  points.row(2) = place(2.0 + 1e-3, 1.0);
  SurfaceDistanceParams params;
  params.Kind = DistanceKind::Vertical;
  const auto found = MeasureSurfaceDistances(points, { surface }, params);
  ASSERT_TRUE(found) << found.Status.Message();
  EXPECT_EQ(found->Surfaces, (std::vector<int>{ 0, -1, -1 }));
  EXPECT_NEAR(found->Distances[0], -1.0, 1e-3);
  // a surface so small that its points differ by little more than rounding
  Spline<2> small = surface;
  small.ControlPoints.rowwise() -= shift;
  small.ControlPoints *= 1e-6;
  small.ControlPoints.rowwise() += shift;
  points.row(0) = (place(1.0, 1.0) - shift) * 1e-6 + shift;
  const auto near = MeasureSurfaceDistances(points.topRows(1), { small }, params);
  ASSERT_TRUE(near) << near.Status.Message();
  EXPECT_EQ(near->Surfaces, std::vector<int>{ 0 });
}

TEST(SurfaceDistance, VerticalOfEveryKind_ExactOracle)
{
  for (const SpaceKind kind : Kinds)
  {
    Random random(1);
    std::vector<double> offsets;
    const PointMatrix points = PointsAbove(random, 500, offsets);
    const Spline<2> surface = Saddle(kind);
    ASSERT_EQ(surface.Space->Kind, kind);
    const auto result = MeasureSurfaceDistances(points, { surface });
    ASSERT_TRUE(result) << result.Status.Message();
    EXPECT_EQ(result->Kind, DistanceKind::Vertical);
    EXPECT_EQ(result->NumWithout, 0u);
    for (std::size_t i = 0; i < offsets.size(); ++i)
    {
      EXPECT_NEAR(result->Distances[i], offsets[i], 1e-14); // values up to 5
    }
  }
}

TEST(SurfaceDistance, VerticalThroughAPlaneMap_CrossOracle)
{
  Random random(2);
  std::vector<double> offsets;
  const PointMatrix flat = PointsAbove(random, 200, offsets);
  PointMatrix points = flat;
  const double turn = 0.4;
  points.col(0) = std::cos(turn) * flat.col(0) - std::sin(turn) * flat.col(1);
  points.col(1) = std::sin(turn) * flat.col(0) + std::cos(turn) * flat.col(1);
  SurfaceDistanceParams params;
  params.Kind = DistanceKind::Vertical;
  const auto result =
    MeasureSurfaceDistances(points, { Saddle(SpaceKind::LocallyRefined, turn) }, params);
  ASSERT_TRUE(result) << result.Status.Message();
  for (std::size_t i = 0; i < offsets.size(); ++i)
  {
    EXPECT_NEAR(result->Distances[i], offsets[i], 1e-8); // points of the inverse map, times slope
  }
}

TEST(SurfaceDistance, ClosestOfASphere_ExactOracle)
{
  ShapeParams shape;
  shape.Kind = ShapeKind::SphereSurface;
  const auto made = MakeShape(shape);
  ASSERT_TRUE(made) << made.Status.Message();
  std::vector<Spline<2>> sphere;
  for (const AnySpline& patch : made.Value)
  {
    sphere.push_back(std::get<Spline<2>>(patch));
  }
  Random random(3);
  PointMatrix points(300, 3);
  for (Eigen::Index i = 0; i < points.size(); ++i)
  {
    points.data()[i] = random.In(-1.5, 1.5);
  }
  const auto result = MeasureSurfaceDistances(points, sphere);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result->Kind, DistanceKind::Closest);
  int inside = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    const double expected = points.row(i).norm() - shape.OuterRadius; // the normal points outward
    EXPECT_NEAR(result->Distances[static_cast<std::size_t>(i)], expected, 1e-9);
    EXPECT_NEAR(result->Feet.row(i).norm(), shape.OuterRadius, 1e-9);
    inside += expected < 0 ? 1 : 0;
  }
  EXPECT_GT(inside, 30);
}

TEST(SurfaceDistance, ClassesAndStatistics_GoldenOracle)
{
  // heights over the plane z = 2 (x y = 0 on x = 0)
  PointMatrix points(7, 3);
  points << 0, 1, 2, 0, 1, 2.1, 0, 1, 2.4, 0, 1, 1.7, 0, 1, 1.0, 0, 1, 2.2, 5, 5, 9;
  SurfaceDistanceParams params;
  params.Tolerances = { 0.25, 0.5 };
  const auto result = MeasureSurfaceDistances(points, { Saddle(SpaceKind::Tensor) }, params);
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result->Classes, (std::vector<int>{ 0, 0, 1, -1, -2, 0, 0 }));
  EXPECT_EQ(result->NumWithout, 1u);
  EXPECT_TRUE(std::isnan(result->Distances[6]));
  EXPECT_EQ(result->Surfaces[6], -1);
  ASSERT_EQ(result->ByClass.size(), 5u);
  EXPECT_EQ(result->ByClass[2].NumPoints, 3u);
  EXPECT_NEAR(result->ByClass[2].Mean, 0.1, 1e-14);
  EXPECT_NEAR(result->ByClass[2].Max, 0.2, 1e-14);
  EXPECT_EQ(result->ByClass[4].NumPoints, 0u);
  EXPECT_EQ(result->All.NumPoints, 6u);
  EXPECT_NEAR(result->All.Min, -1.0, 1e-14);
  EXPECT_NEAR(result->All.Mean, -0.1, 1e-14); // (0 + .1 + .4 - .3 - 1 + .2) / 6
  EXPECT_NEAR(result->All.MeanAbsolute, 2.0 / 6, 1e-14);
  EXPECT_NEAR(result->All.Rms, std::sqrt(1.3 / 6), 1e-14);
}

TEST(SurfaceDistance, SeveralSurfacesAndThreads_PropertyOracle)
{
  Random random(4);
  std::vector<double> offsets;
  const PointMatrix points = PointsAbove(random, 1000, offsets);
  const Spline<2> whole = Saddle(SpaceKind::LocallyRefined);
  const std::vector<Spline<2>> halves{ RestrictToBox(whole, { { 0, 0 }, { 1.1, 3 } }, 0).Value,
    RestrictToBox(whole, { { 1.1, 0 }, { 2, 3 } }, 0).Value };
  SurfaceDistanceParams params;
  for (const DistanceKind kind : { DistanceKind::Vertical, DistanceKind::Closest })
  {
    params.Kind = kind;
    params.Threads = 1;
    const auto one = MeasureSurfaceDistances(points, halves, params);
    params.Threads = 3;
    const auto three = MeasureSurfaceDistances(points, halves, params);
    const auto all = MeasureSurfaceDistances(points, { whole }, params);
    ASSERT_TRUE(one && three && all);
    EXPECT_EQ(one->Distances, three->Distances);
    EXPECT_EQ(one->Surfaces, three->Surfaces);
    for (std::size_t i = 0; i < offsets.size(); ++i)
    {
      EXPECT_NEAR(one->Distances[i], all->Distances[i], 1e-9);
      const auto row = static_cast<Eigen::Index>(i);
      const double x = points(row, 0);
      if (kind == DistanceKind::Vertical)
      {
        EXPECT_NEAR(one->Distances[i], offsets[i], 1e-13);
        EXPECT_EQ(one->Surfaces[i], x > 1.1 ? 1 : 0) << x;
        continue;
      }
      // Over a grid of the surface's formula none is nearer, and one almost as near, on the side
      // of the cut that is named.
      constexpr int n = 300;
      double nearest = HUGE_VAL;
      double place = 0.0;
      for (int k = 0; k < (n + 1) * (n + 1); ++k)
      {
        const double u = 2.0 * (k % (n + 1)) / n;
        const double v = 3.0 * (k / (n + 1)) / n;
        const Eigen::RowVector3d surface(u, v, 2 + 0.25 * u * v);
        const double distance = (surface - points.row(row)).norm();
        place = distance < nearest ? u : place;
        nearest = std::min(nearest, distance);
      }
      const double found = std::fabs(one->Distances[i]);
      EXPECT_LE(found, nearest + 1e-9);
      // half a cell's diagonal away, measured across the distance
      EXPECT_GE(found, std::sqrt(std::max(0.0, nearest * nearest - 2e-4)) - 1e-2);
      EXPECT_EQ(std::signbit(one->Distances[i]), std::signbit(offsets[i]));
      if (std::fabs(place - 1.1) > 0.02)
      {
        EXPECT_EQ(one->Surfaces[i], place > 1.1 ? 1 : 0) << place;
      }
    }
    EXPECT_GT(std::count(one->Surfaces.begin(), one->Surfaces.end(), 1), 300);
    EXPECT_GT(std::count(one->Surfaces.begin(), one->Surfaces.end(), 0), 300);
  }
}

TEST(SurfaceDistance, EveryFailureIsReachable_ExactOracle)
{
  const Spline<2> surface = Saddle(SpaceKind::Tensor);
  const PointMatrix points = PointMatrix::Ones(2, 3);
  const auto code = [](const PointMatrix& at, const std::vector<Spline<2>>& surfaces,
                      const SurfaceDistanceParams& params = {})
  { return MeasureSurfaceDistances(at, surfaces, params).Status.Code; };
  EXPECT_EQ(code(points, { surface }), ErrorCode::Ok);
  EXPECT_EQ(code(PointMatrix(0, 3), { surface }), ErrorCode::EmptyInput);
  EXPECT_EQ(code(points, {}), ErrorCode::EmptyInput);
  EXPECT_EQ(code(points.leftCols(2), { surface }), ErrorCode::SizeMismatch);
  PointMatrix bad = points;
  bad(1, 2) = std::nan("");
  EXPECT_EQ(code(bad, { surface }), ErrorCode::NonFiniteInput);
  bad(1, 2) = 1e61;
  EXPECT_EQ(code(bad, { surface }), ErrorCode::TooLarge);
  Spline<2> flat = surface;
  flat.ControlPoints = surface.ControlPoints.leftCols(2).eval();
  EXPECT_EQ(code(points, { flat }), ErrorCode::SizeMismatch);
  Spline<2> broken = surface;
  broken.ControlPoints(3, 1) = HUGE_VAL;
  EXPECT_EQ(code(points, { broken }), ErrorCode::NonFiniteInput);
  for (const std::vector<double>& tolerances :
    std::vector<std::vector<double>>{ { 0.0 }, { 2.0, 1.0 }, { std::nan("") } })
  {
    SurfaceDistanceParams params;
    params.Tolerances = tolerances;
    EXPECT_EQ(code(points, { surface }, params), ErrorCode::InvalidParameter);
  }
  SurfaceDistanceParams params;
  params.Progress = [](double) { return false; };
  EXPECT_EQ(code(points, { surface }, params), ErrorCode::Aborted);
}
