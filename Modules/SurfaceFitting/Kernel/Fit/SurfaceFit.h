// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/LRStrategies.h>

#include <cstdint>
#include <iterator>
#include <optional>

namespace knotwork
{
/// Scattered points with parameters, n rows each.
struct PointCloud
{
  PointMatrix Parameters; ///< n x 2, where on the surface a point belongs
  /// n x c: the first FitParams::NumMeasured columns are what the tolerance is about (z of a height
  /// field; x, y, z of a surface in space), the others are fitted along.
  PointMatrix Values;
  Eigen::VectorXd Tolerances; ///< n, > 0, a tolerance of each point; size 0: FitParams says
  /// n, not 0 where a point counts FitParams::SignificantWeight times; size 0: nowhere.
  std::vector<std::uint8_t> Significant;
};

/// Points of a parametric box have a tolerance of their own.
struct ToleranceBox
{
  ParametricBox<2> Box;
  double Tolerance = 0.0;
};

enum class FitSpace
{
  LocallyRefined,
  Hierarchical ///< truncated hierarchical B-splines
};

enum class FitMethod
{
  LeastSquares,            ///< with smoothing, in every iteration
  MultilevelApproximation, ///< MBA: averages of local solutions, no equations
  Combined                 ///< least squares until FitParams::SwitchIteration, then MBA
};

enum class FitSide
{
  Both,
  Above, ///< no point above the surface (by more than rounding)
  Below  ///< no point below the surface
};

/// How the distances around a point that may be an outlier are summed up.
enum class FitDeviation
{
  Robust,  ///< median and median absolute deviation: other outliers nearby hardly matter
  Standard ///< mean and standard deviation
};

/// Which elements with points outside the tolerance an iteration splits; all of them when they are
/// at most one in a hundred of all elements. After ten iterations ThresholdShare is halved in each.
enum class FitThreshold
{
  All,           ///< all of them
  LargestErrors, ///< those whose largest excess is at least ThresholdShare of the largest of all
  MostPoints     ///< those whose number of points outside is at least ThresholdShare of the largest
};

enum class FitDirections
{
  Both,
  Alternating,
  ByError ///< the direction in which the distances vary more, an element
};

/// What ends the fit besides the tolerance and the limits.
enum class FitCriterion
{
  Tolerance,
  AIC, ///< the information criterion has risen twice: the fit before is the result
  BIC
};

/// What of a start surface stays along a side of the domain, through all refinement.
enum class FitEdge
{
  Free,
  Values,     ///< the curve of the surface over the side
  Derivatives ///< and its derivatives across the side
};

/// A surface that a fit starts from and updates: polynomial, over a parameter domain (of kind
/// Tensor, Hierarchical or LocallyRefined). The Surface and DomainPoints of a fit are one.
struct FitStart
{
  /// Its first components are those of PointCloud::Values; further ones are carried along.
  Spline<2> Surface;
  PointMatrix DomainPoints; ///< NumFunctions x 2, as SurfaceFit::DomainPoints
  /// By side: lower and upper end of the first parameter, then of the second.
  std::array<FitEdge, 4> Edges{};
};

/// Why a fit ended.
enum class FitEnd
{
  Tolerance, ///< all points are within
  Iterations,
  Functions,
  Seconds,
  Criterion,     ///< the information criterion has risen
  Resolution,    ///< what is outside lies where no element may be split, or no smaller one helps
  Contradiction, ///< every point outside is in the place of another one that no surface meets too
  HeldEdges      ///< points outside lie on edges of the start that are held
};

/// What the tolerance grows with.
enum class FitDistance
{
  None,
  Value, ///< |value in the last measured column|: depth below a height of 0
  Point  ///< distance of the parameters from DistanceCentre
};

/// One row of the table of iterations.
struct FitIteration
{
  int Iteration = 0; ///< 0 is the initial space
  bool LeastSquares = true;
  int NumFunctions = 0;
  int NumElements = 0;
  double MaxError = 0.0;  ///< of points that are no outliers, as RmsError and MeanError
  double MeanError = 0.0; ///< of absolute values
  double RmsError = 0.0;
  std::size_t NumOutside = 0; ///< points farther away than their tolerance, outliers left out
  std::size_t NumOutliers = 0;
  /// The same of significant points that are no outliers.
  std::size_t NumSignificant = 0;
  double MaxSignificantError = 0.0;
  double MeanSignificantError = 0.0;
  std::size_t NumSignificantOutside = 0;
  double LogLikelihood = 0.0; ///< of a t-distribution fitted to the distances
  double DegreesOfFreedom = 0.0;
  double AIC = 0.0;
  double BIC = 0.0;
  double Seconds = 0.0; ///< since the start
};

struct FitParams
{
  FitSpace Space = FitSpace::LocallyRefined;
  IntArray<2> Degree{ 2, 2 };             ///< each in [1, 9]
  IntArray<2> NumInitialElements{ 0, 0 }; ///< each >= 0; 0: chosen by the number of points
  /// Parameter domain; without an area the box of the parameters.
  ParametricBox<2> Domain;
  /// The surface that the fit updates: its degree and domain count instead of Degree,
  /// NumInitialElements and Domain, and its kind instead of Space unless it is of kind Tensor.
  /// Where no function's support holds a point that counts it stays as it is, to the last bit, and
  /// it stays altogether when it meets all points.
  std::optional<FitStart> Start;
  int NumMeasured = 1; ///< in [1, columns of Values]
  /// Parameters of the points become those of the closest points of every iteration's surface, so
  /// distances are those from the surface. Surfaces in space: NumMeasured in [2, 4].
  bool CorrectParameters = false;

  FitMethod Method = FitMethod::LeastSquares;
  int SwitchIteration = 6; ///< >= 0
  /// >= 0: weight of the thin-plate energy of an element in its own parameters, relative to the
  /// mean weight of the points of an element, so it means the same on every level. Unless it is 0,
  /// the first surface comes from a stiff one, and from then on control points change little where
  /// there are few points or none. 0: nothing but the points decides, with spikes between sparse
  /// ones.
  double Smoothing = 1e-9;
  double SignificantWeight = 10.0; ///< >= 1

  double Tolerance = 0.0; ///< > 0, or 0: a thousandth of the range of the measured values
  std::vector<ToleranceBox> ToleranceBoxes; ///< the smallest tolerance of those around a point
  /// Times the tolerance of a point that lies above or below the surface, > 0; 1 unless NumMeasured
  /// is 1 and Side is Both.
  double ToleranceFactorAbove = 1.0;
  double ToleranceFactorBelow = 1.0;
  FitDistance Distance = FitDistance::None;
  double DistanceSlope = 0.0; ///< tolerance = Tolerance + DistanceSlope * distance, >= 0
  RealArray<2> DistanceCentre{};
  FitSide Side = FitSide::Both;

  bool FindOutliers = false;
  double OutlierScale = 4.5; ///< standard deviations of the distances nearby, > 0
  FitDeviation OutlierDeviation = FitDeviation::Robust;

  int MaxIterations = 30; ///< >= 0
  /// 0: ten times the number of points but at most a million, or the number of points if that is
  /// more.
  int MaxFunctions = 0;
  double MaxSeconds = 0.0; ///< 0: no limit
  FitCriterion Criterion = FitCriterion::Tolerance;

  FitThreshold Threshold = FitThreshold::LargestErrors;
  double ThresholdShare = 0.1;                       ///< in [0, 1]
  FitDirections Directions = FitDirections::ByError; ///< LR; THB elements are split in both
  LRStrategy Strategy = LRStrategy::FullSpan;
  int StrategySwitch = 0; ///< >= 0: the first iteration whose space LaterStrategy makes; 0: none
  LRStrategy LaterStrategy = LRStrategy::FullSpan;
  bool Independent = false; ///< LR: no step leaves linearly dependent functions (slower)
  /// Elements whose halves would be smaller than this share of the domain are not split; lines of
  /// an LR space that come from beside them may still cross them. In (0, 1).
  double MinElementSize = 1e-7;

  int FeatureGridSize = 0;        ///< n: features of n x n equal cells; 0: none
  bool ElementFeatures = false;   ///< features of elements
  bool FeatureIterations = false; ///< features of every iteration, not of the result alone
  int Threads = 0;
  ProgressCallback Progress;
};

/// What is known of a part of the domain: an element, or a cell of a regular grid. Heights are
/// those of the last measured column, of the surface at 3 x 3 places of the part; distances those
/// of the points in it that are no outliers, sizes where they are above or below. 0 without points.
enum class FitFeature
{
  Height,     ///< of the surface in the middle
  MeanHeight, ///< of the places
  HeightRange,
  Slope, ///< length of the gradient in the middle
  MeanSlope,
  Laplacian,   ///< mean of the sum of the second derivatives
  ElementSize, ///< area of the element in the middle
  NumElements, ///< that meet it
  NumPoints,
  NumOutside,
  NumAbove,
  NumBelow, ///< or on the surface
  NumOutsideAbove,
  NumOutsideBelow,
  MaxError,
  MeanError,
  Roughness,     ///< standard deviation of the distances
  DistanceRange, ///< between the highest and the lowest point, over the surface
  MaxAbove,
  MeanAbove,
  DeviationAbove,
  MaxBelow,
  MeanBelow,
  DeviationBelow,
  MeanPointHeight,
  PointHeightRange,
  PointHeightDeviation
};

inline constexpr const char* FitFeatureNames[] = { "Height", "MeanHeight", "HeightRange", "Slope",
  "MeanSlope", "Laplacian", "ElementSize", "NumElements", "NumPoints", "NumOutside", "NumAbove",
  "NumBelow", "NumOutsideAbove", "NumOutsideBelow", "MaxError", "MeanError", "Roughness",
  "DistanceRange", "MaxAbove", "MeanAbove", "DeviationAbove", "MaxBelow", "MeanBelow",
  "DeviationBelow", "MeanPointHeight", "PointHeightRange", "PointHeightDeviation" };
inline constexpr int NumFitFeatures = static_cast<int>(std::size(FitFeatureNames));

/// Features of all parts.
struct FitFeatures
{
  std::vector<ParametricBox<2>> Boxes; ///< of elements; empty for a grid
  PointMatrix Values;                  ///< parts x NumFitFeatures

  auto Of(FitFeature feature) const { return this->Values.col(static_cast<Eigen::Index>(feature)); }
};

struct SurfaceFit
{
  Spline<2> Surface; ///< columns of Values as components, then further ones of the start
  /// The domain's own coordinates as control points of the space (u and v exactly): with Surface's
  /// first column a height field is the surface (u, v, z).
  PointMatrix DomainPoints;
  PointMatrix Parameters;             ///< n x 2, corrected ones; 0 x 0 unless CorrectParameters
  std::vector<double> Distances;      ///< n; signed (value - surface) when NumMeasured is 1
  std::vector<double> Tolerances;     ///< n, those that were used, on the points' sides
  std::vector<std::uint8_t> Outliers; ///< n, 1: an outlier; empty unless FindOutliers
  /// The last row is Final. One-sided fits: errors before are distances from the middle of the band
  /// between the points and their tolerances.
  std::vector<FitIteration> Iterations;
  /// Of the result, or with FeatureIterations one a row of Iterations.
  std::vector<FitFeatures> GridFeatures;
  std::vector<FitFeatures> ElementFeatures;
  FitIteration Final;        ///< the numbers of the result, computed anew
  std::size_t NumPoints = 0; ///< of all processes
  bool WithinTolerance = false;
  FitEnd End = FitEnd::Tolerance;
};

/// Fits a spline surface to points until all of them (outliers left out) are within tolerance:
/// approximate, measure, split elements, again. Bit-identical for every number of threads.
///
/// @return EmptyInput; NonFiniteInput and TooLarge naming the point; SizeMismatch; InvalidDegree;
/// InvalidParameter naming the option; OutsideDomain naming the point; of a start DimensionMismatch
/// (no parameter domain), InvalidWeight (rational), SizeMismatch, NonFiniteInput, InvalidKnots;
/// Aborted. A fit that ends by a limit is a result with WithinTolerance false.
/// @complexity an iteration O(points (p + 1)^2) and the solve.
/// @source  Skytt, Barrowclough, Dokken, Computers & Graphics 49 (2015) 58-68 (LR least squares and
/// MBA); Lee, Wolberg, Shin, IEEE TVCG 3 (1997) 228-244 (MBA).
Result<SurfaceFit> FitSurface(const PointCloud& cloud, const FitParams& params);
}
