// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "TrimLoops.h"

/// Private to FitLoops: which boundary edges of charts become one edge of the model.
namespace knotwork
{
/// A chart along a chain.
struct ChainUse
{
  int Chart = 0;
  std::vector<int> Points; ///< of the chart, in the chain's direction; equal ends when closed
  bool Reversed = false;   ///< the chart lies to the right
};

struct BoundaryChain
{
  std::vector<ChainUse> Uses; ///< one, or two of opposite directions; the first is not reversed
  std::array<int, 2> Vertices{ 0, 0 };
};

/// Use of a chain in a loop.
struct ChainStep
{
  int Chain = 0;
  int Use = 0;
};

struct BoundaryChains
{
  std::vector<BoundaryChain> Chains; ///< in the order in which charts and their loops meet them
  /// Of each chart: the outer loop first, triangles to the left.
  std::vector<std::vector<std::vector<ChainStep>>> Loops;
  int NumVertices = 0;
  int NumBoundaryLoops = 0; ///< closed curves of edges that one chart uses
};

/// Chains end where the charts along the boundary change, at points where several boundaries
/// touch, and where the boundary turns by more than cornerAngle degrees, in space or in UV of a
/// chart, and at `vertices`. A closed curve without such points is one chain that begins at its
/// first point.
/// @pre every ChartMesh::Check is Ok.
/// @return InvalidTopology: an edge of three triangles (of charts), or of two that lie on the same
/// side; triangles that touch in a point only; charts whose common points lie apart, charts that
/// are not one disc with holes.
/// @complexity O(n log n).
Result<BoundaryChains> FindBoundaryChains(const std::vector<ChartMesh>& charts, double cornerAngle,
  const std::vector<LoopVertex>& vertices = {});
}
