// SPDX-License-Identifier: BSD-3-Clause
// Tiles of a cloud: rectangles of equal size in the plane of x and y.
#pragma once
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineCore/Types.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace knotwork
{
/// Rectangles without end; those before the first and behind the last belong to these.
struct TileGrid
{
  static constexpr int Farthest = 1000000; ///< largest magnitude of a number

  RealArray<2> Origin{};
  RealArray<2> Size{ 1.0, 1.0 }; ///< > 0
  RealArray<2> Halo{};           ///< in [0, Size / 2]: how far a tile knows its neighbours' points
  IntArray<2> First{ -Farthest, -Farthest };
  IntArray<2> Last{ Farthest, Farthest };

  /// Where tile `number` begins.
  double Edge(std::size_t direction, int number) const
  {
    return this->Origin[direction] + number * this->Size[direction];
  }
  /// The tile that a coordinate belongs to: from its edge, included, to the next one, excluded.
  int Number(std::size_t direction, double x) const;
  /// Whether a coordinate is within the halo's width of a tile.
  bool IsNear(std::size_t direction, int number, double x) const
  {
    return x >= this->Edge(direction, number) - this->Halo[direction] &&
      x <= this->Edge(direction, number + 1) + this->Halo[direction];
  }
};

struct CloudTile
{
  std::string File; ///< relative to the index
  IntArray<2> Number{};
  ParametricBox<2> Box;            ///< without the halo; outer tiles end with the points
  std::uint64_t NumPoints = 0;     ///< that belong to it
  std::uint64_t NumNeighbours = 0; ///< points of its file that belong to others
  std::string Checksum;            ///< of the coordinates in its file, in their order
};

/// What the index of the tiles of a cloud tells.
struct TileIndex
{
  TileGrid Grid;
  RealArray<3> Lower{}; ///< of the box of all points
  RealArray<3> Upper{};
  std::uint64_t NumPoints = 0;
  std::string ReferenceSystem;
  std::vector<CloudTile> Tiles; ///< row by row
};

/// As JSON, which ReadTileIndex reads again bit for bit.
std::string WriteTileIndex(const TileIndex& index);

/// @return InvalidFormat naming the key or the tile: no JSON, another kind of file, numbers that
/// are missing, not finite or do not go together (points of the tiles, boxes of their numbers),
/// files that do not lie beside the index.
Result<TileIndex> ReadTileIndex(std::string_view text);
}
