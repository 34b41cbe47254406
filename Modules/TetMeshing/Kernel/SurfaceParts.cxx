// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceParts.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

namespace knotwork
{
namespace
{
using Eigen::Vector3d;

/// The nearest point of a triangle's sides: number of the side and share of its length.
struct Rim
{
  double Place = 0.0; ///< in [0, 3]
  double Distance = 0.0;
};

Rim NearestOnSides(const std::array<Vector3d, 3>& corners, const Vector3d& point)
{
  Rim best;
  best.Distance = std::numeric_limits<double>::infinity();
  for (std::size_t side = 0; side < 3; ++side)
  {
    const Vector3d along = corners[(side + 1) % 3] - corners[side];
    const double share =
      std::clamp((point - corners[side]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double distance = (corners[side] + share * along - point).norm();
    if (distance < best.Distance)
    {
      best = { static_cast<double>(side) + share, distance };
    }
  }
  return best;
}

/// Edges of an odd number of parts, as neighbours of their ends.
std::map<int, std::vector<int>> OddEdges(
  const std::vector<MeshTriangle>& parts, const std::vector<int>& which)
{
  std::set<std::pair<int, int>> odd;
  for (const int part : which)
  {
    const MeshTriangle& corners = parts[static_cast<std::size_t>(part)];
    for (std::size_t i = 0; i < 3; ++i)
    {
      const auto edge = std::minmax(corners[i], corners[(i + 1) % 3]);
      if (!odd.insert(edge).second)
      {
        odd.erase(edge);
      }
    }
  }
  std::map<int, std::vector<int>> neighbours;
  for (const auto& [a, b] : odd)
  {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  }
  return neighbours;
}

/// Whether edges are one loop that goes once around a triangle, and how far its ends are from it.
std::optional<double> FarthestOfLoop(const std::map<int, std::vector<int>>& neighbours,
  const std::array<Vector3d, 3>& corners, const PointMatrix& points)
{
  if (neighbours.empty())
  {
    return std::nullopt;
  }
  double farthest = 0.0;
  double turned = 0.0; // in sides
  std::size_t passed = 0;
  int previous = -1;
  int at = neighbours.begin()->first;
  Rim here = NearestOnSides(corners, points.row(at).transpose());
  double sign = 0.0;
  do
  {
    const std::vector<int>& next = neighbours.at(at);
    if (next.size() != 2)
    {
      return std::nullopt;
    }
    const int to = next[0] == previous ? next[1] : next[0];
    const Rim there = NearestOnSides(corners, points.row(to).transpose());
    const double step = std::remainder(there.Place - here.Place, 3.0);
    // no edge leads over more than one side, and all lead the same way round
    if (!(std::abs(step) <= 1.0) || step * sign < 0.0 || step == 0.0)
    {
      return std::nullopt;
    }
    sign = step;
    turned += step;
    farthest = std::max(farthest, there.Distance);
    previous = at;
    at = to;
    here = there;
    ++passed;
  } while (at != neighbours.begin()->first && passed <= neighbours.size());
  return passed == neighbours.size() && std::abs(std::abs(turned) - 3.0) < 0.5
    ? std::optional<double>(farthest)
    : std::nullopt;
}
}

PartsDistance MeasureParts(const PointMatrix& surface, const std::vector<MeshTriangle>& triangles,
  const PointMatrix& points, const std::vector<MeshTriangle>& parts,
  const std::vector<int>& sources, double tolerance)
{
  const TriangleIndex<3> index(surface, triangles);
  std::vector<std::vector<int>> partsOf(triangles.size());
  PartsDistance found;
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    partsOf[static_cast<std::size_t>(sources[i])].push_back(static_cast<int>(i));
    for (const int corner : parts[i])
    {
      const Eigen::RowVector3d point = points.row(corner);
      found.OfParts =
        std::max(found.OfParts, std::sqrt(index.Foot(sources[i], point.data()).SquaredDistance));
    }
  }
  double sides = 0.0;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    std::array<Vector3d, 3> corners;
    for (std::size_t i = 0; i < 3; ++i)
    {
      corners[i] = surface.row(triangles[t][i]).transpose();
    }
    const auto farthest = FarthestOfLoop(OddEdges(parts, partsOf[t]), corners, points);
    if (!farthest || *farthest > tolerance)
    {
      found.Open.push_back(triangles[t]);
      continue;
    }
    sides = std::max(sides, *farthest);
  }
  found.OfSurface = found.OfParts + 2.0 * sides;
  return found;
}
}
