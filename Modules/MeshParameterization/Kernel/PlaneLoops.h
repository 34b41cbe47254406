// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/MeshParameterization/TriangleMesh.h>

namespace knotwork
{
/// Two boundary edges, by their points.
struct EdgeCrossing
{
  std::array<int, 2> First{ -1, -1 };
  std::array<int, 2> Second{ -1, -1 };
  explicit operator bool() const { return this->First[0] >= 0; }
};

/// Sign of the area of the triangle of rows a, b, c: exact where products neither over- nor
/// underflow.
int Turn(const PointMatrix& uv, int a, int b, int c);

/// Whether no triangle is flipped or has no area; exact.
bool IsCounterclockwise(const DiscMesh& mesh, const PointMatrix& uv);

/// Of a map without flips two boundary edges of a place that it covers more than once, none when it
/// is injective as a whole. Exact: the number of triangles over a point is the winding number of
/// the boundary, which is 0 or 1 when loops meet neither themselves nor each other (but in common
/// ends of edges) and one of them, the outer, runs counterclockwise.
/// @param loops  of the boundary, with the triangles to their left; each point lies in one of them,
///        once.
/// @return edges that meet; of all such pairs the one with the longest way along the boundary
///         between them, loops are farthest from each other. Without such a pair opposite edges of
///         a hole whose loop runs counterclockwise.
/// @complexity O(n log n) when few edges are near each other.
EdgeCrossing FindOverlap(const std::vector<std::vector<int>>& loops, const PointMatrix& uv);

/// Proof that a map is injective as a whole; exact.
/// @return InvalidTopology: triangles that are not counterclockwise; an overlap, by its points.
Status CheckInjective(const DiscMesh& mesh, const PointMatrix& uv);

/// What FindOverlap finds, or boundary edges that come nearer to each other than half an edge in
/// the plane, but not than two edges in space, or, from a common point on, than a quarter of their
/// distance in space: what lies between such sheets could not be fitted.
EdgeCrossing FindCrossing(const DiscMesh& mesh, const PointMatrix& uv);
}
