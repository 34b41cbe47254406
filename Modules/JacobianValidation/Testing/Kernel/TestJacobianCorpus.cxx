// SPDX-License-Identifier: BSD-3-Clause
// Thousands of cells whose verdict is known by construction (JacobianCorpus.h). No verdict may be
// wrong; none may be undecided here. A sample goes through the second verifier, whose integers take
// their time.
#include "JacobianCorpus.h"
#include <knotwork/JacobianValidation/CellMaps.h>
#include <knotwork/SplineCore/HierarchicalSpace.h>
#include <knotwork/SplineCore/Shapes.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace knotwork
{
namespace
{
using namespace corpus;

struct Case
{
  std::string Name;
  BernsteinCells Cells;
  Verdict Expected = Verdict::Valid;
  bool Degenerate = false;
  bool Verify = false;
};

int RunCase(const Case& c)
{
  const auto result = ValidateJacobian(c.Cells, { 1.0, false, 1000000, 0x1p-48, 1 });
  EXPECT_TRUE(result) << c.Name << ": " << result.Status.Message();
  if (!result)
  {
    return 0;
  }
  EXPECT_EQ(result.Value.Verdict, c.Expected)
    << c.Name << " boxes " << result.Value.Boxes << " min " << result.Value.MinLower << " .. "
    << result.Value.MinUpper << " limit " << static_cast<int>(result.Value.Cells[0].Limit);
  if (c.Expected == Verdict::Valid)
  {
    EXPECT_EQ(result.Value.NumDegenerate > 0, c.Degenerate) << c.Name;
  }
  if (c.Verify)
  {
    const auto check = VerifyCertificate(c.Cells, result.Value, 500);
    EXPECT_EQ(check.Refuted, 0) << c.Name << ": " << check.FirstRefuted;
  }
  return 1;
}

const char* const ShapeNames[] = { "curve", "quadrilateral", "hexahedron", "triangle",
  "tetrahedron", "wedge" };
constexpr CellShape Determinants[] = { CellShape::Quadrilateral, CellShape::Hexahedron,
  CellShape::Triangle, CellShape::Tetrahedron, CellShape::Wedge };

/// Bowls whose lowest value is +-10^-k inside the cell, disguised.
TEST(JacobianCorpus, BowlsInEveryShape_ExactOracle)
{
  int cases = 0;
  oracle::Random random(11);
  for (const CellShape shape : Determinants)
  {
    const int n = NumParameters(shape);
    for (int seed = 0; seed < 13; ++seed)
    {
      for (int k = 1; k <= 12; ++k)
      {
        for (const int sign : { 1, -1 })
        {
          const int lowest = 3;
          const int most = n == 2 ? 6 : seed % 13 == 0 ? 5 : 4;
          const CellDegree degree = DegreeOf(shape, random.Int(lowest, most),
            random.Int(lowest - 1, most), random.Int(lowest - 1, n == 2 ? 3 : 3));
          Case c;
          Disguise disguise;
          disguise.Reverse = random.Unit() < 0.3;
          disguise.Rational = random.Unit() < 0.4 && (n == 2 || k < 12);
          if (disguise.Rational)
          {
            disguise.Projective = random.In(-0.8, 0.8);
            // weights up to a thousand apart
            for (int d = 0; d < n; ++d)
            {
              disguise.Log2Weights[static_cast<std::size_t>(d)] = random.Int(-2, 2);
            }
          }
          const Polynomial g = Bowl(InnerPoint(random, shape), n, sign * std::pow(Real(10), -k));
          AddCell(c.Cells, shape, degree, MapOf(g, n, random), disguise, random);
          c.Expected = sign < 0 ? Verdict::Invalid
            : disguise.Reverse  ? Verdict::Reversed
                                : Verdict::Valid;
          c.Name = std::string(ShapeNames[static_cast<int>(shape)]) + " seed " +
            std::to_string(seed) + " number " + std::to_string(sign) + "e-" + std::to_string(k) +
            (disguise.Rational ? " rational" : "") + (disguise.Reverse ? " reversed" : "");
          c.Verify = n == 2 && seed == 0 && k % 4 == 1;
          cases += RunCase(c);
        }
      }
    }
  }
  EXPECT_EQ(cases, 5 * 13 * 24);
}

/// Bowls under weights from 2^-10 to 2^10 in every shape; those of two corners are the extremes.
TEST(JacobianCorpus, WeightsOverSixDecades_ExactOracle)
{
  int cases = 0;
  oracle::Random random(18);
  for (const CellShape shape : Determinants)
  {
    const int n = NumParameters(shape);
    for (int seed = 0; seed < (n == 2 ? 8 : 3); ++seed)
    {
      for (int k = 1; k <= 10; k += 3)
      {
        for (const int sign : { 1, -1 })
        {
          // 2 * 5 in the first direction less 2 * 5 in the second: 20 powers of two in all; the
          // third adds none in wedges and hexahedra
          const CellDegree degree = DegreeOf(shape, 5, 5, n == 3 ? 2 : 0);
          Case c;
          Disguise disguise;
          disguise.Rational = true;
          disguise.Reverse = seed % 4 == 3;
          disguise.Log2Weights =
            seed % 2 == 0 ? std::array<int, 3>{ 2, -2, 0 } : std::array<int, 3>{ -2, 2, 0 };
          const Polynomial g = Bowl(InnerPoint(random, shape), n, sign * std::pow(Real(10), -k));
          AddCell(c.Cells, shape, degree, MapOf(g, n, random), disguise, random);
          const std::size_t size = static_cast<std::size_t>(NumCellCoefficients(shape, degree));
          const auto weights = c.Cells.Data.begin() + static_cast<std::ptrdiff_t>(n * size);
          const auto [least, most] = std::minmax_element(weights, weights + size);
          EXPECT_LE(*least, 1e-3);
          EXPECT_GE(*most, 1e3);
          c.Expected = sign < 0 ? Verdict::Invalid
            : disguise.Reverse  ? Verdict::Reversed
                                : Verdict::Valid;
          c.Name = std::string("weights ") + ShapeNames[static_cast<int>(shape)] + " seed " +
            std::to_string(seed) + " number " + std::to_string(sign) + "e-" + std::to_string(k);
          c.Verify = n == 2 && seed == 0 && k == 4;
          cases += RunCase(c);
        }
      }
    }
  }
  EXPECT_EQ(cases, (2 * 8 + 3 * 3) * 4 * 2);
}

/// Maps of constant determinant: triangular polynomial maps with whole coefficients.
TEST(JacobianCorpus, ConstantDeterminants_ExactOracle)
{
  int cases = 0;
  oracle::Random random(12);
  for (const CellShape shape : Determinants)
  {
    const int n = NumParameters(shape);
    for (int seed = 0; seed < 40; ++seed)
    {
      const int p = random.Int(2, n == 2 ? 6 : 3);
      std::vector<Polynomial> map{ Parameter(0), Parameter(1), Parameter(2) };
      map.resize(static_cast<std::size_t>(n));
      map[0] = map[0] + Real(random.Int(-2, 2)) * (Parameter(1) * Parameter(1));
      if (n == 3)
      {
        map[0] = map[0] + Real(random.Int(-2, 2)) * (Parameter(2) * Parameter(2));
        map[1] = map[1] + Real(random.Int(-2, 2)) * (Parameter(2) * Parameter(2));
      }
      Case c;
      Disguise disguise;
      disguise.Reverse = seed % 4 == 1;
      disguise.Rational = seed % 2 == 1;
      disguise.Projective = 0.5;
      disguise.Offset = seed % 5 == 0 ? 100 : 0;
      disguise.Log2Weights = { random.Int(-3, 3), random.Int(-3, 3), random.Int(-1, 1) };
      AddCell(c.Cells, shape, DegreeOf(shape, p, p, n == 3 ? 2 : p), map, disguise, random);
      c.Expected = disguise.Reverse ? Verdict::Reversed : Verdict::Valid;
      c.Name =
        std::string("constant ") + ShapeNames[static_cast<int>(shape)] + " " + std::to_string(seed);
      c.Verify = n == 2 && seed < 4;
      cases += RunCase(c);
    }
  }
  EXPECT_EQ(cases, 200);
}

/// det J = a product of parameters times a bowl: zero on edges, faces and vertices, all legal, or
/// folded beside.
TEST(JacobianCorpus, DegenerateCells_ExactOracle)
{
  int cases = 0;
  oracle::Random random(13);
  for (const CellShape shape : Determinants)
  {
    const int n = NumParameters(shape);
    for (int seed = 0; seed < 24; ++seed)
    {
      for (const int sign : { 1, -1 })
      {
        // vertex: u + v; edges or faces: u, v, u v
        const Polynomial zeros[] = { Parameter(0), Parameter(1), Parameter(0) * Parameter(1),
          Parameter(0) + Parameter(1), Parameter(0) * Parameter(0) };
        // exact control points: whole multiples of the degrees' least common multiple
        std::array<double, 3> at{};
        for (int d = 0; d < n; ++d)
        {
          at[static_cast<std::size_t>(d)] = 0.25;
        }
        const Polynomial g = Real(240 * 64) *
          (zeros[seed % 5] * Bowl(at, n, sign * std::ldexp(Real(1), -4 - seed % 5)));
        Case c;
        Disguise disguise;
        disguise.Reverse = seed % 3 == 1;
        const int p = 5;
        const CellDegree degree =
          DegreeOf(shape, p, 4, n == 3 && shape == CellShape::Hexahedron ? 2 : 4);
        std::vector<Polynomial> map = MapOf(g, n, random);
        for (std::size_t d = 1; d < map.size(); ++d)
        {
          map[d] = Real(60) * map[d];
        }
        AddCell(c.Cells, shape, degree, map, disguise, random);
        c.Expected = sign < 0 ? Verdict::Invalid
          : disguise.Reverse  ? Verdict::Reversed
                              : Verdict::Valid;
        c.Degenerate = true;
        c.Name = std::string("degenerate ") + ShapeNames[static_cast<int>(shape)] + " " +
          std::to_string(seed) + (sign < 0 ? " folded" : "");
        cases += RunCase(c);
      }
    }
  }
  EXPECT_EQ(cases, 240);
}

/// A collapsed edge with rounding in it: the pole lies anywhere.
TEST(JacobianCorpus, CollapsedEdgesWithRounding_ExactOracle)
{
  int cases = 0;
  oracle::Random random(14);
  for (int seed = 0; seed < 120; ++seed)
  {
    // (x, y) = pole + u (a(v), b(v)), det = u (a b' - a' b) with a = 1 - v / 2, b = v: u
    const Polynomial a = Constant(1) + Real(-0.5) * Parameter(1);
    std::vector<Polynomial> map{ Parameter(0) * a, Parameter(0) * Parameter(1) };
    Case c;
    Disguise disguise;
    disguise.Rational = seed % 2 == 0;
    disguise.Projective = disguise.Rational ? 0.3 : 0;
    disguise.Offset = random.In(-3, 3);
    disguise.Log2Weights = { 0, seed % 3, 0 };
    const bool solid = seed % 4 == 3;
    if (solid)
    {
      map.push_back(Parameter(2) + Parameter(2) * Parameter(2));
    }
    AddCell(c.Cells, solid ? CellShape::Hexahedron : CellShape::Quadrilateral,
      { random.Int(1, 3), random.Int(1, 4), solid ? 2 : 0 }, map, disguise, random);
    c.Degenerate = true;
    c.Name = "collapsed " + std::to_string(seed);
    cases += RunCase(c);
  }
  EXPECT_EQ(cases, 120);
}

/// Edges that stand still, with rounding in the point beside: the control points of a box, of which
/// those of the edge u = 0, v = 0 have the next ones in u in the same place.
TEST(JacobianCorpus, EdgesThatStandStillWithRounding_ExactOracle)
{
  oracle::Random random(23);
  int forgiven = 0;
  for (int seed = 0; seed < 60; ++seed)
  {
    SCOPED_TRACE(seed);
    const int degree = random.Int(2, 3);
    const CellDegree degrees{ degree, random.Int(1, 2), random.Int(1, 2) };
    const bool rational = seed % 3 == 0;
    const double offset = random.In(-3, 3);
    const auto cell = [&](double noise)
    {
      BernsteinCells cells;
      cells.NumComponents = 3;
      cells.Rational = rational;
      cells.Add(CellShape::Hexahedron, degrees);
      oracle::Random shake(static_cast<unsigned>(seed));
      const std::size_t n = cells.Data.size() / (rational ? 4 : 3);
      std::size_t at = 0;
      for (int k = 0; k <= degrees[2]; ++k)
      {
        for (int j = 0; j <= degrees[1]; ++j)
        {
          for (int i = 0; i <= degrees[0]; ++i, ++at)
          {
            const bool still = i == 1 && j == 0;
            // u^2 in the place of u there: whole numbers over powers of two, exact but for noise
            const double x[3] = { still ? 0.0 : double(i), double(j), double(k) };
            const double w = rational ? std::ldexp(1.0, (i + j + k) % 2) : 1.0;
            for (std::size_t c = 0; c < 3; ++c)
            {
              const double moved = still ? noise * shake.In(-1, 1) : 0.0;
              cells.Data[c * n + at] = w * (std::ldexp(std::round(offset * 64), -6) + x[c] + moved);
            }
            if (rational)
            {
              cells.Data[3 * n + at] = w;
            }
          }
        }
      }
      return cells;
    };
    const auto prove = [&](double noise, double tolerance)
    {
      JacobianParams params;
      params.CollapseTolerance = tolerance;
      return ValidateJacobian(cell(noise), params).Value.Cells[0];
    };
    const CellCertificate exact = prove(0.0, 0.0);
    EXPECT_EQ(exact.Verdict, Verdict::Valid);
    EXPECT_EQ(exact.Degenerate & DegenerateEdge, DegenerateEdge);
    const CellCertificate noise = prove(4e-16 * (1 + std::fabs(offset)), 0x1p-48);
    EXPECT_EQ(noise.Verdict, Verdict::Valid);
    EXPECT_EQ(noise.Degenerate & DegenerateEdge, DegenerateEdge);
    const CellCertificate strict = prove(4e-16 * (1 + std::fabs(offset)), 0.0);
    EXPECT_TRUE(strict.Verdict != Verdict::Valid || strict.Degenerate == 0 || noise.Snapped);
    forgiven += strict.Verdict == Verdict::Invalid && noise.Snapped;
    // more than rounding is judged as it is
    const CellCertificate fold = prove(1e-9, 0x1p-48);
    EXPECT_EQ(fold.Verdict, prove(1e-9, 0.0).Verdict);
    EXPECT_FALSE(fold.Snapped);
  }
  EXPECT_GT(forgiven, 10);
}

/// Surfaces: graphs over planar maps (valid), cusps along a line (zero normal), flat ones.
TEST(JacobianCorpus, Surfaces_ExactOracle)
{
  int cases = 0;
  oracle::Random random(15);
  for (int seed = 0; seed < 120; ++seed)
  {
    const CellShape shape = seed % 3 == 0 ? CellShape::Triangle : CellShape::Quadrilateral;
    const int k = 1 + seed % 10;
    Case c;
    Disguise disguise;
    disguise.Rational = seed % 2 == 1;
    disguise.Projective = 0.4;
    const CellDegree degree = DegreeOf(shape, random.Int(3, 5), random.Int(2, 4), 0);
    std::vector<Polynomial> map =
      MapOf(Bowl(InnerPoint(random, shape), 2, std::pow(Real(10), -k)), 2, random);
    map.push_back(
      Parameter(0) * Parameter(1) + Real(random.Int(-1, 1)) * (Parameter(1) * Parameter(1)));
    AddCell(c.Cells, shape, degree, map, disguise, random);
    c.Name = "graph " + std::to_string(seed);
    cases += RunCase(c);
  }
  for (int seed = 0; seed < 60; ++seed)
  {
    // (12 t^2, 8 t^3, v) with t = u - 1/2: whole control points, zero normal at t = 0
    const Polynomial t = Parameter(0) + Constant(Real(-0.5));
    std::vector<Polynomial> map{ Real(12) * (t * t), Real(8) * (t * t * t), Parameter(1) };
    Case c;
    AddCell(
      c.Cells, CellShape::Quadrilateral, { 3, random.Int(1, 2) > 1 ? 2 : 1, 0 }, map, {}, random);
    c.Expected = Verdict::Invalid;
    c.Name = "cusp " + std::to_string(seed);
    c.Verify = seed < 3;
    cases += RunCase(c);
  }
  for (int seed = 0; seed < 60; ++seed)
  {
    const int sign = seed % 2 == 0 ? 1 : -1;
    std::vector<Polynomial> map = MapOf(Bowl(InnerPoint(random, CellShape::Quadrilateral), 2,
                                          sign * std::pow(Real(10), -1 - seed % 12)),
      2, random);
    Case c;
    BernsteinCells planar;
    Disguise disguise;
    disguise.Reverse = seed % 3 == 0;
    AddCell(planar, CellShape::Quadrilateral, { 3, 3, 0 }, map, disguise, random);
    c.Cells.NumComponents = 3;
    c.Cells.Add(CellShape::Quadrilateral, { 3, 3, 0 });
    const int plane = seed % 3; // which coordinate is constant
    for (int i = 0; i < 16; ++i)
    {
      c.Cells.Data[static_cast<std::size_t>(plane * 16 + i)] = 7.0;
      c.Cells.Data[static_cast<std::size_t>((plane + 1) % 3 * 16 + i)] =
        planar.Data[static_cast<std::size_t>(i)];
      c.Cells.Data[static_cast<std::size_t>((plane + 2) % 3 * 16 + i)] =
        planar.Data[static_cast<std::size_t>(16 + i)];
    }
    c.Expected = sign < 0 ? Verdict::Invalid : Verdict::Valid;
    c.Name = "flat " + std::to_string(seed);
    c.Verify = seed < 8;
    cases += RunCase(c);
  }
  EXPECT_EQ(cases, 240);
}

/// Small whole numbers: zeros at corners, along edges and inside abound. What is decided, the
/// second verifier confirms.
TEST(JacobianCorpus, WholeNumberCells_CrossOracle)
{
  oracle::Random random(17);
  JacobianParams strict;
  strict.CollapseTolerance = 0.0;
  strict.MaxBoxes = 2000;
  int confirmed = 0;
  int decided = 0;
  for (int trial = 0; trial < 1500; ++trial)
  {
    const CellShape shape = Determinants[trial % 5];
    const int n = NumParameters(shape);
    const CellDegree degree =
      DegreeOf(shape, random.Int(1, n == 2 ? 2 : 1), random.Int(1, n == 2 ? 2 : 1), 1);
    BernsteinCells cells;
    cells.NumComponents = trial % 7 == 6 ? 3 : n;
    cells.Rational = trial % 3 == 2;
    const int size = NumCellCoefficients(shape, degree);
    cells.Add(shape, degree);
    for (int k = 0; k <= degree[2]; ++k)
    {
      for (int j = 0; j <= degree[1]; ++j)
      {
        for (int i = 0; i <= degree[0]; ++i)
        {
          const bool simplex = shape != CellShape::Quadrilateral && shape != CellShape::Hexahedron;
          if (simplex && i + j + (shape == CellShape::Tetrahedron ? k : 0) > degree[0])
          {
            continue;
          }
          const int at = CellCoefficient(shape, degree, i, j, k);
          const int index[3] = { i, j, k };
          for (int c = 0; c < cells.NumComponents; ++c)
          {
            cells.Data[static_cast<std::size_t>(c * size + at)] =
              (c < n ? index[c] : 0) + (random.Unit() < 0.35 ? random.Int(-1, 1) : 0);
          }
          if (cells.Rational)
          {
            cells.Data[static_cast<std::size_t>(cells.NumComponents * size + at)] =
              random.Int(1, 3);
          }
        }
      }
    }
    const auto result = ValidateJacobian(cells, strict);
    ASSERT_TRUE(result);
    const auto check = VerifyCertificate(cells, result.Value, 200);
    EXPECT_EQ(check.Refuted, 0) << "trial " << trial << " shape " << static_cast<int>(shape) << " "
                                << check.FirstRefuted << " verdict "
                                << static_cast<int>(result.Value.Verdict);
    confirmed += check.Confirmed;
    decided += result.Value.Verdict != Verdict::Undecided;
  }
  EXPECT_GT(decided, 1400);
  EXPECT_GT(confirmed, 1100);
}

/// A bowl on a hierarchical mesh of five levels: the folded element is the one that has the point.
TEST(JacobianCorpus, HierarchicalMapsOverFiveLevels_ExactOracle)
{
  oracle::Random random(16);
  int cases = 0;
  for (int seed = 0; seed < 12; ++seed)
  {
    for (const int sign : { 1, -1 })
    {
      const auto at = InnerPoint(random, CellShape::Quadrilateral);
      const Real number = sign * std::pow(Real(10), -4 - seed % 9);
      BernsteinCells one;
      AddCell(one, CellShape::Quadrilateral, { 3, 3, 0 }, MapOf(Bowl(at, 2, number), 2, random), {},
        random);
      Spline<2> spline;
      spline.Space =
        MakeTensorSpace<2>({ KnotVector::Uniform(3, 1), KnotVector::Uniform(3, 1) }).Value;
      spline.ControlPoints.resize(16, 2);
      for (int i = 0; i < 16; ++i)
      {
        spline.ControlPoints(i, 0) = one.Data[static_cast<std::size_t>(i)];
        spline.ControlPoints(i, 1) = one.Data[static_cast<std::size_t>(16 + i)];
      }
      auto space = spline.Space;
      for (int level = 0; level < 5; ++level)
      {
        double local[2];
        const int e = space->Locate(at.data(), local);
        RefinementParams params;
        params.Extension = 2;
        space = RefineElements<2>(space, { e }, params).Value;
      }
      const auto fine = TransferToRefined<2>(spline, space);
      ASSERT_TRUE(fine) << fine.Status.Message();
      int deepest = 0;
      for (const auto& element : space->Elements)
      {
        deepest = std::max(deepest, element.Level);
      }
      EXPECT_GE(deepest, 5);
      const BernsteinCells cells = MakeBernsteinCells(MakeBezierForm(fine.Value));
      const auto result = ValidateJacobian(cells);
      ASSERT_TRUE(result);
      EXPECT_EQ(result.Value.NumUndecided, 0);
      EXPECT_EQ(result.Value.Verdict, sign > 0 ? Verdict::Valid : Verdict::Invalid) << seed;
      if (sign < 0)
      {
        double local[2];
        const int folded = space->Locate(at.data(), local);
        EXPECT_EQ(result.Value.Cells[static_cast<std::size_t>(folded)].Verdict, Verdict::Invalid);
        for (const JacobianWitness& w : result.Value.Witnesses)
        {
          // the fold is a disc of radius sqrt(-number) about the point
          const auto& box = space->Elements[static_cast<std::size_t>(w.Cell)].Box;
          double distance = 0.0;
          for (std::size_t d = 0; d < 2; ++d)
          {
            const double x = box.Lower[d] + w.Parameters[d] * (box.Upper[d] - box.Lower[d]) - at[d];
            distance += x * x;
          }
          EXPECT_LE(distance, -static_cast<double>(number) * (1.0 + 1e-3) + 1e-14);
        }
      }
      ++cases;
    }
  }
  EXPECT_EQ(cases, 24);
}

/// Every ready-made shape is valid, wherever it lies; degenerate where its words say so.
TEST(JacobianCorpus, ReadyMadeShapes_ExactOracle)
{
  for (int kind = 0; kind < NumShapeKinds; ++kind)
  {
    for (const double offset : { 0.0, 0.37, -2.1 })
    {
      ShapeParams params;
      params.Kind = static_cast<ShapeKind>(kind);
      params.Center = { offset, 2.0 * offset, -offset };
      params.Elements = { 2, 2, 2 };
      bool degenerate = params.Kind == ShapeKind::PolarSphereSurface;
      if (params.Kind == ShapeKind::BallSector)
      {
        params.InnerRadius = 0.0;
        degenerate = true;
      }
      if (params.Kind == ShapeKind::PlateWithHole || params.Kind == ShapeKind::QuarterPlateWithHole)
      {
        params.Size = { 3.0, 3.0, 1.0 };
      }
      const auto shape = MakeShape(params);
      ASSERT_TRUE(shape) << shape.Status.Message();
      int numDegenerate = 0;
      for (const AnySpline& patch : shape.Value)
      {
        const BernsteinCells cells = std::visit(
          [](const auto& spline) { return MakeBernsteinCells(MakeBezierForm(spline)); }, patch);
        ASSERT_EQ(cells.NumComponents, 3);
        const auto result = ValidateMaps(cells, FindCellMaps(cells, {}));
        ASSERT_TRUE(result) << result.Status.Message();
        EXPECT_EQ(result.Value.Verdict, Verdict::Valid)
          << ToString(params.Kind) << " at " << offset << ": " << result.Value.NumInvalid
          << " invalid, " << result.Value.NumUndecided << " undecided, " << result.Value.MinLower;
        numDegenerate += result.Value.NumDegenerate;
      }
      EXPECT_EQ(numDegenerate > 0, degenerate) << ToString(params.Kind) << " at " << offset;
    }
  }
}
}
}
