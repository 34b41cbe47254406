// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkSplineGridModule.h" // for export macro
#include <knotwork/SplineCore/Status.h>

#include <string>

class vtkDataSet;

namespace knotwork
{
/// Polygons and strips of polydata have three corners or more, polylines two: VTK's own questions
/// after a cell crash on others. Datasets of other kinds pass.
/// @return InvalidTopology naming the cell.
VTKKNOTWORKSPLINEGRID_EXPORT Status CheckCellSizes(vtkDataSet* data);

/// Points that are to be taken for points of a shape do not belong to Bezier cells: those are
/// control points, which lie beside it.
/// @param name  of the input in the message.
/// @return InvalidParameter that says how points are made of a spline.
VTKKNOTWORKSPLINEGRID_EXPORT Status CheckSampledPoints(vtkDataSet* data, const std::string& name);
}
