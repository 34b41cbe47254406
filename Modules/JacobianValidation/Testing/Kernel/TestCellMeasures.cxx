// SPDX-License-Identifier: BSD-3-Clause
#include "CellMeasures.h"
#include "TestCells.h"

#include <cmath>
#include <limits>
#include <random>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
constexpr double pi = 3.14159265358979323846;
/// What the measures promise; the oracles' own rounding is far below.
constexpr double relative = 1e-12;

CellMeasures Measured(const BernsteinCells& cells, const CellMeasuresParams& params = {})
{
  auto result = MeasureCells(cells, params);
  EXPECT_TRUE(result) << result.Status.Message();
  return result.Value;
}

BernsteinCells Quad(const std::array<std::array<double, 2>, 4>& corners)
{
  BernsteinCells cells;
  cells.NumComponents = 2;
  cells.Add(CellShape::Quadrilateral, { 1, 1, 0 });
  for (std::size_t i = 0; i < 4; ++i)
  {
    cells.Block(0)[i] = corners[i][0];
    cells.Block(0)[4 + i] = corners[i][1];
  }
  return cells;
}
}

TEST(CellMeasures, AreaAndVolumeOfShapes_ExactOracle)
{
  ShapeParams s;
  s.InnerRadius = 0.4;
  s.OuterRadius = 1.3;
  s.Angle = 250.0;
  s.PolarAngle = 100.0;
  s.Height = 1.7;
  s.Twist = 60.0;
  s.Size = { 2.1, 1.5, 3.2 };
  s.Elements = { 2, 3, 1 };
  const double angle = s.Angle * pi / 180.0;
  const double r = s.InnerRadius;
  const double R = s.OuterRadius;
  const std::vector<std::tuple<ShapeKind, bool, double>> oracles = { { ShapeKind::Square, true,
                                                                       s.Size[0] * s.Size[1] },
    { ShapeKind::AnnulusSector, true, 0.5 * angle * (R * R - r * r) },
    { ShapeKind::Disc, true, pi * R * R },
    { ShapeKind::PlateWithHole, true, s.Size[0] * s.Size[1] - pi * r * r },
    { ShapeKind::Arc, true, R * angle }, { ShapeKind::Arc, false, R * angle },
    { ShapeKind::CylinderSurface, false, R * angle * s.Height },
    { ShapeKind::SphereSurface, false, 4.0 * pi * R * R },
    { ShapeKind::TorusSurface, false, angle * R * 2.0 * pi * r },
    { ShapeKind::Cube, false, s.Size[0] * s.Size[1] * s.Size[2] },
    { ShapeKind::SolidTube, false, 0.5 * angle * (R * R - r * r) * s.Height },
    { ShapeKind::SolidCylinder, false, pi * R * R * s.Height },
    { ShapeKind::BallSector, false,
      2.0 / 3.0 * angle * std::sin(s.PolarAngle * pi / 360.0) * (R * R * R - r * r * r) },
    { ShapeKind::Ball, false, 4.0 / 3.0 * pi * R * R * R },
    { ShapeKind::SolidTorus, false, angle * R * pi * r * r } };
  for (const auto& [kind, planar, exact] : oracles)
  {
    SCOPED_TRACE(ToString(kind));
    ShapeParams params = s;
    params.Kind = kind;
    const CellMeasures measures = Measured(MakeShapeCells(params, planar).Cells);
    EXPECT_NEAR(measures.Total.Measure, exact, relative * exact);
    EXPECT_TRUE(measures.Total.Converged);
    EXPECT_LE(measures.Total.MeasureError, 2.0 * relative * exact);
  }
}

TEST(CellMeasures, CentroidOfHalfAnnulus_ExactOracle)
{
  ShapeParams s;
  s.Kind = ShapeKind::AnnulusSector;
  s.Angle = 180.0;
  s.Center = { 100.0, -50.0, 0.0 };
  s.Elements = { 3, 2, 1 };
  const CellMeasures measures = Measured(MakeShapeCells(s, true).Cells);
  const double r = s.InnerRadius;
  const double R = s.OuterRadius;
  const double y = 4.0 / (3.0 * pi) * (R * R * R - r * r * r) / (R * R - r * r);
  EXPECT_NEAR(measures.Total.Centroid[0], 100.0, relative * 100.0);
  EXPECT_NEAR(measures.Total.Centroid[1], -50.0 + y, relative * 100.0);
  EXPECT_TRUE(std::isnan(measures.Total.Centroid[2]));
}

// A triangular map (x + a(y, z), y + b(z), z) keeps volumes; after it the affine map A with det A.
TEST(CellMeasures, VolumePreservingMapsOfAllShapes_ExactOracle)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const CellShape shape : AllCellShapes)
  {
    const int dim = NumParameters(shape);
    for (int p = 1; p <= 5; ++p)
    {
      SCOPED_TRACE(
        "shape " + std::to_string(static_cast<int>(shape)) + " degree " + std::to_string(p));
      Eigen::Matrix3d a = Eigen::Matrix3d::Identity();
      for (int i = 0; i < dim; ++i)
      {
        for (int j = 0; j < dim; ++j)
        {
          a(i, j) += 0.4 * uniform(random);
        }
      }
      const double s = uniform(random);
      const double t = uniform(random);
      BernsteinCells cells;
      cells.NumComponents = dim;
      AddInterpolant(cells, shape, UniformDegree(shape, p),
        [&](const std::array<double, 3>& u)
        {
          Eigen::Vector3d x(u[0] + (dim > 1 ? s * std::pow(u[1], p) + t * std::pow(u[2], p) : 0.0),
            u[1] + (dim > 2 ? t * std::pow(u[2], p) : 0.0), u[2]);
          x = a * x + Eigen::Vector3d(3.0, -2.0, 1.0);
          return std::array<double, 3>{ x[0], x[1], x[2] };
        });
      const double exact = ReferenceMeasure(shape) * a.determinant();
      const CellMeasures measures = Measured(cells);
      EXPECT_NEAR(measures.Cells[0].Measure, exact, relative * std::abs(exact));
      EXPECT_LE(std::abs(measures.Cells[0].Measure - exact),
        measures.Cells[0].MeasureError + 1e-13 * std::abs(exact));
      if (dim > 1)
      {
        EXPECT_NEAR(measures.Total.UniformityMin, 1.0, 1e-11);
        EXPECT_NEAR(measures.Total.UniformityMax, 1.0, 1e-11);
      }
    }
  }
}

// Centroid and volume of the image of a simplex under (x, y + x^2, z): integrals by hand.
TEST(CellMeasures, CentroidOfBentSimplices_ExactOracle)
{
  BernsteinCells triangle;
  triangle.NumComponents = 2;
  AddInterpolant(triangle, CellShape::Triangle, { 2, 2, 0 },
    [](const std::array<double, 3>& u) {
      return std::array<double, 3>{ u[0], u[1] + u[0] * u[0], 0.0 };
    });
  const CellMeasure t = Measured(triangle).Cells[0];
  EXPECT_NEAR(t.Centroid[0], 1.0 / 3.0, 1e-14);
  EXPECT_NEAR(t.Centroid[1], 1.0 / 3.0 + 1.0 / 6.0, 1e-14); // mean of x^2 is 2 (2! / 4!) = 1/6
  BernsteinCells tetrahedron;
  tetrahedron.NumComponents = 3;
  AddInterpolant(tetrahedron, CellShape::Tetrahedron, { 2, 2, 2 },
    [](const std::array<double, 3>& u) {
      return std::array<double, 3>{ u[0], u[1] + u[0] * u[0], u[2] };
    });
  const CellMeasure v = Measured(tetrahedron).Cells[0];
  EXPECT_NEAR(v.Measure, 1.0 / 6.0, 1e-15);
  EXPECT_NEAR(v.Centroid[1], 0.25 + 0.1, 1e-14); // mean of x^2 is 6 (2! / 5!) = 1/10
}

// The same map in a higher degree is integrated by a longer rule.
TEST(CellMeasures, DegreeElevationChangesNothing_PropertyOracle)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const CellShape shape : AllCellShapes)
  {
    const int dim = NumParameters(shape);
    for (int p = 1; p <= 3; ++p)
    {
      SCOPED_TRACE(
        "shape " + std::to_string(static_cast<int>(shape)) + " degree " + std::to_string(p));
      BernsteinCells cells;
      cells.NumComponents = dim;
      AddInterpolant(cells, shape, UniformDegree(shape, p),
        [&](const std::array<double, 3>& u)
        {
          return std::array<double, 3>{ u[0] + 0.2 * uniform(random), u[1] + 0.2 * uniform(random),
            u[2] + 0.2 * uniform(random) };
        });
      AddInterpolant(cells, shape, UniformDegree(shape, p + 3),
        [&](const std::array<double, 3>& u) { return EvaluateCell(cells, 0, u.data()).Position; });
      const CellMeasures measures = Measured(cells);
      // rounding of the interpolation's solve
      const double tolerance = 1e-12;
      EXPECT_NEAR(measures.Cells[0].Measure, measures.Cells[1].Measure, tolerance);
      for (std::size_t d = 0; d < static_cast<std::size_t>(dim); ++d)
      {
        EXPECT_NEAR(measures.Cells[0].Centroid[d], measures.Cells[1].Centroid[d], 10.0 * tolerance);
      }
    }
  }
}

// w_i c^i is a reparameterization: the same quarter annulus with weights over five decades.
TEST(CellMeasures, ExtremeWeightsOfTheSameAnnulus_ExactOracle)
{
  ShapeParams s;
  s.Kind = ShapeKind::AnnulusSector;
  for (const double c : { 0.03, 3.0, 30.0, 300.0 })
  {
    SCOPED_TRACE(c);
    BernsteinCells cells = MakeShapeCells(s, true).Cells;
    const CellDegree degree = cells.Degrees[0];
    const int n = NumCellCoefficients(cells.Shapes[0], degree);
    for (int i = 0; i < n; ++i)
    {
      const int power = degree[0] == 2 ? i % 3 : i / (degree[0] + 1);
      for (int plane = 0; plane < cells.NumPlanes(); ++plane)
      {
        cells.Block(0)[plane * n + i] *= std::pow(c, power);
      }
    }
    const double exact = pi / 4.0 * 0.75;
    const CellMeasures measures = Measured(cells);
    EXPECT_NEAR(measures.Total.Measure, exact, relative * exact);
    EXPECT_TRUE(measures.Total.Converged);
  }
}

TEST(CellMeasures, FoldedQuadrilateralIsTheShoelaceArea_ExactOracle)
{
  const CellMeasures bow = Measured(Quad({ { { 0., 0. }, { 1., 0. }, { 1., 1. }, { 0., 1. } } }));
  EXPECT_NEAR(bow.Total.Measure, 0.0, 1e-15);
  const CellMeasures reversed =
    Measured(Quad({ { { 0., 0. }, { 0., 2. }, { 3., 0. }, { 3., 2. } } }));
  EXPECT_NEAR(reversed.Total.Measure, -6.0, 1e-14);
  EXPECT_NEAR(reversed.Total.ScaledMax, -1.0, 1e-15);
}

TEST(CellMeasures, QualityOfAffineMaps_ExactOracle)
{
  const double angle = 0.7;
  const CellMeasure skew =
    Measured(Quad({ { { 0., 0. }, { 2., 0. }, { 3. * std::cos(angle), 3. * std::sin(angle) },
               { 2. + 3. * std::cos(angle), 3. * std::sin(angle) } } }))
      .Cells[0];
  EXPECT_NEAR(skew.ScaledMin, std::sin(angle), 1e-14);
  EXPECT_NEAR(skew.ScaledMax, std::sin(angle), 1e-14);
  EXPECT_NEAR(skew.ScaledMean, std::sin(angle), 1e-14);
  EXPECT_LE(skew.ScaledLower, std::sin(angle));
  EXPECT_GE(skew.ScaledLower, std::sin(angle) - 1e-10);
  // (4 + 9) / (2 * 2 * 3 sin)
  EXPECT_NEAR(skew.ConditionMax, 13.0 / (12.0 * std::sin(angle)), 1e-13);
  BernsteinCells box;
  box.NumComponents = 3;
  AddInterpolant(box, CellShape::Hexahedron, { 2, 1, 1 },
    [](const std::array<double, 3>& u) {
      return std::array<double, 3>{ 2. * u[0], 3. * u[1], 6. * u[2] };
    });
  // |J|^2 = 4 + 9 + 36 = 49, |J^-1|^2 = 1/4 + 1/9 + 1/36 = 14/36
  EXPECT_NEAR(Measured(box).Total.ConditionMean, 7.0 * std::sqrt(14.0) / 18.0, 1e-13);
}

TEST(CellMeasures, BoundOfScaledJacobianIsBelowDenseSamples_PropertyOracle)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (const CellShape shape : AllCellShapes)
  {
    const int dim = NumParameters(shape);
    for (int rational = 0; rational < 2; ++rational)
    {
      SCOPED_TRACE(
        "shape " + std::to_string(static_cast<int>(shape)) + (rational ? " rational" : ""));
      BernsteinCells cells;
      cells.NumComponents = dim;
      for (int i = 0; i < 4; ++i)
      {
        AddInterpolant(cells, shape, UniformDegree(shape, 2),
          [&](const std::array<double, 3>& u)
          {
            return std::array<double, 3>{ u[0] + 0.04 * uniform(random),
              u[1] + 0.04 * uniform(random), u[2] + 0.04 * uniform(random) };
          });
      }
      if (rational)
      {
        BernsteinCells weighted;
        weighted.NumComponents = dim;
        weighted.Rational = true;
        Append(weighted, cells);
        for (int c = 0; c < 4; ++c)
        {
          const int n = NumCellCoefficients(shape, weighted.Degrees[0]);
          for (int i = 0; i < n; ++i)
          {
            const double w = std::exp(0.3 * uniform(random));
            for (int plane = 0; plane <= dim; ++plane)
            {
              weighted.Block(c)[plane * n + i] *= w;
            }
          }
        }
        cells = weighted;
      }
      CellMeasuresParams params;
      params.BoundBoxes = 1024;
      const CellMeasures measures = Measured(cells, params);
      params.SamplesPerEdge = 25;
      params.BoundBoxes = 0;
      const CellMeasures dense = Measured(cells, params);
      for (std::size_t c = 0; c < 4; ++c)
      {
        EXPECT_LE(measures.Cells[c].ScaledLower, dense.Cells[c].ScaledMin + 1e-12);
        // first order in the size of the boxes, of which volumes have few along an edge
        EXPECT_GE(measures.Cells[c].ScaledLower,
          dense.Cells[c].ScaledMin -
            (dim < 3       ? 0.1
                : rational ? 1.2
                           : 0.7));
      }
    }
  }
}

TEST(CellMeasures, ThreadsGiveTheSameBits_PropertyOracle)
{
  ShapeParams s;
  s.Kind = ShapeKind::Ball;
  s.Elements = { 3, 3, 3 };
  const BernsteinCells cells = MakeShapeCells(s).Cells;
  CellMeasuresParams params;
  params.Threads = 1;
  const CellMeasures one = Measured(cells, params);
  params.Threads = 4;
  const CellMeasures four = Measured(cells, params);
  ASSERT_EQ(one.Cells.size(), four.Cells.size());
  EXPECT_EQ(one.Total.Measure, four.Total.Measure);
  for (std::size_t c = 0; c < one.Cells.size(); ++c)
  {
    EXPECT_EQ(one.Cells[c].Measure, four.Cells[c].Measure);
    EXPECT_EQ(one.Cells[c].ScaledLower, four.Cells[c].ScaledLower);
  }
}

TEST(CellMeasures, EveryFailureIsReachable)
{
  const BernsteinCells quad = Quad({ { { 0., 0. }, { 1., 0. }, { 0., 1. }, { 1., 1. } } });
  const auto code = [](const BernsteinCells& cells, const CellMeasuresParams& params = {})
  { return MeasureCells(cells, params).Status.Code; };
  EXPECT_EQ(code(quad), ErrorCode::Ok);
  EXPECT_EQ(code(BernsteinCells{}), ErrorCode::EmptyInput);
  BernsteinCells bad = quad;
  bad.Block(0)[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code(bad), ErrorCode::NonFiniteInput);
  bad = quad;
  bad.Add(CellShape::Hexahedron, { 1, 1, 1 });
  EXPECT_EQ(code(bad), ErrorCode::DimensionMismatch);
  bad = {};
  bad.NumComponents = 1;
  bad.Add(CellShape::Triangle, { 1, 1, 0 });
  EXPECT_EQ(code(bad), ErrorCode::DimensionMismatch);
  const auto with = [&](auto change)
  {
    CellMeasuresParams params;
    change(params);
    return code(quad, params);
  };
  using P = CellMeasuresParams;
  EXPECT_EQ(with([](P& p) { p.Tolerance = 0.0; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](P& p) { p.MaxDepth = 61; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](P& p) { p.SamplesPerEdge = 1; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](P& p) { p.BoundBoxes = -1; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](P& p) { p.Threads = -1; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](P& p) { p.ParametricVolumes = { 0.0 }; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](P& p) { p.ParametricVolumes = { 1.0, 1.0 }; }), ErrorCode::SizeMismatch);
}
