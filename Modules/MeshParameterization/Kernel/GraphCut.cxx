// SPDX-License-Identifier: BSD-3-Clause
#include "GraphCut.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace knotwork
{
namespace
{
using Capacity = std::int64_t;
constexpr double Resolution = 1073741824.0; // 2^30
constexpr Capacity Held = std::numeric_limits<Capacity>::max() / 4;

/// Flow from nodes with an excess to nodes with a deficit; arc i runs back as arc i ^ 1.
struct Network
{
  std::vector<int> First; ///< arcs of a node: Order[First[v]] ... Order[First[v + 1] - 1]
  std::vector<int> Order;
  std::vector<int> Head;
  std::vector<Capacity> Rest;
  std::vector<Capacity> Excess;  ///< that can still flow in from the source
  std::vector<Capacity> Deficit; ///< that can still flow out to the sink
  std::vector<int> Level;
  std::vector<int> Next; ///< arc to be tried

  std::size_t NumNodes() const { return this->Excess.size(); }
  bool FindLevels();
  void Push(std::size_t source);
};

/// Breadth first from all nodes with an excess. @return whether a deficit is reached.
bool Network::FindLevels()
{
  std::fill(this->Level.begin(), this->Level.end(), -1);
  std::vector<int> queue;
  for (std::size_t v = 0; v < this->NumNodes(); ++v)
  {
    if (this->Excess[v] > 0)
    {
      this->Level[v] = 0;
      queue.push_back(static_cast<int>(v));
    }
  }
  bool reached = false;
  for (std::size_t i = 0; i < queue.size(); ++i)
  {
    const auto v = static_cast<std::size_t>(queue[i]);
    reached = reached || this->Deficit[v] > 0;
    for (int j = this->First[v]; j < this->First[v + 1]; ++j)
    {
      const auto arc = static_cast<std::size_t>(this->Order[static_cast<std::size_t>(j)]);
      const auto w = static_cast<std::size_t>(this->Head[arc]);
      if (this->Rest[arc] > 0 && this->Level[w] < 0)
      {
        this->Level[w] = this->Level[v] + 1;
        queue.push_back(static_cast<int>(w));
      }
    }
  }
  return reached;
}

/// Paths from one node, by increasing levels, until its excess is gone or stuck.
void Network::Push(std::size_t source)
{
  std::vector<std::size_t> path; // arcs
  std::size_t v = source;
  while (this->Excess[source] > 0)
  {
    if (this->Deficit[v] > 0)
    {
      Capacity flow = std::min(this->Excess[source], this->Deficit[v]);
      for (std::size_t arc : path)
      {
        flow = std::min(flow, this->Rest[arc]);
      }
      this->Excess[source] -= flow;
      this->Deficit[v] -= flow;
      std::size_t full = path.size();
      for (std::size_t i = path.size(); i-- > 0;)
      {
        this->Rest[path[i]] -= flow;
        this->Rest[path[i] ^ 1U] += flow;
        full = this->Rest[path[i]] == 0 ? i : full;
      }
      if (full < path.size()) // go on from before the first arc that is full
      {
        v = static_cast<std::size_t>(this->Head[path[full] ^ 1U]);
        path.resize(full);
      }
      continue;
    }
    bool advanced = false;
    for (int& j = this->Next[v]; j < this->First[v + 1]; ++j)
    {
      const auto arc = static_cast<std::size_t>(this->Order[static_cast<std::size_t>(j)]);
      const auto w = static_cast<std::size_t>(this->Head[arc]);
      if (this->Rest[arc] > 0 && this->Level[w] == this->Level[v] + 1)
      {
        path.push_back(arc);
        v = w;
        advanced = true;
        break;
      }
    }
    if (!advanced)
    {
      if (path.empty())
      {
        return;
      }
      v = static_cast<std::size_t>(this->Head[path.back() ^ 1U]);
      path.pop_back();
      ++this->Next[v];
    }
  }
}
}

std::vector<char> CutGraph(const std::vector<double>& costs, const std::vector<GraphEdge>& edges)
{
  const std::size_t n = costs.size();
  double sum = std::numeric_limits<double>::min();
  for (double cost : costs)
  {
    sum += std::isfinite(cost) ? std::abs(cost) : 0.0;
  }
  for (const GraphEdge& edge : edges)
  {
    sum += edge.Weight;
  }
  const auto capacity = [&](double value)
  { return std::isfinite(value) ? std::llround(value * (Resolution / sum)) : Held; };
  Network network;
  network.First.assign(n + 1, 0);
  for (const GraphEdge& edge : edges)
  {
    ++network.First[static_cast<std::size_t>(edge.A) + 1];
    ++network.First[static_cast<std::size_t>(edge.B) + 1];
    network.Head.push_back(edge.B);
    network.Head.push_back(edge.A);
    network.Rest.insert(network.Rest.end(), 2, capacity(edge.Weight));
  }
  for (std::size_t v = 0; v < n; ++v)
  {
    network.First[v + 1] += network.First[v];
  }
  network.Order.resize(network.Head.size());
  std::vector<int> used(network.First.begin(), network.First.end() - 1);
  for (std::size_t arc = 0; arc < network.Head.size(); ++arc)
  {
    const auto tail = static_cast<std::size_t>(network.Head[arc ^ 1U]);
    network.Order[static_cast<std::size_t>(used[tail]++)] = static_cast<int>(arc);
  }
  for (double cost : costs)
  {
    network.Excess.push_back(cost > 0.0 ? capacity(cost) : 0);
    network.Deficit.push_back(cost < 0.0 ? capacity(-cost) : 0);
  }
  network.Level.assign(n, -1);
  while (network.FindLevels())
  {
    network.Next.assign(network.First.begin(), network.First.end() - 1);
    for (std::size_t v = 0; v < n; ++v)
    {
      if (network.Excess[v] > 0)
      {
        network.Push(v);
      }
    }
  }
  std::vector<char> sides(n, 1);
  for (std::size_t v = 0; v < n; ++v)
  {
    sides[v] = network.Level[v] >= 0 ? 0 : 1; // reached from the source
  }
  return sides;
}
}
