// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/MeshParameterization/TriangleMesh.h>

/// Private to ModelRegions: the edges of a mesh between its regions, in rows.
namespace knotwork
{
/// Edges between two regions, or of one region along the mesh's rim.
struct RegionChain
{
  std::vector<Eigen::Vector3d> Points;     ///< of a closed chain the first one again at the end
  std::vector<Eigen::Vector3d> MeshPoints; ///< where the mesh has them
  std::vector<int> PointIds;               ///< of the mesh; -1: of none
  std::array<int, 2> Regions{ -1, -1 };    ///< to the left and to the right; -1: none
  std::array<int, 2> Vertices{ -1, -1 };   ///< at both ends; -1: a closed chain without one

  bool IsRim() const { return this->Regions[0] < 0 || this->Regions[1] < 0; }
};

struct ChainUseOfRegion
{
  int Chain = 0;
  bool Reversed = false;
};

struct RegionVertex
{
  Eigen::Vector3d Point;
  Eigen::Vector3d MeshPoint;
  int PointId = -1;         ///< of the mesh; -1: of none
  std::vector<int> Regions; ///< that meet there, ascending
};

struct RegionChains
{
  std::vector<RegionChain> Chains;
  std::vector<RegionVertex> Vertices;
  /// Of each region: loops with its triangles to the left.
  std::vector<std::vector<std::vector<ChainUseOfRegion>>> Loops;

  /// Divides a chain at an inner point, which becomes a vertex; a closed chain without a vertex
  /// gets its first one there, and stays one. @return the vertex.
  int Split(int chain, std::size_t point);

  /// Lets a chain run the other way.
  void Reverse(int chain);
};

/// Chains end where other than two edges between regions, or edges of other regions, meet, and
/// where a rim turns by more than cornerAngle degrees.
/// @param regions  one a triangle, from 0 on.
/// @complexity O(n log n).
RegionChains FindRegionChains(
  const DiscMesh& surface, const std::vector<int>& regions, int numRegions, double cornerAngle);
}
