// SPDX-License-Identifier: BSD-3-Clause
#include "TestCells.h"
#include <knotwork/JacobianValidation/CellMeasures.h>
#include <knotwork/SplineCore/Quadrature.h>

#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <random>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
constexpr double Pi = 3.14159265358979323846;
/// What the measures promise; the oracles' own rounding is far below.
constexpr double Relative = 1e-12;

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
  const double angle = s.Angle * Pi / 180.0;
  const double r = s.InnerRadius;
  const double R = s.OuterRadius;
  const std::vector<std::tuple<ShapeKind, bool, double>> oracles = { { ShapeKind::Square, true,
                                                                       s.Size[0] * s.Size[1] },
    { ShapeKind::AnnulusSector, true, 0.5 * angle * (R * R - r * r) },
    { ShapeKind::Disc, true, Pi * R * R },
    { ShapeKind::PlateWithHole, true, s.Size[0] * s.Size[1] - Pi * r * r },
    { ShapeKind::Arc, true, R * angle }, { ShapeKind::Arc, false, R * angle },
    { ShapeKind::CylinderSurface, false, R * angle * s.Height },
    { ShapeKind::SphereSurface, false, 4.0 * Pi * R * R },
    { ShapeKind::TorusSurface, false, angle * R * 2.0 * Pi * r },
    { ShapeKind::Cube, false, s.Size[0] * s.Size[1] * s.Size[2] },
    { ShapeKind::SolidTube, false, 0.5 * angle * (R * R - r * r) * s.Height },
    { ShapeKind::SolidCylinder, false, Pi * R * R * s.Height },
    { ShapeKind::BallSector, false,
      2.0 / 3.0 * angle * std::sin(s.PolarAngle * Pi / 360.0) * (R * R * R - r * r * r) },
    { ShapeKind::Ball, false, 4.0 / 3.0 * Pi * R * R * R },
    { ShapeKind::SolidTorus, false, angle * R * Pi * r * r } };
  for (const auto& [kind, planar, exact] : oracles)
  {
    SCOPED_TRACE(ToString(kind));
    ShapeParams params = s;
    params.Kind = kind;
    const CellMeasures measures = Measured(MakeShapeCells(params, planar).Cells);
    EXPECT_NEAR(measures.Total.Measure, exact, Relative * exact);
    EXPECT_TRUE(measures.Total.Converged);
    EXPECT_LE(measures.Total.MeasureError, 2.0 * Relative * exact);
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
  const double y = 4.0 / (3.0 * Pi) * (R * R * R - r * r * r) / (R * R - r * r);
  EXPECT_NEAR(measures.Total.Centroid[0], 100.0, Relative * 100.0);
  EXPECT_NEAR(measures.Total.Centroid[1], -50.0 + y, Relative * 100.0);
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
      EXPECT_NEAR(measures.Cells[0].Measure, exact, Relative * std::abs(exact));
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
    const double exact = Pi / 4.0 * 0.75;
    const CellMeasures measures = Measured(cells);
    EXPECT_NEAR(measures.Total.Measure, exact, Relative * exact);
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

// A rational map of degree 1 of a simplex is a reparameterization of the simplex of its vertices.
TEST(CellMeasures, LinearSimplicesOfAnyWeights_ExactOracle)
{
  std::mt19937 random(23);
  for (const CellShape shape : { CellShape::Triangle, CellShape::Tetrahedron })
  {
    const int dim = NumParameters(shape);
    BernsteinCells cells;
    cells.NumComponents = dim;
    cells.Rational = true;
    for (int i = 0; i < 50; ++i)
    {
      AddRandomCell(cells, shape, 1, 0.3, 3.0, i, random);
    }
    const CellMeasures measures = Measured(cells);
    for (int c = 0; c < cells.NumCells(); ++c)
    {
      SCOPED_TRACE("cell " + std::to_string(c) + " of " + std::to_string(dim) + " parameters");
      const double* block = cells.Block(c);
      const int n = dim + 1;
      Eigen::MatrixXd vertices(dim, n);
      for (int i = 0; i < n; ++i)
      {
        for (int d = 0; d < dim; ++d)
        {
          vertices(d, i) = block[d * n + i] / block[dim * n + i];
        }
      }
      const double exact = (vertices.rightCols(dim).colwise() - vertices.col(0)).determinant() *
        ReferenceMeasure(shape);
      const CellMeasure& m = measures.Cells[static_cast<std::size_t>(c)];
      // vertices as far from the origin as 50 are rounded by 1e-14
      const double tolerance = Relative * std::abs(exact) + 1e-13;
      EXPECT_TRUE(m.Converged);
      EXPECT_NEAR(m.Measure, exact, tolerance);
      for (int d = 0; d < dim; ++d)
      {
        EXPECT_NEAR(
          m.Centroid[static_cast<std::size_t>(d)], vertices.row(d).mean(), 3.0 * tolerance / exact);
      }
    }
  }
}

// det J by rules of 40 points a direction over the whole cell, through the chain of EvaluateCell:
// converged for weights from 1/3 to 3, and neither by sides nor by pieces.
TEST(CellMeasures, RandomRationalCellsOfAllShapes_CrossOracle)
{
  std::mt19937 random(29);
  const QuadratureRule rule = GaussLegendre(40);
  for (const CellShape shape : AllCellShapes)
  {
    const int dim = NumParameters(shape);
    for (const int components : { dim, 3 })
    {
      if (dim == 1 && components == 1)
      {
        continue; // the difference of its ends
      }
      for (int p = 1; p <= 2; ++p)
      {
        SCOPED_TRACE("shape " + std::to_string(static_cast<int>(shape)) + " degree " +
          std::to_string(p) + " components " + std::to_string(components));
        BernsteinCells cells;
        cells.NumComponents = components;
        cells.Rational = true;
        // folds included
        AddRandomCell(cells, shape, p, 0.1, 0.5, 0.0, random);
        AddRandomCell(cells, shape, p, components == dim ? 0.6 : 0.1, 0.3, 0.0, random);
        const CellMeasures measures = Measured(cells);
        for (int c = 0; c < 2; ++c)
        {
          double sum = 0.0;
          Eigen::Vector3d moment = Eigen::Vector3d::Zero();
          double absolute = 0.0;
          const std::size_t n = rule.Nodes.size();
          for (std::size_t at = 0; at < (dim == 1 ? n : dim == 2 ? n * n : n * n * n); ++at)
          {
            std::array<double, 3> u{ rule.Nodes[at % n], dim > 1 ? rule.Nodes[at / n % n] : 0.0,
              dim > 2 ? rule.Nodes[at / n / n] : 0.0 };
            double weight = rule.Weights[at % n] * (dim > 1 ? rule.Weights[at / n % n] : 1.0) *
              (dim > 2 ? rule.Weights[at / n / n] : 1.0);
            if (shape == CellShape::Tetrahedron)
            {
              weight *= (1.0 - u[0]) * (1.0 - u[0]) * (1.0 - u[1]);
              u = { u[0], u[1] * (1.0 - u[0]), u[2] * (1.0 - u[0]) * (1.0 - u[1]) };
            }
            else if (shape == CellShape::Triangle || shape == CellShape::Wedge)
            {
              weight *= 1.0 - u[0];
              u[1] *= 1.0 - u[0];
            }
            const CellPoint point = EvaluateCell(cells, c, u.data());
            Eigen::Matrix3d j = Eigen::Matrix3d::Identity();
            for (int d = 0; d < dim; ++d)
            {
              j.col(d) = Eigen::Vector3d(point.Derivative[static_cast<std::size_t>(d)].data());
            }
            const double det = dim == components ? j.topLeftCorner(dim, dim).determinant()
              : dim == 2                         ? j.col(0).cross(j.col(1)).norm()
                                                 : j.col(0).norm();
            sum += weight * det;
            absolute += weight * std::abs(det);
            moment += weight * det * Eigen::Vector3d(point.Position.data());
          }
          const CellMeasure& m = measures.Cells[static_cast<std::size_t>(c)];
          // what the reference itself leaves for such weights, and the roots of surfaces
          const double tolerance = (dim == components ? 1e-11 : 1e-8) * absolute + m.MeasureError;
          EXPECT_NEAR(m.Measure, sum, tolerance);
          for (int d = 0; d < components; ++d)
          {
            EXPECT_NEAR(
              m.Centroid[static_cast<std::size_t>(d)] * m.Measure, moment[d], 3.0 * tolerance);
          }
        }
      }
    }
  }
}

// Whatever the weights, the effort is bounded, and what is said of the error is true of what
// twenty times the effort finds.
TEST(CellMeasures, EffortIsBoundedAndTheErrorKnown_PropertyOracle)
{
  std::mt19937 random(31);
  for (const CellShape shape : AllCellShapes)
  {
    const int dim = NumParameters(shape);
    for (const int components : { dim, 3 })
    {
      if (components < 2)
      {
        continue;
      }
      for (int p = 1; p <= 3; ++p)
      {
        BernsteinCells cells;
        cells.NumComponents = components;
        cells.Rational = true;
        for (int i = 0; i < 4; ++i)
        {
          AddRandomCell(cells, shape, p, 0.2, i % 2 == 0 ? 3.0 : 1.0, 0.0, random);
        }
        CellMeasuresParams params;
        params.BoundBoxes = 0;
        const CellMeasures measures = Measured(cells, params);
        CellMeasuresParams more = params;
        more.MaxPoints = 20 * params.MaxPoints;
        const CellMeasures reference = Measured(cells, more);
        for (std::size_t c = 0; c < measures.Cells.size(); ++c)
        {
          SCOPED_TRACE("shape " + std::to_string(static_cast<int>(shape)) + " degree " +
            std::to_string(p) + " components " + std::to_string(components) + " cell " +
            std::to_string(c));
          const CellMeasure& m = measures.Cells[c];
          const CellMeasure& r = reference.Cells[c];
          // the last halving makes two pieces of at most 32 x 32 points
          EXPECT_LE(m.Points, params.MaxPoints + 2 * 32 * 32);
          EXPECT_NEAR(m.Measure, r.Measure, m.MeasureError + r.MeasureError);
          if (m.Converged)
          {
            EXPECT_LE(m.MeasureError,
              1e-12 * std::abs(m.Measure) + 1e-13 * std::abs(reference.Total.Measure));
          }
        }
      }
    }
  }
}

// A wedge of random weights from 1e-3 to 1e3, with a layer between the points of the first rules
// that holds a part of the volume; a rule's estimate alone overlooks it. The volume is that of the
// trapezoidal rule in the logistic variable, det(x, x_s, x_t) / 3 over the faces, steps 0.2 and
// 0.1.
TEST(CellMeasures, LayerBetweenThePointsOfARule_CrossOracle)
{
  const double coefficients[18][4] = { { 3.4672790947871539e-05, -0.00015359941839620275,
                                         0.010555412767666814, 0.0017514572877940944 },
    { 24.677180032880699, 1.9766347031940017, 310.48999876142693, 51.431073167185119 },
    { 199.62192712991035, -4.2312275515898961, 1182.8318007320422, 196.32302348448974 },
    { 0.25074976914845931, 18.629037825991041, 195.39051470565099, 33.052461957172575 },
    { 0.40354458174343, 0.47872413429680882, 5.7225776900898211, 0.95709237311484996 },
    { -9.7417439595179101, 152.23094769771458, 991.31581833812209, 164.34596343741842 },
    { -23.469225112956437, 55.887569766760798, 5510.9075228913634, 844.71407472612282 },
    { 265.82123953643793, 42.329072685753538, 3511.2768232269532, 534.05698357865231 },
    { 17.074115531314437, -1.2576941468421192, 114.09624615005347, 17.381200150441234 },
    { 0.64742036672545433, 26.490018418817193, 346.92002922049301, 53.209206362165126 },
    { 125.80153351544399, 100.7119459170199, 1578.2878203447567, 239.80433702656987 },
    { -0.027439777239682713, 0.25705082556470382, 1.866514868705881, 0.28553268757089617 },
    { 0.00019315534339769483, 0.00022927737140215242, 0.018289077821794709, 0.0026289590683375901 },
    { 0.0045979199222999975, 0.0010091704188725653, 0.071463942494180741, 0.01013544272515929 },
    { 0.0014257478427642692, 3.116033240614593e-05, 0.011043187458388256, 0.0015558811724812292 },
    { -0.034058274326381352, 0.22067509306838656, 3.1624286825831707, 0.45364641913518888 },
    { 460.3448352532327, 408.50469920037534, 6412.5674021803889, 907.79544969261008 },
    { 0.00012079179249439345, 0.0015164824724195405, 0.010342385146535378,
      0.0014742600511707029 } };
  BernsteinCells cells;
  cells.NumComponents = 3;
  cells.Rational = true;
  double* block = cells.Block(cells.Add(CellShape::Wedge, { 2, 2, 2 }));
  for (int i = 0; i < 18; ++i)
  {
    for (int plane = 0; plane < 4; ++plane)
    {
      block[plane * 18 + i] = coefficients[i][plane];
    }
  }
  const double volume = 0.4356249313788895;
  for (const std::int64_t points : { 10000, 20000, 40000, 80000, 160000 })
  {
    SCOPED_TRACE(points);
    CellMeasuresParams params;
    params.MaxPoints = points;
    const CellMeasure m = Measured(cells, params).Cells[0];
    EXPECT_NEAR(m.Measure, volume, m.MeasureError + 1e-13);
  }
}

TEST(CellMeasures, LimitsOfTheEffortAreSaid_ExactOracle)
{
  std::mt19937 random(37);
  BernsteinCells cells;
  cells.NumComponents = 3;
  cells.Rational = true;
  AddRandomCell(cells, CellShape::Hexahedron, 2, 0.1, 1.0, 0.0, random);
  CellMeasuresParams params;
  params.MaxPoints = 2000;
  const CellMeasure few = Measured(cells, params).Cells[0];
  EXPECT_FALSE(few.Converged);
  EXPECT_GT(few.MeasureError, 1e-12 * few.Measure);
  params.MaxPoints = 1000000;
  const CellMeasure many = Measured(cells, params).Cells[0];
  EXPECT_TRUE(many.Converged);
  EXPECT_NEAR(few.Measure, many.Measure, few.MeasureError);
  params.MaxDepth = 0;
  const CellMeasure whole = Measured(cells, params).Cells[0];
  EXPECT_FALSE(whole.Converged);
  EXPECT_EQ(whole.Points, 6 * 14 * 14); // one rule a side
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
  EXPECT_EQ(with([](P& p) { p.MaxPoints = 0; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](P& p) { p.SamplesPerEdge = 1; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](P& p) { p.BoundBoxes = -1; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](P& p) { p.Threads = -1; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](P& p) { p.ParametricVolumes = { 0.0 }; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](P& p) { p.ParametricVolumes = { 1.0, 1.0 }; }), ErrorCode::SizeMismatch);
}
