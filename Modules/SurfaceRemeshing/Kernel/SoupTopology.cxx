// SPDX-License-Identifier: BSD-3-Clause
#include "SoupTopology.h"

#include <knotwork/SplineCore/DisjointSets.h>

#include <Eigen/Geometry>

#include <map>
#include <set>
#include <tuple>

namespace knotwork
{
std::vector<SoupSide> SortedSides(const std::vector<MeshTriangle>& triangles)
{
  std::vector<SoupSide> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const int a = triangles[t][k];
      const int b = triangles[t][(k + 1) % 3];
      sides.push_back({ std::min(a, b), std::max(a, b), static_cast<int>(t), a < b });
    }
  }
  std::sort(sides.begin(), sides.end(),
    [](const SoupSide& a, const SoupSide& b)
    {
      return std::tie(a.First, a.Second, a.Triangle, a.Forward) <
        std::tie(b.First, b.Second, b.Triangle, b.Forward);
    });
  return sides;
}

SoupDefects FindDefects(const std::vector<MeshTriangle>& triangles, Eigen::Index numPoints)
{
  SoupDefects defects;
  const auto cornerOf = [&](int t, int point)
  {
    const MeshTriangle& corners = triangles[static_cast<std::size_t>(t)];
    return 3 * t + (corners[0] == point ? 0 : corners[1] == point ? 1 : 2);
  };
  DisjointSets fans(3 * static_cast<int>(triangles.size()));
  ForEachEdge(SortedSides(triangles),
    [&](const SoupSide* begin, const SoupSide* end)
    {
      const auto count = end - begin;
      const auto forward =
        std::count_if(begin, end, [](const SoupSide& side) { return side.Forward; });
      const std::pair<int, int> edge(begin->First, begin->Second);
      if (count == 1)
      {
        defects.OpenEdges.push_back(
          begin->Forward ? edge : std::make_pair(edge.second, edge.first));
      }
      else if (2 * forward != count)
      {
        defects.TwistedEdges.push_back(edge);
      }
      if (count > 2)
      {
        defects.CrowdedEdges.push_back(edge);
      }
      for (const SoupSide* side = begin + 1; side < end; ++side)
      {
        for (const int point : { edge.first, edge.second })
        {
          fans.Unite(cornerOf(begin->Triangle, point), cornerOf(side->Triangle, point));
        }
      }
    });
  std::vector<int> fanOfPoint(static_cast<std::size_t>(numPoints), -1);
  std::set<int> split;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      int& fan = fanOfPoint[static_cast<std::size_t>(triangles[t][k])];
      const int own = fans.Find(static_cast<int>(3 * t + k));
      fan = fan < 0 ? own : fan;
      if (fan != own)
      {
        split.insert(triangles[t][k]);
      }
    }
  }
  defects.SplitPoints.assign(split.begin(), split.end());
  return defects;
}

std::vector<int> NumberParts(
  const std::vector<MeshTriangle>& triangles, bool throughCrowded, int& count)
{
  DisjointSets sets(static_cast<int>(triangles.size()));
  ForEachEdge(SortedSides(triangles),
    [&](const SoupSide* begin, const SoupSide* end)
    {
      for (const SoupSide* side = begin + 1; side < end && (throughCrowded || end - begin == 2);
           ++side)
      {
        sets.Unite(begin->Triangle, side->Triangle);
      }
    });
  std::map<int, int> numbers;
  std::vector<int> parts;
  parts.reserve(triangles.size());
  for (int t = 0; t < sets.Size(); ++t)
  {
    parts.push_back(numbers.emplace(sets.Find(t), static_cast<int>(numbers.size())).first->second);
  }
  count = static_cast<int>(numbers.size());
  return parts;
}

std::pair<int, int> OrientTriangles(std::vector<MeshTriangle>& triangles, std::vector<int>& turned)
{
  SignedSets sets(static_cast<int>(triangles.size()));
  std::pair<int, int> oneSided(-1, -1);
  ForEachEdge(SortedSides(triangles),
    [&](const SoupSide* begin, const SoupSide* end)
    {
      if (end - begin == 2 &&
        !sets.Unite(begin->Triangle, begin[1].Triangle, begin->Forward == begin[1].Forward))
      {
        oneSided = { begin->First, begin->Second };
      }
    });
  if (oneSided.first >= 0)
  {
    return oneSided;
  }
  std::map<int, int> balance; // triangles of a patch that run as its first one, less the others
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
  {
    balance[sets.Find(t)] += sets.IsTurned(t) ? -1 : 1;
  }
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
  {
    if (sets.IsTurned(t) == (balance[sets.Find(t)] >= 0))
    {
      std::swap(
        triangles[static_cast<std::size_t>(t)][1], triangles[static_cast<std::size_t>(t)][2]);
      turned.push_back(t);
    }
  }
  return oneSided;
}

std::vector<std::vector<int>> TraceRims(
  const std::vector<MeshTriangle>& triangles, const SoupDefects& defects)
{
  // an open edge is followed by the one of the same fan
  std::map<std::pair<int, int>, int> apexes; // third corners by directed edges
  for (const MeshTriangle& corners : triangles)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      apexes[{ corners[k], corners[(k + 1) % 3] }] = corners[(k + 2) % 3];
    }
  }
  std::set<std::pair<int, int>> open(defects.OpenEdges.begin(), defects.OpenEdges.end());
  const auto next = [&](std::pair<int, int> edge)
  {
    // around edge.second through the triangles, until there is none
    int apex = apexes.at(edge);
    for (std::size_t step = 0; step <= triangles.size(); ++step)
    {
      const auto found = apexes.find({ edge.second, apex });
      if (open.count({ edge.second, apex }) > 0)
      {
        return std::make_pair(edge.second, apex);
      }
      const auto across = apexes.find({ apex, edge.second });
      if (found == apexes.end() || across == apexes.end())
      {
        break;
      }
      apex = across->second;
    }
    return std::make_pair(-1, -1);
  };
  std::vector<std::vector<int>> rims;
  while (!open.empty())
  {
    const std::pair<int, int> first = *open.begin();
    std::vector<int> rim;
    std::pair<int, int> edge = first;
    do
    {
      rim.push_back(edge.first);
      const std::pair<int, int> following = next(edge);
      if (edge != first)
      {
        open.erase(edge);
      }
      edge = following;
    } while (edge != first && edge.first >= 0);
    open.erase(first);
    if (edge == first)
    {
      rims.push_back(std::move(rim));
    }
  }
  return rims;
}

double SignedVolume(const PointMatrix& points, const std::vector<MeshTriangle>& triangles)
{
  if (triangles.empty())
  {
    return 0.0;
  }
  const Eigen::RowVector3d origin = points.row(triangles.front()[0]);
  double volume = 0.0;
  for (const MeshTriangle& t : triangles)
  {
    const Eigen::Vector3d a = (points.row(t[0]) - origin).transpose();
    const Eigen::Vector3d b = (points.row(t[1]) - origin).transpose();
    const Eigen::Vector3d c = (points.row(t[2]) - origin).transpose();
    volume += a.dot(b.cross(c)) / 6.0;
  }
  return volume;
}

int EulerNumber(const std::vector<MeshTriangle>& triangles)
{
  std::set<int> points;
  for (const MeshTriangle& corners : triangles)
  {
    points.insert(corners.begin(), corners.end());
  }
  int edges = 0;
  ForEachEdge(SortedSides(triangles), [&](const SoupSide*, const SoupSide*) { ++edges; });
  return static_cast<int>(points.size()) - edges + static_cast<int>(triangles.size());
}
}
