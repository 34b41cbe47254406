// SPDX-License-Identifier: BSD-3-Clause
#include "InnerCollapse.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
/// Whether the control points of an edge, from a corner along a direction, coincide.
bool IsOnePoint(const BernsteinCells& cells, double tolerance, int cell, int corner, int along)
{
  const std::size_t at = static_cast<std::size_t>(cell);
  const CellDegree& degree = cells.Degrees[at];
  const int n = NumCellCoefficients(cells.Shapes[at], degree);
  const double* data = cells.Block(cell);
  const int components = cells.NumComponents;
  const auto value = [&](int i, int d)
  { return data[d * n + i] / (cells.Rational ? data[components * n + i] : 1.0); };
  std::array<int, 3> place{};
  for (std::size_t d = 0; d < 3; ++d)
  {
    place[d] = (corner >> d & 1) * degree[d];
  }
  double largest = 0.0;
  for (int i = 0; i < n; ++i)
  {
    for (int d = 0; d < components; ++d)
    {
      largest = std::max(largest, std::abs(value(i, d)));
    }
  }
  const auto coefficient = [&]
  { return CellCoefficient(cells.Shapes[at], degree, place[0], place[1], place[2]); };
  const int first = coefficient();
  for (int i = 1; i <= degree[static_cast<std::size_t>(along)]; ++i)
  {
    place[static_cast<std::size_t>(along)] = i;
    for (int d = 0; d < components; ++d)
    {
      if (!(std::abs(value(coefficient(), d) - value(first, d)) <= tolerance * largest))
      {
        return false;
      }
    }
  }
  return true;
}

/// Whether the boxes of a patch leave nothing out around the middle of an edge.
bool IsInsidePatch(
  const BernsteinCells& cells, const CellComplex& complex, int cell, int corner, int along)
{
  const std::size_t at = static_cast<std::size_t>(cell);
  const std::size_t dim = static_cast<std::size_t>(NumParameters(cells.Shapes[at]));
  const ParametricBox<3>& own = complex.Boxes[at];
  std::array<double, 3> middle{};
  for (std::size_t d = 0; d < dim; ++d)
  {
    middle[d] = static_cast<int>(d) == along ? 0.5 * (own.Lower[d] + own.Upper[d])
      : (corner >> d & 1) != 0               ? own.Upper[d]
                                             : own.Lower[d];
  }
  double covered = 0.0; // share of a small box around it
  for (std::size_t c = 0; c < complex.Boxes.size(); ++c)
  {
    const ParametricBox<3>& box = complex.Boxes[c];
    double share = complex.Patches.empty()
      ? (c == at ? 1.0 : 0.0)
      : (complex.Patches[c] == complex.Patches[at] ? 1.0 : 0.0);
    for (std::size_t d = 0; d < dim && share > 0.0; ++d)
    {
      const bool isIn = box.Lower[d] <= middle[d] && middle[d] <= box.Upper[d];
      const bool isEnd = middle[d] == box.Lower[d] || middle[d] == box.Upper[d];
      share *= !isIn || box.Lower[d] == box.Upper[d] ? 0.0 : isEnd ? 0.5 : 1.0;
    }
    covered += share;
  }
  return covered == 1.0;
}
}

std::array<int, 3> FindInnerCollapse(const BernsteinCells& cells, const CellComplex& complex,
  const JacobianCertificate& certificate, double tolerance)
{
  for (int c = 0; c < cells.NumCells(); ++c)
  {
    const std::size_t at = static_cast<std::size_t>(c);
    const CellShape shape = cells.Shapes[at];
    const bool isBox = shape == CellShape::Quadrilateral || shape == CellShape::Hexahedron;
    if (!isBox || complex.Boxes.empty() || certificate.Cells[at].Degenerate == 0)
    {
      continue;
    }
    const int dim = NumParameters(shape);
    for (int along = 0; along < dim; ++along)
    {
      for (int corner = 0; corner < (1 << dim); ++corner)
      {
        if ((corner >> along & 1) == 0 && IsOnePoint(cells, tolerance, c, corner, along) &&
          IsInsidePatch(cells, complex, c, corner, along))
        {
          return std::array<int, 3>{ c, corner, corner | 1 << along };
        }
      }
    }
  }
  return std::array<int, 3>{ -1, -1, -1 };
}
}
