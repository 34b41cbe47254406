// SPDX-License-Identifier: BSD-3-Clause
#include "StarShape.h"
#include "TestCells.h"

#include <cmath>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
constexpr double pi = 3.14159265358979323846;

/// What FindStarShaped says of the boundary of cells that are all taken for det J > 0 (or < 0).
std::vector<char> StarShaped(const BernsteinCells& cells, int sign = 1)
{
  const std::vector<int> signs(cells.Shapes.size(), sign);
  const CellGluing gluing = GlueCells(cells, {}, signs, {});
  BernsteinCells sides;
  sides.NumComponents = cells.NumComponents;
  sides.Rational = cells.Rational;
  for (const BoundarySide& side : gluing.Boundary)
  {
    const int i = sides.Add(side.Frame.Shape, side.Degree);
    std::copy(side.Data.begin(), side.Data.end(), sides.Block(i));
    sides.Errors.push_back(side.Error);
  }
  return FindStarShaped(gluing.Boundary, gluing.NumComponents, sides, signs, 1);
}

InjectivityCertificate Prove(const BernsteinCells& cells)
{
  const auto local = ValidateJacobian(cells);
  EXPECT_TRUE(local) << local.Status.Message();
  const auto result = ProveInjectivity(cells, {}, local.Value);
  EXPECT_TRUE(result) << result.Status.Message();
  return result.Value;
}

void AddTetrahedron(BernsteinCells& cells, const std::array<Eigen::Vector3d, 4>& vertices)
{
  double* block = cells.Block(cells.Add(CellShape::Tetrahedron, { 1, 1, 1 }));
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      block[c * 4 + static_cast<int>(i)] = vertices[i][c];
    }
  }
}

/// Tetrahedra around the axis from (0, 0, -1) to (0, 0, 1), a third of a turn each.
BernsteinCells AroundTheAxis(int count)
{
  BernsteinCells cells;
  cells.NumComponents = 3;
  const auto point = [&](int k)
  {
    const int at = k % count;
    const double radius = at < 3 ? 1.0 : 1.3;
    return Eigen::Vector3d(
      radius * std::cos(2.0 * pi * at / 3.0), radius * std::sin(2.0 * pi * at / 3.0), 0.0);
  };
  for (int k = 0; k < count; ++k)
  {
    AddTetrahedron(
      cells, { Eigen::Vector3d(0, 0, -1), point(k), point(k + 1), Eigen::Vector3d(0, 0, 1) });
  }
  return cells;
}
}

// One side a corner less than pi and three a corner: no branch is possible.
TEST(StarShape, SingleCellsOfExtremeWeights_ExactOracle)
{
  std::mt19937 random(41);
  for (const CellShape shape : { CellShape::Hexahedron, CellShape::Tetrahedron, CellShape::Wedge })
  {
    for (int p = 1; p <= 2; ++p)
    {
      SCOPED_TRACE(
        "shape " + std::to_string(static_cast<int>(shape)) + " degree " + std::to_string(p));
      for (const double decades : { 0.0, 1.0, 3.0 })
      {
        BernsteinCells cells;
        cells.NumComponents = 3;
        cells.Rational = decades > 0.0;
        AddRandomCell(cells, shape, p, 0.03, decades, 5.0, random);
        EXPECT_EQ(StarShaped(cells), std::vector<char>{ 1 });
        EXPECT_EQ(StarShaped(cells, -1), std::vector<char>{ 0 }); // seen from outside
        const InjectivityCertificate proof = Prove(cells);
        EXPECT_EQ(proof.Verdict, InjectivityVerdict::Injective);
        EXPECT_EQ(proof.Boxes, 0);
      }
    }
  }
}

TEST(StarShape, BlocksAndBentBars_ExactOracle)
{
  ShapeParams s;
  s.Kind = ShapeKind::Cube;
  s.Elements = { 3, 3, 3 };
  const ShapeCells cube = MakeShapeCells(s);
  EXPECT_EQ(StarShaped(cube.Cells), std::vector<char>{ 1 });
  s.Kind = ShapeKind::SolidTube; // three quarters of a turn: no point sees both ends
  s.Angle = 270.0;
  EXPECT_EQ(StarShaped(MakeShapeCells(s).Cells), std::vector<char>{ 0 });
}

// The unit cube, triquadratic, with a control point in a face that is far away but weighs next to
// nothing: it moves the face by less than 1e-3, and the mean of all control points out of the cube.
TEST(StarShape, APointIsFoundWhereTheMeanIsOutside_ExactOracle)
{
  for (const double far : { 10.0, 50.0, 200.0 })
  {
    for (const double shift : { 0.0, 1e4 })
    {
      SCOPED_TRACE("at " + std::to_string(far) + " moved by " + std::to_string(shift));
      BernsteinCells cells;
      cells.NumComponents = 3;
      cells.Rational = true;
      double* block = cells.Block(cells.Add(CellShape::Hexahedron, { 2, 2, 2 }));
      const int n = 27;
      for (int i = 0; i < n; ++i)
      {
        const bool isFar = i == 2 + 3 + 9; // in the middle of x = 1
        const double w = isFar ? 1e-6 : 1.0;
        block[i] = w * (shift + (isFar ? n * far : 0.5 * (i % 3)));
        block[n + i] = w * 0.5 * (i / 3 % 3);
        block[2 * n + i] = w * 0.5 * (i / 9);
        block[3 * n + i] = w;
      }
      EXPECT_EQ(StarShaped(cells), std::vector<char>{ 1 });
      EXPECT_EQ(StarShaped(cells, -1), std::vector<char>{ 0 });
      const InjectivityCertificate proof = Prove(cells);
      EXPECT_EQ(proof.Verdict, InjectivityVerdict::Injective);
      EXPECT_EQ(proof.Boxes, 0);
    }
  }
}

// A mirrored cell has det J < 0 and its sides the other way round.
TEST(StarShape, MirroredCells_PropertyOracle)
{
  std::mt19937 random(43);
  BernsteinCells cells;
  cells.NumComponents = 3;
  AddRandomCell(cells, CellShape::Hexahedron, 2, 0.03, 0.0, 0.0, random);
  const int n = NumCellCoefficients(cells.Shapes[0], cells.Degrees[0]);
  for (int i = 0; i < n; ++i)
  {
    cells.Block(0)[i] *= -1.0;
  }
  EXPECT_EQ(StarShaped(cells), std::vector<char>{ 0 });
  EXPECT_EQ(StarShaped(cells, -1), std::vector<char>{ 1 });
  EXPECT_EQ(Prove(cells).Verdict, InjectivityVerdict::Injective);
}

// Six tetrahedra that turn around their axis twice: det J > 0, one closed surface whose directions
// from the middle cover the sphere twice, with branches at the two ends of the axis. Only the
// number of sides that meet there tells.
TEST(StarShape, SurfaceThatCoversTheSphereTwice_ExactOracle)
{
  const BernsteinCells once = AroundTheAxis(3);
  EXPECT_EQ(StarShaped(once), std::vector<char>{ 1 });
  EXPECT_EQ(Prove(once).Verdict, InjectivityVerdict::Injective);
  const BernsteinCells twice = AroundTheAxis(6);
  for (const char is : StarShaped(twice))
  {
    EXPECT_EQ(is, 0);
  }
  const InjectivityVerdict verdict = Prove(twice).Verdict;
  EXPECT_NE(verdict, InjectivityVerdict::Injective);
  EXPECT_NE(verdict, InjectivityVerdict::InjectiveUpToSeam);
}

// A dent that reaches past the middle hides what is behind it; pushed in less it does not.
TEST(StarShape, DentedCubes_ExactOracle)
{
  for (const double depth : { 0.0, 0.2, 1.2 })
  {
    BernsteinCells cells;
    cells.NumComponents = 3;
    AddInterpolant(cells, CellShape::Hexahedron, { 2, 2, 2 },
      [&](const std::array<double, 3>& u)
      {
        const double bump = 16.0 * u[0] * (1.0 - u[0]) * u[1] * (1.0 - u[1]);
        return std::array<double, 3>{ u[0], u[1], u[2] * (1.0 - depth * bump) };
      });
    EXPECT_EQ(StarShaped(cells), std::vector<char>{ depth < 1.0 }) << depth;
  }
}

// Cells apart need no look at each other; one inside another is found.
TEST(StarShape, ManyComponentsApartAndNested_ExactOracle)
{
  std::mt19937 random(47);
  BernsteinCells cells;
  cells.NumComponents = 3;
  cells.Rational = true;
  for (int i = 0; i < 20; ++i)
  {
    AddRandomCell(cells, CellShape::Hexahedron, 2, 0.03, 3.0, 3.0 * i, random);
  }
  const InjectivityCertificate apart = Prove(cells);
  EXPECT_EQ(apart.Verdict, InjectivityVerdict::Injective);
  EXPECT_EQ(apart.NumBoundaryComponents, 20);
  BernsteinCells nested;
  nested.NumComponents = 3;
  AddRandomCell(nested, CellShape::Hexahedron, 1, 0.03, 0.0, 0.0, random);
  AddRandomCell(nested, CellShape::Hexahedron, 1, 0.03, 0.0, 0.0, random);
  for (int i = 0; i < 24; ++i)
  {
    nested.Block(1)[i] = 0.4 + 0.2 * nested.Block(1)[i];
  }
  const InjectivityCertificate inside = Prove(nested);
  EXPECT_EQ(inside.Verdict, InjectivityVerdict::NotInjective);
  EXPECT_EQ(inside.Reason, InjectivityReason::Overlap);
}
