// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ChartMesh.h"
#include "Spline.h"

/// Surfaces S(u, v) over a rectangle W that contains a chart, with S(UV) = its points.
namespace knotwork
{
enum class BackMapMethod
{
  Nurbs,    ///< grid points inside the chart by interpolation, others by extrapolation outwards
  Rbf,      ///< thin-plate radial basis functions, then a spline that follows them
  Hybrid,   ///< control points are values of the radial basis functions
  Penalized ///< least squares with thin-plate energy
};
/// Name as options and reports have it.
const char* ToString(BackMapMethod method);

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
  int Threads = 0;    ///< 0: all cores; the result does not depend on it
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
};

/// @return failures of ChartMesh::Check; InvalidParameter; SingularSystem; TooLarge; Aborted. A
/// surface that misses the tolerance is a result.
Result<BackMap> FitBackMap(const ChartMesh& chart, const BackMapParams& params);
}
