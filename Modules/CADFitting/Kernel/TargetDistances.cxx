// SPDX-License-Identifier: BSD-3-Clause
#include "TargetDistances.h"

#include "QueryBlocks.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr double AlongNormal = 0.99;   ///< cosine from which on a foot is inside of a face
constexpr double ProbeDistance = 1e-5; ///< of the target's size, for the normals at an edge
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
  return RunInBlocks(count, params.Threads, params.Progress, "the search for closest points",
    [&](Eigen::Index begin, Eigen::Index end)
    {
      const Eigen::Index rows = end - begin;
      TargetPoints own;
      if (Status status = target.Find(params.Part, queries.middleRows(begin, rows), own); !status)
      {
        return status;
      }
      result.Points.middleRows(begin, rows) = own.Points;
      result.Normals.middleRows(begin, rows) = own.Normals;
      std::copy(own.Faces.begin(), own.Faces.end(), result.Faces.begin() + begin);
      return Status();
    });
}

Result<TargetSides> SidesOf(const FitTarget& target, const TargetDistanceParams& params)
{
  TargetSides sides;
  const TargetSamples samples = target.Samples(OrientationSamples);
  if (samples.Points.rows() == 0)
  {
    return sides;
  }
  sides.Size = (samples.Points.colwise().maxCoeff() - samples.Points.colwise().minCoeff()).norm();
  if (!target.IsClosed())
  {
    return sides;
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
  sides.Outward = volume < 0.0 ? -1.0 : 1.0;
  return sides;
}

Result<TargetDistances> MeasureTargetDistances(const FitTarget& target,
  const PointMatrixView& queries, const TargetSides& sides, const TargetDistanceParams& params)
{
  TargetDistances measured;
  if (Status status = FindOnTarget(
        target, queries, measured.Feet, { params.Threads, PartOf(params.Progress, 0.0, 0.5) });
      !status)
  {
    return status;
  }
  measured.Distances.resize(queries.rows());
  const double step = ProbeDistance * sides.Size;
  const Status status = RunInBlocks(static_cast<std::size_t>(queries.rows()), params.Threads,
    PartOf(params.Progress, 0.5, 1.0), "the measurement of distances",
    [&](Eigen::Index begin, Eigen::Index end)
    {
      for (Eigen::Index i = begin; i < end; ++i)
      {
        const Eigen::RowVector3d offset = queries.row(i) - measured.Feet.Points.row(i);
        const double distance = offset.norm();
        measured.Distances[i] = distance;
        if (target.IsClosed() && sides.Size > 0.0 && distance > sides.Size)
        {
          continue; // outside, wherever rounding puts the closest point
        }
        Eigen::RowVector3d normal = measured.Feet.Normals.row(i);
        if (distance > step && std::abs(offset.dot(normal)) < AlongNormal * distance)
        {
          if (Status found = SumNormals(target, measured.Feet.Points.row(i), step, normal); !found)
          {
            return found;
          }
        }
        if (offset.dot(normal) * sides.Outward < 0.0)
        {
          measured.Distances[i] = -distance;
        }
      }
      return Status();
    });
  return status ? Result<TargetDistances>(std::move(measured)) : status;
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
