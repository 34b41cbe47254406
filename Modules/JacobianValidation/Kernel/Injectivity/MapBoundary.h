// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "BoundaryShift.h"
#include "CellGluing.h"

/// Private to the injectivity proof: what a map's cells leave unglued, and places on it.
namespace knotwork
{
/// Cells, and their boundary as cells of its own.
struct MapBoundary
{
  /// @param gluing  of the cells; its sides are moved to their middle.
  /// @param signs   of det J, one a cell.
  MapBoundary(
    const BernsteinCells& cells, CellGluing& gluing, const std::vector<int>& signs, int threads);

  const BoundarySide& Side(int i) const
  {
    return this->Gluing.Boundary[static_cast<std::size_t>(i)];
  }
  CellShape Shape(int cell) const { return this->Cells.Shapes[static_cast<std::size_t>(cell)]; }
  const CellLattice& LatticeOf(int cell) const
  {
    return this->Lattices.at(
      { static_cast<int>(this->Shape(cell)), this->Cells.Degrees[static_cast<std::size_t>(cell)] });
  }

  const BernsteinCells& Cells;
  const CellGluing& Gluing;
  BoundaryShift Shift;
  CellLatticeTable Lattices; ///< of the cells
  CellLatticeTable SideLattices;
  BernsteinCells SideCells;
  PointMatrix Lower; ///< boxes of the sides
  PointMatrix Upper;
  double ModelSize = 0.0;
  std::vector<char> StarShaped; ///< one a component of the boundary
};

/// Boxes of cells, n x d each.
void MakeBoxes(const BernsteinCells& cells, const CellLatticeTable& lattices, PointMatrix& lower,
  PointMatrix& upper, int threads);

InjectivityWitness::Place PlaceInCell(
  const BernsteinCells& cells, int cell, int side, const std::array<double, 3>& u);
/// @param s  parameters of the side.
InjectivityWitness::Place PlaceOnSide(
  const BernsteinCells& cells, const BoundarySide& side, const std::array<double, 3>& s);
/// @param cell  negative: none.
InjectivityWitness::Place MiddleOfSide(const BernsteinCells& cells, int cell, int number);
}
