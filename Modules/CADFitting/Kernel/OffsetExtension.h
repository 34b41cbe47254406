// SPDX-License-Identifier: BSD-3-Clause
// Points inside that follow those of the boundary, private to the kernel.
#pragma once
#include "NodeLattice.h"

namespace knotwork
{
/// Moves points so that their ways are discrete harmonic functions of the lattice's steps, each of
/// which weighs as its element's box over the square of its length.
/// @param straight  points before. @param elements  around the free points, ascending.
/// @param isFree  one a point. @param ways  of all points; gets those of the free ones.
/// @return SingularSystem for free points that hang together with no other.
Status ExtendWays(const NodeLattice& lattice, const PointMatrix& straight,
  const std::vector<int>& elements, const std::vector<char>& isFree, PointMatrix& ways);

/// Elements within so many rings of some, by common corners; ascending.
std::vector<int> RingsOf(const NodeLattice& lattice, const std::vector<int>& elements, int rings);
}
