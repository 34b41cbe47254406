// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/CADModel/CADTopology.h>

namespace knotwork
{
/// A face whose opposite sides want as many segments.
struct RectangleFace
{
  int Face = 0;
  std::array<std::vector<int>, 4> Sides; ///< edges
};

/// Two chains of edges that have as many segments.
struct EqualChains
{
  std::vector<int> One;
  std::vector<int> Other;
};

/// Even numbers of segments of all edges, at least those that are wished, such that chains that
/// must, and opposite sides of rectangles, have as many. Where a rectangle would need more than
/// three times the wish, it is left out.
/// @param wishes      one an edge, at least 1.
/// @param rectangles  result: those that hold.
/// @return InvalidTopology: chains that must have as many segments, and cannot.
/// @source  the problem is that of Mitchell, Int. J. Numer. Meth. Eng. 49 (2000) 273 (interval
/// assignment); this is a greedy answer that always ends.
Result<std::vector<int>> DivideEdges(const CADTopology& model, const std::vector<int>& wishes,
  const std::vector<EqualChains>& required, std::vector<RectangleFace>& rectangles);
}
