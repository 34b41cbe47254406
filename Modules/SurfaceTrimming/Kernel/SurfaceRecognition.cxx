// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceRecognition.h"

#include "FacetClusters.h"
#include "FreeShape.h"
#include "JoinRegions.h"
#include "SnapSurfaces.h"
#include "SurfaceGrowth.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
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
/// Of both levels of noise pieces are joined within the tolerance: what is less then is no chance.
constexpr double WorthItWithNoise = 0.95;
/// Of the cost of a cluster where it is: less beside it, and it goes over.
constexpr double BetterShare = 0.5;
constexpr int BorderPasses = 6;
constexpr double LargestTurn = 1.0471975511965976; // 60 degrees
/// Of a curved surface at least, for each of its parameters.
constexpr int PointsOfParameter = 5;
constexpr int PointsOfFacet = 4; ///< of a plane that says little
/// A torus has the curvatures of any surface at a point: its normals must turn by that, radians.
constexpr double SpreadOfTorus = 0.5235987755982988; // 30 degrees from their mean
/// Between regions of one free form at most, radians.
constexpr double SmoothAngle = 0.6981317007977318; // 40 degrees
/// Surfaces of parts of one are so far apart, in the noise of their points, where that is little:
/// up to this level.
constexpr double NearEnough = 3.0;
constexpr std::size_t LastOfExact = 2;
constexpr std::size_t MostToJoin = 1000; ///< more are pieces of a free shape

struct Division
{
  std::vector<GrownRegion> Regions;
  std::vector<int> RegionOfCluster;
};

/// When a division stops, and leaves clusters without a region.
struct DivisionLimits
{
  std::size_t Most = std::numeric_limits<std::size_t>::max(); ///< regions
  /// Whether the first regions, of the largest facets, must cover half of the area: those of
  /// machined parts do, those of free shapes cover little each.
  bool CoversSoon = false;
};
constexpr std::size_t FirstRegions = 200;

Division Divide(
  const SurfaceGrowth& growth, const FacetClusters& facets, const DivisionLimits& limits)
{
  Division division;
  double covered = 0.0;
  double area = 0.0;
  for (const FacetCluster& cluster : facets.Clusters)
  {
    area += cluster.Area;
  }
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
    if (division.Regions.size() >= limits.Most ||
      (limits.CoversSoon && division.Regions.size() == FirstRegions && covered < 0.5 * area))
    {
      break;
    }
    GrownRegion region = growth.BestRegion(seed, division.RegionOfCluster);
    for (int cluster : region.Clusters)
    {
      division.RegionOfCluster[static_cast<std::size_t>(cluster)] =
        static_cast<int>(division.Regions.size());
      covered += facets.Clusters[static_cast<std::size_t>(cluster)].Area;
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

bool IsCurved(SurfaceType type)
{
  return type != SurfaceType::Plane && type != SurfaceType::FreeForm;
}

/// Whether all points of a cluster lie on a surface, and it does not lean away from it.
bool LiesOn(const DiscMesh& surface, const FacetCluster& cluster, const AnalyticSurface& on,
  bool reversed, double noise)
{
  const Eigen::Vector3d normal = on.Normal(cluster.Piece.Centre) * (reversed ? -1.0 : 1.0);
  return normal.dot(cluster.Piece.Normal) >= std::cos(LargestTurn) &&
    std::all_of(cluster.Points.begin(), cluster.Points.end(),
      [&](int point) { return std::abs(on.Distance(surface.Point(point))) <= noise; });
}

/// Triangles that are planes of their own for they sag too much, and whose corners lie on the
/// surface of a neighbour, go over to it: wide triangles between the holes of a cylinder.
void TakeWideTriangles(
  const DiscMesh& surface, const FacetClusters& facets, double noise, Division& division)
{
  for (bool any = true; any;)
  {
    any = false;
    for (std::size_t c = 0; c < facets.Clusters.size(); ++c)
    {
      const FacetCluster& cluster = facets.Clusters[c];
      GrownRegion& own = division.Regions[static_cast<std::size_t>(division.RegionOfCluster[c])];
      if (cluster.Triangles.size() > 1 || own.Clusters.size() > 1)
      {
        continue;
      }
      for (const ClusterSide& side : facets.Sides[c])
      {
        const int other = division.RegionOfCluster[static_cast<std::size_t>(side.Cluster)];
        GrownRegion& region = division.Regions[static_cast<std::size_t>(other)];
        if (&region != &own && region.Clusters.size() > 1 && IsCurved(region.Surface.Type) &&
          LiesOn(surface, cluster, region.Surface, region.Reversed, noise))
        {
          region.Clusters.push_back(static_cast<int>(c));
          own.Clusters.clear();
          division.RegionOfCluster[c] = other;
          any = true;
          break;
        }
      }
    }
  }
}

/// Planes of four points say nothing where these are as near to the surface beside them as its own:
/// single strips that seemed flat.
void TakeStrips(const FacetClusters& facets, const SurfaceGrowth& growth, Division& division)
{
  for (std::size_t c = 0; c < facets.Clusters.size(); ++c)
  {
    for (const ClusterSide& side : facets.Sides[c])
    {
      const int from = division.RegionOfCluster[c];
      const int to = division.RegionOfCluster[static_cast<std::size_t>(side.Cluster)];
      GrownRegion& own = division.Regions[static_cast<std::size_t>(from)];
      GrownRegion& region = division.Regions[static_cast<std::size_t>(to)];
      if (from != to && own.Surface.Type == SurfaceType::Plane && own.NumPoints <= PointsOfFacet &&
        IsCurved(region.Surface.Type) &&
        region.NumPoints > PointsOfParameter + NumSurfaceParameters(region.Surface.Type) &&
        std::all_of(own.Clusters.begin(), own.Clusters.end(),
          [&](int cluster) { return growth.Fits(cluster, region.Surface, region.Reversed); }))
      {
        for (const int cluster : own.Clusters)
        {
          division.RegionOfCluster[static_cast<std::size_t>(cluster)] = to;
        }
        region.Clusters.insert(region.Clusters.end(), own.Clusters.begin(), own.Clusters.end());
        own.Clusters.clear();
        growth.Refit(region);
      }
    }
  }
}

/// What is left of a curved surface when all but one facet have gone over to others is flat.
void FlattenSingles(const FacetClusters& facets, Division& division)
{
  for (GrownRegion& region : division.Regions)
  {
    if (region.Clusters.size() == 1 && region.Surface.Type != SurfaceType::FreeForm)
    {
      const FlatPiece& piece =
        facets.Clusters[static_cast<std::size_t>(region.Clusters.front())].Piece;
      region.Surface = AnalyticSurface();
      region.Surface.Type = SurfaceType::Plane;
      region.Surface.Point = piece.Centre;
      region.Surface.Axis = piece.Normal;
      region.Reversed = false;
    }
  }
}

/// Curved surfaces become planes that are no worse: noise bends what is flat. The test is Fisher's,
/// of one per cent.
void FlattenDoubtful(const SurfaceGrowth& growth, Division& division)
{
  constexpr double Significant = 7.0; // Fisher's F of one degree of freedom and many
  for (GrownRegion& region : division.Regions)
  {
    GrownRegion flat = region;
    const int parameters = NumSurfaceParameters(region.Surface.Type);
    if (!IsCurved(region.Surface.Type) || region.NumPoints <= parameters ||
      !growth.FitType(SurfaceType::Plane, {}, flat))
    {
      continue;
    }
    const double curved = growth.Squares(region.Clusters, region.Surface);
    const double freedom = region.NumPoints - parameters;
    const double more = parameters - NumSurfaceParameters(SurfaceType::Plane);
    if (growth.Squares(region.Clusters, flat.Surface) <=
      curved * (1.0 + Significant * more / freedom))
    {
      region = std::move(flat);
    }
  }
}

/// A flat face between two roundings and the first strips of both lie on one wide cylinder, too:
/// where all facets but the largest lie on larger curved regions beside it, and nearer to them by
/// much than the largest one's middle is to what it is said to lie on, they go over.
void ShareOut(const SurfaceGrowth& growth, const FacetClusters& facets, Division& division)
{
  constexpr double MuchNearer = 4.0;
  for (std::size_t r = 0; r < division.Regions.size(); ++r)
  {
    const GrownRegion& own = division.Regions[r];
    if (!IsCurved(own.Surface.Type) || own.Clusters.size() < 2)
    {
      continue;
    }
    const auto clusterOf = [&](int c) -> const FacetCluster&
    { return facets.Clusters[static_cast<std::size_t>(c)]; };
    const auto middleFrom = [&](int c, const AnalyticSurface& surface)
    { return std::abs(surface.Distance(clusterOf(c).Piece.Centre)); };
    const int largest = *std::max_element(own.Clusters.begin(), own.Clusters.end(),
      [&](int a, int b) { return clusterOf(a).Area < clusterOf(b).Area; });
    const double far = middleFrom(largest, own.Surface) / MuchNearer;
    std::vector<std::array<int, 2>> moves; // cluster and region
    for (const int c : own.Clusters)
    {
      for (const ClusterSide& side : facets.Sides[static_cast<std::size_t>(c)])
      {
        const int other = division.RegionOfCluster[static_cast<std::size_t>(side.Cluster)];
        const GrownRegion& beside = division.Regions[static_cast<std::size_t>(other)];
        if (c != largest && static_cast<std::size_t>(other) != r && side.Angle < LargestTurn &&
          IsCurved(beside.Surface.Type) && beside.NumPoints > own.NumPoints &&
          middleFrom(c, beside.Surface) < far && growth.Fits(c, beside.Surface, beside.Reversed))
        {
          moves.push_back({ c, other });
          break;
        }
      }
    }
    if (moves.size() + 1 < own.Clusters.size())
    {
      continue;
    }
    for (const auto& [c, to] : moves)
    {
      division.RegionOfCluster[static_cast<std::size_t>(c)] = to;
      division.Regions[static_cast<std::size_t>(to)].Clusters.push_back(c);
    }
    division.Regions[r].Clusters = { largest };
  }
}

/// Neighbours that are one surface become one region.
/// @param exact  whether points lie on surfaces but for rounding.
void JoinEqual(const DiscMesh& surface, const FacetClusters& facets, double noise, bool exact,
  const SurfaceGrowth& growth, Division& division)
{
  for (std::size_t c = 0; c < facets.Clusters.size(); ++c)
  {
    for (const ClusterSide& side : facets.Sides[c])
    {
      const int to = division.RegionOfCluster[c];
      const int from = division.RegionOfCluster[static_cast<std::size_t>(side.Cluster)];
      GrownRegion& region = division.Regions[static_cast<std::size_t>(to)];
      GrownRegion& other = division.Regions[static_cast<std::size_t>(from)];
      const bool isSameType = region.Surface.Type == other.Surface.Type;
      if (to == from || region.NumPoints < other.NumPoints || (!isSameType && !exact) ||
        !IsCurved(region.Surface.Type) || !IsCurved(other.Surface.Type))
      {
        continue;
      }
      // few rows of a surface lie on a simpler one, too
      if (!isSameType &&
        !std::all_of(other.Clusters.begin(), other.Clusters.end(),
          [&](int cluster) { return growth.Fits(cluster, region.Surface, region.Reversed); }))
      {
        continue;
      }
      const auto liesOn = [&](const GrownRegion& on)
      {
        return [&](int cluster)
        {
          return LiesOn(surface, facets.Clusters[static_cast<std::size_t>(cluster)], on.Surface,
            on.Reversed, noise);
        };
      };
      if (!std::all_of(other.Clusters.begin(), other.Clusters.end(), liesOn(region)))
      {
        continue;
      }
      GrownRegion joined = region;
      joined.Clusters.insert(joined.Clusters.end(), other.Clusters.begin(), other.Clusters.end());
      growth.Refit(joined);
      if (std::all_of(joined.Clusters.begin(), joined.Clusters.end(), liesOn(joined)))
      {
        for (int cluster : other.Clusters)
        {
          division.RegionOfCluster[static_cast<std::size_t>(cluster)] = to;
        }
        other.Clusters.clear();
        region = std::move(joined);
      }
    }
  }
}

/// Regions that have lost all clusters are dropped.
void DropEmpty(Division& division)
{
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

/// MoveClusters until nothing changes; regions that have lost all clusters are dropped.
void MoveBorders(const SurfaceGrowth& growth, const FacetClusters& facets, Division& division)
{
  for (int pass = 0; pass < BorderPasses && MoveClusters(growth, facets, division); ++pass)
  {
  }
  DropEmpty(division);
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
      "a "
      "free shape" };
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
    for (GrownRegion& region : division.Regions)
    {
      growth.Reconsider(region);
    }
    const bool exact = level <= LastOfExact;
    const double near = exact ? NearEnough * noise : noise;
    TakeWideTriangles(surface, facets, near, division);
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
