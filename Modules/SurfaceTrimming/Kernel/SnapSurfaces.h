// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SurfaceRecognition.h"

namespace knotwork
{
/// Regions, and the mesh whose triangles they are of.
struct SnappedPart
{
  const PointMatrix* Points = nullptr;
  const std::vector<std::array<int, 3>>* Triangles = nullptr;
  SurfaceRecognition* Recognition = nullptr; ///< surfaces and distances of its regions are set
};

/// Makes values of planes, cylinders, spheres, cones and tori common that are nearly equal, as long
/// as surfaces move little at the points of their regions, and these stay within the tolerance:
/// first directions, which become parallel or, to a frame of the heaviest direction and the
/// heaviest one across it, perpendicular; then offsets of planes, lines of axes, and centres of
/// spheres that lie on such a line; then radii (of cylinders, spheres, and the minor ones of tori)
/// and angles of cones. A common value is the mean by area; what is not held is fitted again each
/// time. A surface that fails keeps its own value.
/// @param distance  by which a surface moves at the points of its region at most, their unit, > 0.
/// @complexity O(n) for each value, and O(regions^2).
SnappedValues SnapSurfaces(const std::vector<SnappedPart>& parts, double distance);
}
