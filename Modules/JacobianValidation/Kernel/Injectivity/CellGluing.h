// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "BoundaryInjectivity.h"
#include "CellPieces.h"
#include "SideContacts.h"

/// Private to the injectivity proof: which sides of cells are glued.
namespace knotwork
{
struct CellGluing
{
  std::vector<BoundarySide> Boundary;
  int NumComponents = 0;
  int NumInterfaces = 0;
  int NumSeams = 0;
  int NumCollapsed = 0;
  int NumTouching = 0;
  double InnerRounding = 0.0;
  /// The first of each kind, if any: cell and side.
  std::array<int, 4> Folded{ -1, -1, -1, -1 }; ///< cell, side, cell, side
  std::array<int, 2> Partial{ -1, -1 };
  std::array<int, 2> Open{ -1, -1 };
  std::array<int, 4> Torn{ -1, -1, -1, -1 }; ///< inner sides that differ by more than allowed
  double TornSize = 0.0;
  /// The first edge of a solid, if any, that is one point though all sides around it are glued:
  /// cell and two of its corners.
  std::array<int, 3> InnerPoint{ -1, -1, -1 };
};

/// @param signs  1 or -1 a cell: of det J.
CellGluing GlueCells(const BernsteinCells& cells, const CellComplex& complex,
  const std::vector<int>& signs, const InjectivityParams& params);
}
