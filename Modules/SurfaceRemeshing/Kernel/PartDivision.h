// SPDX-License-Identifier: BSD-3-Clause
// Triangles divided where they meet, exactly, private to the kernel.
#pragma once
#include "ExactPoints.h"

#include <utility>

namespace knotwork
{
/// Divides the triangles of pairs along what they have in common; parts that still overlap without
/// being the same are divided again, a few times at most.
/// @param triangles  none of them degenerate. @param points  of the triangles; new ones are added.
/// @return all triangles, divided or not, in their order.
std::vector<TrianglePart> DivideAll(const std::vector<MeshTriangle>& triangles,
  std::vector<std::pair<int, int>> pairs, ExactPoints& points);
}
