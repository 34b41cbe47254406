// SPDX-License-Identifier: BSD-3-Clause
#include "ProfileRegions.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr double SmoothAngle = 0.6981317007977318; // 40 degrees between facets
constexpr double Doubtful = 0.1; ///< of the tolerance: points farther from their surface
constexpr int PointsOfStrip = 4; ///< of a plane that says nothing
constexpr int FewPoints = 15;    ///< of a plane that may be a strip of something
/// Of the root mean square distance. With noise it says little, but a profile of few spans follows
/// no flat face and the tight rounding beside it.
constexpr double Nearer = 0.95;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

constexpr std::ptrdiff_t MostSeeds = 200; ///< more are pieces of a free shape

class ProfileJoiner
{
public:
  ProfileJoiner(const SurfaceGrowth& growth, const FacetClusters& facets, double tolerance,
    std::vector<GrownRegion>& regions, std::vector<int>& regionOfCluster)
    : Growth(growth), Facets(facets), Regions(regions), RegionOfCluster(regionOfCluster)
  {
    this->IsFlat.assign(facets.Clusters.size(), 0);
    for (const GrownRegion& region : regions)
    {
      const bool isFree = region.Surface.Type == SurfaceType::FreeForm;
      const auto [largest, mean] =
        isFree ? std::array<double, 2>{ tolerance, tolerance } : growth.Residuals(region);
      this->Squares.push_back(mean * mean * region.NumPoints);
      const bool isDoubtful = largest > Doubtful * tolerance;
      const bool isFlat = region.Surface.Type == SurfaceType::Plane &&
        region.NumPoints > PointsOfStrip && !isDoubtful;
      for (const int cluster : region.Clusters)
      {
        this->IsFlat[At(cluster)] = isFlat ? 1 : 0;
      }
      const bool isStrip =
        region.Surface.Type == SurfaceType::Plane && region.NumPoints < FewPoints;
      this->IsSeed.push_back(isDoubtful && region.Surface.Type != SurfaceType::Plane ? 1 : 0);
      this->MayJoin.push_back(isDoubtful || isStrip ? 1 : 0);
    }
  }

  void Run()
  {
    std::vector<int> order(this->Regions.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
      [&](int a, int b)
      { return this->Regions[At(a)].NumPoints > this->Regions[At(b)].NumPoints; });
    if (std::count(this->IsSeed.begin(), this->IsSeed.end(), 1) > MostSeeds)
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
  bool Join(int number, int other, GrownRegion& joined) const
  {
    const double before = this->Squares[At(number)] + this->Squares[At(other)];
    double least = Nearer * Nearer * before;
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
      const double mean = this->Growth.Residuals(trial)[1];
      const double squares = mean * mean * trial.NumPoints;
      if (squares < least)
      {
        least = squares;
        joined = std::move(trial);
        any = true;
      }
    }
    return any;
  }

  void GrowFrom(int seed)
  {
    for (bool isNew = true; isNew;)
    {
      isNew = false;
      for (const int other : this->NeighboursOf(this->Regions[At(seed)], seed))
      {
        GrownRegion joined;
        if (!this->Join(seed, other, joined))
        {
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

  const SurfaceGrowth& Growth;
  const FacetClusters& Facets;
  std::vector<GrownRegion>& Regions;
  std::vector<int>& RegionOfCluster;
  std::vector<double> Squares; ///< sums of distances, by the surfaces that there were
  std::vector<char> IsFlat;    ///< of clusters
  std::vector<char> IsSeed;
  std::vector<char> MayJoin;
};
}

void JoinAlongProfiles(const SurfaceGrowth& growth, const FacetClusters& facets, double tolerance,
  std::vector<GrownRegion>& regions, std::vector<int>& regionOfCluster)
{
  ProfileJoiner(growth, facets, tolerance, regions, regionOfCluster).Run();
}
}
