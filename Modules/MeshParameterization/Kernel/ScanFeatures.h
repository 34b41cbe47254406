// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "MeshFeatures.h"

namespace knotwork
{
/// Edges and regions that somebody knows.
struct KnownFeatures
{
  /// Pairs of points of the mesh; the shortest way along its edges lies between them.
  std::vector<std::array<int, 2>> Edges;
  /// One a triangle, or empty: edges between triangles of different numbers are features.
  std::vector<int> Regions;
  bool Only = false; ///< nothing is looked for beside these
};

struct ScanFeatureParams
{
  MeshFeatureParams Angles;
  /// Standard deviation of the points across the surface, unit of the points; negative: estimated
  /// for each part of the mesh.
  double Noise = -1.0;
  /// Share of the area of the mesh below which a region joins a neighbour, [0, 1).
  double SmallestRegion = 0.0;
  /// Width of a row of triangles between two sides that is no region but an edge, share of the
  /// diagonal of the box of its part, [0, 1].
  double NarrowWidth = 0.005;
  /// Length of gaps in chains that are closed, share of the diagonal, [0, 1].
  double LargestGap = 0.02;
  KnownFeatures Known;
  int Threads = 0; ///< 0: all cores; results do not depend on it
  ProgressCallback Progress;
};

struct FeatureLine
{
  FeatureChain Chain; ///< of points of the mesh; of equal ones the first
  bool IsRim = false;
  double MeanAngle = 0.0; ///< between the two sides, by length, degrees; 0 on rims
  double MaxAngle = 0.0;
  double Length = 0.0;
};

struct ScanFeatures
{
  std::vector<FeatureLine> Lines;    ///< part by part
  std::vector<int> Corners;          ///< points of the mesh
  std::vector<int> RegionOfTriangle; ///< -1 of triangles of two equal corners
  int NumRegions = 0;
  int NumSharpEdges = 0; ///< edges of the mesh in lines that are no rims
  int NumRimEdges = 0;
  int NumJoined = 0; ///< regions that were joined with others
  int NumClosedGaps = 0;
  double Noise = 0.0; ///< that was given, or the largest estimate of a part
};

/// Sharp edges of a mesh that may be a noisy scan, as chains, corners and the regions between them.
///
/// Normals are fitted to patches that are as large as the noise asks for (FitNormals); an edge is
/// sharp where those of its sides differ as FindMeshFeatures asks for. Then narrow rows of
/// triangles between two sides are made edges: they join the side across their blunter bound, and
/// the sharper one stays. Gaps are closed, regions joined that are smaller than SmallestRegion or
/// than half of the patches that their normals come from, and ends of chains dropped that are
/// shorter than patches. Each part has its own noise, width of rows and length of gaps: what lies
/// beside it does not matter. Without noise, narrow rows, gaps and small regions the result is that
/// of FindMeshFeatures.
/// @param mesh  of one or several parts; points that are equal are one.
/// @return EmptyInput; InvalidParameter (also Known.Only and nothing known); InvalidTopology: a
/// known edge of points of different parts;
///         SizeMismatch: known numbers of another count; OutsideDomain: known edges of points that
///         are none; the failures of CheckComponent; Aborted.
/// @complexity O(n log n), times the triangles of a patch where there is noise.
/// @source Canny, IEEE PAMI 8 (1986) 679 (hysteresis); Zhang et al., CGF 34 (2015) 23 (normals of
///         the most consistent patch).
Result<ScanFeatures> FindScanFeatures(
  const TriangleMesh& mesh, const ScanFeatureParams& params = {});
}
