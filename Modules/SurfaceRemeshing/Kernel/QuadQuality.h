// SPDX-License-Identifier: BSD-3-Clause
// Shapes of quadrilaterals in space and how they become better, private to the kernel.
#pragma once
#include <knotwork/SplineCore/TriangleIndex.h>

namespace knotwork
{
using MeshQuad = std::array<int, 4>; ///< points in cyclic order

/// Vector product of the diagonals: along the normal, twice as long as the area of a plane one.
Eigen::Vector3d DiagonalProduct(const PointMatrix& points, const MeshQuad& quad);

/// Smallest sine of the four angles about the normal, in [-1, 1]: 1 is a rectangle, below 0 it is
/// folded. -1 where edges or the normal have no length.
double ScaledJacobian(const PointMatrix& points, const MeshQuad& quad);

/// Both halves of every quadrilateral, along the shorter diagonal.
std::vector<MeshTriangle> HalvesOf(const PointMatrix& points, const std::vector<MeshQuad>& quads);

/// Moves points to the middles of their neighbours - and, where shapes are poor, along edges and
/// diagonals - and onto the surface, each only where that
/// raises the smallest scaled Jacobian around it, or the mean where that one is below 0.1; points
/// between quadrilaterals whose normals differ by more than 30 degrees stay, unless one of these is
/// folded or nearly so.
/// @param times  over all points at most; it ends where none moves.
/// @return whether any has moved.
bool SmoothQuads(const TriangleIndex<3>& surface, const std::vector<MeshQuad>& quads, int times,
  PointMatrix& points);
}
