// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ContourCells.h"
#include "ElementSides.h"

/// Private to TraceContours: where contours cross the sides of elements, found once for both
/// neighbours.
namespace knotwork
{
/// A level as it is traced: {value >= Value} is the upper set.
struct ShiftedLevel
{
  double Value = 0.0;
  double Shift = 0.0; ///< below the level that was asked for
};

struct SideRoots
{
  std::vector<std::size_t> Start; ///< of a piece: [Start[p], Start[p + 1]), by level, then by place
  std::vector<int> Levels;
  std::vector<double> Places;       ///< in [0, 1] from the piece's begin to its end
  std::vector<double> VertexValues; ///< of the component

  /// Crossings and sign of a side of an element at a level.
  void Collect(const ElementSides& sides, int element, int side, int level, double value,
    BorderSide& border) const;
};

/// Smallest and largest ratio of coefficients of a component to weights: bounds of its values.
/// @param weights  nullptr: polynomial.
std::array<double, 2> CoefficientRange(std::size_t n, const double* values, const double* weights);

SideRoots FindSideRoots(const BezierForm<2>& form, int component, const ElementSides& sides,
  const std::vector<ShiftedLevel>& levels, int threads);
}
