// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SideContacts.h"

/// Private to the injectivity proof: boundaries far away from the origin.
namespace knotwork
{
/// Where boundaries were moved from.
struct BoundaryShift
{
  std::array<double, 3> Middle{}; ///< that was taken from all points
  double Distance = 0.0;          ///< largest coordinate of that
};

/// Sides far away from the origin move to it, so that the roundings of what follows are of their
/// size and not of their distance. Coefficients become x w - o w, from what the cell stores with
/// its remainder; equal ones stay equal. By multiples of a power of two larger than they are,
/// most move exactly: w o has few more digits than w.
/// @param cells  that the sides are of.
BoundaryShift MoveToMiddle(const BernsteinCells& cells, std::vector<BoundarySide>& boundary);
}
