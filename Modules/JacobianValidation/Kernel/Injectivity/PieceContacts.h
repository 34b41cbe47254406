// SPDX-License-Identifier: BSD-3-Clause
// What two pieces of sides have in common; private to the separation of sides.
#pragma once
#include "SideSeparation.h"

namespace knotwork
{
/// What two pieces share.
struct PieceRelation
{
  enum Kind
  {
    None,
    Same,
    Corner,
    Edge,
    Mixed
  } What = None;
  int A = -1;
  int B = -1;
  bool Reversed = false;
  /// Mixed: both have a part of an edge in common that is longer in one of them (0 or 1), and that
  /// edge of it. Cut to the common part, it is one edge.
  int Longer = -1;
  int LongerEdge = -1;
};

/// By the places of pieces on their sides, and the contacts of these.
class PieceContacts
{
public:
  /// Sides a and b. @param lattices  theirs.
  PieceContacts(
    const SeparationInput& input, int a, int b, const std::array<const CellLattice*, 2>& lattices);

  /// Of two pieces, one of side a and one of side b.
  PieceRelation Relate(const CellPiece& a, const CellPiece& b) const;
  /// Of a piece of a side that is both, with itself.
  PieceRelation RelateToItself(const CellPiece& a) const;

private:
  struct Shared
  {
    PieceRelation::Kind What;
    int A;
    int B;
    bool Reversed;
    double Ratio = 1.0; ///< of the lengths of the edges that have a part in common
  };

  /// The first corner of a piece on a collapsed edge of its side that also holds the given one: all
  /// of them are one point. Otherwise the corner itself.
  int FirstOnPole(int k, const CellPiece& piece, int corner) const;
  const BoundarySide& SideOf(int k) const;
  /// Whether a piece has a corner of its side, or a point of a collapsed edge that is that corner.
  bool HasCorner(int k, const CellPiece& piece, int sideCorner, int& corner) const;
  void AddContacts(const CellPiece& a, const CellPiece& b, std::vector<Shared>& shared) const;
  /// Pieces of one side by their place in its parameters. Bisection keeps them convex, and apart
  /// but for their boundary.
  void AddNeighbours(const CellPiece& a, const CellPiece& b, std::vector<Shared>& shared) const;
  PieceRelation Reduce(
    const CellPiece& a, const CellPiece& b, const std::vector<Shared>& shared) const;
  PieceRelation OwnContacts(const CellPiece& a, const CellPiece& b, bool contactsOnly) const;

  const SeparationInput& Input;
  int SideA;
  int SideB;
  std::vector<SideContact> Contacts;
  std::array<const CellLattice*, 2> Lattice;
};
}
