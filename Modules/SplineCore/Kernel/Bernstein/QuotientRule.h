// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace knotwork
{
/// Number of terms of a value with its derivatives up to an order: value, Dim first derivatives,
/// then the second ones (pairs 00, 01, 11 / 00, 01, 02, 11, 12, 22).
constexpr int NumDerivativeTerms(int dim, int order)
{
  return 1 + (order >= 1 ? dim : 0) + (order >= 2 ? dim * (dim + 1) / 2 : 0);
}

/// Turns the terms of w x into those of x, given those of w: R = A / W, R_d = (A_d - R W_d) / W,
/// R_de = (A_de - R_d W_e - R_e W_d - R W_de) / W.
/// @param w  terms of the denominator, w[0] != 0. @param a  terms of the numerator, overwritten.
/// @source  The NURBS Book, 2nd edition, eqs. (4.8), (4.20).
/// @tparam Real  double, or a vector of doubles with a point a lane.
template <int Dim, typename Real>
inline void DivideTerms(int order, const Real* w, Real* a)
{
  const Real inverse = 1.0 / w[0];
  a[0] *= inverse;
  if (order >= 1)
  {
    for (int d = 1; d <= Dim; ++d)
    {
      a[d] = (a[d] - a[0] * w[d]) * inverse;
    }
  }
  if (order >= 2)
  {
    int k = 1 + Dim;
    for (int d = 1; d <= Dim; ++d)
    {
      for (int e = d; e <= Dim; ++e, ++k)
      {
        a[k] = (a[k] - a[d] * w[e] - a[e] * w[d] - a[0] * w[k]) * inverse;
      }
    }
  }
}
}
