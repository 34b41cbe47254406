// SPDX-License-Identifier: BSD-3-Clause
#include "SplineOracle.h"
#include <knotwork/SplineCore/Bernstein.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace knotwork;
using oracle::Epsilon;

namespace
{
template <int Dim>
std::vector<double> RandomCoefficients(oracle::Random& random, const IntArray<Dim>& degree)
{
  std::vector<double> a(NumTensorFunctions<Dim>(degree));
  for (double& value : a)
  {
    value = random.In(-1.0, 1.0);
  }
  return a;
}

/// Value by the definition of the Bernstein polynomials, in extended precision.
template <int Dim>
double Value(const IntArray<Dim>& degree, const std::vector<double>& a, const RealArray<Dim>& t)
{
  oracle::Real sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    oracle::Real term = a[i];
    int rest = static_cast<int>(i);
    for (int d = 0; d < Dim; ++d)
    {
      term *= oracle::Bernstein(degree[d], rest % (degree[d] + 1), t[d]);
      rest /= degree[d] + 1;
    }
    sum += term;
  }
  return static_cast<double>(sum);
}

template <int Dim>
IntArray<Dim> RandomDegree(oracle::Random& random, int lower, int upper)
{
  IntArray<Dim> degree;
  for (int& p : degree)
  {
    p = random.Int(lower, upper);
  }
  return degree;
}

template <int Dim>
RealArray<Dim> RandomPoint(oracle::Random& random)
{
  RealArray<Dim> t;
  for (double& x : t)
  {
    x = random.Int(0, 9) == 0 ? random.Int(0, 1) : random.Unit();
  }
  return t;
}

template <typename Dimension>
class BernsteinInDimension : public testing::Test
{
};
using Dimensions = testing::Types<std::integral_constant<int, 1>, std::integral_constant<int, 2>,
  std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(BernsteinInDimension, Dimensions);
}

TEST(Bernstein, BinomialsUpTo56AreExact_IntegerOracle)
{
  std::vector<unsigned long long> row = { 1 };
  for (int n = 0; n <= 56; ++n)
  {
    for (int k = 0; k <= n; ++k)
    {
      EXPECT_EQ(Binomial(n, k), static_cast<double>(row[k]));
      EXPECT_EQ(static_cast<unsigned long long>(Binomial(n, k)), row[k]);
    }
    row.push_back(0);
    for (int k = n + 1; k > 0; --k)
    {
      row[k] += row[k - 1];
    }
  }
  EXPECT_EQ(Binomial(4, -1), 0.0);
  EXPECT_EQ(Binomial(4, 5), 0.0);
  EXPECT_NEAR(Binomial(60, 30) / 118264581564861424.0, 1.0, 60 * Epsilon);
}

TEST(Bernstein, Values_DefinitionOracle)
{
  oracle::Random random(10);
  for (int p = 0; p <= 27; ++p)
  {
    std::vector<double> values(p + 1);
    for (double t : { 0.0, 1.0, 0.5, random.Unit(), random.Unit(), 1e-9, -0.5, 1.5 })
    {
      BernsteinValues(p, t, values.data());
      double sum = 0.0;
      double size = 0.0;
      for (int i = 0; i <= p; ++i)
      {
        const double expected = static_cast<double>(oracle::Bernstein(p, i, t));
        // inside [0, 1] all terms are positive: relative accuracy
        ASSERT_NEAR(values[i], expected, 4 * (p + 1) * Epsilon * std::abs(expected) + 1e-300);
        sum += values[i];
        size += std::abs(values[i]);
      }
      ASSERT_NEAR(sum, 1.0, 4 * (p + 1) * Epsilon * size);
    }
  }
}

TEST(Bernstein, Derivatives_DeCasteljauOracle)
{
  oracle::Random random(11);
  for (int p = 0; p <= 9; ++p)
  {
    const int order = 4;
    std::vector<double> rows((order + 1) * (p + 1));
    for (double t : { 0.0, 1.0, random.Unit(), random.Unit() })
    {
      BernsteinDerivatives(p, t, order, rows.data());
      for (int i = 0; i <= p; ++i)
      {
        std::vector<double> a(p + 1, 0.0);
        a[i] = 1.0;
        double scale = 1.0;
        for (int k = 0, q = p; k <= order; ++k, --q)
        {
          const double expected = q < 0 ? 0.0 : BernsteinEvaluate<1>({ q }, a.data(), &t);
          ASSERT_NEAR(rows[k * (p + 1) + i], expected, 16 * (p + 1) * Epsilon * scale)
            << "degree " << p << " derivative " << k;
          if (q > 0)
          {
            a = BernsteinDerivative<1>({ q }, a, 0);
          }
          else
          {
            a.assign(1, 0.0);
          }
          scale *= 2.0 * std::max(q, 1);
        }
      }
    }
  }
}

TEST(Bernstein, DerivativesOfMonomials_ExactOracle)
{
  // t^m has the Bernstein coefficients C(i, m) / C(p, m)
  const double t = 0.375;
  for (int p = 1; p <= 9; ++p)
  {
    for (int m = 0; m <= p; ++m)
    {
      std::vector<double> rows(3 * (p + 1));
      BernsteinDerivatives(p, t, 2, rows.data());
      double sums[3] = {};
      for (int k = 0; k < 3; ++k)
      {
        for (int i = 0; i <= p; ++i)
        {
          sums[k] += rows[k * (p + 1) + i] * Binomial(i, m) / Binomial(p, m);
        }
      }
      EXPECT_NEAR(sums[0], std::pow(t, m), 32 * Epsilon);
      EXPECT_NEAR(sums[1], m * std::pow(t, m - 1), 32 * 2 * p * Epsilon);
      EXPECT_NEAR(sums[2], m * (m - 1) * std::pow(t, m - 2), 32 * 4 * p * p * Epsilon);
    }
  }
}

TYPED_TEST(BernsteinInDimension, DeCasteljau_DefinitionOracle)
{
  constexpr int Dim = TypeParam::value;
  oracle::Random random(12);
  for (int run = 0; run < 60; ++run)
  {
    const auto degree = RandomDegree<Dim>(random, 0, 9);
    const auto a = RandomCoefficients<Dim>(random, degree);
    const auto t = RandomPoint<Dim>(random);
    ASSERT_NEAR(
      BernsteinEvaluate<Dim>(degree, a.data(), t.data()), Value<Dim>(degree, a, t), 64 * Epsilon);
  }
}

TYPED_TEST(BernsteinInDimension, Product_PointwiseOracle)
{
  constexpr int Dim = TypeParam::value;
  oracle::Random random(13);
  for (int run = 0; run < 40; ++run)
  {
    const auto p = RandomDegree<Dim>(random, 0, 5);
    const auto q = RandomDegree<Dim>(random, 0, 5);
    const auto a = RandomCoefficients<Dim>(random, p);
    const auto b = RandomCoefficients<Dim>(random, q);
    const auto c = BernsteinProduct<Dim>(p, a, q, b);
    IntArray<Dim> r;
    for (int d = 0; d < Dim; ++d)
    {
      r[d] = p[d] + q[d];
    }
    ASSERT_EQ(c.size(), static_cast<std::size_t>(NumTensorFunctions<Dim>(r)));
    const auto t = RandomPoint<Dim>(random);
    // coefficients are convex combinations of products of numbers below 1
    ASSERT_NEAR(Value<Dim>(r, c, t), Value<Dim>(p, a, t) * Value<Dim>(q, b, t), 64 * Epsilon);
  }
}

TYPED_TEST(BernsteinInDimension, Derivative_ProductRuleOracle)
{
  constexpr int Dim = TypeParam::value;
  oracle::Random random(14);
  for (int run = 0; run < 30; ++run)
  {
    const auto p = RandomDegree<Dim>(random, 1, 4);
    const auto a = RandomCoefficients<Dim>(random, p);
    const int direction = random.Int(0, Dim - 1);
    const auto d = BernsteinDerivative<Dim>(p, a, direction);
    IntArray<Dim> low = p;
    --low[direction];
    IntArray<Dim> square;
    for (int k = 0; k < Dim; ++k)
    {
      square[k] = 2 * p[k];
    }
    // (a^2)' = 2 a a'
    const auto left =
      BernsteinDerivative<Dim>(square, BernsteinProduct<Dim>(p, a, p, a), direction);
    const auto right = BernsteinProduct<Dim>(p, a, low, d);
    ASSERT_EQ(left.size(), right.size());
    for (std::size_t i = 0; i < left.size(); ++i)
    {
      ASSERT_NEAR(left[i], 2.0 * right[i], 32 * 16 * Epsilon); // |a'| <= 2 p <= 8
    }
    // and the definition of a derivative, by a centred difference of a polynomial continued
    auto t = RandomPoint<Dim>(random);
    const double slope = Value<Dim>(low, d, t);
    const double h = 1e-4;
    t[direction] += h;
    const double after = Value<Dim>(p, a, t);
    t[direction] -= 2.0 * h;
    const double before = Value<Dim>(p, a, t);
    ASSERT_NEAR((after - before) / (2.0 * h), slope, 1e-5); // h^2 / 6 times third derivatives < 500
  }
}

TYPED_TEST(BernsteinInDimension, Elevation_PointwiseOracle)
{
  constexpr int Dim = TypeParam::value;
  oracle::Random random(15);
  for (int run = 0; run < 40; ++run)
  {
    const auto p = RandomDegree<Dim>(random, 0, 6);
    auto q = p;
    for (int& degree : q)
    {
      degree += random.Int(0, 4);
    }
    const auto a = RandomCoefficients<Dim>(random, p);
    const auto b = BernsteinElevate<Dim>(p, a, q);
    ASSERT_EQ(b.size(), static_cast<std::size_t>(NumTensorFunctions<Dim>(q)));
    const auto t = RandomPoint<Dim>(random);
    ASSERT_NEAR(Value<Dim>(q, b, t), Value<Dim>(p, a, t), 64 * Epsilon);
    ASSERT_EQ(b.front(), a.front());
    ASSERT_EQ(b.back(), a.back());
  }
}

TYPED_TEST(BernsteinInDimension, Restriction_PointwiseOracle)
{
  constexpr int Dim = TypeParam::value;
  oracle::Random random(16);
  for (int run = 0; run < 60; ++run)
  {
    const auto p = RandomDegree<Dim>(random, 0, 7);
    const auto a = RandomCoefficients<Dim>(random, p);
    const int direction = random.Int(0, Dim - 1);
    const double lower = random.Unit();
    const double upper = run % 5 == 0 ? lower : random.Unit(); // also reversed, also a point
    const auto b = BernsteinRestrict<Dim>(p, a, direction, lower, upper);
    auto t = RandomPoint<Dim>(random);
    const double value = Value<Dim>(p, b, t);
    t[direction] = lower + (upper - lower) * t[direction];
    // rounding of the mapped parameter counts with the slope 2 p <= 14
    ASSERT_NEAR(value, Value<Dim>(p, a, t), 64 * Epsilon);
    ASSERT_EQ((BernsteinRestrict<Dim>(p, a, direction, 0.0, 1.0)), a);
  }
}

TYPED_TEST(BernsteinInDimension, RestrictionFactor_CrossOracle)
{
  constexpr int Dim = TypeParam::value;
  oracle::Random random(18);
  for (int run = 0; run < 60; ++run)
  {
    const auto p = RandomDegree<Dim>(random, 0, 10);
    const auto a = RandomCoefficients<Dim>(random, p);
    const std::size_t direction = static_cast<std::size_t>(random.Int(0, Dim - 1));
    const double lower = run % 4 == 0 ? 0.0 : random.Unit();
    const double upper = run % 4 == 1 ? 1.0 : random.Unit();
    const auto expected = BernsteinRestrict<Dim>(p, a, static_cast<int>(direction), lower, upper);
    std::vector<double> matrix(static_cast<std::size_t>((p[direction] + 1) * (p[direction] + 1)));
    BernsteinRestriction(p[direction], lower, upper, matrix.data());
    std::array<const double*, Dim> factors{};
    factors[direction] = matrix.data();
    std::vector<double> b(a.size());
    ApplyFactors<Dim>(p, factors, a.data(), b.data());
    for (std::size_t i = 0; i < a.size(); ++i)
    {
      ASSERT_NEAR(
        b[i], expected[i], 64 * Epsilon); // both are convex combinations of values in [-1, 1]
    }
  }
}

TEST(Bernstein, RestrictionBeyondTheInterval_PointwiseOracle)
{
  oracle::Random random(17);
  const IntArray<1> p = { 5 };
  const auto a = RandomCoefficients<1>(random, p);
  const auto b = BernsteinRestrict<1>(p, a, 0, -0.5, 1.5);
  for (double t : { 0.0, 0.25, 0.6, 1.0 })
  {
    EXPECT_NEAR((Value<1>(p, b, { t })), (Value<1>(p, a, { -0.5 + 2.0 * t })),
      32 * 32 * Epsilon); // growth (1/2 + 3/2)^5
  }
}

TEST(Bernstein, GramInverse_ExactOracle)
{
  for (int p = 0; p <= 9; ++p)
  {
    const auto inverse = BernsteinGramInverse(p);
    double largest = 0.0;
    for (double value : inverse)
    {
      largest = std::max(largest, std::abs(value));
    }
    for (int i = 0; i <= p; ++i)
    {
      for (int j = 0; j <= p; ++j)
      {
        oracle::Real sum = 0;
        for (int k = 0; k <= p; ++k)
        {
          const oracle::Real gram = static_cast<oracle::Real>(Binomial(p, i)) * Binomial(p, k) /
            ((2 * p + 1) * static_cast<oracle::Real>(Binomial(2 * p, i + k)));
          sum += gram * inverse[k * (p + 1) + j];
        }
        ASSERT_NEAR(static_cast<double>(sum), i == j ? 1.0 : 0.0, Epsilon * largest);
      }
    }
  }
}

TYPED_TEST(BernsteinInDimension, ApplyFactors_DefinitionOracle)
{
  constexpr int Dim = TypeParam::value;
  oracle::Random random(18);
  for (int run = 0; run < 20; ++run)
  {
    const auto p = RandomDegree<Dim>(random, 1, Dim == 3 ? 4 : 9);
    const auto in = RandomCoefficients<Dim>(random, p);
    std::array<std::vector<double>, Dim> storage;
    std::array<const double*, Dim> factors;
    for (int d = 0; d < Dim; ++d)
    {
      storage[d] = RandomCoefficients<2>(random, { p[d], p[d] });
      factors[d] = random.Int(0, 3) == 0 ? nullptr : storage[d].data();
    }
    std::vector<double> out(in.size());
    ApplyFactors<Dim>(p, factors, in.data(), out.data());
    for (std::size_t k = 0; k < out.size(); ++k)
    {
      oracle::Real sum = 0;
      for (std::size_t i = 0; i < in.size(); ++i)
      {
        oracle::Real term = in[i];
        int restI = static_cast<int>(i);
        int restK = static_cast<int>(k);
        for (int d = 0; d < Dim; ++d)
        {
          const int n = p[d] + 1;
          term *= factors[d] ? factors[d][restI % n * n + restK % n]
                             : (restI % n == restK % n ? 1.0 : 0.0);
          restI /= n;
          restK /= n;
        }
        sum += term;
      }
      ASSERT_NEAR(out[k], static_cast<double>(sum), 1000 * 8 * Epsilon); // up to 125 terms below 1
    }
    auto inPlace = in;
    ApplyFactors<Dim>(p, factors, inPlace.data(), inPlace.data());
    ASSERT_EQ(inPlace, out);
  }
}
