// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FreeRegions.h"
#include "RegionChains.h"
#include <knotwork/SplineCore/AnalyticSurface.h>
#include <knotwork/SurfaceTrimming/TrimSurface.h>

/// Private to ModelRegions: spline faces of charts that share edges with analytic faces.
namespace knotwork
{
/// Divides chains where edges of charts end.
/// @return failures of FindBoundaryChains.
Status SplitAtChartCorners(
  const std::vector<ChartMesh>& charts, double cornerAngle, RegionChains& chains);

struct FreeFaces
{
  TrimmedSurface Trimmed;       ///< a face a chart
  std::vector<int> ChainOfEdge; ///< of the faces' edges; chains run as their edges do
  double MaxMove = 0.0;         ///< of the charts' points to analytic surfaces beside them
};

/// Fits surfaces and edges. Charts' points along analytic faces are moved onto these first; edges
/// end at the vertices of chains.
/// @param charted  its charts get the points that chains have between points of the mesh, and more
/// on curved surfaces beside them, as chains do.
/// @param surfaces  of all regions.
/// @return InvalidTopology: chains are not the edges of charts; failures of TrimSurface.
Result<FreeFaces> FitFreeFaces(ChartedRegions& charted,
  const std::vector<AnalyticSurface>& surfaces, RegionChains& chains, const TrimParams& params);
}
