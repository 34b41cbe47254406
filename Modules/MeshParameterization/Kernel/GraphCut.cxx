// SPDX-License-Identifier: BSD-3-Clause
#include "GraphCut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace knotwork
{
namespace
{
using Capacity = std::int64_t;
constexpr double Resolution = 1073741824.0; // 2^30
constexpr Capacity Held = std::numeric_limits<Capacity>::max() / 4;

/// Flow from nodes with an excess to nodes with a deficit; arc i runs back as arc i ^ 1.
///
/// Two trees grow towards each other, of nodes that the source reaches and of nodes that reach the
/// sink, along arcs that are not full. Where they meet, flow is pushed; nodes that lose their
/// parent by that look for another one, and the trees are kept for the next path.
class Network
{
public:
  Network(std::size_t nodes, const std::vector<std::array<int, 2>>& ends);

  std::vector<Capacity> Rest;    ///< of arcs
  std::vector<Capacity> Excess;  ///< that can still flow in from the source
  std::vector<Capacity> Deficit; ///< that can still flow out to the sink

  void Flow();
  /// After the flow: whether the source still reaches the node.
  bool IsReached(std::size_t v) const { return this->Trees[v] == OfSource; }

private:
  enum Tree : char
  {
    None,
    OfSource,
    OfSink
  };
  static constexpr int Root = -1;   ///< in place of an arc: the source or the sink itself
  static constexpr int Orphan = -2; ///< no parent

  void Grow(int v);
  void Push(std::size_t between);
  void Adopt(int v);
  /// Capacity that is left from a parent to its child, or for the sink from the child to it.
  Capacity RestToChild(std::size_t arcToParent, Tree tree) const
  {
    return this->Rest[tree == OfSource ? arcToParent ^ 1U : arcToParent];
  }
  /// Steps to the root; -1: none is there.
  int FindRoot(int v);
  void Activate(int v);
  void MakeOrphan(int v);

  std::vector<int> First; ///< arcs of a node: Order[First[v]] ... Order[First[v + 1] - 1]
  std::vector<int> Order;
  std::vector<int> Head;
  std::vector<Tree> Trees;
  std::vector<int> Parents;    ///< arcs to them
  std::vector<int> Distances;  ///< to the root, as of Times
  std::vector<int> Times;      ///< when it was known that the root is reached
  std::vector<char> AreActive; ///< wait in Active
  std::vector<int> Active;     ///< nodes whose arcs are to be looked at, from NextActive on
  std::size_t NextActive = 0;
  std::vector<int> Orphans;
  int Time = 0;
};

Network::Network(std::size_t nodes, const std::vector<std::array<int, 2>>& ends)
  : Excess(nodes, 0), Deficit(nodes, 0), First(nodes + 1, 0), Trees(nodes, None),
    Parents(nodes, Orphan), Distances(nodes, 0), Times(nodes, 0), AreActive(nodes, 0)
{
  for (const auto& [a, b] : ends)
  {
    ++this->First[static_cast<std::size_t>(a) + 1];
    ++this->First[static_cast<std::size_t>(b) + 1];
    this->Head.push_back(b);
    this->Head.push_back(a);
  }
  std::partial_sum(this->First.begin(), this->First.end(), this->First.begin());
  this->Order.resize(this->Head.size());
  this->Rest.resize(this->Head.size());
  std::vector<int> used(this->First.begin(), this->First.end() - 1);
  for (std::size_t arc = 0; arc < this->Head.size(); ++arc)
  {
    const auto tail = static_cast<std::size_t>(this->Head[arc ^ 1U]);
    this->Order[static_cast<std::size_t>(used[tail]++)] = static_cast<int>(arc);
  }
}

void Network::Activate(int v)
{
  if (this->AreActive[static_cast<std::size_t>(v)] == 0)
  {
    this->AreActive[static_cast<std::size_t>(v)] = 1;
    this->Active.push_back(v);
  }
}

void Network::MakeOrphan(int v)
{
  this->Parents[static_cast<std::size_t>(v)] = Orphan;
  this->Orphans.push_back(v);
}

void Network::Flow()
{
  for (std::size_t v = 0; v < this->Trees.size(); ++v)
  {
    if (this->Excess[v] > 0 || this->Deficit[v] > 0)
    {
      this->Trees[v] = this->Excess[v] > 0 ? OfSource : OfSink;
      this->Parents[v] = Root;
      this->Activate(static_cast<int>(v));
    }
  }
  while (this->NextActive < this->Active.size())
  {
    const int v = this->Active[this->NextActive++];
    this->AreActive[static_cast<std::size_t>(v)] = 0;
    this->Grow(v);
  }
}

/// Takes free nodes into the tree of a node, and pushes along the arcs where it meets the other.
void Network::Grow(int v)
{
  const auto at = static_cast<std::size_t>(v);
  for (int j = this->First[at]; j < this->First[at + 1]; ++j)
  {
    const auto arc = static_cast<std::size_t>(this->Order[static_cast<std::size_t>(j)]);
    const auto w = static_cast<std::size_t>(this->Head[arc]);
    const Tree tree = this->Trees[at];
    if (tree == None)
    {
      return; // lost on the way
    }
    if (this->Rest[tree == OfSource ? arc : arc ^ 1U] == 0)
    {
      continue;
    }
    if (this->Trees[w] == None)
    {
      this->Trees[w] = tree;
      this->Parents[w] = static_cast<int>(arc ^ 1U);
      this->Distances[w] = this->Distances[at] + 1;
      this->Times[w] = this->Times[at];
      this->Activate(this->Head[arc]);
    }
    else if (this->Trees[w] == tree)
    {
      if (this->Parents[w] >= 0 && this->Times[w] <= this->Times[at] &&
        this->Distances[w] > this->Distances[at] + 1)
      {
        this->Parents[w] = static_cast<int>(arc ^ 1U);
        this->Distances[w] = this->Distances[at] + 1;
        this->Times[w] = this->Times[at];
      }
    }
    else
    {
      ++this->Time;
      this->Push(tree == OfSource ? arc : arc ^ 1U);
      while (!this->Orphans.empty())
      {
        const int orphan = this->Orphans.back();
        this->Orphans.pop_back();
        this->Adopt(orphan);
      }
      --j; // there may be more
    }
  }
}

/// @param between  an arc from the source's tree to the sink's.
void Network::Push(std::size_t between)
{
  const std::array<int, 2> ends{ this->Head[between ^ 1U], this->Head[between] };
  const auto parentOf = [this](int v) { return this->Parents[static_cast<std::size_t>(v)]; };
  std::array<int, 2> roots{};
  Capacity flow = this->Rest[between];
  for (std::size_t k = 0; k < 2; ++k)
  {
    int v = ends[k];
    for (; parentOf(v) >= 0; v = this->Head[static_cast<std::size_t>(parentOf(v))])
    {
      flow = std::min(
        flow, this->RestToChild(static_cast<std::size_t>(parentOf(v)), k == 0 ? OfSource : OfSink));
    }
    roots[k] = v;
  }
  Capacity& excess = this->Excess[static_cast<std::size_t>(roots[0])];
  Capacity& deficit = this->Deficit[static_cast<std::size_t>(roots[1])];
  flow = std::min({ flow, excess, deficit });
  excess -= flow;
  deficit -= flow;
  this->Rest[between] -= flow;
  this->Rest[between ^ 1U] += flow;
  for (std::size_t k = 0; k < 2; ++k)
  {
    for (int v = ends[k]; v != roots[k];)
    {
      const auto arc = static_cast<std::size_t>(parentOf(v)) ^ (k == 0 ? 1U : 0U);
      const int parent = this->Head[static_cast<std::size_t>(parentOf(v))];
      this->Rest[arc] -= flow;
      this->Rest[arc ^ 1U] += flow;
      if (this->Rest[arc] == 0)
      {
        this->MakeOrphan(v);
      }
      v = parent;
    }
  }
  if (excess == 0)
  {
    this->MakeOrphan(roots[0]);
  }
  if (deficit == 0)
  {
    this->MakeOrphan(roots[1]);
  }
}

int Network::FindRoot(int v)
{
  int steps = 0;
  int node = v;
  for (;; ++steps)
  {
    const auto at = static_cast<std::size_t>(node);
    if (this->Times[at] == this->Time && this->Parents[at] != Orphan)
    {
      steps += this->Distances[at];
      break;
    }
    if (this->Parents[at] == Root)
    {
      this->Times[at] = this->Time;
      this->Distances[at] = 0;
      break;
    }
    if (this->Parents[at] == Orphan)
    {
      return -1;
    }
    node = this->Head[static_cast<std::size_t>(this->Parents[at])];
  }
  int left = steps;
  for (node = v; this->Times[static_cast<std::size_t>(node)] != this->Time;)
  {
    const auto at = static_cast<std::size_t>(node);
    this->Times[at] = this->Time;
    this->Distances[at] = left--;
    node = this->Head[static_cast<std::size_t>(this->Parents[at])];
  }
  return steps;
}

/// Finds the nearest parent, or gives the node and its children up.
void Network::Adopt(int v)
{
  const auto at = static_cast<std::size_t>(v);
  const Tree tree = this->Trees[at];
  int nearest = std::numeric_limits<int>::max();
  const auto forNeighbours = [&](const auto& take)
  {
    for (int j = this->First[at]; j < this->First[at + 1]; ++j)
    {
      const auto arc = static_cast<std::size_t>(this->Order[static_cast<std::size_t>(j)]);
      if (this->Trees[static_cast<std::size_t>(this->Head[arc])] == tree)
      {
        take(arc, this->Head[arc]);
      }
    }
  };
  forNeighbours(
    [&](std::size_t arc, int w)
    {
      if (this->RestToChild(arc, tree) == 0)
      {
        return;
      }
      if (const int steps = this->FindRoot(w); steps >= 0 && steps < nearest)
      {
        nearest = steps;
        this->Parents[at] = static_cast<int>(arc);
      }
    });
  if (this->Parents[at] != Orphan)
  {
    this->Distances[at] = nearest + 1;
    this->Times[at] = this->Time;
    return;
  }
  forNeighbours(
    [&](std::size_t arc, int w)
    {
      const int parent = this->Parents[static_cast<std::size_t>(w)];
      if (this->RestToChild(arc, tree) > 0)
      {
        this->Activate(w);
      }
      if (parent >= 0 && this->Head[static_cast<std::size_t>(parent)] == v)
      {
        this->MakeOrphan(w);
      }
    });
  this->Trees[at] = None;
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
  std::vector<std::array<int, 2>> ends;
  ends.reserve(edges.size());
  for (const GraphEdge& edge : edges)
  {
    ends.push_back({ edge.A, edge.B });
  }
  Network network(n, ends);
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    network.Rest[2 * i] = network.Rest[2 * i + 1] = capacity(edges[i].Weight);
  }
  for (std::size_t v = 0; v < n; ++v)
  {
    network.Excess[v] = costs[v] > 0.0 ? capacity(costs[v]) : 0;
    network.Deficit[v] = costs[v] < 0.0 ? capacity(-costs[v]) : 0;
  }
  network.Flow();
  std::vector<char> sides(n, 1);
  for (std::size_t v = 0; v < n; ++v)
  {
    sides[v] = network.IsReached(v) ? 0 : 1;
  }
  return sides;
}
}
