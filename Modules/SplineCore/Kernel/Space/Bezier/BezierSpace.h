// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// Space of Bezier elements that share control points where their ids agree: what a Bezier grid of
/// foreign origin is. Local functions are the Bernstein polynomials; no parameter domain.
/// @param degrees      one a cell, each entry in [1, 9].
/// @param pointIds     per cell prod(p_d + 1) function ids in [0, numFunctions), first direction
/// fastest,
///                     concatenated.
/// @return InvalidDegree, SizeMismatch, or InvalidTopology for an id out of range; details name the
/// cell.
template <int Dim>
Result<SplineSpacePtr<Dim>> MakeBezierSpace(
  const std::vector<IntArray<Dim>>& degrees, const std::vector<int>& pointIds, int numFunctions);

/// The family's entry in the table.
template <int Dim>
const SpaceFamily<Dim>& BezierFamily();
}
