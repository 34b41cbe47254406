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
/// A data set, table or vtkPartitionedDataSetCollection for another process, exact: grids and
/// polydata as the bytes of their arrays, what has more to it than bytes as VTK's XML.
VTKKNOTWORKSPLINEIO_EXPORT void AppendParts(vtkDataObject* data, std::vector<std::string>& parts);

/// Takes a data object from the parts at `next`, which goes on.
/// @return null where the parts do not hold one.
VTKKNOTWORKSPLINEIO_EXPORT vtkSmartPointer<vtkDataObject> TakeData(
  std::vector<std::string>& parts, std::size_t& next);
}
