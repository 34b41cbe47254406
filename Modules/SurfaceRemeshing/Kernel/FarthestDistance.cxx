// SPDX-License-Identifier: BSD-3-Clause
#include "FarthestDistance.h"

#include <array>
#include <cmath>

namespace knotwork
{
LargestDistance FarthestFrom(const TriangleIndex<3>& surface, const PointMatrix& points,
  const std::vector<MeshTriangle>& triangles, double tolerance, double enough)
{
  LargestDistance found;
  double reached = 0.0; // at a point
  const auto nearest = [&](const Eigen::Vector3d& point)
  {
    const TriangleFoot foot = surface.Nearest(point.data());
    const double value = std::sqrt(foot.SquaredDistance);
    if (value > reached)
    {
      reached = value;
      found.Place = point;
    }
    return foot.Triangle;
  };
  using Piece = std::array<Eigen::Vector3d, 3>;
  std::vector<Piece> pieces;
  const double pruned = std::isfinite(enough) ? enough : 0.0;
  double largest = 0.0; // bound of what was not divided further
  for (const MeshTriangle& corners : triangles)
  {
    pieces.push_back({ points.row(corners[0]).transpose(), points.row(corners[1]).transpose(),
      points.row(corners[2]).transpose() });
    while (!pieces.empty())
    {
      const Piece piece = pieces.back();
      pieces.pop_back();
      const auto& [a, b, c] = piece;
      const Eigen::Vector3d middle = (a + b + c) / 3.0;
      // the distance from one triangle is convex: of a piece it is largest at a corner
      double bound = std::numeric_limits<double>::infinity();
      for (const int triangle : { nearest(middle), nearest(a), nearest(b), nearest(c) })
      {
        double farthest = 0.0;
        for (const Eigen::Vector3d& corner : piece)
        {
          farthest = std::max(farthest, surface.Foot(triangle, corner.data()).SquaredDistance);
        }
        bound = std::min(bound, std::sqrt(farthest));
      }
      if (reached > enough)
      {
        found.Value = reached;
        return found;
      }
      if (bound <= reached + tolerance || bound <= pruned)
      {
        largest = std::max(largest, bound);
        continue;
      }
      const Eigen::Vector3d ab = 0.5 * (a + b);
      const Eigen::Vector3d bc = 0.5 * (b + c);
      const Eigen::Vector3d ca = 0.5 * (c + a);
      pieces.push_back({ a, ab, ca });
      pieces.push_back({ ab, b, bc });
      pieces.push_back({ ca, bc, c });
      pieces.push_back({ ab, bc, ca });
    }
  }
  found.Value = largest;
  return found;
}
}
