// SPDX-License-Identifier: BSD-3-Clause
// Planes between pieces of sides; private to the separation of sides.
#pragma once
#include "SidePieces.h"

namespace knotwork
{
/// A piece seen from one of its corners.
struct PieceCone
{
  const CellLattice* Lattice;
  const BoundaryPiece* Piece;
  int Corner;
};

/// A plane between two pieces, wherever their corners are.
bool HullsApart(const PieceMeasures& measures, const PieceCone& first, const PieceCone& second);

/// A plane through the common corner with one piece on either side: the pieces meet there only.
bool ConesApart(const PieceMeasures& measures, const std::array<PieceCone, 2>& cones);
}
