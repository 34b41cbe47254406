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

/// Even numbers of segments of all edges, at least those that are wished, such that opposite sides
/// of rectangles have as many. Where that would need more than three times the wish, the rectangle
/// is left out.
/// @param wishes      one an edge, at least 1.
/// @param rectangles  result: those that hold.
/// @source  the problem is that of Mitchell, Int. J. Numer. Meth. Eng. 49 (2000) 273 (interval
/// assignment); this is a greedy answer that always ends.
std::vector<int> DivideEdges(
  const CADTopology& model, const std::vector<int>& wishes, std::vector<RectangleFace>& rectangles);
}
