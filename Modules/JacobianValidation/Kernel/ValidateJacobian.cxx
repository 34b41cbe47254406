// SPDX-License-Identifier: BSD-3-Clause
#include "JacobianCertificate.h"

namespace knotwork
{
BernsteinCells PlanarCells(const BernsteinCells& cells)
{
  if (cells.NumComponents != 3)
  {
    return cells;
  }
  BernsteinCells planar;
  planar.NumComponents = 2;
  planar.Rational = cells.Rational;
  planar.Errors = cells.Errors;
  planar.Data.reserve(cells.Data.size());
  for (int c = 0; c < cells.NumCells(); ++c)
  {
    const std::size_t at = static_cast<std::size_t>(c);
    const int n = NumCellCoefficients(cells.Shapes[at], cells.Degrees[at]);
    const double* z = cells.Block(c) + 2 * n;
    const double* w = cells.Rational ? z + n : nullptr;
    // the Euclidean z of homogeneous doubles is exactly constant only when it is zero or the
    // weights agree
    for (int i = 0; i < n; ++i)
    {
      if (z[i] != z[0] || (w && z[0] != 0.0 && w[i] != w[0]))
      {
        return cells;
      }
    }
    const int to = planar.Add(cells.Shapes[at], cells.Degrees[at]);
    std::copy(cells.Block(c), cells.Block(c) + 2 * n, planar.Block(to));
    if (w)
    {
      std::copy(w, w + n, planar.Block(to) + 2 * n);
    }
  }
  return planar;
}
}
