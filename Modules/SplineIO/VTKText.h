// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <string>

class vtkDataObject;

namespace knotwork
{
/// Writes a dataset as .vtu, .vtp or .vti, or a collection of grids and polygons as .vtpc, whose
/// pieces are files in a folder of its name that is not there yet.
/// @param encoding  of numbers: ascii, binary (base64 within the elements) or appended.
/// @param threads  that compress; 0: all cores. The bytes do not depend on it.
/// @return FileError; LibraryError without a text: VTK has said why.
Status WriteVTKFile(
  vtkDataObject* data, const std::string& file, const std::string& encoding, int threads = 0);

/// A vtkTable as comma-separated values.
std::string TextOfTable(vtkDataObject* table);
}
