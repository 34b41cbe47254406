// SPDX-License-Identifier: BSD-3-Clause
#include "SplineOracle.h"
#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/KnotVector.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using knotwork::ErrorCode;
using knotwork::KnotVector;

namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();
}

TEST(KnotVector, CreateReportsEachFault_ExactOracle)
{
  struct
  {
    int Degree;
    std::vector<double> Knots;
    ErrorCode Code;
    const char* Place; // what the detail must name
  } const cases[] = {
    { 0, { 0, 1 }, ErrorCode::InvalidDegree, "0" },
    { 10, std::vector<double>(22, 0.0), ErrorCode::InvalidDegree, "10" },
    { 2, { 0, 0, 1, 1, 1 }, ErrorCode::InvalidKnots, "5" },
    { 1, {}, ErrorCode::InvalidKnots, "0" },
    { 1, { 0, 0, NaN, 1 }, ErrorCode::NonFiniteInput, "knot 2" },
    { 1, { 0, 0, 1, Infinity }, ErrorCode::NonFiniteInput, "knot 3" },
    { 1, { 0, 0, 2, 1, 3, 3 }, ErrorCode::InvalidKnots, "knot 3" },
    { 1, { 0, 0, 1, 1, 1, 2, 2 }, ErrorCode::InvalidKnots, "knot 4" },
    { 1, { 0, 0, 0, 1 }, ErrorCode::InvalidKnots, "knot 2" },
    { 2, { 0, 1, 2, 2, 3, 4 }, ErrorCode::InvalidKnots, "domain" },
    { 1, { -1.7e308, -1.7e308, 1.7e308, 1.7e308 }, ErrorCode::InvalidKnots, "length" },
  };
  for (const auto& c : cases)
  {
    const auto result = KnotVector::Create(c.Degree, c.Knots);
    EXPECT_EQ(result.Status.Code, c.Code) << result.Status.Message();
    EXPECT_NE(result.Status.Detail.find(c.Place), std::string::npos) << result.Status.Message();
  }
}

TEST(KnotVector, AcceptsEveryLegalShape_ExactOracle)
{
  EXPECT_TRUE(KnotVector::Create(1, { 0, 0, 1, 1 }));
  EXPECT_TRUE(KnotVector::Create(1, { 0, 1, 2, 3 }));             // unclamped
  EXPECT_TRUE(KnotVector::Create(1, { 0, 0, 1, 1, 2, 2 }));       // discontinuous
  EXPECT_TRUE(KnotVector::Create(2, { 0, 1, 2, 2, 2, 3, 4, 5 })); // C^-1, unclamped
  EXPECT_TRUE(KnotVector() == KnotVector::Create(1, { 0, 0, 1, 1 }).Value);
  EXPECT_FALSE(KnotVector() == KnotVector::Uniform(2, 1));
}

TEST(KnotVector, UniformKnots_ExactOracle)
{
  const KnotVector k = KnotVector::Uniform(2, 4, -1.0, 3.0, 2);
  EXPECT_EQ(k.Knots(), (std::vector<double>{ -1, -1, -1, 0, 0, 1, 1, 2, 2, 3, 3, 3 }));
  EXPECT_EQ(k.Breaks(), (std::vector<double>{ -1, 0, 1, 2, 3 }));
  EXPECT_EQ(k.NumFunctions(), 9);
  EXPECT_EQ(k.NumElements(), 4);
  for (int p = 1; p <= 9; ++p)
  {
    for (int m = 1; m <= p + 1; ++m)
    {
      const KnotVector u = KnotVector::Uniform(p, 7, 0.1, 0.7, m);
      EXPECT_EQ(u.NumFunctions(), p + 1 + 6 * m);
      EXPECT_EQ(u.NumElements(), 7);
      EXPECT_EQ(u.End(), 0.7);
      EXPECT_EQ(u.Multiplicity(0), p + 1);
      EXPECT_EQ(u.Multiplicity(3), m);
      EXPECT_TRUE(KnotVector::Create(p, u.Knots()));
    }
  }
}

TEST(KnotVector, SpansBreaksAndSupports_DefinitionOracle)
{
  oracle::Random random(1);
  for (int run = 0; run < 400; ++run)
  {
    const KnotVector k = random.Knots(8);
    const auto& t = k.Knots();
    const int p = k.Degree();
    ASSERT_EQ(k.Begin(), t[p]);
    ASSERT_EQ(k.End(), t[k.NumFunctions()]);
    for (int e = 0; e < k.NumElements(); ++e)
    {
      ASSERT_LT(k.Breaks()[e], k.Breaks()[e + 1]);
      ASSERT_EQ(t[k.Span(e)], k.Breaks()[e]);
      ASSERT_EQ(t[k.Span(e) + 1], k.Breaks()[e + 1]);
      ASSERT_EQ(std::count(t.begin(), t.end(), k.Breaks()[e]), k.Multiplicity(e));
    }
    for (int i = 0; i < k.NumFunctions(); ++i)
    {
      int first = k.NumElements();
      int last = -1;
      for (int e = 0; e < k.NumElements(); ++e)
      {
        if (k.Span(e) - p <= i && i <= k.Span(e))
        {
          first = std::min(first, e);
          last = e;
        }
      }
      const auto support = k.Support(i);
      if (last < 0)
      {
        ASSERT_GT(support[0], support[1]);
      }
      else
      {
        ASSERT_EQ(support[0], first);
        ASSERT_EQ(support[1], last);
      }
    }
  }
}

TEST(KnotVector, FindElement_LinearSearchOracle)
{
  oracle::Random random(2);
  for (int run = 0; run < 300; ++run)
  {
    const KnotVector k = random.Knots(60);
    const auto& b = k.Breaks();
    std::vector<double> parameters = { -Infinity, Infinity, -1e300, 1e300, k.Begin() - 1.0,
      k.End() + 1.0 };
    for (double u : b) // breaks and their floating-point neighbours
    {
      parameters.insert(
        parameters.end(), { u, std::nextafter(u, -Infinity), std::nextafter(u, Infinity) });
    }
    for (int i = 0; i < 200; ++i)
    {
      parameters.push_back(random.In(k.Begin(), k.End()));
    }
    for (double u : parameters)
    {
      int expected = 0;
      while (expected + 1 < k.NumElements() && b[expected + 1] <= u)
      {
        ++expected;
      }
      ASSERT_EQ(k.FindElement(u), expected) << u;
    }
  }
}

TEST(KnotVector, FindElementOnExtremeKnots_LinearSearchOracle)
{
  const std::vector<KnotVector> vectors = {
    KnotVector::Uniform(1, 100, 1e10, 1e10 + 1e-3), // a few hundred representable numbers
    KnotVector::Create(1, { 0, 0, 1e-300, 1e-200, 1e-100, 1e-10, 1, 1e10, 1e300, 1e300 }).Value,
    KnotVector::Create(1, { 0, 0, 5e-324, 1e-323, 1e-323 }).Value,
    KnotVector::Create(1, { -8e307, -8e307, 0, 8e307, 8e307 }).Value,
  };
  for (const KnotVector& k : vectors)
  {
    for (int e = 0; e < k.NumElements(); ++e)
    {
      EXPECT_EQ(k.FindElement(k.Breaks()[e]), e);
      EXPECT_EQ(k.FindElement(std::nextafter(k.Breaks()[e + 1], -Infinity)), e);
    }
    EXPECT_EQ(k.FindElement(k.End()), k.NumElements() - 1);
  }
  EXPECT_GE(vectors[0].FindElement(NaN), 0); // any element, but no crash
}

TEST(KnotVector, ValuesAndDerivatives_CoxDeBoorOracle)
{
  oracle::Random random(3);
  double worst = 0.0;
  for (int run = 0; run < 150; ++run)
  {
    const KnotVector k = random.Knots(6);
    const int p = k.Degree();
    const int order = std::min(p, 4);
    std::vector<double> values((order + 1) * (p + 1));
    for (int sample = 0; sample < 6; ++sample)
    {
      const double u = random.Parameter(k);
      const int e = k.FindElement(u);
      ASSERT_EQ(k.Span(e), oracle::FindSpan(p, k.Knots(), u));
      k.EvaluateFunctions(e, u, order, values.data());
      for (int d = 0; d <= order; ++d)
      {
        std::vector<double> expected;
        double size = 0.0;
        for (int i = 0; i <= p; ++i)
        {
          expected.push_back(static_cast<double>(
            oracle::BasisDerivative(k.Span(e) - p + i, p, k.Knots(), k.Span(e), u, d)));
          size = std::max(size, std::abs(expected.back()));
        }
        for (int i = 0; i <= p; ++i)
        {
          const double error = std::abs(values[d * (p + 1) + i] - expected[i]) / size;
          worst = std::max(worst, error);
          // each of the 2 p steps rounds a few times; knot lengths that differ by 100 amplify the
          // differences of a derivative
          ASSERT_LE(error, (d == 0 ? 64 : 6400) * oracle::Epsilon)
            << "degree " << p << " derivative " << d << " at " << u;
        }
      }
    }
  }
  RecordProperty("worstRelativeError", std::to_string(worst));
}

TEST(KnotVector, PartitionOfUnityAndPositivity_PropertyOracle)
{
  oracle::Random random(4);
  for (int run = 0; run < 500; ++run)
  {
    const KnotVector k = random.Knots(6);
    const int p = k.Degree();
    double values[3 * 10];
    const double u = random.Parameter(k);
    k.EvaluateFunctions(k.FindElement(u), u, 2, values);
    double sums[3] = {};
    double sizes[3] = {};
    for (int d = 0; d < 3; ++d)
    {
      for (int i = 0; i <= p; ++i)
      {
        sums[d] += values[d * (p + 1) + i];
        sizes[d] += std::abs(values[d * (p + 1) + i]);
        if (d == 0)
        {
          ASSERT_GE(values[i], 0.0);
        }
      }
    }
    ASSERT_NEAR(sums[0], 1.0, 32 * oracle::Epsilon);
    ASSERT_LE(std::abs(sums[1]), 320 * oracle::Epsilon * sizes[1]);
    ASSERT_LE(std::abs(sums[2]), 3200 * oracle::Epsilon * sizes[2]);
  }
}

TEST(KnotVector, DerivativesAboveDegreeVanish_ExactOracle)
{
  const KnotVector k = KnotVector::Uniform(2, 3);
  double values[6 * 3];
  k.EvaluateFunctions(1, 0.5, 5, values);
  for (int i = 9; i < 18; ++i)
  {
    EXPECT_EQ(values[i], 0.0);
  }
}

TEST(KnotVector, ContinuedPolynomials_CoxDeBoorOracle)
{
  const KnotVector k = KnotVector::Create(3, { 0, 0, 0, 0, 1, 3, 4, 4, 4, 4 }).Value;
  double values[4];
  for (double u : { -1.0, 0.5, 3.5, 6.0 })
  {
    k.EvaluateFunctions(1, u, 0, values);
    for (int i = 0; i < 4; ++i)
    {
      EXPECT_NEAR(values[i], static_cast<double>(oracle::Basis(1 + i, 3, k.Knots(), 4, u)),
        1e-13); // values up to 60
    }
  }
}

TEST(KnotVector, GrevilleAbscissaeReproduceTheParameter_PropertyOracle)
{
  oracle::Random random(5);
  for (int run = 0; run < 300; ++run)
  {
    const KnotVector k = random.Knots(6);
    const double u = random.Parameter(k);
    const int e = k.FindElement(u);
    double values[20];
    k.EvaluateFunctions(e, u, 1, values);
    double sum = 0.0;
    double slope = 0.0;
    for (int i = 0; i <= k.Degree(); ++i)
    {
      const double g = k.Greville(k.Span(e) - k.Degree() + i);
      sum += g * values[i];
      slope += g * values[k.Degree() + 1 + i];
    }
    ASSERT_NEAR(sum, u, 32 * oracle::Epsilon * 20.0); // |knots| < 20
    ASSERT_NEAR(slope, 1.0, 1e-9);                    // eps * 20 * p / shortest knot span (1e-2)
  }
}

TEST(KnotVector, ExtractionEqualsBasis_CoxDeBoorOracle)
{
  oracle::Random random(6);
  for (int run = 0; run < 150; ++run)
  {
    const KnotVector k = random.Knots(6);
    const int p = k.Degree();
    std::vector<double> matrix((p + 1) * (p + 1));
    for (int e = 0; e < k.NumElements(); ++e)
    {
      k.Extraction(e, matrix.data());
      for (double local : { 0.0, 0.25, random.Unit(), 1.0 })
      {
        const oracle::Real a = k.Breaks()[e];
        const oracle::Real u = a + (k.Breaks()[e + 1] - a) * local;
        for (int i = 0; i <= p; ++i)
        {
          oracle::Real value = 0;
          for (int j = 0; j <= p; ++j)
          {
            value += matrix[i * (p + 1) + j] * oracle::Bernstein(p, j, local);
            ASSERT_GE(matrix[i * (p + 1) + j], 0.0);
          }
          ASSERT_NEAR(static_cast<double>(value),
            static_cast<double>(oracle::Basis(k.Span(e) - p + i, p, k.Knots(), k.Span(e), u)),
            64 * oracle::Epsilon); // p de Boor steps of convex combinations
        }
      }
      for (int j = 0; j <= p; ++j)
      {
        double sum = 0.0;
        for (int i = 0; i <= p; ++i)
        {
          sum += matrix[i * (p + 1) + j];
        }
        ASSERT_NEAR(sum, 1.0, 32 * oracle::Epsilon);
      }
    }
  }
}

TEST(KnotVector, ExtractionOfBezierKnotsIsIdentity_ExactOracle)
{
  for (int p = 1; p <= 9; ++p)
  {
    double matrix[100];
    KnotVector::Uniform(p, 3, 0.0, 1.0, p).Extraction(1, matrix);
    for (int i = 0; i < (p + 1) * (p + 1); ++i)
    {
      EXPECT_EQ(matrix[i], i % (p + 2) == 0 ? 1.0 : 0.0);
    }
  }
}

TEST(KnotVector, DyadicKnots_ExactOracle)
{
  const KnotVector k = KnotVector::Create(2, { 0, 0.5, 1, 1, 3, 4, 5, 6 }).Value;
  // elements [1, 3], [3, 4]; knots beyond the domain stay
  EXPECT_EQ(k.Dyadic().Knots(), (std::vector<double>{ 0, 0.5, 1, 1, 2, 3, 3.5, 4, 5, 6 }));
}

TEST(KnotVector, DyadicKeepsDomainAndMultiplicity_PropertyOracle)
{
  oracle::Random random(7);
  for (int run = 0; run < 200; ++run)
  {
    const KnotVector k = random.Knots(6);
    const KnotVector fine = k.Dyadic();
    ASSERT_TRUE(KnotVector::Create(k.Degree(), fine.Knots()));
    ASSERT_EQ(fine.Begin(), k.Begin());
    ASSERT_EQ(fine.End(), k.End());
    ASSERT_EQ(fine.NumElements(), 2 * k.NumElements());
    ASSERT_EQ(fine.NumFunctions(), k.NumFunctions() + k.NumElements());
    for (int e = 0; e <= k.NumElements(); ++e)
    {
      ASSERT_EQ(fine.Breaks()[2 * e], k.Breaks()[e]);
      ASSERT_EQ(fine.Multiplicity(2 * e), k.Multiplicity(e));
    }
    for (int e = 0; e < k.NumElements(); ++e)
    {
      ASSERT_EQ(fine.Multiplicity(2 * e + 1), 1);
      ASSERT_NEAR(fine.Breaks()[2 * e + 1], 0.5 * (k.Breaks()[e] + k.Breaks()[e + 1]),
        2 * oracle::Epsilon * 20.0); // |knots| < 20
    }
  }
}
