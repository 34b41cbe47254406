// SPDX-License-Identifier: BSD-3-Clause
// Grids and collections of grids alike: what filters need besides decoding and encoding.
#pragma once
#include <knotwork/SplineGrid/SplineModel.h>

#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <functional>
#include <map>

class vtkDataSet;

namespace knotwork
{
/// The grids of a dataset by block, cells numbered as SplinePatch::Cells: the pieces of a block
/// are appended. A vtkUnstructuredGrid is block 0.
VTKKNOTWORKSPLINEGRID_EXPORT std::map<int, vtkSmartPointer<vtkUnstructuredGrid>> GridsByBlock(
  vtkDataObject* data);

/// Whether a grid has Bezier curves, quadrilaterals and hexahedra alone, and such cells at all;
/// true of a collection.
VTKKNOTWORKSPLINEGRID_EXPORT bool HoldsSplines(vtkDataObject* data);

/// Fills a dataset from the patches of one block; source holds their cells.
using BlockMaker = std::function<Status(const std::vector<const SplinePatch*>& patches,
  vtkUnstructuredGrid* source, vtkDataSet* dataSet)>;

/// Calls make for every block of the model. A dataset as output is filled itself; in a
/// vtkPartitionedDataSetCollection every block becomes a new dataset of class `type` in the
/// structure of the input.
VTKKNOTWORKSPLINEGRID_EXPORT Status MakeByBlock(const SplineModel& model, vtkDataObject* input,
  vtkDataObject* output, int type, const BlockMaker& make);
}
