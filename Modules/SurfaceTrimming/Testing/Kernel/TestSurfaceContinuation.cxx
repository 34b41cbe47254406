// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceContinuation.h"
#include <knotwork/SplineCore/BezierForm.h>

#include <Eigen/QR>
#include <gtest/gtest.h>

#include <random>

namespace knotwork
{
namespace
{
using Place = std::function<Eigen::RowVector3d(double, double)>;

/// Two triangles a square of n x m squares on [0, 1]^2, where `isIn` says so.
ChartMesh Squares(int n, int m, const std::function<bool(int, int)>& isIn, const Place& place)
{
  ChartMesh chart;
  chart.UV.resize((n + 1) * (m + 1), 2);
  chart.Points.resize(chart.UV.rows(), 3);
  for (int k = 0; k < chart.UV.rows(); ++k)
  {
    chart.UV.row(k) << static_cast<double>(k % (n + 1)) / n, static_cast<double>(k / (n + 1)) / m;
    chart.Points.row(k) = place(chart.UV(k, 0), chart.UV(k, 1));
  }
  for (int j = 0; j < m; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      if (isIn(i, j))
      {
        const int corner = j * (n + 1) + i;
        chart.Triangles.push_back({ corner, corner + 1, corner + n + 2 });
        chart.Triangles.push_back({ corner, corner + n + 2, corner + n + 1 });
      }
    }
  }
  return chart;
}

ParametricBox<2> UnitSquare()
{
  ParametricBox<2> box;
  box.Upper = { 1.0, 1.0 };
  return box;
}

PointMatrix Evaluate(const Spline<2>& surface, const PointMatrix& parameters)
{
  EvaluationBatch batch;
  EXPECT_TRUE(EvaluateParameters<2>(MakeBezierForm(surface), parameters, {}, batch));
  return batch.Values;
}

TEST(LargestKnownRectangle, IsThatOfAllRectangles_CrossOracle)
{
  std::mt19937 random(7);
  for (int run = 0; run < 300; ++run)
  {
    KnownGrid grid;
    for (auto& lines : grid.Lines)
    {
      lines.resize(1 + random() % 9);
    }
    const unsigned holes = 2 + random() % 12; // one of so many points is not known
    for (int k = 0; k < grid.Size(0) * grid.Size(1); ++k)
    {
      grid.Known.push_back(random() % holes != 0);
    }
    const int smallest = 1 + static_cast<int>(random() % 3);
    int most = 0;
    for (int i0 = 0; i0 < grid.Size(0); ++i0)
    {
      for (int j0 = 0; j0 < grid.Size(1); ++j0)
      {
        for (int i1 = i0 + smallest - 1; i1 < grid.Size(0); ++i1)
        {
          for (int j1 = j0 + smallest - 1; j1 < grid.Size(1); ++j1)
          {
            bool known = true;
            for (int k = 0; k < (i1 - i0 + 1) * (j1 - j0 + 1); ++k)
            {
              known &= grid.IsKnown(i0 + k % (i1 - i0 + 1), j0 + k / (i1 - i0 + 1));
            }
            most = std::max(most, known ? (i1 - i0 + 1) * (j1 - j0 + 1) : 0);
          }
        }
      }
    }
    const GridRectangle found = LargestKnownRectangle(grid, smallest);
    ASSERT_EQ(most > 0, found.Size(0) > 0);
    if (most > 0)
    {
      EXPECT_EQ(found.Size(0) * found.Size(1), most);
      EXPECT_GE(std::min(found.Size(0), found.Size(1)), smallest);
      for (int j = found.First[1]; j <= found.Last[1]; ++j)
      {
        for (int i = found.First[0]; i <= found.Last[0]; ++i)
        {
          EXPECT_TRUE(grid.IsKnown(i, j));
        }
      }
    }
  }
}

TEST(ContinueSurface, ContinuesAPolynomialOfItsDegree_ExactOracle)
{
  // an L with a hole; grid points are points of the mesh, so all rings take the polynomial's values
  const Place place = [](double u, double v)
  { return Eigen::RowVector3d(u - v * v, v + u * u * v, u * u * u - 2.0 * u * v * v + v * v * v); };
  const ChartMesh chart = Squares(
    12, 10, [](int i, int j) { return (i < 6 || j < 6) && !(i == 8 && j == 2); }, place);
  const auto surface = ContinueSurface(chart, UnitSquare(), 3, { 13, 11 });
  ASSERT_TRUE(surface) << surface.Status.Message();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  PointMatrix parameters(200, 2);
  for (Eigen::Index i = 0; i < parameters.size(); ++i)
  {
    parameters(i) = part(random);
  }
  const PointMatrix points = Evaluate(surface.Value, parameters);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    // rounding, times up to some 10 for each of the six rings
    EXPECT_LE((points.row(i) - place(parameters(i, 0), parameters(i, 1))).norm(), 1e-8);
  }
}

/// A cubic spline through values, in truncated powers; its last piece is continued.
struct TruncatedPowers
{
  Eigen::VectorXd Coefficients;
  Eigen::VectorXd Kinks;

  Eigen::RowVectorXd Row(double t) const
  {
    Eigen::RowVectorXd row(4 + this->Kinks.size());
    row.head(4) << 1.0, t, t * t, t * t * t;
    for (Eigen::Index k = 0; k < this->Kinks.size(); ++k)
    {
      row[4 + k] = std::pow(std::max(t - this->Kinks[k], 0.0), 3.0);
    }
    return row;
  }
  TruncatedPowers(const std::vector<double>& at, const Eigen::VectorXd& values)
  {
    const auto n = static_cast<Eigen::Index>(at.size());
    this->Kinks.resize(n - 4);
    for (Eigen::Index k = 0; k < n - 4; ++k)
    {
      const auto j = static_cast<std::size_t>(k) + 1;
      this->Kinks[k] = (at[j] + at[j + 1] + at[j + 2]) / 3.0;
    }
    Eigen::MatrixXd matrix(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
    {
      matrix.row(i) = this->Row(at[static_cast<std::size_t>(i)]);
    }
    this->Coefficients = matrix.fullPivHouseholderQr().solve(values);
  }
};

TEST(ContinueSurface, TakesTheSurfaceOfTheLastRing_IndependentOracle)
{
  // the chart ends at u = 0.6: in v nothing is continued, in u three rings are
  const auto height = [](double u) { return std::sin(5.0 * u); };
  const ChartMesh chart = Squares(
    10, 4, [](int i, int) { return i < 7; },
    [&](double u, double v) { return Eigen::RowVector3d(u, v, height(u)); });
  const auto surface = ContinueSurface(chart, UnitSquare(), 3, { 11, 5 });
  ASSERT_TRUE(surface) << surface.Status.Message();
  std::vector<double> at;
  std::vector<double> values;
  for (int i = 0; i <= 10; ++i)
  {
    const double u = 0.1 * i;
    values.push_back(i <= 7 ? height(u) : 0.0);
    if (i > 7)
    {
      const TruncatedPowers spline(
        at, Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(at.size())));
      values.back() = spline.Row(u) * spline.Coefficients;
    }
    at.push_back(u);
  }
  const TruncatedPowers spline(
    at, Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(at.size())));
  for (double u = 0.0; u <= 1.0; u += 0.03)
  {
    PointMatrix parameter(1, 2);
    parameter << u, 0.37;
    const double expected = spline.Row(u) * spline.Coefficients;
    EXPECT_NEAR(Evaluate(surface.Value, parameter)(0, 2), expected, 1e-9) << u;
  }
}

TEST(ContinueSurface, RingsInTheChartTakeItsPoints_ExactOracle)
{
  // heights at random: a T, of which the largest grid is the bar; the stem's points are not free
  std::mt19937 random(11);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  const Place place = [&](double u, double v) { return Eigen::RowVector3d(u, v, part(random)); };
  const ChartMesh chart = Squares(
    12, 10, [](int i, int j) { return j >= 6 || (i >= 4 && i < 8); }, place);
  const auto surface = ContinueSurface(chart, UnitSquare(), 3, { 13, 11 });
  ASSERT_TRUE(surface) << surface.Status.Message();
  const PointMatrix points = Evaluate(surface.Value, chart.UV);
  for (Eigen::Index k = 0; k < points.rows(); ++k)
  {
    const Eigen::Index i = k % 13;
    const Eigen::Index j = k / 13;
    if (j >= 6 || (i >= 4 && i <= 8))
    {
      // rounding of values that grow by some 100 a ring beside the stem
      EXPECT_LE((points.row(k) - chart.Points.row(k)).norm(), 1e-4) << i << ", " << j;
    }
  }
}

TEST(ContinueSurface, KeepsTheToleranceOnAChartThatFillsItsRectangle_ExactOracle)
{
  const Place place = [](double u, double v)
  { return Eigen::RowVector3d(u, v, 0.2 * std::sin(3.0 * u) * std::cos(4.0 * v)); };
  BackMapParams params;
  params.Method = BackMapMethod::Nurbs;
  params.Tolerance = 2e-3; // chords of the mesh: 0.2 * 25 / 8 / 40^2 = 4e-4
  const auto map = FitBackMap(Squares(
                                40, 40, [](int, int) { return true; }, place),
    params);
  ASSERT_TRUE(map) << map.Status.Message();
  EXPECT_TRUE(map->WithinTolerance) << map->MaxResidual;
  PointMatrix parameters(441, 2);
  for (Eigen::Index k = 0; k < parameters.rows(); ++k)
  {
    parameters.row(k) << static_cast<double>(k % 21) / 20, static_cast<double>(k / 21) / 20;
  }
  const PointMatrix points = Evaluate(map->Surface, parameters);
  for (Eigen::Index k = 0; k < points.rows(); ++k)
  {
    EXPECT_LE((points.row(k) - place(parameters(k, 0), parameters(k, 1))).norm(), 2.4e-3);
  }
}

TEST(ContinueSurface, FailuresAreNamed_ExactOracle)
{
  const Place plane = [](double u, double v) { return Eigen::RowVector3d(u, v, 0.0); };
  const ChartMesh narrow = Squares(
    30, 30, [](int i, int j) { return i < 2 || j < 2; }, plane);
  const auto few = ContinueSurface(narrow, UnitSquare(), 3, { 31, 31 }); // three lines in an arm
  EXPECT_EQ(few.Status.Code, ErrorCode::SingularSystem);
  EXPECT_NE(few.Status.Message().find("4 x 4"), std::string::npos) << few.Status.Message();

  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  const ChartMesh wild = Squares(
    900, 4, [](int i, int) { return i < 6; },
    [&](double u, double v) { return Eigen::RowVector3d(u, v, part(random)); });
  const auto large = ContinueSurface(wild, UnitSquare(), 9, { 901, 12 }); // 1e3 a ring and more
  EXPECT_EQ(large.Status.Code, ErrorCode::SingularSystem);
}
}
}
