// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ChartMesh.h"
#include "TrimmedModel.h"

namespace knotwork
{
enum class LoopVerdict : std::int8_t
{
  Crossing = -1, ///< loops cross themselves or each other, or are not nested
  Undecided = 0,
  SimpleNested = 1 ///< proved: simple closed curves, holes inside the outer one and outside others
};
/// "simple_nested", "crossing", "undecided".
const char* ToString(LoopVerdict verdict);

/// Proves that the loops of a face are simple, disjoint, closed, nested and oriented (outer one
/// counterclockwise, holes clockwise), in the parameter plane.
Result<LoopVerdict> ProveLoops(const TrimmedFace& face, int threads = 0);

struct LoopParams
{
  /// Largest distance in space between the mesh's boundary and the curve that replaces it, > 0.
  double Tolerance = 0.0;
  /// A boundary that turns by more than so many degrees at a point has a corner there: edges end.
  /// (0, 180].
  double CornerAngle = 40.0;
  int Threads = 0;
  ProgressCallback Progress;
};

struct TrimLoops
{
  std::vector<std::vector<TrimmedLoop>> Loops; ///< of each chart, as TrimmedFace::Loops
  std::vector<LoopVerdict> Verdicts;           ///< of each chart
  int NumEdges = 0;
  int NumVertices = 0;
  int NumBoundaryLoops = 0; ///< of the whole surface: loops of edges that only one chart uses
  double MaxBoundaryDistance = 0.0; ///< bound of the distance |curve(t) - boundary(t)| in space
  double MaxEdgeGap = 0.0;          ///< bound of |curve(t) - S(pcurve(t))| over all uses
};

/// Boundary loops of charts as trimming curves: chains of boundary edges between corners, and
/// between points where other charts begin, become one edge each, which all charts along it use.
/// Pcurves are least squares splines with as many knots as the tolerance asks; where loops cross,
/// the tolerance is halved until they do not. Edge curves follow S(pcurve) (the mean of both
/// surfaces) to a hundredth of the tolerance beyond what the surfaces disagree.
/// @param surfaces  of the charts.
/// @return InvalidTopology (a boundary that is no manifold, an edge of three charts), SizeMismatch,
/// InvalidParameter, NotConverged, Aborted.
Result<TrimLoops> FitLoops(const std::vector<ChartMesh>& charts,
  const std::vector<Spline<2>>& surfaces, const LoopParams& params);
}
