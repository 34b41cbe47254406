// SPDX-License-Identifier: BSD-3-Clause
#include "JacobianCorpus.h"

#include <gtest/gtest.h>

#include <limits>

namespace knotwork
{
namespace
{
using namespace corpus;

BernsteinCells OneCell(
  CellShape shape, const CellDegree& degree, const std::vector<Polynomial>& map)
{
  oracle::Random random(1);
  BernsteinCells cells;
  Disguise plain;
  plain.Linear = false;
  AddCell(cells, shape, degree, map, plain, random);
  return cells;
}

BernsteinCells Square()
{
  return OneCell(CellShape::Quadrilateral, { 1, 1, 0 }, { Parameter(0), Parameter(1) });
}

Polynomial Valley(const std::array<double, 4>& line, Real number)
{
  const Polynomial l = Real(line[0]) * Parameter(0) + Real(line[1]) * Parameter(1) +
    Real(line[2]) * Parameter(2) + Constant(Real(line[3]));
  return l * l + Constant(number);
}

/// det J = l^2 + number along a line that cuts the square askew: decided down to 1e-8.
TEST(ValidateJacobian, ValleysInThePlane_ExactOracle)
{
  oracle::Random random(1);
  for (const double number : { 1e-4, 1e-6, 1e-8, -1e-4, -1e-6, -1e-8 })
  {
    for (const auto& line : { std::array<double, 4>{ 1.0, -0.83, 0.0, -0.07 },
           std::array<double, 4>{ 0.6, 0.9, 0.0, -0.71 } })
    {
      const BernsteinCells cells =
        OneCell(CellShape::Quadrilateral, { 3, 3, 0 }, MapOf(Valley(line, number), 2, random));
      const auto result = ValidateJacobian(cells);
      ASSERT_TRUE(result);
      EXPECT_EQ(result.Value.Verdict, number > 0.0 ? Verdict::Valid : Verdict::Invalid)
        << number << " boxes " << result.Value.Boxes;
      EXPECT_LE(result.Value.Boxes, 1000000);
      EXPECT_LE(result.Value.MinLower, number + 1e-12);
      ::testing::Test::RecordProperty(
        number > 0 ? "boxes" : "foldedBoxes", static_cast<int>(result.Value.Boxes));
    }
  }
}

TEST(ValidateJacobian, ValleysInSpace_ExactOracle)
{
  oracle::Random random(1);
  for (const double number : { 1e-2, 1e-4, -1e-2, -1e-4 })
  {
    const BernsteinCells cells = OneCell(CellShape::Hexahedron, { 3, 2, 2 },
      MapOf(Valley({ 0.8, -0.7, 0.9, -0.52 }, number), 3, random));
    const auto result = ValidateJacobian(cells);
    ASSERT_TRUE(result);
    EXPECT_EQ(result.Value.Verdict, number > 0.0 ? Verdict::Valid : Verdict::Invalid)
      << number << " boxes " << result.Value.Boxes;
  }
}

/// A perfect square along a line that no dyadic point lies on is neither: the budget ends it, and
/// the bounds say how far it came.
TEST(ValidateJacobian, UndecidedNamesItsLimit_ExactOracle)
{
  oracle::Random random(1);
  const BernsteinCells cells = OneCell(CellShape::Quadrilateral, { 3, 3, 0 },
    MapOf(Valley({ 1.0, -1.0 / 3.0, 0.0, -0.1 }, 1e-13), 2, random));
  JacobianParams params;
  params.MaxBoxes = 20000;
  const auto result = ValidateJacobian(cells, params);
  ASSERT_TRUE(result);
  EXPECT_EQ(result.Value.Verdict, Verdict::Undecided);
  EXPECT_EQ(result.Value.Cells[0].Limit, JacobianLimit::Boxes);
  EXPECT_LE(result.Value.Boxes, 2 * params.MaxBoxes);
  EXPECT_LT(result.Value.MinLower, 0.0);
  EXPECT_GT(result.Value.MinLower, -1e-4);
  EXPECT_GT(result.Value.MinUpper, 0.0);
}

/// Bounds to a gap: of a bowl the minimum is the number, the maximum is at a corner.
TEST(ValidateJacobian, BoundsMeetTheGap_ExactOracle)
{
  oracle::Random random(5);
  for (const double gap : { 0.5, 1e-1, 1e-3, 1e-6 })
  {
    for (int seed = 0; seed < 10; ++seed)
    {
      const std::array<double, 3> at = InnerPoint(random, CellShape::Quadrilateral);
      const double number = std::pow(10.0, random.In(-3.0, 1.0));
      const Polynomial g = Bowl(at, 2, number);
      const BernsteinCells cells =
        OneCell(CellShape::Quadrilateral, { 4, 3, 0 }, MapOf(g, 2, random));
      JacobianParams params;
      params.RelativeGap = gap;
      params.ComputeMax = true;
      const auto result = ValidateJacobian(cells, params);
      ASSERT_TRUE(result);
      const CellCertificate& c = result.Value.Cells[0];
      double largest = 0.0;
      for (int k = 0; k < 4; ++k)
      {
        largest = std::max(
          largest, static_cast<double>(Evaluate(g, CornerParameters(CellShape::Quadrilateral, k))));
      }
      const double rounding = 1e-13;
      EXPECT_LE(c.MinLower, number + rounding);
      EXPECT_GE(c.MinUpper, number - rounding);
      EXPECT_LE(c.MaxLower, largest + rounding);
      EXPECT_GE(c.MaxUpper, largest - rounding);
      EXPECT_LE(c.MinUpper - c.MinLower, gap * c.MinUpper);
      EXPECT_LE(c.MaxUpper - c.MaxLower, gap * c.MaxUpper);
      const auto check = VerifyCertificate(cells, result.Value, 3000);
      EXPECT_EQ(check.Refuted, 0) << check.FirstRefuted;
    }
  }
}

/// Rational bounds converge too: (x, y) / (1 + x / 2) of the unit square has det J = (1 + x /
/// 2)^-3.
TEST(ValidateJacobian, RationalBoundsMeetTheGap_ExactOracle)
{
  BernsteinCells cells;
  cells.NumComponents = 2;
  cells.Rational = true;
  cells.Add(CellShape::Quadrilateral, { 1, 1, 0 });
  cells.Data = { 0, 1, 0, 1, 0, 0, 1, 1, 1, 1.5, 1, 1.5 };
  for (const double gap : { 1e-2, 1e-5 })
  {
    JacobianParams params;
    params.RelativeGap = gap;
    params.ComputeMax = true;
    const auto result = ValidateJacobian(cells, params);
    ASSERT_TRUE(result);
    const CellCertificate& c = result.Value.Cells[0];
    const double smallest = std::pow(1.5, -3);
    EXPECT_LE(c.MinLower, smallest);
    EXPECT_GE(c.MinUpper, smallest);
    EXPECT_LE(c.MinUpper - c.MinLower, gap * c.MinUpper);
    EXPECT_LE(c.MaxLower, 1.0);
    EXPECT_GE(c.MaxUpper, 1.0);
    EXPECT_LE(c.MaxUpper - c.MaxLower, gap * c.MaxUpper);
    EXPECT_EQ(VerifyCertificate(cells, result.Value).Refuted, 0);
  }
}

/// The witness of a folded square: det J <= Upper <= 0 there, by the second verifier and by hand.
TEST(ValidateJacobian, WitnessIsFolded_GoldenOracle)
{
  BernsteinCells cells = Square();
  cells.Data[3] = 0.25; // corner (1, 1) moves to (1/4, 1/4): det J = 1 - 3/4 u - 3/4 v
  cells.Data[7] = 0.25;
  const auto result = ValidateJacobian(cells);
  ASSERT_TRUE(result);
  EXPECT_EQ(result.Value.Verdict, Verdict::Invalid);
  ASSERT_EQ(result.Value.Witnesses.size(), 1u);
  const JacobianWitness& w = result.Value.Witnesses[0];
  EXPECT_EQ(w.Cell, 0);
  EXPECT_EQ(w.NumCorners, 4);
  const double det = 1.0 - 0.75 * w.Parameters[0] - 0.75 * w.Parameters[1];
  EXPECT_LE(det, w.Upper);
  EXPECT_LE(w.Upper, 0.0);
  EXPECT_LE(result.Value.MinUpper, w.Upper);
  const auto check = VerifyCertificate(cells, result.Value);
  EXPECT_EQ(check.Confirmed, 1) << check.FirstRefuted;
}

/// The verifier refutes what is wrong: it can fail.
TEST(VerifyCertificate, RefutesFalseClaims_PropertyOracle)
{
  const BernsteinCells square = Square();
  const auto good = ValidateJacobian(square);
  ASSERT_TRUE(good);
  EXPECT_EQ(VerifyCertificate(square, good.Value).Confirmed, 1);
  auto bad = good.Value;
  bad.Cells[0].Verdict = Verdict::Reversed;
  EXPECT_EQ(VerifyCertificate(square, bad).Refuted, 1);
  bad = good.Value;
  bad.Cells[0].Verdict = Verdict::Invalid;
  EXPECT_EQ(VerifyCertificate(square, bad).Refuted, 1);
  bad = good.Value;
  bad.Cells[0].MinLower = 1.01;
  bad.Cells[0].MinUpper = bad.Cells[0].MaxLower = bad.Cells[0].MaxUpper = 1.02;
  EXPECT_EQ(VerifyCertificate(square, bad).Refuted, 1);
  bad = good.Value;
  bad.Cells[0].MinUpper = 0.9;
  bad.Cells[0].MinLower = 0.8;
  EXPECT_EQ(VerifyCertificate(square, bad).Refuted, 1);
  BernsteinCells folded = square;
  folded.Data[3] = folded.Data[7] = 0.25;
  EXPECT_EQ(VerifyCertificate(folded, good.Value).Refuted, 1);
}

/// Verdicts, bounds and witnesses are the same to the last bit for any number of threads.
TEST(ValidateJacobian, ThreadsChangeNothing_PropertyOracle)
{
  oracle::Random random(9);
  BernsteinCells cells;
  for (int k = 0; k < 3000; ++k)
  {
    const double number = std::pow(10.0, random.In(-9.0, 0.0)) * (k % 7 == 0 ? -1.0 : 1.0);
    AddCell(cells, CellShape::Quadrilateral, { 3, 3 + k % 2, 0 },
      MapOf(Bowl(InnerPoint(random, CellShape::Quadrilateral), 2, number), 2, random), {}, random);
  }
  JacobianParams params;
  params.RelativeGap = 0.1;
  params.Threads = 1;
  const auto one = ValidateJacobian(cells, params);
  params.Threads = 4;
  const auto four = ValidateJacobian(cells, params);
  ASSERT_TRUE(one && four);
  for (std::size_t c = 0; c < one.Value.Cells.size(); ++c)
  {
    const CellCertificate& a = one.Value.Cells[c];
    const CellCertificate& b = four.Value.Cells[c];
    EXPECT_EQ(a.Verdict, b.Verdict);
    EXPECT_EQ(a.Boxes, b.Boxes);
    EXPECT_EQ(a.MinLower, b.MinLower);
    EXPECT_EQ(a.MaxUpper, b.MaxUpper);
    EXPECT_EQ(a.Witness, b.Witness);
    if (a.Witness >= 0)
    {
      EXPECT_EQ(one.Value.Witnesses[static_cast<std::size_t>(a.Witness)].Parameters,
        four.Value.Witnesses[static_cast<std::size_t>(b.Witness)].Parameters);
    }
  }
}

/// Scaling by powers of two, far beyond the filter's range, changes no verdict.
TEST(ValidateJacobian, ExtremeMagnitudesAreExact_PropertyOracle)
{
  oracle::Random random(10);
  for (const int power : { -900, -400, -150, 150, 400 })
  {
    for (const int sign : { 1, -1 })
    {
      BernsteinCells cells;
      Disguise plain;
      AddCell(cells, CellShape::Quadrilateral, { 3, 2, 0 },
        MapOf(Bowl({ 0.4, 0.3, 0.0 }, 2, sign * 1e-3), 2, random), plain, random);
      for (double& x : cells.Data)
      {
        x = std::ldexp(x, power);
      }
      const auto result = ValidateJacobian(cells);
      ASSERT_TRUE(result);
      EXPECT_EQ(result.Value.Verdict, sign > 0 ? Verdict::Valid : Verdict::Invalid) << power;
    }
  }
}

/// One unit in the last place decides: det J of a thin parallelogram is exactly -2^-52, 0 or 2^-52.
TEST(ValidateJacobian, LastBitDecides_ExactOracle)
{
  JacobianParams strict;
  strict.CollapseTolerance = 0.0;
  const double eps = std::numeric_limits<double>::epsilon();
  const struct
  {
    double Corner;
    Verdict Expected;
  } cases[] = { { 1.0 + eps, Verdict::Valid }, { 1.0, Verdict::Invalid },
    { 1.0 - eps, Verdict::Reversed } };
  for (const auto& c : cases)
  {
    BernsteinCells cells;
    cells.NumComponents = 2;
    cells.Add(CellShape::Triangle, { 1, 1, 0 });
    cells.Data = { 0.0, 1.0, 1.0, 0.0, 1.0, c.Corner }; // (0,0), (1,1), (1,c): det = c - 1
    const auto result = ValidateJacobian(cells, strict);
    ASSERT_TRUE(result);
    EXPECT_EQ(result.Value.Verdict, c.Expected);
    EXPECT_EQ(VerifyCertificate(cells, result.Value).Confirmed, 1);
  }
}

/// A stated error of the coefficients is part of the claim.
TEST(ValidateJacobian, GivenErrorsAreInside_PropertyOracle)
{
  BernsteinCells cells = Square();
  cells.Errors = { 1e-3 };
  auto result = ValidateJacobian(cells);
  ASSERT_TRUE(result);
  EXPECT_EQ(result.Value.Verdict, Verdict::Valid);
  EXPECT_LE(result.Value.MinLower, (1.0 - 2e-3) * (1.0 - 2e-3) - 4e-6);
  cells.Errors = { 0.6 };
  result = ValidateJacobian(cells);
  ASSERT_TRUE(result);
  EXPECT_EQ(result.Value.Verdict, Verdict::Undecided);
  EXPECT_EQ(result.Value.Cells[0].Limit, JacobianLimit::Precision);
}

/// Curves: |C_u| of a parabola is positive; a cusp is a zero.
TEST(ValidateJacobian, CurvesInSpace_ExactOracle)
{
  const Polynomial t = Parameter(0) + Constant(Real(-0.5));
  auto result =
    ValidateJacobian(OneCell(CellShape::Curve, { 3, 0, 0 }, { Parameter(0), t * t, t * t * t }));
  ASSERT_TRUE(result) << result.Status.Message();
  EXPECT_EQ(result.Value.Verdict, Verdict::Valid);
  EXPECT_TRUE(result.Value.Cells[0].OneSided);
  EXPECT_LE(result.Value.MinLower, 1.0);
  EXPECT_GE(result.Value.MinUpper, 1.0);
  result = ValidateJacobian(
    OneCell(CellShape::Curve, { 3, 0, 0 }, { Real(12) * (t * t), Real(8) * (t * t * t) }));
  ASSERT_TRUE(result);
  EXPECT_EQ(result.Value.Verdict, Verdict::Invalid);
  ASSERT_EQ(result.Value.Witnesses.size(), 1u);
  EXPECT_EQ(result.Value.Witnesses[0].Parameters[0], 0.5);
}

TEST(ValidateJacobian, EveryFailureIsReachable)
{
  const BernsteinCells good = Square();
  const auto code = [](const BernsteinCells& cells, const JacobianParams& params)
  { return ValidateJacobian(cells, params).Status.Code; };
  JacobianParams params;
  params.RelativeGap = 0.0;
  EXPECT_EQ(code(good, params), ErrorCode::InvalidParameter);
  params = {};
  params.MaxBoxes = 0;
  EXPECT_EQ(code(good, params), ErrorCode::InvalidParameter);
  params = {};
  params.CollapseTolerance = 1.0;
  EXPECT_EQ(code(good, params), ErrorCode::InvalidParameter);
  params = {};
  params.Threads = -1;
  EXPECT_EQ(code(good, params), ErrorCode::InvalidParameter);
  BernsteinCells empty;
  empty.NumComponents = 2;
  EXPECT_EQ(code(empty, {}), ErrorCode::EmptyInput);
  BernsteinCells flat;
  flat.NumComponents = 2;
  flat.Add(CellShape::Hexahedron, { 1, 1, 1 });
  EXPECT_EQ(code(flat, {}), ErrorCode::DimensionMismatch);
  BernsteinCells nan = good;
  nan.Data[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code(nan, {}), ErrorCode::NonFiniteInput);
  EXPECT_EQ(
    ValidateJacobian(good, {}, [](double) { return false; }).Status.Code, ErrorCode::Aborted);
}
}
}
