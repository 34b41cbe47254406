// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BezierProjection.h>
#include <knotwork/SplineCore/UnstructuredSpace.h>

/// Splines of unstructured spaces from the vertices of their meshes.
namespace knotwork
{
/// The spline that follows the vertices: on every cell the vertices around it are interpolated by
/// polynomials, which are projected onto the space: of degree p, and up to p + 4 where that changes
/// less and less, in windows that end at facets that are C^0. It passes the vertices at a distance
/// of O(h^(p+1)), the order of the space where patches between creases have p cells and more, and
/// has the splines of a grid of p + 1 cells and more that are polynomials of degree p.
/// @param vertices  rows by number: coordinates, and whatever goes with them.
/// @return EmptyInput, DimensionMismatch for a space without a mesh; SizeMismatch, NonFiniteInput
/// with the vertex; Aborted.
/// @source  projection: Thomas, Scott, Evans, Tew, Evans, CMAME 284 (2015) 55-105.
template <int Dim>
Result<Spline<Dim>> SplineThroughVertices(const SplineSpacePtr<Dim>& space,
  const PointMatrixView& vertices, int threads = 0, const ProgressCallback& progress = {});

/// The mesh map: on every element the polynomial through the vertices of a window of q cells a
/// direction around it, q the smallest odd number above p, less where facets that are C^0 end it.
/// It differs from a smooth surface through the vertices by O(h^(q+1)), a multilinear one by
/// O(h^2).
/// @param vertices  must outlive the function. @param linear  cells of bad shape, whose own corners
/// alone are interpolated: wider windows swing there.
/// @pre  the space is one on a mesh of as many points; it is kept.
template <int Dim>
ElementFunction InterpolateVertices(const SplineSpacePtr<Dim>& space, const PointMatrix& vertices,
  const std::vector<int>& linear = {});

/// The spline whose control net is the mesh: the control point of every function is the value of
/// the mesh's multilinear map at the function's Greville point, the means of p knots a direction.
/// Inside of patches of odd degree these are the vertices, of even degree the centres of cells. It
/// lies in the convex hulls of vertices, and smooths the mesh by O(h^2).
/// @return as SplineThroughVertices.
/// @source  Schoenberg's operator (Marsden, Schoenberg, Mathematica 8 (1966) 61-82).
template <int Dim>
Result<Spline<Dim>> SplineOfCage(const SplineSpacePtr<Dim>& space, const PointMatrixView& vertices);

struct VertexDistance
{
  double Largest = 0.0;
  double RootMeanSquare = 0.0;
};
/// Distances of the vertices from the points of the spline at the corners of cells.
/// @pre  the spline is of an unstructured space, and has as many columns as the vertices.
template <int Dim>
VertexDistance DistanceFromVertices(
  const Spline<Dim>& spline, const PointMatrixView& vertices, int threads = 0);

/// Elements where the map turns over, at p + 2 points a direction: det J <= 0 against the sign that
/// most elements have in their middles; of surfaces in space, a normal away from the element's mean
/// normal. What cells of bad shape cause; a sample, no proof.
/// @pre  the spline is of an unstructured space; its first columns are the coordinates, 2 or 3.
template <int Dim>
std::vector<int> FoldedElements(const Spline<Dim>& spline, int threads = 0);

/// Largest angle in degrees between normals of a surface from both sides of facets that are C^0, at
/// 2 p + 1 points an edge and its ends. Places without a normal do not count.
/// @param features  facets that are left out, each seen from either cell.
/// @pre  the spline is of an unstructured space; its first three columns are the coordinates.
double LargestCreaseAngle(
  const Spline<2>& surface, const std::vector<CellSide>& features = {}, int threads = 0);
}
