// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FitPoints.h"
#include <knotwork/SplineCore/BernsteinBasis.h>

#include <algorithm>

namespace knotwork
{
inline constexpr int Lanes = 8;
/// A number of each of eight points.
typedef double Eight __attribute__((vector_size(Lanes * sizeof(double))));

/// Bernstein polynomials of both directions of an element at up to eight of its points; the last
/// point fills the lanes that are left. Degrees are constants of the compiler or ints.
/// @param count  in [1, Lanes]. @param u, v  MaxDegree + 1.
template <typename DegreeU, typename DegreeV>
inline void BasisAtPoints(const DegreeU p, const DegreeV q, const ParametricBox<2>& box,
  const FitPoints& points, std::size_t first, int count, Eight* u, Eight* v)
{
  const double scale[2] = { 1.0 / (box.Upper[0] - box.Lower[0]),
    1.0 / (box.Upper[1] - box.Lower[1]) };
  Eight s{};
  Eight t{};
  for (int i = 0; i < Lanes; ++i)
  {
    const std::size_t k = first + static_cast<std::size_t>(std::min(i, count - 1));
    s[i] = (points.U[k] - box.Lower[0]) * scale[0];
    t[i] = (points.V[k] - box.Lower[1]) * scale[1];
  }
  BernsteinBasis<0>(p, s, Eight{}, u, 0);
  BernsteinBasis<0>(q, t, Eight{}, v, 0);
}
}
