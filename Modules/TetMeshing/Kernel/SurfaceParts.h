// SPDX-License-Identifier: BSD-3-Clause
// Triangles that were divided, measured against what they were.
#pragma once
#include <knotwork/SplineCore/TriangleIndex.h>

namespace knotwork
{
struct PartsDistance
{
  double OfParts = 0.0;           ///< no point of a part is farther from its triangle
  double OfSurface = 0.0;         ///< no point of a triangle is farther from its parts, but of Open
  std::vector<MeshTriangle> Open; ///< triangles that the edges do not go once around
};

/// Bounds from the corners of the parts: a part is as far from a plane triangle as its farthest
/// corner is. The edges that bound the parts of a triangle go once around it, so that the parts
/// cover it (their degree modulo 2 is 1 inside): its points are no farther from them than corners
/// are from the triangle, and twice as far as those edges' ends are from its sides.
/// @param sources  triangle of each part.
/// @param tolerance  farther from a triangle's sides those edges do not count.
/// @complexity O(n log n)
PartsDistance MeasureParts(const PointMatrix& surface, const std::vector<MeshTriangle>& triangles,
  const PointMatrix& points, const std::vector<MeshTriangle>& parts,
  const std::vector<int>& sources, double tolerance);
}
