// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineCore/Types.h>

#include <cstdint>
#include <vector>

namespace knotwork
{
/// A mesh of quadrilaterals (Dim = 2) or hexahedra (Dim = 3) by the points at the corners of its
/// cells.
template <int Dim>
struct CellMesh
{
  int NumPoints = 0;
  /// 2^Dim a cell; bit d of the number of a corner is the end in direction d. (What VTK calls
  /// corners 2 and 3 of a quadrilateral are exchanged.)
  std::vector<int> Corners;

  int NumCells() const { return static_cast<int>(this->Corners.size() >> Dim); }
  const int* Cell(int cell) const
  {
    return this->Corners.data() + (static_cast<std::size_t>(cell) << Dim);
  }
};

/// A facet as a side of a cell; sides are numbered as in PatchSides.h.
struct CellSide
{
  int Cell = -1;
  int Side = -1;
};

/// How directions of a cell go on in the next one, across a common facet.
template <int Dim>
struct FacetCrossing
{
  std::uint8_t Side = 0;        ///< of the other cell: the facet
  std::uint8_t Orientation = 0; ///< number of the SideOrientation of the facet on `Side`
  bool Coherent = true;         ///< both cells are right-handed, or both left-handed
  /// Side of the other cell that goes on where each side of this one ends: the facet's becomes the
  /// one opposite of `Side`, a side that meets the facet the one that meets it there.
  std::array<std::uint8_t, 2 * Dim> Image{};
};

/// How the cells of a mesh hang together. Facets are edges (Dim = 2) or faces (Dim = 3), ridges are
/// vertices (Dim = 2) or edges (Dim = 3). A ridge is regular when it has four cells, or is on the
/// boundary and has one or two; else it is extraordinary.
template <int Dim>
class MeshTopology
{
public:
  static constexpr int NumSides = 2 * Dim;
  static constexpr int NumCorners = 1 << Dim;
  static constexpr int NumRidges = Dim == 2 ? 4 : 12; ///< of a cell

  /// @return EmptyInput; SizeMismatch; InvalidTopology with the numbers of the cells or points: ids
  /// out of range, a cell with a point twice, points of no cell, cells with the same corners, a
  /// facet of three cells, a facet whose corners two cells have in another order, two cells that
  /// are all around a ridge (a doublet), cells that meet without common facets between them, cells
  /// that are inverted against their neighbours. Quadrilaterals that cannot be oriented are not
  /// refused. @complexity O(cells).
  static Result<MeshTopology> Make(const CellMesh<Dim>& mesh);

  int NumCells() const { return static_cast<int>(this->Links.size()) / NumSides; }
  bool IsBoundary(int cell, int side) const { return this->LinkOf(cell, side).Cell < 0; }
  /// The cell across a side, -1 on the boundary.
  int Neighbour(int cell, int side) const { return this->LinkOf(cell, side).Cell; }
  /// @pre !IsBoundary.
  const FacetCrossing<Dim>& Crossing(int cell, int side) const
  {
    return this->Table[this->LinkOf(cell, side).Crossing];
  }
  /// Number of the crossing among all there are, below NumCrossings. @pre !IsBoundary.
  int CrossingNumber(int cell, int side) const { return this->LinkOf(cell, side).Crossing; }
  static constexpr int NumCrossings = NumSides * NumSides * (Dim == 2 ? 2 : 8);
  const FacetCrossing<Dim>& CrossingOfNumber(int number) const { return this->Table[number]; }
  /// Number of the ridge of a cell where two of its sides meet.
  static int RidgeOf(int side, int other);
  /// The two sides of a cell that meet at a ridge, the lower first.
  static std::array<int, 2> SidesOf(int ridge);
  bool IsExtraordinary(int cell, int ridge) const { return this->Has(cell, ridge); }
  /// Whether the ridge is inside of the mesh and has four cells.
  bool IsRegularInside(int cell, int ridge) const { return this->Has(cell, 16 + ridge); }
  /// The facet opposite of a side's at a ridge with IsRegularInside: of the four the one without a
  /// common cell. @param across  the side that meets `side` at the ridge.
  CellSide Opposite(int cell, int side, int across) const
  {
    return { this->Neighbour(cell, across),
      this->Crossing(cell, across).Image[static_cast<std::size_t>(side)] };
  }
  /// Calls visit(cell, in, out) for the cells around a ridge, `in` and `out` being their sides
  /// there, from a boundary on where there is one. @return whether the ridge is inside of the mesh.
  template <class Visit>
  bool Around(int cell, int ridge, Visit&& visit) const
  {
    const auto [first, second] = SidesOf(ridge);
    CellSide begin{ cell, first };
    int out = second;
    for (CellSide at = begin; !this->IsBoundary(at.Cell, at.Side);)
    {
      const FacetCrossing<Dim>& crossing = this->Crossing(at.Cell, at.Side);
      const int next = crossing.Image[static_cast<std::size_t>(out)];
      at = { this->Neighbour(at.Cell, at.Side), next };
      out = crossing.Side;
      begin = at;
      if (at.Cell == cell)
      {
        break;
      }
    }
    const bool closed = !this->IsBoundary(begin.Cell, begin.Side);
    for (CellSide at = begin;;)
    {
      visit(at.Cell, at.Side, out);
      if (this->IsBoundary(at.Cell, out))
      {
        return closed;
      }
      const FacetCrossing<Dim>& crossing = this->Crossing(at.Cell, out);
      const int next = crossing.Image[static_cast<std::size_t>(at.Side)];
      at = { this->Neighbour(at.Cell, out), crossing.Side };
      out = next;
      if (at.Cell == begin.Cell)
      {
        return closed;
      }
    }
  }

  /// Sheets of parallel edges: number of the sheet of direction d of cell c at c * Dim + d, in the
  /// order in which cells meet them.
  struct EdgeSheets
  {
    int Count = 0;
    std::vector<int> Of;
  };
  EdgeSheets FindSheets() const;

  /// An order in which cells come soon after their neighbours: breadth first. Empty where cells
  /// follow their neighbours as they are numbered.
  std::vector<int> LocalOrder() const;
  /// The same cells in another order. @param order  old number of every new cell.
  MeshTopology Reordered(const std::vector<int>& order) const;

  std::int64_t NumInteriorFacets = 0;
  std::int64_t NumBoundaryFacets = 0;
  std::int64_t NumExtraordinaryRidges = 0;
  bool IsOrientable = true;

private:
  struct Link
  {
    std::int32_t Cell = -1;
    std::uint16_t Crossing = 0;
  };
  static const FacetCrossing<Dim>* Crossings();
  const Link& LinkOf(int cell, int side) const
  {
    return this->Links[static_cast<std::size_t>(cell) * NumSides + static_cast<std::size_t>(side)];
  }
  bool Has(int cell, int bit) const
  {
    return (this->RidgeBits[static_cast<std::size_t>(cell)] >> bit & 1) != 0;
  }
  Status CheckCells(const CellMesh<Dim>& mesh) const;
  Status LinkFacets(const CellMesh<Dim>& mesh);
  Status CheckDoublets(const CellMesh<Dim>& mesh) const;
  Status FindRidges(const CellMesh<Dim>& mesh);
  Status FindApart(const CellMesh<Dim>& mesh, int cell, int ridge) const;
  Status CheckCorners(const CellMesh<Dim>& mesh) const;
  Status CheckOrientation();

  const FacetCrossing<Dim>* Table = Crossings(); ///< of all pairs of sides and orientations
  std::vector<Link> Links;                       ///< NumSides a cell
  bool IsCoherent = true;
  std::vector<std::uint32_t> RidgeBits; ///< extraordinary from bit 0, regular inside from bit 16
};
template <>
Status MeshTopology<2>::FindRidges(const CellMesh<2>& mesh);
template <>
Status MeshTopology<3>::FindRidges(const CellMesh<3>& mesh);
}
