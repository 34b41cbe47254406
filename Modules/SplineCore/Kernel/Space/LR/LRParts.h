// SPDX-License-Identifier: BSD-3-Clause
// The steps of MakeLRSpace.
#pragma once
#include "LRSpace.h"

namespace knotwork
{
/// Degrees, knots and lines; with functions also all that MakeLRSpace says about those but their
/// sum. @return what MakeLRSpace returns.
Status CheckLRLines(const LRBasis& basis);
Status CheckLRFunctions(const LRBasis& basis, int threads);

/// AliveStart and AliveFunctions from Basis and ElementKnots.
/// @return TooLarge above 16 (p + 1)(q + 1) functions on an element on average.
Status FindAliveFunctions(LRData& data, int threads);

/// The rows of T from Basis, ElementKnots and the alive functions.
/// @return InvalidTopology when the functions' sum is not 1.
Status BuildLRRows(SplineSpace<2>& space, const LRData& data, int threads);

/// MakeLRSpace for lines and functions that passed the checks or are right by construction.
Result<SplineSpacePtr<2>> AssembleLRSpace(LRBasis basis, int threads);
}
