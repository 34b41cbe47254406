// SPDX-License-Identifier: BSD-3-Clause
#include "MeshFeatures.h"

#include "FeatureEdges.h"

#include <algorithm>

namespace knotwork
{
Result<MeshFeatures> FindMeshFeatures(const DiscMesh& surface, const MeshFeatureParams& params)
{
  if (Status status = CheckParams(params); !status)
  {
    return status;
  }
  const std::vector<int> noHoles;
  const SurfaceParts parts(surface, noHoles);
  std::vector<MeshEdge> edges = SharpEdges(
    parts, params, [&](std::size_t t, std::size_t k) { return Degrees * parts.Dihedral(t, k); });
  const std::vector<MeshEdge> rims = RimEdges(parts);
  edges.insert(edges.end(), rims.begin(), rims.end());
  std::sort(edges.begin(), edges.end());
  return TraceFeatures(parts, edges, params.CornerAngle);
}
}
