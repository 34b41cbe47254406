// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FreeFaces.h"
#include <knotwork/SurfaceTrimming/RegionModel.h>

/// Private to ModelRegions and ModelMesh.
namespace knotwork
{
/// ModelRegions of a mesh whose regions of free form are charts.
/// @param charts  null: there are none.
/// @param failed  result: regions that are no faces as they are, or whose surfaces are farther than
/// the tolerance from edges that they share.
Result<RegionModel> ModelCharted(const DiscMesh& surface, const SurfaceRecognition& recognition,
  ChartedRegions* charts, const RegionModelParams& params, std::vector<int>& failed);
}
