// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "StitchTiles.h"

namespace knotwork
{
/// Knots so close (relative to the side) are one; above what the insertion takes for one.
inline constexpr double SameKnot = 2e-12;

/// Direction of the parameter along a side.
inline std::size_t AlongSide(int side)
{
  return SideDirections<2>(side)[0];
}

/// The part of two sides that is one curve.
struct TileEdge : PatchInterface
{
  double Low(std::size_t i) const { return this->Parts[i].Lower[0]; }
  double High(std::size_t i) const { return this->Parts[i].Upper[0]; }
  bool IsReversed() const { return this->Orientation.Reversed[0]; }
  /// The second tile's length in parameters over the first one's.
  double Ratio() const { return (this->High(1) - this->Low(1)) / (this->High(0) - this->Low(0)); }
  /// A parameter along side `from` of the pair as one along the other side.
  double Map(std::size_t from, double t) const
  {
    const std::size_t to = 1 - from;
    if (!this->IsReversed() && this->Low(0) == this->Low(1) && this->High(0) == this->High(1))
    {
      return t;
    }
    const double s = (t - this->Low(from)) / (this->High(from) - this->Low(from));
    const double r = this->IsReversed() ? 1.0 - s : s;
    return (1.0 - r) * this->Low(to) + r * this->High(to);
  }
};

/// Finds the edges that tiles share. Domain: boxes within the tolerance of each other are made to
/// fit, by moving the tiles' knots (and x and y of height fields with them). @param tiles  of kind
/// LocallyRefined.
/// @return InvalidParameter, InvalidTopology as StitchTiles says.
Result<std::vector<TileEdge>> FindTileEdges(
  std::vector<Spline<2>>& tiles, const StitchParams& params);
}
