// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/SplineSpace.h>
#include <knotwork/SplineCore/Status.h>

/// Private to the search of critical points.
namespace knotwork
{
/// Where a Bezier element without a domain lies as a unit square of a plane.
struct PlacedElement
{
  IntArray<2> Cell{}; ///< lower corner
  IntArray<2> Axis{ 0, 1 };
  std::array<bool, 2> Reversed{}; ///< see ScalarPieces
};

/// Unfolds Bezier elements that share the control points of their sides. Parts that do not hang
/// together are placed apart.
/// @return InvalidTopology where it cannot be done: around a corner of other than four elements,
/// on surfaces that close, where three elements share a side.
Result<std::vector<PlacedElement>> PlaceElements(const SplineSpace<2>& space);
}
