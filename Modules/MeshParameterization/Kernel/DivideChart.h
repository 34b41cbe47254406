// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CutMesh.h"
#include "PlaneLoops.h"

namespace knotwork
{
/// Numbers of the holes that must not be cut, one a point, -1 at others: loops that are shorter
/// than the root of the area, and whose triangles face one side.
std::vector<int> FindSmallHoles(const DiscMesh& mesh);

/// Cuts a chart in two or more parts: one keeps its number, the others get the next ones.
/// @param crossing  points of the mesh whose images come to lie over each other: the cut runs
///        between them. Without: between sides of different normals.
/// @param holes     of FindSmallHoles, one a point of the mesh that was the first.
/// @param numCharts  raised by the number of new charts.
/// @return charts that are new or changed; InvalidTopology when the chart is a single triangle.
Result<std::vector<int>> DivideChart(CutMesh& mesh, int chart, const EdgeCrossing& crossing,
  const std::vector<int>& holes, double creaseAngle, int& numCharts);
}
