// SPDX-License-Identifier: BSD-3-Clause
// Certified hexahedra as VTK's data.
#pragma once
#include <knotwork/CADMeshing/HexahedronQuality.h>

class vtkTable;
class vtkUnstructuredGrid;

namespace knotwork
{
/// Points and cells, with the cell arrays ScaledJacobian and Verdict.
void EncodeHexahedra(const CellMesh<3>& mesh, const PointMatrix& points,
  const HexahedronQuality& quality, vtkUnstructuredGrid* output);

/// Columns Verdict, ValidCells, ReversedCells, InvalidCells, UndecidedCells, MinJacobianLower,
/// LeastScaledJacobian and Volume.
void AddHexahedronColumns(const HexahedronQuality& quality, vtkTable* table);
}
