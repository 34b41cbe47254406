// SPDX-License-Identifier: BSD-3-Clause
#include "TileStrips.h"

#include <knotwork/SplineCore/LRRefinement.h>
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

struct KnotCount
{
  double Value = 0.0;
  int Count = 0;
};

/// A side of a tile, seen from its basis.
class Side
{
public:
  Side(const SplineSpace<2>& space, int side)
    : Basis(space.LocallyRefined->Basis), Across(AcrossSide(side)), Along(AlongSide(side)),
      IsUpper(side % 2 == 1)
  {
    const std::vector<double>& knots = this->Basis.Knots[this->Along];
    this->Tolerance = SameKnot * (knots.back() - knots.front());
  }

  int Degree() const { return this->Basis.Degree[this->Along]; }

  /// Functions whose local knots across have multiplicity degree + 1 - row at the side.
  std::vector<int> Row(int row) const
  {
    const int p = this->Basis.Degree[this->Across];
    const int end = this->End();
    std::vector<int> functions;
    for (int f = 0; f < this->Basis.NumFunctions(); ++f)
    {
      const int* local = this->Basis.Local(f, static_cast<int>(this->Across));
      if (std::count(local, local + p + 2, end) == p + 1 - row)
      {
        functions.push_back(f);
      }
    }
    return functions;
  }

  /// The knot where a function ends that begins on the side.
  int FarKnot(int function) const
  {
    const int* local = this->Basis.Local(function, static_cast<int>(this->Across));
    return this->IsUpper ? local[0] : local[this->Basis.Degree[this->Across] + 1];
  }

  /// Which of two knots across is farther from the side.
  int Farther(int a, int b) const { return this->IsUpper ? std::min(a, b) : std::max(a, b); }
  int Nearer(int a, int b) const { return this->IsUpper ? std::max(a, b) : std::min(a, b); }

  /// Knots along the side of functions, each as often as one of them has it.
  std::vector<KnotCount> Knots(const std::vector<int>& functions) const
  {
    const std::vector<double>& values = this->Basis.Knots[this->Along];
    std::vector<int> counts(values.size(), 0);
    for (const int f : functions)
    {
      const int* local = this->Basis.Local(f, static_cast<int>(this->Along));
      for (int i = 0, run = 1; i < this->Degree() + 2; ++i, ++run)
      {
        run = i > 0 && local[i] != local[i - 1] ? 1 : run;
        counts[At(local[i])] = std::max(counts[At(local[i])], run);
      }
    }
    std::vector<KnotCount> knots;
    for (std::size_t k = 0; k < counts.size(); ++k)
    {
      if (counts[k] > 0)
      {
        knots.push_back({ values[k], counts[k] });
      }
    }
    return knots;
  }

  /// The line that all functions of the row have as their first inner knot, if not all have it.
  bool InnerLine(const std::vector<int>& row, LRSegment& segment) const
  {
    const auto end = static_cast<int>(this->Basis.Knots[this->Across].size()) - 1;
    int nearest = this->IsUpper ? 0 : end;
    bool same = true;
    for (const int f : row)
    {
      nearest = this->Nearer(nearest, this->FarKnot(f));
    }
    for (const int f : row)
    {
      same = same && this->FarKnot(f) == nearest;
    }
    segment.Direction = static_cast<int>(this->Across);
    segment.Value = this->Basis.Knots[this->Across][At(nearest)];
    segment.Start = this->Basis.Knots[this->Along].front();
    segment.End = this->Basis.Knots[this->Along].back();
    segment.Multiplicity = 1;
    const bool isWhole = nearest == (this->IsUpper ? 0 : end);
    if (isWhole && this->Basis.Degree[this->Across] == 2)
    {
      // both sides of the tile need rows of their own
      segment.Value =
        0.5 * (this->Basis.Knots[this->Across].front() + this->Basis.Knots[this->Across].back());
      return true;
    }
    return !same;
  }

  /// The line of a knot from the side across all functions that lack it; false when none does.
  bool KnotLine(const std::vector<int>& functions, const KnotCount& knot, LRSegment& segment) const
  {
    const std::vector<double>& values = this->Basis.Knots[this->Along];
    int reach = this->End();
    for (const int f : functions)
    {
      const int* local = this->Basis.Local(f, static_cast<int>(this->Along));
      const int last = this->Degree() + 1;
      if (knot.Value > values[At(local[0])] + this->Tolerance &&
        knot.Value < values[At(local[last])] - this->Tolerance)
      {
        const auto count = std::count_if(local, local + last + 1,
          [&](int k) { return std::fabs(values[At(k)] - knot.Value) <= this->Tolerance; });
        if (count < knot.Count)
        {
          reach = this->Farther(reach, this->FarKnot(f));
        }
      }
    }
    const std::vector<double>& across = this->Basis.Knots[this->Across];
    segment.Direction = static_cast<int>(this->Along);
    segment.Value = knot.Value;
    segment.Start = across[At(std::min(reach, this->End()))];
    segment.End = across[At(std::max(reach, this->End()))];
    segment.Multiplicity = knot.Count;
    return reach != this->End();
  }

  /// Bases of the rows. @pre no line is missing.
  SideRows Rows(int count) const
  {
    SideRows rows;
    for (int r = 0; r < count; ++r)
    {
      std::vector<int>& functions = rows.Functions[At(r)];
      functions = this->Row(r);
      std::sort(functions.begin(), functions.end(),
        [&](int a, int b)
        {
          const int* x = this->Basis.Local(a, static_cast<int>(this->Along));
          const int* y = this->Basis.Local(b, static_cast<int>(this->Along));
          return std::lexicographical_compare(x, x + this->Degree() + 2, y, y + this->Degree() + 2);
        });
    }
    for (const KnotCount& knot : this->Knots(rows.Functions[0]))
    {
      rows.Knots.insert(rows.Knots.end(), At(knot.Count), knot.Value);
    }
    const std::vector<double>& across = this->Basis.Knots[this->Across];
    rows.Span =
      std::fabs(across[At(this->End())] - across[At(this->FarKnot(rows.Functions[0].front()))]);
    return rows;
  }

private:
  int End() const
  {
    return this->IsUpper ? static_cast<int>(this->Basis.Knots[this->Across].size()) - 1 : 0;
  }

  const LRBasis& Basis;
  std::size_t Across;
  std::size_t Along;
  bool IsUpper;
  double Tolerance;
};

/// What the sides of a tile must have: knots along each of them.
using TileDemands = std::map<int, std::vector<KnotCount>>;

/// The knots that the sides of all edges ask of each other.
std::vector<TileDemands> Demands(const std::vector<Spline<2>>& tiles,
  const std::vector<TileEdge>& edges, const StitchParams& params)
{
  std::vector<TileDemands> demands(tiles.size());
  for (const TileEdge& edge : edges)
  {
    std::array<std::vector<KnotCount>, 2> inside;
    int count = 0; // of functions on the edge
    for (std::size_t i = 0; i < 2; ++i)
    {
      const SplineSpace<2>& space = *tiles[At(edge.Sides[i].Patch)].Space;
      const int sideId = edge.Sides[i].Side;
      const Side side(space, sideId);
      const double tolerance = SameKnot * (edge.High(i) - edge.Low(i));
      for (const KnotCount& knot : side.Knots(side.Row(0)))
      {
        if (knot.Value > edge.Low(i) + tolerance && knot.Value < edge.High(i) - tolerance)
        {
          inside[i].push_back(knot);
        }
      }
      std::vector<KnotCount>& own = demands[At(edge.Sides[i].Patch)][sideId];
      own.insert(own.end(), inside[i].begin(), inside[i].end());
      // where the edge ends within the side
      const ParametricBox<2> domain = space.Domain();
      const int least = std::max(side.Degree() - 1, 1);
      if (edge.Low(i) != domain.Lower[AlongSide(sideId)])
      {
        own.push_back({ edge.Low(i), least });
      }
      if (edge.High(i) != domain.Upper[AlongSide(sideId)])
      {
        own.push_back({ edge.High(i), least });
      }
      int total = side.Degree() + 1;
      for (const KnotCount& knot : inside[i])
      {
        total += knot.Count;
      }
      count = std::max(count, total);
    }
    for (std::size_t i = 0; i < 2; ++i)
    {
      std::vector<KnotCount>& other = demands[At(edge.Sides[1 - i].Patch)][edge.Sides[1 - i].Side];
      for (const KnotCount& knot : inside[i])
      {
        other.push_back({ edge.Map(i, knot.Value), knot.Count });
      }
      if (params.Continuity == 1 && count < 4) // two at each end
      {
        const double middle = 0.5 * (edge.Low(i) + edge.High(i));
        demands[At(edge.Sides[i].Patch)][edge.Sides[i].Side].push_back({ middle, 1 });
      }
    }
  }
  return demands;
}

/// Lines that a tile still lacks; first those along its sides, which make the others short.
std::vector<LRSegment> MissingLines(
  const SplineSpace<2>& space, const TileDemands& demands, int numRows)
{
  std::vector<LRSegment> segments;
  LRSegment segment;
  for (const auto& [sideId, knots] : demands)
  {
    const Side side(space, sideId);
    if (numRows == 2 && side.InnerLine(side.Row(0), segment))
    {
      segments.push_back(segment);
    }
  }
  if (!segments.empty())
  {
    return segments;
  }
  for (const auto& [sideId, wanted] : demands)
  {
    const Side side(space, sideId);
    std::vector<int> functions = side.Row(0);
    if (numRows == 2)
    {
      const std::vector<int> second = side.Row(1);
      functions.insert(functions.end(), second.begin(), second.end());
    }
    std::vector<KnotCount> knots = side.Knots(functions);
    knots.insert(knots.end(), wanted.begin(), wanted.end());
    for (const KnotCount& knot : knots)
    {
      if (side.KnotLine(functions, knot, segment))
      {
        segments.push_back(segment);
      }
    }
  }
  return segments;
}
}

Status CheckTileDegrees(const std::vector<Spline<2>>& tiles, const std::vector<TileEdge>& edges,
  const StitchParams& params)
{
  for (const TileEdge& edge : edges)
  {
    std::array<IntArray<2>, 2> degrees;
    for (std::size_t i = 0; i < 2; ++i)
    {
      degrees[i] = tiles[At(edge.Sides[i].Patch)].Space->LocallyRefined->Basis.Degree;
      if (params.Continuity == 1 && std::min(degrees[i][0], degrees[i][1]) < 2)
      {
        return { ErrorCode::InvalidDegree,
          "tile " + std::to_string(edge.Sides[i].Patch) +
            " is of degree 1, but C1 needs 2 in both directions; choose C0 or fit it anew" };
      }
    }
    const int a = degrees[0][AlongSide(edge.Sides[0].Side)];
    const int b = degrees[1][AlongSide(edge.Sides[1].Side)];
    if (a != b)
    {
      return { ErrorCode::InvalidDegree,
        "tiles " + std::to_string(edge.Sides[0].Patch) + " and " +
          std::to_string(edge.Sides[1].Patch) + " have degrees " + std::to_string(a) + " and " +
          std::to_string(b) + " along their common edge; fit them with the same degree" };
    }
  }
  return {};
}

Result<TileRows> PrepareStrips(
  std::vector<Spline<2>>& tiles, const std::vector<TileEdge>& edges, const StitchParams& params)
{
  const int numRows = params.Continuity + 1;
  std::vector<TileDemands> demands;
  bool changed = true;
  for (int round = 1; changed; ++round)
  {
    if (params.Progress && !params.Progress(0.9 - 0.8 / round))
    {
      return { ErrorCode::Aborted, "" };
    }
    demands = Demands(tiles, edges, params);
    std::vector<Status> statuses(tiles.size());
    std::vector<char> grown(tiles.size(), 0);
    ParallelFor(tiles.size(), 1, params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t t = begin; t < end; ++t)
        {
          const auto segments = MissingLines(*tiles[t].Space, demands[t], numRows);
          if (!segments.empty())
          {
            auto refined = InsertSegments(tiles[t], segments, 1);
            statuses[t] = refined.Status;
            if (refined && refined->Space->NumFunctions == tiles[t].Space->NumFunctions)
            {
              statuses[t] = {
                ErrorCode::InvalidKnots,
                "knots of its neighbours are closer to its own than can be told apart; fit it anew"
              };
            }
            tiles[t] = refined ? std::move(refined.Value) : tiles[t];
            grown[t] = 1;
          }
        }
      });
    for (std::size_t t = 0; t < tiles.size(); ++t)
    {
      if (!statuses[t])
      {
        return { statuses[t].Code, "tile " + std::to_string(t) + ": " + statuses[t].Detail };
      }
    }
    changed = std::find(grown.begin(), grown.end(), 1) != grown.end();
  }
  TileRows rows(tiles.size());
  for (std::size_t t = 0; t < tiles.size(); ++t)
  {
    for (const auto& demand : demands[t])
    {
      rows[t][At(demand.first)] = Side(*tiles[t].Space, demand.first).Rows(numRows);
    }
  }
  return rows;
}
}
