// SPDX-License-Identifier: BSD-3-Clause
#include "JoinCharts.h"

#include "TriangleAdjacency.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace knotwork
{
namespace
{
constexpr double SmallShare = 0.05;          // of the whole area: charts that are tried
constexpr double SharpWeight = 0.1;          // of borders along creases
constexpr int MostTrials = 3;                // neighbours of a chart
constexpr std::size_t MostTriangles = 20000; // of two charts together: what costs seconds
constexpr double Pi = 3.14159265358979323846;

/// Charts as lists of triangles, with what choosing among them asks for.
class Patchwork
{
public:
  Patchwork(const CutMesh& mesh, std::size_t count, double creaseAngle)
    : Mesh(mesh), Adjacency(FindAdjacency(mesh.Triangles).Value), Triangles(count),
      Areas(count, 0.0)
  {
    this->Sharp = std::cos(creaseAngle * Pi / 180.0);
    for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
    {
      const auto chart = static_cast<std::size_t>(mesh.Charts[t]);
      const Eigen::Vector3d normal = this->Side(t, 0).cross(this->Side(t, 1));
      this->Normals.push_back(normal.normalized());
      this->Areas[chart] += 0.5 * normal.norm();
      this->Area += 0.5 * normal.norm();
      this->Triangles[chart].push_back(static_cast<int>(t));
    }
  }

  /// Neighbours of a chart, the one with the longest border first.
  std::vector<int> Neighbours(int chart) const
  {
    std::map<int, double> borders;
    for (int triangle : this->Triangles[static_cast<std::size_t>(chart)])
    {
      const auto t = static_cast<std::size_t>(triangle);
      for (std::size_t k = 0; k < 3; ++k)
      {
        const auto other = static_cast<std::size_t>(this->Adjacency.Triangle[t][k]);
        if (this->Adjacency.Triangle[t][k] >= 0 && this->Mesh.Charts[other] != chart)
        {
          const bool sharp = this->Normals[t].dot(this->Normals[other]) < this->Sharp;
          borders[this->Mesh.Charts[other]] +=
            (sharp ? SharpWeight : 1.0) * this->Side(t, k).norm();
        }
      }
    }
    std::vector<int> neighbours;
    for (const auto& [other, length] : borders)
    {
      neighbours.push_back(other);
    }
    std::stable_sort(neighbours.begin(), neighbours.end(),
      [&](int a, int b) { return borders.at(a) > borders.at(b); });
    return neighbours;
  }

  std::vector<int> Union(int a, int b) const
  {
    std::vector<int> both;
    const auto& p = this->Triangles[static_cast<std::size_t>(a)];
    const auto& q = this->Triangles[static_cast<std::size_t>(b)];
    std::merge(p.begin(), p.end(), q.begin(), q.end(), std::back_inserter(both));
    return both;
  }

  void Join(int from, int to)
  {
    const auto a = static_cast<std::size_t>(from);
    const auto b = static_cast<std::size_t>(to);
    this->Triangles[b] = this->Union(from, to);
    this->Triangles[a].clear();
    this->Areas[b] += this->Areas[a];
    this->Areas[a] = 0.0;
  }

  /// Another one after each change of the chart.
  std::size_t Number(int chart) const
  {
    const auto c = static_cast<std::size_t>(chart);
    return c * (this->Mesh.Triangles.size() + 1) + this->Triangles[c].size();
  }

  const CutMesh& Mesh;
  TriangleAdjacency Adjacency;
  std::vector<std::vector<int>> Triangles;
  std::vector<double> Areas;
  double Area = 0.0;

private:
  Eigen::Vector3d Side(std::size_t t, std::size_t k) const
  {
    const auto& corners = this->Mesh.Triangles[t];
    return this->Mesh.Points[static_cast<std::size_t>(corners[(k + 1) % 3])] -
      this->Mesh.Points[static_cast<std::size_t>(corners[k])];
  }

  std::vector<Eigen::Vector3d> Normals;
  double Sharp = 0.0; ///< cosine
};

bool HasCopies(const ChartPart& part)
{
  return std::adjacent_find(part.Points.begin(), part.Points.end()) != part.Points.end();
}

void CloseUp(CutMesh& mesh, const Patchwork& patchwork, std::vector<ChartMap>& maps)
{
  std::vector<int> number(maps.size(), -1);
  std::vector<ChartMap> kept;
  for (std::size_t c = 0; c < maps.size(); ++c)
  {
    if (!patchwork.Triangles[c].empty())
    {
      number[c] = static_cast<int>(kept.size());
      kept.push_back(std::move(maps[c]));
    }
  }
  maps = std::move(kept);
  for (int& chart : mesh.Charts)
  {
    chart = number[static_cast<std::size_t>(chart)];
  }
}
}

Status JoinCharts(CutMesh& mesh, const FlattenParams& params, const ChartParams& charts,
  std::vector<ChartMap>& maps)
{
  Patchwork patchwork(mesh, maps.size(), charts.CreaseAngle);
  std::set<std::pair<double, int>> waiting; // by area
  for (std::size_t c = 0; c < maps.size(); ++c)
  {
    waiting.insert({ patchwork.Areas[c], static_cast<int>(c) });
  }
  std::set<std::pair<std::size_t, std::size_t>> tried;
  std::set<std::pair<double, int>> failed;
  while (!waiting.empty() && waiting.begin()->first < SmallShare * patchwork.Area)
  {
    const auto at = *waiting.begin();
    const int small = at.second;
    waiting.erase(waiting.begin());
    failed.insert(at);
    int trials = 0;
    for (int other : patchwork.Neighbours(small))
    {
      const std::vector<int> triangles = patchwork.Union(small, other);
      if (triangles.size() > MostTriangles || trials++ == MostTrials ||
        !tried.insert({ patchwork.Number(small), patchwork.Number(other) }).second)
      {
        continue;
      }
      const auto part = TakePart(mesh, triangles);
      if (!part)
      {
        return part.Status;
      }
      ChartMap map;
      if (!HasCopies(part.Value))
      {
        map = MapChart(part.Value.Mesh, params, charts.MaxStretch);
      }
      if (!map.Good)
      {
        continue;
      }
      PlaceTriangles(part.Value, map, mesh);
      for (int t : patchwork.Triangles[static_cast<std::size_t>(small)])
      {
        mesh.Charts[static_cast<std::size_t>(t)] = other;
      }
      const std::pair<double, int> before{ patchwork.Areas[static_cast<std::size_t>(other)],
        other };
      waiting.erase(before);
      failed.erase(before);
      failed.erase(at);
      patchwork.Join(small, other);
      maps[static_cast<std::size_t>(other)] = std::move(map);
      waiting.insert({ patchwork.Areas[static_cast<std::size_t>(other)], other });
      waiting.insert(failed.begin(), failed.end()); // its neighbours may join it now
      failed.clear();
      break;
    }
  }
  CloseUp(mesh, patchwork, maps);
  return {};
}
}
