// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleAdjacency.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace knotwork
{
namespace
{
/// One side of a triangle, from its corner Side to the next one.
struct HalfEdge
{
  int Low = 0;
  int High = 0;
  int Triangle = 0;
  int Side = 0;
  bool operator<(const HalfEdge& other) const
  {
    return std::tie(this->Low, this->High, this->Triangle, this->Side) <
      std::tie(other.Low, other.High, other.Triangle, other.Side);
  }
};

/// Sorted; by the lower corner first without comparisons, which takes a fraction of the time.
std::vector<HalfEdge> SortedHalfEdges(const std::vector<std::array<int, 3>>& triangles)
{
  int last = -1;
  for (const auto& corners : triangles)
  {
    last = std::max({ last, corners[0], corners[1], corners[2] });
  }
  std::vector<std::size_t> begin(static_cast<std::size_t>(last) + 2, 0);
  const auto forEdges = [&triangles](const auto& take)
  {
    for (std::size_t t = 0; t < triangles.size(); ++t)
    {
      for (int k = 0; k < 3; ++k)
      {
        const int a = triangles[t][static_cast<std::size_t>(k)];
        const int b = triangles[t][static_cast<std::size_t>((k + 1) % 3)];
        take(HalfEdge{ std::min(a, b), std::max(a, b), static_cast<int>(t), k });
      }
    }
  };
  forEdges([&](const HalfEdge& edge) { ++begin[static_cast<std::size_t>(edge.Low) + 1]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<HalfEdge> edges(3 * triangles.size());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  forEdges([&](const HalfEdge& edge) { edges[next[static_cast<std::size_t>(edge.Low)]++] = edge; });
  for (std::size_t v = 0; v + 1 < begin.size(); ++v)
  {
    std::sort(edges.begin() + static_cast<std::ptrdiff_t>(begin[v]),
      edges.begin() + static_cast<std::ptrdiff_t>(begin[v + 1]));
  }
  return edges;
}
}

Result<TriangleAdjacency> FindAdjacency(const std::vector<std::array<int, 3>>& triangles)
{
  Result<TriangleAdjacency> result;
  TriangleAdjacency& adjacency = result.Value;
  const std::vector<HalfEdge> edges = SortedHalfEdges(triangles);
  adjacency.Triangle.assign(triangles.size(), { -1, -1, -1 });
  adjacency.Side.assign(triangles.size(), { -1, -1, -1 });
  int crowded = 0;
  std::string first;
  for (std::size_t i = 0; i < edges.size();)
  {
    std::size_t j = i + 1;
    while (j < edges.size() && edges[j].Low == edges[i].Low && edges[j].High == edges[i].High)
    {
      ++j;
    }
    if (j - i > 2)
    {
      if (crowded++ < 5)
      {
        first += (first.empty() ? "" : ", ") + std::to_string(edges[i].Low) + "-" +
          std::to_string(edges[i].High);
      }
    }
    else if (j - i == 2)
    {
      const auto link = [&](const HalfEdge& from, const HalfEdge& to)
      {
        const auto t = static_cast<std::size_t>(from.Triangle);
        const auto k = static_cast<std::size_t>(from.Side);
        adjacency.Triangle[t][k] = to.Triangle;
        adjacency.Side[t][k] = to.Side;
      };
      link(edges[i], edges[i + 1]);
      link(edges[i + 1], edges[i]);
    }
    i = j;
  }
  if (crowded > 0)
  {
    return { ErrorCode::InvalidTopology,
      std::to_string(crowded) + " edges of more than two triangles (points " + first +
        (crowded > 5 ? ", ..." : "") + ")" };
  }
  return result;
}
}
