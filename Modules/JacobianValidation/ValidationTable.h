// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ValidatedGrids.h"
#include <knotwork/JacobianValidation/CellMeasures.h>

class vtkTable;

/// Output 2: a row a patch, and one of all.
namespace knotwork
{
/// All but what is known of the map as a whole; nothing when there are no cells.
/// @param before    cells of the blocks in pieces before the grids.
/// @param measured  one a cell, or empty.
void FillTable(const std::vector<GridPair>& grids, const std::map<int, vtkIdType>& before,
  const std::vector<CellCertificate>& certificates, const std::vector<CellMeasure>& measured,
  vtkTable* table);

/// The tables of pieces become that of all.
/// @pre all processes call it. @return the verdict over all.
Verdict MergePieces(vtkTable* table);

/// Columns that only the last row has.
/// @param applicable  whether there are maps.
void FillInjectivity(const InjectivityCertificate& injectivity, bool applicable, vtkTable* table);
}
