// SPDX-License-Identifier: BSD-3-Clause
#include "MeshCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/MeshSpline.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace knotwork;
using namespace meshes;

namespace
{
template <int Dim>
UnstructuredResult<Dim> Make(const CellMesh<Dim>& mesh, const UnstructuredParams& params)
{
  auto made = MakeUnstructuredSpace<Dim>(mesh, params);
  EXPECT_TRUE(made) << made.Status.Message();
  return std::move(made.Value);
}

template <int Dim>
UnstructuredResult<Dim> Make(const CellMesh<Dim>& mesh, int degree)
{
  UnstructuredParams params;
  params.Degree = degree;
  return Make<Dim>(mesh, params);
}

/// Values at random places of cells.
template <int Dim>
PointMatrix RandomValues(const Spline<Dim>& spline, Random& random, int count,
  std::vector<int>& elements, PointMatrix& local)
{
  elements.clear();
  local.resize(count, Dim);
  for (int i = 0; i < count; ++i)
  {
    elements.push_back(random.Int(0, spline.Space->NumElements() - 1));
    for (int d = 0; d < Dim; ++d)
    {
      local(i, d) = random.Unit();
    }
  }
  EvaluationBatch batch;
  EXPECT_TRUE(EvaluateElements<Dim>(MakeBezierForm(spline, 1), elements, local, {}, batch));
  return batch.Values;
}

/// The parameters of points on a grid: sums of intervals.
template <int Dim>
std::array<std::vector<double>, Dim> Breaks(const std::array<int, Dim>& n, Random& random)
{
  std::array<std::vector<double>, Dim> breaks;
  for (int d = 0; d < Dim; ++d)
  {
    breaks[d].assign(1, 0.0);
    for (int i = 0; i < n[d]; ++i)
    {
      breaks[d].push_back(breaks[d].back() + random.In(0.5, 2.0));
    }
  }
  return breaks;
}

/// Intervals of the sheets of a grid.
template <int Dim>
std::vector<double> Lengths(const CellMesh<Dim>& mesh, const std::array<int, Dim>& n,
  const std::array<std::vector<double>, Dim>& breaks)
{
  const auto sheets = MeshTopology<Dim>::Make(mesh)->FindSheets();
  std::vector<double> lengths(static_cast<std::size_t>(sheets.Count));
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    for (int d = 0, rest = c; d < Dim; rest /= n[d], ++d)
    {
      const int i = rest % n[d];
      lengths[static_cast<std::size_t>(sheets.Of[static_cast<std::size_t>(c * Dim + d)])] =
        breaks[d][i + 1] - breaks[d][i];
    }
  }
  return lengths;
}

/// Components of degree p in every parameter.
template <int Dim>
Eigen::RowVector3d Polynomial(const std::vector<double>& coefficients, int p, const double* x)
{
  Eigen::RowVector3d value = Eigen::RowVector3d::Zero();
  IntArray<Dim> power{};
  for (std::size_t i = 0; i + 2 < coefficients.size(); i += 3)
  {
    double term = 1.0;
    for (int d = 0; d < Dim; ++d)
    {
      term *= std::pow(x[d] / 4.0, power[d]);
    }
    value += term * Eigen::RowVector3d(coefficients[i], coefficients[i + 1], coefficients[i + 2]);
    for (int d = 0; d < Dim && ++power[d] > p; ++d)
    {
      power[d] = 0;
    }
  }
  return value;
}

template <int Dim>
void ExpectPolynomials(const std::array<int, Dim>& n, int p, Random& random)
{
  const CellMesh<Dim> mesh = Grid<Dim>(n);
  const auto breaks = Breaks<Dim>(n, random);
  UnstructuredParams params;
  params.Degree = p;
  params.Lengths = Lengths<Dim>(mesh, n, breaks);
  const auto made = Make<Dim>(mesh, params);
  std::vector<double> coefficients(static_cast<std::size_t>(3 * std::pow(p + 1, Dim)));
  for (double& c : coefficients)
  {
    c = random.In(-1.0, 1.0);
  }
  PointMatrix points(mesh.NumPoints, 3);
  for (int i = 0; i < mesh.NumPoints; ++i)
  {
    double x[Dim];
    for (int d = 0, rest = i; d < Dim; rest /= n[d] + 1, ++d)
    {
      x[d] = breaks[d][rest % (n[d] + 1)];
    }
    points.row(i) = Polynomial<Dim>(coefficients, p, x);
  }
  const auto spline = SplineThroughVertices<Dim>(made.Space, points, 1);
  ASSERT_TRUE(spline) << spline.Status.Message();
  std::vector<int> elements;
  PointMatrix local;
  const PointMatrix values = RandomValues<Dim>(spline.Value, random, 100, elements, local);
  // rounding grows with the interpolation of p + 2 degrees and the dual functionals
  const double tolerance = 1e-9 * points.cwiseAbs().maxCoeff();
  for (int i = 0; i < values.rows(); ++i)
  {
    double x[Dim];
    for (int d = 0, rest = elements[i]; d < Dim; rest /= n[d], ++d)
    {
      const int k = rest % n[d];
      x[d] = breaks[d][k] + local(i, d) * (breaks[d][k + 1] - breaks[d][k]);
    }
    EXPECT_LE(
      (values.row(i) - Polynomial<Dim>(coefficients, p, x)).cwiseAbs().maxCoeff(), tolerance);
  }
  EXPECT_LE(DistanceFromVertices<Dim>(spline.Value, points, 1).Largest, tolerance);
}

struct SphereErrors
{
  double Distance; ///< of random points from the sphere, root of the mean square
  double Vertices;
  double Angle;
};

SphereErrors FitSphere(int n, int p, CreasePolicy policy = CreasePolicy::Full)
{
  const CellMesh<2> mesh = CubeSphere(n);
  const PointMatrix points = CubeSpherePoints(mesh, n);
  UnstructuredParams params;
  params.Degree = p;
  params.Policy = policy;
  const auto spline = SplineThroughVertices<2>(Make<2>(mesh, params).Space, points, 1);
  EXPECT_TRUE(spline) << spline.Status.Message();
  Random random(7);
  std::vector<int> elements;
  PointMatrix local;
  const PointMatrix values = RandomValues<2>(spline.Value, random, 2000, elements, local);
  return { std::sqrt((values.rowwise().norm().array() - 1.0).square().mean()),
    DistanceFromVertices<2>(spline.Value, points, 1).Largest,
    LargestCreaseAngle(spline.Value, {}, 1) };
}
}

TEST(MeshSpline, PolynomialsOnGridsAreReproduced_ExactOracle)
{
  Random random(1);
  for (int p = 2; p <= 5; ++p)
  {
    SCOPED_TRACE("degree " + std::to_string(p));
    ExpectPolynomials<2>({ p, p + 3 }, p, random);
    ExpectPolynomials<2>({ 2 * p + 4, p + 1 }, p, random);
  }
  ExpectPolynomials<2>({ 4, 3 }, 1, random);
  ExpectPolynomials<3>({ 2, 5, 4 }, 2, random);
  ExpectPolynomials<3>({ 4, 3, 6 }, 3, random);
}

TEST(MeshSpline, SpheresConvergeByTheOrderOfTheSpace_PublishedOracle)
{
  // order p + 1; limits of angles are those of a prototype of the same construction
  for (int p = 1; p <= 4; ++p)
  {
    SCOPED_TRACE("degree " + std::to_string(p));
    const SphereErrors coarse = FitSphere(8, p);
    const SphereErrors fine = FitSphere(16, p);
    EXPECT_GE(std::log2(coarse.Distance / fine.Distance), p + 0.9);
    EXPECT_LE(fine.Angle, coarse.Angle / 1.8);
    EXPECT_LE(fine.Vertices, p == 1 ? 1e-14 : coarse.Vertices / 6.5);
  }
  EXPECT_LE(FitSphere(16, 2).Angle, 0.35);
  EXPECT_LE(FitSphere(8, 3).Angle, 0.06);
  EXPECT_LE(FitSphere(16, 3).Angle, 0.006);
}

TEST(MeshSpline, CagesOfGridsAreControlPointsAtGrevillePoints_ExactOracle)
{
  Random random(3);
  for (int p = 1; p <= 5; ++p)
  {
    const std::array<int, 2> n{ p + 1, p + 4 };
    const CellMesh<2> mesh = Grid<2>(n);
    const auto breaks = Breaks<2>(n, random);
    UnstructuredParams params;
    params.Degree = p;
    params.Lengths = Lengths<2>(mesh, n, breaks);
    const auto space = Make<2>(mesh, params).Space;
    PointMatrix points(mesh.NumPoints, 2); // the parameters themselves
    for (int i = 0; i < mesh.NumPoints; ++i)
    {
      points.row(i) << breaks[0][i % (n[0] + 1)], breaks[1][i / (n[0] + 1)];
    }
    const auto spline = SplineOfCage<2>(space, points);
    ASSERT_TRUE(spline) << spline.Status.Message();
    // linear precision: only Greville points reproduce parameters
    std::vector<int> elements;
    PointMatrix local;
    const PointMatrix values = RandomValues<2>(spline.Value, random, 100, elements, local);
    for (int i = 0; i < values.rows(); ++i)
    {
      for (int d = 0; d < 2; ++d)
      {
        const int k = d == 0 ? elements[i] % n[0] : elements[i] / n[0];
        const double x = breaks[d][k] + local(i, d) * (breaks[d][k + 1] - breaks[d][k]);
        EXPECT_NEAR(values(i, d), x, 1e-12);
      }
    }
  }
}

TEST(MeshSpline, CagesOfOddDegreeAreVerticesAndOfEvenDegreeCentres_ExactOracle)
{
  const CellMesh<2> mesh = Grid<2>({ 9, 9 }, { true, true });
  Random random(5);
  PointMatrix points(mesh.NumPoints, 3);
  for (double& x : points.reshaped())
  {
    x = random.In(-1.0, 1.0);
  }
  for (const int p : { 2, 3 })
  {
    std::vector<int> smooth(static_cast<std::size_t>(mesh.NumCells()) * 4, p - 1);
    const auto space = MakeUnstructuredSpace<2>(mesh, p, smooth);
    ASSERT_TRUE(space) << space.Status.Message();
    const auto spline = SplineOfCage<2>(space.Value, points);
    ASSERT_TRUE(spline) << spline.Status.Message();
    ASSERT_EQ(spline->ControlPoints.rows(), mesh.NumPoints);
    PointMatrix expected = points;
    for (int c = 0; p == 2 && c < mesh.NumCells(); ++c)
    {
      expected.row(c).setZero();
      for (int corner = 0; corner < 4; ++corner)
      {
        expected.row(c) += 0.25 * points.row(mesh.Cell(c)[corner]);
      }
    }
    std::vector<char> found(static_cast<std::size_t>(expected.rows()), 0); // in any order
    for (int f = 0; f < spline->ControlPoints.rows(); ++f)
    {
      Eigen::Index nearest = 0;
      EXPECT_LE(
        (expected.rowwise() - spline->ControlPoints.row(f)).rowwise().norm().minCoeff(&nearest),
        1e-14);
      ++found[static_cast<std::size_t>(nearest)];
    }
    EXPECT_EQ(std::count(found.begin(), found.end(), 1), expected.rows());
  }
}

TEST(MeshSpline, RandomMeshesHaveSplinesWithinTheirVertices_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 60; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const CellMesh<2> mesh = RandomMesh<2>(random, 60);
    UnstructuredParams params;
    params.Degree = random.Int(1, 4);
    params.Policy = static_cast<CreasePolicy>(random.Int(0, 3));
    const auto space = Make<2>(mesh, params).Space;
    PointMatrix points(mesh.NumPoints, 4);
    for (double& x : points.reshaped())
    {
      x = random.In(-1.0, 1.0);
    }
    points.col(3).setConstant(2.5);
    const auto cage = SplineOfCage<2>(space, points);
    ASSERT_TRUE(cage) << cage.Status.Message();
    EXPECT_LE(cage->ControlPoints.leftCols(3).cwiseAbs().maxCoeff(), 1.0);
    const auto through = SplineThroughVertices<2>(space, points, 2);
    ASSERT_TRUE(through) << through.Status.Message();
    // constants pass; rounding of windows of up to six vertices
    EXPECT_LE((through->ControlPoints.col(3).array() - 2.5).abs().maxCoeff(), 1e-11);
    EXPECT_LE((cage->ControlPoints.col(3).array() - 2.5).abs().maxCoeff(), 1e-14);
    EXPECT_EQ(through->ControlPoints, SplineThroughVertices<2>(space, points, 1)->ControlPoints);
    if (params.Degree == 1)
    {
      EXPECT_LE(DistanceFromVertices<2>(through.Value, points, 1).Largest, 1e-13);
      EXPECT_LE(DistanceFromVertices<2>(cage.Value, points, 1).Largest, 1e-14);
    }
  }
}

TEST(MeshSpline, AnglesBetweenNormalsAreThoseOfBentSheets_ExactOracle)
{
  // a strip of 6 x 2 cells bent by 30 degrees in the middle, where it is C^0
  const CellMesh<2> mesh = Grid<2>({ 6, 2 });
  PointMatrix points(mesh.NumPoints, 3);
  const double bend = static_cast<double>(EIGEN_PI) / 6.0;
  for (int i = 0; i < mesh.NumPoints; ++i)
  {
    const double x = i % 7 - 3.0;
    points.row(i) << (x < 0.0 ? x : x * std::cos(bend)), i / 7,
      (x < 0.0 ? 0.0 : x * std::sin(bend));
  }
  UnstructuredParams params;
  params.Features = { { 2, 1 }, { 8, 1 } };
  const auto made = Make<2>(mesh, params);
  const auto spline = SplineThroughVertices<2>(made.Space, points);
  ASSERT_TRUE(spline) << spline.Status.Message();
  EXPECT_NEAR(LargestCreaseAngle(spline.Value), 30.0, 1e-9);
  EXPECT_EQ(LargestCreaseAngle(spline.Value, params.Features), 0.0);
  EXPECT_EQ(LargestCreaseAngle(spline.Value, { { 3, 0 }, { 9, 0 } }), 0.0);
  EXPECT_LE(DistanceFromVertices<2>(spline.Value, points).Largest, 1e-13);
}

TEST(MeshSpline, NormalsOfStripsThatCannotBeOrientedAreCompared_ExactOracle)
{
  // 48 flat cells turn by 7.5 degrees each around the circle and by half of that about it
  const CellMesh<2> strip = Twisted(48, 1, false);
  const auto made = Make<2>(strip, 1);
  EXPECT_FALSE(made.IsOrientable);
  const auto spline = SplineThroughVertices<2>(made.Space, MoebiusPoints(strip, 48));
  ASSERT_TRUE(spline) << spline.Status.Message();
  const double angle = LargestCreaseAngle(spline.Value);
  EXPECT_GT(angle, 3.0);
  EXPECT_LT(angle, 15.0);
}

TEST(MeshSpline, EveryFailureIsReachable_ExactOracle)
{
  const CellMesh<2> mesh = Grid<2>({ 3, 2 });
  const auto space = Make<2>(mesh, 2).Space;
  PointMatrix points = PointMatrix::Random(mesh.NumPoints, 3);
  const auto codes = [](const SplineSpacePtr<2>& s, const PointMatrix& x)
  {
    return std::array{ SplineThroughVertices<2>(s, x).Status.Code,
      SplineOfCage<2>(s, x).Status.Code };
  };
  const auto both = [](ErrorCode code) { return std::array{ code, code }; };
  EXPECT_EQ(codes(nullptr, points), both(ErrorCode::EmptyInput));
  EXPECT_EQ(codes(space, points.topRows(5)), both(ErrorCode::SizeMismatch));
  EXPECT_EQ(codes(space, PointMatrix(mesh.NumPoints, 0)), both(ErrorCode::SizeMismatch));
  const KnotVector knots = KnotVector::Uniform(2, 3, 0.0, 1.0);
  EXPECT_EQ(
    codes(MakeTensorSpace<2>({ knots, knots }).Value, points), both(ErrorCode::DimensionMismatch));
  points(4, 1) = std::nan("");
  EXPECT_EQ(codes(space, points), both(ErrorCode::NonFiniteInput));
  EXPECT_EQ(SplineOfCage<2>(space, points).Status.Detail, "vertex 4");
  points(4, 1) = 0.0;
  EXPECT_EQ(SplineThroughVertices<2>(space, points, 1, [](double) { return false; }).Status.Code,
    ErrorCode::Aborted);
}
