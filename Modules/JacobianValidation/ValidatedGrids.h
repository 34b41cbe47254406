// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CellsFromGrid.h"
#include "ValidationPieces.h"

#include <map>
#include <utility>

class vtkDataObject;

/// The grids of an input, whose cells are numbered through all of them.
namespace knotwork
{
/// A grid of the input and the one of the output that it becomes.
struct GridPair
{
  vtkUnstructuredGrid* Input = nullptr;
  vtkUnstructuredGrid* Output = nullptr;
  int Block = 0;
  std::size_t FirstCell = 0; ///< of the certificate
};

/// The grids of the input, with their blocks.
std::vector<std::pair<int, vtkUnstructuredGrid*>> GridsOf(vtkDataObject* input);

/// Output 0 as a shallow copy of the input; its grids become the outputs of the pairs.
void CopyInput(vtkDataObject* input, vtkDataObject* output, std::vector<GridPair>& pairs);

/// The grid of a cell of the certificate.
const GridPair& OwnerOf(const std::vector<GridPair>& grids, std::size_t cell);

/// Value of the cell array PatchId, 0 without one.
int PatchOf(vtkUnstructuredGrid* grid, vtkIdType cell);

/// Whether all grids have a cell array.
bool HaveCellArray(const std::vector<GridPair>& grids, const char* name);

/// How the cells of the grids fit together.
/// @param isPiece  points are known by their global ids alone.
CellComplex ComplexOf(const GridCells& cells, const std::vector<GridPair>& grids, bool isPiece);

/// By what the cells of grids are called; the arguments are kept by reference.
/// @param before  cells of their blocks in pieces before these grids.
CellNames NamesOf(const std::vector<GridPair>& grids, const std::map<int, vtkIdType>& before);
}
