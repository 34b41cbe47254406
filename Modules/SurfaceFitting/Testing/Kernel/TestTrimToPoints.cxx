// SPDX-License-Identifier: BSD-3-Clause
#include "LRCases.h"
#include "TrimToPoints.h"
#include "TrimmedRegion.h"

#include <gtest/gtest.h>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
/// Random points of the unit disc without the disc of radius 0.4, density 5000 a unit of area.
PointMatrix RingPoints(Random& random)
{
  std::vector<double> rows;
  for (int i = 0; i < 20000; ++i)
  {
    const double x = random.In(-1, 1);
    const double y = random.In(-1, 1);
    const double r = std::hypot(x, y);
    if (r <= 1.0 && r >= 0.4)
    {
      rows.insert(rows.end(), { x, y });
    }
  }
  return Eigen::Map<const PointMatrix>(rows.data(), static_cast<Eigen::Index>(rows.size() / 2), 2);
}

/// z = x y / 2 over [-1, 1]^2 with a line that is not as long as the domain.
Spline<2> Saddle()
{
  Spline<2> surface;
  surface.Space =
    MakeTensorSpace<2>({ KnotVector::Uniform(2, 4, -1, 1), KnotVector::Uniform(2, 4, -1, 1) })
      .Value;
  const PointMatrix at = GrevillePoints(*surface.Space);
  surface.ControlPoints.resize(at.rows(), 3);
  for (Eigen::Index i = 0; i < at.rows(); ++i)
  {
    surface.ControlPoints.row(i) << at(i, 0), at(i, 1), 0.5 * at(i, 0) * at(i, 1);
  }
  return InsertSegments(surface, { { 0, 0.2, -1, 0.5, 1 } }, 0).Value;
}

double AreaOf(const OutlinePart& part)
{
  double area = 0.0;
  for (const auto& [a, b, c] : part.Triangles)
  {
    const auto& p = part.Points;
    const double turned =
      (p(b, 0) - p(a, 0)) * (p(c, 1) - p(a, 1)) - (p(c, 0) - p(a, 0)) * (p(b, 1) - p(a, 1));
    EXPECT_GT(turned, 0.0);
    area += 0.5 * turned;
  }
  return area;
}
}

TEST(CloudOutline, ARingHasItsArea_ExactOracle)
{
  for (unsigned seed = 1; seed <= 5; ++seed)
  {
    Random random(seed);
    const PointMatrix points = RingPoints(random);
    const auto outline = FindCloudOutline(points);
    ASSERT_TRUE(outline) << outline.Status.Message();
    ASSERT_EQ(outline->Parts.size(), 1u);
    const double area = 3.14159265 * (1.0 - 0.16);
    // cells at the boundary stick out by half a cell on average, along 2 pi (1 + 0.4)
    EXPECT_NEAR(AreaOf(outline->Parts[0]), area + 8.8 * 0.5 * outline->CellSize,
      0.5 * 8.8 * outline->CellSize);
    // 2.5 times the mean spacing
    EXPECT_NEAR(outline->CellSize, 2.5 * std::sqrt(1.0 / 5000), 0.3 * outline->CellSize);
  }
}

TEST(CloudOutline, GapsAndParts_GoldenOracle)
{
  // two columns of unit cells with one empty between them, one cell far away
  std::vector<double> rows;
  for (int j = 0; j < 6; ++j)
  {
    rows.insert(rows.end(), { 0.5, j + 0.5, 2.5, j + 0.5 });
  }
  rows.insert(rows.end(), { 0.0, 0.0, 9.5, 6.0 });
  const PointMatrix points = Eigen::Map<const PointMatrix>(rows.data(), 14, 2);
  CloudOutlineParams params;
  params.CellSize = 1.0;
  params.MaxGap = 1e-3;
  params.MinCells = 2;
  // a gap closes when half of it, in whole cells, covers it: one cell on each side
  const auto joined = FindCloudOutline(points, params);
  ASSERT_TRUE(joined) << joined.Status.Message();
  EXPECT_EQ(joined->Parts.size(), 1u);
  params.MinCells = 1;
  const auto all = FindCloudOutline(points, params);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->Parts.size(), 2u);
}

TEST(TrimToPoints, RingOnASaddle_PropertyOracle)
{
  Random random(7);
  const PointMatrix points = RingPoints(random);
  const auto trimmed = TrimToPoints(Saddle(), points);
  ASSERT_TRUE(trimmed) << trimmed.Status.Message();
  ASSERT_EQ(trimmed->Model.Faces.size(), 1u);
  EXPECT_TRUE(trimmed->Model.Check());
  EXPECT_EQ(trimmed->NumLoops, 2);
  EXPECT_EQ(trimmed->Loops[0], LoopVerdict::SimpleNested);
  EXPECT_EQ(trimmed->Certificates[0].Verdict, Verdict::Valid);
  EXPECT_LE(trimmed->MaxTrimDistance, trimmed->Tolerance);
  // curves follow the boundary of cells with points, so few points are cut off
  EXPECT_LE(static_cast<double>(trimmed->NumPointsOutside), 0.02 * points.rows());
  const auto region = TrimmedRegion::Create(trimmed->Model.Faces[0].Loops);
  ASSERT_TRUE(region);
  std::size_t outside = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    outside += region->Contains({ points(i, 0), points(i, 1) }) == RegionPlace::Outside ? 1 : 0;
  }
  EXPECT_EQ(outside, trimmed->NumPointsOutside);
  // the hole is one: its middle is outside; a point between both circles inside
  EXPECT_EQ(region->Contains({ 0.0, 0.0 }), RegionPlace::Outside);
  EXPECT_EQ(region->Contains({ 0.7, 0.0 }), RegionPlace::Inside);
}

TEST(TrimToPoints, TheSameForAnyNumberOfThreads_PropertyOracle)
{
  Random random(8);
  const PointMatrix points = RingPoints(random);
  TrimToPointsParams params;
  params.Threads = 1;
  const auto one = TrimToPoints(Saddle(), points, params);
  params.Threads = 3;
  const auto three = TrimToPoints(Saddle(), points, params);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->NumPointsOutside, three->NumPointsOutside);
  EXPECT_EQ(one->Model.Faces[0].Loops[0].Curves[0].UV, three->Model.Faces[0].Loops[0].Curves[0].UV);
}

TEST(TrimToPoints, EveryFailureIsReachable_ExactOracle)
{
  Random random(9);
  const PointMatrix good = RingPoints(random);
  const auto code =
    [](const Spline<2>& surface, const PointMatrix& points, const TrimToPointsParams& params = {})
  { return TrimToPoints(surface, points, params).Status.Code; };
  const Spline<2> surface = Saddle();
  EXPECT_EQ(code(surface, PointMatrix(0, 2)), ErrorCode::EmptyInput);
  PointMatrix bad = good;
  bad(3, 1) = std::nan("");
  EXPECT_EQ(code(surface, bad), ErrorCode::NonFiniteInput);
  bad = good;
  for (const double outside : { 1.5, 1e308 })
  {
    bad(3, 1) = outside;
    EXPECT_EQ(code(surface, bad), ErrorCode::OutsideDomain);
  }
  bad = good;
  bad.col(1).setZero();
  EXPECT_EQ(code(surface, bad), ErrorCode::SingularSystem);
  TrimToPointsParams params;
  params.Tolerance = -1.0;
  EXPECT_EQ(code(surface, good, params), ErrorCode::InvalidParameter);
  params = {};
  params.Outline.CellSize = -1.0;
  EXPECT_EQ(code(surface, good, params), ErrorCode::InvalidParameter);
  params.Outline.CellSize = 1e-5;
  EXPECT_EQ(code(surface, good, params), ErrorCode::TooLarge);
  params.Outline.CellSize = 0.0;
  params.Outline.MinCells = 1 << 30;
  EXPECT_EQ(code(surface, good, params), ErrorCode::EmptyInput);
  Spline<2> other = surface;
  other.ControlPoints = surface.ControlPoints.leftCols(2).eval();
  EXPECT_EQ(code(other, good), ErrorCode::SizeMismatch);
  other = surface;
  other.Weights = Eigen::VectorXd::Ones(surface.ControlPoints.rows());
  EXPECT_EQ(code(other, good), ErrorCode::InvalidWeight);
  params = {};
  params.Progress = [](double) { return false; };
  EXPECT_EQ(code(surface, good, params), ErrorCode::Aborted);
}
