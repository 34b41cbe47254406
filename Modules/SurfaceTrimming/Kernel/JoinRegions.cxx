// SPDX-License-Identifier: BSD-3-Clause
#include "JoinRegions.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr double SmoothAngle = 0.6981317007977318; // 40 degrees between facets
constexpr double Exact = 0.02;                     ///< of the tolerance: distances that are none
constexpr double Doubtful = 0.1; ///< of the tolerance: points farther from their surface
constexpr int PointsOfStrip = 4; ///< of a plane that says nothing
constexpr int FewPoints = 15;    ///< three for each parameter of a cylinder: fewer say little
constexpr std::ptrdiff_t MostSeeds = 200; ///< more are pieces of a free shape
/// Sums of squares may grow by these factors: about what Fisher's test allows of pieces with few
/// degrees of freedom, and more of one that goes on into a strip.
constexpr double MostOfPieces = 2.25;
constexpr double MostBesideStrip = 4.0;
/// A profile has more parameters than its pieces: it must halve the sum of squares. With noise that
/// says little, but a profile of few spans follows no flat face and the tight rounding beside it.
constexpr double MostOfProfile = 0.5;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

bool IsPlane(const GrownRegion& region)
{
  return region.Surface.Type == SurfaceType::Plane;
}

enum class JoinKind
{
  Pieces,
  Profiles
};

class RegionJoiner
{
public:
  RegionJoiner(JoinKind kind, const SurfaceGrowth& growth, const FacetClusters& facets,
    double tolerance, std::vector<GrownRegion>& regions, std::vector<int>& regionOfCluster)
    : Kind(kind), Growth(growth), Facets(facets), Tolerance(tolerance), Regions(regions),
      RegionOfCluster(regionOfCluster)
  {
    this->IsFlat.assign(facets.Clusters.size(), 0);
    const std::vector<int> numInside = CountPointsInside(facets, regionOfCluster, regions.size());
    for (std::size_t r = 0; r < regions.size(); ++r)
    {
      const GrownRegion& region = regions[r];
      const bool isFree = region.Surface.Type == SurfaceType::FreeForm;
      const bool isPlane = IsPlane(region);
      const auto [largest, mean] =
        isFree ? std::array<double, 2>{ tolerance, tolerance } : growth.Residuals(region);
      this->Squares.push_back(mean * mean * region.NumPoints);
      const bool isFar = largest > Doubtful * tolerance;
      for (const int cluster : region.Clusters)
      {
        this->IsFlat[At(cluster)] = isPlane && region.NumPoints > PointsOfStrip && !isFar ? 1 : 0;
      }
      const bool isInexact = largest > Exact * tolerance;
      const bool isFew = region.NumPoints < FewPoints;
      const bool isDoubtful = isFar || (!isPlane && isFew && isInexact);
      // all points of a single row of facets lie in others, too, and on surfaces of many types
      const bool isVague = isDoubtful || isInexact || (!isPlane && numInside[r] == 0);
      const bool isPieces = kind == JoinKind::Pieces;
      this->IsDoubtful.push_back(isDoubtful ? 1 : 0);
      this->IsSeed.push_back((isPieces ? isVague : isDoubtful && !isPlane) ? 1 : 0);
      this->MayJoin.push_back((isPlane && isFew) || (isPieces ? isVague : isDoubtful) ? 1 : 0);
    }
  }

  void Run()
  {
    std::vector<int> order(this->Regions.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
      [&](int a, int b)
      { return this->Regions[At(a)].NumPoints > this->Regions[At(b)].NumPoints; });
    if (this->Kind == JoinKind::Profiles &&
      std::count(this->IsSeed.begin(), this->IsSeed.end(), 1) > MostSeeds)
    {
      return;
    }
    for (const int seed : order)
    {
      if (this->IsSeed[At(seed)])
      {
        this->GrowFrom(seed);
      }
    }
  }

private:
  /// Neighbours across smooth borders, those of the longest ones first.
  std::vector<int> NeighboursOf(const GrownRegion& region, int number) const
  {
    struct Border
    {
      double Smooth = 0.0;
      double All = 0.0;
    };
    std::map<int, Border> borders;
    for (const int cluster : region.Clusters)
    {
      for (const ClusterSide& side : this->Facets.Sides[At(cluster)])
      {
        const int other = this->RegionOfCluster[At(side.Cluster)];
        if (other != number && this->MayJoin[At(other)])
        {
          const double length = this->Growth.LengthOf(side);
          borders[other].All += length;
          borders[other].Smooth += side.Angle < SmoothAngle ? length : 0.0;
        }
      }
    }
    std::vector<std::pair<double, int>> found;
    for (const auto& [other, border] : borders)
    {
      if (border.Smooth > 0.5 * border.All)
      {
        found.emplace_back(-border.Smooth, other);
      }
    }
    std::sort(found.begin(), found.end());
    std::vector<int> neighbours;
    for (const auto& [length, other] : found)
    {
      neighbours.push_back(other);
    }
    return neighbours;
  }

  /// Both as parts of one surface with a profile, if they are nearer to it.
  bool JoinAlongProfile(int number, int other, GrownRegion& joined) const
  {
    double least = MostOfProfile * (this->Squares[At(number)] + this->Squares[At(other)]);
    bool any = false;
    for (const SurfaceType type : { SurfaceType::Extrusion, SurfaceType::Revolution })
    {
      GrownRegion trial = this->Regions[At(number)];
      const auto& more = this->Regions[At(other)].Clusters;
      trial.Clusters.insert(trial.Clusters.end(), more.begin(), more.end());
      if (!this->Growth.FitProfile(type, this->IsFlat, trial))
      {
        continue;
      }
      const double squares = this->Growth.Squares(trial.Clusters, trial.Surface);
      if (squares < least)
      {
        least = squares;
        joined = std::move(trial);
        any = true;
      }
    }
    return any;
  }

  double AreaOf(const GrownRegion& region) const
  {
    double area = 0.0;
    for (const int c : region.Clusters)
    {
      area += this->Facets.Clusters[At(c)].Area;
    }
    return area;
  }

  bool IsStripOf(const GrownRegion& strip, const GrownRegion& beside) const
  {
    return IsPlane(strip) && !IsPlane(beside) && strip.NumPoints < FewPoints &&
      strip.NumPoints < beside.NumPoints && this->AreaOf(strip) < this->AreaOf(beside);
  }

  /// How much the squares of a region may grow that becomes one with another.
  double MostOf(int number, int other) const
  {
    const GrownRegion& own = this->Regions[At(number)];
    const GrownRegion& beside = this->Regions[At(other)];
    if (this->IsDoubtful[At(other)] && this->IsStripOf(own, beside))
    {
      return HUGE_VAL;
    }
    if (this->IsDoubtful[At(number)] && this->IsStripOf(beside, own))
    {
      return own.NumPoints < FewPoints ? HUGE_VAL : MostBesideStrip;
    }
    return MostOfPieces;
  }

  /// Whether the points of both are about as near to a surface as to the ones that they have.
  bool IsLike(int number, int other, const AnalyticSurface& surface) const
  {
    const auto pointsOf = [&](int r) { return this->Regions[At(r)].NumPoints; };
    const double none = Exact * this->Tolerance * Exact * this->Tolerance;
    const double mean = (this->Squares[At(number)] + this->Squares[At(other)]) /
      static_cast<double>(pointsOf(number) + pointsOf(other));
    const auto isLike = [&](int r, int beside)
    {
      const double before = std::max(this->Squares[At(r)], std::max(mean, none) * pointsOf(r));
      const double most = this->MostOf(r, beside);
      return most == HUGE_VAL ||
        this->Growth.Squares(this->Regions[At(r)].Clusters, surface) <= most * before;
    };
    return isLike(number, other) && isLike(other, number);
  }

  /// Both as parts of one simple surface: of the type of the larger one, or the simplest. What is
  /// flat becomes part of a curved one as a strip only.
  bool JoinAsPieces(int number, int other, GrownRegion& joined) const
  {
    const GrownRegion& a = this->Regions[At(number)];
    const GrownRegion& b = this->Regions[At(other)];
    const bool mayCurve =
      !(IsPlane(a) || IsPlane(b)) || this->IsStripOf(a, b) || this->IsStripOf(b, a);
    const SurfaceType ofLarger = (a.NumPoints < b.NumPoints ? b : a).Surface.Type;
    for (const SurfaceType type : { ofLarger, SurfaceType::Plane, SurfaceType::Cylinder,
           SurfaceType::Sphere, SurfaceType::Cone, SurfaceType::Torus })
    {
      GrownRegion trial = a;
      trial.Clusters.insert(trial.Clusters.end(), b.Clusters.begin(), b.Clusters.end());
      if ((mayCurve || type == SurfaceType::Plane) &&
        this->Growth.FitType(type, { &a, &b }, trial) && this->IsLike(number, other, trial.Surface))
      {
        joined = std::move(trial);
        return true;
      }
    }
    return false;
  }

  void GrowFrom(int seed)
  {
    for (bool isNew = true; isNew;)
    {
      isNew = false;
      for (const int other : this->NeighboursOf(this->Regions[At(seed)], seed))
      {
        // what failed before fails again while both are what they were
        std::array<std::size_t, 2> sizes{ this->Regions[At(seed)].Clusters.size(),
          this->Regions[At(other)].Clusters.size() };
        const std::array<int, 2> pair{ std::min(seed, other), std::max(seed, other) };
        if (seed > other)
        {
          std::swap(sizes[0], sizes[1]);
        }
        if (const auto failed = this->Failed.find(pair);
            failed != this->Failed.end() && failed->second == sizes)
        {
          continue;
        }
        GrownRegion joined;
        if (!(this->Kind == JoinKind::Pieces ? this->JoinAsPieces(seed, other, joined)
                                             : this->JoinAlongProfile(seed, other, joined)))
        {
          this->Failed[pair] = sizes;
          continue;
        }
        for (const int cluster : this->Regions[At(other)].Clusters)
        {
          this->RegionOfCluster[At(cluster)] = seed;
        }
        this->Regions[At(seed)] = std::move(joined);
        this->Regions[At(other)].Clusters.clear();
        // what comes next is compared with the surfaces that there were
        this->Squares[At(seed)] += this->Squares[At(other)];
        this->MayJoin[At(other)] = 0;
        this->IsSeed[At(other)] = 0;
        isNew = true;
        break;
      }
    }
  }

  JoinKind Kind;
  const SurfaceGrowth& Growth;
  const FacetClusters& Facets;
  double Tolerance;
  std::vector<GrownRegion>& Regions;
  std::vector<int>& RegionOfCluster;
  std::vector<double> Squares; ///< sums of distances, by the surfaces that there were
  std::vector<char> IsFlat;    ///< of clusters
  std::vector<char> IsDoubtful;
  std::vector<char> IsSeed;
  std::vector<char> MayJoin;
  std::map<std::array<int, 2>, std::array<std::size_t, 2>> Failed; ///< clusters of both
};
}

void JoinPieces(const SurfaceGrowth& growth, const FacetClusters& facets, double tolerance,
  std::vector<GrownRegion>& regions, std::vector<int>& regionOfCluster)
{
  RegionJoiner(JoinKind::Pieces, growth, facets, tolerance, regions, regionOfCluster).Run();
}

void JoinAlongProfiles(const SurfaceGrowth& growth, const FacetClusters& facets, double tolerance,
  std::vector<GrownRegion>& regions, std::vector<int>& regionOfCluster)
{
  RegionJoiner(JoinKind::Profiles, growth, facets, tolerance, regions, regionOfCluster).Run();
}
}
