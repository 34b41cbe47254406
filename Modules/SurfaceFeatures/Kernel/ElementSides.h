// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/PatchSides.h>

/// Private to the contours: where the elements of a surface meet.
namespace knotwork
{
/// Of an element, numbered as in PatchSides.h.
inline constexpr int NumSides = 4;

/// A piece of a side that has one neighbour all along: whole sides, or what a hanging corner of a
/// neighbour leaves of them.
struct SidePiece
{
  std::array<int, 2> Element{ -1, -1 }; ///< the second is -1 on the boundary and at a jump
  IntArray<2> Side{};
  /// Ends of the piece as local parameters along the sides; where the sides run in opposite
  /// directions, the second's descend.
  RealArray<2> Begin{};
  RealArray<2> End{ 1.0, 1.0 };
  IntArray<2> Vertex{}; ///< at the beginning and at the end
  bool Seam = false;    ///< joins opposite sides of the domain
};

/// A corner where elements meet that are continuous there; given as one of its places.
struct SideVertex
{
  int Element = -1;
  RealArray<2> Local{};
};

struct ElementSides
{
  std::vector<SidePiece> Pieces;
  std::vector<SideVertex> Vertices;
  /// Pieces of side s of element e, ascending along the side:
  /// PieceIds[Start[4 e + s] ... Start[4 e + s + 1]).
  std::vector<std::size_t> Start;
  std::vector<int> PieceIds;
  std::vector<int> Corners; ///< 4 an element: vertices
  double LargestGap = 0.0;  ///< of the values of neighbours that count as equal

  /// Which of the piece's two sides this one is.
  int Role(int piece, int element, int side) const
  {
    const SidePiece& p = this->Pieces[static_cast<std::size_t>(piece)];
    return p.Element[0] == element && p.Side[0] == side ? 0 : 1;
  }
};

/// Place of coefficient k of a side in the block of an element.
inline int SideCoefficient(const IntArray<2>& degree, int side, int k)
{
  const int end = side % 2;
  return side < 2 ? k * (degree[0] + 1) + end * degree[0] : end * degree[1] * (degree[0] + 1) + k;
}

/// Neighbours by the boxes of the domain (hanging corners allowed), or without a domain by the ids
/// of the functions of whole sides; sides of three or more elements have no neighbours.
///
/// Neighbours whose values of the component differ by more than 1e-9 of their coefficients are a
/// jump: both sides become boundary. Opposite sides of the domain whose other components (at least
/// one) agree as well are neighbours too when seams is set.
/// @complexity O(n log n).
ElementSides FindElementSides(const BezierForm<2>& form, int component, bool seams, int threads);
}
