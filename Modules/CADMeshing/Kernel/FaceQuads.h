// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ChartTriangles.h"

namespace knotwork
{
/// Quadrilaterals of one face in its chart, counterclockwise there. The points of a seam are there
/// twice, at both of its places.
struct FaceQuads
{
  /// @return its number. @param node  of the mesh; -1: inside of the face.
  int AddPoint(const Eigen::Vector2d& place, const Eigen::Vector3d& point, int node);

  std::vector<Eigen::Vector2d> Places;
  std::vector<Eigen::Vector3d> Points;
  std::vector<int> Nodes; ///< of the mesh; -1 inside of the face
  std::vector<std::array<int, 4>> Quads;
};

/// Triangles between every other point of the loops are joined in pairs where that makes good
/// quadrilaterals; then both kinds are divided, at their middles and those of their edges: loops
/// with an even number of points always become quadrilaterals.
/// @return failures of TriangulateChart.
/// @source  Blacker, Stephenson, Int. J. Numer. Meth. Eng. 32 (1991) 811 (even boundaries are what
/// quadrilaterals need).
Result<FaceQuads> PaveFace(const FaceChart& chart, const std::vector<ChartLoop>& loops,
  const ChartSizes& sizes, int maxTriangles);

/// Smallest sine of the angle at a corner, signed, about the normal of the face: 1 is a right
/// angle, below 0 it is folded.
double ScaledJacobian(const FaceQuads& mesh, const std::vector<Eigen::Vector3d>& normals, int quad);

/// Normals of all points.
std::vector<Eigen::Vector3d> NormalsOf(const FaceChart& chart, const FaceQuads& mesh);

/// Moves inner points on the surface to raise the smallest scaled Jacobians.
/// @return the smallest of all.
double SmoothFace(const FaceChart& chart, FaceQuads& mesh);
}
