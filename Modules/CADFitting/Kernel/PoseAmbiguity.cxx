// SPDX-License-Identifier: BSD-3-Clause
#include "PoseAmbiguity.h"

#include "QueryBlocks.h"

#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/SampleIndex.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
// shares of the target's size
constexpr double SameTarget = 1e-6; ///< what CAD files are exact to
constexpr double FreeShift = 0.02;
constexpr double PoseMargin = 0.05;
constexpr double FreeRank = 1e-4;  ///< eigenvalue of a free motion, of the largest one
constexpr double FreeShare = 0.95; ///< of inliers that stay

double InlierDistance(const RigidAlignment& found)
{
  return std::isfinite(found.OutlierDistance) ? found.OutlierDistance : 0.0;
}

/// Compares poses by distances both ways.
class PoseComparison
{
public:
  PoseComparison(const TriangleMesh& scan, const AlignmentSamples& samples, const FitTarget& target,
    const AlignmentParams& params)
    : Samples(samples), Params(params), Find(OnTarget(target, params.Threads))
  {
    if (samples.IsMesh)
    {
      this->ScanTriangles = TriangleIndex<3>(scan.Points, scan.Triangles);
    }
    else
    {
      this->ScanIndex = SampleIndex(samples.Spread);
    }
  }

  Result<int> CountEqual(const std::vector<Pose>& poses, const RigidAlignment& found) const
  {
    const double distance = std::max(InlierDistance(found), LeastDistance * this->Samples.Size);
    double median = 0.0;
    Eigen::VectorXd best;
    if (Status status = this->Residuals(found.Motion, distance, 0.0, best, &median); !status)
    {
      return status;
    }
    AlignmentStepParams step;
    step.Find = this->Find;
    step.Size = this->Samples.Size;
    step.MaxIterations = 50;
    step.Tolerance = this->Params.Tolerance * this->Samples.Size;
    step.LeastOutlierDistance = LeastDistance * this->Samples.Size;
    std::vector<RigidMotion> equal{ found.Motion };
    const PointMatrix own = SubsetOf(this->Samples.Points, PoseSamples);
    for (std::size_t i = 0; i < poses.size(); ++i)
    {
      if (poses[i].Score > poses.front().Score + PoseMargin)
      {
        continue;
      }
      step.Progress = PartOf(this->Params.Progress,
        0.8 + 0.1 * static_cast<double>(i) / static_cast<double>(poses.size()),
        0.8 + 0.1 * static_cast<double>(i + 1) / static_cast<double>(poses.size()));
      const auto steps =
        StepToTarget(own, { poses[i].Motion, 0.1 * LastSearchDistance * this->Samples.Size }, step);
      if (!steps)
      {
        return steps.Status;
      }
      const RigidMotion& motion = steps->Motion;
      const auto isSame = [&](const RigidMotion& other)
      { return this->Samples.Between(motion, other) < SamePose * this->Samples.Size; };
      if (std::any_of(equal.begin(), equal.end(), isSame))
      {
        continue;
      }
      Eigen::VectorXd residuals;
      const double back = std::max(distance, 7.0 * median);
      if (Status status = this->Residuals(motion, distance, back, residuals); !status)
      {
        return status;
      }
      const Eigen::VectorXd worse = residuals - best;
      const auto count = static_cast<double>(worse.size());
      const double mean = worse.mean();
      const double error = std::sqrt((worse.array() - mean).square().sum()) / count;
      bool isEqual = mean <= 3.0 * error;
      if (!isEqual)
      {
        const auto alike = this->IsTargetAlike(
          motion * found.Motion.Inverse(), std::max(distance, SameTarget * this->Samples.Size));
        if (!alike)
        {
          return alike.Status;
        }
        isEqual = alike.Value;
      }
      if (isEqual)
      {
        equal.push_back(motion);
      }
    }
    return static_cast<int>(equal.size());
  }

private:
  /// Bounded squares of distances of the scan's points and, back, of the target's samples.
  Status Residuals(const RigidMotion& motion, double distance, double back, Eigen::VectorXd& result,
    double* medianBack = nullptr) const
  {
    const PointMatrix moved = motion.Move(this->Samples.Points);
    TargetPoints feet;
    if (Status status = this->Find(moved, feet); !status)
    {
      return status;
    }
    const Eigen::VectorXd own = DistancesOf(moved, feet);
    const PointMatrix inverse = motion.Inverse().Move(this->Samples.TargetSpread);
    Eigen::VectorXd other(inverse.rows());
    ParallelFor(static_cast<std::size_t>(inverse.rows()), 256, this->Params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (auto i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end); ++i)
        {
          const double* const at = inverse.row(i).data();
          other[i] =
            std::sqrt(this->Samples.IsMesh ? this->ScanTriangles.Nearest(at).SquaredDistance
                                           : this->ScanIndex.Nearest(at).SquaredDistance);
        }
      });
    if (medianBack)
    {
      *medianBack = QuantileOf(other, 0.5);
      back = std::max(distance, 7.0 * *medianBack);
    }
    const auto bounded = [](double limit)
    { return [limit](double d) { return std::min(1.0, d * d / (limit * limit)); }; };
    result.resize(own.size() + other.size());
    result << own.unaryExpr(bounded(distance)), other.unaryExpr(bounded(back));
    return {};
  }

  /// Whether the target lies on itself after a motion, as exactly as the scan lies on it.
  Result<bool> IsTargetAlike(const RigidMotion& motion, double distance) const
  {
    const PointMatrix moved = motion.Move(SubsetOf(this->Samples.TargetSpread, 2 * PoseSamples));
    TargetPoints feet;
    if (Status status = this->Find(moved, feet); !status)
    {
      return status;
    }
    return DistancesOf(moved, feet).maxCoeff() <= distance;
  }

  const AlignmentSamples& Samples;
  const AlignmentParams& Params;
  FootFinder Find;
  SampleIndex ScanIndex;
  TriangleIndex<3> ScanTriangles;
};
}

Result<int> CountFreeMotions(const AlignmentSamples& samples, const FitTarget& target,
  const RigidAlignment& found, int threads)
{
  const PointMatrix own = SubsetOf(samples.IsMesh ? samples.Spread : samples.Points, PoseSamples);
  const PointMatrix moved = found.Motion.Move(own);
  const FootFinder find = OnTarget(target, threads);
  TargetPoints feet;
  if (Status status = find(moved, feet); !status)
  {
    return status;
  }
  const Eigen::VectorXd distances = DistancesOf(moved, feet);
  // points of triangles sag
  const double limit = std::max(
    { InlierDistance(found), 3.0 * QuantileOf(distances, 0.5), SameTarget * samples.Size });
  const Eigen::VectorXd weights = (distances.array() <= limit).cast<double>();
  const MotionEquations equations =
    EquationsOf(moved, feet, weights, 0.0, std::numeric_limits<double>::infinity());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(equations.Matrix);
  int count = 0;
  for (int k = 0; k < 6; ++k)
  {
    if (solver.eigenvalues()[k] > FreeRank * solver.eigenvalues()[5])
    {
      break;
    }
    const double shift = FreeShift * samples.Size;
    const PointMatrix slid = equations.Step(shift * solver.eigenvectors().col(k)).Move(moved);
    if (Status status = find(slid, feet); !status)
    {
      return status;
    }
    // an edge of the second order leaves within the square of the shift
    const Eigen::VectorXd after = DistancesOf(slid, feet);
    const double stay = ((after.array() <= 2.0 * limit).cast<double>() * weights.array()).sum();
    count += stay >= FreeShare * weights.sum() ? 1 : 0;
  }
  return count;
}

Result<int> CountEqualPoses(const TriangleMesh& scan, const AlignmentSamples& samples,
  const FitTarget& target, const AlignmentParams& params, const std::vector<Pose>& poses,
  const RigidAlignment& found)
{
  return PoseComparison(scan, samples, target, params).CountEqual(poses, found);
}
}
