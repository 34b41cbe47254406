// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/MeshParameterization/TriangleMesh.h>

#include <Eigen/Core>

#include <utility>
#include <vector>

namespace knotwork
{
enum class GeodesicEstimator
{
  Unfolding, ///< waves across triangles from an unfolded source
  EdgeGraph ///< shortest paths of edges (Dijkstra): too long by some percent, however fine the mesh
};

/// Geodesic distances on a mesh from one vertex. A wave crosses an edge from the point in the plane
/// of the next triangle that has the distances of the edge's ends (exact on developable surfaces
/// where the way is straight; bends at corners of the boundary are taken along edges).
/// @source  Novotni, Klein, WSCG 10 (2002) 341-347; positions: Melvaer, Reimers, CGF 31 (2012).
class GeodesicMarch
{
public:
  explicit GeodesicMarch(
    const DiscMesh& mesh, GeodesicEstimator estimator = GeodesicEstimator::Unfolding);

  /// Distances of all vertices. @complexity O(n log n).
  std::vector<double> Distances(int source);

  /// The source and its `count` nearest vertices (fewer on a smaller mesh), by distance; each with
  /// its place in the plane, unfolded triangle by triangle around the source at the origin: exact
  /// up to a rotation where the surface is developable. Angles at an inner source are scaled to
  /// fill 2 pi.
  /// @complexity O(count log count).
  void Nearest(int source, int count, std::vector<int>& vertices, PointMatrix& places);

private:
  void Start(int source);
  void CrossFan(int vertex);
  void Reach(int a, int b, int c, double ab, double ac, double bc, double side);
  bool Next(int& vertex);

  const DiscMesh& Mesh;
  GeodesicEstimator Estimator;
  int Run = 0;
  std::vector<int> Touched; ///< run that gave a vertex its distance
  std::vector<char> Final;
  std::vector<double> Distance;
  std::vector<Eigen::Vector2d> Place;
  std::vector<std::pair<double, int>> Heap;
};
}
