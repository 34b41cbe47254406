// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineCore/Status.h>

#include <string>
#include <vector>

class vtkDataObject;

namespace knotwork
{
struct DataFile;
struct DataFileParams;

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
  GridContent = 1U << 11,             ///< any cells of one grid
  ImageContent = 1U << 12,            ///< values on a raster
  TableContent = 1U << 13,            ///< rows of numbers and text
  SplineElementContent = 1U << 14,    ///< splines without knots: Bezier elements, operators
  HeightRasterContent = 1U << 15      ///< heights of surfaces on a raster, which has a cell size
};

struct FileFormat
{
  const char* Name;
  std::vector<std::string> Endings; ///< in lower case with their dot, the usual one first
  unsigned Reads;                   ///< bits of FileContent; 0: it is not read
  unsigned Writes;                  ///< bits of FileContent; 0: it is not written
  bool IsOfVTK;                     ///< served by VTK's own readers and writers
  /// Sets the data, the curves and what was left out. Without a text it has failed where there was
  /// an error of VTK, and the code is that error's. Null: it is not read.
  Status (*Read)(const std::string& file, DataFile& found);
  /// A failure without a text is an error of VTK. Null: it is not written.
  Status (*Write)(vtkDataObject* data, const std::string& file, const DataFileParams& params);
};

/// Every format that is read or written, no ending twice: what the program, readers, writers and
/// messages know of endings, they know from here.
VTKKNOTWORKSPLINEIO_EXPORT const std::vector<FileFormat>& FileFormats();

/// The format of an ending as LowerEnding gives it.
/// @return null: there is none.
VTKKNOTWORKSPLINEIO_EXPORT const FileFormat* FormatOfEnding(const std::string& ending);

/// Endings of all formats that read, or write, any content of these, in the order of the table.
VTKKNOTWORKSPLINEIO_EXPORT std::vector<std::string> EndingsThatRead(unsigned contents);
VTKKNOTWORKSPLINEIO_EXPORT std::vector<std::string> EndingsThatWrite(unsigned contents);

/// Endings of a list in one text.
VTKKNOTWORKSPLINEIO_EXPORT std::string JoinEndings(
  const std::vector<std::string>& endings, const std::string& between = " ");

/// " (did you mean '.step'?)" where an ending is no format's and a known one is near; else empty.
VTKKNOTWORKSPLINEIO_EXPORT std::string SuggestEnding(
  const std::string& ending, const std::vector<std::string>& known);

/// All contents.
constexpr unsigned AnyContent = ~0U;
}
