// SPDX-License-Identifier: BSD-3-Clause
// How far a repair is from what was given, private to the kernel.
#pragma once
#include "OngoingRepair.h"

namespace knotwork
{
/// Sets DistanceFromInput and DistanceToInput. Triangles that are not one of the other mesh, with
/// points of the same numbers, are measured, but not those in holes.
/// @param firstOfEqual  of FirstOfEqualPoints of the input.
/// @param result  all else is set.
/// @return NotConverged: a distance above Limit, with its place.
Status CheckDistances(const TriangleMesh& input, const std::vector<int>& firstOfEqual,
  const OngoingRepair& repair, SurfaceRepair& result);
}
