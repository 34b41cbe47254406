// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkJacobianValidationModule.h" // for export macro
#include <knotwork/SplineCore/BernsteinCells.h>

#include "vtkType.h"

#include <vector>

class vtkUnstructuredGrid;

namespace knotwork
{
/// The cells of grids in Bernstein form: those of the first grid in its order, then those of the
/// next.
struct GridCells
{
  BernsteinCells Cells; ///< three components; rational when one cell of the grid is
  /// Point (of its grid) of every coefficient, cell by cell, where a coefficient is a point (Bezier
  /// and linear cells); -1 where it is not.
  std::vector<vtkIdType> Points;
  std::vector<std::size_t> FirstPoint; ///< offset into Points of every cell
};

/// Bezier cells as they are, all other cells by exact change of basis, with the rounding of it in
/// BernsteinCells::Errors.
/// @return InvalidTopology (a cell type without Bernstein form), InvalidDegree, NonFiniteInput,
/// InvalidWeight; all name the cell, and the grid when there are several.
VTKKNOTWORKJACOBIANVALIDATION_EXPORT Result<GridCells> ReadGridCells(
  const std::vector<vtkUnstructuredGrid*>& grids);
}
