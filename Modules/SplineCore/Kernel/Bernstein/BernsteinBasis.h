// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Types.h>

namespace knotwork
{
/// Bernstein polynomials of one direction with their derivatives, for the inner loops of
/// evaluation: with a degree known at compile time (std::integral_constant) straight code. Rows of
/// length degree + 1 at values, values + stride, ...: the polynomials, then (as far as Order) their
/// first and second derivatives times scale and scale^2.
/// @tparam Real  double, or a vector of doubles with a point a lane.
/// @param scale  d(local) / d(parameter) of the direction, so rows are derivatives with respect to
/// the domain's parameter.
template <int Order, typename Degree, typename Real>
inline void BernsteinBasis(
  const Degree degree, const Real& t, const Real& scale, Real* values, int stride)
{
  const Real s = 1.0 - t;
  const Real zero{};
  // B^q from B^{q-1} in place; the differences of B^{p-1} and B^{p-2} are the derivatives.
  values[0] = zero + 1.0;
  for (int q = 1; q <= degree; ++q)
  {
    if constexpr (Order >= 2)
    {
      if (q == degree - 1)
      {
        const Real f = static_cast<double>(degree * (degree - 1)) * scale * scale;
        Real* second = values + 2 * stride;
        for (int i = 0; i <= degree; ++i)
        {
          const Real right = i < q ? values[i] : zero;
          const Real middle = i >= 1 && i - 1 < q ? values[i - 1] : zero;
          const Real left = i >= 2 ? values[i - 2] : zero;
          second[i] = f * (left - 2.0 * middle + right);
        }
      }
    }
    if constexpr (Order >= 1)
    {
      if (q == degree)
      {
        const Real f = static_cast<double>(degree) * scale;
        Real* first = values + stride;
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
        values[2 * stride + i] = zero;
      }
    }
  }
}
}
