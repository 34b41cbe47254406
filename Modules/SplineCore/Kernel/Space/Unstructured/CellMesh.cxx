// SPDX-License-Identifier: BSD-3-Clause
#include "CellMesh.h"

#include "DisjointSets.h"
#include "PatchSides.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

template <int Dim>
constexpr int NumOrientations = Dim == 2 ? 2 : 8;

template <int Dim>
std::uint16_t NumberOf(int side, int other, int orientation)
{
  return static_cast<std::uint16_t>((side * 2 * Dim + other) * NumOrientations<Dim> + orientation);
}

template <int Dim>
FacetCrossing<Dim> MakeCrossing(int side, int other, const SideOrientation& orientation)
{
  FacetCrossing<Dim> made;
  made.Side = static_cast<std::uint8_t>(other);
  made.Orientation = static_cast<std::uint8_t>(orientation.Number());
  made.Coherent = SideSign(side) * SideSign(other) * orientation.Sign() == -1;
  made.Image[At(side)] = static_cast<std::uint8_t>(other ^ 1);
  made.Image[At(side ^ 1)] = static_cast<std::uint8_t>(other);
  const auto own = SideDirections<Dim>(side);
  const auto directions = SideDirections<Dim>(other);
  for (std::size_t k = 0; k + 1 < Dim; ++k)
  {
    const std::size_t direction = directions[At(orientation.Axis[k])];
    for (std::size_t end = 0; end < 2; ++end)
    {
      made.Image[2 * own[k] + end] =
        static_cast<std::uint8_t>(2 * direction + (orientation.Reversed[k] ? 1 - end : end));
    }
  }
  return made;
}

/// Corners of the facets of a cell.
template <int Dim>
struct FacetCorners
{
  static constexpr int Count = 1 << (Dim - 1);
  std::array<std::array<int, Count>, 2 * Dim> OfSide;
  /// Corner of the other facet at one of this, by orientation.
  std::array<std::array<int, Count>, NumOrientations<Dim>> Turned;

  FacetCorners()
  {
    for (int corner = 0; corner < Count; ++corner)
    {
      for (int side = 0; side < 2 * Dim; ++side)
      {
        this->OfSide[At(side)][At(corner)] = PatchCorner<Dim>(side, corner);
      }
      for (int o = 0; o < NumOrientations<Dim>; ++o)
      {
        this->Turned[At(o)][At(corner)] = SideOrientation::Make(o).Corner(corner) & (Count - 1);
      }
    }
  }
};

template <int Dim>
const FacetCorners<Dim>& Corners()
{
  static const FacetCorners<Dim> corners;
  return corners;
}

/// A facet's points but the lowest, ascending, and its number.
template <int Dim>
struct FacetEntry
{
  std::array<int, FacetCorners<Dim>::Count - 1> Rest;
  std::uint32_t FacetAndTurn; ///< 2 facet + 1 where an edge's first corner is not the lowest point

  int Facet() const { return static_cast<int>(this->FacetAndTurn >> 1); }
  bool IsTurned() const { return (this->FacetAndTurn & 1) != 0; }
  bool operator<(const FacetEntry& other) const
  {
    return this->Rest != other.Rest ? this->Rest < other.Rest
                                    : this->FacetAndTurn < other.FacetAndTurn;
  }
};

template <int Dim>
std::array<int, FacetCorners<Dim>::Count> SortedPoints(
  const CellMesh<Dim>& mesh, const FacetCorners<Dim>& facets, int facet)
{
  std::array<int, FacetCorners<Dim>::Count> points;
  const int* corners = mesh.Cell(facet / (2 * Dim));
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    points[k] = corners[facets.OfSide[At(facet % (2 * Dim))][k]];
  }
  if constexpr (Dim == 2)
  {
    return { std::min(points[0], points[1]), std::max(points[0], points[1]) };
  }
  std::sort(points.begin(), points.end());
  return points;
}

/// Orientation of the facet of one entry on that of another with the same points; -1 for none.
template <int Dim>
int OrientationOf(const CellMesh<Dim>& mesh, const FacetEntry<Dim>& a, const FacetEntry<Dim>& b)
{
  if constexpr (Dim == 2)
  {
    return a.IsTurned() != b.IsTurned() ? 1 : 0;
  }
  const FacetCorners<Dim>& facets = Corners<Dim>();
  const auto point = [&](const FacetEntry<Dim>& entry, int corner)
  {
    const int facet = entry.Facet();
    return mesh.Cell(facet / (2 * Dim))[facets.OfSide[At(facet % (2 * Dim))][At(corner)]];
  };
  for (int o = 0; o < NumOrientations<Dim>; ++o)
  {
    bool fits = true;
    for (int k = 0; k < FacetCorners<Dim>::Count; ++k)
    {
      fits = fits && point(b, facets.Turned[At(o)][At(k)]) == point(a, k);
    }
    if (fits)
    {
      return o;
    }
  }
  return -1;
}

std::string Name(int cell)
{
  return "cell " + std::to_string(cell);
}
std::string Names(int a, int b)
{
  return "cells " + std::to_string(std::min(a, b)) + " and " + std::to_string(std::max(a, b));
}

template <int Dim>
std::array<int, (1 << Dim)> SortedCorners(const CellMesh<Dim>& mesh, int cell)
{
  std::array<int, (1 << Dim)> corners;
  std::copy_n(mesh.Cell(cell), corners.size(), corners.begin());
  std::sort(corners.begin(), corners.end());
  return corners;
}
template <int Dim>
bool HaveSameCorners(const CellMesh<Dim>& mesh, int a, int b)
{
  return SortedCorners(mesh, a) == SortedCorners(mesh, b);
}
Status Duplicate(int a, int b)
{
  return { ErrorCode::InvalidTopology, Names(a, b) + " have the same corners; remove one" };
}
}

template <int Dim>
const FacetCrossing<Dim>* MeshTopology<Dim>::Crossings()
{
  static const std::vector<FacetCrossing<Dim>> table = []
  {
    std::vector<FacetCrossing<Dim>> all;
    for (int side = 0; side < NumSides; ++side)
    {
      for (int other = 0; other < NumSides; ++other)
      {
        for (int o = 0; o < NumOrientations<Dim>; ++o)
        {
          all.push_back(MakeCrossing<Dim>(side, other, SideOrientation::Make(o)));
        }
      }
    }
    return all;
  }();
  return table.data();
}

template <int Dim>
int MeshTopology<Dim>::RidgeOf(int side, int other)
{
  const int low = std::min(side, other);
  const int high = std::max(side, other);
  const int pair = low / 2 + high / 2 - 1; // directions 0 1, 0 2, 1 2
  return 4 * pair + (low & 1) + 2 * (high & 1);
}

template <int Dim>
std::array<int, 2> MeshTopology<Dim>::SidesOf(int ridge)
{
  const int pair = ridge / 4;
  return { (pair == 2 ? 2 : 0) + (ridge & 1), (pair == 0 ? 2 : 4) + (ridge >> 1 & 1) };
}

template <int Dim>
Status MeshTopology<Dim>::CheckCells(const CellMesh<Dim>& mesh) const
{
  if (mesh.Corners.empty())
  {
    return { ErrorCode::EmptyInput, "the mesh has no cells" };
  }
  if (mesh.Corners.size() % NumCorners != 0)
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(mesh.Corners.size()) + " corners are not " + std::to_string(NumCorners) +
        " a cell" };
  }
  if (mesh.Corners.size() / NumCorners * NumSides > std::numeric_limits<int>::max())
  {
    return { ErrorCode::TooLarge, "a mesh has at most 2^31 - 1 sides of cells" };
  }
  std::vector<char> used(At(std::max(mesh.NumPoints, 0)), 0);
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    const int* corners = mesh.Cell(c);
    for (int i = 0; i < NumCorners; ++i)
    {
      if (corners[i] < 0 || corners[i] >= mesh.NumPoints)
      {
        return { ErrorCode::InvalidTopology,
          Name(c) + " has point " + std::to_string(corners[i]) + " of " +
            std::to_string(mesh.NumPoints) };
      }
      for (int k = 0; k < i; ++k)
      {
        if (corners[k] == corners[i])
        {
          return { ErrorCode::InvalidTopology,
            Name(c) + " has point " + std::to_string(corners[i]) + " twice" };
        }
      }
      used[At(corners[i])] = 1;
    }
  }
  const auto unused = std::find(used.begin(), used.end(), 0);
  if (unused != used.end())
  {
    return { ErrorCode::InvalidTopology,
      "point " + std::to_string(unused - used.begin()) + " belongs to no cell; remove it" };
  }
  return {};
}

template <int Dim>
Status MeshTopology<Dim>::LinkFacets(const CellMesh<Dim>& mesh)
{
  using Entry = FacetEntry<Dim>;
  const FacetCorners<Dim>& facets = Corners<Dim>();
  const int numFacets = mesh.NumCells() * NumSides;
  this->Links.assign(At(numFacets), Link());

  // facets by their lowest point
  std::vector<int> first(At(mesh.NumPoints) + 1, 0);
  for (int f = 0; f < numFacets; ++f)
  {
    ++first[At(SortedPoints(mesh, facets, f)[0]) + 1];
  }
  for (std::size_t i = 1; i < first.size(); ++i)
  {
    first[i] += first[i - 1];
  }
  std::vector<Entry> entries(At(numFacets));
  std::vector<int> next(first.begin(), first.end() - 1);
  for (int f = 0; f < numFacets; ++f)
  {
    const auto points = SortedPoints(mesh, facets, f);
    Entry entry; // written at once: nothing waits for the memory where it goes
    std::copy(points.begin() + 1, points.end(), entry.Rest.begin());
    const int corner = facets.OfSide[At(f % NumSides)][0];
    entry.FacetAndTurn = 2 * static_cast<std::uint32_t>(f) +
      (Dim == 2 && mesh.Cell(f / NumSides)[corner] != points[0] ? 1 : 0);
    entries[At(next[At(points[0])]++)] = entry;
  }

  for (std::size_t point = 0; point + 1 < first.size(); ++point)
  {
    const auto begin = entries.begin() + first[point];
    const auto end = entries.begin() + first[point + 1];
    std::sort(begin, end);
    for (auto a = begin; a != end;)
    {
      const auto b = a + 1;
      if (b == end || b->Rest != a->Rest)
      {
        ++this->NumBoundaryFacets;
        a = b;
        continue;
      }
      const int facet = a->Facet();
      const int otherFacet = b->Facet();
      const int own = facet / NumSides;
      const int other = otherFacet / NumSides;
      if (b + 1 != end && (b + 1)->Rest == a->Rest)
      {
        const int third = (b + 1)->Facet() / NumSides;
        return HaveSameCorners(mesh, own, other) ? Duplicate(own, other)
          : HaveSameCorners(mesh, own, third)    ? Duplicate(own, third)
          : HaveSameCorners(mesh, other, third)
          ? Duplicate(other, third)
          : Status{ ErrorCode::InvalidTopology,
              "cells " + std::to_string(own) + ", " + std::to_string(other) + " and " +
                std::to_string(third) + " have one " + (Dim == 2 ? "edge" : "face") +
                " in common; at most two may: give bodies that meet there points of their own" };
      }
      const int side = facet % NumSides;
      const int otherSide = otherFacet % NumSides;
      const int orientation = OrientationOf(mesh, *a, *b);
      if (orientation < 0)
      {
        return { ErrorCode::InvalidTopology,
          Names(own, other) + " have the corners of a common face in another order" };
      }
      // read from the other cell the orientation is the inverse one, which exchanges the turns
      const int inverse = orientation == 5 ? 6 : orientation == 6 ? 5 : orientation;
      const std::uint16_t crossing = NumberOf<Dim>(side, otherSide, orientation);
      this->Links[At(facet)] = { other, crossing };
      this->Links[At(otherFacet)] = { own, NumberOf<Dim>(otherSide, side, inverse) };
      this->IsCoherent = this->IsCoherent && this->Table[crossing].Coherent;
      ++this->NumInteriorFacets;
      a = b + 1;
    }
  }
  return {};
}

template <int Dim>
int RidgeCorner(int ridge)
{
  const auto [first, second] = MeshTopology<Dim>::SidesOf(ridge);
  return (first & 1) << (first / 2) | (second & 1) << (second / 2);
}

template <int Dim>
Status MeetsApart(int a, int b)
{
  return { ErrorCode::InvalidTopology,
    Names(a, b) + " meet at " + (Dim == 2 ? "a point" : "an edge") + " without common " +
      (Dim == 2 ? "edges" : "faces") + " between them; separate them there" };
}

template <int Dim>
Status MeshTopology<Dim>::CheckDoublets(const CellMesh<Dim>& mesh) const
{
  for (int c = 0; c < this->NumCells(); ++c)
  {
    for (int side = 0; side < NumSides; ++side)
    {
      const int other = this->Neighbour(c, side);
      for (int next = side / 2 * 2 + 2; other >= 0 && next < NumSides; ++next)
      {
        if (this->Neighbour(c, next) == other)
        {
          return HaveSameCorners(mesh, c, other)
            ? Duplicate(c, other)
            : Status{ ErrorCode::InvalidTopology,
                Names(c, other) + " have two neighbouring " + (Dim == 2 ? "edges" : "faces") +
                  " in common (a doublet); merge them" };
        }
      }
    }
  }
  return {};
}

/// Without doublets a point inside of a mesh of quadrilaterals with four cells is regular, and one
/// with two edges on the boundary and at most two cells: only others are walked around.
template <>
Status MeshTopology<2>::FindRidges(const CellMesh<2>& mesh)
{
  constexpr std::uint32_t boundaryEdge = 1U << 24;
  std::vector<std::uint32_t> counts(At(mesh.NumPoints), 0); // cells, edges on the boundary
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    for (int corner = 0; corner < NumCorners; ++corner)
    {
      counts[At(mesh.Cell(c)[corner])] += 1 + (this->IsBoundary(c, corner & 1) ? boundaryEdge : 0) +
        (this->IsBoundary(c, 2 + (corner >> 1)) ? boundaryEdge : 0);
    }
  }
  this->RidgeBits.assign(At(mesh.NumCells()), 0);
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    for (int corner = 0; corner < NumCorners; ++corner) // the ridges of a cell are its corners
    {
      const std::uint32_t count = counts[At(mesh.Cell(c)[corner])];
      if (count == 4)
      {
        this->RidgeBits[At(c)] |= 1U << (16 + corner);
      }
      else if (count != 2 * boundaryEdge + 1 && count != 2 * boundaryEdge + 2 &&
        !this->Has(c, corner))
      {
        std::uint32_t cells = 0;
        this->Around(c, corner,
          [&](int cell, int in, int out)
          {
            ++cells;
            this->RidgeBits[At(cell)] |= 1U << RidgeOf(in, out);
          });
        ++this->NumExtraordinaryRidges;
        if (cells != count % boundaryEdge)
        {
          return this->FindApart(mesh, c, corner);
        }
      }
    }
  }
  return {};
}

/// Names a cell that has a point of another one and is not among those around it.
template <int Dim>
Status MeshTopology<Dim>::FindApart(const CellMesh<Dim>& mesh, int cell, int ridge) const
{
  const int point = mesh.Cell(cell)[RidgeCorner<Dim>(ridge)];
  std::vector<char> around(At(mesh.NumCells()), 0);
  this->Around(cell, ridge, [&](int c, int, int) { around[At(c)] = 1; });
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    const int* corners = mesh.Cell(c);
    if (around[At(c)] == 0 &&
      std::find(corners, corners + NumCorners, point) != corners + NumCorners)
    {
      return MeetsApart<Dim>(cell, c);
    }
  }
  return {};
}

template <>
Status MeshTopology<3>::FindRidges(const CellMesh<3>& mesh)
{
  this->RidgeBits.assign(At(mesh.NumCells()), 0);
  std::vector<std::pair<std::int64_t, int>> rings; // of cells, by the points of their edge
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    for (int ridge = 0; ridge < NumRidges; ++ridge)
    {
      if (this->Has(c, ridge) || this->Has(c, 16 + ridge))
      {
        continue;
      }
      int count = 0;
      int lowest = c;
      const bool inside = this->Around(c, ridge,
        [&](int cell, int, int)
        {
          ++count;
          lowest = std::min(lowest, cell);
        });
      if (lowest == c)
      {
        const auto [first, second] = SidesOf(ridge);
        const int corner = RidgeCorner<3>(ridge);
        const int a = mesh.Cell(c)[corner];
        const int b = mesh.Cell(c)[corner | 1 << (3 - first / 2 - second / 2)];
        rings.emplace_back(std::int64_t{ std::min(a, b) } << 32 | std::max(a, b), c);
      }
      const bool isRegular = inside ? count == 4 : count <= 2;
      if (isRegular && !inside)
      {
        continue;
      }
      this->NumExtraordinaryRidges += isRegular ? 0 : 1;
      this->Around(c, ridge,
        [&](int cell, int in, int out)
        { this->RidgeBits[At(cell)] |= 1U << (RidgeOf(in, out) + (isRegular ? 16 : 0)); });
    }
  }
  std::sort(rings.begin(), rings.end());
  const auto same = std::adjacent_find(
    rings.begin(), rings.end(), [](const auto& a, const auto& b) { return a.first == b.first; });
  return same != rings.end() ? MeetsApart<3>(same->second, (same + 1)->second)
                             : this->CheckCorners(mesh);
}

/// The cells at a point hang together by faces.
template <int Dim>
Status MeshTopology<Dim>::CheckCorners(const CellMesh<Dim>& mesh) const
{
  DisjointSets corners(mesh.NumCells() * NumCorners);
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    for (int side = 0; side < NumSides; ++side)
    {
      const int other = this->Neighbour(c, side);
      for (int k = 0; other > c && k < FacetCorners<Dim>::Count; ++k)
      {
        const int corner = PatchCorner<Dim>(side, k);
        const int* points = mesh.Cell(other);
        const auto at = std::find(points, points + NumCorners, mesh.Cell(c)[corner]) - points;
        corners.Unite(c * NumCorners + corner, other * NumCorners + static_cast<int>(at));
      }
    }
  }
  std::vector<int> owner(At(mesh.NumPoints), -1);
  for (int i = 0; i < corners.Size(); ++i)
  {
    int& first = owner[At(mesh.Corners[At(i)])];
    first = first < 0 ? i : first;
    if (corners.Find(i) != corners.Find(first))
    {
      return { ErrorCode::InvalidTopology,
        Names(first / NumCorners, i / NumCorners) + " meet at point " +
          std::to_string(mesh.Corners[At(i)]) +
          " without common faces between them; separate them there" };
    }
  }
  return {};
}

template <int Dim>
Status MeshTopology<Dim>::CheckOrientation()
{
  if (this->IsCoherent)
  {
    return {};
  }
  std::vector<signed char> turned(At(this->NumCells()), -1);
  std::vector<int> stack;
  for (int root = 0; root < this->NumCells(); ++root)
  {
    if (turned[At(root)] >= 0)
    {
      continue;
    }
    turned[At(root)] = 0;
    stack.push_back(root);
    bool isOrientable = true;
    CellSide inverted;
    while (!stack.empty())
    {
      const int c = stack.back();
      stack.pop_back();
      for (int side = 0; side < NumSides; ++side)
      {
        if (this->IsBoundary(c, side))
        {
          continue;
        }
        const int other = this->Neighbour(c, side);
        const bool coherent = this->Crossing(c, side).Coherent;
        inverted = coherent || inverted.Cell >= 0 ? inverted : CellSide{ c, side };
        const auto expected =
          static_cast<signed char>(coherent ? turned[At(c)] : 1 - turned[At(c)]);
        if (turned[At(other)] < 0)
        {
          turned[At(other)] = expected;
          stack.push_back(other);
        }
        isOrientable = isOrientable && turned[At(other)] == expected;
      }
    }
    this->IsOrientable = this->IsOrientable && isOrientable;
    if (inverted.Cell >= 0 && (isOrientable || Dim == 3))
    {
      return { ErrorCode::InvalidTopology,
        Names(inverted.Cell, this->Neighbour(inverted.Cell, inverted.Side)) +
          (isOrientable ? " are inverted against each other; turn one of them round"
                        : " belong to a mesh of hexahedra that cannot be oriented") };
    }
  }
  return {};
}

template <int Dim>
Result<MeshTopology<Dim>> MeshTopology<Dim>::Make(const CellMesh<Dim>& mesh)
{
  MeshTopology made;
  Status status = made.CheckCells(mesh);
  status = status ? made.LinkFacets(mesh) : status;
  status = status ? made.CheckDoublets(mesh) : status;
  status = status ? made.FindRidges(mesh) : status;
  status = status ? made.CheckOrientation() : status;
  return status ? Result<MeshTopology>(std::move(made)) : Result<MeshTopology>(status);
}

template <int Dim>
typename MeshTopology<Dim>::EdgeSheets MeshTopology<Dim>::FindSheets() const
{
  DisjointSets sets(this->NumCells() * Dim);
  for (int c = 0; c < this->NumCells(); ++c)
  {
    for (int side = 0; side < NumSides; ++side)
    {
      const int other = this->Neighbour(c, side);
      for (int d = 0; other > c && d < Dim; ++d)
      {
        if (d != side / 2)
        {
          sets.Unite(c * Dim + d, other * Dim + this->Crossing(c, side).Image[At(2 * d)] / 2);
        }
      }
    }
  }
  EdgeSheets sheets;
  sheets.Of.resize(At(sets.Size()));
  for (int i = 0; i < sets.Size(); ++i)
  {
    const int first = sets.Find(i); // the smallest member
    sheets.Of[At(i)] = first == i ? sheets.Count++ : sheets.Of[At(first)];
  }
  return sheets;
}

template <int Dim>
std::vector<int> MeshTopology<Dim>::LocalOrder() const
{
  // most neighbours are further away than the cells that a cache holds
  constexpr int far = 1 << 13;
  constexpr int samples = 1 << 10;
  const int numCells = this->NumCells();
  int numFar = 0;
  for (int i = 0; i < samples && numCells > far; ++i)
  {
    const int c = static_cast<int>(std::int64_t{ numCells } * i / samples);
    for (int side = 0; side < NumSides; ++side)
    {
      numFar += std::abs(this->Neighbour(c, side) - c) > far ? 1 : 0;
    }
  }
  std::vector<int> order;
  if (2 * numFar < samples * NumSides)
  {
    return order;
  }
  order.reserve(At(numCells));
  std::vector<char> isSeen(At(numCells), 0);
  for (int root = 0; root < numCells; ++root)
  {
    if (isSeen[At(root)] != 0)
    {
      continue;
    }
    isSeen[At(root)] = 1;
    order.push_back(root);
    for (std::size_t i = order.size() - 1; i < order.size(); ++i)
    {
      for (int side = 0; side < NumSides; ++side)
      {
        const int other = this->Neighbour(order[i], side);
        if (other >= 0 && isSeen[At(other)] == 0)
        {
          isSeen[At(other)] = 1;
          order.push_back(other);
        }
      }
    }
  }
  return order;
}

template <int Dim>
MeshTopology<Dim> MeshTopology<Dim>::Reordered(const std::vector<int>& order) const
{
  std::vector<int> newNumber(order.size());
  for (std::size_t c = 0; c < order.size(); ++c)
  {
    newNumber[At(order[c])] = static_cast<int>(c);
  }
  MeshTopology made;
  made.NumInteriorFacets = this->NumInteriorFacets;
  made.NumBoundaryFacets = this->NumBoundaryFacets;
  made.NumExtraordinaryRidges = this->NumExtraordinaryRidges;
  made.IsOrientable = this->IsOrientable;
  made.IsCoherent = this->IsCoherent;
  made.Links.resize(this->Links.size());
  made.RidgeBits.resize(this->RidgeBits.size());
  for (std::size_t c = 0; c < order.size(); ++c)
  {
    made.RidgeBits[c] = this->RidgeBits[At(order[c])];
    for (std::size_t side = 0; side < NumSides; ++side)
    {
      Link link = this->Links[At(order[c]) * NumSides + side];
      link.Cell = link.Cell < 0 ? -1 : newNumber[At(link.Cell)];
      made.Links[c * NumSides + side] = link;
    }
  }
  return made;
}

template class MeshTopology<2>;
template class MeshTopology<3>;
}
