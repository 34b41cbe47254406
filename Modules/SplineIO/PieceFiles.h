// SPDX-License-Identifier: BSD-3-Clause
// VTK's files in pieces, .pvtu and .pvtp: an index that names .vtu or .vtp files.
#pragma once
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineCore/Status.h>

#include <vtkSmartPointer.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

class vtkDataObject;
class vtkDataSet;
class vtkUnstructuredGrid;

namespace knotwork
{
/// Whether the ending is one of an index of pieces.
VTKKNOTWORKSPLINEIO_EXPORT bool IsPieceIndex(const std::string& file);

/// The files that an index names, as they are found from where the index stands.
/// @return FileError; InvalidFormat: no such index, or one that names nothing or other files.
VTKKNOTWORKSPLINEIO_EXPORT Result<std::vector<std::filesystem::path>> ReadPieceIndex(
  const std::string& file);

/// Reads pieces [begin, end) of an index, end at most their number, as one data set, see
/// JoinPieces; an empty one where there are none.
/// @return failures of ReadPieceIndex, ReadVTKFile and JoinPieces.
VTKKNOTWORKSPLINEIO_EXPORT Result<vtkSmartPointer<vtkDataObject>> ReadPieces(
  const std::string& file, std::size_t begin = 0, std::size_t end = static_cast<std::size_t>(-1));

/// Grids or polygons one after the other. Patches of splines become those of one spline grid, with
/// the interfaces that are stated between them; where two have one number, those between patches of
/// different pieces are lost. Points of different pieces are not united. Arrays that not all have
/// are left out.
/// @return failures of DecodeSplineModel and EncodeSplineGrid.
VTKKNOTWORKSPLINEIO_EXPORT Result<vtkSmartPointer<vtkDataObject>> JoinPieces(
  const std::vector<vtkSmartPointer<vtkDataObject>>& pieces);

/// Writes a piece of a staged index, by its number, into the index's folder, which is made where
/// it is not there. Points that no cell has are left out.
/// @param threads  that compress; 0: all cores.
/// @return FileError; LibraryError.
VTKKNOTWORKSPLINEIO_EXPORT Status WritePiece(vtkDataSet* piece, std::size_t number,
  const std::string& index, const std::string& encoding, int threads = 0);

/// Writes the index of the pieces of these numbers.
/// @param like  a piece, for the names of the arrays.
VTKKNOTWORKSPLINEIO_EXPORT Status WritePieceIndex(
  vtkDataSet* like, const std::vector<std::size_t>& numbers, const std::string& index);

/// Divides a grid into parts of as many cells as can be, patches of splines whole, with what
/// concerns these in the field data. Points have global ids.
VTKKNOTWORKSPLINEIO_EXPORT std::vector<vtkSmartPointer<vtkUnstructuredGrid>> DivideGrid(
  vtkUnstructuredGrid* grid, std::size_t count);

/// Cells [begin, end) of a grid with all of its points, whose global ids begin with `firstPoint`
/// where they have none.
VTKKNOTWORKSPLINEIO_EXPORT vtkSmartPointer<vtkUnstructuredGrid> CellRange(
  vtkUnstructuredGrid* grid, std::size_t begin, std::size_t end, std::size_t firstPoint = 0);
}
