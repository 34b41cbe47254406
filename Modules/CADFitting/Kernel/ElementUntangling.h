// SPDX-License-Identifier: BSD-3-Clause
// Points inside that move until elements of volumes have the shapes of straight ones, private to
// the kernel.
#pragma once
#include "NodeLattice.h"

namespace knotwork
{
/// det J of a straight element that counts as its own: the least at its corners.
double CornerDeterminant(const NodeLattice& lattice, const PointMatrix& straight, int element);

/// Minimizes, over samples of some elements, |T|^2 / c^(2/3) + (d^2 + 1) / c of the map T from the
/// straight element to the curved one, with d = det T and c = (d + sqrt(e^2 + d^2)) / 2, for
/// smaller and smaller e: elements that are folded unfold, and all keep shape and size where they
/// can.
/// @param elements  of volumes, which hold all elements of the free points. @param straight  points
/// of valid straight elements. @param isFree  one a point. @param points  start; the free ones
/// move.
/// @param threads  0 = all cores; the result does not depend on it.
/// @return Aborted.
/// @source  Garanzha, Kaporin, Kudryavtseva, Protais, Ray, Sokolov, Foldover-free maps in 50 lines
/// of code, ACM TOG 40 (2021) 102.
Status UntangleInside(const NodeLattice& lattice, const std::vector<int>& elements,
  const PointMatrix& straight, const std::vector<char>& isFree, int threads,
  const ProgressCallback& progress, PointMatrix& points);
}
