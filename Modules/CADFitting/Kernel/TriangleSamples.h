// SPDX-License-Identifier: BSD-3-Clause
// Points spread over triangles, private to the kernel.
#pragma once
#include <knotwork/SplineCore/TriangleIndex.h>

namespace knotwork
{
struct TriangleSamples
{
  PointMatrix Points; ///< n x 3
  Eigen::VectorXd Areas;
  std::vector<int> Triangles; ///< that they lie on
};

/// The middles of a square number of equal parts of every triangle, as its area asks for: at least
/// so many points where the triangles have an area.
TriangleSamples SampleTriangles(
  const PointMatrix& points, const std::vector<MeshTriangle>& triangles, int atLeast);
}
