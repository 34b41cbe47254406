// SPDX-License-Identifier: BSD-3-Clause
// Sides of a planar domain from lines that were drawn by hand.
#pragma once
#include <knotwork/SplineCore/Spline.h>
#include <knotwork/SplineCore/Status.h>

#include <string>
#include <vector>

namespace knotwork
{
struct OutlineParams
{
  double Tolerance = 2e-3;    ///< of curves from points, a share of the size; [1e-9, 0.1]
  double CornerAngle = 40.0;  ///< degrees a line turns at a corner, at least; [5, 170]
  double CornerWindow = 0.02; ///< share of a line's length that its directions are those of; [1e-4,
                              ///< 0.2]
  int NumSides = 4;           ///< of one closed line; 0: a side from every corner to the next
};

struct OutlineSides
{
  std::vector<Spline<1>> Sides; ///< control points n x 2; ends that meet are the same numbers
  int NumCorners = 0;           ///< that were found, at ends of sides and within
  int NumLines = 0;             ///< straight pieces
  int NumArcs = 0;              ///< pieces that are exact arcs of circles
  int NumCurves = 0;            ///< pieces that are fitted cubic splines
  double MaxDistance = 0.0;     ///< of the points from the curves, unit of the points
  std::vector<std::string> Messages;
};

/// Fits curves to polylines. Corners are where a line turns by CornerAngle between the chords over
/// CornerWindow before and behind a point, most nearby, and by half of that within a quarter of the
/// window, which bends do not. A closed line (its ends are at most 2 % of the size apart) is cut at
/// NumSides of its corners, the convex ones that turn most; where there are fewer, at places that
/// turn by half of the angle, and then the longest sides are halved, which a message tells. An open
/// line is a side;
/// ends of lines that near to each other are joined in their middle. Between corners a side is
/// straight, or an arc (rational, quadratic), or a cubic spline by least squares whose knots are
/// doubled until it is near enough; at corners within a side it is continuous.
///
/// @param lines  each n x 2, n >= 2, in drawing order.
/// @return NonFiniteInput, EmptyInput, SizeMismatch naming the line; InvalidParameter;
/// InvalidTopology: an open line alone, an end that meets no other, or neither one closed line nor
/// NumSides open ones; NotConverged: a piece that 512 spans do not fit.
/// @complexity n log n for corners; n k^2 for a piece of k spans
/// @source Piegl and Tiller, The NURBS Book, 9.4; Hoschek (1988), parameter correction.
Result<OutlineSides> FitOutline(
  const std::vector<PointMatrix>& lines, const OutlineParams& params = {});
}
