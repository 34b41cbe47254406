// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "MapChart.h"

namespace knotwork
{
/// Joins small charts to neighbours where both together have a good map: the smallest ones first,
/// to the neighbour of the longest common border, which counts little along creases.
/// @param maps  one a chart; charts that are gone have none, and the numbers of others close up.
/// @return failures of TakePart.
Status JoinCharts(CutMesh& mesh, const FlattenParams& params, const ChartParams& charts,
  std::vector<ChartMap>& maps);
}
