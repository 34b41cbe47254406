// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FaceChart.h"
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineCore/Types.h>

namespace knotwork
{
/// Triangles of a face in its chart, all counterclockwise there.
struct ChartTriangles
{
  PointMatrix Places; ///< those of the loops first, in their order
  std::vector<std::array<int, 3>> Triangles;
};

struct ChartSizes
{
  double Largest = 0.0;   ///< edges
  double Curvature = 0.0; ///< angle between normals at the ends of an edge, radians
};

/// Triangles between loops, whose sides stay undivided, with inner points such that edges are about
/// as long as the sides near them, and no longer than the sizes say.
/// @return InvalidTopology: loops cross in the chart; TooLarge: more than a limit of triangles.
/// @complexity O(n^2) in the points of the loops.
/// @source  flips by lengths on the surface: Fisher, Springborn, Bobenko, Schroeder, Computing 81
/// (2007) 199 (intrinsic Delaunay triangulations).
Result<ChartTriangles> TriangulateChart(const FaceChart& chart, const std::vector<ChartLoop>& loops,
  const ChartSizes& sizes, int maxTriangles);
}
