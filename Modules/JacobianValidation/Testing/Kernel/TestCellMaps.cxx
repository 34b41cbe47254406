// SPDX-License-Identifier: BSD-3-Clause
// What cells of a dataset are maps of, and that a certificate does not depend on what stands
// beside.
#include "SplineOracle.h"
#include <knotwork/JacobianValidation/CellMaps.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace knotwork
{
namespace
{
using Point = std::array<double, 3>;

/// A cell of degree 1 with these corners (in the order of coefficients) and weights.
void AddCorners(BernsteinCells& cells, CellShape shape, const std::vector<Point>& corners,
  const std::vector<double>& weights = {})
{
  cells.NumComponents = 3;
  const CellDegree degree = shape == CellShape::Hexahedron ? CellDegree{ 1, 1, 1 }
    : shape == CellShape::Curve                            ? CellDegree{ 1, 0, 0 }
                                                           : CellDegree{ 1, 1, 0 };
  double* block = cells.Block(cells.Add(shape, degree));
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i)
  {
    const double w = weights.empty() ? 1.0 : weights[i];
    for (std::size_t d = 0; d < 3; ++d)
    {
      block[d * n + i] = w * corners[i][d];
    }
    if (cells.Rational)
    {
      block[3 * n + i] = w;
    }
  }
}

std::vector<Point> Quad(double x, double y, double z, bool clockwise = false)
{
  std::vector<Point> corners{ { x, y, z }, { x + 1, y, z }, { x, y + 1, z }, { x + 1, y + 1, z } };
  if (clockwise)
  {
    std::swap(corners[1], corners[2]);
  }
  return corners;
}

std::vector<Point> Cube(double x)
{
  std::vector<Point> corners = Quad(x, 0, 0);
  const std::vector<Point> top = Quad(x, 0, 1);
  corners.insert(corners.end(), top.begin(), top.end());
  return corners;
}

/// The outer side of a cube, each square turned outward.
BernsteinCells BoxSurface(double gap)
{
  BernsteinCells cells;
  const double g = 1.0 + gap;
  const auto add = [&](Point a, Point b, Point c, Point d) {
    AddCorners(cells, CellShape::Quadrilateral, { a, b, c, d });
  };
  add({ 0, 0, 0 }, { 0, 1, 0 }, { 1, 0, 0 }, { 1, 1, 0 }); // seen from above: clockwise
  add({ 0, 0, 1 }, { 1, 0, g }, { 0, 1, 1 }, { 1, 1, g });
  add({ 0, 0, 0 }, { 1, 0, 0 }, { 0, 0, 1 }, { 1, 0, g });
  add({ 1, 0, 0 }, { 1, 1, 0 }, { 1, 0, g }, { 1, 1, g });
  add({ 1, 1, 0 }, { 0, 1, 0 }, { 1, 1, g }, { 0, 1, 1 });
  add({ 0, 1, 0 }, { 0, 0, 0 }, { 0, 1, 1 }, { 0, 0, 1 });
  return cells;
}

TEST(CellMaps, APlanarCellIsAMapOfItsPlaneWhateverStandsBeside_ExactOracle)
{
  BernsteinCells cells;
  AddCorners(cells, CellShape::Quadrilateral, Quad(5, 5, 0, true));
  AddCorners(cells, CellShape::Hexahedron, Cube(0));
  AddCorners(cells, CellShape::Quadrilateral, Quad(0, 0, 2));
  AddCorners(cells, CellShape::Curve, { { 0, 0, 0 }, { 1, 0, 0 } });
  AddCorners(
    cells, CellShape::Quadrilateral, { { 9, 0, 0 }, { 9, 1, 0 }, { 8, 0, 1 }, { 8, 1, 0 } });
  const CellMaps maps = FindCellMaps(cells, {});
  ASSERT_EQ(maps.Planes.size(), 2u);
  EXPECT_EQ(maps.Planes[0], std::vector<int>{ 0 });
  EXPECT_EQ(maps.Planes[1], std::vector<int>{ 2 });
  EXPECT_EQ(maps.Volumes, std::vector<int>{ 1 });
  EXPECT_EQ(maps.Others, (std::vector<int>{ 3, 4 }));
  const auto certificate = ValidateMaps(cells, maps);
  ASSERT_TRUE(certificate) << certificate.Status.Message();
  const Verdict expected[] = { Verdict::Reversed, Verdict::Valid, Verdict::Valid, Verdict::Valid,
    Verdict::Valid };
  for (std::size_t c = 0; c < 5; ++c)
  {
    EXPECT_EQ(certificate->Cells[c].Verdict, expected[c]) << c;
  }
  EXPECT_EQ(certificate->NumReversed, 1);
}

TEST(CellMaps, SurfacesAreToldByTheirEdgesAndPatches_ExactOracle)
{
  // A box is a surface in space, its bottom included; but for the cells apart from it.
  for (const double gap : { 0.0, 0.25 })
  {
    BernsteinCells cells = BoxSurface(gap);
    AddCorners(cells, CellShape::Quadrilateral, Quad(3, 0, 0, true));
    const CellMaps maps = FindCellMaps(cells, {});
    ASSERT_EQ(maps.Planes.size(), 1u) << gap;
    EXPECT_EQ(maps.Planes[0], std::vector<int>{ 6 });
    EXPECT_EQ(maps.Others.size(), 6u);
    const auto certificate = ValidateMaps(cells, maps);
    ASSERT_TRUE(certificate);
    EXPECT_EQ(certificate->NumValid, 6);
    EXPECT_EQ(certificate->Cells[6].Verdict, Verdict::Reversed);
  }
  // Cells of one patch are one surface, edges in common or not.
  BernsteinCells apart;
  AddCorners(apart, CellShape::Quadrilateral, Quad(0, 0, 0, true));
  AddCorners(
    apart, CellShape::Quadrilateral, { { 5, 0, 0 }, { 6, 0, 1 }, { 5, 1, 0 }, { 6, 1, 0 } });
  EXPECT_EQ(FindCellMaps(apart, { 0, 1 }).Planes.size(), 1u);
  EXPECT_TRUE(FindCellMaps(apart, { 4, 4 }).Planes.empty());
  // Edges that agree to a millionth of their length are common, far from the origin too.
  for (const double far : { 0.0, 1e6 })
  {
    for (const double off : { 1e-9, 1e-3 })
    {
      BernsteinCells two;
      AddCorners(two, CellShape::Quadrilateral, Quad(far, 0, 0, true));
      AddCorners(two, CellShape::Quadrilateral,
        { { far + 1 + off, 0, 0 }, { far + 2, 0, 1 }, { far + 1 + off, 1, 0 }, { far + 2, 1, 1 } });
      EXPECT_EQ(FindCellMaps(two, {}).Planes.empty(), off < 1e-6) << far << " " << off;
    }
  }
}

TEST(CellMaps, HeightsOfRationalCellsAreQuotients_PropertyOracle)
{
  oracle::Random random(3);
  for (int seed = 0; seed < 50; ++seed)
  {
    BernsteinCells cells;
    cells.Rational = true;
    std::vector<double> weights;
    for (int i = 0; i < 4; ++i)
    {
      weights.push_back(std::pow(10.0, random.In(-3, 3)));
    }
    AddCorners(cells, CellShape::Quadrilateral, Quad(0, 0, random.In(-2, 2)), weights);
    EXPECT_EQ(FindCellMaps(cells, {}).Planes.size(), 1u) << seed;
    cells.Data[8] *= 1.0 + 1e-12;
    EXPECT_EQ(FindCellMaps(cells, {}).Planes.size(), 0u) << seed;
  }
}

/// Random cells of every kind; of some the middle is pushed far out.
void AddRandomCell(BernsteinCells& cells, oracle::Random& random, bool planar, bool rational)
{
  const CellShape shapes[] = { CellShape::Quadrilateral, CellShape::Triangle, CellShape::Hexahedron,
    CellShape::Tetrahedron, CellShape::Wedge, CellShape::Curve };
  const CellShape shape = shapes[planar ? random.Int(0, 1) : random.Int(0, 5)];
  const int p = random.Int(1, 3);
  const int q = random.Int(1, 2);
  const bool simplex = shape == CellShape::Triangle || shape == CellShape::Wedge;
  CellDegree degree{ p, simplex ? p : q, random.Int(1, 2) };
  degree = shape == CellShape::Tetrahedron ? CellDegree{ p, p, p } : degree;
  degree[1] = shape == CellShape::Curve ? 0 : degree[1];
  degree[2] = NumParameters(shape) < 3 ? 0 : degree[2];
  const int n = NumCellCoefficients(shape, degree);
  double* block = cells.Block(cells.Add(shape, degree));
  cells.Remainders.resize(cells.Data.size());
  double* rest = cells.Remainders.data() + (cells.Data.size() - static_cast<std::size_t>(4 * n));
  const double z = planar ? random.In(-1, 1) : 0.0;
  const double w0 = random.In(0.5, 2.0);
  double largest = 0.0;
  for (int i = 0; i < n; ++i)
  {
    const double w = rational ? std::pow(10.0, random.In(-2, 2)) : w0;
    for (int d = 0; d < 3; ++d)
    {
      const double x = d == 2 && planar ? z : random.In(-1, 1);
      block[d * n + i] = w * x;
      rest[d * n + i] = std::fma(w, x, -block[d * n + i]);
      largest = std::max(largest, std::fabs(rest[d * n + i]));
    }
    block[3 * n + i] = w;
  }
  cells.Errors.push_back(largest);
}

bool HasSameBits(const CellCertificate& a, const CellCertificate& b)
{
  return a.Verdict == b.Verdict && a.Limit == b.Limit && a.Degenerate == b.Degenerate &&
    a.Boxes == b.Boxes && a.Snapped == b.Snapped && a.MinLower == b.MinLower &&
    a.MinUpper == b.MinUpper && a.MaxLower == b.MaxLower && a.MaxUpper == b.MaxUpper;
}

TEST(CellMaps, ACertificateIsTheSameWhateverStandsBeside_PropertyOracle)
{
  oracle::Random random(8);
  for (int seed = 0; seed < 20; ++seed)
  {
    BernsteinCells all;
    all.NumComponents = 3;
    all.Rational = true;
    std::vector<BernsteinCells> alone;
    for (int cell = 0; cell < 12; ++cell)
    {
      BernsteinCells one = BernsteinCells();
      one.NumComponents = 3;
      one.Rational = true;
      AddRandomCell(one, random, random.Unit() < 0.5, random.Unit() < 0.5);
      double* block = all.Block(all.Add(one.Shapes[0], one.Degrees[0]));
      std::copy(one.Data.begin(), one.Data.end(), block);
      all.Remainders.insert(all.Remainders.end(), one.Remainders.begin(), one.Remainders.end());
      all.Errors.push_back(one.Errors[0]);
      alone.push_back(std::move(one));
    }
    const auto together = ValidateMaps(all, FindCellMaps(all, {}));
    ASSERT_TRUE(together) << together.Status.Message();
    int witnesses = 0;
    for (std::size_t c = 0; c < alone.size(); ++c)
    {
      const auto single = ValidateMaps(alone[c], FindCellMaps(alone[c], {}));
      ASSERT_TRUE(single);
      EXPECT_TRUE(HasSameBits(single->Cells[0], together->Cells[c])) << seed << " " << c;
      ASSERT_EQ(single->Cells[0].Witness >= 0, together->Cells[c].Witness >= 0);
      if (single->Cells[0].Witness >= 0)
      {
        ++witnesses;
        const auto& witness =
          together->Witnesses[static_cast<std::size_t>(together->Cells[c].Witness)];
        EXPECT_EQ(witness.Cell, static_cast<int>(c));
        EXPECT_EQ(witness.Parameters, single->Witnesses[0].Parameters);
      }
    }
    EXPECT_EQ(static_cast<int>(together->Witnesses.size()), witnesses);
  }
}

TEST(CellMaps, InjectivityIsOfEveryPlaneAndOfVolumes_ExactOracle)
{
  // Squares above each other are two maps; they do not overlap. A surface in space has no part in
  // it.
  BernsteinCells cells;
  AddCorners(cells, CellShape::Quadrilateral, Quad(0, 0, 0));
  AddCorners(cells, CellShape::Hexahedron, Cube(0.25));
  AddCorners(cells, CellShape::Quadrilateral, Quad(0, 0, 1));
  AddCorners(
    cells, CellShape::Quadrilateral, { { 9, 0, 0 }, { 9, 1, 0 }, { 8, 0, 1 }, { 8, 1, 0 } });
  CellMaps maps = FindCellMaps(cells, {});
  auto certificate = ValidateMaps(cells, maps);
  ASSERT_TRUE(certificate);
  auto proof = ProveMapsInjective(cells, maps, {}, certificate.Value);
  ASSERT_TRUE(proof) << proof.Status.Message();
  EXPECT_EQ(proof->Verdict, InjectivityVerdict::Injective);
  EXPECT_EQ(proof->NumBoundarySides, 4 + 6 + 4);

  // Two in one plane do, and two volumes: the witness has the dataset's numbers.
  for (const bool volumes : { false, true })
  {
    BernsteinCells more = cells;
    AddCorners(more, volumes ? CellShape::Hexahedron : CellShape::Quadrilateral,
      volumes ? Cube(0.5) : Quad(0.5, 0.5, 1));
    maps = FindCellMaps(more, {});
    certificate = ValidateMaps(more, maps);
    ASSERT_TRUE(certificate);
    proof = ProveMapsInjective(more, maps, {}, certificate.Value);
    ASSERT_TRUE(proof) << proof.Status.Message();
    EXPECT_EQ(proof->Verdict, InjectivityVerdict::NotInjective);
    std::array<int, 2> found{ proof->Witness.Places[0].Cell, proof->Witness.Places[1].Cell };
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, (std::array<int, 2>{ volumes ? 1 : 2, 4 }));
  }
}

/// Most products are no doubles. Weights from 1e-3 to 1e3, places up to 1e8 away: the
/// sign is that of the bilinear cell with the same corners.
TEST(CellMaps, ProductsThatAreNoDoublesAreExact_ExactOracle)
{
  oracle::Random random(21);
  int nearly = 0;
  for (int seed = 0; seed < 200; ++seed)
  {
    // Corner (1 + t, 1 + t) of a square lies past the diagonal of its neighbours by t / 2: at the
    // corner opposite det J is positive; there it is proportional to 1 + 2 t, at the others to 1 +
    // t. With t = -1/2 + 2^-k the corner is all but straight: reversed from there on for -2^-k.
    // Far away corners within 2^-48 of the coordinates are taken as straight: that is 2^-22 there.
    const double far = seed % 4 < 2 ? 0.0 : 0x1p26;
    const int k = random.Int(10, far > 0.0 ? 17 : 24);
    const double t = -0.5 + (seed % 2 == 0 ? std::ldexp(1.0, -k) : -std::ldexp(1.0, -k));
    const double size = 3.0;
    BernsteinCells cells;
    cells.NumComponents = 3;
    cells.Rational = true;
    double* block = cells.Block(cells.Add(CellShape::Quadrilateral, { 1, 1, 0 }));
    cells.Remainders.assign(16, 0.0);
    cells.Errors.assign(1, 0.0);
    const double corners[4][2] = { { 0, 0 }, { 1, 0 }, { 0, 1 }, { 1 + t, 1 + t } };
    for (int i = 0; i < 4; ++i)
    {
      const double w = std::pow(10.0, random.In(-3, 3));
      for (int d = 0; d < 3; ++d)
      {
        const double x = d < 2 ? far + size * corners[i][d] : 0.7;
        block[4 * d + i] = w * x;
        const double rest = std::fma(w, x, -block[4 * d + i]);
        cells.Remainders[static_cast<std::size_t>(4 * d + i)] = rest;
        cells.Errors[0] = std::max(cells.Errors[0], std::fabs(rest));
      }
      block[12 + i] = w;
    }
    const CellMaps maps = FindCellMaps(cells, {});
    ASSERT_EQ(maps.Planes.size(), 1u);
    const auto result = ValidateMaps(cells, maps);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->Cells[0].Verdict, seed % 2 == 0 ? Verdict::Valid : Verdict::Invalid)
      << seed << " " << k << " " << far << " limit " << ToString(result->Cells[0].Limit);
    nearly += k > 20;
    // without the remainders such cells stay undecided at best
  }
  EXPECT_GT(nearly, 20);
}

/// The square with straight corners (det J = 0 there), extruded; one point moves by so much.
BernsteinCells StraightCorners(double move, double angle)
{
  BernsteinCells cells;
  cells.NumComponents = 3;
  double* block = cells.Block(cells.Add(CellShape::Hexahedron, { 2, 2, 1 }));
  const double net[9][2] = { { 0, -1 }, { 1, -1 }, { 1, 0 }, { -1, -1 }, { 0, 0 }, { 1, 1 },
    { -1, 0 }, { -1, 1 }, { 0, 1 } };
  for (int k = 0; k < 2; ++k)
  {
    for (int i = 0; i < 9; ++i)
    {
      const double x = net[i][0];
      const double y = net[i][1] + (i == 1 ? move : 0.0);
      const int at = 9 * k + i;
      block[at] = std::cos(angle) * x - std::sin(angle) * y;
      block[18 + at] = std::sin(angle) * x + std::cos(angle) * y;
      block[36 + at] = 0.5 * k;
    }
  }
  return cells;
}

/// With any weights the corners stay straight: the products w x are rounded, their remainders say
/// by what, and det J = 0 along the edges is known, with no tolerance.
TEST(CellMaps, StraightCornersOfRationalCellsAreDegenerate_ExactOracle)
{
  oracle::Random random(5);
  for (int seed = 0; seed < 20; ++seed)
  {
    BernsteinCells cells = StraightCorners(0.0, 0.0);
    const std::vector<double> net = cells.Data;
    cells.Rational = true;
    cells.Data.assign(72, 0.0);
    cells.Remainders.assign(72, 0.0);
    cells.Errors.assign(1, 0.0);
    cells.Offsets[1] = 72;
    for (std::size_t i = 0; i < 18; ++i)
    {
      const double w = random.In(0.6, 1.4);
      for (std::size_t d = 0; d < 3; ++d)
      {
        const double x = 0.05 * net[18 * d + i];
        double& value = cells.Data[18 * d + i];
        value = w * x;
        cells.Remainders[18 * d + i] = std::fma(w, x, -value);
        cells.Errors[0] = std::max(cells.Errors[0], std::fabs(cells.Remainders[18 * d + i]));
      }
      cells.Data[54 + i] = w;
    }
    JacobianParams strict;
    strict.CollapseTolerance = 0.0;
    const auto result = ValidateJacobian(cells, strict);
    ASSERT_TRUE(result) << result.Status.Message();
    EXPECT_EQ(result->Cells[0].Degenerate & DegenerateEdge, DegenerateEdge) << seed;
    EXPECT_EQ(result->Cells[0].Verdict, Verdict::Valid) << seed;
    EXPECT_FALSE(result->Cells[0].Snapped);
  }
}

TEST(CellMaps, DegenerateWithinRoundingIsNeitherValidNorInvalid_ExactOracle)
{
  // At the corner (0, -1) the derivatives are 2 (1, 0) and 2 (-1, 0): det J = 0 along the edge.
  // Moved down by t, the point beside makes it -2 t (times 2), moved up 2 t.
  const auto prove = [](double move, double angle, double tolerance)
  {
    JacobianParams params;
    params.CollapseTolerance = tolerance;
    auto result = ValidateJacobian(StraightCorners(move, angle), params);
    EXPECT_TRUE(result) << result.Status.Message();
    return result->Cells[0];
  };
  const CellCertificate exact = prove(0.0, 0.0, 0x1p-48);
  EXPECT_EQ(exact.Verdict, Verdict::Valid);
  EXPECT_EQ(exact.Degenerate & DegenerateEdge, DegenerateEdge);

  const double ulp = 0x1p-52;
  bool anyNegative = false;
  for (const double move : { -ulp, ulp })
  {
    const CellCertificate noise = prove(move, 0.0, 0x1p-48);
    const CellCertificate strict = prove(move, 0.0, 0.0);
    if (strict.Verdict == Verdict::Invalid)
    {
      anyNegative = true;
      EXPECT_EQ(noise.Verdict, Verdict::Undecided);
      EXPECT_EQ(noise.Limit, JacobianLimit::Rounding);
      EXPECT_LE(noise.MinUpper, 0.0);
      EXPECT_GE(noise.MinUpper, -16.0 * ulp);
      // the move itself, to the factor that a bound by the largest differences gives away
      EXPECT_LE(noise.Rounding, 2.0 * ulp);
      EXPECT_GE(noise.Rounding, ulp / 16.0);
    }
    else
    {
      EXPECT_NE(noise.Verdict, Verdict::Invalid);
    }
    // a fold that is none of rounding stays one
    EXPECT_EQ(prove(1e6 * move, 0.0, 0x1p-48).Verdict, strict.Verdict) << move;
    EXPECT_EQ(prove(0.01 * move / ulp, 0.0, 0x1p-48).Verdict, strict.Verdict) << move;
  }
  EXPECT_TRUE(anyNegative);
  // turned, its coordinates are rounded: never invalid, and undecided for that reason alone
  int rounding = 0;
  for (int k = 1; k <= 40; ++k)
  {
    const CellCertificate turned = prove(0.0, 0.1 * k, 0x1p-48);
    EXPECT_TRUE(turned.Verdict == Verdict::Valid || turned.Limit == JacobianLimit::Rounding) << k;
    rounding += turned.Limit == JacobianLimit::Rounding;
  }
  EXPECT_GT(rounding, 5);
}
}
}
