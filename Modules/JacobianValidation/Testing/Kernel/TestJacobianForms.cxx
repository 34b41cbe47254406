// SPDX-License-Identifier: BSD-3-Clause
#include "ExactForm.h"
#include "JacobianCorpus.h"
#include <knotwork/SplineCore/Bernstein.h>

#include <gtest/gtest.h>

namespace knotwork
{
namespace
{
struct RandomCell
{
  std::vector<double> Block;
  int Components;
  bool Rational;
};

/// Whole numbers, so that every oracle below is exact or nearly so.
RandomCell MakeCell(
  oracle::Random& random, CellShape shape, const CellDegree& degree, int components, bool rational)
{
  RandomCell cell{ {}, components, rational };
  const int n = NumCellCoefficients(shape, degree);
  for (int c = 0; c < components + rational; ++c)
  {
    for (int i = 0; i < n; ++i)
    {
      cell.Block.push_back(c < components ? random.Int(-64, 64) : random.Int(1, 16));
    }
  }
  return cell;
}

template <typename T>
std::array<const T*, 4> Planes(const std::vector<T>& block, int n)
{
  std::array<const T*, 4> planes{};
  for (std::size_t c = 0; c * static_cast<std::size_t>(n) < block.size(); ++c)
  {
    planes[c] = block.data() + c * static_cast<std::size_t>(n);
  }
  return planes;
}

const ExactForm ExactDeterminant(
  LayoutCache& cache, CellShape shape, const CellDegree& degree, const RandomCell& cell)
{
  const FormLayout& layout = cache.Get(shape, degree);
  const ExactCell exact =
    MakeExactCell(layout, cell.Components, cell.Rational, cell.Block.data(), nullptr, 0.0);
  std::array<const ExactInteger*, 4> planes{};
  for (std::size_t c = 0; c < 4; ++c)
  {
    planes[c] = exact.Planes[c].data();
  }
  JacobianForms<ExactInteger> forms(cache);
  forms.Set(shape, degree, cell.Components, cell.Rational, planes, {});
  const auto& form = forms.Determinant();
  ExactForm result;
  result.Layout = form.Layout;
  result.C = form.C;
  result.Exponent = exact.Exponent * (cell.Components + (cell.Rational ? 1 : 0));
  return result;
}

/// A Bernstein form and its partial derivatives at a point, by sums over its definition.
struct Jet
{
  long double Value = 0;
  long double First[3] = {};
};
Jet EvaluateJet(
  CellShape shape, const CellDegree& degree, const double* c, const std::array<double, 3>& at)
{
  // derivatives by central differences of exact sums would lose digits: differentiate the products
  LayoutCache cache;
  const FormLayout& layout = cache.Get(shape, degree);
  long double slots[MaxSlots] = {};
  for (int g = 0, first = 0; g < layout.NumGroups; ++g)
  {
    int last = first;
    slots[first] = 1;
    for (int d = 0; d < NumParameters(shape); ++d)
    {
      if (GroupOfDirection(shape, d) == g)
      {
        slots[++last] = at[static_cast<std::size_t>(d)];
        slots[first] -= at[static_cast<std::size_t>(d)];
      }
    }
    first = last + 1;
  }
  Jet jet;
  long double bySlot[MaxSlots] = {};
  for (int i = 0; i < layout.Size; ++i)
  {
    const auto& e = layout.Exponents[static_cast<std::size_t>(i)];
    const long double scaled =
      static_cast<long double>(layout.Multinomials[static_cast<std::size_t>(i)]) * c[i];
    long double value = scaled;
    for (int s = 0; s < layout.NumSlots; ++s)
    {
      value *= std::pow(slots[s], static_cast<int>(e[static_cast<std::size_t>(s)]));
    }
    jet.Value += value;
    for (int t = 0; t < layout.NumSlots; ++t)
    {
      const int power = e[static_cast<std::size_t>(t)];
      if (power == 0)
      {
        continue;
      }
      long double derivative = scaled * power;
      for (int s = 0; s < layout.NumSlots; ++s)
      {
        derivative *=
          std::pow(slots[s], static_cast<int>(e[static_cast<std::size_t>(s)]) - (s == t));
      }
      bySlot[t] += derivative;
    }
  }
  for (int d = 0; d < NumParameters(shape); ++d)
  {
    const int slot = SlotOfDirection(shape, d);
    int zero = 0;
    while (!(layout.GroupMasks[static_cast<std::size_t>(GroupOfDirection(shape, d))] >> zero & 1))
    {
      ++zero;
    }
    jet.First[d] = bySlot[slot] - bySlot[zero];
  }
  return jet;
}

/// det J of a cell at a point by the quotient rule, times W^(d + 1).
long double DirectDeterminant(CellShape shape, const CellDegree& degree, const RandomCell& cell,
  const std::array<double, 3>& at)
{
  const int n = NumCellCoefficients(shape, degree);
  const int d = NumParameters(shape);
  Jet w;
  w.Value = 1;
  if (cell.Rational)
  {
    w = EvaluateJet(shape, degree, cell.Block.data() + cell.Components * n, at);
  }
  long double m[3][3];
  for (int c = 0; c < d; ++c)
  {
    const Jet x = EvaluateJet(shape, degree, cell.Block.data() + c * n, at);
    for (int k = 0; k < d; ++k)
    {
      m[c][k] = (x.First[k] - x.Value / w.Value * w.First[k]) / w.Value;
    }
  }
  const long double det = d == 2 ? m[0][0] * m[1][1] - m[0][1] * m[1][0]
                                 : m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
      m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
      m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return det * (cell.Rational ? std::pow(w.Value, d + 1) : 1.0L);
}

constexpr CellShape PlaneAndSpace[] = { CellShape::Quadrilateral, CellShape::Triangle,
  CellShape::Hexahedron, CellShape::Tetrahedron, CellShape::Wedge };

TEST(JacobianForms, DegreesAreMinimal_GoldenOracle)
{
  LayoutCache cache;
  oracle::Random random(1);
  const auto degreeOf = [&](CellShape shape, const CellDegree& degree, bool rational)
  {
    return ExactDeterminant(
      cache, shape, degree, MakeCell(random, shape, degree, NumParameters(shape), rational))
      .Layout->Degree;
  };
  EXPECT_EQ(degreeOf(CellShape::Quadrilateral, { 2, 3, 0 }, false), (CellDegree{ 3, 5, 0 }));
  EXPECT_EQ(degreeOf(CellShape::Quadrilateral, { 2, 3, 0 }, true), (CellDegree{ 4, 7, 0 }));
  EXPECT_EQ(degreeOf(CellShape::Hexahedron, { 1, 2, 3 }, false), (CellDegree{ 2, 5, 8 }));
  EXPECT_EQ(degreeOf(CellShape::Hexahedron, { 1, 2, 3 }, true), (CellDegree{ 2, 6, 10 }));
  EXPECT_EQ(degreeOf(CellShape::Triangle, { 3, 3, 0 }, false), (CellDegree{ 4, 4, 0 }));
  EXPECT_EQ(degreeOf(CellShape::Triangle, { 3, 3, 0 }, true), (CellDegree{ 6, 6, 0 }));
  EXPECT_EQ(degreeOf(CellShape::Tetrahedron, { 2, 2, 2 }, false), (CellDegree{ 3, 3, 3 }));
  EXPECT_EQ(degreeOf(CellShape::Tetrahedron, { 2, 2, 2 }, true), (CellDegree{ 4, 4, 4 }));
  EXPECT_EQ(degreeOf(CellShape::Wedge, { 2, 2, 3 }, false), (CellDegree{ 4, 4, 8 }));
  EXPECT_EQ(degreeOf(CellShape::Wedge, { 2, 2, 3 }, true), (CellDegree{ 5, 5, 10 }));
}

/// The minimal form's values are those of the quotient rule, in every shape and degree.
TEST(JacobianForms, ValuesAreTheDeterminant_CrossOracle)
{
  LayoutCache cache;
  oracle::Random random(2);
  for (const CellShape shape : PlaneAndSpace)
  {
    for (int trial = 0; trial < 24; ++trial)
    {
      const bool rational = trial % 2 == 1;
      const CellDegree degree =
        corpus::DegreeOf(shape, random.Int(1, 4), random.Int(1, 4), random.Int(1, 4));
      const RandomCell cell = MakeCell(random, shape, degree, NumParameters(shape), rational);
      const ExactForm form = ExactDeterminant(cache, shape, degree, cell);
      const auto at = corpus::InnerPoint(random, shape);
      const long double direct = DirectDeterminant(shape, degree, cell, at);
      const double exact = form.ValueAt(at);
      double largest = 0.0;
      int scale = 0;
      for (double c : form.Coefficients(scale))
      {
        largest = std::max(largest, std::fabs(std::ldexp(c, scale)));
      }
      // long double rounding of a few hundred terms
      EXPECT_NEAR(exact, static_cast<double>(direct), 1e-13 * largest)
        << static_cast<int>(shape) << " " << degree[0] << degree[1] << degree[2] << rational;
      EXPECT_EQ(form.SignAt(at), exact > 0.0 ? 1 : -1);
    }
  }
}

/// The form of degree (4p - 1, 4q - 1), (X_u W - X W_u)(Y_v W - Y W_v) - (X_v W - X W_v)(Y_u W
/// - Y W_u), is the minimal one times W, raised by one degree.
TEST(JacobianForms, RedundantFormIsTheMinimalTimesWeights_CrossOracle)
{
  LayoutCache cache;
  oracle::Random random(6);
  for (int trial = 0; trial < 12; ++trial)
  {
    const IntArray<2> pq{ random.Int(1, 4), random.Int(1, 4) };
    const CellDegree degree{ pq[0], pq[1], 0 };
    const RandomCell cell = MakeCell(random, CellShape::Quadrilateral, degree, 2, true);
    const std::size_t n = static_cast<std::size_t>(NumTensorFunctions<2>(pq));
    std::array<std::vector<double>, 3> x;
    for (std::size_t c = 0; c < 3; ++c)
    {
      x[c].assign(cell.Block.data() + c * n, cell.Block.data() + (c + 1) * n);
    }
    const auto lower = [&](int d)
    {
      IntArray<2> l = pq;
      --l[static_cast<std::size_t>(d)];
      return l;
    };
    const auto quotient = [&](std::size_t c, int d)
    {
      auto a = BernsteinProduct<2>(lower(d), BernsteinDerivative<2>(pq, x[c], d), pq, x[2]);
      const auto b = BernsteinProduct<2>(lower(d), BernsteinDerivative<2>(pq, x[2], d), pq, x[c]);
      for (std::size_t k = 0; k < a.size(); ++k)
      {
        a[k] -= b[k];
      }
      return a;
    };
    const IntArray<2> du{ 2 * pq[0] - 1, 2 * pq[1] };
    const IntArray<2> dv{ 2 * pq[0], 2 * pq[1] - 1 };
    auto redundant = BernsteinProduct<2>(du, quotient(0, 0), dv, quotient(1, 1));
    const auto second = BernsteinProduct<2>(du, quotient(1, 0), dv, quotient(0, 1));
    double largest = 0.0;
    for (std::size_t k = 0; k < redundant.size(); ++k)
    {
      redundant[k] -= second[k];
      largest = std::max(largest, std::fabs(redundant[k]));
    }
    const ExactForm minimal = ExactDeterminant(cache, CellShape::Quadrilateral, degree, cell);
    const IntArray<2> md{ minimal.Layout->Degree[0], minimal.Layout->Degree[1] };
    EXPECT_EQ(md, (IntArray<2>{ 3 * pq[0] - 2, 3 * pq[1] - 2 }));
    const auto product = BernsteinProduct<2>(md, minimal.CoefficientsAt(0), pq, x[2]);
    const auto raised = BernsteinElevate<2>(
      { md[0] + pq[0], md[1] + pq[1] }, product, { 4 * pq[0] - 1, 4 * pq[1] - 1 });
    ASSERT_EQ(raised.size(), redundant.size());
    for (std::size_t k = 0; k < raised.size(); ++k)
    {
      EXPECT_NEAR(
        raised[k], redundant[k], 1e-12 * largest); // a few hundred roundings of terms of that size
    }
  }
}

/// The static bound holds, and is not so loose that it decides nothing.
TEST(JacobianForms, ErrorBoundHolds_CrossOracle)
{
  LayoutCache cache;
  oracle::Random random(3);
  double tightest = 0.0;
  for (const CellShape shape : PlaneAndSpace)
  {
    for (int trial = 0; trial < 30; ++trial)
    {
      const bool rational = trial % 2 == 1;
      const CellDegree degree =
        corpus::DegreeOf(shape, random.Int(1, 3), random.Int(1, 3), random.Int(1, 3));
      RandomCell cell = MakeCell(random, shape, degree, NumParameters(shape), rational);
      for (double& x : cell.Block)
      {
        x *= 1.0 + random.Unit(); // full mantissas
      }
      const ExactForm exact = ExactDeterminant(cache, shape, degree, cell);
      JacobianForms<double> forms(cache);
      forms.Set(shape, degree, cell.Components, rational,
        Planes(cell.Block, NumCellCoefficients(shape, degree)), {});
      const Form<double>& form = forms.Determinant();
      ASSERT_EQ(form.Layout, exact.Layout);
      const double bound =
        RoundingFactor(form.Roundings + form.Layout->MultinomialRoundings + 1) * form.Magnitude;
      double largest = 0.0;
      for (std::size_t k = 0; k < form.C.size(); ++k)
      {
        // the difference exactly, then rounded
        ExactForm one = exact;
        const DyadicNumber mine = Dyadic(form.C[k]);
        const int e = std::min(mine.M.is_zero() ? exact.Exponent : mine.E, exact.Exponent);
        one.C.assign(one.C.size(), ExactInteger());
        one.C[k] = ExactInteger(ExactInteger::Number((exact.C[k].V << (exact.Exponent - e)) -
          (mine.M.is_zero() ? ExactInteger::Number(0)
                            : ExactInteger::Number(mine.M << (mine.E - e)))));
        one.Exponent = e;
        const double difference = one.C[k].Sign() == 0 ? 0.0 : std::fabs(one.CoefficientsAt(0)[k]);
        EXPECT_LE(difference, bound);
        tightest = std::max(tightest, difference / bound);
        largest = std::max(largest, std::fabs(form.C[k]));
      }
      EXPECT_LT(bound, 1e-10 * largest);
    }
  }
  EXPECT_GT(tightest, 1e-3); // not vacuous
}

TEST(JacobianForms, HalvesAreTheForm_PropertyOracle)
{
  LayoutCache cache;
  oracle::Random random(4);
  for (const CellShape shape : PlaneAndSpace)
  {
    const CellDegree degree = corpus::DegreeOf(shape, 2, 3, 2);
    const ExactForm form = ExactDeterminant(
      cache, shape, degree, MakeCell(random, shape, degree, NumParameters(shape), false));
    for (std::size_t e = 0; e < form.Layout->Edges.size(); ++e)
    {
      for (int side = 0; side < 2; ++side)
      {
        const ExactForm half = form.Half(static_cast<int>(e), side);
        // the corners of the half are points of the form
        for (int c = 0; c < NumCorners(shape); ++c)
        {
          auto at = CornerParameters(shape, c);
          const std::uint8_t mask = form.Layout->CornerMasks[static_cast<std::size_t>(c)];
          const int moved = side == 0 ? form.Layout->Edges[e].To : form.Layout->Edges[e].From;
          const int kept = side == 0 ? form.Layout->Edges[e].From : form.Layout->Edges[e].To;
          const double value = half.ValueAt(at);
          if (!(mask >> moved & 1))
          {
            // this corner is the middle of the edge
            for (int d = 0; d < NumParameters(shape); ++d)
            {
              double& x = at[static_cast<std::size_t>(d)];
              x = SlotOfDirection(shape, d) == moved || SlotOfDirection(shape, d) == kept ? 0.5 : x;
            }
          }
          EXPECT_EQ(form.ValueAt(at), value);
        }
      }
    }
  }
}
}
}
