// SPDX-License-Identifier: BSD-3-Clause
// Random LR B-splines and their plain definition in extended precision.
#pragma once
#include "RandomSplines.h"
#include <knotwork/SplineCore/LRRefinement.h>

#include <gtest/gtest.h>

#include <cmath>

namespace knotwork::testing
{
using oracle::Real;

/// Value of B[t] by the recursion; the last span with a length holds the end of the domain.
inline Real LocalBSpline(const std::vector<double>& t, double x, double domainEnd)
{
  const int p = static_cast<int>(t.size()) - 2;
  int span = -1;
  for (int k = 0; k <= p; ++k)
  {
    if (t[k] < t[k + 1] && t[k] <= x && (x < t[k + 1] || (x == t[k + 1] && x == domainEnd)))
    {
      span = k;
    }
  }
  return span < 0 ? 0 : oracle::Basis(0, p, t, span, x);
}

inline std::vector<double> LocalKnotValues(const LRBasis& basis, int f, int d)
{
  std::vector<double> t;
  for (int i = 0; i < basis.Degree[d] + 2; ++i)
  {
    t.push_back(basis.Knots[d][basis.Local(f, d)[i]]);
  }
  return t;
}

/// Values gamma_i B_i(u, v) of all functions.
inline std::vector<Real> LRFunctions(const LRBasis& basis, double u, double v)
{
  std::vector<Real> values;
  for (int f = 0; f < basis.NumFunctions(); ++f)
  {
    const Real a = LocalBSpline(LocalKnotValues(basis, f, 0), u, basis.Knots[0].back());
    const Real b = LocalBSpline(LocalKnotValues(basis, f, 1), v, basis.Knots[1].back());
    values.push_back(basis.Scaling[f] * a * b);
  }
  return values;
}

inline std::vector<double> LREvaluate(const Spline<2>& spline, double u, double v)
{
  const std::vector<Real> values = LRFunctions(spline.Space->LocallyRefined->Basis, u, v);
  const PointMatrix points = spline.HomogeneousPoints();
  std::vector<double> result;
  for (int c = 0; c < spline.NumComponents(); ++c)
  {
    Real sum = 0;
    Real weight = 0;
    for (std::size_t f = 0; f < values.size(); ++f)
    {
      sum += values[f] * points(f, c);
      weight += spline.IsRational() ? values[f] * spline.Weights[f] : values[f];
    }
    result.push_back(static_cast<double>(spline.IsRational() ? sum / weight : sum));
  }
  return result;
}

/// A clamped tensor-product spline, degrees in [1, maxDegree].
inline Spline<2> RandomClampedSurface(
  Random& random, int maxDegree, int maxElements, int components, bool rational)
{
  std::array<KnotVector, 2> knots;
  for (KnotVector& k : knots)
  {
    const int degree = random.Int(1, maxDegree);
    k = MildKnots(random, degree, random.Int(1, maxElements), random.Int(1, degree), true);
  }
  return RandomSpline<2>(random, MakeTensorSpace<2>(knots).Value, components, rational);
}

/// A segment across the supports of one or two functions on a random element: through the middle of
/// the element, elsewhere in it, or along one of its lower sides with a higher multiplicity.
inline LRSegment RandomSegment(Random& random, const SplineSpace<2>& space)
{
  const LRData& data = *space.LocallyRefined;
  const int e = random.Int(0, space.NumElements() - 1);
  const ParametricBox<2>& box = space.Elements[e].Box;
  LRSegment segment;
  segment.Direction = random.Int(0, 1);
  const int d = segment.Direction;
  const double where = random.Unit() < 0.7 ? 0.5 : random.In(0.1, 0.9);
  segment.Value = box.Lower[d] + where * (box.Upper[d] - box.Lower[d]);
  if (random.Unit() < 0.2 && box.Lower[d] > space.Domain().Lower[d])
  {
    segment.Value = box.Lower[d];
    segment.Multiplicity = random.Int(1, data.Basis.Degree[d] + 1);
  }
  else if (random.Unit() < 0.2)
  {
    segment.Multiplicity = random.Int(1, data.Basis.Degree[d] + 1);
  }
  const auto first = static_cast<int>(data.AliveStart[e]);
  const auto last = static_cast<int>(data.AliveStart[e + 1]) - 1;
  segment.Start = box.Lower[1 - d];
  segment.End = box.Upper[1 - d];
  for (int k = random.Int(1, 2); k > 0; --k)
  {
    const std::vector<double> t =
      LocalKnotValues(data.Basis, data.AliveFunctions[random.Int(first, last)], 1 - d);
    segment.Start = std::min(segment.Start, t.front());
    segment.End = std::max(segment.End, t.back());
  }
  return segment;
}

/// Segments that can be inserted one after the other, at most count.
inline std::vector<LRSegment> RandomSegments(Random& random, SplineSpacePtr<2> space, int count)
{
  space = InsertSegments(space, {}, 0).Value;
  std::vector<LRSegment> segments;
  for (int i = 0; i < count; ++i)
  {
    const LRSegment segment = RandomSegment(random, *space);
    const auto next = InsertSegments(space, { segment }, 0);
    if (next)
    {
      segments.push_back(segment);
      space = next.Value;
      continue;
    }
    // refused by the rules of insertion, not by a check of what came out
    EXPECT_EQ(next.Status.Detail.find("segment 0"), 0u) << next.Status.Message();
  }
  return segments;
}

/// Random parameters; one in three coordinates is a knot.
inline PointMatrix RandomParameters(Random& random, const SplineSpace<2>& space, int n)
{
  PointMatrix points(n, 2);
  for (Eigen::Index i = 0; i < points.size(); ++i)
  {
    points.data()[i] = random.Parameter(space.Knots[i % 2]);
  }
  return points;
}

inline std::vector<LRSegment> KnownSegments()
{
  return { { 1, 3, 3, 9 }, { 0, 7, 2, 6 }, { 0, 5, 2, 7 }, { 1, 5, 1, 7 }, { 0, 4, 1, 5 } };
}

/// Biquadratic functions with one relation among 82: five segments on a tensor-product mesh.
inline Spline<2> DependentSurface(bool rational = false)
{
  const auto knots = [](std::vector<double> inner, double end)
  {
    std::vector<double> t{ 0, 0, 0 };
    t.insert(t.end(), inner.begin(), inner.end());
    t.insert(t.end(), 3, end);
    return KnotVector::Create(2, t).Value;
  };
  Random random(9);
  const auto tensor =
    MakeTensorSpace<2>({ knots({ 1, 2, 3, 6, 8, 9 }, 10), knots({ 1, 2, 4, 6, 7 }, 8) }).Value;
  const auto surface =
    InsertSegments(RandomSpline(random, tensor, 3, rational), KnownSegments(), 0);
  EXPECT_TRUE(surface) << surface.Status.Message();
  EXPECT_EQ(surface->Space->NumFunctions, 82);
  return surface.Value;
}
}
