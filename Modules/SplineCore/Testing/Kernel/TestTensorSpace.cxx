// SPDX-License-Identifier: BSD-3-Clause
#include "SplineOracle.h"
#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

using namespace knotwork;
using oracle::Epsilon;

namespace
{
template <typename Dimension>
class TensorSpace : public testing::Test
{
};
using Dimensions = testing::Types<std::integral_constant<int, 1>, std::integral_constant<int, 2>,
  std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(TensorSpace, Dimensions);

/// Elements a direction so that a case of any dimension takes about the same time.
constexpr int MaxElements(int dim)
{
  return dim == 1 ? 8 : dim == 2 ? 4 : 2;
}

template <int Dim>
std::array<KnotVector, Dim> RandomKnots(oracle::Random& random)
{
  std::array<KnotVector, Dim> knots;
  for (KnotVector& k : knots)
  {
    k = random.Knots(MaxElements(Dim), Dim == 3 ? random.Int(1, 4) : 0);
  }
  return knots;
}

template <int Dim>
RealArray<Dim> RandomParameter(oracle::Random& random, const SplineSpace<Dim>& space)
{
  RealArray<Dim> u;
  for (int d = 0; d < Dim; ++d)
  {
    u[d] = random.Parameter(space.Knots[d]);
  }
  return u;
}

/// The two maps agree at random parameters and breaks of the first one's domain.
template <int Dim>
void ExpectSameMap(
  oracle::Random& random, const Spline<Dim>& a, const Spline<Dim>& b, double tolerance)
{
  for (int d = 0; d < Dim; ++d)
  {
    ASSERT_EQ(a.Space->Knots[d].Begin(), b.Space->Knots[d].Begin());
    ASSERT_EQ(a.Space->Knots[d].End(), b.Space->Knots[d].End());
  }
  for (int i = 0; i < 12; ++i)
  {
    const auto u = RandomParameter<Dim>(random, *a.Space);
    const auto pa = oracle::Evaluate<Dim>(a, u);
    const auto pb = oracle::Evaluate<Dim>(b, u);
    for (std::size_t c = 0; c < pa.size(); ++c)
    {
      ASSERT_NEAR(pa[c], pb[c], tolerance);
    }
  }
}

// ---- exact arithmetic -------------------------------------------------------------------------

/// Fraction of 128-bit integers, always reduced.
struct Fraction
{
  __extension__ typedef __int128 Integer;
  Integer Numerator = 0;
  Integer Denominator = 1;

  Fraction(Integer numerator = 0, Integer denominator = 1)
    : Numerator(numerator), Denominator(denominator)
  {
    Integer a = numerator < 0 ? -numerator : numerator;
    Integer b = denominator < 0 ? -denominator : denominator;
    while (b != 0)
    {
      const Integer rest = a % b;
      a = b;
      b = rest;
    }
    this->Numerator = numerator / a * (denominator < 0 ? -1 : 1);
    this->Denominator = (denominator < 0 ? -denominator : denominator) / a;
  }
  Fraction operator+(const Fraction& o) const
  {
    return { this->Numerator * o.Denominator + o.Numerator * this->Denominator,
      this->Denominator * o.Denominator };
  }
  Fraction operator*(const Fraction& o) const
  {
    return { this->Numerator * o.Numerator, this->Denominator * o.Denominator };
  }
  double ToDouble() const
  {
    return static_cast<double>(
      static_cast<long double>(this->Numerator) / static_cast<long double>(this->Denominator));
  }
};

/// Exact Bernstein coefficients, on the span of integer knots, of function i of degree p: the
/// Cox-de Boor recursion in Bernstein form, multiplying by linear factors.
std::vector<Fraction> ExactExtraction(int i, int p, const std::vector<double>& t, int span)
{
  if (p == 0)
  {
    return { Fraction(i == span ? 1 : 0) };
  }
  const auto at = [&t](int k) { return static_cast<long>(t[k]); };
  std::vector<Fraction> result(p + 1);
  const auto add = [&](long root, long length, int function)
  {
    // (u - root) / length has the Bernstein coefficients (a - root) / length, (b - root) / length
    if (length == 0)
    {
      return;
    }
    const auto low = ExactExtraction(function, p - 1, t, span);
    const Fraction first(at(span) - root, length);
    const Fraction second(at(span + 1) - root, length);
    for (int k = 0; k < p; ++k)
    {
      result[k] = result[k] + low[k] * first * Fraction(p - k, p);
      result[k + 1] = result[k + 1] + low[k] * second * Fraction(k + 1, p);
    }
  };
  add(at(i), at(i + p) - at(i), i);
  add(at(i + p + 1), at(i + 1) - at(i + p + 1), i + 1);
  return result;
}

constexpr std::uint64_t Prime = (std::uint64_t(1) << 61) - 1;

std::uint64_t Multiply(std::uint64_t a, std::uint64_t b)
{
  return static_cast<std::uint64_t>(static_cast<Fraction::Integer>(a) * b % Prime);
}

std::uint64_t Inverse(std::uint64_t a)
{
  std::uint64_t result = 1;
  for (std::uint64_t e = Prime - 2; e > 0; e >>= 1)
  {
    result = e & 1 ? Multiply(result, a) : result;
    a = Multiply(a, a);
  }
  return result;
}

std::uint64_t Modular(const Fraction& f)
{
  const auto modulus = static_cast<Fraction::Integer>(Prime);
  const auto numerator = static_cast<std::uint64_t>((f.Numerator % modulus + modulus) % modulus);
  return Multiply(numerator, Inverse(static_cast<std::uint64_t>(f.Denominator % modulus)));
}

/// Rank over the field of 2^61 - 1 elements: never above the rank over the rationals.
int Rank(std::vector<std::vector<std::uint64_t>> rows)
{
  int rank = 0;
  const std::size_t columns = rows.empty() ? 0 : rows[0].size();
  for (std::size_t c = 0; c < columns; ++c)
  {
    std::size_t pivot = rank;
    while (pivot < rows.size() && rows[pivot][c] == 0)
    {
      ++pivot;
    }
    if (pivot == rows.size())
    {
      continue;
    }
    std::swap(rows[pivot], rows[rank]);
    const std::uint64_t inverse = Inverse(rows[rank][c]);
    for (std::size_t r = rank + 1; r < rows.size(); ++r)
    {
      const std::uint64_t factor = Multiply(rows[r][c], inverse);
      for (std::size_t k = c; factor != 0 && k < columns; ++k)
      {
        rows[r][k] = (rows[r][k] + Prime - Multiply(factor, rows[rank][k])) % Prime;
      }
    }
    ++rank;
  }
  return rank;
}

/// Compares a space's operators with exact ones and returns the exact rank of the matrix of all
/// functions' Bernstein coefficients on all elements, addressed by the space's own function ids.
template <int Dim>
int ExactRank(const SplineSpace<Dim>& space)
{
  std::vector<std::vector<std::uint64_t>> rows;
  IntArray<Dim> cell{};
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const auto& degree = space.Elements[e].Degree;
    const int n = NumTensorFunctions<Dim>(degree);
    const Eigen::MatrixXd extraction = space.ExtractionOperator(e);
    const auto alive = space.AliveFunctions(e);
    EXPECT_EQ(static_cast<int>(alive.size()), n);
    std::array<std::vector<std::vector<Fraction>>, Dim> factors;
    for (int d = 0; d < Dim; ++d)
    {
      const KnotVector& k = space.Knots[d];
      const int span = k.Span(cell[d]);
      for (int i = 0; i <= degree[d]; ++i)
      {
        factors[d].push_back(ExactExtraction(span - degree[d] + i, degree[d], k.Knots(), span));
      }
    }
    const std::size_t first = rows.size();
    rows.resize(first + n, std::vector<std::uint64_t>(space.NumFunctions, 0));
    for (int i = 0; i < n; ++i)
    {
      for (int b = 0; b < n; ++b)
      {
        Fraction exact(1);
        int restI = i;
        int restB = b;
        for (int d = 0; d < Dim; ++d)
        {
          exact = exact * factors[d][restI % (degree[d] + 1)][restB % (degree[d] + 1)];
          restI /= degree[d] + 1;
          restB /= degree[d] + 1;
        }
        // p convex combinations a direction; equal operators are shared up to 1e-13
        EXPECT_NEAR(extraction(i, b), exact.ToDouble(), 32 * Epsilon + 1e-13);
        rows[first + b][alive[i]] = Modular(exact);
      }
    }
    for (int d = 0; d < Dim && ++cell[d] == space.Knots[d].NumElements(); ++d)
    {
      cell[d] = 0;
    }
  }
  return Rank(rows);
}

KnotVector SmallIntegerKnots(oracle::Random& random, int degree, int maxElements)
{
  // the shape of a random vector with integer steps of 1 to 3
  const KnotVector shape = random.Knots(maxElements, degree);
  std::vector<double> t = { 0.0 };
  for (std::size_t i = 1; i < shape.Knots().size(); ++i)
  {
    const bool same = shape.Knots()[i] == shape.Knots()[i - 1];
    t.push_back(t.back() + (same ? 0.0 : random.Int(1, 3)));
  }
  return KnotVector::Create(degree, t).Value;
}

Spline<1> QuarterCircle()
{
  Spline<1> arc;
  arc.Space = MakeTensorSpace<1>({ KnotVector::Uniform(2, 1) }).Value;
  arc.ControlPoints.resize(3, 2);
  arc.ControlPoints << 1, 0, 1, 1, 0, 1;
  arc.Weights.resize(3);
  arc.Weights << 1.0, std::sqrt(0.5), 1.0;
  return arc;
}
}

// ---- the space --------------------------------------------------------------------------------

TYPED_TEST(TensorSpace, CountsAndBoxes_FormulaOracle)
{
  constexpr int Dim = TypeParam::value;
  oracle::Random random(20);
  for (int run = 0; run < 20; ++run)
  {
    const auto knots = RandomKnots<Dim>(random);
    const auto space = MakeTensorSpace<Dim>(knots).Value;
    int functions = 1;
    int elements = 1;
    double volume = 1.0;
    for (const KnotVector& k : knots)
    {
      functions *= static_cast<int>(k.Knots().size()) - k.Degree() - 1;
      elements *= k.NumElements();
      volume *= k.End() - k.Begin();
    }
    ASSERT_EQ(space->Kind, SpaceKind::Tensor);
    ASSERT_EQ(space->NumFunctions, functions);
    ASSERT_EQ(space->NumElements(), elements);
    ASSERT_TRUE(space->HasDomain());
    ASSERT_TRUE(space->IsIdentityMap());
    double sum = 0.0;
    for (const auto& element : space->Elements)
    {
      double product = 1.0;
      for (int d = 0; d < Dim; ++d)
      {
        product *= element.Box.Upper[d] - element.Box.Lower[d];
        ASSERT_EQ(element.Degree[d], knots[d].Degree());
      }
      ASSERT_GT(product, 0.0);
      sum += product;
    }
    ASSERT_NEAR(sum, volume, 1e-12 * (1.0 + volume)); // cancellation in |knots| < 20 of size 1e-2
  }
}

TYPED_TEST(TensorSpace, LocateFindsTheBox_LinearSearchOracle)
{
  constexpr int Dim = TypeParam::value;
  oracle::Random random(21);
  for (int run = 0; run < 20; ++run)
  {
    const auto space = MakeTensorSpace<Dim>(RandomKnots<Dim>(random)).Value;
    const auto domain = space->Domain();
    for (int sample = 0; sample < 20; ++sample)
    {
      auto u = RandomParameter<Dim>(random, *space);
      double local[Dim];
      const int e = space->Locate(u.data(), local);
      int expected = -1;
      for (int c = 0; c < space->NumElements() && expected < 0; ++c)
      {
        bool inside = true;
        for (int d = 0; d < Dim; ++d)
        {
          const auto& box = space->Elements[c].Box;
          inside = inside && box.Lower[d] <= u[d] &&
            (u[d] < box.Upper[d] || (u[d] == box.Upper[d] && u[d] == domain.Upper[d]));
        }
        expected = inside ? c : -1;
      }
      ASSERT_EQ(e, expected);
      for (int d = 0; d < Dim; ++d)
      {
        const auto& box = space->Elements[e].Box;
        ASSERT_GE(local[d], 0.0);
        ASSERT_LE(local[d], 1.0);
        ASSERT_NEAR(
          box.Lower[d] + local[d] * (box.Upper[d] - box.Lower[d]), u[d], 2 * Epsilon * 20.0);
      }
    }
    auto u = RandomParameter<Dim>(random, *space);
    const int d = random.Int(0, Dim - 1);
    const double size = domain.Upper[d] - domain.Lower[d];
    double local[Dim];
    u[d] = domain.Upper[d] + 1e-9 * size;
    ASSERT_EQ(space->Locate(u.data(), local), -1);
    u[d] = domain.Lower[d] - 1e-9 * size;
    ASSERT_EQ(space->Locate(u.data(), local), -1);
    u[d] = std::numeric_limits<double>::quiet_NaN();
    ASSERT_EQ(space->Locate(u.data(), local), -1);
    u[d] = domain.Upper[d] + 1e-14 * size; // rounding of the caller counts as inside
    ASSERT_GE(space->Locate(u.data(), local), 0);
    ASSERT_EQ(local[d], 1.0);
  }
}

TYPED_TEST(TensorSpace, ExtractionEqualsBasis_CoxDeBoorOracle)
{
  constexpr int Dim = TypeParam::value;
  oracle::Random random(22);
  for (int run = 0; run < 12; ++run)
  {
    const auto space = MakeTensorSpace<Dim>(RandomKnots<Dim>(random)).Value;
    auto u = RandomParameter<Dim>(random, *space);
    double local[Dim];
    const int e = space->Locate(u.data(), local);
    ASSERT_GE(e, 0);
    const auto& element = space->Elements[e];
    const Eigen::MatrixXd operatorOfE = space->ExtractionOperator(e);
    const auto alive = space->AliveFunctions(e);
    const int n = NumTensorFunctions<Dim>(element.Degree);
    Eigen::VectorXd bernstein(n);
    for (int b = 0; b < n; ++b)
    {
      oracle::Real value = 1;
      int rest = b;
      for (int d = 0; d < Dim; ++d)
      {
        value *= oracle::Bernstein(element.Degree[d], rest % (element.Degree[d] + 1), local[d]);
        rest /= element.Degree[d] + 1;
      }
      bernstein[b] = static_cast<double>(value);
      ASSERT_NEAR(operatorOfE.col(b).sum(), 1.0, Dim * (32 * Epsilon + 1e-12));
    }
    ASSERT_GE(operatorOfE.minCoeff(), 0.0);
    const Eigen::VectorXd values = operatorOfE * bernstein;
    for (std::size_t i = 0; i < alive.size(); ++i)
    {
      oracle::Real expected = 1;
      int rest = alive[i];
      for (int d = 0; d < Dim; ++d)
      {
        const KnotVector& k = space->Knots[d];
        const oracle::Real lower = element.Box.Lower[d];
        const int span = oracle::FindSpan(k.Degree(), k.Knots(), u[d]);
        expected *= oracle::Basis(rest % k.NumFunctions(), k.Degree(), k.Knots(), span,
          lower + local[d] * (element.Box.Upper[d] - lower));
        rest /= k.NumFunctions();
      }
      // shared operators agree to 1e-13 an entry
      ASSERT_NEAR(values[i], static_cast<double>(expected), Dim * 2e-13);
    }
  }
}

TEST(TensorSpaceOperators, ComputedUniformKnotsShareOperators_FormulaOracle)
{
  std::vector<double> t(4, 0.0);
  for (int i = 1; i < 50; ++i)
  {
    t.push_back(i * (1.0 / 50.0)); // rounded: ratios of neighbours differ in the last bits
  }
  t.insert(t.end(), 4, 1.0);
  const auto space = MakeTensorSpace<1>({ KnotVector::Create(3, t).Value }).Value;
  EXPECT_EQ(space->FactorData.size(), 5u * 16u); // two at each end and one inside
  const KnotVector bezier = KnotVector::Uniform(3, 10, 0.0, 1.0, 3);
  EXPECT_TRUE((MakeTensorSpace<2>({ bezier, bezier }).Value->FactorData.empty()));
}

TEST(TensorSpaceOperators, FunctionsOfOneDirectionAreIndependent_ExactRankOracle)
{
  oracle::Random random(23);
  for (int p = 1; p <= 5; ++p)
  {
    for (int run = 0; run < 12; ++run)
    {
      const KnotVector k = SmallIntegerKnots(random, p, 5);
      const auto space = MakeTensorSpace<1>({ k }).Value;
      EXPECT_EQ(ExactRank<1>(*space), space->NumFunctions) << "degree " << p;
    }
  }
}

TEST(TensorSpaceOperators, FunctionsOfTwoDirectionsAreIndependent_ExactRankOracle)
{
  oracle::Random random(24);
  for (int run = 0; run < 6; ++run)
  {
    const auto space = MakeTensorSpace<2>({ SmallIntegerKnots(random, random.Int(1, 3), 3),
                                            SmallIntegerKnots(random, random.Int(1, 3), 3) })
                         .Value;
    EXPECT_EQ(ExactRank<2>(*space), space->NumFunctions);
  }
}

TYPED_TEST(TensorSpace, GrevillePointsAreTheIdentityMap_PropertyOracle)
{
  constexpr int Dim = TypeParam::value;
  oracle::Random random(25);
  for (int run = 0; run < 10; ++run)
  {
    Spline<Dim> spline;
    spline.Space = MakeTensorSpace<Dim>(RandomKnots<Dim>(random)).Value;
    spline.ControlPoints = GrevillePoints<Dim>(*spline.Space);
    ASSERT_TRUE(spline.Check());
    for (int i = 0; i < 8; ++i)
    {
      const auto u = RandomParameter<Dim>(random, *spline.Space);
      const auto x = oracle::Evaluate<Dim>(spline, u);
      for (int d = 0; d < Dim; ++d)
      {
        ASSERT_NEAR(x[d], u[d], 16 * Epsilon * 20.0); // |knots| < 20
      }
    }
  }
}

// ---- knot insertion ---------------------------------------------------------------------------

TYPED_TEST(TensorSpace, InsertionKeepsTheMap_CoxDeBoorOracle)
{
  constexpr int Dim = TypeParam::value;
  oracle::Random random(26);
  for (int run = 0; run < (Dim == 1 ? 150 : 15); ++run)
  {
    const bool rational = run % 2 == 1;
    const auto spline = random.Spline<Dim>(RandomKnots<Dim>(random), 2, rational);
    const int direction = random.Int(0, Dim - 1);
    const KnotVector& k = spline.Space->Knots[direction];
    // new values, some repeated, and copies of breaks (the ends too) up to multiplicity p + 1
    std::vector<double> inserted;
    for (int i = random.Int(0, 6); i > 0; --i)
    {
      inserted.insert(inserted.end(), random.Int(1, k.Degree() + 1), random.In(k.Begin(), k.End()));
    }
    for (int b = 0; b <= k.NumElements(); ++b)
    {
      inserted.insert(
        inserted.begin(), random.Int(0, k.Degree() + 1 - k.Multiplicity(b)), k.Breaks()[b]);
    }
    const auto refined = InsertKnots(spline, direction, inserted);
    ASSERT_TRUE(refined) << refined.Status.Message();
    ASSERT_TRUE(refined->Check()) << refined->Check().Message();
    auto expected = k.Knots();
    expected.insert(expected.end(), inserted.begin(), inserted.end());
    std::sort(expected.begin(), expected.end());
    ASSERT_EQ(refined->Space->Knots[direction].Knots(), expected);
    ASSERT_EQ(refined->IsRational(), rational);
    // convex combinations of coordinates below 1, p steps each; weights between 1/2 and 2 count 4
    ExpectSameMap<Dim>(random, spline, refined.Value, 128 * Epsilon);
    if (rational)
    {
      ASSERT_GE(refined->Weights.minCoeff(), spline.Weights.minCoeff() * (1.0 - 64 * Epsilon));
      ASSERT_LE(refined->Weights.maxCoeff(), spline.Weights.maxCoeff() * (1.0 + 64 * Epsilon));
    }
    ASSERT_LE(refined->ControlPoints.template lpNorm<Eigen::Infinity>(),
      spline.ControlPoints.template lpNorm<Eigen::Infinity>() * (1.0 + 64 * Epsilon));
  }
}

TEST(TensorOperations, InsertionOfOneKnot_BoehmOracle)
{
  oracle::Random random(27);
  for (int run = 0; run < 200; ++run)
  {
    const auto spline = random.Spline<1>({ random.Knots(6) }, 1, false);
    const KnotVector& k = spline.Space->Knots[0];
    const auto& t = k.Knots();
    const int p = k.Degree();
    const double u = random.Parameter(k);
    const int multiplicity = static_cast<int>(std::count(t.begin(), t.end(), u));
    if (multiplicity > p)
    {
      continue;
    }
    // Q_i = (1 - a_i) P_{i-1} + a_i P_i
    int last = 0;
    while (last + 1 < static_cast<int>(t.size()) && t[last + 1] <= u)
    {
      ++last;
    }
    const auto result = InsertKnots(spline, 0, { u });
    ASSERT_TRUE(result);
    ASSERT_EQ(result->Space->NumFunctions, k.NumFunctions() + 1);
    for (int i = 0; i <= k.NumFunctions(); ++i)
    {
      const double a = i <= last - p ? 1.0
        : i > last - multiplicity    ? 0.0
                                     : (u - t[i]) / (t[i + p] - t[i]);
      const double expected = (a < 1.0 ? (1.0 - a) * spline.ControlPoints(i - 1, 0) : 0.0) +
        (a > 0.0 ? a * spline.ControlPoints(i, 0) : 0.0);
      ASSERT_NEAR(result->ControlPoints(i, 0), expected, 64 * Epsilon);
    }
  }
}

TEST(TensorOperations, InsertionOfNothingIsTheSpline_ExactOracle)
{
  oracle::Random random(28);
  const auto spline = random.Spline<1>({ random.Knots(4) }, 3, true);
  EXPECT_EQ(InsertKnots(spline, 0, {})->ControlPoints, spline.ControlPoints);
  EXPECT_EQ(ElevateDegree(spline, 0, 0)->ControlPoints, spline.ControlPoints);
}

TEST(TensorOperations, FullMultiplicityGivesBezierPoints_ExtractionOracle)
{
  oracle::Random random(29);
  const KnotVector k = KnotVector::Create(3, { 0, 1, 1.5, 2, 3, 3, 5, 6, 7, 8 }).Value;
  const auto spline = random.Spline<1>({ k }, 2, false);
  std::vector<double> inserted;
  for (int b = 0; b <= k.NumElements(); ++b)
  {
    inserted.insert(inserted.end(), 4 - k.Multiplicity(b), k.Breaks()[b]);
  }
  const auto bezier = InsertKnots(spline, 0, inserted);
  ASSERT_TRUE(bezier);
  for (int e = 0; e < k.NumElements(); ++e)
  {
    const PointMatrix expected = spline.Space->ExtractionOperator(e).transpose() *
      spline.ControlPoints.middleRows(k.Span(e) - 3, 4);
    const int first = bezier->Space->Knots[0].Span(e) - 3;
    EXPECT_LE((bezier->ControlPoints.middleRows(first, 4) - expected).cwiseAbs().maxCoeff(),
      64 * Epsilon + 4e-13); // shared operators agree to 1e-13 an entry
  }
}

// ---- degree elevation -------------------------------------------------------------------------

TYPED_TEST(TensorSpace, ElevationKeepsTheMap_CoxDeBoorOracle)
{
  constexpr int Dim = TypeParam::value;
  oracle::Random random(31);
  for (int run = 0; run < (Dim == 1 ? 150 : 15); ++run)
  {
    const bool rational = run % 2 == 1;
    const auto spline = random.Spline<Dim>(RandomKnots<Dim>(random), 2, rational);
    const int direction = random.Int(0, Dim - 1);
    const KnotVector& k = spline.Space->Knots[direction];
    const int times = random.Int(0, std::min(9 - k.Degree(), 4));
    const auto elevated = ElevateDegree(spline, direction, times);
    ASSERT_TRUE(elevated) << elevated.Status.Message();
    ASSERT_TRUE(elevated->Check()) << elevated->Check().Message();
    const KnotVector& high = elevated->Space->Knots[direction];
    ASSERT_EQ(high.Degree(), k.Degree() + times);
    ASSERT_EQ(high.Breaks(), k.Breaks());
    for (int b = 1; b < k.NumElements(); ++b)
    {
      ASSERT_EQ(high.Multiplicity(b), k.Multiplicity(b) + times);
    }
    if (k.Multiplicity(0) == k.Degree() + 1 && k.Multiplicity(k.NumElements()) == k.Degree() + 1)
    {
      ASSERT_EQ(
        high.NumFunctions(), k.NumFunctions() + times * k.NumElements()); // one more an element
      ASSERT_EQ(high.Multiplicity(0), high.Degree() + 1);
    }
    ExpectSameMap<Dim>(random, spline, elevated.Value, 128 * Epsilon);
    ASSERT_LE(elevated->ControlPoints.template lpNorm<Eigen::Infinity>(),
      spline.ControlPoints.template lpNorm<Eigen::Infinity>() * (1.0 + 64 * Epsilon));
  }
}

TEST(TensorOperations, ElevationOfOneElement_BernsteinOracle)
{
  oracle::Random random(32);
  for (int p = 1; p <= 9; ++p)
  {
    for (int q = p; q <= 9; ++q)
    {
      const auto spline = random.Spline<1>({ KnotVector::Uniform(p, 1) }, 1, false);
      const std::vector<double> a(spline.ControlPoints.data(), spline.ControlPoints.data() + p + 1);
      const auto expected = BernsteinElevate<1>({ p }, a, { q });
      const auto result = ElevateDegree(spline, 0, q - p);
      for (int i = 0; i <= q; ++i)
      {
        EXPECT_NEAR(result->ControlPoints(i, 0), expected[i], 64 * Epsilon);
      }
    }
  }
}

TEST(TensorOperations, ElevationKeepsLongKnotVectors_PropertyOracle)
{
  // control points may not drift along many elements
  oracle::Random random(33);
  const auto spline = random.Spline<1>({ KnotVector::Uniform(3, 2000, -1.0, 1.0) }, 1, false);
  const auto elevated = ElevateDegree(spline, 0, 2);
  ASSERT_TRUE(elevated);
  EXPECT_EQ(elevated->ControlPoints(0, 0), spline.ControlPoints(0, 0));
  EXPECT_EQ(elevated->ControlPoints(elevated->ControlPoints.rows() - 1, 0),
    spline.ControlPoints(spline.ControlPoints.rows() - 1, 0));
  ExpectSameMap<1>(random, spline, elevated.Value, 64 * Epsilon);
}

TEST(TensorOperations, QuarterCircleStaysExact_AnalyticOracle)
{
  auto arc = ElevateDegree(QuarterCircle(), 0, 2).Value;
  arc = InsertKnots(arc, 0, { 0.1, 0.5, 0.5, 0.7 }).Value;
  arc = ElevateDegree(arc, 0, 1).Value;
  arc = InsertKnots(arc, 0, { 0.5, 0.25 }).Value;
  ASSERT_EQ(arc.Space->Knots[0].Degree(), 5);
  for (int i = 0; i <= 100; ++i)
  {
    const auto x = oracle::Evaluate<1>(arc, { i / 100.0 });
    EXPECT_NEAR(std::hypot(x[0], x[1]), 1.0, 16 * Epsilon);
  }
}

TEST(TensorOperations, QuarterAnnulusStaysExact_AnalyticOracle)
{
  const auto arc = QuarterCircle();
  Spline<2> annulus;
  annulus.Space =
    MakeTensorSpace<2>({ KnotVector::Uniform(1, 1), KnotVector::Uniform(2, 1) }).Value;
  annulus.ControlPoints.resize(6, 2);
  annulus.Weights.resize(6);
  for (int i = 0; i < 6; ++i)
  {
    annulus.ControlPoints.row(i) = (1.0 + i % 2) * arc.ControlPoints.row(i / 2);
    annulus.Weights[i] = arc.Weights[i / 2];
  }
  auto fine = ElevateDegree(annulus, 0, 2).Value;
  fine = ElevateDegree(fine, 1, 1).Value;
  fine = InsertKnots(fine, 0, { 0.3, 0.6 }).Value;
  fine = InsertKnots(fine, 1, { 0.5 }).Value;
  for (int i = 0; i <= 10; ++i)
  {
    for (int j = 0; j <= 10; ++j)
    {
      const auto x = oracle::Evaluate<2>(fine, { i / 10.0, j / 10.0 });
      EXPECT_NEAR(std::hypot(x[0], x[1]), 1.0 + i / 10.0, 32 * Epsilon);
    }
  }
}
