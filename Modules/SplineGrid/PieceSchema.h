// SPDX-License-Identifier: BSD-3-Clause
// The field data of spline grids that are divided into pieces, patches whole, and put together.
#pragma once
#include "vtkKnotworkSplineGridModule.h" // for export macro
#include <knotwork/SplineCore/MultiPatch.h>

#include "vtkSmartPointer.h"

#include <map>
#include <utility>
#include <vector>

class vtkFieldData;
class vtkUnstructuredGrid;

namespace knotwork
{
/// Leaves in the field data of pieces what concerns the patches of which they have cells, and their
/// interfaces with others. Field data that cannot be read, and pieces with patches that others
/// define, stay as they are.
/// @param whole  the grid that the pieces are of.
VTKKNOTWORKSPLINEGRID_EXPORT void KeepOwnPatches(
  vtkUnstructuredGrid* whole, const std::vector<vtkSmartPointer<vtkUnstructuredGrid>>& pieces);

/// What pieces state of the sides of their patches, also of interfaces between patches of different
/// pieces; each once.
/// @param patches  by PatchId, which no two of them have in common: index and number of parameters.
VTKKNOTWORKSPLINEGRID_EXPORT PatchTopology JoinTopologies(
  const std::vector<vtkFieldData*>& pieces, const std::map<int, std::pair<int, int>>& patches);
}
