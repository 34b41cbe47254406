// SPDX-License-Identifier: BSD-3-Clause
// Triangles that meet where they should not, private to the kernel.
#pragma once
#include <knotwork/SplineCore/TriangleIndex.h>

#include <utility>
#include <vector>

namespace knotwork
{
/// Triangles without an area, exactly: corners that are equal or on a line.
std::vector<char> FindDegenerate(
  const PointMatrix& points, const std::vector<MeshTriangle>& triangles, int threads);

/// Pairs of triangles (the lower number first, ascending) that have more in common than the
/// corners and edges that they share by number. Decided exactly; degenerate triangles are in none.
/// @param of  one a triangle: only pairs of which one is set; empty: all.
std::vector<std::pair<int, int>> FindIntersections(const PointMatrix& points,
  const std::vector<MeshTriangle>& triangles, int threads, const std::vector<char>& of = {});
}
