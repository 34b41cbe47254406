// SPDX-License-Identifier: BSD-3-Clause
#include "MfemLattice.h"

#include <algorithm>
#include <map>
#include <unordered_map>

namespace knotwork
{
namespace
{
using Corner = std::array<int, 3>;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

MfemReference MakeReference(MfemShape shape)
{
  const Corner o{ 0, 0, 0 }, x{ 1, 0, 0 }, y{ 0, 1, 0 }, z{ 0, 0, 1 };
  const Corner xy{ 1, 1, 0 }, xz{ 1, 0, 1 }, yz{ 0, 1, 1 }, xyz{ 1, 1, 1 };
  switch (shape)
  {
    case MfemShape::Point:
      return { 0, 1, false, { o }, {}, {} };
    case MfemShape::Segment:
      return { 1, 2, true, { o, x }, {}, {} };
    case MfemShape::Triangle:
      return { 2, 3, false, { o, x, y }, { { 0, 1 }, { 1, 2 }, { 2, 0 } }, {} };
    case MfemShape::Quadrilateral:
      return { 2, 4, true, { o, x, xy, y }, { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 } }, {} };
    case MfemShape::Tetrahedron:
      return { 3, 4, false, { o, x, y, z },
        { { 0, 1 }, { 0, 2 }, { 0, 3 }, { 1, 2 }, { 1, 3 }, { 2, 3 } },
        { { 1, 2, 3 }, { 0, 3, 2 }, { 0, 1, 3 }, { 0, 2, 1 } } };
    case MfemShape::Hexahedron:
      return { 3, 8, true, { o, x, xy, y, z, xz, xyz, yz },
        { { 0, 1 }, { 1, 2 }, { 3, 2 }, { 0, 3 }, { 4, 5 }, { 5, 6 }, { 7, 6 }, { 4, 7 }, { 0, 4 },
          { 1, 5 }, { 2, 6 }, { 3, 7 } },
        { { 3, 2, 1, 0 }, { 0, 1, 5, 4 }, { 1, 2, 6, 5 }, { 2, 3, 7, 6 }, { 3, 0, 4, 7 },
          { 4, 5, 6, 7 } } };
    case MfemShape::Wedge:
      return { 3, 6, false, { o, x, y, z, xz, yz },
        { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 3, 4 }, { 4, 5 }, { 5, 3 }, { 0, 3 }, { 1, 4 },
          { 2, 5 } },
        { { 0, 2, 1 }, { 3, 4, 5 }, { 0, 1, 4, 3 }, { 1, 2, 5, 4 }, { 2, 0, 3, 5 } } };
    case MfemShape::Pyramid:
      return { 3, 5, false, { o, x, xy, y, z },
        { { 0, 1 }, { 1, 2 }, { 3, 2 }, { 0, 3 }, { 0, 4 }, { 1, 4 }, { 2, 4 }, { 3, 4 } },
        { { 3, 2, 1, 0 }, { 0, 1, 4 }, { 1, 2, 4 }, { 2, 3, 4 }, { 3, 0, 4 } } };
  }
  return {};
}

/// Nodes inside a lattice of so many from end to end.
std::int64_t NumInside(const MfemPlace& place, bool isTriangle)
{
  const std::int64_t a = place.Count[0] - 2;
  return isTriangle ? a * (a - 1) / 2 : a * (place.Count[1] - 2);
}

/// Number of a node of a face for the first cell that has the face.
std::int64_t OnFace(
  const std::array<int, 4>& base, const std::array<int, 4>& own, const MfemPlace& place)
{
  const auto [i, j] = place.At;
  if (own[3] < 0)
  {
    // steps towards every corner are barycentric: they go with the corner
    const int p = place.Count[0] - 1;
    const std::array<int, 3> towards{ p - i - j, i, j };
    std::array<int, 3> sorted{};
    for (std::size_t k = 0; k < 3; ++k)
    {
      const auto corner = std::find(base.begin(), base.begin() + 3, own[k]);
      sorted[static_cast<std::size_t>(corner - base.begin()) % 3] = towards[k];
    }
    std::int64_t number = sorted[1] - 1;
    for (int row = 1; row < sorted[2]; ++row)
    {
      number += p - 1 - row;
    }
    return number;
  }
  std::size_t first = 0;
  while (first < 3 && own[first] != base[0])
  {
    ++first;
  }
  const bool isForward = own[(first + 1) % 4] == base[1];
  const int across = first == 0 || first == 3 ? i : place.Count[0] - 1 - i;
  const int up = first < 2 ? j : place.Count[1] - 1 - j;
  // the next corner lies across from an even one, up from an odd one
  const bool isAcross = (first % 2 == 0) == isForward;
  const std::int64_t stride = place.Count[isAcross ? 0 : 1] - 2;
  return (isAcross ? across : up) - 1 + stride * ((isAcross ? up : across) - 1);
}

std::array<int, 4> FaceCorners(const MfemCell& cell, int face)
{
  std::array<int, 4> corners{ -1, -1, -1, -1 };
  std::size_t k = 0;
  for (const int corner : ReferenceOf(cell.Shape).Faces[At(face)])
  {
    corners[k++] = cell.Corners[At(corner)];
  }
  return corners;
}

struct HashOfFace
{
  std::size_t operator()(const std::array<int, 3>& face) const
  {
    std::uint64_t hash = 0x9e3779b97f4a7c15ULL;
    for (const int vertex : face)
    {
      hash = (hash ^ static_cast<std::uint64_t>(vertex)) * 0xff51afd7ed558ccdULL;
      hash ^= hash >> 32;
    }
    return static_cast<std::size_t>(hash);
  }
};

/// How many become where they begin. @return where the next begin.
std::int64_t Accumulate(std::vector<std::int64_t>& counts, std::int64_t begin)
{
  for (std::int64_t& count : counts)
  {
    const std::int64_t here = begin;
    begin += std::max<std::int64_t>(count, 0);
    count = here;
  }
  return begin;
}
}

const MfemReference& ReferenceOf(MfemShape shape)
{
  static const std::vector<MfemReference> all = []
  {
    std::vector<MfemReference> made;
    for (int s = 0; s <= static_cast<int>(MfemShape::Pyramid); ++s)
    {
      made.push_back(MakeReference(static_cast<MfemShape>(s)));
    }
    return made;
  }();
  return all[static_cast<std::size_t>(shape)];
}

std::vector<MfemPlace> LatticeOf(MfemShape shape, const std::array<int, 3>& count)
{
  const MfemReference& reference = ReferenceOf(shape);
  const auto node = [&](int corner)
  {
    Corner at = reference.Corners[At(corner)];
    for (std::size_t d = 0; d < 3; ++d)
    {
      at[d] *= count[d] - 1;
    }
    return at;
  };
  /// one node along an edge, and how many from end to end
  const auto step = [&](int from, int to, int& nodes)
  {
    Corner one{};
    for (std::size_t d = 0; d < 3; ++d)
    {
      one[d] = reference.Corners[At(to)][d] - reference.Corners[At(from)][d];
      nodes = one[d] != 0 ? count[d] : nodes;
    }
    return one;
  };
  std::map<Corner, MfemPlace> places;
  for (int corner = 0; corner < reference.NumCorners; ++corner)
  {
    places[node(corner)] = { MfemPlace::Vertex, corner, {}, {} };
  }
  for (int e = 0; e < static_cast<int>(reference.Edges.size()); ++e)
  {
    const auto [from, to] = reference.Edges[At(e)];
    int nodes = 0;
    const Corner along = step(from, to, nodes);
    Corner at = node(from);
    for (int t = 1; t < nodes - 1; ++t)
    {
      for (std::size_t d = 0; d < 3; ++d)
      {
        at[d] += along[d];
      }
      places[at] = { MfemPlace::Edge, e, { t, 0 }, { nodes, 0 } };
    }
  }
  for (int f = 0; f < static_cast<int>(reference.Faces.size()); ++f)
  {
    const std::vector<int>& corners = reference.Faces[At(f)];
    int nodes = 0;
    int up = 0;
    const Corner u = step(corners[0], corners[1], nodes);
    const Corner v = step(corners[0], corners.back(), up);
    for (int j = 1; j < up - 1; ++j)
    {
      for (int i = 1; i < nodes - 1 - (corners.size() == 3 ? j : 0); ++i)
      {
        Corner at = node(corners[0]);
        for (std::size_t d = 0; d < 3; ++d)
        {
          at[d] += i * u[d] + j * v[d];
        }
        places[at] = { MfemPlace::Face, f, { i, j }, { nodes, up } };
      }
    }
  }
  std::vector<MfemPlace> lattice;
  int inside = 0;
  const int p = count[0] - 1;
  for (int k = 0; k < (reference.Dimension > 2 ? count[2] : 1); ++k)
  {
    for (int j = 0; j < (reference.Dimension > 1 ? count[1] : 1); ++j)
    {
      for (int i = 0; i < count[0]; ++i)
      {
        const int sum = i + j + (shape == MfemShape::Tetrahedron ? k : 0);
        if (!reference.IsTensor && sum > p)
        {
          continue;
        }
        const auto known = places.find({ i, j, k });
        lattice.push_back(known != places.end()
            ? known->second
            : MfemPlace{ MfemPlace::Interior, 0, { inside++, 0 }, {} });
      }
    }
  }
  return lattice;
}

MfemEntities::MfemEntities(
  const std::vector<MfemCell>& cells, const std::vector<std::array<int, 2>>& edges)
{
  std::unordered_map<std::uint64_t, int> knownEdges;
  const auto number = [&](int a, int b)
  {
    const auto key =
      static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint64_t>(std::max(a, b));
    return knownEdges.emplace(key, static_cast<int>(knownEdges.size())).first->second;
  };
  for (const auto& [a, b] : edges)
  {
    number(a, b);
  }
  std::unordered_map<std::array<int, 3>, int, HashOfFace> knownFaces;
  this->CellEdges.assign(12 * cells.size(), -1);
  this->CellFaces.assign(6 * cells.size(), -1);
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    const MfemCell& cell = cells[c];
    const MfemReference& reference = ReferenceOf(cell.Shape);
    for (std::size_t e = 0; e < reference.Edges.size(); ++e)
    {
      const auto [a, b] = reference.Edges[e];
      this->CellEdges[12 * c + e] = number(cell.Corners[At(a)], cell.Corners[At(b)]);
    }
    for (std::size_t f = 0; f < reference.Faces.size(); ++f)
    {
      const std::array<int, 4> corners = FaceCorners(cell, static_cast<int>(f));
      std::array<int, 4> sorted = corners;
      // three vertices say which face it is: of four, the highest is left out
      std::sort(sorted.begin(), sorted.begin() + (corners[3] < 0 ? 3 : 4));
      const auto [known, isNew] =
        knownFaces.emplace(std::array<int, 3>{ sorted[0], sorted[1], sorted[2] },
          static_cast<int>(this->Faces.size()));
      if (isNew)
      {
        this->Faces.push_back(corners);
      }
      this->CellFaces[6 * c + f] = known->second;
    }
  }
  this->NumEdges = static_cast<int>(knownEdges.size());
}

bool MfemNumbering::Add(const std::vector<MfemPlace>& places)
{
  this->EdgeNodes.resize(At(this->Entities.NumEdges), -1);
  this->FaceNodes.resize(this->Entities.Faces.size(), -1);
  bool fits = true;
  const auto put = [&fits](std::int64_t& count, std::int64_t found)
  {
    fits = fits && (count < 0 || count == found);
    count = found;
  };
  std::int64_t inside = 0;
  for (const MfemPlace& place : places)
  {
    if (place.Kind == MfemPlace::Edge)
    {
      put(this->EdgeNodes[At(this->Entities.Edge(this->Added, place.Which))], place.Count[0] - 2);
    }
    else if (place.Kind == MfemPlace::Face)
    {
      const int face = this->Entities.Face(this->Added, place.Which);
      const bool isTriangle =
        ReferenceOf(this->Cells[this->Added].Shape).Faces[At(place.Which)].size() == 3;
      fits = fits && isTriangle == (this->Entities.Faces[At(face)][3] < 0);
      put(this->FaceNodes[At(face)], NumInside(place, isTriangle));
    }
    inside += place.Kind == MfemPlace::Interior ? 1 : 0;
  }
  this->CellNodes.push_back(inside);
  ++this->Added;
  return fits;
}

std::int64_t MfemNumbering::Finish()
{
  return Accumulate(
    this->CellNodes, Accumulate(this->FaceNodes, Accumulate(this->EdgeNodes, this->NumVertices)));
}

std::int64_t MfemNumbering::Node(std::size_t c, const MfemPlace& place) const
{
  const MfemCell& cell = this->Cells[c];
  switch (place.Kind)
  {
    case MfemPlace::Vertex:
      return cell.Corners[At(place.Which)];
    case MfemPlace::Edge:
    {
      const auto [from, to] = ReferenceOf(cell.Shape).Edges[At(place.Which)];
      const bool isForward = cell.Corners[At(from)] < cell.Corners[At(to)];
      return this->EdgeNodes[At(this->Entities.Edge(c, place.Which))] +
        (isForward ? place.At[0] - 1 : place.Count[0] - 2 - place.At[0]);
    }
    case MfemPlace::Face:
    {
      const int face = this->Entities.Face(c, place.Which);
      return this->FaceNodes[At(face)] +
        OnFace(this->Entities.Faces[At(face)], FaceCorners(cell, place.Which), place);
    }
    case MfemPlace::Interior:
      break;
  }
  return this->CellNodes[c] + place.At[0];
}
}
