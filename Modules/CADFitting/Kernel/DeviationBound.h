// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/TriangleIndex.h>

namespace knotwork
{
struct DeviationBoundParams
{
  /// Of the facets that take the surface's place, unit of the points, > 0: what they are off by is
  /// part of the bounds.
  double Tolerance = 1e-3;
  double Enough = 0.0; ///< bounds that are not larger are left as they are, >= 0
  /// Others are refined until they are at most so many times a distance that is met there, > 1.
  double Ratio = 1.1;
  int MaxPieces = 2000; ///< parts of a triangle looked at before it is left as it is, >= 1
  int Threads = 0;      ///< 0: all cores; the result does not depend on it
  ProgressCallback Progress;
};

/// Proved: no point is farther away. Rounding is allowed for by 1e-13 of the coordinates.
struct DeviationBound
{
  double OfSurface = -1.0;         ///< of the surface from the triangles; -1: none
  double OfMesh = -1.0;            ///< of the triangles from the surface
  std::vector<double> OfElements;  ///< of the surface's elements from the triangles
  std::vector<double> OfTriangles; ///< of every triangle from the surface
  double Flatness = 0.0;           ///< bound of what the facets are off by, in all of these
};

/// Bounds of the distances between a spline surface and a triangle mesh, both ways.
///
/// The surface is replaced by facets that are proved to be near it (Tessellate). The distance from
/// one triangle is a convex function, so that over a plane polygon it is largest at a corner. Every
/// facet, and every triangle of the mesh, is a polygon whose bound is the least of those from the
/// triangles of the other side near its corners and its middle. Where that is too much the polygon
/// is cut: along the plane between two triangles with a common edge, else across its longest
/// diagonal.
/// @return the errors of Tessellate; EmptyInput for a mesh without triangles; InvalidParameter;
/// Aborted.
/// @complexity some polygons a facet and a triangle, each a few closest points.
Result<DeviationBound> BoundSurfaceDeviation(const BezierForm<2>& surface,
  const TriangleIndex<3>& mesh, const DeviationBoundParams& params = {});
}
