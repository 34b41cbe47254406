// SPDX-License-Identifier: BSD-3-Clause
#include "LRCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/TrimmedRegion.h>
#include <knotwork/SurfaceTrimming/TrimToPoints.h>

#include <gtest/gtest.h>

#include <set>

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

TEST(CloudOutline, ARingIsItsCells_CrossOracle)
{
  for (unsigned seed = 1; seed <= 5; ++seed)
  {
    Random random(seed);
    const PointMatrix points = RingPoints(random);
    const auto outline = FindCloudOutline(points);
    ASSERT_TRUE(outline) << outline.Status.Message();
    ASSERT_EQ(outline->Parts.size(), 1u);
    const OutlinePart& part = outline->Parts[0];
    const double cell = outline->CellSize;
    // 2.5 times the mean spacing, which random points miss by some percent
    EXPECT_NEAR(cell, 2.5 * std::sqrt(1.0 / 5000), 0.1 * cell);

    const Eigen::RowVector2d low = points.colwise().minCoeff();
    const Eigen::RowVector2d high = points.colwise().maxCoeff();
    std::set<std::array<int, 2>> cells;
    Eigen::RowVector2d middle(0, 0);
    double cut = 0.0; // of the last cells, by the points' box
    for (Eigen::Index i = 0; i < points.rows(); ++i)
    {
      const Eigen::RowVector2d at = (points.row(i) - low) / cell;
      if (cells.insert({ static_cast<int>(at[0]), static_cast<int>(at[1]) }).second)
      {
        const Eigen::RowVector2d corner = low + cell * at.array().floor().matrix();
        middle.array() += corner.array() + 0.5 * cell;
        cut += cell * cell - (high - corner).cwiseMin(cell).prod();
      }
    }
    const auto occupied = static_cast<double>(cells.size());
    const double found = 0.5 * static_cast<double>(part.Triangles.size());
    EXPECT_GE(found, occupied);
    EXPECT_LE(found, 1.02 * occupied); // gaps of two cells, of which there are few
    // smoothing takes from corners of the outer loop what it gives to those of the hole
    EXPECT_NEAR(AreaOf(part), found * cell * cell - cut, 3.0 * cell * cell);
    Eigen::RowVector2d centre(0, 0);
    for (const auto& [i, j, k] : part.Triangles)
    {
      centre += part.Points.row(i) + part.Points.row(j) + part.Points.row(k);
    }
    centre /= 3.0 * static_cast<double>(part.Triangles.size());
    EXPECT_LE((centre - middle / occupied).norm(), 0.2 * cell);
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
  params.MinCells = 2;
  // the gap of one cell closes when a cell fits into what may be closed
  for (const double gap : { 1e-3, 0.999, 1.0, 1.5 })
  {
    params.MaxGap = gap;
    const auto outline = FindCloudOutline(points, params);
    ASSERT_TRUE(outline) << outline.Status.Message();
    EXPECT_EQ(outline->Parts.size(), gap < 1.0 ? 2u : 1u) << gap;
  }
  params.MinCells = 1;
  const auto all = FindCloudOutline(points, params);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->Parts.size(), 2u);
}

namespace
{
constexpr int Columns = 13;
constexpr int Rows = 10;
using Cells = std::array<std::array<bool, Columns>, Rows>;

bool IsEmptySquare(const Cells& cells, int i, int j, int side)
{
  for (int b = std::max(j, 0); b < std::min(j + side, Rows); ++b)
  {
    for (int a = std::max(i, 0); a < std::min(i + side, Columns); ++a)
    {
      if (cells[b][a])
      {
        return false;
      }
    }
  }
  return true;
}

/// The definition: a cell stays empty when an empty square of gap + 1 cells covers it.
Cells Closed(const Cells& cells, int gap)
{
  Cells closed;
  for (int j = 0; j < Rows; ++j)
  {
    for (int i = 0; i < Columns; ++i)
    {
      bool covered = false;
      for (int b = j - gap; b <= j; ++b)
      {
        for (int a = i - gap; a <= i; ++a)
        {
          covered = covered || IsEmptySquare(cells, a, b, gap + 1);
        }
      }
      closed[j][i] = !covered;
    }
  }
  return closed;
}

bool TouchInACorner(const Cells& c)
{
  for (int j = 0; j + 1 < Rows; ++j)
  {
    for (int i = 0; i + 1 < Columns; ++i)
    {
      if (c[j][i] == c[j + 1][i + 1] && c[j][i + 1] == c[j + 1][i] && c[j][i] != c[j][i + 1])
      {
        return true;
      }
    }
  }
  return false;
}
}

TEST(CloudOutline, GapsOfAnyNumberOfCells_CrossOracle)
{
  int compared = 0;
  for (unsigned seed = 1; seed <= 300; ++seed)
  {
    Random random(seed);
    const double density = random.In(0.02, 0.9);
    Cells cells;
    std::vector<double> points{ 0, 0, Columns, Rows };
    for (int j = 0; j < Rows; ++j)
    {
      for (int i = 0; i < Columns; ++i)
      {
        const bool isEnd = i + j == 0 || i + j == Columns + Rows - 2;
        cells[j][i] = isEnd || random.In(0, 1) < density;
        if (cells[j][i])
        {
          points.insert(points.end(), { i + 0.5, j + 0.5 });
        }
      }
    }
    const PointMatrix at =
      Eigen::Map<const PointMatrix>(points.data(), static_cast<Eigen::Index>(points.size() / 2), 2);
    for (const int gap : { 1, 2, 3, 4, 7, 20 })
    {
      const Cells closed = Closed(cells, gap);
      if (TouchInACorner(closed))
      {
        continue; // more cells are filled
      }
      ++compared;
      CloudOutlineParams params;
      params.CellSize = 1.0;
      params.MaxGap = gap + 0.5;
      params.MinCells = 1;
      const auto outline = FindCloudOutline(at, params);
      ASSERT_TRUE(outline) << outline.Status.Message();
      std::size_t found = 0;
      for (const OutlinePart& part : outline->Parts)
      {
        found += part.Triangles.size() / 2;
      }
      std::size_t expected = 0;
      for (const auto& row : closed)
      {
        expected += static_cast<std::size_t>(std::count(row.begin(), row.end(), true));
      }
      EXPECT_EQ(found, expected) << "seed " << seed << " gap " << gap;
    }
  }
  EXPECT_GE(compared, 300);
}

TEST(CloudOutline, WideGapsOfManyCells_PropertyOracle)
{
  // two crossing lines of points through 9 million cells: the gap takes no more time than the cells
  std::vector<double> rows;
  for (int i = 0; i <= 3000; ++i)
  {
    rows.insert(rows.end(), { i + 0.0, 1500.5, 1500.5, i + 0.0 });
  }
  const PointMatrix points =
    Eigen::Map<const PointMatrix>(rows.data(), static_cast<Eigen::Index>(rows.size() / 2), 2);
  CloudOutlineParams params;
  params.CellSize = 1.0;
  for (const double gap : { 1000.0, 1e9 })
  {
    params.MaxGap = gap;
    const auto outline = FindCloudOutline(points, params);
    ASSERT_TRUE(outline) << outline.Status.Message();
    ASSERT_EQ(outline->Parts.size(), 1u);
    EXPECT_EQ(outline->Parts[0].Triangles.size(), 2u * (2u * 3000u - 1u)) << "corners are no gaps";
  }
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

TEST(TrimToPoints, ManyPartsShareTheSurface_PropertyOracle)
{
  // 144 islands of 36 points each
  std::vector<double> rows;
  for (int island = 0; island < 144; ++island)
  {
    for (int i = 0; i < 36; ++i)
    {
      const double s = (island % 12 + 0.1 + 0.1 * (i % 6)) / 12.0;
      const double t = (island / 12 + 0.1 + 0.1 * (i / 6)) / 12.0; // NOLINT: whole numbers
      rows.insert(rows.end(), { 2.0 * s - 1.0, 2.0 * t - 1.0 });
    }
  }
  const PointMatrix points =
    Eigen::Map<const PointMatrix>(rows.data(), static_cast<Eigen::Index>(rows.size() / 2), 2);
  Spline<2> surface;
  surface.Space =
    MakeTensorSpace<2>({ KnotVector::Uniform(2, 60, -1, 1), KnotVector::Uniform(2, 60, -1, 1) })
      .Value;
  const PointMatrix at = GrevillePoints(*surface.Space);
  surface.ControlPoints.resize(at.rows(), 3);
  surface.ControlPoints << at, at.col(0).cwiseProduct(at.col(1));
  TrimToPointsParams params;
  params.Outline.CellSize = 0.02; // points are 1/60 apart, islands 1/12
  params.Outline.MaxGap = 0.04;
  const auto trimmed = TrimToPoints(surface, points, params);
  ASSERT_TRUE(trimmed) << trimmed.Status.Message();
  ASSERT_EQ(trimmed->Model.Faces.size(), 144u);
  EXPECT_TRUE(trimmed->Model.Check());
  Eigen::Index controlPoints = 0;
  for (const TrimmedFace& face : trimmed->Model.Faces)
  {
    controlPoints += face.Surface.ControlPoints.rows();
    EvaluationBatch whole;
    EvaluationBatch part;
    const PointMatrix where = face.Loops[0].Curves[0].UV.topRows(1);
    ASSERT_TRUE(EvaluateParameters(MakeBezierForm(surface), where, {}, whole));
    ASSERT_TRUE(EvaluateParameters(MakeBezierForm(face.Surface), where, {}, part));
    EXPECT_LE((whole.Values - part.Values).cwiseAbs().maxCoeff(), 1e-14);
  }
  // a part and its margin are less than twice as long as what belongs to it in the lattice
  EXPECT_LE(controlPoints, 8 * surface.ControlPoints.rows());
  EXPECT_LE(trimmed->NumPointsOutside, 4u * 144u); // corners are cut
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
