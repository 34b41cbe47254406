// SPDX-License-Identifier: BSD-3-Clause
// Triangles divided where they meet, and put together to sheets that do not cross, private to the
// kernel.
#pragma once
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineCore/TriangleIndex.h>

#include <utility>
#include <vector>

namespace knotwork
{
/// Sheets of triangles: every edge joins two triangles, every point one fan of them. Points of
/// several fans are there several times, at the same place.
struct SheetMesh
{
  PointMatrix Points; ///< n x 3, rounded
  std::vector<MeshTriangle> Triangles;
  std::vector<int> Sources;  ///< triangle of the input, one a triangle
  std::vector<int> Sheets;   ///< number of the sheet, one a triangle
  std::vector<int> PointIds; ///< of the input, -1: made where triangles meet; one a point
  std::vector<int> Places;   ///< equal for points that are one in space; one a point
  int NumSheets = 0;
  std::vector<Eigen::Vector3d> Cancelled;    ///< triangles on top of each other that run oppositely
  std::vector<Eigen::Vector3d> OpenEdges;    ///< middles of edges of one triangle
  std::vector<Eigen::Vector3d> TwistedEdges; ///< whose triangles do not run both ways alike
  std::vector<Eigen::Vector3d> CrowdedEdges; ///< of more than two triangles
};

/// Triangles that were divided.
struct DividedTriangles
{
  PointMatrix Points; ///< those given, then new ones, rounded
  std::vector<MeshTriangle> Triangles;
  std::vector<int> Sources; ///< triangle of the input, one a triangle
};

/// Divides the triangles of pairs along what they have in common, exactly.
/// @param triangles  none of them degenerate, points of equal place have one number.
Result<DividedTriangles> DivideTriangles(const PointMatrix& points,
  const std::vector<MeshTriangle>& triangles, const std::vector<std::pair<int, int>>& pairs);

/// Takes edges and heights away that are shorter than a distance: points are put on others, or
/// edges led through points. What is closed stays closed.
/// @return the same points, fewer of which are used.
DividedTriangles SnapTriangles(
  const PointMatrix& points, const std::vector<MeshTriangle>& triangles, double distance);

/// Divides the triangles of pairs along what they have in common, exactly, and joins what comes
/// together at an edge as the boundaries of the regions of equal winding number there: sheets
/// touch, but do not cross. Triangles on top of each other that run oppositely cancel.
/// @param triangles  none of them degenerate, points of equal place have one number.
/// @param pairs  of FindIntersections.
/// @param snap  edges and heights of divided triangles that are shorter than it go.
/// @return with OpenEdges or TwistedEdges: nothing but these.
Result<SheetMesh> ArrangeSheets(const PointMatrix& points,
  const std::vector<MeshTriangle>& triangles, const std::vector<std::pair<int, int>>& pairs,
  double snap);
}
