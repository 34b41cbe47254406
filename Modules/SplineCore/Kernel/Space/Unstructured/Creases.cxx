// SPDX-License-Identifier: BSD-3-Clause
#include "Creases.h"

#include <algorithm>
#include <map>
#include <set>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}
/// Full is taken where it creases at most this part of the inner facets.
constexpr double MostCreased = 0.4;
}

template <int Dim>
Status CheckFeatures(const MeshTopology<Dim>& topology, const std::vector<CellSide>& features)
{
  for (const CellSide& feature : features)
  {
    const bool isThere = feature.Cell >= 0 && feature.Cell < topology.NumCells() &&
      feature.Side >= 0 && feature.Side < 2 * Dim;
    if (!isThere || topology.IsBoundary(feature.Cell, feature.Side))
    {
      return { ErrorCode::InvalidParameter,
        "side " + std::to_string(feature.Side) + " of cell " + std::to_string(feature.Cell) +
          " is no inner facet" };
    }
  }
  return {};
}

/// Marks an inner facet from both cells. @return whether it was not.
template <int Dim>
bool Creases<Dim>::Mark(std::vector<char>& marks, int cell, int side) const
{
  char& mark = marks[this->Slot(cell, side)];
  if (mark != 0)
  {
    return false;
  }
  mark = 1;
  marks[this->Slot(
    this->Data.Topology.Neighbour(cell, side), this->Data.Topology.Crossing(cell, side).Side)] = 1;
  return true;
}

/// Visits the facets opposite of an inner one at its regular ridges.
template <int Dim>
template <class Visit>
void Creases<Dim>::ForOpposites(int cell, int side, Visit&& visit) const
{
  for (int across = 0; across < NumSides; ++across)
  {
    if (across / 2 != side / 2 &&
      this->Data.Topology.IsRegularInside(cell, Topology::RidgeOf(side, across)))
    {
      visit(this->Data.Topology.Opposite(cell, side, across));
    }
  }
}

/// Marks facets and all their opposites. @return those that were not marked.
template <int Dim>
std::vector<CellSide> Creases<Dim>::Saturate(
  std::vector<char>& marks, std::vector<CellSide> facets) const
{
  std::vector<CellSide> added;
  for (const CellSide& facet : facets)
  {
    if (this->Mark(marks, facet.Cell, facet.Side))
    {
      added.push_back(facet);
    }
  }
  for (std::size_t i = 0; i < added.size(); ++i)
  {
    this->ForOpposites(added[i].Cell, added[i].Side,
      [&](const CellSide& opposite)
      {
        if (this->Mark(marks, opposite.Cell, opposite.Side))
        {
          added.push_back(opposite);
        }
      });
  }
  return added;
}

template <int Dim>
void Creases<Dim>::FindSeeds(const std::vector<CellSide>& features)
{
  const Topology& topology = this->Data.Topology;
  this->IsSeed.assign(At(topology.NumCells()) * NumSides, 0);
  const auto add = [&](int cell, int side)
  {
    if (!topology.IsBoundary(cell, side) && this->Mark(this->IsSeed, cell, side))
    {
      this->Seeds.push_back({ cell, side });
    }
  };
  for (int c = 0; topology.NumExtraordinaryRidges > 0 && c < topology.NumCells(); ++c)
  {
    for (int ridge = 0; ridge < Topology::NumRidges; ++ridge)
    {
      if (topology.IsExtraordinary(c, ridge))
      {
        for (const int side : Topology::SidesOf(ridge))
        {
          add(c, side);
        }
      }
    }
  }
  for (const CellSide& feature : features)
  {
    add(feature.Cell, feature.Side);
  }
  this->InComplex.assign(this->IsSeed.size(), 0);
  this->Complex = this->Saturate(this->InComplex, this->Seeds);
}

/// Facets of the complex at points where extraordinary edges meet: not where one ends and has all
/// cells of the point, nor where two of n cells each are all of its 2 n.
template <>
void Creases<3>::AddVertexSeeds()
{
  const Topology& topology = this->Data.Topology;
  const CellMesh<3>& mesh = this->Data.Mesh;
  std::vector<int> cells(At(mesh.NumPoints), 0);
  for (const int point : mesh.Corners)
  {
    ++cells[At(point)];
  }
  std::map<int, std::map<int, int>> edges; // by point: cells of the edges to other points
  for (int c = 0; c < topology.NumCells(); ++c)
  {
    for (int ridge = 0; ridge < Topology::NumRidges; ++ridge)
    {
      if (topology.IsExtraordinary(c, ridge))
      {
        const auto [first, second] = Topology::SidesOf(ridge);
        const int corner = (first & 1) << (first / 2) | (second & 1) << (second / 2);
        const int a = mesh.Cell(c)[corner];
        const int b = mesh.Cell(c)[corner | 1 << (3 - first / 2 - second / 2)];
        ++edges[a][b];
        ++edges[b][a];
      }
    }
  }
  std::vector<char> isSeedPoint(At(mesh.NumPoints), 0);
  for (const auto& [point, ends] : edges)
  {
    const int n = ends.begin()->second;
    const bool isEnd = ends.size() == 1 && cells[At(point)] == n;
    const bool isOnLine =
      ends.size() == 2 && ends.rbegin()->second == n && cells[At(point)] == 2 * n;
    isSeedPoint[At(point)] = isEnd || isOnLine ? 0 : 1;
  }
  for (const CellSide& facet : std::vector<CellSide>(this->Complex))
  {
    for (int corner = 0; corner < Topology::NumCorners; ++corner)
    {
      if ((corner >> (facet.Side / 2) & 1) == facet.Side % 2 &&
        isSeedPoint[At(mesh.Cell(facet.Cell)[corner])] != 0 &&
        this->Mark(this->IsSeed, facet.Cell, facet.Side))
      {
        this->Seeds.push_back(facet);
      }
    }
  }
}
template <>
void Creases<2>::AddVertexSeeds()
{
}

/// Lowers a facet, and its opposites to one order more in every step away from it.
template <int Dim>
void Creases<Dim>::GradeFrom(const CellSide& facet, int continuity)
{
  if (this->Data.Lower(facet.Cell, facet.Side, continuity))
  {
    this->ForOpposites(facet.Cell, facet.Side,
      [&](const CellSide& opposite) { this->GradeFrom(opposite, continuity + 1); });
  }
}

/// Continuity by the distance to the seeds, in steps from a facet to its opposite; what was creased
/// fully stays.
template <int Dim>
void Creases<Dim>::Grade()
{
  for (const CellSide& seed : this->Seeds)
  {
    this->GradeFrom(seed, 0);
  }
  while (this->AgreeOnBoundary())
  {
  }
}

/// Whether of two cells beside each other each is less smooth than the other at one of the facets
/// within p steps along a direction, both ways: neither's B-splines are averages of the other's.
/// @param one, other  with the sides where the direction goes on.
template <int Dim>
bool Creases<Dim>::AreCrosswise(const CellSide& one, const CellSide& other) const
{
  bool isLess = false;
  bool isMore = false;
  for (const int turn : { 0, 1 })
  {
    std::array<CellSide, 2> at{ one, other };
    at[0].Side ^= turn;
    at[1].Side ^= turn;
    for (int step = 0; step < this->Data.Degree; ++step)
    {
      const int r[2] = { this->Data.ContinuityOf(at[0].Cell, at[0].Side),
        this->Data.ContinuityOf(at[1].Cell, at[1].Side) };
      isLess = isLess || r[0] < r[1];
      isMore = isMore || r[0] > r[1];
      if (r[0] < 0 || r[1] < 0 || (r[0] == 0 && r[1] == 0))
      {
        break;
      }
      for (CellSide& end : at)
      {
        const FacetCrossing<Dim>& crossing = this->Data.Topology.Crossing(end.Cell, end.Side);
        end = { this->Data.Topology.Neighbour(end.Cell, end.Side), crossing.Image[At(end.Side)] };
      }
    }
  }
  return isLess && isMore;
}

/// Where boundary facets meet at an edge with other cells between theirs, a curve along the edge is
/// as smooth as the smoothest of the cells lets it be. That it is a curve of the boundary's space,
/// which has the facets' cells alone, those between get no higher continuity at the edge's ends
/// than the smoother of the two; none is smoother than the other where they are crosswise.
/// @return whether something was lowered.
template <>
bool Creases<3>::AgreeOnBoundary()
{
  const Topology& topology = this->Data.Topology;
  bool lowered = false;
  std::vector<CellSide> ends; // across the edge, at one end of it, from boundary to boundary
  for (int c = 0; c < topology.NumCells(); ++c)
  {
    for (int code = 0; code < NumSides * 8; ++code)
    {
      int in = code / 8; // then the two other directions, either first, to either end
      if (!topology.IsBoundary(c, in))
      {
        code += 7;
        continue;
      }
      const int across = (in / 2 + 1 + (code & 1)) % 3;
      int out = 2 * across + (code >> 1 & 1);
      CellSide end{ c, 2 * (3 - in / 2 - across) + (code >> 2 & 1) };
      if (topology.IsBoundary(c, end.Side))
      {
        continue;
      }
      ends.assign(1, end);
      while (!topology.IsBoundary(end.Cell, out))
      {
        const FacetCrossing<3>& crossing = topology.Crossing(end.Cell, out);
        end = { topology.Neighbour(end.Cell, out), crossing.Image[At(end.Side)] };
        out = crossing.Image[At(in)];
        in = crossing.Side;
        ends.push_back(end);
      }
      if (ends.size() < 3 ||
        std::any_of(ends.begin(), ends.end(),
          [&](const CellSide& at) { return topology.IsBoundary(at.Cell, at.Side); }))
      {
        continue;
      }
      const auto continuity = [this](const CellSide& at)
      { return int{ this->Data.ContinuityOf(at.Cell, at.Side) }; };
      const std::pair<int, int> of =
        std::minmax({ continuity(ends.front()), continuity(ends.back()) });
      const int limit = this->AreCrosswise(ends.front(), ends.back()) ? of.first : of.second;
      for (const CellSide& at : ends)
      {
        lowered = lowered || continuity(at) > limit;
        this->GradeFrom(at, limit);
      }
    }
  }
  return lowered;
}
template <>
bool Creases<2>::AgreeOnBoundary()
{
  return false;
}

/// Particles go out from the seeds' ends, straight on, one edge a step; each stops at a point where
/// a track has been. Of those that reach a point together the first goes on.
/// @source  Eppstein, Goodrich, Kim, Tamstorf, SGP 2008.
template <>
void Creases<2>::LayTracks()
{
  const Topology& topology = this->Data.Topology;
  const auto pointOf = [&](int cell, int side, int across)
  {
    const int corner = (side & 1) << (side / 2) | (across & 1) << (across / 2);
    return this->Data.Mesh.Cell(cell)[corner];
  };
  struct Particle
  {
    CellSide Edge;
    int Across; // side of the cell at the edge's end
  };
  std::vector<Particle> particles;
  for (const CellSide& seed : this->Seeds)
  {
    this->Data.Lower(seed.Cell, seed.Side, 0);
    particles.push_back({ seed, seed.Side < 2 ? 2 : 0 });
    particles.push_back({ seed, seed.Side < 2 ? 3 : 1 });
  }
  std::vector<char> visited(At(this->Data.Mesh.NumPoints), 0);
  std::vector<char> onTrack = this->IsSeed;
  while (!particles.empty())
  {
    std::vector<Particle> arrived;
    for (const Particle& particle : particles)
    {
      const auto [cell, side] = particle.Edge;
      char& point = visited[At(pointOf(cell, side, particle.Across))];
      if (point == 0 && topology.IsRegularInside(cell, Topology::RidgeOf(side, particle.Across)))
      {
        arrived.push_back(particle);
      }
      point = 1;
    }
    particles.clear();
    for (const Particle& particle : arrived)
    {
      const CellSide next =
        topology.Opposite(particle.Edge.Cell, particle.Edge.Side, particle.Across);
      // across the side the edge goes on away from it
      const int across = topology.Crossing(particle.Edge.Cell, particle.Across).Side;
      if (this->Mark(onTrack, next.Cell, next.Side))
      {
        this->Data.Lower(next.Cell, next.Side, 0);
        particles.push_back({ next, across ^ 1 });
      }
    }
  }
}
template <>
void Creases<3>::LayTracks()
{
}

template <int Dim>
Creases<Dim>::Creases(
  UnstructuredData<Dim>& data, const std::vector<CellSide>& features, CreasePolicy policy)
  : Data(data), Taken(policy)
{
  const Topology& topology = data.Topology;
  data.Continuity.resize(At(topology.NumCells()) * NumSides);
  for (int c = 0; c < topology.NumCells(); ++c)
  {
    for (int side = 0; side < NumSides; ++side)
    {
      data.ContinuityOf(c, side) =
        static_cast<signed char>(topology.IsBoundary(c, side) ? -1 : data.Degree - 1);
    }
  }
  this->FindSeeds(features);
  if (policy == CreasePolicy::Automatic)
  {
    const double part = MostCreased * static_cast<double>(topology.NumInteriorFacets);
    this->Taken = static_cast<double>(this->Complex.size()) <= part ? CreasePolicy::Full
      : Dim == 2                                                    ? CreasePolicy::Motorcycle
                                                                    : CreasePolicy::Minimal;
  }
  switch (this->Taken)
  {
    case CreasePolicy::Automatic:
    case CreasePolicy::Full:
      for (const CellSide& facet : this->Complex)
      {
        data.Lower(facet.Cell, facet.Side, 0);
      }
      break;
    case CreasePolicy::Motorcycle:
      this->LayTracks();
      break;
    case CreasePolicy::Minimal:
      this->AddVertexSeeds();
      this->Grade();
      break;
  }
}

template <int Dim>
std::int64_t Creases<Dim>::NumCreased() const
{
  std::int64_t sides = 0;
  for (const signed char r : this->Data.Continuity)
  {
    sides += r >= 0 && r < this->Data.Degree - 1 ? 1 : 0;
  }
  return sides / 2;
}

/// The accepted facets of the nearest cell that has any, by steps from cell to cell; the lowest
/// cell of equals.
template <int Dim>
template <class Accept>
std::vector<CellSide> Creases<Dim>::Nearest(int cell, Accept&& accept) const
{
  std::set<int> seen{ cell };
  std::vector<int> front{ cell };
  while (!front.empty())
  {
    std::sort(front.begin(), front.end());
    std::vector<int> next;
    for (const int c : front)
    {
      std::vector<CellSide> found;
      for (int side = 0; side < NumSides; ++side)
      {
        if (!this->Data.Topology.IsBoundary(c, side) && accept(c, side))
        {
          found.push_back({ c, side });
        }
      }
      if (!found.empty())
      {
        return found;
      }
      for (int side = 0; side < NumSides; ++side)
      {
        if (this->Data.Topology.IsBoundary(c, side))
        {
          continue;
        }
        const int other = this->Data.Topology.Neighbour(c, side);
        if (seen.insert(other).second)
        {
          next.push_back(other);
        }
      }
    }
    front = std::move(next);
  }
  return {};
}

/// The lowest facet of a strip that leads from a cell back to it within p cells and crosses no
/// C^0 facet.
template <int Dim>
CellSide Creases<Dim>::LowestOfStrip(int cell) const
{
  for (int side = 0; side < NumSides; ++side)
  {
    CellSide at{ cell, side };
    CellSide lowest;
    for (int step = 0; step<this->Data.Degree&& this->Data.ContinuityOf(at.Cell, at.Side)> 0;
         ++step)
    {
      const auto& crossing = this->Data.Topology.Crossing(at.Cell, at.Side);
      const CellSide other{ this->Data.Topology.Neighbour(at.Cell, at.Side), crossing.Side };
      for (const CellSide& facet : { at, other })
      {
        const bool isLower = lowest.Cell < 0 || facet.Cell < lowest.Cell ||
          (facet.Cell == lowest.Cell && facet.Side < lowest.Side);
        lowest = isLower ? facet : lowest;
      }
      at = { other.Cell, crossing.Image[At(at.Side)] };
      if (at.Cell == cell)
      {
        return lowest;
      }
    }
  }
  return {};
}

template <int Dim>
std::int64_t Creases<Dim>::CreaseFully(const std::vector<CellSide>& facets)
{
  std::int64_t lowered = 0;
  std::vector<char> marks(this->IsSeed.size(), 0);
  for (const CellSide& facet : this->Saturate(marks, facets))
  {
    lowered += this->Data.Lower(facet.Cell, facet.Side, 0) ? 1 : 0;
  }
  return lowered;
}

/// A cell with one function twice: the strip that closes on it is creased.
template <int Dim>
std::int64_t Creases<Dim>::CreaseStrip(int cell)
{
  CellSide facet = this->LowestOfStrip(cell);
  if (facet.Cell >= 0)
  {
    return this->CreaseFully({ facet });
  }
  auto smooth =
    this->Nearest(cell, [this](int c, int side) { return this->Data.ContinuityOf(c, side) > 0; });
  smooth.resize(std::min<std::size_t>(smooth.size(), 1));
  return this->CreaseFully(smooth);
}

/// Whether a facet at which another is opposite has a continuity that is accepted.
template <int Dim>
template <class Accept>
bool Creases<Dim>::HasOpposite(int cell, int side, Accept&& accept) const
{
  bool has = false;
  this->ForOpposites(cell, side,
    [&](const CellSide& opposite)
    { has = has || accept(this->Data.ContinuityOf(opposite.Cell, opposite.Side)); });
  return has;
}

/// Tracks that end at an edge's points go on until they meet others.
template <int Dim>
std::int64_t Creases<Dim>::Prolong(CellSide end)
{
  const Topology& topology = this->Data.Topology;
  std::int64_t lowered = 0;
  for (int first = 0; first < NumSides; ++first)
  {
    if (first / 2 == end.Side / 2)
    {
      continue;
    }
    CellSide at = end;
    int across = first;
    while (topology.IsRegularInside(at.Cell, Topology::RidgeOf(at.Side, across)))
    {
      const CellSide next = topology.Opposite(at.Cell, at.Side, across);
      const int ahead = topology.Crossing(at.Cell, across).Side ^ 1;
      if (!this->Data.Lower(next.Cell, next.Side, 0))
      {
        break;
      }
      ++lowered;
      at = next;
      across = ahead;
      const int beside = topology.Crossing(at.Cell, at.Side).Image[At(across)];
      const bool meets = this->Data.ContinuityOf(at.Cell, across) == 0 ||
        this->Data.ContinuityOf(topology.Neighbour(at.Cell, at.Side), beside) == 0;
      if (meets)
      {
        break;
      }
    }
  }
  return lowered;
}

template <int Dim>
bool Creases<Dim>::Repair(const std::vector<Inadmissible>& places)
{
  const Topology& topology = this->Data.Topology;
  std::int64_t lowered = 0;
  std::set<int> cells;
  for (const Inadmissible& place : places)
  {
    cells.insert(place.Cell);
    if (place.Side >= 0)
    {
      cells.insert(topology.Neighbour(place.Cell, place.Side));
    }
  }
  std::vector<CellSide> found;
  for (const int cell : cells)
  {
    std::vector<CellSide> nearest;
    if (this->Taken == CreasePolicy::Motorcycle) // an end of a track
    {
      nearest = this->Nearest(cell,
        [this](int c, int side)
        {
          return this->Data.ContinuityOf(c, side) == 0 &&
            this->HasOpposite(c, side, [](int r) { return r > 0; });
        });
      nearest.resize(std::min<std::size_t>(nearest.size(), 1));
    }
    else if (this->Taken == CreasePolicy::Minimal) // facets of the complex next to its C^0 ones
    {
      nearest = this->Nearest(cell,
        [this](int c, int side)
        {
          return this->InComplex[this->Slot(c, side)] != 0 &&
            this->Data.ContinuityOf(c, side) > 0 &&
            this->HasOpposite(c, side, [](int r) { return r == 0; });
        });
    }
    found.insert(found.end(), nearest.begin(), nearest.end());
  }
  for (const CellSide& facet : found)
  {
    if (this->Taken == CreasePolicy::Motorcycle)
    {
      lowered += this->Prolong(facet);
    }
    else if (this->Mark(this->IsSeed, facet.Cell, facet.Side))
    {
      this->Seeds.push_back(facet);
      ++lowered;
    }
  }
  if (this->Taken == CreasePolicy::Minimal && !found.empty())
  {
    this->Grade();
  }
  // a strip a round: what it creases may end the others
  for (auto cell = cells.begin(); found.empty() && lowered == 0 && cell != cells.end(); ++cell)
  {
    lowered += this->CreaseStrip(*cell);
  }
  return lowered > 0;
}

template Status CheckFeatures<2>(const MeshTopology<2>&, const std::vector<CellSide>&);
template Status CheckFeatures<3>(const MeshTopology<3>&, const std::vector<CellSide>&);
template class Creases<2>;
template class Creases<3>;
}
