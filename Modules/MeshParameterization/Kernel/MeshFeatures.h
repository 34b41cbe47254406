// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "TriangleMesh.h"

namespace knotwork
{
/// Angles in degrees; those between normals are 0 where a surface is flat.
struct MeshFeatureParams
{
  double SharpAngle = 40.0;  ///< between normals from which on an edge is sharp, (0, 180)
  double WeakAngle = 20.0;   ///< from which on an edge is sharp that continues one, (0, SharpAngle]
  double CornerAngle = 60.0; ///< turn of a chain from which on it has a corner, (0, 180]
};

/// Sharp edges and rims in a row.
struct FeatureChain
{
  std::vector<int> Points; ///< from corner to corner; of a closed chain the first one once
  bool Closed = false;     ///< without a corner
};

/// Points and triangles are those of the checked surface.
struct MeshFeatures
{
  std::vector<FeatureChain> Chains;
  /// Ascending: where other than two sharp edges or rims meet, or two turn by CornerAngle.
  std::vector<int> Corners;
  /// One a triangle: the region between chains, numbered by their first triangles.
  std::vector<int> Regions;
  int NumRegions = 0;
};

/// Sharp edges by the angle between normals with hysteresis: edges from SharpAngle on, and those
/// from WeakAngle on that are connected with them by such edges. Angles within 1e-6 degrees below
/// a limit reach it.
/// @param surface  of CheckSurface.
/// @return InvalidParameter: an angle outside its range.
/// @complexity O(n log n).
/// @source Canny, IEEE PAMI 8 (1986) 679 (hysteresis).
Result<MeshFeatures> FindMeshFeatures(
  const DiscMesh& surface, const MeshFeatureParams& params = {});
}
