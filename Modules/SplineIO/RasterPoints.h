// SPDX-License-Identifier: BSD-3-Clause
// Heights of a GeoTIFF as points in the middle of its cells.
#pragma once
#include <knotwork/SplineIO/PointFile.h>
#include <knotwork/SplineIO/PointStream.h>

namespace knotwork
{
bool IsRasterEnding(const std::string& ending); ///< .tif or .tiff, in lower case

struct RasterPoints
{
  PointFile Points;                 ///< row by row, cells without data left out
  std::uint64_t NumWithoutData = 0; ///< cells that are left out
};

/// @return failures of OpenRaster and of reading; TooLarge: more than 100,000,000 cells;
/// EmptyInput: no cell has data; Aborted. The file is named.
Result<RasterPoints> ReadRasterPoints(const std::string& file, const ProgressCallback& progress);

/// The same points as a stream, which holds two rows of the file's blocks; MostPoints are its
/// cells, its box is that of their middles. @return as ReadRasterPoints; TooLarge: more than 1e12.
Result<std::shared_ptr<PointStream>> OpenRasterStream(const std::string& file);
}
