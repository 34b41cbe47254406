// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>
#include <knotwork/SurfaceTrimming/ChartMesh.h>

#include <string>
#include <vector>

/// Surfaces S(u, v) over a rectangle W that contains a chart, with S(UV) = its points.
namespace knotwork
{
enum class BackMapMethod
{
  Nurbs,         ///< a surface over the largest grid in the chart, continued ring by ring
  Rbf,           ///< thin-plate radial basis functions, then a spline that follows them
  Hybrid,        ///< control points are values of the radial basis functions
  Penalized,     ///< least squares with thin-plate energy
  ContinuedLines ///< all grid points in the chart, rows and columns continued
};
/// Name as options and reports have it.
const char* ToString(BackMapMethod method);

/// Why a surface was not refined further.
enum class BackMapStop
{
  Finished,     ///< within the tolerance, or on the net that was asked for
  Effort,       ///< Effort was used up
  Time,         ///< TimeLimit was reached
  Elements,     ///< MaxElements in a direction
  Functions,    ///< MaxFunctions
  Contradiction ///< two triangles lie on each other in the plane, their places apart
};
/// Name as reports have it: finished, effort, time_limit, elements, functions, contradiction.
const char* ToString(BackMapStop stop);

struct BackMapParams
{
  BackMapMethod Method = BackMapMethod::Penalized;
  int Degree = 3; ///< [1, 9]; extrapolation and thin-plate energy want at least 2
  /// Spans of the net in the longer direction of W, in [1, 2000]; 0: refined from few, by need of
  /// each span, until the deviation is within Tolerance or MaxElements is reached.
  int Elements = 0;
  int MaxElements = 400; ///< in a direction
  /// Largest distance between mesh (inside triangles too) and surface, unit of the points, > 0.
  double Tolerance = 0.0;
  double Margin = 0.02; ///< of W around UV, part of its longest side, [0, 1]
  /// Weight of the thin-plate energy, > 0, independent of units and of the number of points. It is
  /// that of a net of eight spans; finer nets have less, by the fourth power of the smallest span:
  /// against the data it stays as small, where there is none it rules alone.
  double Smoothing = 1e-7;
  int Centres = 2000; ///< radial basis functions at most: all points up to so many, else the
                      ///< greedy choice of so many at most, [10, 20000]
  /// Control points of a net at most, >= 1: a net of 2e5 takes about 1.5e9 bytes to solve for. A
  /// net by need ends before it, one that is asked for is refused.
  int MaxFunctions = 200000;
  /// Work at most of Penalized, (0, 1e6]: about as many seconds of one core, but counted, so that
  /// the same run ends at the same place on every machine. The best surface so far is then the
  /// result; the first net is solved for in any case.
  double Effort = 50.0;
  /// What each control point of the result costs after the fit, in the same unit, >= 0: that much
  /// is left for it.
  double LaterWork = 0.0;
  /// A net by need begins with it: BackMap::NextNet of a fit that was stopped. Empty: few spans.
  std::vector<KnotVector> FirstNet;
  double TimeLimit = 0.0; ///< seconds of the wall clock, >= 0; 0: none. The same
  int Threads = 0;        ///< 0: all cores; the result does not depend on it
  ProgressCallback Progress;
};

struct BackMap
{
  Spline<2> Surface;            ///< tensor, polynomial, n x 3
  double MaxResidual = 0.0;     ///< largest |S(u) - X(u)| found at points of the triangles
  double RmsResidual = 0.0;     ///< root mean square by area
  int Centres = 0;              ///< radial basis functions used
  int Passes = 0;               ///< nets solved for
  bool WithinTolerance = false; ///< as found, not proved: BoundDeviation does that
  BackMapStop Stop = BackMapStop::Finished;
  std::string StopReason;          ///< place of a contradiction
  double Work = 0.0;               ///< in the unit of BackMapParams::Effort, without the later one
  std::vector<KnotVector> NextNet; ///< that the effort did not suffice for
  double NextWork = 0.0;           ///< what it is expected to cost, with the later work
};

/// @return failures of ChartMesh::Check; InvalidParameter; SingularSystem; TooLarge; Aborted. A
/// surface that misses the tolerance is a result.
Result<BackMap> FitBackMap(const ChartMesh& chart, const BackMapParams& params);
}
