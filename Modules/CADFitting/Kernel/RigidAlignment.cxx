// SPDX-License-Identifier: BSD-3-Clause
#include "RigidAlignment.h"

#include "AlignmentSteps.h"
#include "QueryBlocks.h"
#include "ScanCheck.h"
#include "TriangleSamples.h"

#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/SampleIndex.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr int SpreadSamples = 20000; ///< on target and scan, for the search
constexpr int CellsOfMoments = 2000;
constexpr int FirstSamples = 200; ///< of the scan, for every pose of the search
constexpr int NextSamples = 500;  ///< for the better ones
constexpr int PoseSamples = 2000; ///< for poses that may be as good as the best
constexpr int MinMeshPoints =
  500; ///< below it a mesh is refined with points of its triangles first
constexpr int EvenRotations = 600;
constexpr std::size_t NextPoses = 150;
constexpr std::size_t MaxPoses = 32;
// shares of the target's size
constexpr double FirstDistance = 0.2; ///< of outliers
constexpr double NextDistance = 0.1;
constexpr double ScoreDistance = 0.04;
constexpr double LastSearchDistance = 0.03;
constexpr double StartDistance = 0.1;       ///< without a search
constexpr double LeastDistance = 1e-7;      ///< of outliers of exact scans
constexpr double LeastScoreDistance = 1e-4; ///< for scores of poses that have not settled
constexpr double SamePose = 0.03;
constexpr double SameTarget = 1e-6; ///< what CAD files are exact to
constexpr double FreeShift = 0.02;
constexpr double LikeRadii = 0.95;  ///< of inertia: axes are ambiguous above
constexpr double GoodScore = 0.5;   ///< of both ways together, in [0, 2]: axes did not fit above
constexpr double ScoreMargin = 0.3; ///< beyond the best one's of poses that are looked at closer
constexpr double PoseMargin = 0.05;
constexpr double FreeRank = 1e-4;    ///< eigenvalue of a free motion, of the largest one
constexpr double FreeShare = 0.95;   ///< of inliers that stay
constexpr double FarRadii = 6.0;     ///< of half of the points: what is farther is not the part
constexpr double LargestRatio = 5.0; ///< of the scan's size to the target's
constexpr double LeastRatio = 0.01;
constexpr double UsefulShare = 0.1;
constexpr double UsefulDistance = 0.05;

/// A subset of rows, spread over them without a period.
PointMatrix SubsetOf(const PointMatrix& points, Eigen::Index atMost)
{
  if (points.rows() <= atMost)
  {
    return points;
  }
  constexpr double golden = 0.6180339887498949;
  PointMatrix subset(atMost, points.cols());
  for (Eigen::Index i = 0; i < atMost; ++i)
  {
    const double jitter = std::fmod(static_cast<double>(i) * golden, 1.0);
    const double share = (static_cast<double>(i) + jitter) / static_cast<double>(atMost);
    subset.row(i) = points.row(std::min(
      points.rows() - 1, static_cast<Eigen::Index>(share * static_cast<double>(points.rows()))));
  }
  return subset;
}

/// Number of a point's cell of 2^10 a direction, neighbours near each other.
std::uint64_t MortonCode(const Eigen::RowVector3d& cell)
{
  std::uint64_t code = 0;
  for (int d = 0; d < 3; ++d)
  {
    const auto n = static_cast<std::uint64_t>(std::clamp(cell[d], 0.0, 1023.0));
    for (int bit = 0; bit < 10; ++bit)
    {
      code |= (n >> bit & 1) << (3 * bit + d);
    }
  }
  return code;
}

/// In an order in which neighbours follow each other: closest points are found faster so.
PointMatrix Ordered(const PointMatrix& points)
{
  const Eigen::RowVector3d lower = points.colwise().minCoeff();
  const double size = (points.colwise().maxCoeff() - lower).maxCoeff();
  std::vector<std::pair<std::uint64_t, Eigen::Index>> order;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    const Eigen::RowVector3d share = (points.row(i) - lower) / (size > 0.0 ? size : 1.0);
    order.emplace_back(MortonCode(1023.0 * share), i);
  }
  std::sort(order.begin(), order.end());
  PointMatrix ordered(points.rows(), 3);
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    ordered.row(static_cast<Eigen::Index>(i)) = points.row(order[i].second);
  }
  return ordered;
}

/// Weights that make up for uneven density: points of a cell share the median count of cells where
/// they are more.
Eigen::VectorXd DensityWeights(const PointMatrix& points)
{
  const Eigen::RowVector3d lower = points.colwise().minCoeff();
  const double size = (points.colwise().maxCoeff() - lower).maxCoeff();
  std::vector<std::uint64_t> code(static_cast<std::size_t>(points.rows()));
  std::map<std::uint64_t, int> counts;
  for (double cells = 256.0; cells >= 4.0; cells /= 1.5)
  {
    counts.clear();
    for (Eigen::Index i = 0; i < points.rows(); ++i)
    {
      const Eigen::RowVector3d share = (points.row(i) - lower) / (size > 0.0 ? size : 1.0);
      const std::uint64_t cell = MortonCode(cells * share);
      code[static_cast<std::size_t>(i)] = cell;
      ++counts[cell];
    }
    if (counts.size() <= CellsOfMoments)
    {
      break;
    }
  }
  std::vector<int> sorted;
  for (const auto& [cell, count] : counts)
  {
    sorted.push_back(count);
  }
  std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
  const int median = sorted[sorted.size() / 2];
  Eigen::VectorXd weights(points.rows());
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    const int count = counts[code[static_cast<std::size_t>(i)]];
    weights[i] = static_cast<double>(std::min(count, median)) / count;
  }
  return weights;
}

/// Of every coordinate.
Eigen::RowVector3d MedianOf(const PointMatrix& points)
{
  return { QuantileOf(points.col(0), 0.5), QuantileOf(points.col(1), 0.5),
    QuantileOf(points.col(2), 0.5) };
}

/// Half of the points are nearer to their median.
double RadiusOf(const PointMatrix& points)
{
  return QuantileOf((points.rowwise() - MedianOf(points)).rowwise().norm(), 0.5);
}

/// Middle, principal axes and radii of inertia of weighted points, the longest one first.
struct Moments
{
  Eigen::Vector3d Middle;
  Eigen::Matrix3d Axes; ///< columns, right-handed
  Eigen::Vector3d Radii;

  Moments(const PointMatrix& points, const Eigen::VectorXd& weights)
  {
    const double all = weights.sum();
    this->Middle = (weights.transpose() * points).transpose() / all;
    const PointMatrix arms = points.rowwise() - this->Middle.transpose();
    const Eigen::Matrix3d matrix = arms.transpose() * weights.asDiagonal() * arms / all;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
    this->Axes = solver.eigenvectors().rowwise().reverse();
    this->Axes.col(2) = this->Axes.col(0).cross(this->Axes.col(1));
    this->Radii = solver.eigenvalues().reverse().cwiseMax(0.0).cwiseSqrt();
  }
  bool IsAmbiguous() const
  {
    return this->Radii[1] > LikeRadii * this->Radii[0] ||
      this->Radii[2] > LikeRadii * this->Radii[1];
  }
};

/// The 24 proper rotations that take axes to axes.
std::vector<Eigen::Matrix3d> AxisRotations()
{
  std::vector<Eigen::Matrix3d> rotations;
  std::array<int, 3> order{ 0, 1, 2 };
  do
  {
    for (int signs = 0; signs < 8; ++signs)
    {
      Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();
      for (int d = 0; d < 3; ++d)
      {
        rotation(order[static_cast<std::size_t>(d)], d) = (signs >> d & 1) != 0 ? -1.0 : 1.0;
      }
      if (rotation.determinant() > 0.0)
      {
        rotations.push_back(rotation);
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
  // the identity and half turns first: they are the likely ones
  std::stable_sort(rotations.begin(), rotations.end(),
    [](const Eigen::Matrix3d& a, const Eigen::Matrix3d& b)
    { return a.diagonal().cwiseAbs().sum() > b.diagonal().cwiseAbs().sum(); });
  return rotations;
}

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

struct Pose
{
  AlignmentSteps Steps;
  double Score = std::numeric_limits<double>::infinity();
};

/// Whether the points determine a motion.
Status CheckExtent(const PointMatrix& points)
{
  const Moments moments(points, Eigen::VectorXd::Ones(points.rows()));
  if (!(moments.Radii[1] > 1e-6 * moments.Radii[0]))
  {
    return { ErrorCode::SingularSystem,
      "the " + std::to_string(points.rows()) +
        " points of the scan lie on one line: three that do not are needed" };
  }
  return {};
}

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

class Alignment
{
public:
  Alignment(const TriangleMesh& scan, const FitTarget& target, const AlignmentParams& params)
    : Scan(scan), Target(target), Params(params)
  {
  }

  Result<RigidAlignment> Run()
  {
    Status status = this->Prepare();
    std::vector<Pose> poses(1);
    if (status)
    {
      poses[0].Steps.OutlierDistance = StartDistance * this->Size;
      status = this->Params.Coarse ? this->Search(poses) : status;
    }
    Pose best;
    status = status ? this->RefineBest(poses, best) : status;
    if (status)
    {
      this->Found.Motion = best.Steps.Motion;
      this->Found.Iterations = best.Steps.Iterations;
      this->Found.Converged = best.Steps.Converged;
      this->Found.LastStep = best.Steps.LastStep;
      this->Found.OutlierDistance = best.Steps.OutlierDistance;
      status = this->CountFreeMotions();
    }
    if (status && this->Params.Coarse)
    {
      if (this->Found.FreeMotions > 0)
      {
        this->Found.EqualPoses = 0;
      }
      else
      {
        status = this->CountPoses(poses);
      }
    }
    status = status ? this->Measure() : status;
    return status ? Result<RigidAlignment>(std::move(this->Found)) : status;
  }

private:
  /// Shares of the progress in the order of the stages.
  ProgressCallback Part(double begin, double end) const
  {
    return PartOf(this->Params.Progress, begin, end);
  }
  TargetDistanceParams Searching(ProgressCallback progress = {}) const
  {
    return { this->Params.Threads, std::move(progress) };
  }
  FootFinder OnTarget() const
  {
    return [this](const PointMatrix& queries, TargetPoints& feet)
    { return FindOnTarget(this->Target, queries, feet, this->Searching()); };
  }
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

  Status Prepare()
  {
    if (!this->Target.HasSurface())
    {
      return { ErrorCode::EmptyInput,
        "the target has no faces: give triangles, spline surfaces, a CAD file or a volume" };
    }
    const TargetSamples samples = this->Target.Samples(SpreadSamples);
    const PointMatrix& points = samples.Points;
    this->Size =
      points.rows() > 0 ? (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm() : 0.0;
    if (!(this->Size > 0.0) || !(samples.Areas.sum() > 0.0))
    {
      return { ErrorCode::EmptyInput, "the target has no extent: its faces have no area" };
    }
    this->Found.TargetSize = this->Size;
    this->IsMesh = !this->Scan.Triangles.empty();
    PointMatrix spread = this->Scan.Points;
    Eigen::VectorXd weights;
    if (this->IsMesh)
    {
      TriangleSamples found =
        SampleTriangles(this->Scan.Points, this->Scan.Triangles, SpreadSamples);
      spread = std::move(found.Points);
      weights = std::move(found.Areas);
    }
    this->IsMesh = this->IsMesh && weights.sum() > 0.0;
    if (!this->IsMesh)
    {
      spread = SubsetOf(this->Scan.Points, SpreadSamples);
      weights = DensityWeights(spread);
    }
    const double targetRadius = RadiusOf(this->EvenSubset(points, samples.Areas));
    const double ratio = this->DropFar(spread, weights) / targetRadius;
    if (ratio > LargestRatio || ratio < LeastRatio)
    {
      return { ErrorCode::InvalidParameter,
        "the scan is " + Digits(ratio, 3) +
          " times as large as the target: give both in the same unit" };
    }
    this->Found.SizeRatio = ratio;
    const Moments ofScan(spread, weights);
    const Moments ofTarget(points, samples.Areas);
    this->Spread = Ordered(this->IsMesh ? this->EvenSubset(spread, weights) : spread);
    this->Points = Ordered(SubsetOf(this->Scan.Points, this->Params.Samples));
    this->Rotations = this->Candidates(ofScan, ofTarget);
    this->MiddleOfScan = ofScan.Middle;
    this->MiddleOfTarget = ofTarget.Middle;
    this->TargetSpread = Ordered(this->EvenSubset(points, samples.Areas));
    return {};
  }

  /// Leaves out points that are far from most; half of the others are nearer than the result.
  double DropFar(PointMatrix& points, Eigen::VectorXd& weights) const
  {
    const PointMatrix even = this->IsMesh ? this->EvenSubset(points, weights) : points;
    const double radius = RadiusOf(even);
    const Eigen::RowVector3d middle = MedianOf(even);
    Eigen::Index kept = 0;
    for (Eigen::Index i = 0; i < points.rows(); ++i)
    {
      if ((points.row(i) - middle).norm() <= FarRadii * radius)
      {
        points.row(kept) = points.row(i);
        weights[kept++] = weights[i];
      }
    }
    points.conservativeResize(kept, 3);
    weights.conservativeResize(kept);
    return radius;
  }

  /// Points as dense as their weights say: every sum of weights that is a multiple of a step.
  PointMatrix EvenSubset(const PointMatrix& points, const Eigen::VectorXd& weights) const
  {
    const double step = weights.sum() / SpreadSamples;
    std::vector<Eigen::Index> taken;
    double sum = 0.0;
    double next = 0.5 * step;
    for (Eigen::Index i = 0; i < points.rows(); ++i)
    {
      sum += weights[i];
      if (sum >= next)
      {
        taken.push_back(i);
        next = std::max(next + step, sum);
      }
    }
    PointMatrix subset(static_cast<Eigen::Index>(taken.size()), 3);
    for (std::size_t i = 0; i < taken.size(); ++i)
    {
      subset.row(static_cast<Eigen::Index>(i)) = points.row(taken[i]);
    }
    return subset;
  }

  /// By the axes; the even ones too where axes are ambiguous.
  std::vector<Eigen::Matrix3d> Candidates(const Moments& ofScan, const Moments& ofTarget)
  {
    std::vector<Eigen::Matrix3d> rotations;
    for (const Eigen::Matrix3d& turn : AxisRotations())
    {
      rotations.push_back(ofTarget.Axes * turn * ofScan.Axes.transpose());
    }
    this->AreAxesAmbiguous = ofScan.IsAmbiguous() || ofTarget.IsAmbiguous();
    return rotations;
  }

  RigidMotion MotionOf(const Eigen::Matrix3d& rotation) const
  {
    return { rotation, this->MiddleOfTarget - rotation * this->MiddleOfScan };
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
    const PointMatrix own = SubsetOf(this->Spread, samples);
    const PointMatrix other = SubsetOf(this->TargetSpread, samples);
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
            auto steps = StepToTarget(own, { poses[i].Steps.Motion, distance }, step);
            statuses[i] = steps.Status;
            if (steps)
            {
              poses[i].Steps = std::move(steps.Value);
              poses[i].Score =
                this->SampledScore(poses[i].Steps.Motion, own, other, ScoreDistance * this->Size);
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

  /// How far the scan's points move from one pose to another at most, about.
  double Between(const RigidMotion& a, const RigidMotion& b) const
  {
    const double angle = Eigen::AngleAxisd(a.Rotation * b.Rotation.transpose()).angle();
    const Eigen::Vector3d shift = a.Rotation * this->MiddleOfScan + a.Translation -
      b.Rotation * this->MiddleOfScan - b.Translation;
    return 0.5 * this->Size * angle + shift.norm();
  }

  /// The first of poses that are one.
  void Distinguish(std::vector<Pose>& poses, double distance, std::size_t atMost) const
  {
    std::vector<Pose> kept;
    for (Pose& pose : poses)
    {
      const auto isSame = [&](const Pose& other)
      { return this->Between(pose.Steps.Motion, other.Steps.Motion) < distance; };
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
      pose.Steps.Motion = this->MotionOf(rotation);
    }
    AlignmentStepParams step;
    step.Find = this->OnSamples();
    step.Size = this->Size;
    step.PointWeight = 0.1;
    step.Tolerance = 1e-3 * this->Size;
    step.MaxIterations = 8;
    step.LeastOutlierDistance = FirstDistance * this->Size; // stays
    if (Status status =
          this->Improve(poses, FirstSamples, step, step.LeastOutlierDistance, progress);
        !status)
    {
      return status;
    }
    this->Distinguish(poses, 0.2 * SamePose * this->Size, NextPoses);
    step.MaxIterations = 20;
    step.LeastOutlierDistance = LastSearchDistance * this->Size;
    step.PointWeight = 0.01;
    if (Status status =
          this->Improve(poses, NextSamples, step, NextDistance * this->Size, progress);
        !status)
    {
      return status;
    }
    this->Distinguish(poses, SamePose * this->Size, MaxPoses);
    return {};
  }

  Status Search(std::vector<Pose>& poses)
  {
    TargetPoints feet;
    if (Status status = FindOnTarget(
          this->Target, this->TargetSpread, feet, this->Searching(this->Part(0.0, 0.05)));
        !status)
    {
      return status;
    }
    this->TargetIndex = SampleIndex(this->TargetSpread);
    this->TargetNormals = feet.Normals;
    this->ScanIndex = SampleIndex(this->Spread);
    std::vector<Eigen::Matrix3d> rotations = this->Rotations;
    const auto addEven = [&]()
    {
      const auto even = SpiralRotations(EvenRotations);
      rotations.insert(rotations.end(), even.begin(), even.end());
    };
    if (this->AreAxesAmbiguous)
    {
      addEven();
    }
    Status status = this->SearchAmong(rotations, poses, this->Part(0.05, 0.2));
    if (status && !this->AreAxesAmbiguous && poses.front().Score > GoodScore)
    {
      addEven(); // the scan has other axes: parts are missing, or there is more
      status = this->SearchAmong(rotations, poses, this->Part(0.2, 0.4));
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

  /// Steps on the target itself, and exact distances.
  Status ComparePoses(std::vector<Pose>& poses) const
  {
    AlignmentStepParams step;
    step.Find = this->OnTarget();
    step.Size = this->Size;
    step.Tolerance = 1e-6 * this->Size;
    step.MaxIterations = 25;
    step.LeastOutlierDistance = LeastScoreDistance * this->Size;
    const PointMatrix own = SubsetOf(this->IsMesh ? this->Spread : this->Points, NextSamples);
    std::vector<Eigen::VectorXd> distances;
    double outlierDistance = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < poses.size(); ++i)
    {
      step.Progress =
        this->Part(0.4 + 0.2 * static_cast<double>(i) / static_cast<double>(poses.size()),
          0.4 + 0.2 * static_cast<double>(i + 1) / static_cast<double>(poses.size()));
      auto steps =
        StepToTarget(own, { poses[i].Steps.Motion, LastSearchDistance * this->Size }, step);
      if (!steps)
      {
        return steps.Status;
      }
      poses[i].Steps = std::move(steps.Value);
      const PointMatrix moved = poses[i].Steps.Motion.Move(own);
      TargetPoints feet;
      if (Status status = FindOnTarget(this->Target, moved, feet, this->Searching()); !status)
      {
        return status;
      }
      distances.push_back(DistancesOf(moved, feet));
      outlierDistance = std::min(outlierDistance, poses[i].Steps.OutlierDistance);
    }
    const PointMatrix other = SubsetOf(this->TargetSpread, NextSamples);
    for (std::size_t i = 0; i < poses.size(); ++i)
    {
      const auto bounded = [&](double d)
      { return std::min(1.0, d * d / (outlierDistance * outlierDistance)); };
      const double back = this->SampledScore(
        poses[i].Steps.Motion, PointMatrix::Zero(1, 3), other, ScoreDistance * this->Size);
      poses[i].Score = distances[i].unaryExpr(bounded).mean() + back;
    }
    std::stable_sort(
      poses.begin(), poses.end(), [](const Pose& a, const Pose& b) { return a.Score < b.Score; });
    return {};
  }

  Status RefineBest(const std::vector<Pose>& poses, Pose& best) const
  {
    best = poses.front();
    AlignmentStepParams step;
    step.Find = this->OnTarget();
    step.Size = this->Size;
    step.MaxIterations = this->Params.MaxIterations;
    step.Tolerance = this->Params.Tolerance * this->Size;
    step.LeastOutlierDistance = LeastDistance * this->Size;
    const double from =
      this->Params.Coarse ? LastSearchDistance * this->Size : StartDistance * this->Size;
    const auto run = [&](const PointMatrix& points)
    {
      auto steps = StepToTarget(points, { best.Steps.Motion, from }, step);
      if (steps)
      {
        best.Steps = std::move(steps.Value);
      }
      return steps.Status;
    };
    if (this->IsMesh && this->Points.rows() < MinMeshPoints)
    {
      // few points do not hold the scan in its place, but only they are exact
      step.MaxIterations = 50;
      if (Status status = run(SubsetOf(this->Spread, PoseSamples)); !status)
      {
        return status;
      }
      step.MaxIterations = this->Params.MaxIterations;
    }
    else if (!this->Params.Coarse)
    {
      step.MaxIterations = 50;
      if (Status status = run(SubsetOf(this->Points, PoseSamples)); !status)
      {
        return status;
      }
      step.MaxIterations = this->Params.MaxIterations;
    }
    step.Outliers = this->Params.Outliers;
    step.TrimmedShare = this->Params.TrimmedShare;
    step.Progress = this->Part(0.6, 0.8);
    return run(this->Points);
  }

  /// Of what the scan shows, slid along what its equations do not hold.
  Status CountFreeMotions()
  {
    const PointMatrix own = SubsetOf(this->IsMesh ? this->Spread : this->Points, PoseSamples);
    const PointMatrix moved = this->Found.Motion.Move(own);
    TargetPoints feet;
    if (Status status = FindOnTarget(this->Target, moved, feet, this->Searching()); !status)
    {
      return status;
    }
    const Eigen::VectorXd distances = DistancesOf(moved, feet);
    // points of triangles sag
    const double limit = std::max(
      { this->InlierDistance(), 3.0 * QuantileOf(distances, 0.5), SameTarget * this->Size });
    const Eigen::VectorXd weights = (distances.array() <= limit).cast<double>();
    const MotionEquations equations =
      EquationsOf(moved, feet, weights, 0.0, std::numeric_limits<double>::infinity());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(equations.Matrix);
    for (int k = 0; k < 6; ++k)
    {
      if (solver.eigenvalues()[k] > FreeRank * solver.eigenvalues()[5])
      {
        break;
      }
      const double shift = FreeShift * this->Size;
      const PointMatrix slid = equations.Step(shift * solver.eigenvectors().col(k)).Move(moved);
      if (Status status = FindOnTarget(this->Target, slid, feet, this->Searching()); !status)
      {
        return status;
      }
      // an edge of the second order leaves within the square of the shift
      const Eigen::VectorXd after = DistancesOf(slid, feet);
      const double stay = ((after.array() <= 2.0 * limit).cast<double>() * weights.array()).sum();
      this->Found.FreeMotions += stay >= FreeShare * weights.sum() ? 1 : 0;
    }
    return {};
  }

  double InlierDistance() const
  {
    return std::isfinite(this->Found.OutlierDistance) ? this->Found.OutlierDistance : 0.0;
  }

  /// Bounded squares of distances of the scan's points and, back, of the target's samples.
  Status Residuals(const RigidMotion& motion, double distance, double back, Eigen::VectorXd& result,
    double* medianBack = nullptr) const
  {
    const PointMatrix moved = motion.Move(this->Points);
    TargetPoints feet;
    if (Status status = FindOnTarget(this->Target, moved, feet, this->Searching()); !status)
    {
      return status;
    }
    const Eigen::VectorXd own = DistancesOf(moved, feet);
    const PointMatrix inverse = motion.Inverse().Move(this->TargetSpread);
    Eigen::VectorXd other(inverse.rows());
    ParallelFor(static_cast<std::size_t>(inverse.rows()), 256, this->Params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (auto i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end); ++i)
        {
          const double* const at = inverse.row(i).data();
          other[i] = std::sqrt(this->IsMesh ? this->ScanTriangles.Nearest(at).SquaredDistance
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
    const PointMatrix moved = motion.Move(SubsetOf(this->TargetSpread, 2 * PoseSamples));
    TargetPoints feet;
    if (Status status = FindOnTarget(this->Target, moved, feet, this->Searching()); !status)
    {
      return status;
    }
    return DistancesOf(moved, feet).maxCoeff() <= distance;
  }

  Status CountPoses(const std::vector<Pose>& poses)
  {
    if (this->IsMesh)
    {
      this->ScanTriangles = TriangleIndex<3>(this->Scan.Points, this->Scan.Triangles);
    }
    const double distance = std::max(this->InlierDistance(), LeastDistance * this->Size);
    double median = 0.0;
    Eigen::VectorXd best;
    if (Status status = this->Residuals(this->Found.Motion, distance, 0.0, best, &median); !status)
    {
      return status;
    }
    AlignmentStepParams step;
    step.Find = this->OnTarget();
    step.Size = this->Size;
    step.MaxIterations = 50;
    step.Tolerance = this->Params.Tolerance * this->Size;
    step.LeastOutlierDistance = LeastDistance * this->Size;
    std::vector<RigidMotion> equal{ this->Found.Motion };
    const PointMatrix own = SubsetOf(this->Points, PoseSamples);
    for (std::size_t i = 0; i < poses.size(); ++i)
    {
      if (poses[i].Score > poses.front().Score + PoseMargin)
      {
        continue;
      }
      step.Progress =
        this->Part(0.8 + 0.1 * static_cast<double>(i) / static_cast<double>(poses.size()),
          0.8 + 0.1 * static_cast<double>(i + 1) / static_cast<double>(poses.size()));
      RigidMotion start = poses[i].Steps.Motion;
      const auto steps = StepToTarget(own, { start, 0.1 * LastSearchDistance * this->Size }, step);
      if (!steps)
      {
        return steps.Status;
      }
      const RigidMotion& motion = steps->Motion;
      const auto isSame = [&](const RigidMotion& other)
      { return this->Between(motion, other) < SamePose * this->Size; };
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
          motion * this->Found.Motion.Inverse(), std::max(distance, SameTarget * this->Size));
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
    this->Found.EqualPoses = static_cast<int>(equal.size());
    return {};
  }

  Status Measure()
  {
    const auto sides = SidesOf(this->Target, this->Searching(this->Part(0.9, 0.92)));
    if (!sides)
    {
      return sides.Status;
    }
    auto measured = MeasureTargetDistances(this->Target, this->Found.Motion.Move(this->Scan.Points),
      sides.Value, this->Searching(this->Part(0.92, 1.0)));
    if (!measured)
    {
      return measured.Status;
    }
    this->Found.Deviation = std::move(measured.Value);
    const Eigen::VectorXd& distances = this->Found.Deviation.Distances;
    this->Found.Profile = ProfileOf(distances);
    double squares = 0.0;
    int near = 0;
    for (const double d : distances)
    {
      if (std::abs(d) <= this->Found.OutlierDistance)
      {
        ++this->Found.NumInliers;
        squares += d * d;
      }
      near += std::abs(d) <= UsefulDistance * this->Size ? 1 : 0;
    }
    this->Found.InlierRms =
      this->Found.NumInliers > 0 ? std::sqrt(squares / this->Found.NumInliers) : 0.0;
    if (near < UsefulShare * static_cast<double>(distances.size()))
    {
      return { ErrorCode::NotConverged,
        "only " + std::to_string(near) + " of " + std::to_string(distances.size()) +
          " points of the scan come near the target: give a scan of this part" +
          (this->Params.Coarse ? "" : ", near its place or with the search for a pose") };
    }
    return {};
  }

  const TriangleMesh& Scan;
  const FitTarget& Target;
  const AlignmentParams& Params;
  RigidAlignment Found;
  double Size = 0.0; ///< of the target
  bool IsMesh = false;
  bool AreAxesAmbiguous = false;
  PointMatrix Points;       ///< of the scan
  PointMatrix Spread;       ///< evenly on the scan's triangles; of its points where it has none
  PointMatrix TargetSpread; ///< evenly on the target
  PointMatrix TargetNormals;
  SampleIndex TargetIndex;
  SampleIndex ScanIndex;
  TriangleIndex<3> ScanTriangles;
  std::vector<Eigen::Matrix3d> Rotations;
  Eigen::Vector3d MiddleOfScan;
  Eigen::Vector3d MiddleOfTarget;
};
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
  status = status ? CheckExtent(scan.Points) : status;
  return status ? Alignment(scan, target, params).Run() : Result<RigidAlignment>(status);
}
}
