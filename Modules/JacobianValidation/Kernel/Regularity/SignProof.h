// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CellNumerator.h"

#include <limits>

/// Private to the proof of cells: that a numerator has one sign on its cell.
namespace knotwork
{
struct SignProof
{
  bool NeedsExact = false; ///< doubles do not tell, and exact arithmetic may; nothing else is known
  knotwork::Verdict Verdict = knotwork::Verdict::Undecided;
  JacobianLimit Limit = JacobianLimit::None; ///< of Undecided
  /// Of the problem's minimum, or of that of the negative problem: when it is Reversed or Turned.
  double Lower = -std::numeric_limits<double>::infinity();
  double Upper = std::numeric_limits<double>::infinity();
  bool Turned = false; ///< Undecided, but reversed if anything
  std::int64_t Boxes = 0;
};

/// By the signs at the corners and subdivision.
/// @param params   MaxBoxes is for this search.
/// @param witness  filled when the verdict is Invalid.
SignProof ProveSign(const ProofCell& cell, const CellNumerator& numerator,
  const JacobianParams& params, JacobianWitness& witness);
}
