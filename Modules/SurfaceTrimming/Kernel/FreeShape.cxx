// SPDX-License-Identifier: BSD-3-Clause
#include "FreeShape.h"

#include "RegionEvidence.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr std::size_t FewClusters = 5000;
constexpr int Places = 64;
constexpr int EnoughConvincing = 2;
constexpr int PointsOfParameter = 5; ///< of the inner half: fewer lie on a surface by chance

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Clusters at places spread over the area.
std::vector<int> SpreadClusters(const FacetClusters& facets)
{
  double area = 0.0;
  for (const FacetCluster& cluster : facets.Clusters)
  {
    area += cluster.Area;
  }
  std::vector<int> chosen;
  double before = 0.0;
  for (std::size_t c = 0; c < facets.Clusters.size(); ++c)
  {
    before += facets.Clusters[c].Area;
    while (static_cast<int>(chosen.size()) < Places &&
      before >= area * (static_cast<double>(chosen.size()) + 0.5) / Places)
    {
      chosen.push_back(static_cast<int>(c));
    }
  }
  return chosen;
}

/// Whether half of a region's border is a sharp edge.
bool EndsAtEdges(
  const FacetClusters& facets, const SurfaceGrowth& growth, const GrownRegion& region)
{
  constexpr double Degree = 0.017453292519943295;
  std::vector<int> own = region.Clusters;
  std::sort(own.begin(), own.end());
  double all = 0.0;
  double sharp = 0.0;
  for (const int c : own)
  {
    for (const ClusterSide& side : facets.Sides[At(c)])
    {
      if (!std::binary_search(own.begin(), own.end(), side.Cluster))
      {
        const double length = growth.LengthOf(side);
        all += length;
        sharp += side.Angle >= SharpDegrees * Degree ? length : 0.0;
      }
    }
  }
  return all > 0.0 && sharp >= 0.5 * all;
}

/// Points of triangles, those that are farther from their border than half of the farthest one, by
/// steps along edges.
std::vector<Eigen::Vector3d> InnerPoints(const DiscMesh& surface, const std::vector<int>& triangles)
{
  std::map<int, int> uses; // triangles at each point
  for (const int t : triangles)
  {
    for (const int corner : surface.Triangles[At(t)])
    {
      ++uses[corner];
    }
  }
  std::map<int, int> steps;
  std::vector<int> front;
  for (const auto& [point, count] : uses)
  {
    const int around = surface.FanStart[At(point) + 1] - surface.FanStart[At(point)];
    if (count < around) // on the mesh's boundary, too: it has one triangle fewer than edges
    {
      steps[point] = 0;
      front.push_back(point);
    }
  }
  int farthest = 0;
  while (!front.empty())
  {
    std::vector<int> next;
    for (const int point : front)
    {
      for (int j = surface.FanStart[At(point)]; j < surface.FanStart[At(point) + 1]; ++j)
      {
        const int other = surface.Fan[At(j)];
        if (uses.count(other) != 0 && steps.emplace(other, steps[point] + 1).second)
        {
          next.push_back(other);
        }
      }
    }
    farthest += next.empty() ? 0 : 1;
    front = std::move(next);
  }
  std::vector<Eigen::Vector3d> inner;
  for (const auto& [point, step] : steps)
  {
    if (2 * step > farthest)
    {
      inner.push_back(surface.Point(point));
    }
  }
  return inner;
}

bool IsConvincing(const DiscMesh& surface, const FacetClusters& facets, const SurfaceGrowth& growth,
  const GrownRegion& region, double tolerance)
{
  RecognizedRegion recognized;
  recognized.Surface = region.Surface;
  for (const int c : region.Clusters)
  {
    const auto& triangles = facets.Clusters[At(c)].Triangles;
    recognized.Triangles.insert(recognized.Triangles.end(), triangles.begin(), triangles.end());
  }
  if (IsOnItsSurface(
        surface, recognized, EndsAtEdges(facets, growth, region), tolerance, tolerance))
  {
    return true;
  }
  // a region that has taken the first strips of what is beside it
  const std::vector<Eigen::Vector3d> inner = InnerPoints(surface, recognized.Triangles);
  AnalyticSurface exact = region.Surface;
  return static_cast<int>(inner.size()) >= PointsOfParameter * NumSurfaceParameters(exact.Type) &&
    FitSurface(inner, exact) && MaxDistance(inner, exact) <= ExactDistance * tolerance;
}
}

bool LooksFree(const DiscMesh& surface, const FacetClusters& facets, const SurfaceGrowth& growth,
  double tolerance)
{
  if (facets.Clusters.size() <= FewClusters)
  {
    return false;
  }
  const std::vector<int> none(facets.Clusters.size(), -1);
  int convincing = 0;
  for (const int seed : SpreadClusters(facets))
  {
    const GrownRegion region = growth.BestRegion(seed, none);
    convincing += IsConvincing(surface, facets, growth, region, tolerance) ? 1 : 0;
    if (convincing == EnoughConvincing)
    {
      return false;
    }
  }
  return true;
}
}
