// SPDX-License-Identifier: BSD-3-Clause
#include "PatchForm.h"

#include <knotwork/SplineCore/Bernstein.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
constexpr int NumPlanes = PatchForm::NumPlanes;
}

PatchForm MakePatchForm(const BernsteinCells& cells, int cell, CellShape shape,
  const CellDegree& degree, const std::vector<int>& coefficients,
  const std::array<double, 3>& origin)
{
  const double* block = cells.Block(cell);
  const std::size_t at = static_cast<std::size_t>(cell);
  const int size = NumCellCoefficients(cells.Shapes[at], cells.Degrees[at]);
  const int numComponents = cells.NumComponents;
  PatchForm form;
  const int p = degree[0];
  form.Degree = shape == CellShape::Curve ? std::array<int, 2>{ 0, p }
    : shape == CellShape::Quadrilateral   ? std::array<int, 2>{ p, degree[1] }
                                          : std::array<int, 2>{ p, p };
  const int n = form.Size();
  form.Data.assign(static_cast<std::size_t>(NumPlanes * n), 0.0);
  for (int plane = 0; plane < NumPlanes; ++plane)
  {
    const auto value = [&](int index)
    {
      const int i = coefficients[static_cast<std::size_t>(index)];
      const double w = cells.Rational ? block[numComponents * size + i] : 1.0;
      if (plane == 3)
      {
        return w;
      }
      return plane < numComponents
        ? block[plane * size + i] - origin[static_cast<std::size_t>(plane)] * w
        : 0.0;
    };
    double* to = form.Data.data() + plane * n;
    if (shape != CellShape::Triangle)
    {
      for (int i = 0; i < n; ++i)
      {
        to[i] = value(i);
      }
      continue;
    }
    for (int i = 0; i <= p; ++i)
    {
      // for this i a polynomial of degree p - i in t
      double row[MaxDegree + 1];
      for (int j = 0; j <= p - i; ++j)
      {
        row[j] = value(CellCoefficient(shape, degree, i, j, 0));
      }
      for (int q = p - i + 1; q <= p; ++q)
      {
        row[q] = row[q - 1];
        for (int j = q - 1; j > 0; --j)
        {
          row[j] = (j * row[j - 1] + (q - j) * row[j]) / q;
        }
      }
      for (int j = 0; j <= p; ++j)
      {
        to[j * (p + 1) + i] = row[j];
      }
    }
  }
  return form;
}

int BalanceWeights(PatchForm& form)
{
  const int p = form.Degree[0];
  const int q = form.Degree[1];
  const int n = form.Size();
  const double* w = form.Data.data() + 3 * n;
  double slope[2] = { 0.0, 0.0 };
  double norm[2] = { 0.0, 0.0 };
  for (int j = 0; j <= q; ++j)
  {
    for (int i = 0; i <= p; ++i)
    {
      const double size = std::log2(w[j * (p + 1) + i]);
      const double at[2] = { i - 0.5 * p, j - 0.5 * q };
      for (int d = 0; d < 2; ++d)
      {
        slope[d] += at[d] * size;
        norm[d] += at[d] * at[d];
      }
    }
  }
  const int a = norm[0] > 0.0 ? -static_cast<int>(std::lround(slope[0] / norm[0])) : 0;
  const int b = norm[1] > 0.0 ? -static_cast<int>(std::lround(slope[1] / norm[1])) : 0;
  int largest = std::numeric_limits<int>::min();
  int least = std::numeric_limits<int>::max();
  for (int j = 0; j <= q; ++j)
  {
    for (int i = 0; i <= p; ++i)
    {
      const int exponent = std::ilogb(w[j * (p + 1) + i]) + a * i + b * j;
      largest = std::max(largest, exponent);
      least = std::min(least, exponent);
    }
  }
  for (int j = 0; j <= q; ++j)
  {
    for (int i = 0; i <= p; ++i)
    {
      const double factor = std::ldexp(1.0, a * i + b * j - largest);
      for (int plane = 0; plane < NumPlanes; ++plane)
      {
        form.Data[static_cast<std::size_t>(plane * n + j * (p + 1) + i)] *= factor;
      }
    }
  }
  return largest - least;
}

PatchForm CutOffHalf(PatchForm& form, int direction)
{
  PatchForm first = form;
  const int p = form.Degree[0];
  const int q = form.Degree[1];
  const int n = form.Size();
  const int degree = direction == 0 ? p : q;
  const int step = direction == 0 ? 1 : p + 1;
  const int lines = direction == 0 ? q + 1 : p + 1;
  for (int line = 0; line < lines * NumPlanes; ++line)
  {
    const int start = (line / lines) * n + (line % lines) * (direction == 0 ? p + 1 : 1);
    HalveBernstein(degree, form.Data.data() + start, first.Data.data() + start, step);
  }
  return first;
}
}
