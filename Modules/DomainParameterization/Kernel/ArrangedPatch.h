// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "PatchLayout.h"
#include "SideSplines.h"

/// Private to this module: one patch is a layout.
namespace knotwork
{
/// The layout of one patch whose given sides lie so on its own: common knots, weights that match,
/// control points that sides share. @return the errors of MakeCompatible of a boundary.
template <int Dim>
Result<CompatibleLayout<Dim>> MakeCompatible(const SideList<Dim>& sides,
  const std::array<SideOrigin, 2 * Dim>& origins, const BoundaryParams& params);
}
