// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/MeshParameterization/FlattenCharts.h>
#include <knotwork/SurfaceTrimming/ChartMesh.h>
#include <knotwork/SurfaceTrimming/SurfaceRecognition.h>

/// Private to ModelMesh: regions of free form beside analytic ones.
namespace knotwork
{
/// Makes regions free whose points do not lie on their surface as points with noise do: distances
/// of neighbours are alike (a smooth shape that leaves the surface) or go up to the tolerance, and
/// the region does not end at sharp edges; or there are hardly more points than the surface has
/// parameters.
/// @return the share of the area that is still of analytic surfaces.
double ReleaseDoubtfulRegions(const DiscMesh& surface, SurfaceRecognition& recognition);

/// Whether more than half of a mesh is covered by surfaces on which its points lie neither exactly
/// nor as points with noise do: pieces of a smooth shape.
bool IsPatchwork(const DiscMesh& surface, const SurfaceRecognition& recognition);

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
