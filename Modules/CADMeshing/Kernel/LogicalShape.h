// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FaceChart.h"

namespace knotwork
{
enum class LogicalShapeKind
{
  Other,
  Rectangle, ///< one loop with four corners; it may have a seam
  Polygon,   ///< one loop with three, five or six corners
  Segment,   ///< one loop with two corners, as of half a disc
  Disc,      ///< one loop without corners
  Ring       ///< two loops, of which the longer is at most twice as long
};

/// What a face is to a mesher that lays grids into it.
struct LogicalShape
{
  LogicalShapeKind Kind = LogicalShapeKind::Other;
  std::vector<int> Corners; ///< uses of the first loop that begin at a corner; of a ring none
};

/// By the inner angles of the loops: from 20 to 140 degrees they are corners; all others must be
/// near to straight, but for those of rings.
LogicalShape LogicalShapeOf(const CADTopology& model, const FaceChart& chart);
}
