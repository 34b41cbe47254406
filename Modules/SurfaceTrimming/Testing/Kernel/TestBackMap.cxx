// SPDX-License-Identifier: BSD-3-Clause
#include "BackMap.h"
#include "BezierForm.h"
#include "MeshCases.h"

#include <gtest/gtest.h>

#include <random>

namespace knotwork
{
namespace
{
ChartMesh ChartOf(const MeshCase& data)
{
  ChartMesh chart;
  chart.Points = data.Mesh.Points;
  chart.UV = data.Flat;
  chart.Triangles = data.Mesh.Triangles;
  return chart;
}

BackMapParams Params(double tolerance, BackMapMethod method = BackMapMethod::Penalized)
{
  BackMapParams params;
  params.Method = method;
  params.Tolerance = tolerance;
  return params;
}

BackMap Fit(const ChartMesh& chart, const BackMapParams& params)
{
  auto result = FitBackMap(chart, params);
  EXPECT_TRUE(result) << result.Status.Message();
  return std::move(result.Value);
}

PointMatrix Evaluate(const Spline<2>& surface, const PointMatrix& parameters)
{
  EvaluationBatch batch;
  EXPECT_TRUE(EvaluateParameters<2>(MakeBezierForm(surface), parameters, {}, batch));
  return batch.Values;
}

/// Points all over the rectangle of a surface, its boundary included.
PointMatrix GridOf(const Spline<2>& surface, int n)
{
  const auto box = surface.Space->Domain();
  PointMatrix grid((n + 1) * (n + 1), 2);
  for (int i = 0; i < grid.rows(); ++i)
  {
    grid.row(i) << box.Lower[0] + (box.Upper[0] - box.Lower[0]) * (i % (n + 1)) / n,
      box.Lower[1] + (box.Upper[1] - box.Lower[1]) * (i / (n + 1)) / n;
  }
  return grid;
}

/// Largest distance at random points of all triangles, corners and edges included.
double LargestDistance(const ChartMesh& chart, const Spline<2>& surface)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  constexpr int PerTriangle = 12;
  const auto rows = static_cast<Eigen::Index>(chart.Triangles.size()) * PerTriangle;
  PointMatrix parameters(rows, 2);
  PointMatrix points(rows, 3);
  for (Eigen::Index i = 0; i < rows; ++i)
  {
    const auto& corners = chart.Triangles[static_cast<std::size_t>(i / PerTriangle)];
    const Eigen::Index kind = i % PerTriangle;
    double b = kind == 0 ? 0.0 : part(random);
    double c = kind < 3 ? 0.0 : part(random) * (1.0 - b);
    parameters.row(i) = (1.0 - b - c) * chart.UV.row(corners[0]) + b * chart.UV.row(corners[1]) +
      c * chart.UV.row(corners[2]);
    points.row(i) = (1.0 - b - c) * chart.Points.row(corners[0]) +
      b * chart.Points.row(corners[1]) + c * chart.Points.row(corners[2]);
  }
  return (Evaluate(surface, parameters) - points).rowwise().norm().maxCoeff();
}

/// A plate with holes bent by a right angle at x = 0.87, along a line that no net follows.
MeshCase Roof(double edge)
{
  MeshCase roof = PlateWithHoles(edge);
  Lift(roof,
    [](double x, double y)
    {
      const double across = (x - 0.87) * 0.8 + (y - 0.4) * 0.6;
      const double along = (y - 0.4) * 0.8 - (x - 0.87) * 0.6;
      return Eigen::RowVector3d(std::max(across, 0.0), along, std::max(-across, 0.0));
    });
  return roof;
}

TEST(BackMap, PlaneComesBackOverTheWholeRectangle_ExactOracle)
{
  MeshCase plate = PlateWithHoles(0.1);
  const auto place = [](double x, double y)
  { return Eigen::RowVector3d(2.0 + 0.6 * x - y, 0.8 * x + 0.1 * y, x + y - 5.0); };
  Lift(plate, place);
  for (int degree : { 1, 2, 3, 5 })
  {
    for (int elements : { 0, 1, 7, 30 })
    {
      BackMapParams params = Params(1e-3);
      params.Degree = degree;
      params.Elements = elements;
      params.Margin = 0.1;
      const BackMap map = Fit(ChartOf(plate), params);
      // affine maps bend nothing: what is left is rounding, times what the energy weighs less
      // than the data where there is none
      EXPECT_LE(map.MaxResidual, 1e-8);
      EXPECT_TRUE(map.WithinTolerance);
      const PointMatrix grid = GridOf(map.Surface, 20);
      const PointMatrix points = Evaluate(map.Surface, grid);
      if (degree == 1)
      {
        continue; // folds of bilinear pieces cost nothing: nothing rules outside of the data
      }
      for (Eigen::Index i = 0; i < grid.rows(); ++i)
      {
        EXPECT_LE((points.row(i) - place(grid(i, 0), grid(i, 1))).norm(), 1e-6)
          << degree << " " << elements;
      }
    }
  }
}

TEST(BackMap, DevelopableSurfaceIsWithinToleranceAndFairInHoles_ExactOracle)
{
  const ChartMesh chart = ChartOf(CylinderWithHoles(0.04));
  const BackMap map = Fit(chart, Params(1e-3));
  EXPECT_TRUE(map.WithinTolerance);
  EXPECT_LE(LargestDistance(chart, map.Surface), 1e-3);
  // in holes of a fifth and a quarter the thin plate goes on with the cylinder's curvature at
  // their boundary: within the sagitta 0.25^2 / 2 / 0.5 / 10
  const PointMatrix points = Evaluate(map.Surface, GridOf(map.Surface, 60));
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    EXPECT_NEAR(std::hypot(points(i, 0), points(i, 1)), 0.5, 0.00625);
  }
}

TEST(BackMap, PolyhedralRoofIsWithinTolerance_PropertyOracle)
{
  const ChartMesh chart = ChartOf(Roof(0.2));
  double last = 0.0;
  for (double tolerance : { 2e-2, 5e-3, 2e-3 })
  {
    const BackMap map = Fit(chart, Params(tolerance));
    EXPECT_TRUE(map.WithinTolerance) << map.MaxResidual;
    EXPECT_LE(LargestDistance(chart, map.Surface), 1.05 * tolerance); // between the points seen
    EXPECT_GT(map.Surface.ControlPoints.rows(), last);
    last = static_cast<double>(map.Surface.ControlPoints.rows());
  }
}

TEST(BackMap, ResidualsAreThoseOfTheSurface_CrossOracle)
{
  const ChartMesh chart = ChartOf(Hill(0.1, 0.4));
  BackMapParams params = Params(1e-9);
  params.Elements = 6;
  const BackMap map = Fit(chart, params);
  EXPECT_FALSE(map.WithinTolerance);
  EXPECT_EQ(map.Passes, 1);
  const double found = LargestDistance(chart, map.Surface);
  EXPECT_NEAR(map.MaxResidual, found, 0.1 * found); // different points of the same triangles
  EXPECT_LT(map.RmsResidual, map.MaxResidual);
  EXPECT_GT(map.RmsResidual, 0.0);
}

TEST(BackMap, FinerTrianglesOfTheSamePlanesChangeLittle_PropertyOracle)
{
  // every triangle in four: the same surface, other points
  const ChartMesh chart = ChartOf(Hill(0.1, 0.4));
  ChartMesh fine = chart;
  std::map<std::pair<int, int>, int> middles;
  std::vector<Eigen::RowVectorXd> rows;
  const auto middle = [&](int a, int b)
  {
    const auto next = static_cast<int>(chart.Points.rows() + static_cast<int>(rows.size()));
    const auto found = middles.emplace(std::minmax(a, b), next);
    if (found.second)
    {
      Eigen::RowVectorXd row(5);
      row << 0.5 * (chart.Points.row(a) + chart.Points.row(b)),
        0.5 * (chart.UV.row(a) + chart.UV.row(b));
      rows.push_back(row);
    }
    return found.first->second;
  };
  fine.Triangles.clear();
  for (const auto& [a, b, c] : chart.Triangles)
  {
    const int ab = middle(a, b);
    const int bc = middle(b, c);
    const int ca = middle(c, a);
    fine.Triangles.insert(
      fine.Triangles.end(), { { a, ab, ca }, { ab, b, bc }, { ca, bc, c }, { ab, bc, ca } });
  }
  const Eigen::Index old = chart.Points.rows();
  fine.Points.conservativeResize(old + static_cast<Eigen::Index>(rows.size()), 3);
  fine.UV.conservativeResize(fine.Points.rows(), 2);
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    fine.Points.row(old + static_cast<Eigen::Index>(i)) = rows[i].head(3);
    fine.UV.row(old + static_cast<Eigen::Index>(i)) = rows[i].tail(2);
  }
  BackMapParams params = Params(1.0);
  params.Elements = 16;
  const BackMap a = Fit(chart, params);
  const BackMap b = Fit(fine, params);
  const PointMatrix grid = GridOf(a.Surface, 40);
  const double difference =
    (Evaluate(a.Surface, grid) - Evaluate(b.Surface, grid)).rowwise().norm().maxCoeff();
  // two quadratures of one integral: far below what the spline is off
  EXPECT_LE(difference, 0.3 * a.MaxResidual);
}

TEST(BackMap, UnitsAndOriginDoNotMatter_PropertyOracle)
{
  const ChartMesh chart = ChartOf(Hill(0.1, 0.4));
  const BackMap map = Fit(chart, Params(2e-3));
  ChartMesh other = chart;
  const Eigen::RowVector3d origin(30.0, -10.0, 5.0);
  const Eigen::RowVector2d flatOrigin(64.0, -32.0); // scaled by a power of two: same roundings
  other.Points = (1024.0 * chart.Points).rowwise() + origin;
  other.UV = (256.0 * chart.UV).rowwise() + flatOrigin;
  const BackMap scaled = Fit(other, Params(1024.0 * 2e-3));
  ASSERT_EQ(scaled.Surface.ControlPoints.rows(), map.Surface.ControlPoints.rows());
  const PointMatrix expected = (1024.0 * map.Surface.ControlPoints).rowwise() + origin;
  // in holes rounding is amplified by the inverse weight of the energy, 1e11 at most
  EXPECT_LE((scaled.Surface.ControlPoints - expected).cwiseAbs().maxCoeff(), 1024.0 * 1e-6);
  EXPECT_NEAR(scaled.MaxResidual, 1024.0 * map.MaxResidual, 1024.0 * 1e-9);
}

TEST(BackMap, ResultDoesNotDependOnThreads_PropertyOracle)
{
  const ChartMesh chart = ChartOf(Roof(0.1));
  BackMapParams params = Params(5e-3);
  params.Threads = 1;
  const BackMap one = Fit(chart, params);
  params.Threads = 3;
  const BackMap three = Fit(chart, params);
  ASSERT_EQ(one.Surface.ControlPoints.rows(), three.Surface.ControlPoints.rows());
  EXPECT_TRUE((one.Surface.ControlPoints.array() == three.Surface.ControlPoints.array()).all());
  EXPECT_EQ(one.MaxResidual, three.MaxResidual);
  EXPECT_EQ(one.RmsResidual, three.RmsResidual);
}

TEST(BackMap, SmoothingSmooths_PropertyOracle)
{
  const ChartMesh chart = ChartOf(Hill(0.1, 0.4));
  double last = 0.0;
  for (double smoothing : { 1e-9, 1e-5, 1e-1 })
  {
    BackMapParams params = Params(1.0);
    params.Elements = 12;
    params.Smoothing = smoothing;
    const BackMap map = Fit(chart, params);
    EXPECT_GT(map.RmsResidual, last);
    last = map.RmsResidual;
  }
}

TEST(BackMap, MostElementsAreKept_PropertyOracle)
{
  const ChartMesh chart = ChartOf(Roof(0.2));
  BackMapParams params = Params(1e-5);
  params.MaxElements = 21;
  const BackMap map = Fit(chart, params);
  EXPECT_FALSE(map.WithinTolerance);
  for (const KnotVector& knots : map.Surface.Space->Knots)
  {
    EXPECT_LE(knots.NumElements(), 21);
    EXPECT_GT(knots.NumElements(), 10);
  }
}

TEST(BackMap, EveryFailureIsReached)
{
  const ChartMesh chart = ChartOf(PlateWithHoles(0.2));
  const auto code = [&](const std::function<void(BackMapParams&)>& change)
  {
    BackMapParams params = Params(1e-3);
    change(params);
    return FitBackMap(chart, params).Status.Code;
  };
  const double nan = std::nan("");
  const std::vector<std::function<void(BackMapParams&)>> changes{
    [](BackMapParams& p) { p.Degree = 0; },
    [](BackMapParams& p) { p.Degree = 10; },
    [](BackMapParams& p) { p.Elements = -1; },
    [](BackMapParams& p) { p.Elements = 2001; },
    [](BackMapParams& p) { p.MaxElements = 0; },
    [](BackMapParams& p) { p.MaxElements = 2001; },
    [](BackMapParams& p) { p.Tolerance = 0.0; },
    [&](BackMapParams& p) { p.Tolerance = nan; },
    [](BackMapParams& p) { p.Margin = -0.1; },
    [](BackMapParams& p) { p.Margin = 1.1; },
    [&](BackMapParams& p) { p.Margin = nan; },
    [](BackMapParams& p) { p.Smoothing = 0.0; },
    [&](BackMapParams& p) { p.Smoothing = nan; },
    [](BackMapParams& p) { p.Centres = 9; },
    [](BackMapParams& p) { p.Centres = 20001; },
    [](BackMapParams& p) { p.Threads = -1; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i)
  {
    EXPECT_EQ(code(changes[i]), ErrorCode::InvalidParameter) << i;
  }
  EXPECT_EQ(code(
              [](BackMapParams& p)
              {
                p.Elements = 2000;
                p.Margin = 0.5;
              }),
    ErrorCode::TooLarge);
  EXPECT_EQ(
    code([](BackMapParams& p) { p.Progress = [](double) { return false; }; }), ErrorCode::Aborted);
  EXPECT_EQ(FitBackMap({}, Params(1e-3)).Status.Code, ErrorCode::EmptyInput);
  ChartMesh broken = chart;
  broken.UV.conservativeResize(3, 2);
  EXPECT_EQ(FitBackMap(broken, Params(1e-3)).Status.Code, ErrorCode::SizeMismatch);
  broken = chart;
  broken.Points(5, 1) = nan;
  EXPECT_EQ(FitBackMap(broken, Params(1e-3)).Status.Code, ErrorCode::NonFiniteInput);
  broken = chart;
  std::swap(broken.Triangles[4][0], broken.Triangles[4][1]);
  EXPECT_EQ(FitBackMap(broken, Params(1e-3)).Status.Code, ErrorCode::InvalidTopology);
}
}
}
