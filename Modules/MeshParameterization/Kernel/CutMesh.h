// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FlattenCharts.h"

#include <cstdint>
#include <unordered_map>

namespace knotwork
{
/// A mesh in the course of being cut: triangles know their chart and their corners' places in the
/// chart's plane.
struct CutMesh
{
  using Places = std::array<Eigen::Vector2d, 3>;

  std::vector<Eigen::Vector3d> Points;
  std::vector<PointOrigin> Origins;
  std::vector<std::array<int, 3>> Triangles;
  std::vector<int> TriangleIds; ///< of the input
  std::vector<int> Charts;      ///< one a triangle
  std::vector<char> Sides;      ///< one a triangle, of the cut that is made: 0 or 1
  std::vector<Places> UV;       ///< one a triangle

  explicit CutMesh(const DiscMesh& mesh);

  static std::uint64_t EdgeKey(int a, int b);

  /// Puts a new point on an edge. @param weight  of the end b, in (0, 1).
  int AddPoint(int a, int b, double weight);

  /// Divides all triangles at points on their edges, in all charts alike: parts get what their
  /// triangle has, places are linear along edges, so that maps do not change.
  /// @param points  the new point of an edge, by its key.
  void Split(const std::unordered_map<std::uint64_t, int>& points);

  /// Triangles of a chart, ascending.
  std::vector<int> TrianglesOf(int chart) const;

private:
  struct OnEdge
  {
    int A = 0;           ///< the lower end
    double Weight = 0.0; ///< of the other end
  };
  std::unordered_map<int, OnEdge> NewPoints;

  void Divide(std::size_t t, const std::array<int, 3>& points);
};

/// A chart as a mesh of its own.
struct ChartPart
{
  DiscMesh Mesh;
  std::vector<int> Points;    ///< of the cut mesh, one a point of Mesh, ascending
  std::vector<int> Triangles; ///< of the cut mesh, one a triangle of Mesh
};

/// Fans of triangles that touch in a point only get a point each.
/// @param triangles  of the cut mesh, ascending, connected across edges.
/// @return failures of CheckSurface.
Result<ChartPart> TakePart(const CutMesh& mesh, const std::vector<int>& triangles);

/// Components of the triangles of a chart with each other across edges; in a component triangles
/// have the same side. Ascending in each; components by their first triangle.
std::vector<std::vector<int>> Components(const CutMesh& mesh, const std::vector<int>& triangles);
}
