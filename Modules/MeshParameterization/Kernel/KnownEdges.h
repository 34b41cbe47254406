// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "TriangleMesh.h"

namespace knotwork
{
/// How far points of lines may lie from points of a mesh, share of the diagonal of its box.
constexpr double KnownEdgeTolerance = 1e-3;

/// Lines through points of a mesh as pairs of its points, for KnownFeatures. Pairs of one point are
/// left out.
/// @param mesh  with points and triangles that are in order; else there are no pairs.
/// @param points  n x 3. @param lines  rows of points, one after the other.
/// @return NonFiniteInput; OutsideDomain: points that are farther from all points of the mesh than
///         KnownEdgeTolerance (numbers).
/// @complexity O(log n) a point.
Result<std::vector<std::array<int, 2>>> EdgesOfLines(
  const TriangleMesh& mesh, const PointMatrix& points, const std::vector<std::vector<int>>& lines);
}
