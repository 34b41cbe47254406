// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/MeshParameterization/FlattenCharts.h>
#include <knotwork/SurfaceTrimming/ChartMesh.h>
#include <knotwork/SurfaceTrimming/SurfaceRecognition.h>

/// Private to ModelMesh: regions of free form beside analytic ones.
namespace knotwork
{
/// A mesh whose regions of free form are charts.
struct ChartedRegions
{
  DiscMesh Surface;               ///< with points where charts are cut
  SurfaceRecognition Recognition; ///< analytic regions as they were, then one a chart
  std::vector<ChartMesh> Charts;  ///< PointIds are points of Surface
  /// Of each chart: charts of one number are parts of one smooth region.
  std::vector<int> SmoothRegion;
  int FirstChart = 0;       ///< its region
  std::vector<int> Origins; ///< of the analytic regions: their numbers before
};

struct FreeRegionParams
{
  FlattenParams Flatten;
  ChartParams Charts;
};

/// Divides what is of free form along sharp edges, and each part into charts.
/// @return failures of FlattenCharts and CheckSurface.
/// @complexity that of FlattenCharts.
Result<ChartedRegions> ChartFreeRegions(
  const DiscMesh& surface, const SurfaceRecognition& recognition, const FreeRegionParams& params);
}
