// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleSamples.h"

#include <knotwork/MeshParameterization/TriangleMesh.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
TriangleSamples SampleTriangles(
  const PointMatrix& points, const std::vector<MeshTriangle>& triangles, int atLeast)
{
  Eigen::VectorXd areas(static_cast<Eigen::Index>(triangles.size()));
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    areas[static_cast<Eigen::Index>(t)] = TriangleArea(points, triangles[t]);
  }
  const double all = areas.sum();
  std::vector<int> parts(triangles.size());
  Eigen::Index count = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    const double share = all > 0.0 ? areas[static_cast<Eigen::Index>(t)] / all * atLeast : 0.0;
    parts[t] = std::clamp(static_cast<int>(std::ceil(std::sqrt(share))), 1, 1000);
    count += static_cast<Eigen::Index>(parts[t]) * parts[t];
  }
  TriangleSamples samples;
  samples.Points.resize(count, 3);
  samples.Areas.resize(count);
  samples.Triangles.reserve(static_cast<std::size_t>(count));
  Eigen::Index row = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    const int n = parts[t];
    const auto corner = [&](std::size_t k) { return points.row(triangles[t][k]).data(); };
    for (int i = 0; i < n; ++i)
    {
      for (int j = 0; j < 2 * (n - i) - 1; ++j, ++row)
      {
        // upright parts and, between them, those upside down
        const double b = (i + (j % 2 == 0 ? 1.0 : 2.0) / 3.0) / n;
        const double c = (static_cast<double>(j / 2) + (j % 2 == 0 ? 1.0 : 2.0) / 3.0) / n;
        samples.Points.row(row) = PointOfTriangle<3>(corner(0), corner(1), corner(2), b, c);
        samples.Areas[row] = areas[static_cast<Eigen::Index>(t)] / (n * n);
        samples.Triangles.push_back(static_cast<int>(t));
      }
    }
  }
  return samples;
}
}
