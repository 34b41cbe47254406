// SPDX-License-Identifier: BSD-3-Clause
// Parts of the tessellation, private to the kernel: dyadic charts, sides that match, vertices.
#pragma once
#include "ChartCell.h"
#include "DisjointSets.h"
#include "MultiPatch.h"
#include "PointClusters.h"
#include "Tessellation.h"

#include <unordered_map>

namespace knotwork
{
/// Charts of all elements of all patches, patch after patch; numCharts receives their number.
template <int Dim>
std::vector<std::vector<ChartCell<Dim>>> MakeCharts(
  const std::vector<BezierForm<Dim>>& patches, int& numCharts);

/// A point of a chart.
struct ChartPoint
{
  int Chart = 0;
  std::array<std::int64_t, 3> X{};
  bool operator==(const ChartPoint& other) const
  {
    return this->Chart == other.Chart && this->X == other.X;
  }
};

/// Vertices on the borders of elements, by position.
class VertexTable
{
public:
  /// Vertex at a position, made when it is new.
  int At(const ChartPoint& point);
  /// A vertex that no other element can have.
  int Add() { return this->Sets.Add(); }
  DisjointSets Sets;

private:
  struct Hash
  {
    std::size_t operator()(const ChartPoint& p) const;
  };
  std::unordered_map<ChartPoint, int, Hash> Map;
};

/// Finds sides with the same points up to rounding.
class SideMatcher
{
public:
  /// @param largest  magnitude of the largest value that points will have.
  SideMatcher(int planes, double largest)
    : Planes(planes), Clusters(planes, largest * PointClusters::RelativeTolerance)
  {
  }
  /// @param points  count points of `planes` values each, point by point.
  void Add(const PatchSide& side, const std::array<std::int64_t, 2>& count,
    const std::vector<double>& points);
  const std::vector<PatchInterface>& Interfaces() const { return this->Sides.Interfaces; }

private:
  int Planes;
  PointClusters Clusters;
  SharedSides Sides;
};

/// Largest magnitude in the data of all patches.
template <int Dim>
double LargestValue(const std::vector<BezierForm<Dim>>& patches);

/// An element as the corner of a cell sees it: where a vertex is evaluated.
struct VertexUse
{
  int Vertex = 0;
  int Patch = 0;
  int Element = 0;
  std::array<double, 3> Local{};
  std::array<int, 2> Tangents{ 0, 1 }; ///< the normal is the product of these derivatives
  bool Flip = false;                   ///< times -1
};

/// Cells over vertex uses.
struct CellSoup
{
  std::vector<VertexUse> Uses;
  std::vector<TessellationShape> Shapes;
  std::vector<std::int64_t> Offsets{ 0 };
  std::vector<int> Corners; ///< uses
  std::vector<int> CellPatch;
  std::vector<int> CellElement;

  void AddCell(TessellationShape shape, const int* corners, int n, int patch, int element);
};

/// Evaluates the uses, shares or splits points, drops collapsed polygons.
template <int Dim>
Status FinishTessellation(const std::vector<BezierForm<Dim>>& patches,
  const TessellationParams& params, const VertexTable& vertices, const CellSoup& soup,
  TessellationMesh& mesh);

/// Lines of one-parameter patches.
Status TessellateCurves(const std::vector<BezierForm<1>>& patches, const TessellationParams& params,
  TessellationMesh& mesh);
/// Polygons of two-parameter patches, or of the outer faces of three-parameter patches.
template <int Dim>
Status TessellateSurfaces(const std::vector<BezierForm<Dim>>& patches,
  const TessellationParams& params, TessellationMesh& mesh);
/// Hexahedra of three-parameter patches.
Status TessellateVolumes(const std::vector<BezierForm<3>>& patches,
  const TessellationParams& params, TessellationMesh& mesh);

/// Points of one side of a block: the Bernstein control points with index 0 (end 0) or p (end 1) in
/// a direction, point by point (w x, ..., w), w = 1 when polynomial. Axes are the other directions
/// in ascending order; count has the points along them (1 where there is none).
struct BlockSide
{
  std::array<int, 2> Axes{ -1, -1 };
  std::array<std::int64_t, 2> Count{ 1, 1 };
  std::vector<double> Points;
};
template <int Dim>
BlockSide ExtractSide(const BezierForm<Dim>& form, int element, int direction, int end);
}
