// SPDX-License-Identifier: BSD-3-Clause
#include "TestCells.h"
#include <knotwork/JacobianValidation/BoundaryInjectivity.h>
#include <knotwork/SplineCore/HierarchicalSpace.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
constexpr double Pi = 3.14159265358979323846;

std::ostream& Describe(std::ostream& out, const InjectivityCertificate& c)
{
  out << "verdict " << static_cast<int>(c.Verdict) << ": " << ToString(c.Reason) << "; "
      << c.NumBoundarySides << " sides, " << c.NumBoundaryComponents << " components, "
      << c.NumInterfaces << " interfaces, " << c.NumSeams << " seams, " << c.NumCollapsedSides
      << " collapsed, " << c.NumTouching << " touching, " << c.Gaps.size() << " gaps, " << c.Boxes
      << " boxes";
  if (c.HasWitness)
  {
    for (const auto& p : c.Witness.Places)
    {
      out << "; cell " << p.Cell << " side " << p.Side << " (" << p.Parameters[0] << ", "
          << p.Parameters[1] << ", " << p.Parameters[2] << ") at (" << p.Position[0] << ", "
          << p.Position[1] << ", " << p.Position[2] << ")";
    }
  }
  return out;
}

InjectivityCertificate Prove(const BernsteinCells& cells, const CellComplex& complex = {},
  const InjectivityParams& params = {})
{
  const auto local = ValidateJacobian(cells);
  EXPECT_TRUE(local) << local.Status.Message();
  const auto result = ProveInjectivity(cells, complex, local.Value, params);
  EXPECT_TRUE(result) << result.Status.Message();
  return result.Value;
}

InjectivityCertificate Prove(const ShapeCells& shape, const InjectivityParams& params = {})
{
  return Prove(shape.Cells, { shape.Patches, shape.Boxes, {} }, params);
}

#define EXPECT_VERDICT(certificate, verdict, reason)                                               \
  do                                                                                               \
  {                                                                                                \
    std::ostringstream text;                                                                       \
    Describe(text, certificate);                                                                   \
    EXPECT_EQ((certificate).Verdict, InjectivityVerdict::verdict) << text.str();                   \
    EXPECT_EQ((certificate).Reason, InjectivityReason::reason) << text.str();                      \
  } while (false)

/// A witness of an overlap is checked by evaluation alone: two points that are apart in the
/// parameters, or lie in different cells, have the same image.
void CheckOverlap(const BernsteinCells& cells, const InjectivityCertificate& c)
{
  ASSERT_TRUE(c.HasWitness);
  const auto& [a, b] = c.Witness.Places;
  const auto x = EvaluateCell(cells, a.Cell, a.Parameters.data());
  const auto y = EvaluateCell(cells, b.Cell, b.Parameters.data());
  double apart = 0.0;
  double steepest = 1.0;
  for (std::size_t d = 0; d < 3; ++d)
  {
    apart = std::max(apart, std::abs(a.Parameters[d] - b.Parameters[d]));
    for (const auto& slope : y.Derivative)
    {
      steepest = std::max(steepest, std::abs(slope[d]));
    }
  }
  for (std::size_t d = 0; d < 3; ++d)
  {
    EXPECT_NEAR(x.Position[d], y.Position[d], 4.0 * steepest * c.Witness.Radius + 1e-12);
  }
  EXPECT_TRUE(a.Cell != b.Cell || apart > 2.0 * c.Witness.Radius);
}

/// A spline cut into n x m bicubic elements that interpolates a plane map of [0, 1]^2: neighbours
/// share control points bit by bit.
ShapeCells MapOfSquare(
  int n, int m, const std::function<std::array<double, 2>(double, double)>& map, int patch = 0)
{
  ShapeCells shape;
  shape.Cells.NumComponents = 2;
  std::vector<double> u;
  std::vector<double> v;
  for (int i = 0; i <= 3 * n; ++i)
  {
    u.push_back(i / (3.0 * n));
  }
  for (int j = 0; j <= 3 * m; ++j)
  {
    v.push_back(j / (3.0 * m));
  }
  for (int j = 0; j < m; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      const double h = 1.0 / n;
      const double k = 1.0 / m;
      AddInterpolant(shape.Cells, CellShape::Quadrilateral, { 3, 3, 0 },
        [&](const std::array<double, 3>& s)
        {
          const auto x = map((i + s[0]) * h, (j + s[1]) * k);
          return std::array<double, 3>{ x[0], x[1], 0.0 };
        });
      ParametricBox<3> box;
      box.Lower = { i / static_cast<double>(n), j / static_cast<double>(m), 0.0 };
      box.Upper = { (i + 1) / static_cast<double>(n), (j + 1) / static_cast<double>(m), 0.0 };
      shape.Boxes.push_back(box);
      shape.Patches.push_back(patch);
    }
  }
  return shape;
}

void Join(ShapeCells& shape, const ShapeCells& more, int patch)
{
  Append(shape.Cells, more.Cells);
  shape.Boxes.insert(shape.Boxes.end(), more.Boxes.begin(), more.Boxes.end());
  shape.Patches.insert(shape.Patches.end(), more.Cells.Shapes.size(), patch);
}

/// A straight box [x0, x1] x [y0, y1] as one bilinear patch.
ShapeCells Rectangle(double x0, double x1, double y0, double y1)
{
  ShapeCells shape;
  shape.Cells.NumComponents = 2;
  shape.Cells.Add(CellShape::Quadrilateral, { 1, 1, 0 });
  const double values[8] = { x0, x1, x0, x1, y0, y0, y1, y1 };
  std::copy(values, values + 8, shape.Cells.Block(0));
  shape.Boxes.push_back({ { 0., 0., 0. }, { 1., 1., 0. } });
  shape.Patches.push_back(0);
  return shape;
}

ShapeParams Shape(ShapeKind kind, int elements = 2)
{
  ShapeParams s;
  s.Kind = kind;
  s.Elements = { elements, elements, elements };
  s.Size = { 2.0, 1.8, 1.5 };
  return s;
}

/// A ring band of width 0.4 around the spiral r = 1 + turn * angle / 2 pi over `turns` turns.
ShapeCells Spiral(double pitch, double turns)
{
  return MapOfSquare(2, 24,
    [=](double u, double v)
    {
      const double angle = 2.0 * Pi * turns * v;
      const double r = 1.0 + pitch * turns * v + 0.4 * u;
      return std::array<double, 2>{ r * std::cos(angle), r * std::sin(angle) };
    });
}
}

TEST(BoundaryInjectivity, PlaneShapes_ExactOracle)
{
  for (const int elements : { 1, 3 })
  {
    SCOPED_TRACE(elements);
    auto s = Shape(ShapeKind::Square, elements);
    InjectivityCertificate c = Prove(MakeShapeCells(s, true));
    EXPECT_VERDICT(c, Injective, None);
    EXPECT_EQ(c.NumBoundarySides, 4 * elements);
    EXPECT_EQ(c.NumBoundaryComponents, 1);
    s = Shape(ShapeKind::AnnulusSector, elements);
    s.Angle = 300.0;
    EXPECT_VERDICT(Prove(MakeShapeCells(s, true)), Injective, None);
    c = Prove(MakeShapeCells(Shape(ShapeKind::Disc, elements), true));
    EXPECT_VERDICT(c, Injective, None);
    EXPECT_EQ(c.NumInterfaces, 8 * elements);
    EXPECT_EQ(c.NumBoundaryComponents, 1);
    c = Prove(MakeShapeCells(Shape(ShapeKind::PlateWithHole, elements), true));
    EXPECT_VERDICT(c, Injective, None);
    EXPECT_EQ(c.NumBoundaryComponents, 2);
  }
}

TEST(BoundaryInjectivity, AnnulusOfOnePatchHasASeam_ExactOracle)
{
  auto s = Shape(ShapeKind::AnnulusSector, 3);
  s.Angle = 360.0;
  const InjectivityCertificate seam = Prove(MakeShapeCells(s, true));
  EXPECT_VERDICT(seam, InjectiveUpToSeam, Seam);
  EXPECT_EQ(seam.NumSeams, 3);
  EXPECT_EQ(seam.NumBoundaryComponents, 2);
  s.Sectors = 4; // four patches meet in interfaces
  const InjectivityCertificate ring = Prove(MakeShapeCells(s, true));
  EXPECT_VERDICT(ring, Injective, None);
  EXPECT_EQ(ring.NumInterfaces, 12);
}

TEST(BoundaryInjectivity, Solids_ExactOracle)
{
  for (const ShapeKind kind : { ShapeKind::Cube, ShapeKind::TwistedBar, ShapeKind::SolidTube,
         ShapeKind::SolidCylinder, ShapeKind::BallSector, ShapeKind::Ball })
  {
    SCOPED_TRACE(ToString(kind));
    auto s = Shape(kind, 2);
    s.Angle = 200.0;
    const InjectivityCertificate c = Prove(MakeShapeCells(s));
    EXPECT_VERDICT(c, Injective, None);
    EXPECT_EQ(c.NumBoundaryComponents, 1);
  }
  auto s = Shape(ShapeKind::SolidTube, 2);
  s.Angle = 360.0;
  EXPECT_VERDICT(Prove(MakeShapeCells(s)), InjectiveUpToSeam, Seam);
  s.Sectors = 3;
  EXPECT_VERDICT(Prove(MakeShapeCells(s)), Injective, None);
}

TEST(BoundaryInjectivity, BallSectorsToTheCentreAndThePoles_ExactOracle)
{
  auto s = Shape(ShapeKind::BallSector, 1);
  s.InnerRadius = 0.0;
  s.Angle = 80.0;
  const InjectivityCertificate centre = Prove(MakeShapeCells(s));
  EXPECT_VERDICT(centre, InjectiveUpToSeam, CollapsedSide);
  EXPECT_EQ(centre.NumCollapsedSides, 1);
  // whole balls of one patch, their faces at the poles with a seam beside them
  s.PolarAngle = 180.0;
  s.Angle = 360.0;
  const InjectivityCertificate whole = Prove(MakeShapeCells(s));
  EXPECT_VERDICT(whole, InjectiveUpToSeam, Seam);
  EXPECT_EQ(whole.NumBoundaryComponents, 1);
  s.InnerRadius = 0.4;
  const InjectivityCertificate hollow = Prove(MakeShapeCells(s));
  EXPECT_VERDICT(hollow, InjectiveUpToSeam, Seam);
  EXPECT_EQ(hollow.NumBoundaryComponents, 2);
  // at the poles a face with a collapsed edge meets flat ones that are regular there
  for (const double angle : { 80.0, 200.0, 330.0 })
  {
    for (const double inner : { 0.4, 0.0 })
    {
      SCOPED_TRACE(std::to_string(angle) + " inner radius " + std::to_string(inner));
      s.Angle = angle;
      s.InnerRadius = inner;
      const InjectivityCertificate orange = Prove(MakeShapeCells(s));
      EXPECT_VERDICT(orange, InjectiveUpToSeam, CollapsedSide);
      EXPECT_EQ(orange.NumBoundaryComponents, 1);
    }
  }
}

// Two shells of one radius would be one surface; these are hollow: an outer and an inner sphere.
TEST(BoundaryInjectivity, HollowBallHasTwoBoundaryComponents_ExactOracle)
{
  // the six outer patches of a ball without its core
  ShapeCells ball = MakeShapeCells(Shape(ShapeKind::Ball, 1));
  ShapeCells shell;
  shell.Cells.NumComponents = 3;
  shell.Cells.Rational = ball.Cells.Rational;
  ShapeCells part = ball;
  for (int c = 1; c < 7; ++c)
  {
    BernsteinCells one;
    one.NumComponents = 3;
    one.Rational = ball.Cells.Rational;
    one.Add(ball.Cells.Shapes[static_cast<std::size_t>(c)],
      ball.Cells.Degrees[static_cast<std::size_t>(c)]);
    std::copy_n(ball.Cells.Block(c), one.Data.size(), one.Block(0));
    Append(shell.Cells, one);
    shell.Patches.push_back(c);
  }
  InjectivityCertificate c = Prove(shell.Cells, { shell.Patches, {}, {} });
  EXPECT_VERDICT(c, Injective, None);
  EXPECT_EQ(c.NumBoundaryComponents, 2);
}

// det J > 0 everywhere, and the band overlaps itself when its pitch is below its width.
TEST(BoundaryInjectivity, SpiralsThatOverlapOrDoNot_ExactOracle)
{
  EXPECT_VERDICT(Prove(Spiral(0.5, 1.7)), Injective, None);
  EXPECT_VERDICT(Prove(Spiral(0.41, 1.7)), Injective, None);
  const ShapeCells overlapping = Spiral(0.25, 1.7);
  const auto local = ValidateJacobian(overlapping.Cells);
  ASSERT_EQ(local.Value.Verdict, Verdict::Valid);
  const InjectivityCertificate c = Prove(overlapping);
  EXPECT_VERDICT(c, NotInjective, Overlap);
  CheckOverlap(overlapping.Cells, c);
}

// A ring band that is run through twice: the boundary curves lie on themselves.
TEST(BoundaryInjectivity, BandThatCoversItselfTwice_ExactOracle)
{
  const InjectivityCertificate c = Prove(Spiral(0.0, 1.5));
  EXPECT_NE(c.Verdict, InjectivityVerdict::Injective);
  EXPECT_NE(c.Verdict, InjectivityVerdict::InjectiveUpToSeam);
}

// A band along a lemniscate crosses itself at right angles; det J > 0 throughout.
TEST(BoundaryInjectivity, FigureEightBandOverlaps_ExactOracle)
{
  const auto eight = MapOfSquare(1, 32,
    [](double u, double v)
    {
      const double t = 2.0 * Pi * (0.7 * v - 0.1); // through 0 and pi, where it crosses
      const double dx = std::cos(t);
      const double dy = 2.0 * std::cos(2.0 * t);
      const double n = std::hypot(dx, dy);
      const double side = 0.1 * (u - 0.5);
      return std::array<double, 2>{ std::sin(t) + side * dy / n,
        std::sin(2.0 * t) - side * dx / n };
    });
  const InjectivityCertificate c = Prove(eight);
  EXPECT_VERDICT(c, NotInjective, Overlap);
  CheckOverlap(eight.Cells, c);
}

// A bar bent to a C whose ends come within a gap of each other, down to 1e-9.
TEST(BoundaryInjectivity, CloseButDisjointBoundaries_ExactOracle)
{
  for (const double gap : { 1e-2, 1e-5, 1e-9, -1e-9, -1e-3 })
  {
    SCOPED_TRACE(gap);
    const auto ring = MapOfSquare(1, 12,
      [gap](double u, double v)
      {
        const double angle = (2.0 * Pi - gap) * v;
        const double r = 1.0 + u;
        return std::array<double, 2>{ r * std::cos(angle), r * std::sin(angle) };
      });
    const InjectivityCertificate c = Prove(ring);
    if (gap > 0.0)
    {
      EXPECT_VERDICT(c, Injective, None);
    }
    else
    {
      EXPECT_VERDICT(c, NotInjective, Overlap);
      CheckOverlap(ring.Cells, c);
    }
  }
}

TEST(BoundaryInjectivity, SolidsThatOverlap_ExactOracle)
{
  for (const double pitch : { 0.6, 0.25 })
  {
    SCOPED_TRACE(pitch);
    BernsteinCells cells;
    cells.NumComponents = 3;
    std::vector<ParametricBox<3>> boxes;
    const int n = 10;
    for (int k = 0; k < n; ++k)
    {
      AddInterpolant(cells, CellShape::Hexahedron, { 1, 1, 4 },
        [&](const std::array<double, 3>& u)
        {
          const double v = (k + u[2]) / n;
          const double angle = 2.0 * Pi * 1.3 * v;
          const double r = 1.0 + 0.4 * u[0];
          // a helix of square section
          return std::array<double, 3>{ r * std::cos(angle), r * std::sin(angle),
            0.4 * u[1] + pitch * 1.3 * v };
        });
      boxes.push_back({ { 0., 0., k * 1.0 }, { 1., 1., k + 1.0 } });
    }
    // the helix turns left-handed cells out of (r, z, angle): mirrored ones are as good
    const InjectivityCertificate c =
      Prove(cells, { std::vector<int>(static_cast<std::size_t>(n), 0), boxes, {} });
    if (pitch > 0.4)
    {
      EXPECT_VERDICT(c, Injective, None);
    }
    else
    {
      EXPECT_VERDICT(c, NotInjective, Overlap);
      CheckOverlap(cells, c);
    }
  }
}

// Affine after triangular polynomial maps: injective by construction.
TEST(BoundaryInjectivity, PolynomialDiffeomorphismsOfAllShapes_ExactOracle)
{
  for (unsigned seed = 1; seed <= 12; ++seed)
  {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (const CellShape shape : AllCellShapes)
    {
      const int dim = NumParameters(shape);
      if (dim < 2)
      {
        continue;
      }
      SCOPED_TRACE(
        "seed " + std::to_string(seed) + " shape " + std::to_string(static_cast<int>(shape)));
      Eigen::Matrix3d a = Eigen::Matrix3d::Identity();
      for (int i = 0; i < dim; ++i)
      {
        for (int j = 0; j < dim; ++j)
        {
          a(i, j) += 0.3 * uniform(random);
        }
      }
      const double s = 1.5 * uniform(random);
      const double t = 1.5 * uniform(random);
      const int p = 2 + static_cast<int>(seed % 3);
      BernsteinCells cells;
      cells.NumComponents = dim;
      AddInterpolant(cells, shape, UniformDegree(shape, p),
        [&](const std::array<double, 3>& u)
        {
          Eigen::Vector3d x(u[0] + s * std::pow(u[1], p) + t * std::pow(u[2], p),
            u[1] + (dim > 2 ? t * u[2] * u[2] : 0.0), u[2]);
          x = a * x + Eigen::Vector3d(1.0, -2.0, 0.5);
          return std::array<double, 3>{ x[0], x[1], x[2] };
        });
      EXPECT_VERDICT(Prove(cells), Injective, None);
    }
  }
}

// A cube of 6 tetrahedra and of 2 wedges, glued by equal sides, and one of them pulled away.
TEST(BoundaryInjectivity, SimplicesGlueToACube_ExactOracle)
{
  const std::array<std::array<int, 3>, 6> orders = { { { 0, 1, 2 }, { 1, 2, 0 }, { 2, 0, 1 },
    { 0, 2, 1 }, { 2, 1, 0 }, { 1, 0, 2 } } };
  BernsteinCells cells;
  cells.NumComponents = 3;
  for (const auto& order : orders)
  {
    const int c = cells.Add(CellShape::Tetrahedron, { 1, 1, 1 });
    double corner[3] = { 0., 0., 0. };
    for (int k = 0; k < 4; ++k)
    {
      for (int d = 0; d < 3; ++d)
      {
        cells.Block(c)[d * 4 + k] = corner[d];
      }
      if (k < 3)
      {
        corner[order[static_cast<std::size_t>(k)]] = 1.0;
      }
    }
  }
  InjectivityCertificate c = Prove(cells);
  EXPECT_VERDICT(c, Injective, None);
  EXPECT_EQ(c.NumInterfaces, 6);
  EXPECT_EQ(c.NumBoundarySides, 12);
  // the same corner twice: a cell doubled is on the same side of all its sides
  Append(cells,
    [&]
    {
      BernsteinCells one;
      one.NumComponents = 3;
      one.Add(CellShape::Tetrahedron, { 1, 1, 1 });
      std::copy_n(cells.Block(0), 12, one.Block(0));
      return one;
    }());
  EXPECT_VERDICT(Prove(cells), NotInjective, FoldedSide);
}

TEST(BoundaryInjectivity, PatchesApartOverlappingAndNested_ExactOracle)
{
  ShapeCells apart = Rectangle(0., 1., 0., 1.);
  Join(apart, Rectangle(1.5, 2., 0., 1.), 1);
  InjectivityCertificate c = Prove(apart);
  EXPECT_VERDICT(c, Injective, None);
  EXPECT_EQ(c.NumBoundaryComponents, 2);

  ShapeCells crossing = Rectangle(0., 1., 0., 1.);
  Join(crossing, Rectangle(0.8, 2., 0.3, 1.5), 1);
  c = Prove(crossing);
  EXPECT_VERDICT(c, NotInjective, Overlap);
  CheckOverlap(crossing.Cells, c);

  // boundaries are disjoint, but one covers the other
  ShapeCells nested = Rectangle(0., 1., 0., 1.);
  Join(nested, Rectangle(0.4, 0.6, 0.3, 0.7), 1);
  c = Prove(nested);
  EXPECT_VERDICT(c, NotInjective, Overlap);
  CheckOverlap(nested.Cells, c);
}

// Discs and balls of several patches: they overlap exactly when their centres are nearer than the
// sum of their radii, boundaries crossing or not.
TEST(BoundaryInjectivity, DiscsAndBallsAnywhere_ExactOracle)
{
  for (unsigned seed = 1; seed <= 40; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const bool planar = seed % 4 != 0;
    auto s = Shape(planar ? ShapeKind::Disc : ShapeKind::Ball, 1);
    ShapeCells shape = MakeShapeCells(s, planar);
    const double radius = 0.2 + 0.8 * uniform(random);
    const double distance =
      seed % 5 == 0 ? 1.0 + radius + (seed % 2 ? 1e-6 : -1e-6) : (1.5 + radius) * uniform(random);
    const double angle = 2.0 * Pi * uniform(random);
    s.OuterRadius = radius;
    s.InnerRadius = 0.5 * radius;
    s.Center = { distance * std::cos(angle), distance * std::sin(angle), 0.0 };
    const ShapeCells other = MakeShapeCells(s, planar);
    const int first = *std::max_element(shape.Patches.begin(), shape.Patches.end()) + 1;
    Append(shape.Cells, other.Cells);
    shape.Boxes.insert(shape.Boxes.end(), other.Boxes.begin(), other.Boxes.end());
    for (const int patch : other.Patches)
    {
      shape.Patches.push_back(first + patch);
    }
    const InjectivityCertificate c = Prove(shape);
    if (distance > 1.0 + radius)
    {
      EXPECT_VERDICT(c, Injective, None);
      EXPECT_EQ(c.NumBoundaryComponents, 2);
    }
    else
    {
      EXPECT_VERDICT(c, NotInjective, Overlap);
      CheckOverlap(shape.Cells, c);
    }
  }
}

// Bands around random trigonometric curves, det J > 0 throughout; the oracle is the crossing test
// of their boundaries' fine polygons.
TEST(BoundaryInjectivity, RandomBands_CrossOracle)
{
  int injective = 0;
  int overlapping = 0;
  for (unsigned seed = 1; seed <= 60; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    double a[8];
    for (double& x : a)
    {
      x = uniform(random);
    }
    const auto band = MapOfSquare(1, 24,
      [&](double u, double v)
      {
        const double t = 4.0 * v;
        const double x = 1.2 * t + a[0] * std::cos(2.0 * t) + a[1] * std::sin(3.0 * t);
        const double y = 1.5 * a[2] * std::cos(2.0 * t + a[3]) + 1.2 * a[4] * std::sin(3.0 * t);
        const double dx = 1.2 - 2.0 * a[0] * std::sin(2.0 * t) + 3.0 * a[1] * std::cos(3.0 * t);
        const double dy = -3.0 * a[2] * std::sin(2.0 * t + a[3]) + 3.6 * a[4] * std::cos(3.0 * t);
        const double n = std::hypot(dx, dy);
        const double side = 0.02 * (u - 0.5);
        return std::array<double, 2>{ x + side * dy / n, y - side * dx / n };
      });
    if (ValidateJacobian(band.Cells).Value.Verdict != Verdict::Valid)
    {
      continue; // too tight a bend
    }
    // polygons of the four sides
    std::vector<Eigen::Vector2d> polygon;
    const auto add = [&](int cell, double u, double v)
    {
      const double at[3] = { u, v, 0.0 };
      const auto x = EvaluateCell(band.Cells, cell, at).Position;
      polygon.push_back({ x[0], x[1] });
    };
    constexpr int steps = 20;
    for (int c = 0; c < 24; ++c)
    {
      for (int i = 0; i < steps; ++i)
      {
        add(c, 1.0, static_cast<double>(i) / steps);
      }
    }
    add(23, 1.0, 1.0);
    for (int c = 23; c >= 0; --c)
    {
      for (int i = steps; i > 0; --i)
      {
        add(c, 0.0, static_cast<double>(i) / steps);
      }
    }
    add(0, 0.0, 0.0);
    const auto area =
      [](const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& r)
    { return (q - p).x() * (r - p).y() - (q - p).y() * (r - p).x(); };
    bool crosses = false;
    const std::size_t n = polygon.size();
    for (std::size_t i = 0; i < n && !crosses; ++i)
    {
      for (std::size_t j = i + 2; j < n && !crosses; ++j)
      {
        const auto& p = polygon[i];
        const auto& q = polygon[(i + 1) % n];
        const auto& r = polygon[j];
        const auto& s = polygon[(j + 1) % n];
        crosses = (i != 0 || j != n - 1) && area(p, q, r) * area(p, q, s) < 0.0 &&
          area(r, s, p) * area(r, s, q) < 0.0;
      }
    }
    const InjectivityCertificate c = Prove(band);
    if (crosses)
    {
      ++overlapping;
      EXPECT_VERDICT(c, NotInjective, Overlap);
      CheckOverlap(band.Cells, c);
    }
    else
    {
      ++injective;
      EXPECT_VERDICT(c, Injective, None);
    }
  }
  EXPECT_GT(injective, 5);
  EXPECT_GT(overlapping, 5);
}

TEST(BoundaryInjectivity, TouchingCornersAreNamed_ExactOracle)
{
  ShapeCells chess = Rectangle(0., 1., 0., 1.);
  Join(chess, Rectangle(1., 2., 1., 2.), 1);
  const InjectivityCertificate c = Prove(chess);
  EXPECT_VERDICT(c, InjectiveUpToSeam, Touching);
  EXPECT_EQ(c.NumTouching, 1);
}

// The square (cube) under y = v (2 u - 1)^2 (z = w ((2 u - 1)^2 + (2 v - 1)^2)): its top touches
// its bottom where four (two) elements meet, and the edge between the two, inside of the map, is
// one point. With an element less it is on the boundary. In space the same when every element is a
// patch: what is glued around the edge says that it is inside.
TEST(BoundaryInjectivity, AnEdgeInsideThatIsAPointIsNoMap_ExactOracle)
{
  for (const auto& [dim, patches] : { std::pair{ 2, 1 }, std::pair{ 3, 1 }, std::pair{ 3, 4 } })
  {
    for (const bool whole : { true, false })
    {
      SCOPED_TRACE(std::to_string(dim) + (whole ? "D, " : "D, an element less, ") +
        std::to_string(patches) + " patches");
      ShapeCells touching;
      touching.Cells.NumComponents = dim;
      for (int e = whole ? 0 : 1; e < (dim == 2 ? 2 : 4); ++e)
      {
        const double begin[2] = { 0.5 * (e % 2), 0.5 * (e / 2) };
        const auto square = [](double x) { return (2.0 * x - 1.0) * (2.0 * x - 1.0); };
        AddInterpolant(touching.Cells, dim == 2 ? CellShape::Quadrilateral : CellShape::Hexahedron,
          dim == 2 ? CellDegree{ 2, 1, 0 } : CellDegree{ 2, 2, 1 },
          [&, plane = dim == 2](const std::array<double, 3>& s)
          {
            const double u = begin[0] + 0.5 * s[0];
            const double v = begin[1] + 0.5 * s[1];
            return plane ? std::array<double, 3>{ u, s[1] * square(u), 0.0 }
                         : std::array<double, 3>{ u, v, s[2] * (square(u) + square(v)) };
          });
        ParametricBox<3> box;
        box.Lower = { begin[0], dim == 2 ? 0.0 : begin[1], 0.0 };
        box.Upper = { begin[0] + 0.5, dim == 2 ? 1.0 : begin[1] + 0.5, 1.0 };
        touching.Boxes.push_back(box);
        touching.Patches.push_back(e % patches);
      }
      const auto local = ValidateJacobian(touching.Cells);
      ASSERT_TRUE(local);
      EXPECT_EQ(local->Verdict, Verdict::Valid); // cell by cell
      const InjectivityCertificate c = Prove(touching);
      if (whole)
      {
        EXPECT_VERDICT(c, NotInjective, Overlap);
        const auto& [a, b] = c.Witness.Places;
        for (std::size_t d = 0; d < 3; ++d)
        {
          EXPECT_NEAR(a.Position[d], b.Position[d], 1e-15);
        }
        EXPECT_NE(a.Parameters, b.Parameters);
      }
      else
      {
        EXPECT_NE(c.Verdict, InjectivityVerdict::NotInjective);
      }
    }
  }
}

TEST(BoundaryInjectivity, BoundariesThatTouchInsideASideAreUndecided_ExactOracle)
{
  ShapeCells touching = Rectangle(0., 1., 0., 1.);
  // a triangle with a corner on the middle of a side
  touching.Cells.Add(CellShape::Triangle, { 1, 1, 0 });
  const double values[6] = { 1., 2., 2., 0.5, 0., 1. };
  std::copy(values, values + 6, touching.Cells.Block(1));
  touching.Boxes.push_back({});
  touching.Patches.push_back(1);
  const InjectivityCertificate c = Prove(touching);
  EXPECT_VERDICT(c, Undecided, TooClose);
  EXPECT_NEAR(c.Witness.Places[0].Position[0], 1.0, 1e-6);
  EXPECT_NEAR(c.Witness.Places[0].Position[1], 0.5, 1e-6);
}

TEST(BoundaryInjectivity, UnequalInterfacesAreReportedWithTheirGap_ExactOracle)
{
  for (const double gap : { 1e-3, 1e-7, 1e-12 })
  {
    SCOPED_TRACE(gap);
    ShapeCells disc = MakeShapeCells(Shape(ShapeKind::Disc, 1), true);
    // moves the middle control point of an interface, of one patch only
    const int cell = 1;
    const int n = NumCellCoefficients(disc.Cells.Shapes[1], disc.Cells.Degrees[1]);
    const int p = disc.Cells.Degrees[1][0];
    const int q = disc.Cells.Degrees[1][1];
    const int at = q > 1 ? (p + 1) * (q / 2) : p / 2; // on u = 0, or on v = 0
    const double w = disc.Cells.Block(cell)[2 * n + at];
    disc.Cells.Block(cell)[at] += gap * w;
    const InjectivityCertificate c = Prove(disc);
    EXPECT_VERDICT(c, Undecided, Gap);
    ASSERT_EQ(c.Gaps.size(), 1u);
    EXPECT_LE(c.Gaps[0].Size, gap);
    EXPECT_GE(c.Gaps[0].Size, gap * 0.1);
  }
  // a coarse side beside two finer ones: a T-junction between patches
  ShapeCells junction = Rectangle(0., 1., 0., 2.);
  Join(junction, Rectangle(1., 2., 0., 1.), 1);
  Join(junction, Rectangle(1., 2., 1., 2.), 2);
  const InjectivityCertificate c = Prove(junction);
  EXPECT_VERDICT(c, Undecided, Gap);
  EXPECT_EQ(c.Gaps.size(), 2u);
  EXPECT_LE(c.Gaps[0].Size, 1e-15);
}

template <int Dim>
void ExpectHierarchicalInjective(const ShapeParams& params)
{
  const auto made = MakeShape(params);
  ASSERT_TRUE(made);
  const auto& spline = std::get<Spline<Dim>>(made.Value[0]);
  SplineSpacePtr<Dim> space = spline.Space;
  Spline<Dim> refined = spline;
  for (int level = 0; level < 2; ++level)
  {
    const auto finer = RefineElements<Dim>(space, { 0, 1 }, { /*Extension*/ 0 });
    ASSERT_TRUE(finer) << finer.Status.Message();
    const auto transferred = TransferToRefined<Dim>(refined, finer.Value);
    ASSERT_TRUE(transferred);
    refined = transferred.Value;
    space = finer.Value;
  }
  ShapeCells shape;
  shape.Cells.NumComponents = Dim;
  shape.Cells.Rational = refined.IsRational();
  AddSpline(shape, refined, 0);
  const InjectivityCertificate c = Prove(shape);
  EXPECT_VERDICT(c, Injective, None);
  EXPECT_EQ(c.NumBoundaryComponents, 1);
  EXPECT_LE(c.InnerRounding, 1e-14);
  EXPECT_TRUE(c.Gaps.empty());
}

TEST(BoundaryInjectivity, HangingNodesInsideAPatchAreNoGaps_ExactOracle)
{
  auto s = Shape(ShapeKind::AnnulusSector, 3);
  s.Angle = 200.0;
  ExpectHierarchicalInjective<2>(s);
  ExpectHierarchicalInjective<3>(Shape(ShapeKind::Cube, 2));
  s = Shape(ShapeKind::SolidTube, 2);
  ExpectHierarchicalInjective<3>(s);
}

TEST(BoundaryInjectivity, PointIdsTellASeamFromAnInnerSide_ExactOracle)
{
  // a ring of 6 bicubic cells of one patch without boxes
  ShapeCells ring = MapOfSquare(1, 6,
    [](double u, double v)
    {
      const double angle = 2.0 * Pi * v;
      return std::array<double, 2>{ (1.0 + u) * std::cos(angle), (1.0 + u) * std::sin(angle) };
    });
  // sides are made equal bit by bit, the last with the first too
  for (int c = 0; c < 6; ++c)
  {
    for (int plane = 0; plane < 2; ++plane)
    {
      std::copy_n(
        ring.Cells.Block(c) + plane * 16 + 12, 4, ring.Cells.Block((c + 1) % 6) + plane * 16);
    }
  }
  const auto ids = [](bool closed)
  {
    std::vector<std::int64_t> points;
    for (int c = 0; c < 6; ++c)
    {
      for (int j = 0; j < 4; ++j)
      {
        for (int i = 0; i < 4; ++i)
        {
          const int row = 3 * c + j;
          points.push_back((closed ? row % 18 : row) * 4 + i);
        }
      }
    }
    return points;
  };
  EXPECT_VERDICT(Prove(ring.Cells, { ring.Patches, {}, ids(false) }), InjectiveUpToSeam, Seam);
  EXPECT_VERDICT(Prove(ring.Cells, { ring.Patches, {}, ids(true) }), Injective, None);
  EXPECT_VERDICT(Prove(ring.Cells, { ring.Patches, ring.Boxes, {} }), InjectiveUpToSeam, Seam);
  EXPECT_VERDICT(Prove(ring.Cells), Injective, None);
}

TEST(BoundaryInjectivity, FoldsAndLocalDoubtsAreNamed_ExactOracle)
{
  // folded: the fourth corner pulled through the opposite one
  BernsteinCells cells;
  cells.NumComponents = 2;
  cells.Add(CellShape::Quadrilateral, { 1, 1, 0 });
  const double folded[8] = { 0., 1., 0., -0.5, 0., 0., 1., -0.5 };
  std::copy(folded, folded + 8, cells.Block(0));
  EXPECT_VERDICT(Prove(cells), NotInjective, FoldedCell);
  // two elements of one patch, the second turned back over the first
  ShapeCells back = Rectangle(0., 1., 0., 1.);
  Join(back, Rectangle(1., 0.2, 0., 1.), 0);
  back.Boxes[1] = { { 1., 0., 0. }, { 2., 1., 0. } };
  EXPECT_VERDICT(Prove(back), NotInjective, FoldedSide);
  // an undecided local certificate
  const BernsteinCells square = Rectangle(0., 1., 0., 1.).Cells;
  auto local = ValidateJacobian(square).Value;
  local.Cells[0].Verdict = Verdict::Undecided;
  const auto c = ProveInjectivity(square, {}, local);
  ASSERT_TRUE(c);
  EXPECT_VERDICT(c.Value, Undecided, LocalJacobian);
}

TEST(BoundaryInjectivity, LimitsAndOpenSidesAreNamed_ExactOracle)
{
  InjectivityParams params;
  params.MaxBoxes = 1;
  EXPECT_VERDICT(Prove(Spiral(0.41, 1.7), params), Undecided, Boxes);
  // a coarse element with one of its two finer neighbours missing
  ShapeCells open = Rectangle(0., 1., 0., 2.);
  Join(open, Rectangle(1., 2., 0., 1.), 0);
  open.Boxes[0] = { { 0., 0., 0. }, { 1., 2., 0. } };
  open.Boxes[1] = { { 1., 0., 0. }, { 2., 1., 0. } };
  EXPECT_VERDICT(Prove(open), Undecided, OpenSide);
  // elements of one patch that do not fit
  ShapeCells torn = Rectangle(0., 1., 0., 1.);
  Join(torn, Rectangle(1.01, 2., 0., 1.), 0);
  torn.Boxes[1] = { { 1., 0., 0. }, { 2., 1., 0. } };
  const InjectivityCertificate c = Prove(torn);
  EXPECT_VERDICT(c, Undecided, Gap);
  ASSERT_EQ(c.Gaps.size(), 1u);
  EXPECT_NEAR(c.Gaps[0].Size, 0.01, 1e-12);
}

TEST(BoundaryInjectivity, FarFromTheOriginItIsTheSame_PropertyOracle)
{
  // moved by a power of two, which the coordinates' digits end far above
  const auto moved = [](ShapeCells shape, double by)
  {
    for (int c = 0; c < shape.Cells.NumCells(); ++c)
    {
      const std::size_t at = static_cast<std::size_t>(c);
      const int n = NumCellCoefficients(shape.Cells.Shapes[at], shape.Cells.Degrees[at]);
      for (int i = 0; i < 2 * n; ++i)
      {
        double& x = shape.Cells.Block(c)[i];
        x = std::ldexp(std::round(std::ldexp(x, 24)), -24) + by;
      }
    }
    return shape;
  };
  for (const double by : { 0.0, 0x1p10, -0x1p20, 0x1p22 })
  {
    SCOPED_TRACE(by);
    EXPECT_VERDICT(Prove(moved(Spiral(0.5, 1.7), by)), Injective, None);
    EXPECT_VERDICT(Prove(moved(Spiral(0.41, 1.7), by)), Injective, None);
    const ShapeCells overlapping = moved(Spiral(0.25, 1.7), by);
    const InjectivityCertificate c = Prove(overlapping);
    EXPECT_VERDICT(c, NotInjective, Overlap);
    // sides of two patches that nearly agree: the place is where they are
    ShapeCells pair = Rectangle(0., 1., 0., 1.);
    Join(pair, Rectangle(1. + 0x1p-23, 2., 0., 1.), 1);
    const InjectivityCertificate gap = Prove(moved(pair, by));
    EXPECT_VERDICT(gap, Undecided, Gap);
    ASSERT_EQ(gap.Gaps.size(), 1u);
    EXPECT_NEAR(gap.Gaps[0].Size, 0x1p-23, 1e-12);
    EXPECT_NEAR(gap.Gaps[0].Position[0], by + 1.0, 1e-6);
    EXPECT_GE(gap.Gaps[0].Position[1], by);
    EXPECT_LE(gap.Gaps[0].Position[1], by + 1.0);
  }
}

TEST(BoundaryInjectivity, ThreadsGiveTheSameCertificate_PropertyOracle)
{
  for (const double pitch : { 0.41, 0.25 })
  {
    const ShapeCells spiral = Spiral(pitch, 1.7);
    InjectivityParams params;
    params.Threads = 1;
    const InjectivityCertificate one = Prove(spiral, params);
    params.Threads = 4;
    const InjectivityCertificate four = Prove(spiral, params);
    EXPECT_EQ(one.Verdict, four.Verdict);
    EXPECT_EQ(one.Boxes, four.Boxes);
    EXPECT_EQ(one.Witness.Places[0].Parameters, four.Witness.Places[0].Parameters);
    EXPECT_EQ(one.Witness.Places[1].Parameters, four.Witness.Places[1].Parameters);
  }
}

TEST(BoundaryInjectivity, EveryFailureIsReachable)
{
  const ShapeCells square = Rectangle(0., 1., 0., 1.);
  const auto local = ValidateJacobian(square.Cells).Value;
  const auto code = [&](const BernsteinCells& cells, const CellComplex& complex = {},
                      const InjectivityParams& params = {}, const ProgressCallback& progress = {})
  { return ProveInjectivity(cells, complex, local, params, progress).Status.Code; };
  EXPECT_EQ(code(square.Cells), ErrorCode::Ok);
  EXPECT_EQ(code({}), ErrorCode::EmptyInput);
  BernsteinCells bad = square.Cells;
  bad.Block(0)[0] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(code(bad), ErrorCode::NonFiniteInput);
  bad = {};
  bad.NumComponents = 3;
  bad.Add(CellShape::Triangle, { 1, 1, 0 });
  EXPECT_EQ(code(bad), ErrorCode::DimensionMismatch);
  bad = square.Cells;
  bad.Add(CellShape::Triangle, { 1, 1, 0 });
  EXPECT_EQ(code(bad), ErrorCode::SizeMismatch);
  EXPECT_EQ(code(square.Cells, { { 0, 1 }, {}, {} }), ErrorCode::SizeMismatch);
  EXPECT_EQ(code(square.Cells, { {}, {}, { 1, 2, 3 } }), ErrorCode::SizeMismatch);
  const auto with = [&](auto change)
  {
    InjectivityParams params;
    change(params);
    return code(square.Cells, {}, params);
  };
  using P = InjectivityParams;
  EXPECT_EQ(with([](P& p) { p.MaxBoxes = 0; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](P& p) { p.GapTolerance = -1.0; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](P& p) { p.InnerTolerance = 1.0; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](P& p) { p.InterfaceTolerance = 1.0; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](P& p) { p.CollapseTolerance = 1.0; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(with([](P& p) { p.Threads = -1; }), ErrorCode::InvalidParameter);
  EXPECT_EQ(code(square.Cells, {}, {}, [](double) { return false; }), ErrorCode::Aborted);
}
