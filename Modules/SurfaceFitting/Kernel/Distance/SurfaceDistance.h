// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
enum class DistanceKind
{
  Automatic, ///< Vertical when all surfaces are height fields (HeightField.h), else Closest
  Vertical,  ///< z of the point - z of the surface at its x and y
  Closest    ///< to the closest point, > 0 on the side that the normal points to
};

struct SurfaceDistanceParams
{
  DistanceKind Kind = DistanceKind::Automatic;
  /// Limits of classes, ascending, > 0. A point's class is 0 when its distance is at most the first
  /// one, k (above) or -k (below) when k of them are smaller than its absolute value.
  std::vector<double> Tolerances;
  int Threads = 0;
  ProgressCallback Progress;
};

/// Points of one class, or all of them.
struct DistanceStatistics
{
  int Class = 0;
  std::size_t NumPoints = 0;
  double Min = 0.0; ///< signed, as Max and Mean; zeros without points
  double Max = 0.0;
  double Mean = 0.0;
  double MeanAbsolute = 0.0;
  double Rms = 0.0;
};

struct SurfaceDistances
{
  DistanceKind Kind = DistanceKind::Vertical; ///< never Automatic
  /// n, signed; NaN where no surface lies above or below a point (Vertical).
  std::vector<double> Distances;
  std::vector<int> Classes;  ///< n; 0 where there is no distance
  std::vector<int> Surfaces; ///< n, -1 where there is no distance, as Elements
  std::vector<int> Elements; ///< n
  PointMatrix Local;         ///< n x 2 in [0, 1]; NaN where there is no distance, as Feet
  PointMatrix Feet;          ///< n x 3, the points on the surfaces
  DistanceStatistics All;
  std::vector<DistanceStatistics> ByClass; ///< from -k to k
  std::size_t NumWithout = 0;              ///< points without a distance
};

/// Distances of points from spline surfaces of any kind.
///
/// Vertical distances of a surface that is no height field are those at the parameters that its x
/// and y have there (inverse of the plane map), the first one found where it folds. On borders the
/// sign of Closest is that of the tangent plane there; 0 counts as above.
/// @param points  n x 3, finite. @param surfaces  3 components or more, of which 3 count.
/// @return EmptyInput without points or surfaces; Spline::Check's codes naming the surface;
/// SizeMismatch; NonFiniteInput and TooLarge (beyond 1e60) naming the point; InvalidParameter for
/// tolerances; Aborted.
/// @complexity Vertical: a location and an evaluation a point; Closest: see ClosestPointSearch.
/// Bit-identical for any number of threads.
Result<SurfaceDistances> MeasureSurfaceDistances(const PointMatrixView& points,
  const std::vector<Spline<2>>& surfaces, const SurfaceDistanceParams& params = {});
}
