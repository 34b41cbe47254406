// SPDX-License-Identifier: BSD-3-Clause
#include "MeshNoise.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace knotwork
{
namespace
{
constexpr double CoreShare = 0.2;
constexpr double CoreHalf = 0.2533; // half width of that share about 0 of the normal distribution
constexpr double Window = 2.5;
constexpr double WindowMedian = 0.6651; // of |x| below Window
constexpr int Rounds = 20;
constexpr std::size_t LeastCount = 12; // of values: fewer say nothing
constexpr std::size_t QuadricPoints = 9;

/// Standard deviation of values of which many, maybe not most, are of one normal distribution.
double RobustDeviation(std::vector<double> values)
{
  if (values.size() < LeastCount)
  {
    return std::numeric_limits<double>::infinity();
  }
  std::sort(values.begin(), values.end());
  const auto core = static_cast<std::size_t>(CoreShare * static_cast<double>(values.size()));
  double centre = 0.0;
  double deviation = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + core < values.size(); ++i) // the shortest interval of that share
  {
    const double width = values[i + core] - values[i];
    if (0.5 * width / CoreHalf < deviation)
    {
      deviation = 0.5 * width / CoreHalf;
      centre = values[i] + 0.5 * width;
    }
  }
  std::vector<double> distances;
  for (int round = 0; round < Rounds; ++round)
  {
    const auto first = std::lower_bound(values.begin(), values.end(), centre - Window * deviation);
    const auto last = std::upper_bound(first, values.end(), centre + Window * deviation);
    if (first == last)
    {
      return deviation;
    }
    centre = *(first + (last - first) / 2);
    distances.clear();
    std::transform(first, last, std::back_inserter(distances),
      [&](double value) { return std::abs(value - centre); });
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    const double next = *middle / WindowMedian;
    if (std::abs(next - deviation) <= 1e-3 * deviation)
    {
      return next;
    }
    deviation = next;
  }
  return deviation;
}

double DeviationOfEdges(const SurfaceParts& parts)
{
  std::vector<double> values;
  for (std::size_t t = 0; t < parts.Mesh.Triangles.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const int other = parts.Adjacency.Triangle[t][k];
      if (static_cast<int>(t) >= other)
      {
        continue;
      }
      const auto o = static_cast<std::size_t>(other);
      const auto side = static_cast<std::size_t>(parts.Adjacency.Side[t][k]);
      const auto& own = parts.Mesh.Triangles[t];
      const Eigen::Vector3d a = parts.Mesh.Point(own[k]);
      const Eigen::Vector3d b = parts.Mesh.Point(own[(k + 1) % 3]);
      const Eigen::Vector3d c = parts.Mesh.Point(own[(k + 2) % 3]);
      const Eigen::Vector3d d = parts.Mesh.Point(parts.Mesh.Triangles[o][(side + 2) % 3]);
      // d as a combination of the others, but for its distance from their plane
      const Eigen::Vector3d& normal = parts.Normals[t];
      const double twice = 2.0 * parts.Areas[t];
      const double ofA = (c - b).cross(d - b).dot(normal) / twice;
      const double ofB = (a - c).cross(d - c).dot(normal) / twice;
      const double ofC = 1.0 - ofA - ofB;
      values.push_back((d - a).dot(normal) / std::sqrt(1.0 + ofA * ofA + ofB * ofB + ofC * ofC));
    }
  }
  return RobustDeviation(std::move(values));
}

double DeviationOfPoints(const SurfaceParts& parts)
{
  const DiscMesh& mesh = parts.Mesh;
  std::vector<Eigen::Vector3d> normals(
    static_cast<std::size_t>(mesh.NumPoints()), Eigen::Vector3d::Zero());
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    for (const int corner : mesh.Triangles[t])
    {
      normals[static_cast<std::size_t>(corner)] += parts.Areas[t] * parts.Normals[t];
    }
  }
  std::vector<double> values;
  std::vector<int> ring;
  for (int v = 0; v < mesh.NumPoints(); ++v)
  {
    ring.assign(1, v);
    const auto addRing = [&](int of)
    {
      for (int j = mesh.FanStart[static_cast<std::size_t>(of)];
           j < mesh.FanStart[static_cast<std::size_t>(of) + 1]; ++j)
      {
        ring.push_back(mesh.Fan[static_cast<std::size_t>(j)]);
      }
    };
    addRing(v);
    const std::size_t inner = ring.size();
    for (std::size_t i = 1; i < inner; ++i)
    {
      addRing(ring[i]);
    }
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    const Eigen::Vector3d& normal = normals[static_cast<std::size_t>(v)];
    if (ring.size() < QuadricPoints || normal.norm() == 0.0)
    {
      continue;
    }
    const Eigen::Vector3d up = normal.normalized();
    const Eigen::Vector3d along = up.unitOrthogonal();
    const Eigen::Vector3d across = up.cross(along);
    double radius = 0.0;
    for (const int p : ring)
    {
      radius = std::max(radius, (mesh.Point(p) - mesh.Point(v)).norm());
    }
    const auto rows = static_cast<Eigen::Index>(ring.size());
    Eigen::MatrixXd system(rows, 6);
    Eigen::VectorXd heights(rows);
    Eigen::Index own = 0;
    for (Eigen::Index i = 0; i < rows; ++i)
    {
      const int p = ring[static_cast<std::size_t>(i)];
      own = p == v ? i : own;
      const Eigen::Vector3d at = (mesh.Point(p) - mesh.Point(v)) / radius;
      const double x = at.dot(along);
      const double y = at.dot(across);
      system.row(i) << 1.0, x, y, x * x, x * y, y * y;
      heights[i] = at.dot(up);
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(system);
    if (qr.rank() < 6)
    {
      continue;
    }
    const Eigen::VectorXd residuals = heights - system * qr.solve(heights);
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(rows, own);
    const double share = (unit - system * qr.solve(unit))[own]; // of its own error in its residual
    if (share > 0.1)
    {
      values.push_back(radius * residuals[own] / std::sqrt(share));
    }
  }
  return RobustDeviation(std::move(values));
}
}

double EstimateNoise(const SurfaceParts& parts)
{
  const double deviation = std::min(DeviationOfEdges(parts), DeviationOfPoints(parts));
  return std::isfinite(deviation) ? deviation : 0.0;
}
}
