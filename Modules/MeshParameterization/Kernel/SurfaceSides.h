// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "TriangleAdjacency.h"
#include "TriangleMesh.h"

namespace knotwork
{
/// What the division of a surface in two asks for again and again.
struct SurfaceParts
{
  const DiscMesh& Mesh;
  TriangleAdjacency Adjacency;
  std::vector<Eigen::Vector3d> Normals; ///< one a triangle
  std::vector<double> Areas;            ///< one a triangle
  /// One a point: number of the hole that must not be cut, or -1.
  const std::vector<int>& Holes;

  SurfaceParts(const DiscMesh& mesh, const std::vector<int>& holes);
  /// Angle between the normals beside side k of triangle t, radians; 0 on the boundary.
  double Dihedral(std::size_t t, std::size_t k) const;
  double SideLength(std::size_t t, std::size_t k) const;
};

/// Side (0 or 1) of each triangle; empty when a surface cannot be divided that way.
using Sides = std::vector<char>;

/// Sides of two directions: the sum over triangles of area |normal - direction of the side|^2 and
/// over the edges between the sides of their length, less where they are sharp, becomes small.
/// @source Cohen-Steiner, Alliez, Desbrun, ACM TOG 23 (2004) 905 (the measure L2,1); Boykov,
/// Veksler, Zabih, IEEE PAMI 23 (2001) 1222.
Sides DivideByNormals(const SurfaceParts& parts);

/// Sides of the sign of the harmonic function that is 1 at some points and -1 at others: the cut
/// runs between the two.
Sides DivideBetween(
  const SurfaceParts& parts, const std::vector<int>& first, const std::vector<int>& second);

/// Sides of the sign of the first eigenvector of the Laplacian: halves of a long surface.
Sides DivideByLength(const SurfaceParts& parts);

/// Sides of a plane across the longest principal axis: any surface can be divided that way.
Sides DivideByPosition(const SurfaceParts& parts);

/// Gives components of a side whose area is less than a share of the whole to the other side; the
/// largest one of each side stays.
void JoinIslands(
  const TriangleAdjacency& adjacency, const std::vector<double>& areas, double share, Sides& sides);
}
