// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SurfaceFitting/SurfaceFit.h>

namespace knotwork
{
/// Scattered points in space with values, n rows each.
struct VolumeCloud
{
  PointMatrix Points; ///< n x 3, the parameters of the volume
  PointMatrix Values; ///< n x c, what is fitted; the tolerance is about every column
};

struct VolumeFitParams
{
  FitSpace Space = FitSpace::LocallyRefined;
  int Degree = 2;                            ///< in all three directions, in [1, 9]
  IntArray<3> NumInitialElements{ 0, 0, 0 }; ///< each >= 0; 0: chosen by the number of points
  /// Parameter domain; without a volume the box of the points, a flat one widened.
  ParametricBox<3> Domain;

  FitMethod Method = FitMethod::LeastSquares;
  int SwitchIteration = 6; ///< >= 0
  int MultilevelSteps = 8; ///< of MBA in an iteration, >= 1
  /// > 0: weight of the energy of second derivatives of an element in its own parameters, relative
  /// to the mean number of points of an element, so it means the same on every level. It decides
  /// where there are no points.
  double Smoothing = 1e-9;

  double Tolerance = 0.0; ///< > 0, or 0: a thousandth of the largest range of a column of values
  int MaxIterations = 20; ///< >= 0
  int MaxFunctions = 0;   ///< >= 0; 0: the number of points, at least 1,000
  /// Elements with points outside are halved when their largest excess is at least this share of
  /// the largest of all; all of them when they are at most one in a hundred. In [0, 1].
  double ThresholdShare = 0.1;
  LRStrategy Strategy = LRStrategy::FullSpan; ///< of LR volumes
  /// Elements whose halves would be smaller than this share of the domain are not halved. In (0,
  /// 1).
  double MinElementSize = 1e-5;
  int Threads = 0;
  ProgressCallback Progress;
};

/// One row of the table of iterations.
struct VolumeFitIteration
{
  bool LeastSquares = true;
  int NumFunctions = 0;
  int NumElements = 0;
  double MaxError = 0.0; ///< largest absolute difference in a column
  double RmsError = 0.0; ///< of all values
  std::size_t NumOutside = 0;
  double Seconds = 0.0; ///< since the start
};

struct VolumeFit
{
  Spline<3> Volume; ///< columns of Values as components
  /// The domain's own coordinates as control points of the space (exactly the parameters): with
  /// them as geometry the values are a field in space.
  PointMatrix DomainPoints;
  std::vector<double> Distances; ///< n, largest absolute difference of a column
  double Tolerance = 0.0;        ///< that was used
  std::vector<VolumeFitIteration> Iterations;
  bool WithinTolerance = false;
  FitEnd End = FitEnd::Tolerance;
};

/// Fits a spline of three parameters to values at scattered points until all are within tolerance:
/// approximate, measure, halve elements, again. Bit-identical for every number of threads.
/// @return EmptyInput; SizeMismatch; NonFiniteInput and TooLarge naming the point;
/// InvalidDegree;
/// InvalidParameter naming the option; OutsideDomain naming the point; Aborted. A fit that ends by
/// a limit is a result with WithinTolerance false.
/// @complexity an iteration O(points (p + 1)^3) and the solve.
/// @source  as FitSurface; Dokken, Lyche, Pettersen, CAGD 30 (2013) for LR in any dimension.
Result<VolumeFit> FitVolume(const VolumeCloud& cloud, const VolumeFitParams& params);
}
