// SPDX-License-Identifier: BSD-3-Clause
// Parts of triangles without short edges and heights, private to the kernel.
#pragma once
#include "ExactPoints.h"

namespace knotwork
{
/// Takes short edges and flat triangles away that divisions made: rounding and moving would turn
/// them over. Points are put on others, or edges led through points; what is closed stays closed.
/// @param divided  of all triangles of the input: whether parts of it may go.
/// @param distance  edges and heights that are shorter are short; edges between given points stay.
void SnapParts(std::vector<TrianglePart>& parts, const std::vector<char>& divided,
  const ExactPoints& points, double distance);
}
