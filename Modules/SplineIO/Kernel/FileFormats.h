// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
#include <vector>

namespace knotwork
{
/// What reads and writes a format.
enum class FormatFamily
{
  VTKPolyData,
  VTKGrid,
  VTKCollection,
  VTKLegacy,
  VTKImage,
  GismoXML,
  GoToolsG2,
  CAD,
  BoundaryJSON,
  PointText,
  PolygonFile
};

/// What a file may hold, as bits.
enum FileContent : unsigned
{
  SplineGridContent = 1U << 0,        ///< patches of one grid
  SplineCollectionContent = 1U << 1,  ///< grids of a collection
  SplineCurveContent = 1U << 2,       ///< curves as patches
  TrimmedFaceContent = 1U << 3,       ///< surfaces and what trims them
  BoundaryContent = 1U << 4,          ///< sides of a domain
  PointContent = 1U << 5,             ///< positions
  PointValueContent = 1U << 6,        ///< positions and arrays of values
  PolylineContent = 1U << 7,          ///< polylines
  PolygonContent = 1U << 8,           ///< polygons of one dataset
  PolygonCollectionContent = 1U << 9, ///< polygons of a collection
  CellContent = 1U << 10,             ///< any cells
  ImageContent = 1U << 11,            ///< values on a raster
  TableContent = 1U << 12             ///< rows of numbers and text
};

struct FileFormat
{
  const char* Name;
  FormatFamily Family;
  std::vector<std::string> Endings; ///< in lower case with their dot, the usual one first
  unsigned Reads;                   ///< bits of FileContent; 0: it is not read
  unsigned Writes;                  ///< bits of FileContent; 0: it is not written
};

/// Every format that is read or written, no ending twice: what the program, readers, writers and
/// messages know of endings, they know from here.
const std::vector<FileFormat>& FileFormats();

/// The format of an ending as LowerEnding gives it.
/// @return null: there is none.
const FileFormat* FormatOfEnding(const std::string& ending);

/// Whether an ending is one of a family.
bool IsEndingOf(FormatFamily family, const std::string& ending);

/// Whether VTK's own readers and writers serve a family.
bool IsOfVTK(FormatFamily family);

/// Endings of all formats that read, or write, any content of these, in the order of the table.
std::vector<std::string> EndingsThatRead(unsigned contents);
std::vector<std::string> EndingsThatWrite(unsigned contents);
/// Endings of families, in the order of the table.
std::vector<std::string> EndingsOf(const std::vector<FormatFamily>& families);

/// Endings of a list in one text.
std::string JoinEndings(const std::vector<std::string>& endings, const std::string& between = " ");

/// All contents.
constexpr unsigned AnyContent = ~0U;
}
