// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <array>
#include <vector>

namespace knotwork
{
/// Triangle and side on the other side of each side k (corner k to the next one); -1 on the
/// boundary.
struct TriangleAdjacency
{
  std::vector<std::array<int, 3>> Triangle;
  std::vector<std::array<int, 3>> Side;
};

/// @param triangles  numbers of points, not negative.
/// @return InvalidTopology: edges of more than two triangles (number, first points).
/// @complexity O(n + largest number), where few triangles meet in a point.
Result<TriangleAdjacency> FindAdjacency(const std::vector<std::array<int, 3>>& triangles);
}
