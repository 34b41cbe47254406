// SPDX-License-Identifier: BSD-3-Clause
// Tips of sheets cut off where these touch others, private to the kernel.
#pragma once
#include "SheetArrangement.h"

namespace knotwork
{
/// Triangles that close the loop which is left when a point and the part of its fan next to it are
/// taken away: they lie in the cone over the fan, on its inner side. The fan may be a saddle.
/// @param tip  the point. @param ring  its neighbours, counterclockwise seen from outside.
/// @param inside  whether the side that is meant is the one that the normals point away from.
/// @return triangles of numbers in the ring; empty when there are none.
std::vector<MeshTriangle> CapOfFan(
  const Eigen::Vector3d& tip, const std::vector<Eigen::Vector3d>& ring, bool inside);
}
