// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "BoxSearch.h"
#include "ProofCell.h"
#include "ValueRange.h"

/// Private to the proof of cells: the polynomial whose sign is the Jacobian's.
namespace knotwork
{
/// The numerator of det J, or the square of that of |S_u x S_v| or |C_u|.
struct CellNumerator
{
  std::vector<double> Values; ///< unscaled coefficients
  const FormLayout* Layout = nullptr;
  double Error = 0.0;                     ///< of each of Values
  ValueRange Range;                       ///< of Values
  int Power = 0;                          ///< of the weight function below it
  std::shared_ptr<const ExactForm> Exact; ///< null: Values were computed in doubles
  BoxProblem Problem;                     ///< of the sign
  std::uint8_t Factored = 0;              ///< slots that Problem is divided by
  std::uint8_t Degenerate = 0;            ///< DegeneratePlace bits: where it is zero
};

/// In doubles, with an error bound.
/// @param numerator  result. @return false when magnitudes are extreme.
bool MakeFloatingNumerator(const ProofCell& cell, LayoutCache& cache, CellNumerator& numerator);

/// The numerator itself, of a cell whose collapsed edges and zero corners were made so.
struct SnappedForm
{
  std::shared_ptr<ExactForm> Form;
  int Power = 0;        ///< of the weight function below it
  bool Snapped = false; ///< CollapseTolerance changed the cell
};
SnappedForm MakeSnappedForm(const ProofCell& cell, LayoutCache& cache);

/// Sides and edges on which all coefficients are within what CollapseTolerance makes of zero
/// become zero. @param only  the side (set of slots) that may; 0: all.
/// @return the largest of what they were, 0 when there is none.
double SnapFaces(const ProofCell& cell, const SnappedForm& snapped, int only = 0);

/// Exactly: sides where it vanishes are divided out, edges and vertices where it does are known.
CellNumerator MakeExactNumerator(
  const ProofCell& cell, const SnappedForm& snapped, LayoutCache& cache);
}
