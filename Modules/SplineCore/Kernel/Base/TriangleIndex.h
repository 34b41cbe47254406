// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BoxTree.h>

#include <array>
#include <vector>

namespace knotwork
{
using MeshTriangle = std::array<int, 3>;

/// A point of a triangle mesh, and how far it is from a query.
struct TriangleFoot
{
  int Triangle = -1;   ///< -1: none
  double Second = 0.0; ///< barycentric coordinate of the triangle's corner 1
  double Third = 0.0;  ///< of corner 2; that of corner 0 is 1 - Second - Third
  double SquaredDistance = std::numeric_limits<double>::infinity();
};

/// Combination of three corners; the corners themselves come out exactly.
template <int Dim>
Eigen::Matrix<double, 1, Dim> PointOfTriangle(
  const double* a, const double* b, const double* c, double second, double third)
{
  using Row = Eigen::Map<const Eigen::Matrix<double, 1, Dim>>;
  return (1.0 - second - third) * Row(a) + second * Row(b) + third * Row(c);
}

/// Closest point of a triangle in Dim-space, which may be degenerate. Coordinates are non-negative
/// with a sum of at most 1; the distance is that to a point within the corners' box, so that it is
/// never below the distance to the box.
/// @param triangle  copied to the result.
template <int Dim>
TriangleFoot ClosestOnTriangle(
  const double* a, const double* b, const double* c, const double* point, int triangle = 0);

/// For each point the first one at equal coordinates.
std::vector<int> FirstOfEqualPoints(const PointMatrix& points);

/// Triangles with every corner replaced: corner i by replacement[i].
std::vector<MeshTriangle> ReplaceCorners(
  std::vector<MeshTriangle> triangles, const std::vector<int>& replacement);

/// The triangle on the other side of each edge (corners k and k + 1), -1 where there is none or
/// more than one.
std::vector<MeshTriangle> TriangleNeighbours(const std::vector<MeshTriangle>& triangles);

/// Closest points on a triangle mesh in Dim-space, whose points may move. Long slivers that run
/// aslant are held by several boxes, along their longest edges, so that these enclose little else.
/// @source Ernst, Greiner, Early split clipping for bounding volume hierarchies, IEEE Symposium on
/// Interactive Ray Tracing 2007.
template <int Dim>
class TriangleIndex
{
public:
  TriangleIndex() = default;
  /// @param points  n x Dim, finite. @param triangles  at least one, of rows of points.
  TriangleIndex(PointMatrix points, std::vector<MeshTriangle> triangles);
  /// The same mesh with its points elsewhere. @complexity O(n).
  void Move(const PointMatrixView& points);

  const PointMatrix& Points() const { return this->Corners; }
  const std::vector<MeshTriangle>& Triangles() const { return this->Mesh; }
  const double* Corner(int triangle, int corner) const
  {
    const auto t = static_cast<std::size_t>(triangle);
    return this->Corners.data() +
      static_cast<std::ptrdiff_t>(this->Mesh[t][static_cast<std::size_t>(corner)]) * Dim;
  }
  Eigen::Matrix<double, 1, Dim> PointAt(int triangle, double second, double third) const
  {
    return PointOfTriangle<Dim>(this->Corner(triangle, 0), this->Corner(triangle, 1),
      this->Corner(triangle, 2), second, third);
  }
  /// Closest point of one triangle.
  TriangleFoot Foot(int triangle, const double* point) const
  {
    return ClosestOnTriangle<Dim>(this->Corner(triangle, 0), this->Corner(triangle, 1),
      this->Corner(triangle, 2), point, triangle);
  }
  /// Closest point of the mesh with squared distance <= bound; of equally near triangles the first.
  TriangleFoot Nearest(
    const double* point, double bound = std::numeric_limits<double>::infinity()) const;
  /// Closest points of the rows of queries, each as by itself. Where they come near each other one
  /// after the other, as many as a group holds look at the same few triangles.
  /// @complexity O(1) a query near the ones before, in the mean; else O(log n).
  void Nearest(const PointMatrixView& queries, std::vector<TriangleFoot>& feet) const;

private:
  /// Part of a triangle, of equal ones along its longest edge.
  struct Strip
  {
    int Triangle;
    int Number;
    int Count;
  };
  void MakeStrips();
  int TriangleOf(int strip) const { return this->Strips[static_cast<std::size_t>(strip)].Triangle; }
  void Boxes(PointMatrix& lower, PointMatrix& upper) const;

  PointMatrix Corners;
  std::vector<MeshTriangle> Mesh;
  std::vector<Strip> Strips; ///< that the boxes of the tree enclose, ascending
  BoxTree Tree;
};
}
