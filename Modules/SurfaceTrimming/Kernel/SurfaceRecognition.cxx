// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceRecognition.h"

#include "FacetClusters.h"
#include "SurfaceGrowth.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace knotwork
{
namespace
{
/// Tolerances that are tried, in those of the user: of exact points, of rounded curves, of noise.
constexpr std::array<double, 5> Levels = { 1.0 / 500.0, 1.0 / 50.0, 1.0 / 8.0, 0.35, 1.0 };
/// A coarser level is taken when it needs fewer regions than this share of the finer one's.
constexpr double WorthIt = 0.85;
/// Of the cost of a cluster where it is: less beside it, and it goes over.
constexpr double BetterShare = 0.5;
constexpr int BorderPasses = 6;
constexpr double LargestTurn = 1.0471975511965976; // 60 degrees
/// Of a curved surface at least, for each of its parameters.
constexpr int PointsOfParameter = 5;
/// A torus has the curvatures of any surface at a point: its normals must turn by that, radians.
constexpr double SpreadOfTorus = 0.5235987755982988; // 30 degrees from their mean
/// Between regions of one free form at most, radians.
constexpr double SmoothAngle = 0.6981317007977318; // 40 degrees

struct Division
{
  std::vector<GrownRegion> Regions;
  std::vector<int> RegionOfCluster;
};

Division Divide(const SurfaceGrowth& growth, const FacetClusters& facets)
{
  Division division;
  const std::size_t count = facets.Clusters.size();
  division.RegionOfCluster.assign(count, -1);
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
    [&](int a, int b)
    {
      return facets.Clusters[static_cast<std::size_t>(a)].Area >
        facets.Clusters[static_cast<std::size_t>(b)].Area;
    });
  for (int seed : order)
  {
    if (division.RegionOfCluster[static_cast<std::size_t>(seed)] >= 0)
    {
      continue;
    }
    GrownRegion region = growth.BestRegion(seed, division.RegionOfCluster);
    for (int cluster : region.Clusters)
    {
      division.RegionOfCluster[static_cast<std::size_t>(cluster)] =
        static_cast<int>(division.Regions.size());
    }
    division.Regions.push_back(std::move(region));
  }
  return division;
}

/// Clusters beside another region go over to it where they lie on it much better: what was grown
/// first has taken what lies within the noise, as the first strips of a fillet.
/// @return whether any did; the surfaces are fitted again then.
bool MoveClusters(const SurfaceGrowth& growth, const FacetClusters& facets, Division& division)
{
  std::vector<char> changed(division.Regions.size(), 0);
  bool any = false;
  for (std::size_t c = 0; c < facets.Clusters.size(); ++c)
  {
    const int cluster = static_cast<int>(c);
    const int from = division.RegionOfCluster[c];
    const auto& own = division.Regions[static_cast<std::size_t>(from)];
    double least = BetterShare * growth.Cost(cluster, own.Surface);
    int to = from;
    for (const ClusterSide& side : facets.Sides[c])
    {
      const int other = division.RegionOfCluster[static_cast<std::size_t>(side.Cluster)];
      const auto& region = division.Regions[static_cast<std::size_t>(other)];
      const double cost = growth.Cost(cluster, region.Surface);
      if (other != to && cost < least && side.Angle < LargestTurn &&
        growth.Fits(cluster, region.Surface, region.Reversed))
      {
        least = cost;
        to = other;
      }
    }
    if (to != from)
    {
      division.RegionOfCluster[c] = to;
      changed[static_cast<std::size_t>(from)] = 1;
      changed[static_cast<std::size_t>(to)] = 1;
      any = true;
    }
  }
  for (GrownRegion& region : division.Regions)
  {
    region.Clusters.clear();
  }
  for (std::size_t c = 0; c < facets.Clusters.size(); ++c)
  {
    division.Regions[static_cast<std::size_t>(division.RegionOfCluster[c])].Clusters.push_back(
      static_cast<int>(c));
  }
  for (std::size_t r = 0; r < division.Regions.size(); ++r)
  {
    if (changed[r] && !division.Regions[r].Clusters.empty())
    {
      growth.Refit(division.Regions[r]);
    }
  }
  return any;
}

/// MoveClusters until nothing changes; regions that have lost all clusters are dropped.
void MoveBorders(const SurfaceGrowth& growth, const FacetClusters& facets, Division& division)
{
  for (int pass = 0; pass < BorderPasses && MoveClusters(growth, facets, division); ++pass)
  {
  }
  std::vector<GrownRegion> kept;
  for (GrownRegion& region : division.Regions)
  {
    if (!region.Clusters.empty())
    {
      for (int c : region.Clusters)
      {
        division.RegionOfCluster[static_cast<std::size_t>(c)] = static_cast<int>(kept.size());
      }
      kept.push_back(std::move(region));
    }
  }
  division.Regions = std::move(kept);
}

/// Points of regions that lie in no other one.
std::vector<int> CountInside(const FacetClusters& facets, const Division& division)
{
  std::map<int, int> regionOfPoint; // -1: of several
  for (std::size_t c = 0; c < facets.Clusters.size(); ++c)
  {
    for (int p : facets.Clusters[c].Points)
    {
      const auto [at, isNew] = regionOfPoint.emplace(p, division.RegionOfCluster[c]);
      at->second = isNew || at->second == division.RegionOfCluster[c] ? at->second : -1;
    }
  }
  std::vector<int> counts(division.Regions.size(), 0);
  for (const auto& [point, region] : regionOfPoint)
  {
    if (region >= 0)
    {
      ++counts[static_cast<std::size_t>(region)];
    }
  }
  return counts;
}

/// Largest angle between the mean normal of a region and one of its clusters'.
double NormalSpread(const FacetClusters& facets, const GrownRegion& region)
{
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const int c : region.Clusters)
  {
    const FacetCluster& cluster = facets.Clusters[static_cast<std::size_t>(c)];
    mean += cluster.Area * cluster.Piece.Normal;
  }
  double spread = 0.0;
  for (const int c : region.Clusters)
  {
    const Eigen::Vector3d& normal = facets.Clusters[static_cast<std::size_t>(c)].Piece.Normal;
    spread = std::max(spread, std::atan2(mean.cross(normal).norm(), mean.dot(normal)));
  }
  return spread;
}

/// Whether a region says little by itself. Near its tolerance a curved surface imitates patches of
/// any shape, with points inside of them: there it must have many points.
bool IsWeak(const FacetClusters& facets, const GrownRegion& region, bool coarse, int numInside)
{
  const SurfaceType type = region.Surface.Type;
  if (type == SurfaceType::FreeForm || type == SurfaceType::Plane)
  {
    return type == SurfaceType::FreeForm || region.NumPoints <= 4;
  }
  if (!coarse || numInside == 0)
  {
    return false;
  }
  return region.NumPoints < PointsOfParameter * NumSurfaceParameters(type) ||
    (type == SurfaceType::Torus && NormalSpread(facets, region) < SpreadOfTorus);
}

/// Weak regions that pass over into each other become regions of free form.
void JoinFreeForm(bool coarse, const FacetClusters& facets, Division& division)
{
  const std::vector<int> inside = CountInside(facets, division);
  std::vector<char> weak;
  for (std::size_t r = 0; r < division.Regions.size(); ++r)
  {
    weak.push_back(IsWeak(facets, division.Regions[r], coarse, inside[r]) ? 1 : 0);
  }
  std::vector<char> done(division.Regions.size(), 0);
  std::vector<GrownRegion> kept;
  for (std::size_t r = 0; r < division.Regions.size(); ++r)
  {
    if (done[r])
    {
      continue;
    }
    GrownRegion region = division.Regions[r];
    if (weak[r])
    {
      done[r] = 1;
      for (std::size_t i = 0; i < region.Clusters.size(); ++i)
      {
        for (const ClusterSide& side : facets.Sides[static_cast<std::size_t>(region.Clusters[i])])
        {
          const auto other = static_cast<std::size_t>(
            division.RegionOfCluster[static_cast<std::size_t>(side.Cluster)]);
          if (!done[other] && side.Angle < SmoothAngle && weak[other])
          {
            done[other] = 1;
            const auto& more = division.Regions[other].Clusters;
            region.Clusters.insert(region.Clusters.end(), more.begin(), more.end());
            region.Surface = AnalyticSurface();
          }
        }
      }
    }
    kept.push_back(std::move(region));
  }
  division.Regions = std::move(kept);
}

double AreaOf(const FacetClusters& facets, const std::vector<int>& clusters)
{
  double area = 0.0;
  for (int c : clusters)
  {
    area += facets.Clusters[static_cast<std::size_t>(c)].Area;
  }
  return area;
}

void Report(const SurfaceGrowth& growth, const FacetClusters& facets, const Division& division,
  SurfaceRecognition& result)
{
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t r = 0; r < division.Regions.size(); ++r)
  {
    order.emplace_back(-AreaOf(facets, division.Regions[r].Clusters), r);
  }
  std::sort(order.begin(), order.end());
  for (const auto& [area, r] : order)
  {
    const GrownRegion& grown = division.Regions[r];
    RecognizedRegion region;
    region.Surface = grown.Surface;
    region.Reversed = grown.Reversed;
    for (int c : grown.Clusters)
    {
      const auto& triangles = facets.Clusters[static_cast<std::size_t>(c)].Triangles;
      region.Triangles.insert(region.Triangles.end(), triangles.begin(), triangles.end());
    }
    std::sort(region.Triangles.begin(), region.Triangles.end());
    for (int t : region.Triangles)
    {
      result.RegionOfTriangle[static_cast<std::size_t>(t)] =
        static_cast<int>(result.Regions.size());
    }
    if (grown.Surface.Type != SurfaceType::FreeForm)
    {
      growth.Measure(grown, region.MaxDistance, region.MaxSag);
    }
    ++result.NumOfType[static_cast<std::size_t>(region.Surface.Type)];
    result.Regions.push_back(std::move(region));
  }
}
}

Result<SurfaceRecognition> RecognizeSurfaces(
  const DiscMesh& surface, const RecognitionParams& params)
{
  if (!(params.Tolerance >= 0.0) || !(params.MaximumSag >= 0.0 && params.MaximumSag <= 1000.0))
  {
    return { ErrorCode::InvalidParameter,
      "Tolerance must not be negative, and MaximumSag must lie in [0, 1000]" };
  }
  SurfaceRecognition result;
  const double diagonal =
    (surface.Points.colwise().maxCoeff() - surface.Points.colwise().minCoeff()).norm();
  result.Tolerance = params.Tolerance > 0.0 ? params.Tolerance : 1e-3 * diagonal;
  const FacetClusters facets = FindFacetClusters(surface, Levels.front() * result.Tolerance);
  Division best;
  std::size_t fewest = 0;
  for (std::size_t level = 0; level < Levels.size(); ++level)
  {
    if (params.Progress &&
      !params.Progress(static_cast<double>(level) / static_cast<double>(Levels.size())))
    {
      return { ErrorCode::Aborted, "recognition was stopped" };
    }
    const double noise = Levels[level] * result.Tolerance;
    const SurfaceGrowth growth(surface, facets, noise, params.MaximumSag * result.Tolerance);
    Division division = Divide(growth, facets);
    MoveBorders(growth, facets, division);
    const std::size_t count = division.Regions.size();
    if (level == 0 || static_cast<double>(count) < WorthIt * static_cast<double>(fewest))
    {
      fewest = count;
      best = std::move(division);
      result.Noise = noise;
    }
    if (fewest == 1)
    {
      break;
    }
  }
  const SurfaceGrowth growth(surface, facets, result.Noise, params.MaximumSag * result.Tolerance);
  JoinFreeForm(result.Noise > Levels[1] * result.Tolerance, facets, best);
  result.RegionOfTriangle.resize(surface.Triangles.size());
  Report(growth, facets, best, result);
  return result;
}

Result<SurfaceRecognition> RecognizeSurfaces(
  const TriangleMesh& mesh, const RecognitionParams& params)
{
  const std::vector<MeshComponent> components = ConnectedComponents(mesh);
  if (components.empty())
  {
    return { ErrorCode::EmptyInput, "the mesh has no triangles" };
  }
  SurfaceRecognition all;
  all.RegionOfTriangle.assign(mesh.Triangles.size(), -1);
  RecognitionParams own = params;
  for (std::size_t i = 0; i < components.size(); ++i)
  {
    const auto surface = CheckComponent(mesh, components[i]);
    if (!surface)
    {
      return surface.Status;
    }
    if (i == 0 && params.Tolerance == 0.0)
    {
      const Eigen::RowVector3d box =
        mesh.Points.colwise().maxCoeff() - mesh.Points.colwise().minCoeff();
      own.Tolerance = 1e-3 * box.norm();
    }
    if (params.Progress)
    {
      own.Progress = [&](double share)
      {
        return params.Progress(
          (static_cast<double>(i) + share) / static_cast<double>(components.size()));
      };
    }
    auto part = RecognizeSurfaces(surface.Value, own);
    if (!part)
    {
      return part.Status;
    }
    for (RecognizedRegion& region : part->Regions)
    {
      for (int& triangle : region.Triangles)
      {
        triangle = surface->TriangleIds[static_cast<std::size_t>(triangle)];
        all.RegionOfTriangle[static_cast<std::size_t>(triangle)] =
          static_cast<int>(all.Regions.size());
      }
      std::sort(region.Triangles.begin(), region.Triangles.end());
      ++all.NumOfType[static_cast<std::size_t>(region.Surface.Type)];
      all.Regions.push_back(std::move(region));
    }
    all.Tolerance = part->Tolerance;
    all.Noise = std::max(all.Noise, part->Noise);
  }
  return all;
}
}
