// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "Types.h"

namespace knotwork
{
/// Bernstein polynomials of one direction with their derivatives, for the inner loops of
/// evaluation: with a degree known at compile time (std::integral_constant) straight code. Rows of
/// length degree + 1 at values, values + stride, ...: the polynomials, then (as far as Order) their
/// first and second derivatives times scale and scale^2.
/// @param scale  d(local) / d(parameter) of the direction, so rows are derivatives with respect to
/// the domain's parameter.
template <int Order, typename Degree>
inline void BernsteinBasis(const Degree degree, double t, double scale, double* values, int stride)
{
  const double s = 1.0 - t;
  // B^q from B^{q-1} in place; the differences of B^{p-1} and B^{p-2} are the derivatives.
  values[0] = 1.0;
  for (int q = 1; q <= degree; ++q)
  {
    if constexpr (Order >= 2)
    {
      if (q == degree - 1)
      {
        const double f = degree * (degree - 1) * scale * scale;
        double* second = values + 2 * stride;
        for (int i = 0; i <= degree; ++i)
        {
          const double right = i < q ? values[i] : 0.0;
          const double middle = i >= 1 && i - 1 < q ? values[i - 1] : 0.0;
          const double left = i >= 2 ? values[i - 2] : 0.0;
          second[i] = f * (left - 2.0 * middle + right);
        }
      }
    }
    if constexpr (Order >= 1)
    {
      if (q == degree)
      {
        const double f = degree * scale;
        double* first = values + stride;
        first[0] = -f * values[0];
        for (int i = 1; i < degree; ++i)
        {
          first[i] = f * (values[i - 1] - values[i]);
        }
        first[degree] = f * values[degree - 1];
      }
    }
    values[q] = t * values[q - 1];
    for (int i = q - 1; i > 0; --i)
    {
      values[i] = s * values[i] + t * values[i - 1];
    }
    values[0] *= s;
  }
  if constexpr (Order >= 2)
  {
    if (degree < 2)
    {
      for (int i = 0; i <= degree; ++i)
      {
        values[2 * stride + i] = 0.0;
      }
    }
  }
}
}
