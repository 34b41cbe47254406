// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/TensorSpace.h>

#include <algorithm>
#include <random>
#include <vector>

/// Slow, plain definitions in extended precision, independent of the kernel's algorithms: what
/// fast code is compared with. And seeded random input.
namespace oracle
{
using Real = long double;

inline constexpr double Epsilon = 2.220446049250313e-16;

/// Knot span of a parameter by linear search: right-continuous, the domain's end belongs to the
/// last span.
inline int FindSpan(int degree, const std::vector<double>& t, double u)
{
  int span = -1;
  for (int k = degree; k + degree + 1 < static_cast<int>(t.size()); ++k)
  {
    if (t[k] < t[k + 1] && (span < 0 || t[k] <= u))
    {
      span = k;
    }
  }
  return span;
}

/// Cox-de Boor recursion: function i of degree p, where only the span's step function is 1.
inline Real Basis(int i, int p, const std::vector<double>& t, int span, Real u)
{
  if (p == 0)
  {
    return i == span ? 1 : 0;
  }
  Real value = 0;
  if (t[i + p] > t[i])
  {
    value += (u - t[i]) / (static_cast<Real>(t[i + p]) - t[i]) * Basis(i, p - 1, t, span, u);
  }
  if (t[i + p + 1] > t[i + 1])
  {
    value += (t[i + p + 1] - u) / (static_cast<Real>(t[i + p + 1]) - t[i + 1]) *
      Basis(i + 1, p - 1, t, span, u);
  }
  return value;
}

/// k-th derivative of function i by the difference formula.
inline Real BasisDerivative(int i, int p, const std::vector<double>& t, int span, Real u, int k)
{
  if (k == 0)
  {
    return Basis(i, p, t, span, u);
  }
  if (p == 0)
  {
    return 0;
  }
  Real value = 0;
  if (t[i + p] > t[i])
  {
    value +=
      p / (static_cast<Real>(t[i + p]) - t[i]) * BasisDerivative(i, p - 1, t, span, u, k - 1);
  }
  if (t[i + p + 1] > t[i + 1])
  {
    value -= p / (static_cast<Real>(t[i + p + 1]) - t[i + 1]) *
      BasisDerivative(i + 1, p - 1, t, span, u, k - 1);
  }
  return value;
}

/// Bernstein polynomial by its definition.
inline Real Bernstein(int p, int i, Real t)
{
  Real value = 1;
  for (int k = 1; k <= i; ++k)
  {
    value = value * (p - i + k) / k;
  }
  for (int k = 0; k < p; ++k)
  {
    value *= k < i ? t : 1 - t;
  }
  return value;
}

/// Point of a tensor-product spline from its definition.
template <int Dim>
std::vector<double> Evaluate(const knotwork::Spline<Dim>& spline, const std::array<double, Dim>& u)
{
  std::array<std::vector<Real>, Dim> values;
  std::array<int, Dim> first;
  std::array<int, Dim> index{};
  for (int d = 0; d < Dim; ++d)
  {
    const auto& knots = spline.Space->Knots[d];
    const int p = knots.Degree();
    const int span = FindSpan(p, knots.Knots(), u[d]);
    first[d] = span - p;
    for (int i = span - p; i <= span; ++i)
    {
      values[d].push_back(Basis(i, p, knots.Knots(), span, u[d]));
    }
  }
  std::vector<Real> sum(spline.ControlPoints.cols());
  Real weights = 0;
  for (bool more = true; more;)
  {
    Real value = 1;
    int id = 0;
    int stride = 1;
    for (int d = 0; d < Dim; ++d)
    {
      value *= values[d][index[d]];
      id += stride * (first[d] + index[d]);
      stride *= spline.Space->Knots[d].NumFunctions();
    }
    value *= spline.IsRational() ? spline.Weights[id] : 1.0;
    weights += value;
    for (std::size_t c = 0; c < sum.size(); ++c)
    {
      sum[c] += value * spline.ControlPoints(id, c);
    }
    more = false;
    for (int d = 0; d < Dim && !more; ++d)
    {
      more = ++index[d] < static_cast<int>(values[d].size());
      index[d] = more ? index[d] : 0;
    }
  }
  std::vector<double> point;
  for (Real s : sum)
  {
    point.push_back(static_cast<double>(s / (spline.IsRational() ? weights : 1)));
  }
  return point;
}

/// Seeded numbers that are the same with every standard library.
class Random
{
public:
  explicit Random(unsigned seed) : Engine(seed) {}
  /// In [0, 1).
  double Unit() { return this->Engine() / 4294967296.0; }
  double In(double lower, double upper) { return lower + (upper - lower) * this->Unit(); }
  /// In [lower, upper].
  int Int(int lower, int upper)
  {
    return lower + static_cast<int>(this->Unit() * (upper - lower + 1));
  }

  /// Any degree unless given, 1..maxElements elements whose lengths differ by up to 100, any
  /// multiplicities, ends clamped or not.
  knotwork::KnotVector Knots(int maxElements, int degree = 0)
  {
    const int p = degree > 0 ? degree : this->Int(1, 9);
    const int elements = this->Int(1, maxElements);
    const bool clamped = this->Unit() < 0.4;
    std::vector<double> t;
    const auto add = [&t](double u, int copies) { t.insert(t.end(), copies, u); };
    const auto step = [this] { return std::pow(10.0, this->In(-2.0, 0.0)); };
    // before the domain: as many knots as its first break leaves over, and sometimes one more
    double u = this->In(-5.0, 5.0);
    const int firstCopies = clamped ? p + 1 : this->Int(1, p + 1);
    for (int before = p + 1 - firstCopies; before > 0;)
    {
      const int copies = this->Int(1, before);
      add(u, copies);
      before -= copies;
      u += step();
    }
    add(u, firstCopies);
    for (int e = 1; e < elements; ++e)
    {
      u += step();
      add(u, this->Unit() < 0.5 ? 1 : this->Int(1, p + 1));
    }
    u += step();
    const int lastCopies = clamped ? p + 1 : this->Int(1, p + 1);
    add(u, lastCopies);
    for (int after = p + 1 - lastCopies; after > 0;)
    {
      u += step();
      const int copies = this->Int(1, after);
      add(u, copies);
      after -= copies;
    }
    return knotwork::KnotVector::Create(p, t).Value;
  }

  /// A spline with coordinates in [-1, 1] and weights in [1/2, 2].
  template <int Dim>
  knotwork::Spline<Dim> Spline(
    const std::array<knotwork::KnotVector, Dim>& knots, int components, bool rational)
  {
    knotwork::Spline<Dim> spline;
    spline.Space = knotwork::MakeTensorSpace<Dim>(knots).Value;
    spline.ControlPoints.resize(spline.Space->NumFunctions, components);
    for (Eigen::Index i = 0; i < spline.ControlPoints.size(); ++i)
    {
      spline.ControlPoints.data()[i] = this->In(-1.0, 1.0);
    }
    spline.Weights.resize(rational ? spline.Space->NumFunctions : 0);
    for (double& w : spline.Weights)
    {
      w = this->In(0.5, 2.0);
    }
    return spline;
  }

  /// A parameter of the domain: inside, a break, or an end.
  double Parameter(const knotwork::KnotVector& knots)
  {
    return this->Unit() < 0.3 ? knots.Breaks()[this->Int(0, knots.NumElements())]
                              : this->In(knots.Begin(), knots.End());
  }

private:
  std::mt19937 Engine;
};
}
