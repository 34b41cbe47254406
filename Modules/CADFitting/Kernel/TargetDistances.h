// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/CADFitting/FitTarget.h>

namespace knotwork
{
struct TargetDistanceParams
{
  int Threads = 0; ///< 0: all cores
  ProgressCallback Progress;
  TargetPart Part{}; ///< that is searched: the whole surface, unless another is named
};

/// Closest points of n queries on a target, in parallel.
/// @param queries  n x 3, finite.
/// @return the target's errors; Aborted.
Status FindOnTarget(const FitTarget& target, const PointMatrixView& queries, TargetPoints& result,
  const TargetDistanceParams& params = {});

/// Distances of n points with the place that they are measured from.
struct TargetDistances
{
  Eigen::VectorXd Distances; ///< positive where the normal points to
  TargetPoints Feet;
};

/// What signs of distances go by.
struct TargetSides
{
  /// -1 of a closed target whose normals point inward, else 1: distances times it are positive
  /// outside. It is one for the whole: several bodies must be turned alike.
  double Outward = 1.0;
  double Size = 0.0; ///< diagonal of the box of its samples
};

/// @return the target's errors; Aborted.
Result<TargetSides> SidesOf(const FitTarget& target, const TargetDistanceParams& params = {});

/// Signed distances from the whole surface, of every query by itself. Of a closed target positive
/// is outside, if all of its bodies are turned alike; of an open one it is the side that the
/// normals point to. At an edge or corner the sign is that of the sum of the normals there.
/// @param sides  of the target.
/// @return as FindOnTarget.
/// @source  Baerentzen, Aanaes, IEEE TVCG 11 (2005) 243-253 (signs at edges), with equal weights.
Result<TargetDistances> MeasureTargetDistances(const FitTarget& target,
  const PointMatrixView& queries, const TargetSides& sides,
  const TargetDistanceParams& params = {});

inline constexpr std::array<double, 6> PercentileLevels{ 50.0, 90.0, 95.0, 99.0, 99.9, 100.0 };

/// What distances are like.
struct DistanceProfile
{
  int NumPoints = 0;
  double Min = 0.0; ///< signed, as Max and Mean
  double Max = 0.0;
  double Mean = 0.0;
  double MeanAbsolute = 0.0;
  double Rms = 0.0;
  /// Of the absolute values: the least that so many percent of the weight do not exceed.
  std::array<double, PercentileLevels.size()> Percentiles{};
};

/// @param weights  as many, >= 0; empty: all alike.
DistanceProfile ProfileOf(const Eigen::VectorXd& distances, const Eigen::VectorXd& weights = {});
}
