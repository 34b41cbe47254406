// SPDX-License-Identifier: BSD-3-Clause
// Parts of the tessellation, private to the kernel: dyadic charts, sides that match, vertices, and
// what elements are cut into.
#pragma once
#include "ChartCell.h"
#include "ChordalBound.h"
#include "DisjointSets.h"
#include "MultiPatch.h"
#include "PointClusters.h"
#include "Tessellation.h"

#include <initializer_list>

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

/// The grid that all vertices of a chart lie on.
struct ChartLattice
{
  int First = 0; ///< number of its first vertex
  std::array<std::int64_t, 3> Lower{};
  std::array<int, 3> Shift{};          ///< steps are 2^Shift
  std::array<std::int64_t, 3> Count{}; ///< vertices along the directions
};

/// Vertices on the borders of elements, by position: by their places on lattices, where charts have
/// these, else in an open hash table with linear probing.
class VertexTable
{
public:
  /// @param lattices  of all charts, or none. @param count  vertices of all lattices.
  explicit VertexTable(std::vector<ChartLattice> lattices = {}, int count = 0)
    : Sets(count), Lattices(std::move(lattices))
  {
  }
  /// Vertex at a position, made when it is new.
  int NumberOf(const ChartPoint& point);
  DisjointSets Sets;

private:
  void Grow();
  std::size_t Place(const ChartPoint& point) const;

  std::vector<ChartLattice> Lattices;
  std::vector<ChartPoint> Points; ///< of all vertices
  std::vector<int> Slots;         ///< -1: free; a power of two, at most half of them taken
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

/// Bounds of the second derivatives of what is cut, by its number; parts that tell each other find
/// a share of them each.
/// @return in all parts alike Aborted, where one gave fewer than its share.
template <int K>
Result<std::vector<SecondDerivativeBound<K>>> FindBounds(std::size_t count,
  const TessellationParams& params,
  const std::function<SecondDerivativeBound<K>(std::size_t)>& boundOf);

/// What is cut into cells: an element, or a face of one.
struct CutElement
{
  int Patch = 0;
  int Element = 0;
  std::array<int, 2> Tangents{ 0, 1 }; ///< normals are the product of these derivatives
  bool Flip = false;                   ///< times -1
  int Side = -1;                       ///< of a face, 2 direction + end
};

/// A vertex of a cut on the border of its element.
struct BorderVertex
{
  ChartPoint Position;
  std::int64_t Number = 0; ///< among the vertices of the cut
  std::array<double, 3> Local{};
};

/// The vertices of a cut, in the order of their first use, and its cells.
struct Cut
{
  std::vector<std::array<double, 3>> Local;
  std::vector<TessellationShape> Shapes;
  std::vector<int> Corners; ///< vertices of the cells, one cell after the other

  void Clear();
  void AddCell(TessellationShape shape, std::initializer_list<int> corners);
};

/// The elements of all patches, or faces of them, with what each becomes: known before a point is
/// evaluated. Not changed by its functions, which threads may call at once.
class TessellationCuts
{
public:
  virtual ~TessellationCuts() = default;
  /// Patch after patch.
  virtual std::size_t Count() const = 0;
  virtual CutElement ElementOf(std::size_t cut) const = 0;
  /// Cells, about: shares of the work are made by it.
  virtual double NumCells(std::size_t cut) const = 0;
  /// The vertices of a cut on the border of its element, by their numbers.
  /// @return how many vertices the cut has, those within included.
  virtual std::int64_t Border(std::size_t cut, std::vector<BorderVertex>& border) const = 0;
  virtual void Make(std::size_t cut, Cut& made) const = 0;
  /// Where all vertices are.
  virtual VertexTable MakeTable() const { return VertexTable(); }
  /// Makes one of vertices where elements meet and where sides are points.
  virtual void Unite(VertexTable& vertices) const = 0;
};

/// Numbers the points, evaluates those of the part and makes its cells, without collapsed polygons.
template <int Dim>
Status AssembleTessellation(const std::vector<BezierForm<Dim>>& patches,
  const TessellationParams& params, const TessellationCuts& cuts, TessellationMesh& mesh);

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
