// SPDX-License-Identifier: BSD-3-Clause
#include "GluedBoundary.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
class BoundaryAssembly
{
public:
  explicit BoundaryAssembly(GluingState& state) : State(state) {}

  void AssembleBoundary()
  {
    // collapsed edges make their ends one point: before points are numbered
    for (const SideOfCell side : this->State.Open)
    {
      BoundarySide b;
      const CellShape shape = this->State.Shape(side.Cell);
      b.Cell = side.Cell;
      b.Number = side.Number;
      b.Frame = GetSideFrame(shape, side.Number);
      b.Degree = SideDegree(shape, this->State.Degree(side.Cell), b.Frame);
      b.Patch = this->State.Patch(side.Cell);
      b.Error = this->State.Cells.Errors.empty()
        ? 0.0
        : this->State.Cells.Errors[static_cast<std::size_t>(b.Cell)];
      const auto coefficients = SideCoefficients(shape, this->State.Degree(side.Cell), b.Frame);
      const int n = NumCellCoefficients(shape, this->State.Degree(side.Cell));
      for (int plane = 0; plane < this->State.Cells.NumPlanes(); ++plane)
      {
        for (const int i : coefficients)
        {
          b.Data.push_back(this->State.Cells.Block(side.Cell)[plane * n + i]);
        }
      }
      const double tolerance =
        this->State.Params.CollapseTolerance * this->State.LargestCoordinate(side.Cell);
      for (int e = 0; e < NumSideEdges(b.Frame.Shape); ++e)
      {
        const auto points = this->EdgePoints(b, e, coefficients);
        if (this->State.IsPoint(side.Cell, points, tolerance))
        {
          const auto ends = SideEdge(b.Frame.Shape, e);
          b.CollapsedEdges[static_cast<std::size_t>(e)] = true;
          this->State.JoinCorners(side.Cell, b.Frame.Corners[static_cast<std::size_t>(ends[0])],
            side.Cell, b.Frame.Corners[static_cast<std::size_t>(ends[1])]);
        }
      }
      this->State.Out.Boundary.push_back(std::move(b));
    }
    this->NumberPointsAndEdges();
    this->FindComponents();
  }

private:
  std::vector<int> EdgePoints(
    const BoundarySide& side, int edge, const std::vector<int>& coefficients)
  {
    const CellLattice& lattice = this->State.Lattice(side.Frame.Shape, side.Degree);
    const auto ends = SideEdge(side.Frame.Shape, edge);
    for (const auto& direction : lattice.Directions)
    {
      for (std::size_t k = 0; k < direction.CornerPairs.size(); ++k)
      {
        const auto& pair = direction.CornerPairs[k];
        const bool forward = pair[0] == ends[0] && pair[1] == ends[1];
        if (!forward && !(pair[1] == ends[0] && pair[0] == ends[1]))
        {
          continue;
        }
        const int from = lattice.Corners[static_cast<std::size_t>(pair[0])];
        for (const auto& line : direction.Lines)
        {
          if (line.front() == from)
          {
            std::vector<int> points;
            for (const int i : line)
            {
              points.push_back(coefficients[static_cast<std::size_t>(i)]);
            }
            if (!forward)
            {
              std::reverse(points.begin(), points.end());
            }
            return points;
          }
        }
      }
    }
    return {};
  }

  void NumberPointsAndEdges()
  {
    DisjointSets places = this->State.Corners;
    DisjointSets edgePlaces = this->State.Edges;
    Merger<std::array<double, 3>> positions(places);
    Merger<std::vector<double>> polygons(edgePlaces);
    for (BoundarySide& b : this->State.Out.Boundary)
    {
      const CellShape shape = this->State.Shape(b.Cell);
      const auto coefficients = SideCoefficients(shape, this->State.Degree(b.Cell), b.Frame);
      const CellLattice& lattice = this->State.Lattice(b.Frame.Shape, b.Degree);
      for (std::size_t k = 0; k < static_cast<std::size_t>(b.Frame.NumCorners); ++k)
      {
        positions.Add(
          this->State.Position(b.Cell, coefficients[static_cast<std::size_t>(lattice.Corners[k])]),
          this->State.CornerId(b.Cell, b.Frame.Corners[k]));
      }
      for (int e = 0; e < NumSideEdges(b.Frame.Shape); ++e)
      {
        std::vector<double> there;
        const auto points = this->EdgePoints(b, e, coefficients);
        const auto ends = SideEdge(b.Frame.Shape, e);
        const int id =
          this->State.EdgeId(b.Cell, b.Frame.Corners[static_cast<std::size_t>(ends[0])],
            b.Frame.Corners[static_cast<std::size_t>(ends[1])]);
        if (b.CollapsedEdges[static_cast<std::size_t>(e)])
        {
          continue;
        }
        for (const int i : points)
        {
          const auto x = this->State.Position(b.Cell, i);
          there.insert(there.end(), x.begin(), x.end());
        }
        std::vector<double> back;
        for (auto i = points.rbegin(); i != points.rend(); ++i)
        {
          const auto x = this->State.Position(b.Cell, *i);
          back.insert(back.end(), x.begin(), x.end());
        }
        polygons.Add(std::min(there, back), id);
      }
    }
    std::map<std::array<double, 5>, int> lines;
    for (BoundarySide& b : this->State.Out.Boundary)
    {
      for (std::size_t k = 0; k < static_cast<std::size_t>(b.Frame.NumCorners); ++k)
      {
        const int id = this->State.CornerId(b.Cell, b.Frame.Corners[k]);
        b.Vertices[k] = this->State.Corners.Find(id);
        b.Places[k] = places.Find(id);
      }
      for (int e = 0; e < NumSideEdges(b.Frame.Shape); ++e)
      {
        const std::size_t at = static_cast<std::size_t>(e);
        const auto ends = SideEdge(b.Frame.Shape, e);
        const int c0 = b.Frame.Corners[static_cast<std::size_t>(ends[0])];
        const int c1 = b.Frame.Corners[static_cast<std::size_t>(ends[1])];
        b.Edges[at] = edgePlaces.Find(this->State.EdgeId(b.Cell, c0, c1));
        if (this->State.HasBox(b.Cell))
        {
          const auto u = this->State.BoxCorner(b.Cell, c0);
          const auto v = this->State.BoxCorner(b.Cell, c1);
          std::array<double, 5> key{ static_cast<double>(b.Patch), 0., 0., 0., 0. };
          for (std::size_t d = 0; d < 3; ++d)
          {
            if (u[d] != v[d])
            {
              key[1] = static_cast<double>(d);
              b.LineEnds[at] = { u[d], v[d] };
            }
            else
            {
              key[d + 2] = u[d];
            }
          }
          b.Lines[at] = lines.try_emplace(key, static_cast<int>(lines.size())).first->second;
        }
      }
    }
  }

  /// Sides and their corners by place.
  using CornersAt = std::map<int, std::vector<std::pair<int, int>>>;

  void FindComponents()
  {
    auto& boundary = this->State.Out.Boundary;
    DisjointSets components(static_cast<int>(boundary.size()));
    CornersAt atPlace;
    for (std::size_t i = 0; i < boundary.size(); ++i)
    {
      for (int k = 0; k < boundary[i].Frame.NumCorners; ++k)
      {
        atPlace[boundary[i].Places[static_cast<std::size_t>(k)]].push_back(
          { static_cast<int>(i), k });
      }
    }
    if (this->State.Dim == 2)
    {
      this->UniteCurves(atPlace, components);
    }
    else
    {
      this->UniteFaces(atPlace, components);
    }
    std::map<int, int> numbers;
    for (std::size_t i = 0; i < boundary.size(); ++i)
    {
      boundary[i].Component =
        numbers.try_emplace(components.Find(static_cast<int>(i)), static_cast<int>(numbers.size()))
          .first->second;
    }
    this->State.Out.NumComponents = static_cast<int>(numbers.size());
  }

  /// Keeps the first side with an edge or corner that no other has.
  void SetOpen(int side)
  {
    if (this->State.Out.Open[0] < 0)
    {
      const auto& b = this->State.Out.Boundary[static_cast<std::size_t>(side)];
      this->State.Out.Open = { b.Cell, b.Number };
    }
  }

  void UniteCurves(const CornersAt& atPlace, DisjointSets& components)
  {
    for (const auto& [place, sides] : atPlace)
    {
      for (const auto& s : sides)
      {
        components.Unite(sides[0].first, s.first);
      }
      if (sides.size() % 2 != 0)
      {
        this->SetOpen(sides[0].first);
      }
      this->State.Out.NumTouching += sides.size() > 2 ? 1 : 0;
    }
  }

  void UniteFaces(const CornersAt& atPlace, DisjointSets& components)
  {
    const auto& boundary = this->State.Out.Boundary;
    DisjointSets fans(static_cast<int>(boundary.size()) * 4);
    std::map<int, std::vector<int>> byEdge;
    std::map<int, std::vector<int>> byLine;
    for (std::size_t i = 0; i < boundary.size(); ++i)
    {
      const BoundarySide& b = boundary[i];
      for (int e = 0; e < NumSideEdges(b.Frame.Shape); ++e)
      {
        const std::size_t at = static_cast<std::size_t>(e);
        const auto ends = SideEdge(b.Frame.Shape, e);
        if (b.CollapsedEdges[at])
        {
          fans.Unite(static_cast<int>(i) * 4 + ends[0], static_cast<int>(i) * 4 + ends[1]);
          continue;
        }
        byEdge[b.Edges[at]].push_back(static_cast<int>(i));
        if (b.Lines[at] >= 0)
        {
          byLine[b.Lines[at]].push_back(static_cast<int>(i));
        }
      }
    }
    for (std::size_t i = 0; i < boundary.size(); ++i)
    {
      const BoundarySide& b = boundary[i];
      std::vector<int> near{ static_cast<int>(i) };
      for (int e = 0; e < NumSideEdges(b.Frame.Shape); ++e)
      {
        const std::size_t at = static_cast<std::size_t>(e);
        if (!b.CollapsedEdges[at])
        {
          const auto& same = byEdge[b.Edges[at]];
          near.insert(near.end(), same.begin(), same.end());
          if (b.Lines[at] >= 0)
          {
            const auto& line = byLine[b.Lines[at]];
            near.insert(near.end(), line.begin(), line.end());
          }
        }
      }
      std::sort(near.begin(), near.end());
      near.erase(std::unique(near.begin(), near.end()), near.end());
      std::array<double, 4> covered{};
      for (const int j : near)
      {
        for (const SideContact& contact : FindContacts(boundary, static_cast<int>(i), j))
        {
          if (!contact.IsEdge)
          {
            continue;
          }
          covered[static_cast<std::size_t>(contact.A)] += std::abs(contact.A1 - contact.A0);
          components.Unite(static_cast<int>(i), j);
          const BoundarySide& other = boundary[static_cast<std::size_t>(j)];
          for (const int ka : SideEdge(b.Frame.Shape, contact.A))
          {
            for (const int kb : SideEdge(other.Frame.Shape, contact.B))
            {
              if (b.Places[static_cast<std::size_t>(ka)] ==
                other.Places[static_cast<std::size_t>(kb)])
              {
                fans.Unite(static_cast<int>(i) * 4 + ka, j * 4 + kb);
              }
            }
          }
        }
      }
      for (int e = 0; e < NumSideEdges(b.Frame.Shape); ++e)
      {
        const std::size_t at = static_cast<std::size_t>(e);
        if (!b.CollapsedEdges[at] && covered[at] < 1.0 - 1e-9)
        {
          this->SetOpen(static_cast<int>(i));
        }
        this->State.Out.NumTouching += covered[at] > 1.0 + 1e-9 ? 1 : 0;
      }
    }
    for (const auto& [place, sides] : atPlace)
    {
      int fan = -1;
      bool several = false;
      for (const auto& [side, corner] : sides)
      {
        const int f = fans.Find(side * 4 + corner);
        several = several || (fan >= 0 && f != fan);
        fan = f;
      }
      this->State.Out.NumTouching += several ? 1 : 0;
    }
  }

  GluingState& State;
};
}

void AssembleBoundary(GluingState& state)
{
  BoundaryAssembly(state).AssembleBoundary();
}
}
