// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/CADFitting/TargetDistances.h>
#include <knotwork/MeshParameterization/TriangleMesh.h>

namespace knotwork
{
/// x goes to Rotation x + Translation.
struct RigidMotion
{
  Eigen::Matrix3d Rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d Translation = Eigen::Vector3d::Zero();

  PointMatrix Move(const PointMatrixView& points) const
  {
    return (points * this->Rotation.transpose()).rowwise() + this->Translation.transpose();
  }
  RigidMotion Inverse() const
  {
    return { this->Rotation.transpose(), -this->Rotation.transpose() * this->Translation };
  }
  /// First the other one.
  RigidMotion operator*(const RigidMotion& first) const
  {
    return { this->Rotation * first.Rotation,
      this->Rotation * first.Translation + this->Translation };
  }
  /// Of homogeneous coordinates, by rows.
  std::array<double, 16> Matrix() const;
};

/// What becomes of points that lie far from the target.
enum class OutlierRule
{
  Tukey,   ///< they weigh less with their distance, nothing beyond 4.685 times the noise
  Trimmed, ///< a stated share of the points, those that are farthest, is left out
  None     ///< all points weigh alike
};

struct AlignmentParams
{
  /// Whether the pose is searched for; false: the scan lies near its place (a tenth of the target's
  /// size) already.
  bool Coarse = true;
  OutlierRule Outliers = OutlierRule::Tukey;
  double TrimmedShare = 0.2; ///< for Trimmed, [0, 0.9]
  int Samples = 10000;       ///< points of the scan that the motion is found with, >= 100
  int MaxIterations = 200;   ///< of the refinement, [1, 100000]
  /// Of a step's motion, relative to the target's size, (0, 0.01]; a tenth of noise / sqrt(points)
  /// where that is more.
  double Tolerance = 1e-9;
  int Threads = 0;
  ProgressCallback Progress;
};

struct RigidAlignment
{
  RigidMotion Motion;
  int Iterations = 0;           ///< of the refinement
  bool Converged = false;       ///< the motion settled before MaxIterations
  double LastStep = 0.0;        ///< largest motion of a point in the last iteration
  double OutlierDistance = 0.0; ///< from which on points have no weight; infinite for None
  int NumInliers = 0;           ///< points of the scan that are nearer than that
  double InlierRms = 0.0;       ///< of their distances
  /// Poses at which the scan lies as well as here, this one included. 1 where none was searched
  /// for.
  int EqualPoses = 1;
  /// Independent motions at which the scan stays on the target: 1 of a turned part, 3 of a ball.
  int FreeMotions = 0;
  /// Half of the scan's points are within a radius, as half of the target is: its share of that
  /// one. Whole scans have about 1, those in another unit do not.
  double SizeRatio = 1.0;
  double TargetSize = 0.0;   ///< diagonal of the box of its samples
  TargetDistances Deviation; ///< of all points of the scan, moved
  DistanceProfile Profile;   ///< of its distances
};

/// The rigid motion that lays a scan onto a target.
///
/// Coarse: principal axes of scan and target in all 24 proper orders and signs, and where two of
/// their moments are nearly alike, or none of these fits, 600 rotations spread evenly; poses are
/// improved on samples and scored by bounded distances both ways. Fine: steps of least squares of
/// the distances from tangent planes (of edges and corners where closest points lie on these), with
/// an outlier distance that falls until it is that of the rule. Poses that end elsewhere are as
/// good where their bounded distances are not larger by three standard errors of the difference, or
/// where the target lies on itself.
/// @param scan  points, and triangles where it is a mesh: they tell what lies between the points.
/// @return EmptyInput: no points, a target without surface or extent; NonFiniteInput;
/// InvalidTopology: a corner that is no point; SingularSystem: all points on a line;
/// InvalidParameter: an option, a scan 5 times as large as the target or 100 times smaller;
/// NotConverged: fewer than a tenth of the points come near the target; Aborted; the target's
/// errors.
/// @complexity O(n log n), with some 1e5 closest points for the search.
/// @source  Besl, McKay, IEEE PAMI 14 (1992) 239-256; Chen, Medioni, Image and Vision Computing 10
/// (1992) 145-155 (tangent planes); Low, TR04-004, UNC Chapel Hill (2004) (linear steps); Zhang,
/// IJCV 13 (1994) 119-152 (outliers); Alexa, CVPR (2022) 8281-8290 (even rotations).
Result<RigidAlignment> AlignToTarget(
  const TriangleMesh& scan, const FitTarget& target, const AlignmentParams& params = {});
}
