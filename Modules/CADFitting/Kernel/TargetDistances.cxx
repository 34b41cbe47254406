// SPDX-License-Identifier: BSD-3-Clause
#include "TargetDistances.h"

#include <knotwork/SplineCore/Parallel.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr std::size_t ChunkSize = 64;
constexpr std::size_t AtOnce = 8192;
constexpr double AlongNormal = 0.99;   ///< cosine from which on a foot is inside of a face
constexpr double ProbeDistance = 1e-5; ///< of the size of the queries, for the normals at an edge
constexpr int OrientationSamples = 20000;

/// Directions of the corners and faces of a cube.
PointMatrix Probes(const Eigen::RowVector3d& place, double distance)
{
  PointMatrix probes(26, 3);
  Eigen::Index row = 0;
  for (int i = 0; i < 27; ++i)
  {
    const Eigen::RowVector3d step(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    if (!step.isZero())
    {
      probes.row(row++) = place + distance * step.normalized();
    }
  }
  return probes;
}

/// The sum of the different normals around a place.
Status SumNormals(const FitTarget& target, const Eigen::RowVector3d& place, double distance,
  Eigen::RowVector3d& sum)
{
  TargetPoints feet;
  if (Status status = target.Find({}, Probes(place, distance), feet); !status)
  {
    return status;
  }
  std::vector<Eigen::RowVector3d> found;
  sum.setZero();
  for (Eigen::Index i = 0; i < feet.Normals.rows(); ++i)
  {
    const Eigen::RowVector3d normal = feet.Normals.row(i);
    const auto isSame = [&](const Eigen::RowVector3d& other) { return normal.dot(other) > 0.999; };
    if (!normal.isZero() && std::none_of(found.begin(), found.end(), isSame))
    {
      found.push_back(normal);
      sum += normal;
    }
  }
  return {};
}
}

Status FindOnTarget(const FitTarget& target, const PointMatrixView& queries, TargetPoints& result,
  const TargetDistanceParams& params)
{
  const auto count = static_cast<std::size_t>(queries.rows());
  result.Points.resize(queries.rows(), 3);
  result.Normals.resize(queries.rows(), 3);
  result.Faces.resize(count);
  for (std::size_t first = 0; first < count; first += AtOnce)
  {
    if (params.Progress &&
      !params.Progress(static_cast<double>(first) / static_cast<double>(count)))
    {
      return { ErrorCode::Aborted, "the search for closest points stopped" };
    }
    const std::size_t here = std::min(AtOnce, count - first);
    std::vector<Status> statuses((here + ChunkSize - 1) / ChunkSize);
    ParallelFor(here, ChunkSize, params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        const auto row = static_cast<Eigen::Index>(first + begin);
        const auto rows = static_cast<Eigen::Index>(end - begin);
        TargetPoints own;
        Status& status = statuses[begin / ChunkSize];
        status = target.Find({}, queries.middleRows(row, rows), own);
        if (status)
        {
          result.Points.middleRows(row, rows) = own.Points;
          result.Normals.middleRows(row, rows) = own.Normals;
          std::copy(own.Faces.begin(), own.Faces.end(), result.Faces.begin() + row);
        }
      });
    for (const Status& status : statuses)
    {
      if (!status)
      {
        return status;
      }
    }
  }
  return {};
}

Result<double> OutwardSign(const FitTarget& target, const TargetDistanceParams& params)
{
  if (!target.IsClosed())
  {
    return 1.0;
  }
  const TargetSamples samples = target.Samples(OrientationSamples);
  if (samples.Points.rows() == 0)
  {
    return 1.0;
  }
  TargetPoints feet;
  if (Status status = FindOnTarget(target, samples.Points, feet, params); !status)
  {
    return status;
  }
  const Eigen::RowVector3d middle = samples.Points.colwise().mean();
  double volume = 0.0;
  for (Eigen::Index i = 0; i < samples.Points.rows(); ++i)
  {
    volume += samples.Areas[i] * feet.Normals.row(i).dot(samples.Points.row(i) - middle);
  }
  return volume < 0.0 ? -1.0 : 1.0;
}

Result<TargetDistances> MeasureTargetDistances(const FitTarget& target,
  const PointMatrixView& queries, double sign, const TargetDistanceParams& params)
{
  TargetDistances measured;
  if (Status status = FindOnTarget(target, queries, measured.Feet, params); !status)
  {
    return status;
  }
  const auto count = static_cast<std::size_t>(queries.rows());
  measured.Distances.resize(queries.rows());
  if (count == 0)
  {
    return measured;
  }
  const double size = (queries.colwise().maxCoeff() - queries.colwise().minCoeff()).norm();
  std::vector<Status> statuses((count + ChunkSize - 1) / ChunkSize);
  ParallelFor(count, ChunkSize, params.Threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (auto i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end); ++i)
      {
        const Eigen::RowVector3d offset = queries.row(i) - measured.Feet.Points.row(i);
        const double distance = offset.norm();
        Eigen::RowVector3d normal = measured.Feet.Normals.row(i);
        if (distance > ProbeDistance * size &&
          std::abs(offset.dot(normal)) < AlongNormal * distance)
        {
          Status status =
            SumNormals(target, measured.Feet.Points.row(i), ProbeDistance * size, normal);
          statuses[begin / ChunkSize] = status ? statuses[begin / ChunkSize] : status;
        }
        measured.Distances[i] = offset.dot(normal) * sign < 0.0 ? -distance : distance;
      }
    });
  for (const Status& status : statuses)
  {
    if (!status)
    {
      return status;
    }
  }
  return measured;
}

DistanceProfile ProfileOf(const Eigen::VectorXd& distances, const Eigen::VectorXd& weights)
{
  DistanceProfile profile;
  const Eigen::Index count = distances.size();
  profile.NumPoints = static_cast<int>(count);
  if (count == 0)
  {
    return profile;
  }
  const Eigen::VectorXd weight = weights.size() == count ? weights : Eigen::VectorXd::Ones(count);
  const double all = weight.sum();
  profile.Min = distances.minCoeff();
  profile.Max = distances.maxCoeff();
  profile.Mean = distances.dot(weight) / all;
  profile.MeanAbsolute = distances.cwiseAbs().dot(weight) / all;
  profile.Rms = std::sqrt(distances.cwiseAbs2().dot(weight) / all);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
    [&](Eigen::Index a, Eigen::Index b)
    { return std::abs(distances[a]) < std::abs(distances[b]); });
  double sum = 0.0;
  std::size_t level = 0;
  for (const Eigen::Index i : order)
  {
    sum += weight[i];
    // rounding of the sum must not move a level to the next point
    for (;
         level < PercentileLevels.size() && sum >= (PercentileLevels[level] / 100.0 - 1e-12) * all;
         ++level)
    {
      profile.Percentiles[level] = std::abs(distances[i]);
    }
  }
  for (; level < PercentileLevels.size(); ++level)
  {
    profile.Percentiles[level] = std::abs(distances[order.back()]);
  }
  return profile;
}
}
