// SPDX-License-Identifier: BSD-3-Clause
#include "PoseSearch.h"

#include "QueryBlocks.h"

#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/SampleIndex.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr int FirstSamples = 200; ///< of the scan, for every pose of the search
constexpr int NextSamples = 500;  ///< for the better ones
constexpr int EvenRotations = 600;
constexpr std::size_t NextPoses = 150;
constexpr std::size_t MaxPoses = 32;
// shares of the target's size
constexpr double FirstDistance = 0.2; ///< of outliers
constexpr double NextDistance = 0.1;
constexpr double ScoreDistance = 0.04;
constexpr double LeastScoreDistance = 1e-4; ///< for scores of poses that have not settled
constexpr double GoodScore = 0.5;   ///< of both ways together, in [0, 2]: axes did not fit above
constexpr double ScoreMargin = 0.3; ///< beyond the best one's of poses that are looked at closer

/// Rotations on a spiral of the sphere of quaternions (Alexa).
std::vector<Eigen::Matrix3d> SpiralRotations(int count)
{
  constexpr double phi = 1.41421356237309515;           // sqrt 2
  constexpr double psi = 1.533751168755204288118041413; // psi^4 = psi + 4
  std::vector<Eigen::Matrix3d> rotations;
  for (int i = 0; i < count; ++i)
  {
    const double s = i + 0.5;
    const double t = s / count;
    const double alpha = 2.0 * static_cast<double>(EIGEN_PI) * s / phi;
    const double beta = 2.0 * static_cast<double>(EIGEN_PI) * s / psi;
    const double r = std::sqrt(t);
    const double q = std::sqrt(1.0 - t);
    rotations.push_back(Eigen::Quaterniond(
      q * std::cos(beta), r * std::sin(alpha), r * std::cos(alpha), q * std::sin(beta))
                          .normalized()
                          .toRotationMatrix());
  }
  return rotations;
}

class PoseSearch
{
public:
  PoseSearch(
    const AlignmentSamples& samples, const FitTarget& target, const AlignmentParams& params)
    : Samples(samples), Target(target), Params(params)
  {
  }

  Status Search(std::vector<Pose>& poses)
  {
    TargetPoints feet;
    if (Status status = FindOnTarget(this->Target, this->Samples.TargetSpread, feet,
          { this->Params.Threads, PartOf(this->Params.Progress, 0.0, 0.05) });
        !status)
    {
      return status;
    }
    this->TargetIndex = SampleIndex(this->Samples.TargetSpread);
    this->TargetNormals = feet.Normals;
    this->ScanIndex = SampleIndex(this->Samples.Spread);
    std::vector<Eigen::Matrix3d> rotations = this->Samples.Rotations;
    const auto addEven = [&]()
    {
      const auto even = SpiralRotations(EvenRotations);
      rotations.insert(rotations.end(), even.begin(), even.end());
    };
    if (this->Samples.AreAxesAmbiguous)
    {
      addEven();
    }
    Status status = this->SearchAmong(rotations, poses, PartOf(this->Params.Progress, 0.05, 0.2));
    if (status && !this->Samples.AreAxesAmbiguous && poses.front().Score > GoodScore)
    {
      addEven(); // the scan has other axes: parts are missing, or there is more
      status = this->SearchAmong(rotations, poses, PartOf(this->Params.Progress, 0.2, 0.4));
    }
    if (!status)
    {
      return status;
    }
    const double limit = poses.front().Score + ScoreMargin;
    while (poses.back().Score > limit)
    {
      poses.pop_back();
    }
    return this->ComparePoses(poses);
  }

private:
  /// The nearest of the target's samples, which lie denser than poses of the search differ.
  FootFinder OnSamples() const
  {
    return [this](const PointMatrix& queries, TargetPoints& feet)
    {
      feet.Points.resize(queries.rows(), 3);
      feet.Normals.resize(queries.rows(), 3);
      for (Eigen::Index i = 0; i < queries.rows(); ++i)
      {
        const int sample = this->TargetIndex.Nearest(queries.row(i).data()).Item;
        feet.Points.row(i) = this->TargetIndex.Samples().row(sample);
        feet.Normals.row(i) = this->TargetNormals.row(sample);
      }
      return Status();
    };
  }

  /// Bounded squares of distances both ways, each in the mean in [0, 1].
  double SampledScore(const RigidMotion& motion, const PointMatrix& own, const PointMatrix& other,
    double distance) const
  {
    const auto mean = [distance](const PointMatrix& points, const SampleIndex& index)
    {
      double sum = 0.0;
      for (Eigen::Index i = 0; i < points.rows(); ++i)
      {
        const double square = index.Nearest(points.row(i).data()).SquaredDistance;
        sum += std::min(square / (distance * distance), 1.0);
      }
      return sum / static_cast<double>(points.rows());
    };
    return mean(motion.Move(own), this->TargetIndex) +
      mean(motion.Inverse().Move(other), this->ScanIndex);
  }

  /// Improves poses on samples and sorts them by their scores.
  Status Improve(std::vector<Pose>& poses, int samples, const AlignmentStepParams& step,
    double distance, const ProgressCallback& progress) const
  {
    const PointMatrix own = SubsetOf(this->Samples.Spread, samples);
    const PointMatrix other = SubsetOf(this->Samples.TargetSpread, samples);
    std::vector<Status> statuses(poses.size());
    constexpr std::size_t atOnce = 32;
    for (std::size_t first = 0; first < poses.size(); first += atOnce)
    {
      if (progress && !progress(static_cast<double>(first) / static_cast<double>(poses.size())))
      {
        return { ErrorCode::Aborted, "the search for a pose stopped" };
      }
      ParallelFor(std::min(atOnce, poses.size() - first), 1, this->Params.Threads,
        [&](std::size_t begin, std::size_t end)
        {
          for (std::size_t i = first + begin; i < first + end; ++i)
          {
            auto steps = StepToTarget(own, { poses[i].Motion, distance }, step);
            statuses[i] = steps.Status;
            if (steps)
            {
              poses[i].Motion = steps->Motion;
              poses[i].Score =
                this->SampledScore(poses[i].Motion, own, other, ScoreDistance * this->Samples.Size);
            }
          }
        });
    }
    for (const Status& status : statuses)
    {
      if (!status)
      {
        return status;
      }
    }
    std::stable_sort(
      poses.begin(), poses.end(), [](const Pose& a, const Pose& b) { return a.Score < b.Score; });
    return {};
  }

  /// The first of poses that are one.
  void Distinguish(std::vector<Pose>& poses, double distance, std::size_t atMost) const
  {
    std::vector<Pose> kept;
    for (Pose& pose : poses)
    {
      const auto isSame = [&](const Pose& other)
      { return this->Samples.Between(pose.Motion, other.Motion) < distance; };
      if (kept.size() < atMost && std::none_of(kept.begin(), kept.end(), isSame))
      {
        kept.push_back(std::move(pose));
      }
    }
    poses = std::move(kept);
  }

  Status SearchAmong(const std::vector<Eigen::Matrix3d>& rotations, std::vector<Pose>& poses,
    const ProgressCallback& progress) const
  {
    poses.clear();
    for (const Eigen::Matrix3d& rotation : rotations)
    {
      Pose& pose = poses.emplace_back();
      pose.Motion = { rotation,
        this->Samples.MiddleOfTarget - rotation * this->Samples.MiddleOfScan };
    }
    AlignmentStepParams step;
    step.Find = this->OnSamples();
    step.Size = this->Samples.Size;
    step.PointWeight = 0.1;
    step.Tolerance = 1e-3 * this->Samples.Size;
    step.MaxIterations = 8;
    step.LeastOutlierDistance = FirstDistance * this->Samples.Size; // stays
    if (Status status =
          this->Improve(poses, FirstSamples, step, step.LeastOutlierDistance, progress);
        !status)
    {
      return status;
    }
    this->Distinguish(poses, 0.2 * SamePose * this->Samples.Size, NextPoses);
    step.MaxIterations = 20;
    step.LeastOutlierDistance = LastSearchDistance * this->Samples.Size;
    step.PointWeight = 0.01;
    if (Status status =
          this->Improve(poses, NextSamples, step, NextDistance * this->Samples.Size, progress);
        !status)
    {
      return status;
    }
    this->Distinguish(poses, SamePose * this->Samples.Size, MaxPoses);
    return {};
  }

  /// Steps on the target itself, and exact distances.
  Status ComparePoses(std::vector<Pose>& poses) const
  {
    AlignmentStepParams step;
    step.Find = OnTarget(this->Target, this->Params.Threads);
    step.Size = this->Samples.Size;
    step.Tolerance = 1e-6 * this->Samples.Size;
    step.MaxIterations = 25;
    step.LeastOutlierDistance = LeastScoreDistance * this->Samples.Size;
    const PointMatrix own =
      SubsetOf(this->Samples.IsMesh ? this->Samples.Spread : this->Samples.Points, NextSamples);
    std::vector<Eigen::VectorXd> distances;
    double outlierDistance = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < poses.size(); ++i)
    {
      step.Progress = PartOf(this->Params.Progress,
        0.4 + 0.2 * static_cast<double>(i) / static_cast<double>(poses.size()),
        0.4 + 0.2 * static_cast<double>(i + 1) / static_cast<double>(poses.size()));
      auto steps =
        StepToTarget(own, { poses[i].Motion, LastSearchDistance * this->Samples.Size }, step);
      if (!steps)
      {
        return steps.Status;
      }
      poses[i].Motion = steps->Motion;
      const PointMatrix moved = poses[i].Motion.Move(own);
      TargetPoints feet;
      if (Status status = step.Find(moved, feet); !status)
      {
        return status;
      }
      distances.push_back(DistancesOf(moved, feet));
      outlierDistance = std::min(outlierDistance, steps->OutlierDistance);
    }
    const PointMatrix other = SubsetOf(this->Samples.TargetSpread, NextSamples);
    for (std::size_t i = 0; i < poses.size(); ++i)
    {
      const auto bounded = [&](double d)
      { return std::min(1.0, d * d / (outlierDistance * outlierDistance)); };
      const double back = this->SampledScore(
        poses[i].Motion, PointMatrix::Zero(1, 3), other, ScoreDistance * this->Samples.Size);
      poses[i].Score = distances[i].unaryExpr(bounded).mean() + back;
    }
    std::stable_sort(
      poses.begin(), poses.end(), [](const Pose& a, const Pose& b) { return a.Score < b.Score; });
    return {};
  }

  const AlignmentSamples& Samples;
  const FitTarget& Target;
  const AlignmentParams& Params;
  PointMatrix TargetNormals;
  SampleIndex TargetIndex;
  SampleIndex ScanIndex;
};
}

Status SearchPoses(const AlignmentSamples& samples, const FitTarget& target,
  const AlignmentParams& params, std::vector<Pose>& poses)
{
  return PoseSearch(samples, target, params).Search(poses);
}
}
