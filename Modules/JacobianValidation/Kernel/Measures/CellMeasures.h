// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BernsteinCells.h>

namespace knotwork
{
struct CellMeasuresParams
{
  /// Of rational cells and of curves and surfaces in a space of more components: pieces of their
  /// sides, or of themselves, are halved until the estimated error is this part of the measure (or
  /// rounding of the integral over the sides, if that is more). In [1e-15, 1].
  double Tolerance = 1e-12;
  /// Halvings of a side at most, in [0, 60]; points at which a cell's integrand is evaluated before
  /// no piece is halved any more, >= 1: the effort, about a millisecond a cell of low degree. Where
  /// they are not enough, Converged is false and MeasureError says what was reached.
  int MaxDepth = 40;
  std::int64_t MaxPoints = 40000;
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
  /// Estimate of its error: what the rules leave, and rounding. Centroid times Measure errs by as
  /// much, relative to the cell's size.
  double MeasureError = 0.0;
  std::array<double, 3> Centroid{}; ///< of the signed measure; NaN when that is zero
  bool Converged = true;
  std::int64_t Points = 0; ///< at which the integrand was evaluated: what the measure cost
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

/// Measures and quality of cells. Of as many components as parameters, they are integrals over the
/// cells' sides (divergence theorem): exact but for rounding for polynomial cells, by Gauss rules
/// with an estimate of their error for rational ones. Curves and surfaces in a space of more
/// components are integrated themselves.
/// @return what BernsteinCells::Check says; EmptyInput; DimensionMismatch for cells of different
/// dimension or fewer components than parameters or more than 3; InvalidParameter; SizeMismatch.
/// @complexity (points of the rule) x (degree) a side of a polynomial cell, about MaxPoints x
/// (degree) at most of others.
Result<CellMeasures> MeasureCells(
  const BernsteinCells& cells, const CellMeasuresParams& params = {});
}
