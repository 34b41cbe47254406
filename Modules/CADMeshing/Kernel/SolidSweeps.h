// SPDX-License-Identifier: BSD-3-Clause
// How solids can be swept: from which faces to which others, along which.
#pragma once
#include "CornerSolid.h"

#include <set>
#include <utility>

namespace knotwork
{
/// An edge inside of a target that is there because one inside of the source is.
struct EdgePair
{
  int Source = 0;
  int Target = 0;
};

/// One way to mesh a solid: swept, or a grid at each of its corners. Linking faces are logical
/// rectangles between the rims of source and target, or between those before and behind them.
struct SolidSweep
{
  int Body = 0;
  int Rank = 0;            ///< among the ways to mesh the body, SweepsOf
  std::vector<int> Source; ///< faces
  std::vector<int> Target;
  std::vector<int> Linking;
  std::vector<EqualChains> Equal; ///< besides opposite sides of the linking faces
  std::vector<EdgePair> Imprints; ///< all edges inside of the target, but seams
  PointMatrix Origin;             ///< places on the rim of the source, n x 3, and
  PointMatrix Arrival;            ///< where they come to
  bool Mirrored = false;          ///< imprints lie beyond the target's rim as before the source's
  bool BothWays = false;          ///< all edges inside of the source have a partner too
  bool IsBlock = false; ///< source and target are one rectangle each, with the same corners
  /// A grid at each corner: all faces link, and there are no ends.
  std::optional<CornerSolid> Corners;
  double Score = 0.0; ///< small ones are better: how far the rims are from an affine map
};

/// All ways to sweep a body, the best first, and behind them a grid at each of its corners.
/// @return InvalidTopology: a body that is no solid, or that cannot be swept, with the faces that
/// prevent it.
/// @complexity O(F E) with F faces and E edges.
Result<std::vector<SolidSweep>> SweepsOf(
  const CADTopology& model, const FaceMesher& faces, int body);

/// Body and rank of a way to mesh it.
using SweepNumber = std::pair<int, int>;

/// One sweep for every body, such that faces between bodies, which are grids where one of the two
/// links along them, suit both.
/// @param leftOut  ways that are not taken.
/// @return failures of SweepsOf; InvalidTopology: bodies whose sweeps do not suit each other.
/// @complexity that of SweepsOf for each body, and a search over the bodies' sweeps that stops
/// after 100,000 steps.
/// @source  White, Tautges, Int. J. Numer. Meth. Eng. 49 (2000) 127 (sources, targets and linking
/// faces found by angles and rectangles).
Result<std::vector<SolidSweep>> ChooseSweeps(
  const CADTopology& model, const FaceMesher& faces, const std::set<SweepNumber>& leftOut = {});

/// The sweep with source and target exchanged; of one that goes both ways.
SolidSweep Reversed(const SolidSweep& sweep);
}
