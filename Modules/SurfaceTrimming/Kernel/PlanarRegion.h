// SPDX-License-Identifier: BSD-3-Clause
// Polygons in the plane, private to the triangulation of faces. Coordinates are whole numbers, so
// that the questions asked of them have exact answers.
#pragma once
#include <knotwork/SplineCore/BoxTree.h>

#include <array>
#include <vector>

namespace knotwork
{
/// Whole numbers of magnitude at most PlanarGridSize.
using PlanarPoint = std::array<double, 2>;
inline constexpr double PlanarGridSize = 1099511627776.0; // 2^40: differences are exact

/// Sign of the area of the triangle a, b, c; exact.
int Orientation(const PlanarPoint& a, const PlanarPoint& b, const PlanarPoint& c);

/// From the first point to the second one; the region lies to the left.
using PlanarSegment = std::array<int, 2>;

/// Boxes of segments, a row each, and their tree.
struct PlanarBoxes
{
  PointMatrix Lower; ///< n x 2
  PointMatrix Upper; ///< n x 2
  BoxTree Tree;
};
PlanarBoxes SegmentBoxes(
  const std::vector<PlanarPoint>& points, const std::vector<PlanarSegment>& segments);

/// Pairs of segments that have a point in common other than one end of both, each pair once in
/// ascending order; a segment without length pairs with itself. Exact.
/// @complexity O(n log n) when few boxes of segments overlap.
std::vector<std::array<int, 2>> FindCrossings(
  const std::vector<PlanarPoint>& points, const std::vector<PlanarSegment>& segments);

/// Whether points lie inside of closed polygons (an odd number of segments to their right); either
/// answer on a segment.
std::vector<bool> InsidePolygons(const std::vector<PlanarPoint>& points,
  const std::vector<PlanarSegment>& segments, const std::vector<PlanarPoint>& queries);

/// Part of a triangulation.
struct PlanarRegion
{
  std::vector<std::array<int, 3>> Triangles; ///< those inside
  /// Segments whose two sides are both inside or both outside, or that are no edge of a triangle:
  /// polygons that are not nested, or run the wrong way around. Ascending; empty when all is well.
  std::vector<int> Misplaced;
};

/// The triangles that segments have to their left.
/// @param triangles  of the convex hull, counterclockwise, with the segments among their edges.
PlanarRegion SelectRegion(std::size_t numPoints, const std::vector<std::array<int, 3>>& triangles,
  const std::vector<PlanarSegment>& segments);
}
