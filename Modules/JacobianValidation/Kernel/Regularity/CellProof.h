// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FormLayout.h"
#include "JacobianCertificate.h"

namespace knotwork
{
/// The proof of one cell, by subdivision and, where rounding is in the way, exact arithmetic.
/// @param maxBoxes  in place of the params', which are for all cells.
/// @param witness   filled when the verdict is Invalid.
CellCertificate ProveCell(const BernsteinCells& cells, int cell, const JacobianParams& params,
  std::int64_t maxBoxes, LayoutCache& cache, JacobianWitness& witness);
}
