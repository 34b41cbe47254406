// SPDX-License-Identifier: BSD-3-Clause
#include "FeatureGaps.h"

#include "NearestWay.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <map>

namespace knotwork
{
namespace
{
constexpr double LongerAlong = 3.0; // than a gap: what it closes of its own chain
constexpr double Onward = 0.5;      // cosine of the angle between a chain and a way on at most

using Side = std::pair<std::size_t, std::size_t>; // triangle and side

/// Inner edges at points, marked or not, and the points of rims.
class Surroundings
{
public:
  Surroundings(const SurfaceParts& parts, const EdgeMarks& marks)
    : Parts(parts), Marks(marks), At(static_cast<std::size_t>(parts.Mesh.NumPoints()))
  {
    VisitInnerEdges(parts,
      [&](std::size_t t, std::size_t k)
      {
        for (const int end : EdgeOf(parts, t, k))
        {
          this->At[static_cast<std::size_t>(end)].emplace_back(t, k);
        }
      });
  }
  const std::vector<Side>& Of(int point) const { return this->At[static_cast<std::size_t>(point)]; }
  std::vector<Side> Marked(int point) const
  {
    std::vector<Side> marked;
    for (const Side& side : this->Of(point))
    {
      if (this->Marks(side.first, side.second))
      {
        marked.push_back(side);
      }
    }
    return marked;
  }
  bool IsRim(int point) const
  {
    return this->Parts.Mesh.OnBoundary[static_cast<std::size_t>(point)] != 0;
  }
  int Beyond(const Side& side, int point) const
  {
    const MeshEdge edge = EdgeOf(this->Parts, side.first, side.second);
    return edge[0] == point ? edge[1] : edge[0];
  }
  /// Whether a chain ends there, within a region.
  bool IsFree(int point) const { return !this->IsRim(point) && this->Marked(point).size() == 1; }

  struct Chain
  {
    std::vector<Side> Edges;
    std::map<int, double> Along; ///< length of the chain up to its points
    double Length = 0.0;
  };
  /// From a free end to where it meets another or ends.
  Chain Follow(int end) const
  {
    Chain chain;
    int point = end;
    chain.Along[point] = 0.0;
    for (Side side = this->Marked(point).front();;)
    {
      chain.Edges.push_back(side);
      chain.Length += this->Parts.SideLength(side.first, side.second);
      point = this->Beyond(side, point);
      const bool isNew = chain.Along.emplace(point, chain.Length).second;
      const std::vector<Side> marked = this->Marked(point);
      if (!isNew || this->IsRim(point) || marked.size() != 2)
      {
        return chain;
      }
      side = marked[0] == side ? marked[1] : marked[0];
    }
  }

private:
  const SurfaceParts& Parts;
  const EdgeMarks& Marks;
  std::vector<std::vector<Side>> At;
};

/// Edges of the way that closes the gap at a free end; empty: none.
std::vector<Side> FindWay(const SurfaceParts& parts, const EdgeAngle& angle,
  const GapParams& params, const EdgeMarks& marks, const Surroundings& around, int end)
{
  const Surroundings::Chain chain = around.Follow(end);
  const double limit = std::min(params.Length, chain.Length);
  const Eigen::Vector3d here = parts.Mesh.Point(end);
  const Eigen::Vector3d onward =
    (here - parts.Mesh.Point(around.Beyond(chain.Edges.front(), end))).normalized();
  const auto leadsOn = [&](int point)
  {
    const Eigen::Vector3d step = parts.Mesh.Point(point) - here;
    return step.dot(onward) >= Onward * step.norm();
  };
  const auto judge = [&](int point, double length)
  {
    if (point == end || (!around.IsRim(point) && around.Marked(point).empty()))
    {
      return WayPoint::LeadsOn;
    }
    const auto own = chain.Along.find(point);
    // not aside, and no loop of its own no wider than a gap
    return leadsOn(point) && (own == chain.Along.end() || own->second >= LongerAlong * length)
      ? WayPoint::IsEnd
      : WayPoint::LeadsNowhere;
  };
  const auto steps = [&](int point, double length, const auto& visit)
  {
    for (const Side& side : around.Of(point))
    {
      const int next = around.Beyond(side, point);
      const double step = parts.SideLength(side.first, side.second);
      if (!marks(side.first, side.second) && length + step <= limit &&
        angle(side.first, side.second) >= params.LeastAngle && (point != end || leadsOn(next)))
      {
        visit(next, step, side);
      }
    }
  };
  std::vector<Side> way;
  for (const WayStep<Side>& step : NearestWay<Side>(end, judge, steps))
  {
    way.push_back(step.By);
  }
  return way;
}
}

std::vector<int> ShortestWay(const DiscMesh& surface, int from, int to)
{
  struct NoEdge
  {
  };
  const auto judge = [&](int point, double)
  { return point == to ? WayPoint::IsEnd : WayPoint::LeadsOn; };
  const auto steps = [&](int point, double, const auto& visit)
  {
    const auto v = static_cast<std::size_t>(point);
    for (int j = surface.FanStart[v]; j < surface.FanStart[v + 1]; ++j)
    {
      visit(surface.Fan[static_cast<std::size_t>(j)], surface.Spokes[static_cast<std::size_t>(j)],
        NoEdge());
    }
  };
  const auto way = NearestWay<NoEdge>(from, judge, steps);
  std::vector<int> points;
  if (from == to || !way.empty())
  {
    points.push_back(from);
  }
  for (auto step = way.rbegin(); step != way.rend(); ++step)
  {
    points.push_back(step->Point);
  }
  return points;
}

int CloseGaps(
  const SurfaceParts& parts, const EdgeAngle& angle, const GapParams& params, EdgeMarks& marks)
{
  if (!(params.Length > 0.0))
  {
    return 0;
  }
  const Surroundings around(parts, marks);
  int closed = 0;
  for (int point = 0; point < parts.Mesh.NumPoints(); ++point)
  {
    if (!around.IsFree(point)) // one that was closed from its other end is none any more
    {
      continue;
    }
    const std::vector<Side> way = FindWay(parts, angle, params, marks, around, point);
    for (const Side& side : way)
    {
      marks.Set(side.first, side.second, true);
    }
    closed += way.empty() ? 0 : 1;
  }
  return closed;
}

void DropSpurs(const SurfaceParts& parts, const std::vector<double>& sizes, const EdgeMarks& kept,
  EdgeMarks& marks)
{
  const Surroundings around(parts, marks);
  for (int point = 0; point < parts.Mesh.NumPoints(); ++point)
  {
    if (!around.IsFree(point))
    {
      continue;
    }
    const Surroundings::Chain chain = around.Follow(point);
    double size = 0.0;
    bool isKept = false;
    for (const auto& [t, k] : chain.Edges)
    {
      const auto other = static_cast<std::size_t>(parts.Adjacency.Triangle[t][k]);
      size = std::max({ size, sizes[t], sizes[other] });
      isKept = isKept || kept(t, k);
    }
    if (!isKept && chain.Length < size)
    {
      for (const auto& [t, k] : chain.Edges)
      {
        marks.Set(t, k, false);
      }
    }
  }
}
}
