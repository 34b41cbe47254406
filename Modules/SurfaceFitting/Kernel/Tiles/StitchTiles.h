// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/MultiPatch.h>

namespace knotwork
{
/// How tiles know their neighbours.
enum class TileMatching
{
  Domain,   ///< boxes of one parameter plane that share an edge or a part of one: height fields
  Geometry, ///< sides that begin, end and have their middle at the same points
  Pairs     ///< StitchParams::Pairs
};

struct StitchParams
{
  int Continuity = 1; ///< 0 or 1
  TileMatching Matching = TileMatching::Domain;
  std::vector<PatchInterface> Pairs;
  /// What counts as the same place, in (0, 0.1]: relative to the shortest side of a domain
  /// (Domain), to the longest edge of the box around all control points (Geometry).
  double Tolerance = 1e-6;
  /// The first components, which lengths of changes and jumps are about; 0: all of them. The
  /// others are stitched along.
  int NumMeasured = 0;
  int Threads = 0;
  ProgressCallback Progress;
};

/// A boundary that two tiles share, or the part that they share of it.
struct StitchedEdge
{
  PatchInterface Interface; ///< with the common part of each side, also when it is the whole
  /// Upper bounds, over the whole edge, of the distance between both sides' points, and between
  /// both sides' derivatives across the edge (with the first tile's parameter). Rounding of the
  /// coefficients included; at most a thousandth above the largest distance.
  double JumpBefore = 0.0;
  double Jump = 0.0;
  double SlopeJumpBefore = 0.0;
  double SlopeJump = 0.0;
};

struct StitchedTiles
{
  std::vector<Spline<2>> Tiles; ///< of kind LocallyRefined
  std::vector<StitchedEdge> Edges;
  int NumFunctionsAdded = 0;
  /// Largest distance between a control point of the refined tile and the same one afterwards.
  double MaxChange = 0.0;
  double MaxJumpBefore = 0.0;
  double MaxJump = 0.0;
  double MaxSlopeJumpBefore = 0.0;
  double MaxSlopeJump = 0.0;
};

/// Makes tiles that were fitted apart continuous (C0) or continuously differentiable (C1) across
/// their common boundaries.
///
/// Every tile becomes an LR spline. Along a common boundary both sides get each other's knot lines,
/// just as long as the functions reach that are alive there (C1: one line along the whole boundary
/// first, the innermost that is there already), so that the functions on the boundary, and for C1
/// those next to it, are a univariate B-spline basis, the same on both sides. Then the coefficients
/// on the boundary are averaged (C0); for C1 so are the derivatives across it, which puts both rows
/// of coefficients on lines, in the ratio of the knot spans. Where boundaries meet, value, both
/// derivatives and the mixed one are averaged over all tiles there. A boundary may end in the
/// middle of a neighbour's side (T-junction): the neighbour gets a knot there that leaves it C1.
///
/// Outside the supports of those functions, a knot span (C0) or two (C1) from the boundary, the
/// tiles stay what they are. The result is exact: what is left of the jumps is rounding.
///
/// Tiles paired by sides are stitched with respect to their own parameters, those of the second
/// tile multiplied by the ratio of the sides' lengths in parameters.
/// @return EmptyInput; Spline::Check's codes naming the tile; SizeMismatch (components);
/// InvalidWeight for rational tiles that share an edge; InvalidDegree when degrees along a boundary
/// differ, or are below 2 for C1; InvalidKnots for knots closer than can be told apart (2e-12 of a
/// side); InvalidParameter; InvalidTopology: domains that overlap, several
/// tiles of which no two share an edge, a side in two pairs, C1 where other than four tiles meet
/// around a point; Aborted; what MakeLocallyRefined returns.
/// @complexity a few insertions a knot on a boundary and an assembly of every tile's space. Tiles
/// that are moved in are let go one by one, so their memory is not needed twice.
Result<StitchedTiles> StitchTiles(std::vector<Spline<2>> tiles, const StitchParams& params);
}
