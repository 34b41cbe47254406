// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "DomainBoundary.h"

namespace knotwork
{
/// Neighbouring control points of a boundary that agree within the rounding of their coordinates
/// become one point, so that derivatives that are zero are so exactly: where control points
/// coincide, a refinement leaves them a few units in the last place apart, in any direction.
/// Corners stay where they are, and edges as far as no corner is there.
/// @param tolerance  nothing moves farther than this, unit of the points, nor than 2^-46 of the
/// largest coordinate.
/// @pre the rows that sides share are the same bits, and stay so.
/// @return the largest distance that a point was moved by.
template <int Dim>
double JoinCoincidentPoints(CompatibleBoundary<Dim>& boundary, double tolerance);
}
