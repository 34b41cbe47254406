// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryChains.h"

#include <knotwork/MeshParameterization/PlaneLoops.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>

namespace knotwork
{
namespace
{
/// A boundary edge of a chart with its triangle to the left.
struct HalfEdge
{
  int Chart = 0;
  int From = 0; ///< points of the chart
  int To = 0;
  int Next = -1; ///< along the chart's loop
  int Twin = -1; ///< the same edge of the surface, from the other side
  int Chain = -1;
  int Use = 0;
};

/// An undirected edge and what it belongs to.
struct EdgeKey
{
  std::array<int, 2> Points{};
  int From = 0;
  int Half = -1;
  bool operator<(const EdgeKey& other) const
  {
    return std::tie(this->Points, this->Half, this->From) <
      std::tie(other.Points, other.Half, other.From);
  }
};

EdgeKey MakeKey(int from, int to, int half)
{
  return { { std::min(from, to), std::max(from, to) }, from, half };
}

std::string Describe(std::size_t chart, int a, int b)
{
  return "edge of points " + std::to_string(a) + " and " + std::to_string(b) + " of chart " +
    std::to_string(chart);
}

class ChainFinder
{
public:
  ChainFinder(const std::vector<ChartMesh>& charts, double cornerAngle)
    : Charts(charts), CornerCosine(std::cos(cornerAngle * std::acos(-1.0) / 180.0))
  {
  }

  Status Run(const std::vector<LoopVertex>& vertices)
  {
    if (Status status = this->NumberPoints(vertices); !status)
    {
      return status;
    }
    this->Loops.resize(this->Charts.size());
    for (std::size_t c = 0; c < this->Charts.size(); ++c)
    {
      if (Status status = this->FindLoops(c); !status)
      {
        return status;
      }
    }
    if (Status status = this->FindTwins(); !status)
    {
      return status;
    }
    this->FindEnds();
    this->CountBoundaryLoops();
    this->MakeChains();
    return {};
  }

  BoundaryChains Out;

private:
  HalfEdge& Half(int h) { return this->Halves[static_cast<std::size_t>(h)]; }
  const HalfEdge& Half(int h) const { return this->Halves[static_cast<std::size_t>(h)]; }
  /// Number of a chart's point in the whole surface.
  int PointOf(int chart, int point) const
  {
    return this->Numbers[static_cast<std::size_t>(chart)][static_cast<std::size_t>(point)];
  }

  Status NumberPoints(const std::vector<LoopVertex>& vertices)
  {
    struct First
    {
      int Number;
      std::size_t Chart;
      Eigen::Index Row;
    };
    std::unordered_map<std::int64_t, First> known;
    for (std::size_t c = 0; c < this->Charts.size(); ++c)
    {
      const ChartMesh& chart = this->Charts[c];
      auto& numbers = this->Numbers.emplace_back();
      for (Eigen::Index i = 0; i < chart.Points.rows(); ++i)
      {
        if (chart.PointIds.empty())
        {
          numbers.push_back(this->NumPoints++);
          continue;
        }
        const std::int64_t id = chart.PointIds[static_cast<std::size_t>(i)];
        const auto [entry, isNew] = known.try_emplace(id, First{ this->NumPoints, c, i });
        this->NumPoints += isNew ? 1 : 0;
        const First& first = entry->second;
        if (chart.Points.row(i) != this->Charts[first.Chart].Points.row(first.Row))
        {
          return { ErrorCode::InvalidTopology,
            "point id " + std::to_string(id) + " has different coordinates in charts " +
              std::to_string(first.Chart) + " and " + std::to_string(c) };
        }
        numbers.push_back(first.Number);
      }
    }
    this->IsVertex.assign(static_cast<std::size_t>(this->NumPoints), false);
    for (const LoopVertex& vertex : vertices)
    {
      if (const auto entry = known.find(vertex.PointId); entry != known.end())
      {
        this->IsVertex[static_cast<std::size_t>(entry->second.Number)] = true;
      }
    }
    return {};
  }

  Status FindLoops(std::size_t c)
  {
    const ChartMesh& chart = this->Charts[c];
    std::vector<EdgeKey> edges;
    edges.reserve(3 * chart.Triangles.size());
    for (const auto& corners : chart.Triangles)
    {
      for (std::size_t k = 0; k < 3; ++k)
      {
        edges.push_back(MakeKey(corners[k], corners[(k + 1) % 3], -1));
      }
    }
    std::sort(edges.begin(), edges.end());
    std::vector<int> next(static_cast<std::size_t>(chart.Points.rows()), -1);
    for (std::size_t i = 0; i < edges.size();)
    {
      std::size_t end = i + 1;
      while (end < edges.size() && edges[end].Points == edges[i].Points)
      {
        ++end;
      }
      const auto [a, b] = edges[i].Points;
      if (end - i > 2 || (end - i == 2 && edges[i].From == edges[i + 1].From))
      {
        return { ErrorCode::InvalidTopology,
          end - i > 2 ? Describe(c, a, b) + " belongs to more than two triangles"
                      : "two triangles lie on one side of the " + Describe(c, a, b) };
      }
      if (end - i == 2)
      {
        this->Inner.push_back(MakeKey(this->Numbers[c][static_cast<std::size_t>(a)],
          this->Numbers[c][static_cast<std::size_t>(b)], static_cast<int>(c)));
      }
      else
      {
        int& to = next[static_cast<std::size_t>(edges[i].From)];
        if (to >= 0)
        {
          return { ErrorCode::InvalidTopology,
            "triangles touch only in point " + std::to_string(edges[i].From) + " of chart " +
              std::to_string(c) };
        }
        to = edges[i].From == a ? b : a;
      }
      i = end;
    }
    return this->WalkLoops(c, next);
  }

  Status WalkLoops(std::size_t c, std::vector<int>& next)
  {
    struct Loop
    {
      double Area = 0.0;
      std::vector<int> Points;
    };
    const PointMatrix& uv = this->Charts[c].UV;
    std::vector<Loop> loops;
    for (std::size_t start = 0; start < next.size(); ++start)
    {
      Loop loop;
      for (int v = static_cast<int>(start); next[static_cast<std::size_t>(v)] >= 0;)
      {
        loop.Points.push_back(v);
        v = std::exchange(next[static_cast<std::size_t>(v)], -1);
      }
      const Eigen::RowVector2d origin = uv.row(static_cast<Eigen::Index>(start));
      for (std::size_t i = 0; i < loop.Points.size(); ++i)
      {
        const Eigen::RowVector2d p = uv.row(loop.Points[i]) - origin;
        const Eigen::RowVector2d q = uv.row(loop.Points[(i + 1) % loop.Points.size()]) - origin;
        loop.Area += 0.5 * (p[0] * q[1] - p[1] * q[0]);
      }
      if (!loop.Points.empty())
      {
        loops.push_back(std::move(loop));
      }
    }
    std::stable_sort(
      loops.begin(), loops.end(), [](const Loop& a, const Loop& b) { return a.Area > b.Area; });
    if (loops.empty() || !(loops[0].Area > 0.0) || (loops.size() > 1 && loops[1].Area > 0.0))
    {
      return {
        ErrorCode::InvalidTopology,
        "chart " + std::to_string(c) + " has " +
          (loops.empty() || !(loops[0].Area > 0.0) ? "no" : "more than one") +
          " boundary loop that runs counterclockwise in the plane; a chart is one disc with holes"
      };
    }
    std::vector<std::vector<int>> points;
    for (const Loop& loop : loops)
    {
      points.push_back(loop.Points);
    }
    if (const EdgeCrossing overlap = FindOverlap(points, uv))
    {
      return { ErrorCode::InvalidTopology,
        "chart " + std::to_string(c) + " lies over itself in the plane: boundary edges " +
          std::to_string(overlap.First[0]) + "-" + std::to_string(overlap.First[1]) + " and " +
          std::to_string(overlap.Second[0]) + "-" + std::to_string(overlap.Second[1]) +
          " meet; flatten the mesh with a largest stretch, which cuts it into charts that do not" };
    }
    // holes in the order of their first points
    std::sort(loops.begin() + 1, loops.end(),
      [](const Loop& a, const Loop& b) { return a.Points[0] < b.Points[0]; });
    for (const Loop& loop : loops)
    {
      const int first = static_cast<int>(this->Halves.size());
      const int n = static_cast<int>(loop.Points.size());
      for (int i = 0; i < n; ++i)
      {
        HalfEdge half;
        half.Chart = static_cast<int>(c);
        half.From = loop.Points[static_cast<std::size_t>(i)];
        half.To = loop.Points[static_cast<std::size_t>((i + 1) % n)];
        half.Next = first + (i + 1) % n;
        this->Halves.push_back(half);
      }
      this->Loops[c].push_back(first);
    }
    return {};
  }

  Status FindTwins()
  {
    std::vector<EdgeKey> edges;
    this->Outgoing.assign(static_cast<std::size_t>(this->NumPoints), 0);
    for (std::size_t h = 0; h < this->Halves.size(); ++h)
    {
      const HalfEdge& half = this->Halves[h];
      const int from = this->PointOf(half.Chart, half.From);
      edges.push_back(MakeKey(from, this->PointOf(half.Chart, half.To), static_cast<int>(h)));
      ++this->Outgoing[static_cast<std::size_t>(from)];
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i < edges.size();)
    {
      std::size_t end = i + 1;
      while (end < edges.size() && edges[end].Points == edges[i].Points)
      {
        ++end;
      }
      const HalfEdge& half = this->Half(edges[i].Half);
      const auto place = [&]
      { return Describe(static_cast<std::size_t>(half.Chart), half.From, half.To); };
      if (end - i > 2)
      {
        return { ErrorCode::InvalidTopology, "the " + place() + " belongs to three charts" };
      }
      if (end - i == 2)
      {
        if (edges[i].From == edges[i + 1].From)
        {
          return { ErrorCode::InvalidTopology,
            "the charts " + std::to_string(half.Chart) + " and " +
              std::to_string(this->Half(edges[i + 1].Half).Chart) + " lie on one side of the " +
              place() };
        }
        this->Half(edges[i].Half).Twin = edges[i + 1].Half;
        this->Half(edges[i + 1].Half).Twin = edges[i].Half;
      }
      i = end;
    }
    for (const EdgeKey& inner : this->Inner)
    {
      const auto at = std::lower_bound(edges.begin(), edges.end(), inner,
        [](const EdgeKey& a, const EdgeKey& b) { return a.Points < b.Points; });
      if (at != edges.end() && at->Points == inner.Points)
      {
        const HalfEdge& half = this->Half(at->Half);
        return { ErrorCode::InvalidTopology,
          "the " + Describe(static_cast<std::size_t>(half.Chart), half.From, half.To) +
            " lies inside chart " + std::to_string(inner.Half) };
      }
    }
    return {};
  }

  bool Turns(const Eigen::VectorXd& before, const Eigen::VectorXd& after) const
  {
    return before.dot(after) < this->CornerCosine * before.norm() * after.norm();
  }
  /// Whether a chart's boundary has a corner between two of its edges.
  bool IsCorner(const HalfEdge& before, const HalfEdge& after) const
  {
    const ChartMesh& chart = this->Charts[static_cast<std::size_t>(before.Chart)];
    const auto turns = [&](const PointMatrix& points)
    {
      return this->Turns((points.row(before.To) - points.row(before.From)).transpose(),
        (points.row(after.To) - points.row(after.From)).transpose());
    };
    return turns(chart.Points) || turns(chart.UV);
  }

  void FindEnds()
  {
    this->IsEnd.resize(this->Halves.size());
    for (std::size_t h = 0; h < this->Halves.size(); ++h)
    {
      const HalfEdge& before = this->Halves[h];
      const HalfEdge& after = this->Half(before.Next);
      const auto point = static_cast<std::size_t>(this->PointOf(before.Chart, before.To));
      const int touching = this->Outgoing[point];
      bool isEnd = (before.Twin < 0) != (after.Twin < 0) || this->IsVertex[point] ||
        this->IsCorner(before, after);
      if (before.Twin < 0 || after.Twin < 0)
      {
        isEnd = isEnd || touching != 1;
      }
      else
      {
        const HalfEdge& back = this->Half(after.Twin);
        isEnd = isEnd || touching != 2 || back.Next != before.Twin ||
          this->IsCorner(back, this->Half(before.Twin));
      }
      this->IsEnd[h] = isEnd;
    }
  }

  void CountBoundaryLoops()
  {
    std::vector<bool> done(this->Halves.size(), false);
    for (std::size_t start = 0; start < this->Halves.size(); ++start)
    {
      if (this->Halves[start].Twin >= 0 || done[start])
      {
        continue;
      }
      ++this->Out.NumBoundaryLoops;
      for (std::size_t h = start; !done[h];)
      {
        done[h] = true;
        // around the point to the next edge without a chart on the other side
        int next = this->Halves[h].Next;
        while (this->Half(next).Twin >= 0)
        {
          next = this->Half(this->Half(next).Twin).Next;
        }
        h = static_cast<std::size_t>(next);
      }
    }
  }

  int VertexOf(int chart, int point)
  {
    return this->Vertices.try_emplace(this->PointOf(chart, point), this->Vertices.size())
      .first->second;
  }

  void MakeChains()
  {
    this->Out.Loops.resize(this->Charts.size());
    for (std::size_t c = 0; c < this->Charts.size(); ++c)
    {
      for (const int first : this->Loops[c])
      {
        this->MakeLoop(first, this->Out.Loops[c].emplace_back());
      }
    }
    this->Out.NumVertices = static_cast<int>(this->Vertices.size());
  }

  /// First edge of a chain of the loop.
  int FindStart(int first) const
  {
    int h = first;
    do
    {
      const int next = this->Half(h).Next;
      if (this->IsEnd[static_cast<std::size_t>(h)])
      {
        return next;
      }
      h = next;
    } while (h != first);
    // closed: where the other side began
    const int twin = this->Half(first).Twin;
    if (twin >= 0 && this->Half(twin).Chain >= 0)
    {
      const auto& chain = this->Out.Chains[static_cast<std::size_t>(this->Half(twin).Chain)];
      const int start = chain.Uses[0].Points[0];
      while (this->Half(this->Half(h).Twin).To != start)
      {
        h = this->Half(h).Next;
      }
    }
    return h;
  }

  void MakeLoop(int first, std::vector<ChainStep>& steps)
  {
    const int start = this->FindStart(first);
    int h = start;
    do
    {
      std::vector<int> run{ h };
      while (
        !this->IsEnd[static_cast<std::size_t>(run.back())] && this->Half(run.back()).Next != start)
      {
        run.push_back(this->Half(run.back()).Next);
      }
      this->AddChain(run, steps);
      h = this->Half(run.back()).Next;
    } while (h != start);
  }

  void AddChain(const std::vector<int>& run, std::vector<ChainStep>& steps)
  {
    const HalfEdge& begin = this->Half(run[0]);
    ChainUse use;
    use.Chart = begin.Chart;
    use.Points.push_back(begin.From);
    for (const int h : run)
    {
      use.Points.push_back(this->Half(h).To);
    }
    ChainStep step;
    if (begin.Twin >= 0 && this->Half(begin.Twin).Chain >= 0)
    {
      step = { this->Half(begin.Twin).Chain, 1 };
      use.Reversed = true;
      std::reverse(use.Points.begin(), use.Points.end());
    }
    else
    {
      step = { static_cast<int>(this->Out.Chains.size()), 0 };
      BoundaryChain chain;
      chain.Vertices[0] = this->VertexOf(use.Chart, use.Points.front());
      chain.Vertices[1] = this->VertexOf(use.Chart, use.Points.back());
      this->Out.Chains.push_back(std::move(chain));
    }
    this->Out.Chains[static_cast<std::size_t>(step.Chain)].Uses.push_back(std::move(use));
    for (const int h : run)
    {
      this->Half(h).Chain = step.Chain;
      this->Half(h).Use = step.Use;
    }
    steps.push_back(step);
  }

  const std::vector<ChartMesh>& Charts;
  double CornerCosine;
  int NumPoints = 0;
  std::vector<std::vector<int>> Numbers;
  std::vector<HalfEdge> Halves;
  std::vector<std::vector<int>> Loops; ///< first half edge
  std::vector<EdgeKey> Inner;
  std::vector<bool> IsVertex; ///< points of the surface that are to be one
  std::vector<int> Outgoing;  ///< half edges from a point of the surface
  std::vector<bool> IsEnd;    ///< a chain ends with this half edge
  std::unordered_map<int, int> Vertices;
};
}

Result<BoundaryChains> FindBoundaryChains(
  const std::vector<ChartMesh>& charts, double cornerAngle, const std::vector<LoopVertex>& vertices)
{
  ChainFinder finder(charts, cornerAngle);
  if (Status status = finder.Run(vertices); !status)
  {
    return status;
  }
  return std::move(finder.Out);
}
}
