// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/CADModel/CADModify.h>

#include <functional>

namespace knotwork
{
/// ModifyCAD in a process of its own with limits of memory and time, as OpenCASCADE does not
/// survive all that solids can be. Curves of operations are of tensor kind.
/// @param goOn  asked about ten times a second; false ends the work.
/// @return failures of ModifyCAD; LibraryError: it crashed, or there is no such program or no
/// process; NotConverged: it did not end in time; TooLarge: it asked for too much memory; Aborted.
VTKKNOTWORKSPLINEIO_EXPORT Result<std::vector<CADStep>> ModifyCADInProcess(const std::string& file,
  const std::string& output, const std::vector<CADOperation>& operations,
  const CADModifyParams& params = {}, const std::function<bool()>& goOn = {});
}
