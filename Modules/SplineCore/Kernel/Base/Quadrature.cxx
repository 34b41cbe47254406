// SPDX-License-Identifier: BSD-3-Clause
#include "Quadrature.h"

#include <cmath>

namespace knotwork
{
QuadratureRule GaussLegendre(int numPoints)
{
  // extended precision where the platform has it: then the rounded nodes and weights are accurate
  // to the last bit or so
  using Real = long double;
  const int n = numPoints;
  const Real pi = 3.14159265358979323846264338327950288L;
  QuadratureRule rule;
  rule.Nodes.resize(static_cast<std::size_t>(n));
  rule.Weights.resize(static_cast<std::size_t>(n));
  for (int i = 0; i < (n + 1) / 2; ++i)
  {
    Real x = std::cos(pi * (static_cast<Real>(i) + 0.75L) / (static_cast<Real>(n) + 0.5L));
    Real derivative = 1.0L;
    // from this start Newton's method has converged after four steps; six cost nothing
    for (int step = 0; step < 6; ++step)
    {
      Real p = 1.0L; // P_k
      Real q = 0.0L; // P_{k-1}
      for (int k = 0; k < n; ++k)
      {
        const Real next =
          (static_cast<Real>(2 * k + 1) * x * p - static_cast<Real>(k) * q) / (k + 1);
        q = p;
        p = next;
      }
      derivative = static_cast<Real>(n) * (x * p - q) / (x * x - 1.0L);
      x -= p / derivative;
    }
    if (2 * i + 1 == n)
    {
      x = 0.0L;
    }
    const Real weight = 1.0L / ((1.0L - x * x) * derivative * derivative);
    const std::size_t upper = static_cast<std::size_t>(n - 1 - i);
    const std::size_t lower = static_cast<std::size_t>(i);
    rule.Nodes[lower] = static_cast<double>(0.5L * (1.0L - x));
    rule.Nodes[upper] = static_cast<double>(0.5L * (1.0L + x));
    rule.Weights[lower] = rule.Weights[upper] = static_cast<double>(weight);
  }
  return rule;
}

template <int Dim>
ElementQuadrature<Dim> MakeElementQuadrature(const IntArray<Dim>& numPoints)
{
  std::array<QuadratureRule, Dim> rules;
  Eigen::Index count = 1;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    rules[d] = GaussLegendre(numPoints[d]);
    count *= numPoints[d];
  }
  ElementQuadrature<Dim> result;
  result.Local.resize(count, Dim);
  result.Weights.setOnes(count);
  for (Eigen::Index i = 0; i < count; ++i)
  {
    Eigen::Index rest = i;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const std::size_t k = static_cast<std::size_t>(rest % numPoints[d]);
      rest /= numPoints[d];
      result.Local(i, static_cast<Eigen::Index>(d)) = rules[d].Nodes[k];
      result.Weights[i] *= rules[d].Weights[k];
    }
  }
  return result;
}

template ElementQuadrature<1> MakeElementQuadrature<1>(const IntArray<1>&);
template ElementQuadrature<2> MakeElementQuadrature<2>(const IntArray<2>&);
template ElementQuadrature<3> MakeElementQuadrature<3>(const IntArray<3>&);
}
