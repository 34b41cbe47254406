// SPDX-License-Identifier: BSD-3-Clause
// Pieces of sides seen in a plane; private to the separation of sides.
#pragma once
#include "SidePieces.h"

namespace knotwork
{
/// A piece of a disk that is projected to a plane.
struct DiskFacet
{
  const CellLattice* Lattice; ///< of its side
  const BoundaryPiece* Piece;
  int Edge;                ///< that it shares with the other one, or -1
  std::array<int, 2> Ends; ///< corners of that edge, in an order that both have in common
};

/// One piece, or two with a common edge unfolded to one disk, are projected to a plane where
/// - the Jacobian is positive inside of the pieces (it may vanish on their edges), and
/// - the outline, the edges but the common one, is a simple closed curve.
/// The degree of such a map of a disk is 1 inside of the outline's image and 0 outside, so almost
/// every point has one preimage inside of the pieces at most. The map is open there, so no two
/// points inside have one image, nor one inside and one on the outline, which is a limit of
/// points inside; on the outline it is one-to-one. One piece is one-to-one so, and two meet in
/// their common edge only. What holds of the projection holds of the pieces.
bool HaveOutline(const PieceMeasures& measures, const std::vector<DiskFacet>& facets);
}
