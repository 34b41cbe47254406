// SPDX-License-Identifier: BSD-3-Clause
// Points of a scan and of its target that poses are found with, private to the kernel.
#pragma once
#include "RigidAlignment.h"

namespace knotwork
{
/// Of the scan, for poses that may be as good as the best.
inline constexpr int PoseSamples = 2000;
/// Of outliers of exact scans, as share of the target's size.
inline constexpr double LeastDistance = 1e-7;

/// What poses are found with, and judged by.
struct AlignmentSamples
{
  double Size = 0.0;        ///< of the target
  double SizeRatio = 1.0;   ///< as RigidAlignment
  bool IsMesh = false;      ///< the scan has triangles with an area
  PointMatrix Points;       ///< of the scan
  PointMatrix Spread;       ///< evenly on the scan's triangles; of its points where it has none
  PointMatrix TargetSpread; ///< evenly on the target
  Eigen::Vector3d MiddleOfScan;
  Eigen::Vector3d MiddleOfTarget;
  std::vector<Eigen::Matrix3d> Rotations; ///< of the scan's principal axes to the target's
  bool AreAxesAmbiguous = false;

  /// How far the scan's points move from one pose to another at most, about.
  double Between(const RigidMotion& a, const RigidMotion& b) const;
};

/// Samples of both, as even as triangles or the density of points allow, without what is far from
/// most of the scan; moments of these.
/// @param numPoints  of the scan, at most.
/// @return SingularSystem: all points on a line; EmptyInput: a target without surface or extent;
/// InvalidParameter: a scan 5 times as large as the target or 100 times smaller.
/// @complexity O(n log n).
Result<AlignmentSamples> SampleForAlignment(
  const TriangleMesh& scan, const FitTarget& target, int numPoints);

/// A subset of rows, spread over them without a period.
PointMatrix SubsetOf(const PointMatrix& points, Eigen::Index atMost);
}
