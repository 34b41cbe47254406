// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/MeshParameterization/TriangleMesh.h>

namespace knotwork
{
/// Triangles as a mesher of volumes takes them, equal points being one.
struct SolidSurface
{
  PointMatrix Points; ///< those that are used
  std::vector<std::array<int, 3>> Triangles;
  std::vector<int> PointIds; ///< of the input, the first of equal ones
  double Diagonal = 0.0;     ///< of the points' box
};

/// Whether triangles bound solids: no edge of one triangle only, the two triangles of an edge run
/// alike, triangles have areas and meet in common edges and corners only (decided exactly). More
/// than two triangles may share an edge: walls between regions.
/// @return EmptyInput; NonFiniteInput with the point; InvalidTopology with triangles and places:
/// corners that are no points, triangles without an area, duplicates, open edges, triangles that
/// are turned against each other, triangles that intersect.
/// @complexity O(n log n).
Result<SolidSurface> CheckSolid(const TriangleMesh& mesh, int threads = 0);
}
