// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <vector>

/// Private to this module: products of bivariate Bernstein polynomials.
namespace knotwork
{
/// A bivariate polynomial of degree (P, Q): coefficients times their binomials, or, of a triangle
/// with P = Q, times its multinomials and zero for i + j > P, so that products are sums of
/// products.
struct ScaledPolynomial
{
  int P = 0;
  int Q = 0;
  std::vector<double> C;

  ScaledPolynomial(int p, int q) : P(p), Q(q), C(static_cast<std::size_t>((p + 1) * (q + 1)), 0.0)
  {
  }
  double* Row(int j) { return this->C.data() + j * (this->P + 1); }
  const double* Row(int j) const { return this->C.data() + j * (this->P + 1); }
};

/// to += sign a b.
inline void AddProduct(
  ScaledPolynomial& to, double sign, const ScaledPolynomial& a, const ScaledPolynomial& b)
{
  for (int j = 0; j <= a.Q; ++j)
  {
    for (int l = 0; l <= b.Q; ++l)
    {
      double* row = to.Row(j + l);
      for (int i = 0; i <= a.P; ++i)
      {
        const double x = sign * a.Row(j)[i];
        for (int k = 0; k <= b.P; ++k)
        {
          row[i + k] += x * b.Row(l)[k];
        }
      }
    }
  }
}
}
