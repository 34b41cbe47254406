// SPDX-License-Identifier: BSD-3-Clause
#include "FeatureRegions.h"

#include <knotwork/SplineCore/DisjointSets.h>

#include <algorithm>
#include <map>
#include <set>

namespace knotwork
{
namespace
{
constexpr double LeastAngle = 1.0; // degrees: edges are no blunter than that
constexpr double TieShare = 1e-9;  // of a joint: others are as good, and rounding decides nothing

struct Region
{
  RegionSums Sums;
  bool IsSmall = false;
  std::map<int, double> Joints; ///< by the other region: sum of length over angle
};
}

void RegionSums::Add(const RegionSums& other)
{
  this->Area += other.Area;
  this->Patches += other.Patches;
  this->HasKnown = this->HasKnown || other.HasKnown;
  this->AllBand = this->AllBand && other.AllBand;
}

int JoinRegions(const SurfaceParts& parts, const EdgeAngle& angle, const RegionLabels& labels,
  const std::vector<RegionSums>& sums, const std::function<bool(const RegionSums&)>& isSmall,
  const EdgeMarks& kept, EdgeMarks& marks)
{
  std::vector<Region> regions(static_cast<std::size_t>(labels.Count));
  VisitInnerEdges(parts,
    [&](std::size_t t, std::size_t k)
    {
      const int a = labels.Of[t];
      const int b = labels.Of[static_cast<std::size_t>(parts.Adjacency.Triangle[t][k])];
      if (a != b && !kept(t, k))
      {
        const double joint = parts.SideLength(t, k) / std::max(angle(t, k), LeastAngle);
        regions[static_cast<std::size_t>(a)].Joints[b] += joint;
        regions[static_cast<std::size_t>(b)].Joints[a] += joint;
      }
    });
  std::set<std::pair<double, int>> small;
  for (std::size_t r = 0; r < regions.size(); ++r)
  {
    regions[r].Sums = sums[r];
    regions[r].IsSmall = isSmall(sums[r]);
    if (regions[r].IsSmall)
    {
      small.emplace(sums[r].Area, static_cast<int>(r));
    }
  }
  DisjointSets sets(labels.Count);
  int joined = 0;
  while (!small.empty())
  {
    const int from = small.begin()->second;
    small.erase(small.begin());
    Region& region = regions[static_cast<std::size_t>(from)];
    region.IsSmall = false;
    int to = -1;
    double most = 0.0;
    for (const auto& [other, joint] : region.Joints)
    {
      if (joint > (1.0 + TieShare) * most)
      {
        most = joint;
        to = other;
      }
    }
    if (to < 0)
    {
      continue;
    }
    ++joined;
    // the result has the smaller number, which the sets' representative has too
    const int all = std::min(from, to);
    const int gone = std::max(from, to);
    Region& whole = regions[static_cast<std::size_t>(all)];
    Region& part = regions[static_cast<std::size_t>(gone)];
    if (regions[static_cast<std::size_t>(to)].IsSmall)
    {
      small.erase({ regions[static_cast<std::size_t>(to)].Sums.Area, to });
    }
    whole.Sums.Add(part.Sums);
    whole.Joints.erase(gone);
    part.Joints.erase(all);
    for (const auto& [other, joint] : part.Joints)
    {
      whole.Joints[other] += joint;
      auto& back = regions[static_cast<std::size_t>(other)].Joints;
      back.erase(gone);
      back[all] += joint;
    }
    part.Joints.clear();
    sets.Unite(all, gone);
    whole.IsSmall = isSmall(whole.Sums);
    if (whole.IsSmall)
    {
      small.emplace(whole.Sums.Area, all);
    }
  }
  VisitInnerEdges(parts,
    [&](std::size_t t, std::size_t k)
    {
      const int a = labels.Of[t];
      const int b = labels.Of[static_cast<std::size_t>(parts.Adjacency.Triangle[t][k])];
      if (a != b && sets.Find(a) == sets.Find(b) && !kept(t, k))
      {
        marks.Set(t, k, false);
      }
    });
  return joined;
}
}
