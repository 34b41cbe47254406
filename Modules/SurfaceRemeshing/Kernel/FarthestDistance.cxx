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
  std::vector<int> below(static_cast<std::size_t>(points.rows()), -1); // nearest ones of corners
  for (const MeshTriangle& corners : triangles)
  {
    for (const int corner : corners)
    {
      int& triangle = below[static_cast<std::size_t>(corner)];
      if (triangle < 0)
      {
        const Eigen::Vector3d point = points.row(corner).transpose();
        triangle = nearest(point);
      }
    }
    if (reached > enough)
    {
      found.Value = reached;
      return found;
    }
  }
  struct Corner
  {
    Eigen::Vector3d Place;
    int Triangle; // nearest one
  };
  std::vector<std::array<Corner, 3>> pieces;
  const double pruned = std::isfinite(enough) ? enough : 0.0;
  double largest = 0.0; // bound of what was not divided further
  for (const MeshTriangle& corners : triangles)
  {
    const auto corner = [&](std::size_t k)
    {
      return Corner{ points.row(corners[k]).transpose(),
        below[static_cast<std::size_t>(corners[k])] };
    };
    pieces.push_back({ corner(0), corner(1), corner(2) });
    while (!pieces.empty())
    {
      const std::array<Corner, 3> piece = pieces.back();
      pieces.pop_back();
      // the distance from one triangle is convex: of a piece it is largest at a corner
      const auto farthest = [&](int triangle)
      {
        double squared = 0.0;
        for (const Corner& one : piece)
        {
          squared = std::max(squared, surface.Foot(triangle, one.Place.data()).SquaredDistance);
        }
        return std::sqrt(squared);
      };
      const auto& [a, b, c] = piece;
      double bound = std::min({ farthest(a.Triangle), farthest(b.Triangle), farthest(c.Triangle) });
      if (bound > largest) // the piece below the middle is nearer to all of it, mostly
      {
        bound = std::min(bound, farthest(nearest((a.Place + b.Place + c.Place) / 3.0)));
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
      // longest edges are divided: slivers become short ones, not as many times more slivers
      std::size_t k = 0;
      double length = -1.0;
      for (std::size_t i = 0; i < 3; ++i)
      {
        const double edge = (piece[(i + 1) % 3].Place - piece[i].Place).squaredNorm();
        if (edge > length)
        {
          length = edge;
          k = i;
        }
      }
      const Corner& first = piece[k];
      const Corner& second = piece[(k + 1) % 3];
      const Corner& third = piece[(k + 2) % 3];
      Corner middle{ 0.5 * (first.Place + second.Place), -1 };
      middle.Triangle = nearest(middle.Place);
      if (reached > enough)
      {
        found.Value = reached;
        return found;
      }
      pieces.push_back({ first, middle, third });
      pieces.push_back({ middle, second, third });
    }
  }
  found.Value = largest;
  return found;
}
}
