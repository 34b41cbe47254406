// SPDX-License-Identifier: BSD-3-Clause
#include "TetrahedronShapes.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double DegreesPerRadian = 180.0 / static_cast<double>(EIGEN_PI);
}

TetrahedronShapes MeasureTetrahedra(
  const PointMatrix& points, const std::vector<std::array<int, 4>>& cells)
{
  TetrahedronShapes shapes;
  double largestCosine = -1.0;
  double smallestCosine = 1.0;
  for (const auto& cell : cells)
  {
    std::array<Eigen::Vector3d, 4> p;
    for (std::size_t i = 0; i < 4; ++i)
    {
      p[i] = points.row(cell[i]).transpose();
    }
    const Eigen::Vector3d a = p[1] - p[0];
    const Eigen::Vector3d b = p[2] - p[0];
    const Eigen::Vector3d c = p[3] - p[0];
    const double six = a.dot(b.cross(c));
    shapes.Volume += six / 6.0;
    double shortest = std::numeric_limits<double>::infinity();
    std::array<Eigen::Vector3d, 4> normals; // of the face opposite of a corner, inward
    for (std::size_t i = 0; i < 4; ++i)
    {
      for (std::size_t j = i + 1; j < 4; ++j)
      {
        shortest = std::min(shortest, (p[i] - p[j]).norm());
      }
      const std::size_t j = (i + 1) % 4;
      const std::size_t k = (i + 2) % 4;
      const std::size_t l = (i + 3) % 4;
      normals[i] = (p[k] - p[j]).cross(p[l] - p[j]).normalized();
      if (normals[i].dot(p[i] - p[j]) < 0.0)
      {
        normals[i] = -normals[i];
      }
    }
    for (std::size_t i = 0; i < 4; ++i)
    {
      for (std::size_t j = i + 1; j < 4; ++j)
      {
        const double cosine = -normals[i].dot(normals[j]);
        largestCosine = std::max(largestCosine, cosine);
        smallestCosine = std::min(smallestCosine, cosine);
      }
    }
    const double radius =
      (a.squaredNorm() * b.cross(c) + b.squaredNorm() * c.cross(a) + c.squaredNorm() * a.cross(b))
        .norm() /
      (2.0 * std::abs(six));
    shapes.WorstRadiusEdgeRatio = std::max(shapes.WorstRadiusEdgeRatio, radius / shortest);
  }
  const auto degrees = [](double cosine)
  { return std::acos(std::clamp(cosine, -1.0, 1.0)) * DegreesPerRadian; };
  shapes.MinDihedral = degrees(largestCosine);
  shapes.MaxDihedral = degrees(smallestCosine);
  return shapes;
}
}
