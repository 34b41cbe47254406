// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineIO/PointStream.h>
#include <knotwork/SplineIO/TileIndex.h>

#include <filesystem>

namespace knotwork
{
struct SplitParams
{
  /// Length of the sides of tiles, unit of the coordinates, > 0; 0: by PointsPerTile, which needs a
  /// file that tells its box and its number of points (LAS, GeoTIFF).
  double TileSize = 0.0;
  std::uint64_t PointsPerTile = 1000000; ///< about, where the points are spread evenly; > 0
  /// How much of its neighbours a tile's file holds: share of the tile's sides, in [0, 0.5].
  double Halo = 0.05;
  std::size_t BufferBytes = std::size_t{ 1 } << 25U; ///< of points that wait for their files
  int Threads = 0;
};

struct SplitCloud
{
  TileIndex Index; ///< the files are named relative to the folder's own folder
  std::vector<std::string> Warnings;
  std::vector<std::string> LeftOut;
  std::uint64_t NumWithoutData = 0; ///< cells of a raster that have none
};

/// Splits a cloud (.las .tif .xyz .txt .csv .ply) that may be larger than the memory into files of
/// tiles, in one pass. Every file holds the points of its tile and those of its neighbours within
/// the halo, unchanged: records of LAS files with a header of their own (records behind the points
/// are dropped, the coordinate reference system of all is in the index), all numbers of points of
/// text, PLY and GeoTIFF files as PLY in double precision.
///
/// Where LAS and GeoTIFF files tell a box the tiles divide it evenly; else they begin at multiples
/// of TileSize. The points of an outermost tile that the data fill by no more than the halo go to
/// its neighbour.
/// @param folder  that is there, empty.
/// @return FileError, failures of OpenPointStream; InvalidParameter: TileSize is missing;
/// OutsideDomain: a point is too far away for tiles of that size; TooLarge: more than 100,000
/// tiles; InvalidTopology: the points have no area, or points are lost (their number differs from
/// that of the header, or of the files). The file is named. What has been written so far
/// stays in the folder.
/// @complexity time O(points); memory O(BufferBytes + tiles), of a GeoTIFF and twice a row of its
/// blocks.
VTKKNOTWORKSPLINEIO_EXPORT Result<SplitCloud> SplitIntoTiles(
  const std::string& file, const std::filesystem::path& folder, const SplitParams& params);

/// Reads an index of tiles. @return FileError, failures of ReadTileIndex; the file is named.
VTKKNOTWORKSPLINEIO_EXPORT Result<TileIndex> ReadTileFile(const std::string& file);

/// The positions in a file that SplitIntoTiles wrote.
/// @param expected  their number. @return n x 3; failures of the format, SizeMismatch for another
/// number; the file is named.
VTKKNOTWORKSPLINEIO_EXPORT Result<PointMatrix> ReadTilePoints(
  const std::string& file, std::uint64_t expected);
}
