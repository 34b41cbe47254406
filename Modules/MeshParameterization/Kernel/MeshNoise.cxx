// SPDX-License-Identifier: BSD-3-Clause
#include "MeshNoise.h"

#include "VisitBlocks.h"

#include <knotwork/SplineCore/Parallel.h>

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
constexpr std::size_t MostSpokes = 30; // of a point that is no hub
constexpr std::size_t Chunk = 256;

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

/// Distance of a point from the quadric through those around it, over what noise of unit size makes
/// of it; NaN: cannot be told.
class PointOffsets
{
public:
  explicit PointOffsets(const SurfaceParts& parts)
    : Mesh(parts.Mesh),
      Normals(static_cast<std::size_t>(parts.Mesh.NumPoints()), Eigen::Vector3d::Zero())
  {
    for (std::size_t t = 0; t < parts.Mesh.Triangles.size(); ++t)
    {
      for (const int corner : parts.Mesh.Triangles[t])
      {
        this->Normals[static_cast<std::size_t>(corner)] += parts.Areas[t] * parts.Normals[t];
      }
    }
  }

  double At(int v) const
  {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    const std::vector<int> ring = this->Around(v);
    const Eigen::Vector3d& normal = this->Normals[static_cast<std::size_t>(v)];
    if (ring.size() < QuadricPoints || normal.norm() == 0.0)
    {
      return none;
    }
    const Eigen::Vector3d up = normal.normalized();
    const Eigen::Vector3d along = up.unitOrthogonal();
    const Eigen::Vector3d across = up.cross(along);
    double radius = 0.0;
    for (const int p : ring)
    {
      radius = std::max(radius, (this->Mesh.Point(p) - this->Mesh.Point(v)).norm());
    }
    const auto rows = static_cast<Eigen::Index>(ring.size());
    Eigen::MatrixXd system(rows, 6);
    Eigen::VectorXd heights(rows);
    Eigen::Index own = 0;
    for (Eigen::Index i = 0; i < rows; ++i)
    {
      const int p = ring[static_cast<std::size_t>(i)];
      own = p == v ? i : own;
      const Eigen::Vector3d at = (this->Mesh.Point(p) - this->Mesh.Point(v)) / radius;
      const double x = at.dot(along);
      const double y = at.dot(across);
      system.row(i) << 1.0, x, y, x * x, x * y, y * y;
      heights[i] = at.dot(up);
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(system);
    if (qr.rank() < 6)
    {
      return none;
    }
    const Eigen::VectorXd residuals = heights - system * qr.solve(heights);
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(rows, own);
    const double share = (unit - system * qr.solve(unit))[own]; // of its own error in its residual
    return share > 0.1 ? radius * residuals[own] / std::sqrt(share) : none;
  }

private:
  std::size_t NumSpokes(int v) const
  {
    const auto i = static_cast<std::size_t>(v);
    return static_cast<std::size_t>(this->Mesh.FanStart[i + 1] - this->Mesh.FanStart[i]);
  }
  void AddRing(int v, std::vector<int>& points) const
  {
    const auto i = static_cast<std::size_t>(v);
    points.insert(points.end(), this->Mesh.Fan.begin() + this->Mesh.FanStart[i],
      this->Mesh.Fan.begin() + this->Mesh.FanStart[i + 1]);
  }
  /// The point and two rings around it, ascending. Hubs of many spokes are left out, whose rings
  /// reach far and would cost their square; around one of them a single ring is enough.
  std::vector<int> Around(int v) const
  {
    std::vector<int> points{ v };
    this->AddRing(v, points);
    if (this->NumSpokes(v) <= MostSpokes)
    {
      const std::vector<int> inner(points.begin() + 1, points.end());
      for (const int p : inner)
      {
        if (this->NumSpokes(p) <= MostSpokes)
        {
          this->AddRing(p, points);
        }
      }
      points.erase(std::remove_if(points.begin(), points.end(),
                     [&](int p) { return this->NumSpokes(p) > MostSpokes; }),
        points.end());
    }
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return points;
  }

  const DiscMesh& Mesh;
  std::vector<Eigen::Vector3d> Normals;
};

/// @return Aborted.
Result<double> DeviationOfPoints(
  const SurfaceParts& parts, int threads, const ProgressCallback& progress)
{
  const PointOffsets offsets(parts);
  std::vector<double> values(static_cast<std::size_t>(parts.Mesh.NumPoints()));
  const bool isDone = VisitBlocks(values.size(), progress,
    [&](std::size_t first, std::size_t last)
    {
      ParallelFor(last - first, Chunk, threads,
        [&](std::size_t begin, std::size_t end)
        {
          for (std::size_t v = first + begin; v < first + end; ++v)
          {
            values[v] = offsets.At(static_cast<int>(v));
          }
        });
    });
  if (!isDone)
  {
    return { ErrorCode::Aborted, "stopped while the noise was estimated" };
  }
  values.erase(
    std::remove_if(values.begin(), values.end(), [](double value) { return std::isnan(value); }),
    values.end());
  return RobustDeviation(std::move(values));
}
}

Result<double> EstimateNoise(
  const SurfaceParts& parts, int threads, const ProgressCallback& progress)
{
  const auto ofPoints = DeviationOfPoints(parts, threads, progress);
  if (!ofPoints)
  {
    return ofPoints.Status;
  }
  const double deviation = std::min(DeviationOfEdges(parts), ofPoints.Value);
  return std::isfinite(deviation) ? deviation : 0.0;
}
}
