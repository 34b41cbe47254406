// SPDX-License-Identifier: BSD-3-Clause
// Charts of pieces of sides with a collapsed edge; private to the separation of sides.
#pragma once
#include "SidePieces.h"

namespace knotwork
{
/// A quadrilateral whose edge t = 0 is one point P, seen with s from corner From to corner To of
/// that edge. Of two such pieces the first corners are on their common edge.
struct PolarPiece
{
  const CellLattice* Lattice;
  const BoundaryPiece* Piece;
  int From;
  int To;
};

/// Half of a quadrilateral piece S.
struct PieceHalf
{
  CellLattice Lattice;
  BoundaryPiece Piece;
};

/// The half between the edge from the apex to the corner `along` and the diagonal, as the piece
/// S(t, s t): s from that edge to the diagonal, t from the apex, which is the edge t = 0.
/// Coefficients are means of those of S: B_j^q(s t) = sum over m of B_m^q(t) times the polynomial
/// with the coefficients C(m, j) C(q - m, a - j) / C(q, a).
PieceHalf MakeHalf(const PieceMeasures& measures, const CellLattice& lattice,
  const BoundaryPiece& node, int apex, int along);

/// S - P = t R. The chart is (beta R / alpha R, alpha (S - P)): a projective one, regular at P.
bool HavePolarChart(const PieceMeasures& measures, const std::vector<PolarPiece>& pieces);
}
