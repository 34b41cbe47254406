// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/MeshParameterization/TriangleMesh.h>
#include <knotwork/SplineCore/FitAnalyticSurface.h>

namespace knotwork
{
/// Triangles of one plane that hang together: strips of a tessellated cylinder are one each.
struct FacetCluster
{
  std::vector<int> Triangles;
  std::vector<int> Points; ///< ascending
  FlatPiece Piece;
  double Area = 0.0;
};

/// The other side of an edge between clusters.
struct ClusterSide
{
  int Cluster = 0;
  std::array<int, 2> Edge{}; ///< points
  double Angle = 0.0;        ///< between the normals of the triangles beside the edge, radians
};

struct FacetClusters
{
  std::vector<FacetCluster> Clusters;
  std::vector<std::vector<ClusterSide>> Sides; ///< one list a cluster
  std::vector<Eigen::Vector3d> Normals;        ///< one a triangle
  std::vector<double> Heights;                 ///< least one, one a triangle
};

/// @param surface  of CheckSurface.
/// @param flatness  largest distance of a cluster's points from its plane.
/// @complexity O(n log n).
FacetClusters FindFacetClusters(const DiscMesh& surface, double flatness);

/// How many points of every region lie in no other one. A single row of facets has none.
/// @param regionOfCluster  one a cluster, in [0, numRegions).
std::vector<int> CountPointsInside(
  const FacetClusters& facets, const std::vector<int>& regionOfCluster, std::size_t numRegions);
}
