// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeSizes.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace knotwork
{
namespace
{
constexpr double Growth = 0.5; ///< of lengths, per distance

/// What is summed at a point over the triangles of one region.
struct PointOfRegion
{
  int Region = -1;
  Eigen::Vector3d Normal = Eigen::Vector3d::Zero();
  double Area = 0.0;
  double Curvature = 0.0; ///< times area
};

using RegionsOfPoints = std::vector<std::vector<PointOfRegion>>;

PointOfRegion& Find(RegionsOfPoints& points, int point, int region)
{
  auto& at = points[static_cast<std::size_t>(point)];
  for (PointOfRegion& one : at)
  {
    if (one.Region == region)
    {
      return one;
    }
  }
  at.emplace_back();
  at.back().Region = region;
  return at.back();
}

/// Larger eigenvalue, in magnitude, of the second fundamental form that turns the normals of a
/// triangle's corners best.
double TriangleCurvature(
  const std::array<Eigen::Vector3d, 3>& corners, const std::array<Eigen::Vector3d, 3>& normals)
{
  const Eigen::Vector3d u = (corners[1] - corners[0]).normalized();
  const Eigen::Vector3d v =
    (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized().cross(u);
  Eigen::Matrix<double, 6, 3> matrix = Eigen::Matrix<double, 6, 3>::Zero();
  Eigen::Matrix<double, 6, 1> right;
  for (std::size_t k = 0; k < 3; ++k)
  {
    const Eigen::Vector3d edge = corners[(k + 1) % 3] - corners[k];
    const Eigen::Vector3d turn = normals[(k + 1) % 3] - normals[k];
    const auto row = static_cast<Eigen::Index>(2 * k);
    matrix.row(row) << edge.dot(u), edge.dot(v), 0.0;
    matrix.row(row + 1) << 0.0, edge.dot(u), edge.dot(v);
    right(row) = turn.dot(u);
    right(row + 1) = turn.dot(v);
  }
  const Eigen::Vector3d form = matrix.colPivHouseholderQr().solve(right);
  const double mean = 0.5 * (form[0] + form[2]);
  return std::abs(mean) + std::hypot(0.5 * (form[0] - form[2]), form[1]);
}

/// Curvature of lines by the turn at their points.
void AddLines(
  const DiscMesh& surface, const MeshFeatures& features, std::vector<double>& curvatures)
{
  for (const FeatureChain& chain : features.Chains)
  {
    const std::size_t n = chain.Points.size();
    for (std::size_t i = chain.Closed ? 0 : 1; i + (chain.Closed ? 0 : 1) < n; ++i)
    {
      const Eigen::Vector3d here = surface.Point(chain.Points[i]);
      const Eigen::Vector3d last = here - surface.Point(chain.Points[(i + n - 1) % n]);
      const Eigen::Vector3d next = surface.Point(chain.Points[(i + 1) % n]) - here;
      const double turn = std::atan2(last.cross(next).norm(), last.dot(next));
      double& curvature = curvatures[static_cast<std::size_t>(chain.Points[i])];
      curvature = std::max(curvature, 2.0 * turn / (last.norm() + next.norm()));
    }
  }
}
}

std::vector<double> LargestCurvatures(const DiscMesh& surface, const MeshFeatures& features)
{
  RegionsOfPoints points(static_cast<std::size_t>(surface.NumPoints()));
  const auto corners = [&](std::size_t t)
  {
    const auto& ids = surface.Triangles[t];
    return std::array<Eigen::Vector3d, 3>{ surface.Point(ids[0]), surface.Point(ids[1]),
      surface.Point(ids[2]) };
  };
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    const auto places = corners(t);
    const Eigen::Vector3d normal = (places[1] - places[0]).cross(places[2] - places[0]);
    for (std::size_t k = 0; k < 3; ++k)
    {
      // weighted by the angle: the normal of a round surface, however it is divided
      const Eigen::Vector3d a = places[(k + 1) % 3] - places[k];
      const Eigen::Vector3d b = places[(k + 2) % 3] - places[k];
      Find(points, surface.Triangles[t][k], features.Regions[t]).Normal +=
        std::atan2(a.cross(b).norm(), a.dot(b)) * normal.normalized();
    }
  }
  for (auto& at : points)
  {
    for (PointOfRegion& one : at)
    {
      one.Normal.normalize();
    }
  }
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    const auto places = corners(t);
    const double area = (places[1] - places[0]).cross(places[2] - places[0]).norm();
    std::array<Eigen::Vector3d, 3> normals;
    for (std::size_t k = 0; k < 3; ++k)
    {
      normals[k] = Find(points, surface.Triangles[t][k], features.Regions[t]).Normal;
    }
    const double curvature = TriangleCurvature(places, normals);
    for (const int corner : surface.Triangles[t])
    {
      PointOfRegion& one = Find(points, corner, features.Regions[t]);
      one.Area += area;
      one.Curvature += area * curvature;
    }
  }
  std::vector<double> curvatures(points.size(), 0.0);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    for (const PointOfRegion& one : points[i])
    {
      curvatures[i] = std::max(curvatures[i], one.Curvature / one.Area);
    }
  }
  AddLines(surface, features, curvatures);
  return curvatures;
}

double ChordOf(double curvature, double tolerance)
{
  // an equilateral triangle with its corners on a ball of radius 1 / curvature
  const double squared = curvature * tolerance < 1.0
    ? 6.0 * tolerance / std::max(curvature, std::numeric_limits<double>::min()) -
      3.0 * tolerance * tolerance
    : 3.0 * tolerance * tolerance;
  return std::sqrt(squared);
}

void LimitGrowth(const DiscMesh& surface, std::vector<double>& sizes)
{
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (int i = 0; i < surface.NumPoints(); ++i)
  {
    queue.push({ sizes[static_cast<std::size_t>(i)], i });
  }
  while (!queue.empty())
  {
    const auto [size, point] = queue.top();
    queue.pop();
    const auto i = static_cast<std::size_t>(point);
    if (size > sizes[i])
    {
      continue;
    }
    for (int k = surface.FanStart[i]; k < surface.FanStart[i + 1]; ++k)
    {
      const auto j = static_cast<std::size_t>(k);
      const double most = size + Growth * surface.Spokes[j];
      double& other = sizes[static_cast<std::size_t>(surface.Fan[j])];
      if (most < other)
      {
        other = most;
        queue.push({ most, surface.Fan[j] });
      }
    }
  }
}
}
