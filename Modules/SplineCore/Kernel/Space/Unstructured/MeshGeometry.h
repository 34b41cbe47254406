// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/CellMesh.h>

namespace knotwork
{
/// A point on an edge that it is no end of.
struct HangingPoint
{
  int Point = -1;            ///< -1: there is none
  std::array<int, 2> Own{};  ///< an edge of the point along the other one
  std::array<int, 2> Edge{}; ///< that it lies on
};

/// The first point between others, in a straight row with edges between them, two of which are
/// joined by one edge past it.
/// @param edges  ends of all edges, in any order and number. @param points  n x 2 or 3, finite.
HangingPoint FindHangingPoint(
  const std::vector<std::array<int, 2>>& edges, const PointMatrixView& points);

/// Whether no point lies on an edge of a cell that it does not belong to, between other points that
/// are joined by edges along it: what local refinement without transition leaves.
/// @param points  NumPoints x 2 or 3.
/// @return InvalidTopology with the point and both cells; SizeMismatch, NonFiniteInput.
/// @complexity O(cells log cells).
template <int Dim>
Status CheckConforming(const CellMesh<Dim>& mesh, const PointMatrixView& points);

/// Mean length of the edges of every sheet, over the mean of all edges: lengths for
/// UnstructuredParams.
/// @return SizeMismatch, NonFiniteInput; InvalidParameter for a sheet whose edges are all points.
template <int Dim>
Result<std::vector<double>> MeanSheetLengths(
  const CellMesh<Dim>& mesh, const MeshTopology<Dim>& topology, const PointMatrixView& points);

/// Inner edges where the normals of two quadrilaterals (cross products of their diagonals) differ
/// by more than an angle, each once.
/// @param degrees  in [0, 180].
/// @return SizeMismatch, NonFiniteInput, InvalidParameter; points have 3 coordinates.
Result<std::vector<CellSide>> SharpEdges(const CellMesh<2>& mesh, const MeshTopology<2>& topology,
  const PointMatrixView& points, double degrees);

/// Inner facets between cells of different labels, each once.
/// @param labels  one a cell. @return SizeMismatch.
template <int Dim>
Result<std::vector<CellSide>> FacetsBetween(
  const MeshTopology<Dim>& topology, const std::vector<double>& labels);

/// A mesh of polygons as quadrilaterals: n around the middle of every polygon of n corners.
struct MidpointMesh
{
  CellMesh<2> Mesh;
  /// Of the points behind the polygons': what they are the means of.
  std::vector<std::vector<int>> Means;
  std::vector<int> Polygon; ///< that every cell is part of
};
/// @param polygons  corners in order. @return EmptyInput; InvalidTopology for a polygon of less
/// than three corners or with a corner that is no point; TooLarge.
Result<MidpointMesh> SplitAtMidpoints(int numPoints, const std::vector<std::vector<int>>& polygons);
}
