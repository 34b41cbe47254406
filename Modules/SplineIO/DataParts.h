// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineCore/Status.h>

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkDataObject;

namespace knotwork
{
/// A data set, table or vtkPartitionedDataSetCollection for another process: exact, as VTK's XML
/// with raw numbers.
VTKKNOTWORKSPLINEIO_EXPORT void AppendParts(vtkDataObject* data, std::vector<std::string>& parts);

/// Takes a data object from the parts at `next`, which goes on.
/// @return null where the parts do not hold one that VTK reads again.
VTKKNOTWORKSPLINEIO_EXPORT vtkSmartPointer<vtkDataObject> TakeData(
  std::vector<std::string>& parts, std::size_t& next);
}
