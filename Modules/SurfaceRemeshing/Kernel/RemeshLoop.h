// SPDX-License-Identifier: BSD-3-Clause
// Triangles that are divided, joined, turned and moved on a surface, private to the kernel.
#pragma once
#include "ReferenceSurface.h"

#include <functional>
#include <utility>
#include <vector>

namespace knotwork
{
/// A remeshed part; of Points those are meant that triangles have.
struct RemeshedPart
{
  std::vector<Eigen::Vector3d> Points;
  std::vector<double> Sizes; ///< one a point
  std::vector<MeshTriangle> Triangles;
  std::vector<int> Regions;     ///< one a triangle
  std::vector<int> TriangleIds; ///< of the surface's triangle below the middle
  std::vector<std::array<int, 2>> Lines;
  std::vector<int> LineChains;
  std::vector<int> Corners;
};

/// @param sizes  of edges, one a point of the surface. @param limit  distance of middles of
/// triangles and edges from the surface above which no step leads.
/// @param goesOn  gets the share that is done; false: ends.
/// @return false: ended.
bool RemeshPart(const DiscMesh& surface, const MeshFeatures& features,
  const std::vector<double>& sizes, double limit, int iterations,
  const std::function<bool(double)>& goesOn, RemeshedPart& part);
}
