// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "TileEdges.h"

namespace knotwork
{
/// The functions of a tile along one of its sides: a univariate B-spline basis, twice.
struct SideRows
{
  std::vector<double> Knots; ///< along the side, with multiplicities
  double Span = 0.0;         ///< across the side: the first knot span, which all functions share
  /// Function ids by their number in the basis: those that do not vanish on the side, and (C1)
  /// those whose derivative across it is the first that does not.
  std::array<std::vector<int>, 2> Functions;
};

/// Rows[tile][side]; no functions where no edge is.
using TileRows = std::vector<std::array<SideRows, 4>>;

/// @return InvalidDegree naming the tiles: other degrees on the two sides of an edge, or for C1 a
/// degree of 1. @pre the tiles are locally refined.
Status CheckTileDegrees(const std::vector<Spline<2>>& tiles, const std::vector<TileEdge>& edges,
  const StitchParams& params);

/// Inserts knot lines until the functions along all edges are B-spline bases that have the same
/// knots on both sides of an edge. The maps do not change.
/// @pre CheckTileDegrees is Ok. @return Aborted; what InsertSegments returns.
Result<TileRows> PrepareStrips(
  std::vector<Spline<2>>& tiles, const std::vector<TileEdge>& edges, const StitchParams& params);
}
