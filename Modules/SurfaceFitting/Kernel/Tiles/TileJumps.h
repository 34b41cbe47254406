// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "TileEdges.h"
#include <knotwork/SplineCore/BezierForm.h>

namespace knotwork
{
/// Upper bounds over an edge.
struct EdgeJump
{
  double Value = 0.0; ///< distance between both sides' points
  double Slope =
    0.0; ///< between their derivatives across the edge, with the first tile's parameter
};

/// Bounds from the Bernstein coefficients of the differences, halved until the bound is at most a
/// thousandth above a value that is reached; the coefficients' rounding is added.
/// @param forms  of all tiles, polynomial. @param components  the first ones, that are measured.
EdgeJump MeasureJump(const std::vector<BezierForm<2>>& forms, const TileEdge& edge, int components);
}
