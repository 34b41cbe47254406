// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineCore/Status.h>

#include <vtkSmartPointer.h>

#include <cstddef>
#include <string>
#include <vector>

class vtkDataObject;

namespace knotwork
{
/// What was read from a file.
struct DataFile
{
  vtkSmartPointer<vtkDataObject> Data;
  /// Trimming curves of STEP and IGES, boundary curves of g2; null without any.
  vtkSmartPointer<vtkDataObject> Curves;
  std::vector<std::string> LeftOut;  ///< parts that the reader left out, one sentence each
  std::vector<std::string> Warnings; ///< one line each
};

/// Reads a file by the ending of its name (the table of FileFormats.h). Meshes and points become
/// polydata, splines spline grids. VTK's and CAD files are read in a process of their own, which
/// damaged ones may crash.
/// @return FileError, InvalidParameter (no such format), EmptyInput, failures of the readers and of
/// CheckData; the file is named.
VTKKNOTWORKSPLINEIO_EXPORT Result<DataFile> ReadDataFile(const std::string& file);

/// The part of a file in pieces (.pvtu, .pvtp) that a process of several works on: as many pieces
/// as others have, which may be none. Otherwise as ReadDataFile.
VTKKNOTWORKSPLINEIO_EXPORT Result<DataFile> ReadDataPieces(const std::string& file);

/// Reads a file of rows as a vtkTable: .csv and .txt whose first line names the columns above the
/// numbers. Other files as ReadDataFile.
VTKKNOTWORKSPLINEIO_EXPORT Result<DataFile> ReadTableFile(const std::string& file);

struct DataFileParams
{
  /// What trims the faces of STEP and IGES, what bounds the surfaces of g2; null: nothing.
  vtkDataObject* Curves = nullptr;
  /// Of numbers in VTK's formats: ascii, binary or appended. Debian's ParaView 5.11 with the
  /// present libexpat cannot read appended data.
  std::string Encoding = "binary";
  /// Parts that a .pvtu gets; patches of splines stay whole.
  std::size_t Pieces = 1;
  int Threads = 0; ///< that compress; 0: all cores
};

/// Writes data by the ending of the name. Of a .vtpc the folder of its pieces must not be there
/// yet: OutputFiles stages files that replace others.
/// @return warnings, one line each; failures of CheckDataFormat and of the writers.
VTKKNOTWORKSPLINEIO_EXPORT Result<std::vector<std::string>> WriteDataFile(
  vtkDataObject* data, const std::string& file, const DataFileParams& params = {});

/// Whether data of this class can be written in the format that the ending says.
/// @return InvalidParameter with the endings that can be written.
VTKKNOTWORKSPLINEIO_EXPORT Status CheckDataEnding(vtkDataObject* like, const std::string& file);

/// Whether data of this class and kind can be written in the format that the ending says: asked
/// before the work, with what the output will be like.
/// @param asCurves  curves on the surfaces are written instead of them.
/// @param threads  for decoding the splines; 0: all cores.
/// @return InvalidParameter.
VTKKNOTWORKSPLINEIO_EXPORT Status CheckDataFormat(
  vtkDataObject* like, const std::string& file, bool asCurves = false, int threads = 0);
}
