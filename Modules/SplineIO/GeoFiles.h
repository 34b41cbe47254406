// SPDX-License-Identifier: BSD-3-Clause
// Files of maps by GDAL, which is loaded (knotwork-gdal.so) when the first of these functions is
// called.
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace knotwork
{
/// Cells of equal size, each with one number for all of it.
struct RasterGrid
{
  int Columns = 0;
  int Rows = 0;
  /// x = T[0] + c T[1] + r T[2] and y = T[3] + c T[4] + r T[5] of column c and row r; whole numbers
  /// are corners of cells, the middle of the first cell is c = r = 1/2.
  std::array<double, 6> Transform{ 0.0, 1.0, 0.0, 0.0, 0.0, -1.0 };
  std::string ReferenceSystem; ///< WKT; empty: none
};

/// A raster that is read.
class RasterSource
{
public:
  RasterSource() = default;
  RasterSource(const RasterSource&) = delete;
  RasterSource& operator=(const RasterSource&) = delete;
  virtual ~RasterSource() = default;

  /// Numbers of whole rows, scaled as the file says; NaN where there are no data.
  /// @param values  rows * Columns.
  virtual Status Read(int firstRow, int rows, double* values) = 0;

  RasterGrid Grid;
  int RowsOfBlock = 1; ///< reading them together decodes a block once
  std::vector<std::string> LeftOut;
};

/// A raster that is written, block by block.
class RasterTarget
{
public:
  RasterTarget() = default;
  RasterTarget(const RasterTarget&) = delete;
  RasterTarget& operator=(const RasterTarget&) = delete;
  virtual ~RasterTarget() = default;

  static constexpr int BlockSide = 256; ///< of the blocks, which begin at multiples of it

  /// @param values  rows * columns, row by row.
  virtual Status Write(int column, int row, int columns, int rows, const double* values) = 0;
  /// Writes the rest and closes the file.
  virtual Status Finish() = 0;
};

struct RasterFormat
{
  bool IsDouble = false; ///< else numbers have single precision
  double NoData = -9999.0;
};

/// A number of every line.
struct LineAttribute
{
  std::string Name;
  bool IsInteger = false;
  std::vector<double> Values;
};

struct LineLayer
{
  std::string Name;
  std::vector<double> Points;      ///< x, y, z of each
  std::vector<std::size_t> Begins; ///< of lines among the points, and the end
  std::vector<LineAttribute> Attributes;
  std::string ReferenceSystem; ///< WKT; empty: none
};

struct MapReferenceSystem
{
  std::string Wkt;
  std::string Name; ///< EPSG:25832 where it has a number, else its name
};

/// A reference system by what says it: EPSG:25832, EPSG:25832+7837, WKT, PROJ's strings, or the
/// GeoTIFF keys of a LAS file.
/// @return InvalidParameter: PROJ knows none of these; LibraryError without GDAL.
Result<MapReferenceSystem> FindReferenceSystem(const std::string& text);

/// Opens a GeoTIFF of one band.
/// @return FileError; InvalidFormat: no TIFF, several bands, complex numbers, no or a singular
/// transform; TooLarge: blocks of a row that take more than 1 GB; LibraryError without GDAL. The
/// file is named.
Result<std::shared_ptr<RasterSource>> OpenRaster(const std::string& file);

/// Begins a GeoTIFF: blocks of 256 x 256 cells, deflated, BigTIFF where it may be needed.
/// @param file  where nothing is yet. @return FileError; LibraryError without GDAL.
Result<std::shared_ptr<RasterTarget>> CreateRaster(
  const std::string& file, const RasterGrid& grid, const RasterFormat& format);

/// Writes a GeoPackage of one layer of lines (LINESTRING Z).
/// @param file  where nothing is yet. @return FileError; LibraryError without GDAL.
Status WriteLineLayer(const LineLayer& layer, const std::string& file);

/// What knotwork-gdal.so gives to those that load it.
struct GeoFunctions
{
  decltype(&FindReferenceSystem) FindSystem;
  decltype(&OpenRaster) Open;
  decltype(&CreateRaster) Create;
  decltype(&WriteLineLayer) WriteLines;
};
}

/// The one function that the library exports.
extern "C" const knotwork::GeoFunctions* KnotworkGeoFunctions();
