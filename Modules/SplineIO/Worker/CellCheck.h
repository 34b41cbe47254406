// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

class vtkDataObject;

namespace knotwork
{
/// Whether the cells of a grid, polydata or collection of them have points that are there: VTK's
/// readers do not look, and what works on such cells crashes.
/// @return InvalidTopology. @complexity linear
Status CheckCells(vtkDataObject* data);
}
