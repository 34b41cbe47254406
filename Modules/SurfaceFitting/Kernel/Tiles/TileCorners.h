// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "TileStrips.h"

namespace knotwork
{
/// Numbers, in the basis of a side, of the functions that belong to a part [low, high] of it,
/// ascending. -1 first or last: the end lies within the side and the side is smooth there, so the
/// coefficient that a basis of the part alone had there is a mean of those on both sides.
std::vector<int> EdgeFunctions(const SideRows& rows, int degree, double low, double high);

/// A corner of a tile, or one half of the place where an edge ends within a tile's side. Rows of
/// numbers are those across the side: on it, and (C1) next to it.
struct TileCorner
{
  int Tile = 0;
  std::size_t Across = 0;       ///< direction of the side
  IntArray<2> Degree{};         ///< across, along
  std::array<double, 2> Span{}; ///< across, along: from the corner inwards
  /// Functions: at the corner (-1: a mean, see EdgeFunctions), and next to it along the side.
  std::array<std::array<int, 2>, 2> Functions{};
  /// When a mean: the functions beyond the corner, and the knot span there.
  std::array<int, 2> Beyond{};
  double SpanBeyond = 0.0;
  /// The derivative inwards in direction d of the tile is Factor[d] times that along Axis[d] of the
  /// frame that all corners of a place share.
  std::array<int, 2> Axis{};
  std::array<double, 2> Factor{};
};

/// Corners by the place where they meet.
/// @return InvalidTopology for C1 where the tiles around a place have no common frame.
Result<std::vector<std::vector<TileCorner>>> FindTileCorners(const std::vector<Spline<2>>& tiles,
  const TileRows& rows, const std::vector<TileEdge>& edges, const StitchParams& params);

/// Gives corners that meet the mean of their values, and (C1) of their derivatives and mixed
/// derivatives. @pre the edges have been averaged.
void AverageCorners(
  std::vector<Spline<2>>& tiles, const std::vector<TileCorner>& corners, int continuity);
}
