// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ValidatedGrids.h"
#include <knotwork/JacobianValidation/CellMeasures.h>

#include <cmath>

/// Measures of cells, and of their quality among the others.
namespace knotwork
{
/// Cells whose det J is compared with the mean over all of them: those of a plane's map, volumes,
/// and surfaces and curves in space.
struct MeasuredCells
{
  int Parameters = 0;
  int Components = 3;
  double Height = 0.0;  ///< of a plane
  double Measure = 0.0; ///< sums
  double ParametricVolume = 0.0;

  bool IsLike(const MeasuredCells& other) const
  {
    constexpr double tolerance = 1e-12; // planes are told apart by rounding alone
    return this->Parameters == other.Parameters && this->Components == other.Components &&
      std::abs(this->Height - other.Height) <= tolerance * std::abs(this->Height);
  }
};

/// Of all cells, and in which lists they are compared.
struct Measurement
{
  std::vector<CellMeasure> Cells;
  std::vector<MeasuredCells> Lists;
  std::vector<std::vector<int>> CellsOfLists;

  /// Of pieces: det J over the mean of the cells of all of them.
  /// @pre all processes call it.
  void CompareWithAll();
};

/// @param params  without the cells' volumes in their domains: the cell array ParametricBounds of
/// the grids has them.
/// @return failures of MeasureCells.
Result<Measurement> MeasureGrids(const BernsteinCells& cells, const CellMaps& maps,
  const std::vector<GridPair>& grids, CellMeasuresParams params);
}
