// SPDX-License-Identifier: BSD-3-Clause
#include "FaultPatching.h"

#include "OpenEdges.h"
#include "TrianglePairs.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>
#include <set>

namespace knotwork
{
namespace
{
constexpr double CrumbShare = 0.01; ///< of the diagonal: smaller open pieces between faults go

/// Adds the triangles around points.
void AddFans(const RepairSoup& soup, const std::set<int>& points, std::vector<char>& triangles)
{
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (const int corner : soup.Triangles[t])
    {
      triangles[t] = triangles[t] || points.count(corner) > 0 ? 1 : 0;
    }
  }
}

void Grow(const RepairSoup& soup, std::vector<char>& triangles)
{
  std::set<int> points;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    if (triangles[t])
    {
      points.insert(soup.Triangles[t].begin(), soup.Triangles[t].end());
    }
  }
  AddFans(soup, points, triangles);
}

/// Triangles of what meets, of edges of more or less than two triangles and of points of several
/// fans.
std::vector<char> FindFaults(const RepairSoup& soup, int threads)
{
  std::vector<char> faults = FindDegenerate(soup.Points, soup.Triangles, threads);
  if (std::none_of(faults.begin(), faults.end(), [](char is) { return is != 0; }))
  {
    for (const auto& [s, t] : FindIntersections(soup.Points, soup.Triangles, threads))
    {
      faults[static_cast<std::size_t>(s)] = 1;
      faults[static_cast<std::size_t>(t)] = 1;
    }
  }
  const SoupDefects defects = soup.Defects();
  std::set<int> points(defects.SplitPoints.begin(), defects.SplitPoints.end());
  for (const auto* edges : { &defects.OpenEdges, &defects.CrowdedEdges, &defects.TwistedEdges })
  {
    for (const auto& [a, b] : *edges)
    {
      points.insert({ a, b });
    }
  }
  AddFans(soup, points, faults);
  return faults;
}

/// Adds open parts that are smaller than the result may be off.
void AddCrumbs(const RepairSoup& soup, double most, std::vector<char>& crumbs)
{
  int count = 0;
  const std::vector<int> parts = NumberParts(soup.Triangles, false, count);
  std::vector<Eigen::AlignedBox3d> boxes(static_cast<std::size_t>(count));
  std::vector<char> isOpen(static_cast<std::size_t>(count), 0);
  ForEachEdge(SortedSides(soup.Triangles),
    [&](const SoupSide* begin, const SoupSide* end)
    {
      const auto part = static_cast<std::size_t>(parts[static_cast<std::size_t>(begin->Triangle)]);
      isOpen[part] |= end - begin == 1 ? 1 : 0;
    });
  for (std::size_t t = 0; t < parts.size(); ++t)
  {
    for (const int corner : soup.Triangles[t])
    {
      boxes[static_cast<std::size_t>(parts[t])].extend(soup.Point(corner));
    }
  }
  for (std::size_t t = 0; t < parts.size(); ++t)
  {
    const auto part = static_cast<std::size_t>(parts[t]);
    if (isOpen[part] && boxes[part].diagonal().norm() <= most)
    {
      crumbs[t] = 1;
    }
  }
}

/// Takes triangles away, so that rims of single fans stay, and small open pieces that are left.
RepairSoup TakeAway(RepairSoup& soup, double crumb, const std::vector<char>& faults)
{
  RepairSoup gone = soup;
  gone.Filter([&](int t) { return faults[static_cast<std::size_t>(t)] != 0; });
  const auto drop = [&](const std::vector<char>& triangles)
  {
    for (std::size_t t = 0; t < triangles.size(); ++t)
    {
      if (triangles[t])
      {
        gone.Triangles.push_back(soup.Triangles[t]);
        gone.Sources.push_back(soup.Sources[t]);
      }
    }
    soup.Filter([&](int t) { return !triangles[static_cast<std::size_t>(t)]; });
  };
  soup.Filter([&](int t) { return !faults[static_cast<std::size_t>(t)]; });
  for (;;)
  {
    std::vector<char> more(soup.Triangles.size(), 0);
    const SoupDefects defects = soup.Defects();
    AddFans(soup, { defects.SplitPoints.begin(), defects.SplitPoints.end() }, more);
    AddCrumbs(soup, crumb, more);
    if (std::none_of(more.begin(), more.end(), [](char is) { return is != 0; }))
    {
      return gone;
    }
    drop(more);
  }
}

/// Closes all holes with triangles that come from the nearest ones that went.
void Patch(RepairSoup& soup, const RepairSoup& gone, OngoingRepair& repair)
{
  const std::size_t before = soup.Triangles.size();
  const SoupDefects defects = soup.Defects();
  const std::map<std::pair<int, int>, int> apexes = ApexesOf(soup, defects);
  for (std::vector<int>& rim : TraceRims(soup.Triangles, defects))
  {
    const Eigen::Vector3d middle = MiddleOfRim(soup, rim);
    const double diameter = DiagonalOf(soup.Points, rim);
    if (FillHole(soup, rim, apexes))
    {
      repair.Add(RepairKind::Patch, middle, diameter);
    }
  }
  for (std::size_t t = before; t < soup.Triangles.size(); ++t)
  {
    const Eigen::Vector3d middle = soup.MiddleOf(static_cast<int>(t));
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t g = 0; g < gone.Triangles.size(); ++g)
    {
      const double squared = (gone.MiddleOf(static_cast<int>(g)) - middle).squaredNorm();
      if (squared < nearest)
      {
        nearest = squared;
        soup.Sources[t] = gone.Sources[g];
      }
    }
  }
}
}

bool PatchFaults(RepairSoup& soup, OngoingRepair& repair)
{
  const double crumb = std::min(repair.Params.Limit, CrumbShare) * repair.Diagonal;
  constexpr int MostRounds = 16;
  constexpr int RoundsOfARing = 2; // that are tried with so much around the faults
  for (int round = 0; round < MostRounds && repair.GoesOn(); ++round)
  {
    std::vector<char> faults = FindFaults(soup, repair.Params.Threads);
    if (std::none_of(faults.begin(), faults.end(), [](char is) { return is != 0; }))
    {
      return true;
    }
    for (int ring = 0; ring < round / RoundsOfARing; ++ring)
    {
      Grow(soup, faults);
    }
    const RepairSoup gone = TakeAway(soup, crumb, faults);
    Patch(soup, gone, repair);
  }
  return false;
}
}
