// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineCore/Types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace knotwork
{
/// A triangle mesh laid into the plane: an oriented disc with holes, every triangle
/// counterclockwise in UV. Several charts make up one surface.
struct ChartMesh
{
  PointMatrix Points;                        ///< n x 3
  PointMatrix UV;                            ///< n x 2, about the scale of the points
  std::vector<std::array<int, 3>> Triangles; ///< rows of Points
  /// Points of several charts with the same id are the same point of the surface. Empty: none are.
  std::vector<std::int64_t> PointIds;

  /// EmptyInput; SizeMismatch; NonFiniteInput; InvalidTopology for a corner that is no point, and
  /// for triangles that are not counterclockwise in UV (number, first ids).
  Status Check() const;
};
}
