// SPDX-License-Identifier: BSD-3-Clause
#include "AlignmentSteps.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
constexpr double TukeyConstant = 4.685; ///< 95 % as good as least squares for normal noise
// of normal noise so many absolute values lie within so many standard deviations; not the median,
// which is 0 where half of a scan is exact
constexpr double NoiseShare = 0.8;
constexpr double NoiseDeviations = 1.2816;
constexpr double NoiseWindow = 0.01;   ///< of the size: what is farther does not count as noise
constexpr double RankTolerance = 1e-8; ///< of the largest eigenvalue
constexpr double LargestTurn = 0.5;    ///< of a step, radians
constexpr double LargestShift = 0.25;  ///< of a step, of the target's size
constexpr double TangentCosine = 0.7;  ///< below it a foot lies on an edge, and the distance counts
constexpr double Tiny = 1e-9;   ///< of the size: below it a direction from the foot says nothing
constexpr double Settled = 0.1; ///< of the outlier distance: steps at which it may fall
constexpr double FallOfDistance = 1.0 / 3.0;
constexpr int StepsAtDistance = 8;
constexpr int StepsAtNoise = 10;  ///< after which the outlier distance stays
constexpr double OpenShare = 0.1; ///< of noise / sqrt(number of points)

/// Standard deviation of the distances below a limit.
double NoiseOf(const Eigen::VectorXd& distances, double limit)
{
  Eigen::VectorXd inside(distances.size());
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < distances.size(); ++i)
  {
    if (distances[i] < limit)
    {
      inside[count++] = distances[i];
    }
  }
  return count == 0 ? limit : QuantileOf(inside.head(count), NoiseShare) / NoiseDeviations;
}

Eigen::VectorXd TukeyWeights(const Eigen::VectorXd& distances, double limit)
{
  return distances.unaryExpr(
    [limit](double d)
    {
      const double share = d / limit;
      return share < 1.0 ? (1.0 - share * share) * (1.0 - share * share) : 0.0;
    });
}
}

FootFinder OnTarget(const FitTarget& target, int threads)
{
  return [&target, threads](const PointMatrix& queries, TargetPoints& feet) {
    return FindOnTarget(target, queries, feet, { threads, {} });
  };
}

Eigen::VectorXd DistancesOf(const PointMatrix& moved, const TargetPoints& feet)
{
  return (moved - feet.Points).rowwise().norm();
}

double QuantileOf(Eigen::VectorXd values, double share)
{
  if (values.size() == 0)
  {
    return 0.0;
  }
  const auto rank =
    static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(values.size())));
  double* const at = values.data() + std::clamp<std::ptrdiff_t>(rank - 1, 0, values.size() - 1);
  std::nth_element(values.data(), at, values.data() + values.size());
  return *at;
}

RigidMotion MotionEquations::Step(const Eigen::Matrix<double, 6, 1>& values) const
{
  const Eigen::Vector3d turn = values.head<3>() / this->Radius;
  const double angle = turn.norm();
  RigidMotion motion;
  if (angle > 0.0)
  {
    motion.Rotation = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  }
  motion.Translation = this->Middle - motion.Rotation * this->Middle + values.tail<3>();
  return motion;
}

MotionEquations EquationsOf(const PointMatrix& moved, const TargetPoints& feet,
  const Eigen::VectorXd& weights, double pointWeight, double tiny)
{
  MotionEquations equations;
  const double all = weights.sum();
  if (!(all > 0.0))
  {
    return equations;
  }
  equations.Middle = (weights.transpose() * moved).transpose() / all;
  const Eigen::VectorXd squares =
    (moved.rowwise() - equations.Middle.transpose()).rowwise().squaredNorm();
  equations.Radius = std::sqrt(squares.dot(weights) / all);
  equations.Radius = equations.Radius > 0.0 ? equations.Radius : 1.0;
  for (Eigen::Index i = 0; i < moved.rows(); ++i)
  {
    if (weights[i] <= 0.0)
    {
      continue;
    }
    const Eigen::Vector3d arm = (moved.row(i).transpose() - equations.Middle) / equations.Radius;
    const Eigen::Vector3d offset = (moved.row(i) - feet.Points.row(i)).transpose();
    const auto add = [&](const Eigen::Vector3d& direction, double distance, double weight)
    {
      Eigen::Matrix<double, 6, 1> row;
      row << arm.cross(direction), direction;
      equations.Matrix += weight * row * row.transpose();
      equations.Right -= weight * distance * row;
    };
    const Eigen::Vector3d normal = feet.Normals.row(i).transpose();
    const double distance = offset.norm();
    if (!normal.isZero() &&
      (distance <= tiny || std::abs(offset.dot(normal)) >= TangentCosine * distance ||
        pointWeight > 0.0))
    {
      add(normal, offset.dot(normal), weights[i]);
    }
    else if (distance > tiny)
    {
      add(offset / distance, distance, weights[i]);
    }
    for (int d = 0; d < 3 && pointWeight > 0.0; ++d)
    {
      add(Eigen::Vector3d::Unit(d), offset[d], weights[i] * pointWeight);
    }
  }
  return equations;
}

Result<AlignmentSteps> StepToTarget(
  const PointMatrix& scan, const AlignmentStart& start, const AlignmentStepParams& params)
{
  AlignmentSteps steps;
  steps.Motion = start.Motion;
  double limit = std::max(start.OutlierDistance, params.LeastOutlierDistance);
  const bool isFixed = limit <= params.LeastOutlierDistance;
  const Eigen::Vector3d middle = scan.colwise().mean().transpose();
  const double radius = (scan.rowwise() - middle.transpose()).rowwise().norm().maxCoeff();
  const double window = NoiseWindow * params.Size;
  Eigen::Matrix<double, 6, 1> last = Eigen::Matrix<double, 6, 1>::Zero();
  double damping = 1.0;
  int atLimit = 0;
  int atNoise = 0;
  TargetPoints feet;
  while (steps.Iterations < params.MaxIterations)
  {
    if (params.Progress &&
      !params.Progress(static_cast<double>(steps.Iterations) / params.MaxIterations))
    {
      return { ErrorCode::Aborted, "the alignment stopped" };
    }
    const PointMatrix moved = steps.Motion.Move(scan);
    if (Status status = params.Find(moved, feet); !status)
    {
      return status;
    }
    const Eigen::VectorXd distances = DistancesOf(moved, feet);
    Eigen::VectorXd weights;
    bool mayEnd = true;
    switch (params.Outliers)
    {
      case OutlierRule::Tukey:
        if (!isFixed && atNoise < StepsAtNoise)
        {
          // what the noise asks for; a limit that has come down to it may rise again, for a while
          const double least = std::max(TukeyConstant * NoiseOf(distances, std::max(limit, window)),
            params.LeastOutlierDistance);
          if (limit <= 1.001 * least)
          {
            mayEnd = limit >= 0.999 * least;
            limit = least;
            ++atNoise;
          }
          else
          {
            mayEnd = false;
            if (steps.Iterations > 0 &&
              (steps.LastStep < Settled * limit || atLimit >= StepsAtDistance))
            {
              limit = std::max(FallOfDistance * limit, least);
              atLimit = 0;
            }
          }
        }
        weights = TukeyWeights(distances, limit);
        break;
      case OutlierRule::Trimmed:
        limit = QuantileOf(distances, 1.0 - params.TrimmedShare);
        weights = (distances.array() <= limit).cast<double>();
        break;
      case OutlierRule::None:
        limit = std::numeric_limits<double>::infinity();
        weights.setOnes(distances.size());
        break;
    }
    ++steps.Iterations;
    ++atLimit;
    steps.OutlierDistance = limit;
    const MotionEquations equations =
      EquationsOf(moved, feet, weights, params.PointWeight, Tiny * params.Size);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(equations.Matrix);
    const double largest = solver.eigenvalues()[5];
    if (!(largest > 0.0))
    {
      break; // no point is near the target
    }
    Eigen::Matrix<double, 6, 1> values = Eigen::Matrix<double, 6, 1>::Zero();
    for (int k = 0; k < 6; ++k)
    {
      if (solver.eigenvalues()[k] > RankTolerance * largest)
      {
        const Eigen::Matrix<double, 6, 1> direction = solver.eigenvectors().col(k);
        values += direction * (direction.dot(equations.Right) / solver.eigenvalues()[k]);
      }
    }
    values *= std::min({ 1.0, LargestTurn * equations.Radius / values.head<3>().norm(),
      LargestShift * params.Size / values.tail<3>().norm() });
    // steps to and fro across a place where closest points jump get shorter
    if (mayEnd && values.dot(last) < 0.0)
    {
      damping *= 0.5;
    }
    values *= damping;
    last = values;
    const Eigen::Vector3d before = steps.Motion.Rotation * middle + steps.Motion.Translation;
    const RigidMotion step = equations.Step(values);
    steps.Motion = step * steps.Motion;
    steps.LastStep = values.head<3>().norm() / equations.Radius * radius +
      (steps.Motion.Rotation * middle + steps.Motion.Translation - before).norm();
    // closest points near edges jump from face to face at every step: below what noise leaves open
    // the motion need not settle
    const double open =
      OpenShare * NoiseOf(distances, std::max(limit, window)) / std::sqrt(weights.sum());
    if (mayEnd && steps.LastStep <= std::max(params.Tolerance, open))
    {
      steps.Converged = true;
      break;
    }
  }
  // products of many rotations
  Eigen::Quaterniond turn(steps.Motion.Rotation);
  steps.Motion.Rotation = turn.normalized().toRotationMatrix();
  return steps;
}
}
