// SPDX-License-Identifier: BSD-3-Clause
#include "ChartSamples.h"
#include "MeshCases.h"
#include "RadialKernel.h"
#include "RadialSurface.h"
#include "SurfaceFairness.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SurfaceTrimming/BackMap.h>

#include <Eigen/LU>
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

/// Largest distance of points from those of a formula at parameters.
double LargestDifference(const PointMatrix& points, const PointMatrix& parameters,
  const std::function<Eigen::RowVector3d(double, double)>& place)
{
  double largest = 0.0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    largest = std::max(largest, (points.row(i) - place(parameters(i, 0), parameters(i, 1))).norm());
  }
  return largest;
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
      EXPECT_LE(LargestDifference(points, grid, place), 1e-6) << degree << " " << elements;
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
  // their boundary: within a fifth of the sagitta
  // 0.25^2 / 2 / 0.5
  const PointMatrix points = Evaluate(map.Surface, GridOf(map.Surface, 60));
  double off = 0.0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    off = std::max(off, std::abs(std::hypot(points(i, 0), points(i, 1)) - 0.5));
  }
  EXPECT_LE(off, 0.0125);
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

constexpr std::array<BackMapMethod, 5> AllMethods{ BackMapMethod::Nurbs, BackMapMethod::Rbf,
  BackMapMethod::Hybrid, BackMapMethod::Penalized, BackMapMethod::ContinuedLines };

TEST(BackMap, AllMethodsContinueAPlane_ExactOracle)
{
  MeshCase plate = PlateWithHoles(0.1);
  const auto place = [](double x, double y)
  { return Eigen::RowVector3d(2.0 + 0.6 * x - y, 0.8 * x + 0.1 * y, x + y - 5.0); };
  Lift(plate, place);
  for (BackMapMethod method : AllMethods)
  {
    for (int degree : { 2, 3, 4 })
    {
      BackMapParams params = Params(1e-3, method);
      params.Degree = degree;
      params.Elements = 24; // with 5 x 5 points of the grid between the holes
      const BackMap map = Fit(ChartOf(plate), params);
      EXPECT_TRUE(map.WithinTolerance);
      const PointMatrix grid = GridOf(map.Surface, 20);
      const PointMatrix points = Evaluate(map.Surface, grid);
      // rounding, amplified where the penalized system rests on the energy alone, and by
      // polynomials that are continued
      EXPECT_LE(LargestDifference(points, grid, place), 1e-6) << ToString(method) << " " << degree;
    }
  }
}

TEST(BackMap, AllMethodsButThePublishedAreWithinToleranceOfASmoothSurface_PropertyOracle)
{
  // chords of the mesh: 0.03^2 / 8 / 0.5 = 2e-4
  const ChartMesh chart = ChartOf(CylinderWithHoles(0.03));
  for (BackMapMethod method : AllMethods)
  {
    const BackMap map = Fit(chart, Params(2e-3, method));
    if (method == BackMapMethod::Nurbs) // what it continues into holes spoils the rings around them
    {
      EXPECT_FALSE(map.WithinTolerance);
      EXPECT_GT(map.MaxResidual, 0.05);
      continue;
    }
    EXPECT_TRUE(map.WithinTolerance) << ToString(method) << " " << map.MaxResidual;
    EXPECT_LE(LargestDistance(chart, map.Surface), 2.1e-3) << ToString(method);
    const bool radial = method == BackMapMethod::Rbf || method == BackMapMethod::Hybrid;
    EXPECT_EQ(map.Centres > 0, radial);
    EXPECT_LE(map.Centres, 2000);
  }
}

TEST(BackMap, NoMethodDependsOnThreads_PropertyOracle)
{
  const ChartMesh chart = ChartOf(Hill(0.1, 0.4));
  for (BackMapMethod method : AllMethods)
  {
    BackMapParams params = Params(1e-3, method);
    params.Elements = 20;
    params.Centres = 100;
    params.Threads = 1;
    const BackMap one = Fit(chart, params);
    params.Threads = 3;
    const BackMap three = Fit(chart, params);
    EXPECT_TRUE((one.Surface.ControlPoints.array() == three.Surface.ControlPoints.array()).all())
      << ToString(method);
  }
}

TEST(BackMap, ExtrapolationFoldsOutsideAConcaveChartAndOthersDoNot_PropertyOracle)
{
  const ChartMesh chart = ChartOf(SOnCone(0.06));
  for (BackMapMethod method : AllMethods)
  {
    const BackMap map = Fit(chart, Params(5e-3, method));
    EXPECT_EQ(map.WithinTolerance, method != BackMapMethod::Nurbs)
      << ToString(method) << " " << map.MaxResidual;
    const SurfaceFairness fairness = MeasureFairness(chart, map.Surface);
    if (method == BackMapMethod::Nurbs || method == BackMapMethod::ContinuedLines)
    {
      EXPECT_GT(fairness.FoldedShare, 0.0);
      EXPECT_LT(fairness.MinDot, -0.5);
      EXPECT_GT(fairness.AreaFactor, 10.0);
    }
    else
    {
      // neighbouring grid points are a three-hundredth of 5 apart on a cone of radius 0.75
      EXPECT_EQ(fairness.FoldedShare, 0.0) << ToString(method);
      EXPECT_GT(fairness.MinDot, 0.99) << ToString(method);
      EXPECT_NEAR(fairness.AreaFactor, 1.0, 0.1) << ToString(method);
    }
  }
}

TEST(BackMap, PenalizedRoofIsNotFoldedBesideItsBoundary_PropertyOracle)
{
  const ChartMesh chart = ChartOf(Roof(0.2));
  const BackMap map = Fit(chart, Params(5e-3));
  const SurfaceFairness fairness = MeasureFairness(chart, map.Surface);
  EXPECT_EQ(fairness.FoldedShare, 0.0);
  EXPECT_NEAR(fairness.AreaFactor, 1.0, 0.2);
}

/// A plate of triangles that rise and fall at random, up to the height at each point.
MeshCase Crumpled(double edge, double height)
{
  MeshCase plate = PlateWithHoles(edge);
  std::mt19937 random(5);
  for (Eigen::Index i = 0; i < plate.Mesh.Points.rows(); ++i)
  {
    plate.Mesh.Points(i, 2) = random() % 2 == 0 ? height : -height;
  }
  return plate;
}

TEST(BackMap, SlopesThatWaverAlongABoundaryDoNotFoldBeyondIt_PropertyOracle)
{
  const ChartMesh chart = ChartOf(Crumpled(0.12, 0.18));
  BackMapParams params = Params(6e-3);
  params.MaxElements = 60;
  const SurfaceFairness fairness = MeasureFairness(chart, Fit(chart, params).Surface);
  // 3.6e-4, -0.48 and 1.12 without more stiffness there
  EXPECT_LT(fairness.FoldedShare, 1e-4);
  EXPECT_GT(fairness.MinDot, -0.2);
  EXPECT_NEAR(fairness.AreaFactor, 1.0, 0.1);
}

TEST(BackMap, BoundaryIsKeptAsWellAsTheInside_PropertyOracle)
{
  const ChartMesh chart = ChartOf(Crumpled(0.12, 0.03));
  BackMapParams params = Params(1e-3);
  params.Elements = 20;
  const BackMap map = Fit(chart, params);
  double sum = 0.0;
  constexpr int PerEdge = 10;
  const auto boundary = BoundaryEdges(chart.Triangles);
  for (const auto& [a, b] : boundary)
  {
    PointMatrix parameters(PerEdge, 2);
    PointMatrix points(PerEdge, 3);
    for (int i = 0; i < PerEdge; ++i)
    {
      const double t = (i + 0.5) / PerEdge;
      parameters.row(i) = (1.0 - t) * chart.UV.row(a) + t * chart.UV.row(b);
      points.row(i) = (1.0 - t) * chart.Points.row(a) + t * chart.Points.row(b);
    }
    sum += (Evaluate(map.Surface, parameters) - points).squaredNorm();
  }
  const double rms = std::sqrt(sum / (PerEdge * static_cast<double>(boundary.size())));
  EXPECT_LT(rms, map.RmsResidual); // 1.6 times as much with area alone
}

TEST(BackMap, SharpEdgesNeedFewSpans_PropertyOracle)
{
  // 12626 spans when all points weigh the same
  const BackMap map = Fit(ChartOf(Roof(0.2)), Params(2e-3));
  EXPECT_TRUE(map.WithinTolerance);
  EXPECT_LT(map.Surface.Space->NumElements(), 10000);
}

TEST(BackMap, HybridControlPointsAreThoseOfRbfInterpolation_CrossOracle)
{
  // both follow one radial surface: the hybrid to second order, interpolation to higher order
  const ChartMesh chart = ChartOf(CylinderWithHoles(0.1));
  double last = 0.0;
  for (int elements : { 40, 80 })
  {
    BackMapParams params = Params(1e-3, BackMapMethod::Rbf);
    params.Elements = elements;
    const BackMap rbf = Fit(chart, params);
    params.Method = BackMapMethod::Hybrid;
    const BackMap hybrid = Fit(chart, params);
    const PointMatrix grid = GridOf(rbf.Surface, 50);
    const double difference =
      (Evaluate(rbf.Surface, grid) - Evaluate(hybrid.Surface, grid)).rowwise().norm().maxCoeff();
    // h^2 / 3 times the curvature 2 where knots are simple (Schoenberg's operator, degree 3)
    EXPECT_LE(difference, 2.0 * std::pow(2.08 / elements, 2.0));
    EXPECT_GT(difference, 0.0);
    if (last > 0.0)
    {
      EXPECT_LT(difference, 0.5 * last);
    }
    last = difference;
  }
}

/// Against std::log at distances of all sizes; five components are two kernels.
TEST(RadialSurface, KernelIsThatOfTheFormula_CrossOracle)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> exponent(-139.0, 3.0);
  Eigen::MatrixXd centres(1003, 2);
  for (Eigen::Index i = 0; i < centres.rows(); ++i)
  {
    centres.row(i) << std::pow(10.0, exponent(random)), -std::pow(10.0, exponent(random));
  }
  centres.row(7).setZero();
  const RadialKernel kernel(centres, Eigen::MatrixXd::Ones(centres.rows(), 2));
  Eigen::VectorXd values(centres.rows());
  kernel.Values(0.0, 0.0, values.data());
  double sum = 0.0;
  double largest = 0.0;
  for (Eigen::Index i = 0; i < centres.rows(); ++i)
  {
    const double square = centres.row(i).squaredNorm();
    const double expected = square > 0.0 ? 0.5 * square * std::log(square) : 0.0;
    // a few roundings of the logarithm, which is absolute where it is nearly 0
    EXPECT_NEAR(values[i], expected, 8e-16 * std::max(std::abs(expected), square)) << square;
    sum += values[i];
    largest += std::abs(values[i]);
  }
  double sums[2];
  kernel.Sums(0.0, 0.0, sums);
  EXPECT_NEAR(sums[0], sum, 1e-13 * largest);
  EXPECT_EQ(sums[0], sums[1]);
}

TEST(RadialSurface, TakesItsValues_ExactOracle)
{
  const MeshCase hill = Hill(0.1, 0.4);
  const auto surface = RadialSurface::Interpolate(hill.Flat, hill.Mesh.Points, 0);
  ASSERT_TRUE(surface) << surface.Status.Message();
  const PointMatrix values = surface->Evaluate(hill.Flat, 0);
  EXPECT_LE((values - hill.Mesh.Points).cwiseAbs().maxCoeff(), 1e-10); // condition about 1e6
}

TEST(RadialSurface, ContinuesAffineMaps_ExactOracle)
{
  const PointMatrix flat = PlateWithHoles(0.2).Flat;
  PointMatrix points(flat.rows(), 3);
  points << flat.col(0), flat.col(1) - 2.0 * flat.col(0), flat.col(1).array() + 7.0;
  const auto surface = RadialSurface::Interpolate(flat, points, 1);
  ASSERT_TRUE(surface);
  PointMatrix far(2, 2);
  far << 30.0, -10.0, -5.0, 40.0;
  const PointMatrix values = surface->Evaluate(far, 1);
  EXPECT_NEAR(values(0, 1), -70.0, 1e-8);
  EXPECT_NEAR(values(1, 1), 50.0, 1e-8);
  EXPECT_NEAR(values(1, 2), 47.0, 1e-8);
}

TEST(RadialSurface, IsTheSolutionOfTheFullSystem_CrossOracle)
{
  // [A P; P' 0] by Gauss elimination, at a point beside the centres
  PointMatrix flat(7, 2);
  flat << 0, 0, 1, 0, 0.2, 1, 1.1, 0.9, 0.5, 0.4, 0.8, 0.3, 0.1, 0.6;
  const Eigen::VectorXd values = (flat.col(0).array() * 3.0).sin() + flat.col(1).array().square();
  const auto phi = [](double r) { return r > 0.0 ? r * r * std::log(r) : 0.0; };
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(10, 10);
  for (int i = 0; i < 7; ++i)
  {
    for (int j = 0; j < 7; ++j)
    {
      matrix(i, j) = phi((flat.row(i) - flat.row(j)).norm());
    }
    matrix.row(i).tail(3) << 1.0, flat.row(i);
    matrix.col(i).tail(3) << 1.0, flat.row(i).transpose();
  }
  Eigen::VectorXd sides = Eigen::VectorXd::Zero(10);
  sides.head(7) = values;
  const Eigen::VectorXd solution = matrix.fullPivLu().solve(sides);
  PointMatrix at(1, 2);
  at << 0.63, 0.71;
  double expected = solution[7] + solution[8] * at(0, 0) + solution[9] * at(0, 1);
  for (int i = 0; i < 7; ++i)
  {
    expected += solution[i] * phi((flat.row(i) - at.row(0)).norm());
  }
  const auto surface = RadialSurface::Interpolate(flat, values, 1);
  ASSERT_TRUE(surface);
  EXPECT_NEAR(surface->Evaluate(at, 1)(0, 0), expected, 1e-12);
}

TEST(RadialSurface, GreedyCentresAreFewAndWithinTolerance_PropertyOracle)
{
  const MeshCase hill = Hill(0.025, 0.4); // more than three thousand points
  const auto fit = FitRadialSurface(hill.Flat, hill.Mesh.Points, 2000, 1e-3, 0);
  ASSERT_TRUE(fit);
  EXPECT_LT(fit->Rows.size(), 1000u);
  EXPECT_TRUE(std::is_sorted(fit->Rows.begin(), fit->Rows.end()));
  EXPECT_EQ(std::adjacent_find(fit->Rows.begin(), fit->Rows.end()), fit->Rows.end());
  const auto off = [&](const RadialFit& found)
  { return (found.Surface.Evaluate(hill.Flat, 0) - hill.Mesh.Points).rowwise().norm().maxCoeff(); };
  EXPECT_LE(off(fit.Value), 1e-3);
  const auto few = FitRadialSurface(hill.Flat, hill.Mesh.Points, 60, 1e-3, 0);
  ASSERT_TRUE(few);
  EXPECT_EQ(few->Rows.size(), 60u);
  EXPECT_GT(off(few.Value), 1e-3);
}

TEST(RadialSurface, PointsOnALineAreRefused)
{
  PointMatrix flat(5, 2);
  flat << 0, 0, 1, 0.5, 2, 1, 3, 1.5, 4, 2;
  EXPECT_EQ(RadialSurface::Interpolate(flat, flat, 1).Status.Code, ErrorCode::SingularSystem);
}

TEST(BackMap, WorkIsCountedAndEndsItAtTheSamePlace_PropertyOracle)
{
  const ChartMesh chart = ChartOf(Roof(0.2));
  BackMapParams params = Params(1e-7); // no net is as fine
  params.Threads = 1;
  double before = 1e300;
  for (double effort : { 1e-6, 0.05, 0.5 })
  {
    SCOPED_TRACE(effort);
    params.Effort = effort;
    const BackMap map = Fit(chart, params);
    EXPECT_EQ(map.Stop, BackMapStop::Effort);
    EXPECT_FALSE(map.WithinTolerance);
    EXPECT_LT(map.MaxResidual, before); // the best so far, and the further the better
    before = map.MaxResidual;
    if (effort == 1e-6)
    {
      EXPECT_EQ(map.Passes, 1); // the first net in any case
    }
    else
    {
      EXPECT_LE(map.Work, effort);
      // what a pass costs grows about fourfold: a sixteenth is used at least
      EXPECT_GE(map.Work, effort / 16.0);
    }
    BackMapParams parallel = params;
    parallel.Threads = 3;
    const BackMap again = Fit(chart, parallel);
    EXPECT_EQ(again.Surface.ControlPoints, map.Surface.ControlPoints);
    EXPECT_EQ(again.Work, map.Work);
  }
  // what was stopped goes on where it was stopped, as if it had not been
  params.Effort = 0.05;
  const BackMap stopped = Fit(chart, params);
  params.FirstNet = stopped.NextNet;
  EXPECT_GT(stopped.Work + stopped.NextWork, 0.05);
  params.Effort = 0.5 - stopped.Work;
  const BackMap resumed = Fit(chart, params);
  params.FirstNet.clear();
  params.Effort = 0.5;
  const BackMap whole = Fit(chart, params);
  EXPECT_EQ(resumed.Surface.ControlPoints, whole.Surface.ControlPoints);
  EXPECT_NEAR(stopped.Work + resumed.Work, whole.Work, 1e-9 * whole.Work);
  params.TimeLimit = 1e-9;
  EXPECT_EQ(Fit(chart, params).Stop, BackMapStop::Time);
}

TEST(BackMap, LeavesWhatItsNetWillCostLater_PropertyOracle)
{
  const ChartMesh chart = ChartOf(Roof(0.2));
  BackMapParams params = Params(1e-7); // no net is as fine
  params.Effort = 0.5;
  const BackMap whole = Fit(chart, params);
  params.LaterWork = 0.5 / static_cast<double>(whole.Surface.ControlPoints.rows());
  const BackMap map = Fit(chart, params);
  EXPECT_EQ(map.Stop, BackMapStop::Effort);
  EXPECT_LT(map.Surface.ControlPoints.rows(), whole.Surface.ControlPoints.rows());
  const auto later = [&](double points) { return params.LaterWork * points; };
  EXPECT_LE(map.Work + later(static_cast<double>(map.Surface.ControlPoints.rows())), params.Effort);
  EXPECT_GT(map.Work + map.NextWork, params.Effort);
  EXPECT_GE(map.NextWork, later(map.NextNet[0].NumFunctions() * map.NextNet[1].NumFunctions()));
}

TEST(BackMap, LimitsOfTheNetAreNamed_PropertyOracle)
{
  const ChartMesh chart = ChartOf(Roof(0.2));
  BackMapParams params = Params(1e-6);
  params.MaxElements = 20;
  EXPECT_EQ(Fit(chart, params).Stop, BackMapStop::Elements);
  for (const BackMapMethod method : AllMethods)
  {
    SCOPED_TRACE(ToString(method));
    params = Params(1e-9, method);
    params.MaxFunctions = 500;
    const BackMap map = Fit(chart, params);
    if (method != BackMapMethod::Rbf) // its spline follows the radial functions by then
    {
      EXPECT_EQ(map.Stop, BackMapStop::Functions);
    }
    EXPECT_LE(map.Surface.Space->NumFunctions, 500);
    params.Elements = 30;
    EXPECT_EQ(FitBackMap(chart, params).Status.Code, ErrorCode::TooLarge);
  }
  EXPECT_EQ(Fit(chart, Params(1e-2)).Stop, BackMapStop::Finished);
}

/// A ring of more than one turn, which rises like a ramp: what its ends share in the plane lies
/// 0.5 apart in space.
TEST(BackMap, AChartThatLiesOnItselfEndsAtOnce_ExactOracle)
{
  MeshCase ramp =
    FlatCase(0.0, 7.0, 0.0, 1.0, 0.25, [](double, double) { return true; }); // 7 / 6.28 turns
  for (Eigen::Index i = 0; i < ramp.Flat.rows(); ++i)
  {
    const double angle = -ramp.Flat(i, 0);
    const double radius = 1.0 + ramp.Flat(i, 1);
    ramp.Flat.row(i) << radius * std::cos(angle), radius * std::sin(angle);
    ramp.Mesh.Points.row(i) << ramp.Flat(i, 0), ramp.Flat(i, 1),
      0.5 * angle / (2.0 * std::acos(-1.0));
  }
  const ChartMesh chart = ChartOf(ramp);
  ASSERT_TRUE(chart.Check()) << chart.Check().Message();
  const BackMap map = Fit(chart, Params(1e-3));
  EXPECT_EQ(map.Stop, BackMapStop::Contradiction);
  EXPECT_NE(map.StopReason.find("lie on each other in the plane"), std::string::npos)
    << map.StopReason;
  EXPECT_LE(map.Surface.Space->NumFunctions, 1000);
  EXPECT_GE(map.MaxResidual, 0.24); // half of 0.5, but for the facets of the ramp
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
    [](BackMapParams& p) { p.MaxFunctions = 0; },
    [](BackMapParams& p) { p.FirstNet.resize(1); },
    [](BackMapParams& p) { p.FirstNet.assign(2, KnotVector::Uniform(2, 4, 0.0, 1.0)); },
    [](BackMapParams& p) { p.Effort = 0.0; },
    [](BackMapParams& p) { p.Effort = 1.1e6; },
    [&](BackMapParams& p) { p.Effort = nan; },
    [](BackMapParams& p) { p.LaterWork = -1.0; },
    [&](BackMapParams& p) { p.LaterWork = nan; },
    [](BackMapParams& p) { p.TimeLimit = -1.0; },
    [&](BackMapParams& p) { p.TimeLimit = nan; },
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
  EXPECT_EQ(code(
              [](BackMapParams& p)
              {
                p.Elements = 20;
                p.MaxFunctions = 100;
              }),
    ErrorCode::TooLarge);
  EXPECT_EQ(
    code([](BackMapParams& p) { p.Progress = [](double) { return false; }; }), ErrorCode::Aborted);
  for (BackMapMethod method : AllMethods)
  {
    EXPECT_EQ(code(
                [&](BackMapParams& p)
                {
                  p.Method = method;
                  p.Progress = [](double) { return false; };
                }),
      ErrorCode::Aborted);
  }
  // four corners of the rectangle are the whole grid, and lie in the margin
  for (const BackMapMethod method : { BackMapMethod::Nurbs, BackMapMethod::ContinuedLines })
  {
    EXPECT_EQ(code(
                [&](BackMapParams& p)
                {
                  p.Method = method;
                  p.Degree = 1;
                  p.Elements = 1;
                }),
      ErrorCode::SingularSystem);
  }
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
