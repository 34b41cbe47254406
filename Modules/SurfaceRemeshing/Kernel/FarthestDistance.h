// SPDX-License-Identifier: BSD-3-Clause
// How far triangles are from a surface at most.
#pragma once
#include <knotwork/SplineCore/TriangleIndex.h>

namespace knotwork
{
struct LargestDistance
{
  double Value = 0.0; ///< not below the largest one, and above it by the tolerance at most
  Eigen::Vector3d Place = Eigen::Vector3d::Zero();
};

/// The largest distance of all points of triangles from a surface; they are divided where the
/// corners do not tell.
/// @param tolerance  > 0.
/// @param enough  a distance above it ends the search: whether Value is above it is all that is
/// known.
LargestDistance FarthestFrom(const TriangleIndex<3>& surface, const PointMatrix& points,
  const std::vector<MeshTriangle>& triangles, double tolerance,
  double enough = std::numeric_limits<double>::infinity());
}
