// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "TriangleMesh.h"

namespace knotwork
{
/// Two boundary edges, by their points.
struct EdgeCrossing
{
  std::array<int, 2> First{ -1, -1 };
  std::array<int, 2> Second{ -1, -1 };
  explicit operator bool() const { return this->First[0] >= 0; }
};

/// Boundary edges that cross each other in the plane (common ends do not count), or that come
/// nearer to each other than half an edge there, but not than two edges in space: what lies between
/// such sheets could not be fitted. Of all such pairs the one with the longest way along the
/// boundary between them; loops are farthest from each other. Without such a pair opposite edges of
/// a hole whose loop runs counterclockwise, like the outer one. A map without flips whose boundary
/// does not cross itself and runs counterclockwise once only is injective.
/// @complexity O(n log n) when few edges are near each other.
EdgeCrossing FindCrossing(const DiscMesh& mesh, const PointMatrix& uv);
}
