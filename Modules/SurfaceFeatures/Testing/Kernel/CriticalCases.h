// SPDX-License-Identifier: BSD-3-Clause
// Functions whose critical points are known, as splines.
#pragma once
#include "LRCases.h"
#include <knotwork/SurfaceFeatures/CriticalPoints.h>

#include <gtest/gtest.h>

#include <sstream>

namespace knotwork::testing
{
/// A term c u^a v^b.
struct Monomial
{
  double C;
  int A;
  int B;
};

/// Coefficient of x^k in the B-spline of knots t (p of them): its polar form there.
inline double PolarForm(const double* t, int p, int k)
{
  std::vector<double> e(static_cast<std::size_t>(k) + 1, 0.0); // elementary symmetric
  e[0] = 1.0;
  double ways = 1.0;
  for (int i = 0; i < p; ++i)
  {
    for (int j = k; j > 0; --j)
    {
      e[static_cast<std::size_t>(j)] += t[i] * e[static_cast<std::size_t>(j - 1)];
    }
  }
  for (int i = 0; i < k; ++i)
  {
    ways = ways * (p - i) / (i + 1);
  }
  return e[static_cast<std::size_t>(k)] / ways;
}

/// Clamped knots on these breaks, each interior one as often as said.
inline KnotVector BreakKnots(int degree, const std::vector<double>& breaks, int multiplicity = 1)
{
  std::vector<double> knots(static_cast<std::size_t>(degree) + 1, breaks.front());
  for (std::size_t i = 1; i + 1 < breaks.size(); ++i)
  {
    knots.insert(knots.end(), static_cast<std::size_t>(multiplicity), breaks[i]);
  }
  knots.insert(knots.end(), static_cast<std::size_t>(degree) + 1, breaks.back());
  return KnotVector::Create(degree, knots).Value;
}

/// A polynomial in a tensor-product space.
inline Spline<2> PolynomialSpline(
  const std::array<KnotVector, 2>& knots, const std::vector<Monomial>& terms)
{
  Spline<2> f;
  f.Space = MakeTensorSpace<2>(knots).Value;
  f.ControlPoints = PointMatrix::Zero(f.Space->NumFunctions, 1);
  const int n = knots[0].NumFunctions();
  for (int i = 0; i < f.Space->NumFunctions; ++i)
  {
    const double* s = knots[0].Knots().data() + i % n + 1;
    const double* t = knots[1].Knots().data() + i / n + 1;
    for (const Monomial& m : terms)
    {
      f.ControlPoints(i, 0) +=
        m.C * PolarForm(s, knots[0].Degree(), m.A) * PolarForm(t, knots[1].Degree(), m.B);
    }
  }
  return f;
}

/// The same on a square, divided evenly.
inline Spline<2> PolynomialOn(
  double low, double high, int degree, int elements, const std::vector<Monomial>& terms)
{
  std::vector<double> breaks;
  for (int i = 0; i <= elements; ++i)
  {
    breaks.push_back(i == elements ? high : low + i * (high - low) / elements);
  }
  const KnotVector knots = BreakKnots(degree, breaks);
  return PolynomialSpline({ knots, knots }, terms);
}

inline CriticalPoints Find(const Spline<2>& f, const CriticalPointParams& params = {})
{
  Result<CriticalPoints> found = FindCriticalPoints(f, params);
  EXPECT_TRUE(found) << found.Status.Message();
  return found.Value;
}

inline std::string Summary(const CriticalPoints& found)
{
  std::ostringstream text;
  text << found.NumMinima << " minima, " << found.NumMaxima << " maxima, " << found.NumSaddles
       << " saddles, " << found.Clusters.size() << " clusters of " << found.Boxes.size()
       << " boxes, index " << found.IndexSum << ", characteristic " << found.EulerCharacteristic
       << ", " << found.NumTested << " tested";
  return text.str();
}

/// The point of a kind next to parameters, or none.
inline const CriticalPoint* At(const CriticalPoints& found, double u, double v, double tolerance)
{
  for (const CriticalPoint& point : found.Points)
  {
    if (std::abs(point.Parameters[0] - u) <= tolerance &&
      std::abs(point.Parameters[1] - v) <= tolerance)
    {
      return &point;
    }
  }
  return nullptr;
}

inline void ExpectPoint(const CriticalPoints& found, double u, double v, CriticalKind kind,
  CriticalPlace place, int index, double tolerance = 1e-12)
{
  const CriticalPoint* point = At(found, u, v, tolerance);
  ASSERT_NE(point, nullptr) << "(" << u << ", " << v << ")";
  EXPECT_EQ(point->Kind, kind) << "(" << u << ", " << v << ")";
  EXPECT_EQ(point->Place, place) << "(" << u << ", " << v << ")";
  EXPECT_EQ(point->Index, index) << "(" << u << ", " << v << ")";
}
}
