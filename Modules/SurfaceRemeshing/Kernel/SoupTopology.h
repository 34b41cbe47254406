// SPDX-License-Identifier: BSD-3-Clause
// Edges, fans and parts of triangles as they come.
#pragma once
#include <knotwork/MeshParameterization/TriangleMesh.h>
#include <knotwork/SplineCore/TriangleIndex.h>

namespace knotwork
{
/// A triangle at an edge.
struct SoupSide
{
  int First; ///< the lower point of the edge
  int Second;
  int Triangle;
  bool Forward; ///< the triangle runs from First to Second
};

/// All sides, those of an edge behind each other, in the order of triangles.
std::vector<SoupSide> SortedSides(const std::vector<MeshTriangle>& triangles);

/// Calls use(begin, end) with the sides of each edge.
template <typename Use>
void ForEachEdge(const std::vector<SoupSide>& sides, Use&& use)
{
  for (std::size_t begin = 0; begin < sides.size();)
  {
    std::size_t end = begin + 1;
    while (end < sides.size() && sides[end].First == sides[begin].First &&
      sides[end].Second == sides[begin].Second)
    {
      ++end;
    }
    use(sides.data() + begin, sides.data() + end);
    begin = end;
  }
}

/// What is between triangles and a manifold.
struct SoupDefects
{
  std::vector<std::pair<int, int>> OpenEdges;    ///< of one triangle, in its direction
  std::vector<std::pair<int, int>> CrowdedEdges; ///< of more than two
  std::vector<std::pair<int, int>>
    TwistedEdges;               ///< two or more triangles, not as many run each way
  std::vector<int> SplitPoints; ///< of several fans
  bool IsManifold() const
  {
    return this->CrowdedEdges.empty() && this->TwistedEdges.empty() && this->SplitPoints.empty();
  }
};
SoupDefects FindDefects(const std::vector<MeshTriangle>& triangles, Eigen::Index numPoints);

/// Number of the part of each triangle, parts hang together by edges; numbered by first triangles.
/// @param throughCrowded  also by edges of more than two triangles.
std::vector<int> NumberParts(
  const std::vector<MeshTriangle>& triangles, bool throughCrowded, int& count);

/// Turns triangles so that those at edges of two run alike; of each patch the fewer ones.
/// @param turned  numbers of triangles are added.
/// @return an edge whose triangles cannot: the surface has one side; {-1, -1}: none.
std::pair<int, int> OrientTriangles(std::vector<MeshTriangle>& triangles, std::vector<int>& turned);

/// Closed rims of open edges, each beside its triangles as they run.
std::vector<std::vector<int>> TraceRims(
  const std::vector<MeshTriangle>& triangles, const SoupDefects& defects);

double SignedVolume(const PointMatrix& points, const std::vector<MeshTriangle>& triangles);

/// Number of points that are used - edges + triangles.
int EulerNumber(const std::vector<MeshTriangle>& triangles);
}
