// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <map>
#include <queue>
#include <utility>
#include <vector>

namespace knotwork
{
enum class WayPoint
{
  LeadsOn,
  LeadsNowhere,
  IsEnd
};

/// A step of a way: the point that it reaches, and its edge.
template <class Edge>
struct WayStep
{
  int Point = 0;
  Edge By;
};

/// The shortest way along edges from a point to the nearest one that is an end (Dijkstra).
/// @param judge  WayPoint of (point, length of the way there).
/// @param steps  calls visit(next, length, edge) for the edges of (point, length, visit).
/// @return the last step first; empty: there is none.
/// @complexity O(m log m) with m points that are nearer.
template <class Edge, class Judge, class Steps>
std::vector<WayStep<Edge>> NearestWay(int start, Judge&& judge, Steps&& steps)
{
  struct Arrival
  {
    double Length = 0.0;
    int From = 0;
    Edge By;
  };
  std::map<int, Arrival> reached{ { start, { 0.0, start, Edge() } } };
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
  queue.emplace(0.0, start);
  while (!queue.empty())
  {
    const double length = queue.top().first;
    const int point = queue.top().second;
    queue.pop();
    if (length > reached.at(point).Length)
    {
      continue;
    }
    const WayPoint kind = judge(point, length);
    if (kind == WayPoint::IsEnd)
    {
      std::vector<WayStep<Edge>> way;
      for (int at = point; at != start; at = reached.at(at).From)
      {
        way.push_back({ at, reached.at(at).By });
      }
      return way;
    }
    if (kind == WayPoint::LeadsNowhere)
    {
      continue;
    }
    steps(point, length,
      [&](int next, double step, const Edge& edge)
      {
        const double further = length + step;
        const auto [found, isNew] = reached.emplace(next, Arrival{ further, point, edge });
        if (isNew || further < found->second.Length)
        {
          found->second = { further, point, edge };
          queue.emplace(further, next);
        }
      });
  }
  return {};
}
}
