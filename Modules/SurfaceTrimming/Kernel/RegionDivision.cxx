// SPDX-License-Identifier: BSD-3-Clause
#include "RegionDivision.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace knotwork
{
namespace
{
/// Of the cost of a cluster where it is: less beside it, and it goes over.
constexpr double BetterShare = 0.5;
constexpr int BorderPasses = 6;
constexpr double LargestTurn = 1.0471975511965976; // 60 degrees
constexpr std::size_t FirstRegions = 200;
/// Of the clusters of a region that becomes one with another: those that go elsewhere.
constexpr double LargestShareLeft = 0.25;

/// What says where slivers belong: flat ones, all points of which are on the rim of a fillet beside
/// their face, lie on the fillet, too. Finds what it needs when it is asked.
class SliverEvidence
{
public:
  SliverEvidence(const SurfaceGrowth& growth, const FacetClusters& facets, const Division& division)
    : Growth(growth), Facets(facets), Regions(division.Regions),
      RegionOfCluster(division.RegionOfCluster), Near(division.Regions.size(), -1.0)
  {
  }

  /// Whether other clusters of a region have all points of a cluster: how far these are from its
  /// surface says nothing about the cluster then.
  bool HasAllOf(int cluster, int region)
  {
    if (this->PointsInRegions.empty())
    {
      for (std::size_t c = 0; c < this->Facets.Clusters.size(); ++c)
      {
        for (const int point : this->Facets.Clusters[c].Points)
        {
          this->PointsInRegions.emplace_back(point, this->RegionOfCluster[c]);
        }
      }
      std::sort(this->PointsInRegions.begin(), this->PointsInRegions.end());
    }
    const bool isOwn = this->RegionOfCluster[static_cast<std::size_t>(cluster)] == region;
    const auto& points = this->Facets.Clusters[static_cast<std::size_t>(cluster)].Points;
    return std::all_of(points.begin(), points.end(),
      [&](int point)
      {
        const auto [begin, end] = std::equal_range(
          this->PointsInRegions.begin(), this->PointsInRegions.end(), std::pair(point, region));
        return end - begin > (isOwn ? 1 : 0);
      });
  }

  /// Whether a sliver is one of a flat region: its longest side is there, and its points are as far
  /// from the plane as the region's.
  bool IsOfPlane(int cluster, int number)
  {
    const GrownRegion& region = this->Regions[static_cast<std::size_t>(number)];
    if (region.Surface.Type != SurfaceType::Plane || !this->Growth.IsSliver(cluster))
    {
      return false;
    }
    const auto& sides = this->Facets.Sides[static_cast<std::size_t>(cluster)];
    const auto longest = std::max_element(sides.begin(), sides.end(),
      [&](const ClusterSide& a, const ClusterSide& b)
      { return this->Growth.LengthOf(a) < this->Growth.LengthOf(b); });
    if (longest == sides.end() ||
      this->RegionOfCluster[static_cast<std::size_t>(longest->Cluster)] != number)
    {
      return false;
    }
    double& near = this->Near[static_cast<std::size_t>(number)];
    near = near < 0.0 ? MostDeviations * this->Growth.Residuals(region)[1] : near;
    return this->Growth.IsWithin(cluster, region.Surface, near);
  }

private:
  static constexpr double MostDeviations = 3.0;

  const SurfaceGrowth& Growth;
  const FacetClusters& Facets;
  const std::vector<GrownRegion>& Regions;
  const std::vector<int> RegionOfCluster;           ///< as they were
  std::vector<std::pair<int, int>> PointsInRegions; ///< of every cluster's points, ascending
  std::vector<double> Near;                         ///< of regions; -1: not known yet
};

/// The region that a cluster goes over to, or its own.
int BetterRegion(int cluster, const SurfaceGrowth& growth, const FacetClusters& facets,
  SliverEvidence& slivers, const Division& division)
{
  const auto c = static_cast<std::size_t>(cluster);
  const int from = division.RegionOfCluster[c];
  const auto& own = division.Regions[static_cast<std::size_t>(from)];
  double least = BetterShare * growth.Cost(cluster, own.Surface);
  int to = from;
  for (const ClusterSide& side : facets.Sides[c])
  {
    const int other = division.RegionOfCluster[static_cast<std::size_t>(side.Cluster)];
    const auto& region = division.Regions[static_cast<std::size_t>(other)];
    if (other == to || !(side.Angle < LargestTurn))
    {
      continue;
    }
    const bool belongs = slivers.IsOfPlane(cluster, other) && slivers.HasAllOf(cluster, from);
    const double cost = growth.Cost(cluster, region.Surface);
    if ((!belongs && !(cost < least)) || !growth.Fits(cluster, region.Surface, region.Reversed))
    {
      continue;
    }
    if (belongs)
    {
      return other;
    }
    if (!slivers.IsOfPlane(cluster, from) || !slivers.HasAllOf(cluster, other))
    {
      least = cost;
      to = other;
    }
  }
  return to;
}

/// Clusters beside another region go over to it where they lie on it much better: what was grown
/// first has taken what lies within the noise, as the first strips of a fillet.
/// @return whether any did; the surfaces are fitted again then.
bool MoveClusters(const SurfaceGrowth& growth, const FacetClusters& facets, Division& division)
{
  SliverEvidence slivers(growth, facets, division);
  std::vector<char> changed(division.Regions.size(), 0);
  bool any = false;
  for (std::size_t c = 0; c < facets.Clusters.size(); ++c)
  {
    const int from = division.RegionOfCluster[c];
    const int to = BetterRegion(static_cast<int>(c), growth, facets, slivers, division);
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

/// For every cluster a region beside it that it fits, but two.
/// @return fewer, if one has none.
std::vector<int> RegionsBeside(const std::vector<int>& clusters, const SurfaceGrowth& growth,
  const FacetClusters& facets, const std::array<int, 2>& without, const Division& division)
{
  std::vector<int> found;
  for (const int cluster : clusters)
  {
    for (const ClusterSide& side : facets.Sides[static_cast<std::size_t>(cluster)])
    {
      const int number = division.RegionOfCluster[static_cast<std::size_t>(side.Cluster)];
      const GrownRegion& region = division.Regions[static_cast<std::size_t>(number)];
      if (std::find(without.begin(), without.end(), number) == without.end() &&
        growth.Fits(cluster, region.Surface, region.Reversed))
      {
        found.push_back(number);
        break;
      }
    }
  }
  return found;
}

/// Of the middles of edges and triangles from a surface.
double SagOf(
  const SurfaceGrowth& growth, const std::vector<int>& clusters, const AnalyticSurface& surface)
{
  GrownRegion region;
  region.Clusters = clusters;
  region.Surface = surface;
  double distance = 0.0;
  double sag = 0.0;
  growth.Measure(region, distance, sag);
  return sag;
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
}

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

void TakeWideTriangles(const DiscMesh& surface, const FacetClusters& facets,
  const SurfaceGrowth& growth, double noise, Division& division)
{
  const auto isTriangle = [&](int c)
  { return facets.Clusters[static_cast<std::size_t>(c)].Triangles.size() == 1; };
  for (bool any = true; any;)
  {
    any = false;
    for (std::size_t c = 0; c < facets.Clusters.size(); ++c)
    {
      GrownRegion& own = division.Regions[static_cast<std::size_t>(division.RegionOfCluster[c])];
      const bool isSingle = own.Clusters.size() == 1;
      const bool isPair = own.Surface.Type == SurfaceType::Plane && own.NumPoints <= PointsOfFacet;
      if (!(isSingle || isPair) ||
        !std::all_of(own.Clusters.begin(), own.Clusters.end(), isTriangle))
      {
        continue;
      }
      for (const ClusterSide& side : facets.Sides[c])
      {
        const int other = division.RegionOfCluster[static_cast<std::size_t>(side.Cluster)];
        GrownRegion& region = division.Regions[static_cast<std::size_t>(other)];
        if (&region != &own && region.Clusters.size() > 1 && IsCurved(region.Surface.Type) &&
          std::all_of(own.Clusters.begin(), own.Clusters.end(),
            [&](int cluster)
            {
              return LiesOn(surface, facets.Clusters[static_cast<std::size_t>(cluster)],
                region.Surface, region.Reversed, noise);
            }) &&
          (isSingle ||
            SagOf(growth, own.Clusters, region.Surface) <=
              SagOf(growth, region.Clusters, region.Surface) + noise))
        {
          for (const int cluster : own.Clusters)
          {
            region.Clusters.push_back(cluster);
            division.RegionOfCluster[static_cast<std::size_t>(cluster)] = other;
          }
          own.Clusters.clear();
          any = true;
          break;
        }
      }
    }
  }
}

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
    const double far = SagOf(growth, { largest }, own.Surface) / MuchNearer;
    std::map<int, int> moves; // cluster and region
    const auto regionBeside = [&](int c)
    {
      for (const ClusterSide& side : facets.Sides[static_cast<std::size_t>(c)])
      {
        const auto moved = moves.find(side.Cluster);
        const int other = moved != moves.end()
          ? moved->second
          : division.RegionOfCluster[static_cast<std::size_t>(side.Cluster)];
        const GrownRegion& beside = division.Regions[static_cast<std::size_t>(other)];
        if (static_cast<std::size_t>(other) != r && side.Angle < LargestTurn &&
          IsCurved(beside.Surface.Type) && beside.NumPoints > own.NumPoints &&
          middleFrom(c, beside.Surface) < far && growth.Fits(c, beside.Surface, beside.Reversed))
        {
          return other;
        }
      }
      return -1;
    };
    for (std::size_t before = 1; before != moves.size();) // a strip is several facets, too
    {
      before = moves.size();
      for (const int c : own.Clusters)
      {
        const int to = c == largest || moves.count(c) > 0 ? -1 : regionBeside(c);
        if (to >= 0)
        {
          moves.emplace(c, to);
        }
      }
    }
    GrownRegion flat = own;
    flat.Clusters = { largest };
    for (const int c : own.Clusters)
    {
      if (c != largest && moves.count(c) == 0)
      {
        flat.Clusters.push_back(c);
      }
    }
    // noise parts a flat face into several facets
    if (moves.empty() ||
      (flat.Clusters.size() > 1 && !growth.FitType(SurfaceType::Plane, {}, flat)))
    {
      continue;
    }
    for (const auto& [c, to] : moves)
    {
      division.RegionOfCluster[static_cast<std::size_t>(c)] = to;
      division.Regions[static_cast<std::size_t>(to)].Clusters.push_back(c);
    }
    division.Regions[r] = std::move(flat);
  }
}

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
      // with noise a few may be those of a third region: the first strips of a fillet
      const auto notOn =
        std::stable_partition(other.Clusters.begin(), other.Clusters.end(), liesOn(region));
      const std::vector<int> left(notOn, other.Clusters.end());
      const std::vector<int> homes = RegionsBeside(left, growth, facets, { to, from }, division);
      const bool isMost = LargestShareLeft * static_cast<double>(other.Clusters.size()) >=
        static_cast<double>(left.size());
      if (homes.size() < left.size() || !isMost || (exact && !left.empty()))
      {
        continue;
      }
      GrownRegion joined = region;
      joined.Clusters.insert(joined.Clusters.end(), other.Clusters.begin(), notOn);
      growth.Refit(joined);
      if (std::all_of(joined.Clusters.begin(), joined.Clusters.end(), liesOn(joined)))
      {
        for (auto cluster = other.Clusters.begin(); cluster != notOn; ++cluster)
        {
          division.RegionOfCluster[static_cast<std::size_t>(*cluster)] = to;
        }
        for (std::size_t i = 0; i < left.size(); ++i)
        {
          division.RegionOfCluster[static_cast<std::size_t>(left[i])] = homes[i];
          division.Regions[static_cast<std::size_t>(homes[i])].Clusters.push_back(left[i]);
        }
        other.Clusters.clear();
        region = std::move(joined);
      }
    }
  }
}

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

void Reconsider(const SurfaceGrowth& growth, const FacetClusters& facets, Division& division)
{
  const std::vector<int> inside =
    CountPointsInside(facets, division.RegionOfCluster, division.Regions.size());
  for (std::size_t r = 0; r < division.Regions.size(); ++r)
  {
    growth.Reconsider(inside[r] == 0, division.Regions[r]);
  }
}

void MoveBorders(const SurfaceGrowth& growth, const FacetClusters& facets, Division& division)
{
  for (int pass = 0; pass < BorderPasses && MoveClusters(growth, facets, division); ++pass)
  {
  }
  DropEmpty(division);
}
}
