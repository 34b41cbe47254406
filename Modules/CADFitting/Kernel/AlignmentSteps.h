// SPDX-License-Identifier: BSD-3-Clause
// Steps of an alignment from a start, private to the kernel.
#pragma once
#include "RigidAlignment.h"

#include <functional>

namespace knotwork
{
struct AlignmentStart
{
  RigidMotion Motion;
  double OutlierDistance = 0.0; ///< that the steps begin with
};

struct AlignmentSteps
{
  RigidMotion Motion;
  double OutlierDistance = 0.0;
  int Iterations = 0;
  bool Converged = false;
  double LastStep = 0.0;
};

/// Closest points of moved points of the scan.
using FootFinder = std::function<Status(const PointMatrix& queries, TargetPoints& feet)>;
/// Those on a target, which must outlive the result.
FootFinder OnTarget(const FitTarget& target, int threads);

struct AlignmentStepParams
{
  FootFinder Find;
  OutlierRule Outliers = OutlierRule::Tukey;
  double TrimmedShare = 0.2;
  double LeastOutlierDistance = 0.0; ///< that it falls to at most; that of the start: it stays
  int MaxIterations = 100;
  double Tolerance = 0.0;   ///< of a step's motion
  double Size = 1.0;        ///< of the target
  double PointWeight = 0.0; ///< of distances from closest points beside those from tangent planes
  ProgressCallback Progress;
};

/// Steps of least squares until the motion settles.
Result<AlignmentSteps> StepToTarget(
  const PointMatrix& scan, const AlignmentStart& start, const AlignmentStepParams& params);

/// Normal equations of a small motion at a place: turns about the points' middle times Radius, then
/// shifts.
struct MotionEquations
{
  Eigen::Matrix<double, 6, 6> Matrix = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> Right = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Vector3d Middle = Eigen::Vector3d::Zero();
  double Radius = 1.0;

  /// The motion of turns and shifts.
  RigidMotion Step(const Eigen::Matrix<double, 6, 1>& values) const;
};

/// @param weights  one a point. @param tiny  distance below which a foot is the point itself.
MotionEquations EquationsOf(const PointMatrix& moved, const TargetPoints& feet,
  const Eigen::VectorXd& weights, double pointWeight, double tiny);

/// Distances of points from their feet.
Eigen::VectorXd DistancesOf(const PointMatrix& moved, const TargetPoints& feet);
/// The least value that a share of all does not exceed.
double QuantileOf(Eigen::VectorXd values, double share);
}
