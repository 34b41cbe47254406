// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleAdjacency.h"

#include <algorithm>
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
}

Result<TriangleAdjacency> FindAdjacency(const std::vector<std::array<int, 3>>& triangles)
{
  Result<TriangleAdjacency> result;
  TriangleAdjacency& adjacency = result.Value;
  std::vector<HalfEdge> edges;
  edges.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      const int a = triangles[t][static_cast<std::size_t>(k)];
      const int b = triangles[t][static_cast<std::size_t>((k + 1) % 3)];
      edges.push_back({ std::min(a, b), std::max(a, b), static_cast<int>(t), k });
    }
  }
  std::sort(edges.begin(), edges.end());
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
