// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SignProof.h"

/// Private to the proof of cells: bounds of the smallest and the largest Jacobian.
namespace knotwork
{
/// Fills the four bounds: from the coefficients, the corners and what the proof of the sign found,
/// refined to the gap that is asked for; adds the boxes that takes.
/// @param params  MaxBoxes is for each of minimum and maximum.
/// @param r       with the sign's verdict.
void BoundValues(const ProofCell& cell, const CellNumerator& numerator, const SignProof& sign,
  const JacobianParams& params, LayoutCache& cache, CellCertificate& r);
}
