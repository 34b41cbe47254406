// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceRecognition.h"

#include "FacetClusters.h"
#include "FreeShape.h"
#include "JoinRegions.h"
#include "RegionDivision.h"
#include "SnapSurfaces.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace knotwork
{
namespace
{
/// Tolerances that are tried, in those of the user: of exact points, of rounded curves, of noise.
constexpr std::array<double, 5> Levels = { 1.0 / 500.0, 1.0 / 50.0, 1.0 / 8.0, 0.35, 1.0 };
/// A coarser level is taken when it needs fewer regions than this share of the finer one's.
constexpr double WorthIt = 0.85;
/// Of both levels of noise pieces are joined within the tolerance: what is less then is no chance.
constexpr double WorthItWithNoise = 0.95;
/// A torus has the curvatures of any surface at a point: its normals must turn by that, radians.
constexpr double SpreadOfTorus = 0.5235987755982988; // 30 degrees from their mean
/// Between regions of one free form at most, radians.
constexpr double SmoothAngle = 0.6981317007977318; // 40 degrees
/// Surfaces of parts of one are so far apart, in the noise of their points, where that is little:
/// up to this level.
constexpr double NearEnough = 3.0;
constexpr std::size_t LastOfExact = 2;
constexpr std::size_t MostToJoin = 1000; ///< more are pieces of a free shape

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
    return type == SurfaceType::FreeForm || region.NumPoints <= PointsOfFacet;
  }
  if (!coarse || numInside == 0)
  {
    return false;
  }
  return region.NumPoints < PointsOfParameter * NumSurfaceParameters(type) ||
    (type == SurfaceType::Torus && NormalSpread(facets, region) < SpreadOfTorus);
}

/// Weak regions that pass over into each other become planes where they are flat, or regions of
/// free form.
void JoinFreeForm(
  bool coarse, const FacetClusters& facets, const SurfaceGrowth& growth, Division& division)
{
  const std::vector<int> inside =
    CountPointsInside(facets, division.RegionOfCluster, division.Regions.size());
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
      if (region.Clusters.size() > division.Regions[r].Clusters.size())
      {
        growth.Flatten(region);
      }
    }
    kept.push_back(std::move(region));
  }
  division.Regions = std::move(kept);
}

/// Regions of free form that are one extrusion or revolution.
void TakeProfiles(const SurfaceGrowth& growth, const FacetClusters& facets, Division& division)
{
  std::vector<char> flat;
  for (const FacetCluster& cluster : facets.Clusters)
  {
    flat.push_back(cluster.Points.size() > PointsOfFacet ? 1 : 0);
  }
  for (GrownRegion& region : division.Regions)
  {
    for (const SurfaceType type : { SurfaceType::Extrusion, SurfaceType::Revolution })
    {
      if (region.Surface.Type == SurfaceType::FreeForm)
      {
        growth.FitProfile(type, flat, region);
      }
    }
  }
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
  if (!(params.Tolerance >= 0.0) || params.MaxRegions < 0 || !(params.SnapDistance >= 0.0) ||
    !(params.MaximumSag >= 0.0 && params.MaximumSag <= 1000.0))
  {
    return { ErrorCode::InvalidParameter,
      "Tolerance, MaxRegions and SnapDistance must not be negative, and MaximumSag must lie in [0, "
      "1000]" };
  }
  SurfaceRecognition result;
  const double diagonal =
    (surface.Points.colwise().maxCoeff() - surface.Points.colwise().minCoeff()).norm();
  result.Tolerance = params.Tolerance > 0.0 ? params.Tolerance : 1e-3 * diagonal;
  const FacetClusters facets = FindFacetClusters(surface, Levels.front() * result.Tolerance);
  if (params.MaxRegions > 0 &&
    LooksFree(surface, facets,
      SurfaceGrowth(surface, facets, result.Tolerance, params.MaximumSag * result.Tolerance),
      result.Tolerance))
  {
    return { ErrorCode::NotInSpace,
      "at most one of 64 places of the mesh is on a plane, cylinder, sphere, cone or torus: it is "
      "a free shape" };
  }
  // The coarsest level comes first: it says how many regions the others may have to be taken.
  constexpr std::size_t coarsest = Levels.size() - 1;
  // clusters that go over to others leave fewer regions, and so do regions that are joined
  const auto unfinished = [](std::size_t level) { return level <= LastOfExact ? 2.0 : 3.0; };
  constexpr std::size_t Any = std::numeric_limits<std::size_t>::max();
  const auto divide = [&](std::size_t level, const DivisionLimits& limits, Division& division)
  {
    const double noise = Levels[level] * result.Tolerance;
    const SurfaceGrowth growth(surface, facets, noise, params.MaximumSag * result.Tolerance);
    division = Divide(growth, facets, limits);
    if (std::any_of(division.RegionOfCluster.begin(), division.RegionOfCluster.end(),
          [](int region) { return region < 0; }))
    {
      return false;
    }
    MoveBorders(growth, facets, division);
    ShareOut(growth, facets, division);
    FlattenSingles(facets, division);
    Reconsider(growth, facets, division);
    const bool exact = level <= LastOfExact;
    const double near = exact ? NearEnough * noise : noise;
    TakeWideTriangles(surface, facets, growth, near, division);
    if (!exact)
    {
      FlattenDoubtful(growth, division);
      TakeStrips(facets, growth, division);
    }
    JoinEqual(surface, facets, near, exact, growth, division);
    DropEmpty(division);
    if (!exact && division.Regions.size() <= MostToJoin)
    {
      const SurfaceGrowth loose(
        surface, facets, result.Tolerance, params.MaximumSag * result.Tolerance);
      for (std::size_t before = 0; before != division.Regions.size();)
      {
        before = division.Regions.size();
        JoinPieces(loose, facets, result.Tolerance, division.Regions, division.RegionOfCluster);
        DropEmpty(division);
        MoveBorders(growth, facets, division);
        ShareOut(growth, facets, division); // to what was in pieces before
        FlattenSingles(facets, division);
      }
    }
    return true;
  };
  DivisionLimits limits;
  limits.CoversSoon = params.MaxRegions > 0;
  limits.Most = params.MaxRegions > 0 ? static_cast<std::size_t>(params.MaxRegions) : Any;
  Division last;
  if (!divide(coarsest, limits, last))
  {
    return { ErrorCode::TooLarge,
      "the mesh has more than " + std::to_string(params.MaxRegions) +
        " regions, or the first 200 do not cover half of it" };
  }
  const auto ofCoarsest = static_cast<double>(last.Regions.size());
  Division best;
  std::size_t fewest = Any;
  for (std::size_t level = 0; level < Levels.size() && fewest > 1; ++level)
  {
    if (params.Progress &&
      !params.Progress(static_cast<double>(level + 1) / static_cast<double>(Levels.size() + 1)))
    {
      return { ErrorCode::Aborted, "recognition was stopped" };
    }
    const double most =
      unfinished(level) * ofCoarsest / std::pow(WorthIt, static_cast<double>(coarsest - level));
    Division division;
    if (level == coarsest)
    {
      std::swap(division, last);
    }
    else if (limits = { static_cast<std::size_t>(most), false }; !divide(level, limits, division))
    {
      continue;
    }
    const std::size_t count = division.Regions.size();
    const double worthIt = level < LastOfExact ? 1.0 // rounding, no noise
      : level == coarsest                      ? WorthItWithNoise
                                               : WorthIt;
    if (fewest == Any || static_cast<double>(count) < worthIt * static_cast<double>(fewest))
    {
      fewest = count;
      best = std::move(division);
      result.Noise = Levels[level] * result.Tolerance;
    }
  }
  const SurfaceGrowth growth(surface, facets, result.Noise, params.MaximumSag * result.Tolerance);
  if (result.Noise > Levels[LastOfExact] * result.Tolerance)
  {
    JoinAlongProfiles(growth, facets, result.Tolerance, best.Regions, best.RegionOfCluster);
    DropEmpty(best);
  }
  JoinFreeForm(result.Noise > Levels[1] * result.Tolerance, facets, growth, best);
  // profiles of few spans come no nearer
  const double ofProfiles = std::max(result.Noise, Levels[LastOfExact] * result.Tolerance);
  TakeProfiles(
    SurfaceGrowth(surface, facets, ofProfiles, params.MaximumSag * result.Tolerance), facets, best);
  result.RegionOfTriangle.resize(surface.Triangles.size());
  Report(growth, facets, best, result);
  if (params.SnapDistance > 0.0)
  {
    result.Snapped = SnapSurfaces({ { &surface.Points, &surface.Triangles, &result } },
      std::min(params.SnapDistance, result.Tolerance));
  }
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
  own.SnapDistance = std::min(params.SnapDistance, 0.0); // of all parts together
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
  if (params.SnapDistance > 0.0)
  {
    all.Snapped = SnapSurfaces(
      { { &mesh.Points, &mesh.Triangles, &all } }, std::min(params.SnapDistance, all.Tolerance));
  }
  return all;
}
}
