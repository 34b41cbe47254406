// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "JacobianCertificate.h"

namespace knotwork
{
/// Proves what the signs of the numerators' coefficients prove, for cells [begin, end); the others
/// keep Undecided. Width cells are worked on at a time, with the same operations in the same order.
/// @pre  Width 4: HasWideVectors(). @return false when a value is not finite or a weight not
/// positive.
template <int Width>
bool FilterCells(const BernsteinCells& cells, const JacobianParams& params, std::size_t begin,
  std::size_t end, CellCertificate* results);
}
