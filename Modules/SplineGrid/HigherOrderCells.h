// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkSplineGridModule.h" // for export macro
#include <knotwork/SplineCore/BernsteinCells.h>

#include <vector>

namespace knotwork
{
/// Number of the coefficient (CellCoefficient) of every point of VTK's Lagrange and Bezier cells of
/// a shape with one degree in all directions.
VTKKNOTWORKSPLINEGRID_EXPORT std::vector<int> HigherOrderPointOrder(CellShape shape, int degree);

/// VTK's type of such cells.
VTKKNOTWORKSPLINEGRID_EXPORT int HigherOrderCellType(CellShape shape, bool isBezier);
}
