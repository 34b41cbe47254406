// SPDX-License-Identifier: BSD-3-Clause
#include "FacetClusters.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr double LargestTurn = 0.02; // radians between normals in a cluster, where they are known

using Neighbours = std::vector<std::array<int, 3>>;

Neighbours FindNeighbours(const DiscMesh& surface)
{
  std::map<std::array<int, 2>, std::array<int, 2>> open; // of directed edges: triangle and side
  Neighbours result(surface.Triangles.size(), { -1, -1, -1 });
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const int a = surface.Triangles[t][k];
      const int b = surface.Triangles[t][(k + 1) % 3];
      const auto other = open.find({ b, a });
      if (other == open.end())
      {
        open[{ a, b }] = { static_cast<int>(t), static_cast<int>(k) };
        continue;
      }
      result[t][k] = other->second[0];
      result[static_cast<std::size_t>(other->second[0])]
            [static_cast<std::size_t>(other->second[1])] = static_cast<int>(t);
    }
  }
  return result;
}

void Finish(const DiscMesh& surface, const std::vector<double>& areas,
  const std::vector<Eigen::Vector3d>& normals, FacetCluster& cluster)
{
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (int t : cluster.Triangles)
  {
    const auto& corners = surface.Triangles[static_cast<std::size_t>(t)];
    const double area = areas[static_cast<std::size_t>(t)];
    cluster.Area += area;
    normal += area * normals[static_cast<std::size_t>(t)];
    for (int c : corners)
    {
      centre += area / 3.0 * surface.Point(c);
      cluster.Points.push_back(c);
    }
  }
  std::sort(cluster.Points.begin(), cluster.Points.end());
  cluster.Points.erase(
    std::unique(cluster.Points.begin(), cluster.Points.end()), cluster.Points.end());
  cluster.Piece.Normal = normal.normalized();
  cluster.Piece.Centre = centre / cluster.Area;
}
}

FacetClusters FindFacetClusters(const DiscMesh& surface, double flatness)
{
  const std::size_t count = surface.Triangles.size();
  const Neighbours neighbours = FindNeighbours(surface);
  FacetClusters result;
  std::vector<double> areas(count);
  for (std::size_t t = 0; t < count; ++t)
  {
    const auto& c = surface.Triangles[t];
    const Eigen::Vector3d first = surface.Point(c[1]) - surface.Point(c[0]);
    const Eigen::Vector3d second = surface.Point(c[2]) - surface.Point(c[0]);
    const Eigen::Vector3d normal = first.cross(second);
    const double longest = std::max({ first.norm(), second.norm(), (second - first).norm() });
    areas[t] = normal.norm() / 2.0;
    result.Normals.push_back(normal.normalized());
    result.Heights.push_back(2.0 * areas[t] / longest);
  }
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
    [&](int a, int b)
    { return areas[static_cast<std::size_t>(a)] > areas[static_cast<std::size_t>(b)]; });
  std::vector<int> clusterOf(count, -1);
  for (int seed : order)
  {
    if (clusterOf[static_cast<std::size_t>(seed)] >= 0)
    {
      continue;
    }
    const int number = static_cast<int>(result.Clusters.size());
    FacetCluster& cluster = result.Clusters.emplace_back();
    const Eigen::Vector3d normal = result.Normals[static_cast<std::size_t>(seed)];
    const Eigen::Vector3d origin =
      surface.Point(surface.Triangles[static_cast<std::size_t>(seed)][0]);
    cluster.Triangles.push_back(seed);
    clusterOf[static_cast<std::size_t>(seed)] = number;
    for (std::size_t i = 0; i < cluster.Triangles.size(); ++i)
    {
      for (int next : neighbours[static_cast<std::size_t>(cluster.Triangles[i])])
      {
        if (next < 0 || clusterOf[static_cast<std::size_t>(next)] >= 0)
        {
          continue;
        }
        const auto n = static_cast<std::size_t>(next);
        const double turn = LargestTurn + 4.0 * flatness / result.Heights[n];
        bool joins = result.Normals[n].dot(normal) > std::cos(std::min(turn, 1.5));
        for (int c : surface.Triangles[n])
        {
          joins = joins && std::abs(normal.dot(surface.Point(c) - origin)) <= flatness;
        }
        if (joins)
        {
          clusterOf[n] = number;
          cluster.Triangles.push_back(next);
        }
      }
    }
    Finish(surface, areas, result.Normals, cluster);
  }
  result.Sides.resize(result.Clusters.size());
  for (std::size_t t = 0; t < count; ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const int other = neighbours[t][k];
      if (other < 0 || clusterOf[static_cast<std::size_t>(other)] == clusterOf[t])
      {
        continue;
      }
      const Eigen::Vector3d& a = result.Normals[t];
      const Eigen::Vector3d& b = result.Normals[static_cast<std::size_t>(other)];
      result.Sides[static_cast<std::size_t>(clusterOf[t])].push_back(
        { clusterOf[static_cast<std::size_t>(other)],
          { surface.Triangles[t][k], surface.Triangles[t][(k + 1) % 3] },
          std::atan2(a.cross(b).norm(), a.dot(b)) });
    }
  }
  return result;
}

std::vector<int> CountPointsInside(
  const FacetClusters& facets, const std::vector<int>& regionOfCluster, std::size_t numRegions)
{
  std::map<int, int> regionOfPoint; // -1: of several
  for (std::size_t c = 0; c < facets.Clusters.size(); ++c)
  {
    for (const int p : facets.Clusters[c].Points)
    {
      const auto [at, isNew] = regionOfPoint.emplace(p, regionOfCluster[c]);
      at->second = isNew || at->second == regionOfCluster[c] ? at->second : -1;
    }
  }
  std::vector<int> counts(numRegions, 0);
  for (const auto& [point, region] : regionOfPoint)
  {
    if (region >= 0)
    {
      ++counts[static_cast<std::size_t>(region)];
    }
  }
  return counts;
}
}
