// SPDX-License-Identifier: BSD-3-Clause
#include "FreeFaces.h"
#include "BoundaryChains.h"
#include "RegionEdges.h"
#include "RegionLoops.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

std::int64_t IdOf(const std::vector<ChartMesh>& charts, const ChainUse& use, std::size_t point)
{
  return charts[At(use.Chart)].PointIds[At(use.Points[point])];
}

constexpr double LeastShare = 0.6; ///< of the tolerance, for surfaces

class FreeFitter
{
public:
  FreeFitter(ChartedRegions& charted, const std::vector<AnalyticSurface>& surfaces,
    RegionChains& chains, const TrimParams& params)
    : Charted(charted), Surfaces(surfaces), Chains(chains), Params(params),
      NextId(charted.Surface.NumPoints())
  {
  }

  Result<FreeFaces> Run()
  {
    if (Status status = this->InsertVertices(); !status)
    {
      return status;
    }
    this->InsertOnSurfaces();
    this->MovePoints();
    // what points were moved is taken off, as far as surfaces can be so near
    this->Params.Tolerance =
      std::max(this->Params.Tolerance - this->Made.MaxMove, LeastShare * this->Params.Tolerance);
    for (const RegionVertex& vertex : this->Chains.Vertices)
    {
      LoopVertex& given = this->Params.Vertices.emplace_back();
      given.PointId = vertex.PointId;
      const bool touches = std::any_of(vertex.Regions.begin(), vertex.Regions.end(),
        [&](int region) { return !this->IsFree(region); });
      if (touches)
      {
        given.Point = vertex.Point;
      }
    }
    auto topology =
      FindBoundaryChains(this->Charted.Charts, this->Params.CornerAngle, this->Params.Vertices);
    if (!topology)
    {
      return topology.Status;
    }
    if (Status status = this->MatchChains(topology.Value); !status)
    {
      return status;
    }
    auto trimmed = TrimSurface(this->Charted.Charts, this->Params);
    if (!trimmed)
    {
      return trimmed.Status;
    }
    this->Made.Trimmed = std::move(trimmed.Value);
    return std::move(this->Made);
  }

private:
  bool IsFree(int region) const { return region >= this->Charted.FirstChart; }

  /// Points of chains between points of the mesh, which are vertices all.
  Status InsertVertices()
  {
    struct Place
    {
      int Vertex;
      std::vector<int> Neighbours; ///< along the chart's rim
    };
    std::map<std::pair<int, int>, Place> places; // by vertex and chart
    for (RegionChain& chain : this->Chains.Chains)
    {
      const std::size_t last = chain.PointIds.size() - 1;
      for (std::size_t e = 0; e < 2; ++e)
      {
        int& id = chain.PointIds[e == 0 ? 0 : last];
        RegionVertex& vertex = this->Chains.Vertices[At(chain.Vertices[e])];
        if (id >= 0)
        {
          continue;
        }
        vertex.PointId = vertex.PointId >= 0 ? vertex.PointId : this->NextId++;
        id = vertex.PointId;
        for (const int region : chain.Regions)
        {
          if (this->IsFree(region))
          {
            Place& place = places[{ chain.Vertices[e], region - this->Charted.FirstChart }];
            place.Vertex = chain.Vertices[e];
            place.Neighbours.push_back(chain.PointIds[e == 0 ? 1 : last - 1]);
          }
        }
      }
    }
    for (const auto& [key, place] : places)
    {
      const RegionVertex& vertex = this->Chains.Vertices[At(place.Vertex)];
      if (place.Neighbours.size() != 2 ||
        !this->Divide(
          key.second, place.Neighbours[0], place.Neighbours[1], vertex.MeshPoint, vertex.PointId))
      {
        return { ErrorCode::InvalidTopology,
          "an edge of a region of free form is cut more than once between two points of the mesh; "
          "divide its triangles" };
      }
    }
    return {};
  }

  /// Puts a point on the rim edge of a chart. @return false when there is no such edge.
  bool Divide(int number, int a, int b, const Eigen::Vector3d& point, int id)
  {
    ChartMesh& chart = this->Charted.Charts[At(number)];
    const auto idOf = [&](int row) { return static_cast<int>(chart.PointIds[At(row)]); };
    for (std::size_t t = 0; t < chart.Triangles.size(); ++t)
    {
      for (std::size_t k = 0; k < 3; ++k)
      {
        const int from = chart.Triangles[t][k];
        const int to = chart.Triangles[t][(k + 1) % 3];
        const int beside = chart.Triangles[t][(k + 2) % 3];
        if (!(idOf(from) == a && idOf(to) == b) && !(idOf(from) == b && idOf(to) == a))
        {
          continue;
        }
        const int row = static_cast<int>(chart.Points.rows());
        const Eigen::Vector3d begin = chart.Points.row(from).transpose();
        const Eigen::Vector3d along = chart.Points.row(to).transpose() - begin;
        const double share = (point - begin).dot(along) / along.squaredNorm();
        chart.Points.conservativeResize(row + 1, 3);
        chart.UV.conservativeResize(row + 1, 2);
        chart.Points.row(row) = point.transpose();
        chart.UV.row(row) = (1.0 - share) * chart.UV.row(from) + share * chart.UV.row(to);
        chart.PointIds.push_back(id);
        chart.Triangles[t] = { from, row, beside };
        chart.Triangles.push_back({ row, to, beside });
        return true;
      }
    }
    return false;
  }

  /// Edges of triangles are chords of a curved surface beside them: there charts get points on it.
  void InsertOnSurfaces()
  {
    constexpr double Near = 0.1; // of the tolerance
    constexpr double MostParts = 32.0;
    for (RegionChain& chain : this->Chains.Chains)
    {
      const std::vector<AnalyticSurface> beside = SurfacesOf(chain.Regions, this->Surfaces);
      const int region = std::max(chain.Regions[0], chain.Regions[1]);
      if (beside.empty() || !this->IsFree(region))
      {
        continue;
      }
      std::vector<Eigen::Vector3d> offsets;
      for (const Eigen::Vector3d& point : chain.Points)
      {
        offsets.push_back(point - MoveOnto(beside, point, HUGE_VAL));
      }
      RegionChain refined = chain;
      refined.Points = { chain.Points.front() };
      refined.MeshPoints = { chain.MeshPoints.front() };
      refined.PointIds = { chain.PointIds.front() };
      for (std::size_t i = 0; i + 1 < chain.Points.size(); ++i)
      {
        const Eigen::Vector3d middle = 0.5 * (chain.Points[i] + chain.Points[i + 1]);
        const double sag = std::abs(beside.front().Distance(middle) -
          0.5 *
            (beside.front().Distance(chain.Points[i]) +
              beside.front().Distance(chain.Points[i + 1])));
        const double parts =
          std::min(std::ceil(std::sqrt(sag / (Near * this->Params.Tolerance))), MostParts);
        for (double k = 1.0; k < parts; ++k)
        {
          const auto between = [&](const std::vector<Eigen::Vector3d>& points) -> Eigen::Vector3d
          { return points[i] + k / parts * (points[i + 1] - points[i]); };
          const Eigen::Vector3d onMesh = between(chain.MeshPoints);
          if (this->Divide(region - this->Charted.FirstChart, refined.PointIds.back(),
                chain.PointIds[i + 1], onMesh, this->NextId))
          {
            refined.Points.push_back(
              MoveOnto(beside, between(chain.Points), HUGE_VAL) + between(offsets));
            refined.MeshPoints.push_back(onMesh);
            refined.PointIds.push_back(this->NextId++);
          }
        }
        refined.Points.push_back(chain.Points[i + 1]);
        refined.MeshPoints.push_back(chain.MeshPoints[i + 1]);
        refined.PointIds.push_back(chain.PointIds[i + 1]);
      }
      chain = std::move(refined);
    }
  }

  void MovePoints()
  {
    std::unordered_map<int, Eigen::Vector3d> places;
    for (const RegionChain& chain : this->Chains.Chains)
    {
      for (std::size_t i = 0; i < chain.PointIds.size(); ++i)
      {
        places[chain.PointIds[i]] = chain.Points[i];
      }
    }
    for (ChartMesh& chart : this->Charted.Charts)
    {
      for (Eigen::Index i = 0; i < chart.Points.rows(); ++i)
      {
        const auto id = static_cast<int>(chart.PointIds[static_cast<std::size_t>(i)]);
        if (const auto place = places.find(id); place != places.end())
        {
          const Eigen::Vector3d before = chart.Points.row(i).transpose();
          if (id < this->Charted.Surface.NumPoints()) // the others are on chords
          {
            this->Made.MaxMove = std::max(this->Made.MaxMove, (before - place->second).norm());
          }
          chart.Points.row(i) = place->second.transpose();
        }
      }
    }
  }

  Status MatchChains(const BoundaryChains& topology)
  {
    std::map<std::array<std::int64_t, 2>, std::pair<int, bool>> byBegin; // reversed or not
    std::size_t count = 0;
    for (std::size_t c = 0; c < this->Chains.Chains.size(); ++c)
    {
      const RegionChain& chain = this->Chains.Chains[c];
      if (!this->IsFree(chain.Regions[0]) && !this->IsFree(chain.Regions[1]))
      {
        continue;
      }
      ++count;
      const std::vector<int>& ids = chain.PointIds;
      const std::size_t last = ids.size() - 1;
      byBegin[{ ids[0], ids[1] }] = { static_cast<int>(c), false };
      byBegin[{ ids[last], ids[last - 1] }] = { static_cast<int>(c), true };
    }
    for (const BoundaryChain& edge : topology.Chains)
    {
      const ChainUse& use = edge.Uses.front();
      const auto found =
        byBegin.find({ IdOf(this->Charted.Charts, use, 0), IdOf(this->Charted.Charts, use, 1) });
      const bool fits = found != byBegin.end() &&
        this->Chains.Chains[At(found->second.first)].PointIds.size() == use.Points.size();
      if (!fits || topology.Chains.size() != count)
      {
        return { ErrorCode::InvalidTopology,
          "edges of a region of free form end elsewhere than those of its neighbours" };
      }
      this->Made.ChainOfEdge.push_back(found->second.first);
      if (found->second.second)
      {
        this->Chains.Reverse(found->second.first);
      }
    }
    return {};
  }

  ChartedRegions& Charted;
  const std::vector<AnalyticSurface>& Surfaces;
  RegionChains& Chains;
  TrimParams Params;
  int NextId; ///< of points that are not the mesh's
  FreeFaces Made;
};
}

Status SplitAtChartCorners(
  const std::vector<ChartMesh>& charts, double cornerAngle, RegionChains& chains)
{
  const auto topology = FindBoundaryChains(charts, cornerAngle);
  if (!topology)
  {
    return topology.Status;
  }
  std::unordered_map<int, std::vector<int>> chainsOf; // by point
  for (std::size_t c = 0; c < chains.Chains.size(); ++c)
  {
    for (const int id : chains.Chains[c].PointIds)
    {
      chainsOf[id].push_back(static_cast<int>(c));
    }
  }
  for (const BoundaryChain& edge : topology->Chains)
  {
    for (const std::size_t e : { std::size_t{ 0 }, edge.Uses.front().Points.size() - 1 })
    {
      const auto id = static_cast<int>(IdOf(charts, edge.Uses.front(), e));
      const std::vector<int> candidates = chainsOf[id];
      for (const int c : candidates)
      {
        const RegionChain& chain = chains.Chains[At(c)];
        const auto at = std::find(chain.PointIds.begin(), chain.PointIds.end(), id);
        const bool isClosed = chain.Vertices[0] < 0;
        if (at == chain.PointIds.end() ||
          (!isClosed && (at == chain.PointIds.begin() || at + 1 == chain.PointIds.end())))
        {
          continue;
        }
        chains.Split(c, static_cast<std::size_t>(at - chain.PointIds.begin()));
        if (!isClosed)
        {
          const int added = static_cast<int>(chains.Chains.size()) - 1;
          for (const int point : chains.Chains.back().PointIds)
          {
            chainsOf[point].push_back(added);
          }
        }
        break;
      }
    }
  }
  return {};
}

Result<FreeFaces> FitFreeFaces(ChartedRegions& charted,
  const std::vector<AnalyticSurface>& surfaces, RegionChains& chains, const TrimParams& params)
{
  return FreeFitter(charted, surfaces, chains, params).Run();
}
}
