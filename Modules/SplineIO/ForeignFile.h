// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/CADModel/CADExchange.h>

#include <vtkSmartPointer.h>

#include <string>

class vtkDataObject;

namespace knotwork
{
/// Reads a file of VTK's formats by VTK's readers, which crash or never end on some damaged files,
/// in a process of its own with limits of memory and time.
/// @return InvalidTopology: it is damaged; further as ReadInProcess. Messages name the file.
VTKKNOTWORKSPLINEIO_EXPORT Result<vtkSmartPointer<vtkDataObject>> ReadVTKFile(
  const std::string& file);

/// ReadCAD in a process of its own likewise, as OpenCASCADE does not survive some damaged files.
/// Edges and vertices are numbered in the order of their first use.
/// @return failures of ReadCAD and ReadInProcess.
VTKKNOTWORKSPLINEIO_EXPORT Result<CADContents> ReadCADInProcess(
  const std::string& file, const CADReadParams& params = {});
}
