// SPDX-License-Identifier: BSD-3-Clause
// The LR surfaces of g2 texts (class 293).
#pragma once
#include "G2Words.h"
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// Reads what follows the header of an LRSplineSurface. Functions may stand in any order; their
/// scaling factors are kept. @return an empty spline when words.Outcome tells of a failure.
Spline<2> ReadLRSurface(G2Words& words);

/// Appends what follows the header of an LRSplineSurface. @pre spline.Check() is Ok, kind
/// LocallyRefined.
void AppendLRSurface(const Spline<2>& spline, std::string& text);
}
