// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "MapBoundary.h"

#include <optional>

/// Private to the injectivity proof: points beside two boundary sides that have one image.
namespace knotwork
{
/// Where boundaries cross, the insides beside them overlap: points just inside one cell whose
/// images another cell takes too.
/// @param at  parameters of both sides where the proof that they are apart stopped.
std::optional<InjectivityWitness> FindSideOverlap(const MapBoundary& boundary,
  const std::array<int, 2>& sides, const std::array<std::array<double, 3>, 2>& at);
}
