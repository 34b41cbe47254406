// SPDX-License-Identifier: BSD-3-Clause
// The heights of spline surfaces on a raster, written block by block.
#pragma once
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineCore/Types.h>
#include <knotwork/SplineIO/RasterSummary.h>

#include <functional>

class vtkDataObject;

namespace knotwork
{
struct HeightRasterParams
{
  double CellSize = 0.0;       ///< of square cells, unit of the coordinates, > 0
  RealArray<2> Corner{};       ///< where a corner of cells lies, in the raster or not
  double NoData = -9999.0;     ///< number of cells without a height
  bool IsDouble = false;       ///< double precision, else single
  std::int64_t MaxCells = 0;   ///< more are an error, > 0
  std::string ReferenceSystem; ///< WKT; empty: none
  int Threads = 0;
  ProgressCallback Progress;
};

/// Writes heights z(x, y) of spline surfaces as GeoTIFF: those in the middle of the cells. Cells
/// have their corners at whole multiples of their size from Corner, as many as cover the domains;
/// those whose middle is outside of all domains, or of what trims the faces, have no data. Where
/// several surfaces have a height, the first one's counts.
/// @param splines  surfaces whose x and y are their parameters, or trimmed faces on such.
/// @param file  where nothing is yet.
/// @return failures of DecodeSplineModel and DecodeTrimmedModel; EmptyInput: no surfaces, or no
/// middle of a cell on them; DimensionMismatch: a patch is no surface; InvalidTopology: one is no
/// height function; InvalidParameter: CellSize; TooLarge: MaxCells; NonFiniteInput: heights
/// beyond single precision; FileError; LibraryError without GDAL; Aborted.
/// @complexity one evaluation a cell with a height; memory the surfaces and a row of blocks.
Result<RasterSummary> WriteHeightRaster(
  vtkDataObject* splines, const std::string& file, const HeightRasterParams& params);
}
