// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "BernsteinCells.h"

namespace knotwork
{
struct CellMeasuresParams
{
  /// Of rational cells and of curves and surfaces in a space of more components: subdivision goes
  /// on until two Gauss rules agree within this part of the integral of |det J|. In [1e-15, 1].
  double Tolerance = 1e-12;
  /// Halvings of a cell at most, in [0, 60]. Where that is not enough, Converged is false.
  int MaxDepth = 40;
  /// Quality is sampled at the points of a uniform lattice with so many points along every edge,
  /// edges and corners included, in [2, 64].
  int SamplesPerEdge = 5;
  /// Sub-cells a cell for the proven bound of the scaled Jacobian, in [1, 65536]; it stops earlier
  /// when the bound is within 0.01 of the least sample. 0: no bound (-1 is reported).
  int BoundBoxes = 64;
  /// Volume of the cell's box in the parameter domain of its patch, > 0; empty: 1 each. Only det J
  /// over area knows of it.
  std::vector<double> ParametricVolumes;
  int Threads = 0; ///< 0 = all cores; the result does not depend on it
};

/// Measures of one cell, or of all. J is the derivative with respect to the local parameters;
/// det J stands for |C_u|, |S_u x S_v| when there are more components than parameters.
struct CellMeasure
{
  double Measure = 0.0; ///< signed length, area or volume
  double MeasureError =
    0.0; ///< estimate of its error: rounding of exact rules, agreement of others
  std::array<double, 3> Centroid{}; ///< of the signed measure; NaN when that is zero
  bool Converged = true;
  /// Scaled Jacobian det J / (|f_u| |f_v| (|f_w|)), in [-1, 1]; 0 where a derivative vanishes.
  double ScaledMin = 0.0;
  double ScaledMax = 0.0;
  double ScaledMean = 0.0;
  /// Proved: nowhere in the cell is it smaller (where defined). -1 is always true.
  double ScaledLower = -1.0;
  /// |J|_F |J^-1|_F / d >= 1; infinite where det J is zero.
  double ConditionMax = 0.0;
  double ConditionMean = 0.0;
  /// det J with respect to the patch's parameters, over the mean of that over all cells (for one
  /// patch on the unit square: det J / area). 1 everywhere for an affine map.
  double UniformityMin = 0.0;
  double UniformityMax = 0.0;
};

struct CellMeasures
{
  std::vector<CellMeasure> Cells;
  CellMeasure Total; ///< Measure: the sum; Centroid: of all; means over all samples
};

/// Exact measures and quality of cells. Polynomial cells of as many components as parameters are
/// integrated by Gauss rules of their exact degree; the others adaptively.
/// @return what BernsteinCells::Check says; EmptyInput; DimensionMismatch for cells of different
/// dimension or fewer components than parameters or more than 3; InvalidParameter; SizeMismatch.
/// @complexity (points of the rule) x (coefficients) a polynomial cell.
Result<CellMeasures> MeasureCells(
  const BernsteinCells& cells, const CellMeasuresParams& params = {});
}
