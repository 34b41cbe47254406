// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Types.h>

#include <array>
#include <vector>

namespace knotwork
{
/// Triangles between the corners of a polygon, which run as it does. It is looked at in the plane
/// that is normal to its vector area; there it may have reflex and straight corners, and touch
/// itself. All questions are answered exactly for the coordinates there, which are rounded to 2^-50
/// of its size. Of the corners that can be cut off the one with the best triangle is next.
/// @param corners  n x 3.
/// @return corners.rows() - 2 triangles, all of positive area; none when there are fewer than three
/// corners, or when the polygon crosses itself or has no area.
/// @complexity O(n^2).
/// @source  Meisters, Am. Math. Monthly 82 (1975) 648 (polygons have two ears).
std::vector<std::array<int, 3>> DividePolygon(const PointMatrix& corners);
}
