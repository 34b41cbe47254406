// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/FitAnalyticSurface.h>

#include <array>

namespace knotwork
{
/// The surface of extrusion or of revolution next to points: its axis by the pieces' normals, then
/// by turns its profile, a quintic spline by least squares of as few spans as it takes, and the
/// axis by Gauss-Newton steps. The profile is some percent longer than the points at both ends.
/// @param edges  pairs of neighbouring points, which say along which way the profile runs: lengths
/// of shortest paths over them, seen along the axis, are its first parameters. Those of `straight`,
/// a flag an edge, lie on the surface, too: the profile does not bulge between their ends.
/// @param near  a largest distance of points with which no more spans are tried, unit of the
/// points; what is 128 times as far at first is given up.
/// @param surface  one of the type already: its axis comes first. Result; unchanged on failure.
/// @return false: the type has no profile; the points hang not together; too few of them, a
/// profile that closes or folds, or a flat one; a revolution that reaches its axis.
/// @complexity O(n log n) for n points and edges, at most 8 turns.
/// @source Pottmann, Randrup, Computing 60 (1998) 307 (axes as linear complexes).
bool FitProfileSurface(SurfaceType type, const std::vector<Eigen::Vector3d>& points,
  const std::vector<std::array<int, 2>>& edges, const std::vector<char>& straight,
  const std::vector<FlatPiece>& pieces, double near, AnalyticSurface& surface);
}
