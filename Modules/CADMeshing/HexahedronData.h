// SPDX-License-Identifier: BSD-3-Clause
// Certified hexahedra as VTK's data.
#pragma once
#include <knotwork/CADMeshing/HexahedronQuality.h>

#include <string>
#include <vector>

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

/// A sentence for folded hexahedra (invalid or reversed ones) and one for undecided ones, with the
/// first cell of either; none where all are valid.
/// @param remedy  what the user may do, behind a semicolon.
std::vector<std::string> HexahedronWarnings(
  const HexahedronQuality& quality, const std::string& remedy);
}
