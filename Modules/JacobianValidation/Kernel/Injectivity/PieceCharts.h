// SPDX-License-Identifier: BSD-3-Clause
// That one piece of a side is one-to-one, or two with a common edge; private to the separation of
// sides.
#pragma once
#include "PieceContacts.h"
#include "SidePieces.h"

namespace knotwork
{
/// One piece: monotone after a linear projection, so one-to-one.
bool HasChart(const PieceMeasures& measures, const CellLattice& lattice, const BoundaryPiece& a);

/// Two pieces with a common edge: one chart over both, the second unfolded to the other side.
/// @param lattices  of a and b.
bool HaveChart(const PieceMeasures& measures, const std::array<const CellLattice*, 2>& lattices,
  const PieceRelation& relation, const BoundaryPiece& a, const BoundaryPiece& b);
}
