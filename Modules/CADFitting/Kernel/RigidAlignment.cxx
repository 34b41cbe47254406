// SPDX-License-Identifier: BSD-3-Clause
#include "RigidAlignment.h"

#include "PoseAmbiguity.h"
#include "QueryBlocks.h"
#include "ScanCheck.h"

#include <cmath>

namespace knotwork
{
namespace
{
/// Below it a mesh is refined with points of its triangles first.
constexpr int MinMeshPoints = 500;
// shares of the target's size
constexpr double StartDistance = 0.1; ///< without a search
constexpr double UsefulDistance = 0.05;
constexpr double UsefulShare = 0.1;

Status CheckParams(const AlignmentParams& params)
{
  if (!(params.TrimmedShare >= 0.0 && params.TrimmedShare <= 0.9))
  {
    return { ErrorCode::InvalidParameter, "the share that is left out must be in [0, 0.9]" };
  }
  if (params.Samples < 100 || params.MaxIterations < 1 || params.MaxIterations > 100000)
  {
    return { ErrorCode::InvalidParameter,
      "at least 100 samples and between 1 and 100000 iterations are needed" };
  }
  if (!(params.Tolerance > 0.0 && params.Tolerance <= 0.01))
  {
    return { ErrorCode::InvalidParameter, "the tolerance of the motion must be in (0, 0.01]" };
  }
  return {};
}

/// Steps until the scan lies on the target, of few of its points first where all of them are not
/// enough or far.
/// @param found  Motion: the pose to begin with; gets what is known of the last step.
Status Refine(const AlignmentSamples& samples, const FitTarget& target,
  const AlignmentParams& params, RigidAlignment& found)
{
  AlignmentStepParams step;
  step.Find = OnTarget(target, params.Threads);
  step.Size = samples.Size;
  step.MaxIterations = params.MaxIterations;
  step.Tolerance = params.Tolerance * samples.Size;
  step.LeastOutlierDistance = LeastDistance * samples.Size;
  const double from =
    params.Coarse ? LastSearchDistance * samples.Size : StartDistance * samples.Size;
  const auto run = [&](const PointMatrix& points)
  {
    auto steps = StepToTarget(points, { found.Motion, from }, step);
    if (steps)
    {
      found.Motion = steps->Motion;
      found.Iterations = steps->Iterations;
      found.Converged = steps->Converged;
      found.LastStep = steps->LastStep;
      found.OutlierDistance = steps->OutlierDistance;
    }
    return steps.Status;
  };
  if (samples.IsMesh && samples.Points.rows() < MinMeshPoints)
  {
    // few points do not hold the scan in its place, but only they are exact
    step.MaxIterations = 50;
    if (Status status = run(SubsetOf(samples.Spread, PoseSamples)); !status)
    {
      return status;
    }
    step.MaxIterations = params.MaxIterations;
  }
  else if (!params.Coarse)
  {
    step.MaxIterations = 50;
    if (Status status = run(SubsetOf(samples.Points, PoseSamples)); !status)
    {
      return status;
    }
    step.MaxIterations = params.MaxIterations;
  }
  step.Outliers = params.Outliers;
  step.TrimmedShare = params.TrimmedShare;
  step.Progress = PartOf(params.Progress, 0.6, 0.8);
  return run(samples.Points);
}

/// Distances of all points of the scan.
Status Measure(const TriangleMesh& scan, const FitTarget& target, const AlignmentParams& params,
  RigidAlignment& found)
{
  const auto sides = SidesOf(target, { params.Threads, PartOf(params.Progress, 0.9, 0.92) });
  if (!sides)
  {
    return sides.Status;
  }
  auto measured = MeasureTargetDistances(target, found.Motion.Move(scan.Points), sides.Value,
    { params.Threads, PartOf(params.Progress, 0.92, 1.0) });
  if (!measured)
  {
    return measured.Status;
  }
  found.Deviation = std::move(measured.Value);
  const Eigen::VectorXd& distances = found.Deviation.Distances;
  found.Profile = ProfileOf(distances);
  double squares = 0.0;
  int near = 0;
  for (const double d : distances)
  {
    if (std::abs(d) <= found.OutlierDistance)
    {
      ++found.NumInliers;
      squares += d * d;
    }
    near += std::abs(d) <= UsefulDistance * found.TargetSize ? 1 : 0;
  }
  found.InlierRms = found.NumInliers > 0 ? std::sqrt(squares / found.NumInliers) : 0.0;
  if (near < UsefulShare * static_cast<double>(distances.size()))
  {
    return { ErrorCode::NotConverged,
      "only " + std::to_string(near) + " of " + std::to_string(distances.size()) +
        " points of the scan come near the target: give a scan of this part" +
        (params.Coarse ? "" : ", near its place or with the search for a pose") };
  }
  return {};
}
}

std::array<double, 16> RigidMotion::Matrix() const
{
  std::array<double, 16> matrix{};
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      matrix[static_cast<std::size_t>(4 * i + j)] = this->Rotation(i, j);
    }
    matrix[static_cast<std::size_t>(4 * i + 3)] = this->Translation[i];
  }
  matrix[15] = 1.0;
  return matrix;
}

Result<RigidAlignment> AlignToTarget(
  const TriangleMesh& scan, const FitTarget& target, const AlignmentParams& params)
{
  Status status = CheckParams(params);
  status = status ? CheckScan(scan) : status;
  const auto samples =
    status ? SampleForAlignment(scan, target, params.Samples) : Result<AlignmentSamples>(status);
  if (!samples)
  {
    return samples.Status;
  }
  RigidAlignment found;
  found.TargetSize = samples->Size;
  found.SizeRatio = samples->SizeRatio;
  std::vector<Pose> poses(1);
  status = params.Coarse ? SearchPoses(samples.Value, target, params, poses) : status;
  if (status)
  {
    found.Motion = poses.front().Motion;
    status = Refine(samples.Value, target, params, found);
  }
  if (status)
  {
    const auto count = CountFreeMotions(samples.Value, target, found, params.Threads);
    found.FreeMotions = count.Value;
    status = count.Status;
  }
  if (status && params.Coarse)
  {
    const auto count = found.FreeMotions > 0
      ? Result<int>(0)
      : CountEqualPoses(scan, samples.Value, target, params, poses, found);
    found.EqualPoses = count.Value;
    status = count.Status;
  }
  status = status ? Measure(scan, target, params, found) : status;
  return status ? Result<RigidAlignment>(std::move(found)) : status;
}
}
