// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineIO/SplineFile.h>

#include <string_view>

namespace knotwork
{
/// Reads the sides of a domain from JSON: an object with the list "curves" (of a planar domain:
/// each an object with "degree", "knots", "control_points") or the list "faces" (of a volume: each
/// with "degrees" and "knots" of two directions, "control_points" with the first direction
/// fastest), and optionally "weights" a side. All other keys are ignored.
/// @return InvalidFormat naming the side and the key; InvalidDegree, InvalidKnots, InvalidWeight,
/// NonFiniteInput, SizeMismatch for what the numbers say; EmptyInput without a side.
Result<SplineFile> ReadBoundaryJson(std::string_view text);

/// Whether a text may begin like this.
bool LooksLikeBoundaryJson(std::string_view beginning);
}
