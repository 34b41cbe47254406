// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ValidationPieces.h"

class vtkUnstructuredGrid;

/// Output 1: where cells are folded, and where the map overlaps; both add to what is there.
namespace knotwork
{
/// A point and a box of every invalid cell.
void ShowFolds(const BernsteinCells& cells, const CellNames& names,
  const std::vector<JacobianWitness>& witnesses, vtkUnstructuredGrid* output);

/// Both points of an overlap, if one is proved.
void ShowOverlap(const BernsteinCells& cells, const CellNames& names,
  const std::vector<CellCertificate>& certificates, const InjectivityCertificate& injectivity,
  vtkUnstructuredGrid* output);
}
