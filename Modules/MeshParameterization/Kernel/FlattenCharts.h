// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/MeshParameterization/MeshParameterization.h>

namespace knotwork
{
struct ChartParams
{
  double MaxStretch = 3.0;   ///< of a chart, max(s1, 1 / s2) over its triangles, above 1
  int MaxCharts = 500;       ///< [1, 100000]
  double CreaseAngle = 40.0; ///< degrees, (0, 180); cuts run along sharper edges where they can
};

/// A point of the cut mesh as a mean of the input's points: of one, or of the two or three that
/// span the edge or triangle a cut made it on.
struct PointOrigin
{
  std::array<int, 3> Points{ -1, -1, -1 }; ///< of the input; those used come first
  std::array<double, 3> Weights{};         ///< sum 1
};

/// A mesh that is divided into charts, each of them laid into the plane; their images lie side by
/// side.
struct ChartedMesh
{
  PointMatrix Points; ///< n x 3, without copies: neighbouring charts share those of their borders
  std::vector<PointOrigin> Origins;          ///< one a point
  std::vector<std::array<int, 3>> Triangles; ///< rows of Points, oriented alike
  std::vector<int> TriangleIds;              ///< of the input's triangles that they are parts of
  /// PointIds are rows of Points, TriangleIds those of Triangles. All maps are Injective unless
  /// WithinLimit is false.
  std::vector<MeshParameterization> Charts;
  bool WithinLimit = true; ///< all Injective, no stretch beyond MaxStretch
  int Reversed = 0;        ///< triangles that were turned over
  int Components = 1;      ///< of the input
  double Seconds = 0.0;    ///< of the wall clock, measures not included
};

/// Lays any surface (closed, with handles) into the plane in charts: discs with holes, each with
/// a map that is proved to be injective as a whole, stretched by MaxStretch at most.
///
/// A surface that can be laid out as it is stays uncut. A chart that cannot is cut in two, between
/// sides of different normals or, where it only lies over itself in the plane, between the places
/// that meet; cuts are smooth lines across triangles, or run along creases. At the end small charts
/// join neighbours where both together have a good map. Holes that are small (length below the root
/// of the area, in one side of the surface) are not cut.
/// @param params  Method is tried first; with Fallback, Injective when it fails, flips, crosses or
///        stretches too much.
/// @return InvalidParameter; failures of CheckSurface; NotConverged: MaxCharts are too few for
/// charts that are discs; InvalidTopology: a chart of one triangle that Method without Fallback
/// does not lay out. Charts that are stretched more are a result: see WithinLimit.
/// @complexity O(n log n) graph cuts and factorizations of O(n^1.5), times the depth of cuts.
/// @source Cohen-Steiner, Alliez, Desbrun, ACM TOG 23 (2004) 905 (normals); Boykov, Veksler, Zabih,
/// IEEE PAMI 23 (2001) 1222 (cuts of a graph).
Result<ChartedMesh> FlattenCharts(
  const TriangleMesh& mesh, const FlattenParams& params = {}, const ChartParams& charts = {});

/// A surface that is laid out as one chart.
ChartedMesh OneChart(MeshParameterization map);

/// Measures of all charts together: sums, extremes and means by area; of distance errors the mean
/// square by points. SingularValues in the order of Triangles.
FlattenMeasures TotalMeasures(const ChartedMesh& mesh);
}
