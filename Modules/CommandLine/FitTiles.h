// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineIO/TileIndex.h>

#include <nlohmann/json.hpp>

#include <functional>
#include <string>
#include <vector>

class vtkSplineSurfaceFit;

namespace knotwork
{
class Session;
struct SplinePatch;

/// What is known of a tile of the surface, at the points that belong to it.
struct FittedTile
{
  long long NumFunctions = 0;
  long long NumOutliers = 0;
  long long NumOutside = 0; ///< farther away than their tolerance, outliers left out
  double MaxError = 0.0;
  double MeanError = 0.0;
  double RmsError = 0.0;
};

struct TileFitParams
{
  std::string IndexFile;
  /// Keeps the surface of every tile as soon as it is there; empty: nothing is kept.
  std::string ResumeFolder;
  /// Of the fit: what is kept of a run with others is not taken for that of this one.
  nlohmann::ordered_json Options;
};

struct TileFit
{
  std::vector<FittedTile> Tiles; ///< in the order of the index
  double MaxJumpBefore = 0.0;    ///< between neighbours, before they were stitched
  double MaxSlopeJumpBefore = 0.0;
  double MaxJump = 0.0; ///< and afterwards: rounding
  double MaxSlopeJump = 0.0;
  int NumEdges = 0;
  int NumResumed = 0;            ///< surfaces that an earlier run had left
  std::vector<int> NumOfProcess; ///< tiles that each process has fitted
};

/// Gets the surface of a tile, numbered as in the index, when it is done.
using TakeTile = std::function<Status(SplinePatch&& patch)>;

/// Fits a surface to the tiles of a cloud, one after the other: each with its neighbours' points
/// within the halo, cut down to its own rectangle. Row by row they are stitched to the row before
/// (C1, of degree 1 C0). A row that is stitched on all sides is done when its tiles have been
/// updated where points that belong to them are farther away than their tolerance, edges held. So
/// the memory is that of the functions of two rows and of the points of a tile.
/// @param filter  with its properties set; its inputs are those of the last tile afterwards.
/// @return failures of the filter, the tile is named, and of take; FileError; InvalidParameter: the
/// folder holds something else, or what a run with other options or tiles has left.
Result<TileFit> FitTiles(Session& session, vtkSplineSurfaceFit* filter, const TileIndex& index,
  const TileFitParams& params, const TakeTile& take);
}
