// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "MeshFeatures.h"
#include "SurfaceSides.h"

#include <algorithm>
#include <functional>

namespace knotwork
{
constexpr double Degrees = 57.295779513082320877; // in a radian

/// Ends of an edge, the smaller one first.
using MeshEdge = std::array<int, 2>;

inline MeshEdge EdgeBetween(int a, int b)
{
  return { std::min(a, b), std::max(a, b) };
}

/// Side k of triangle t.
inline MeshEdge EdgeOf(const SurfaceParts& parts, std::size_t t, std::size_t k)
{
  return EdgeBetween(parts.Mesh.Triangles[t][k], parts.Mesh.Triangles[t][(k + 1) % 3]);
}

/// Calls visit(t, k) for one of the two sides of every inner edge.
template <class Visit>
void VisitInnerEdges(const SurfaceParts& parts, Visit&& visit)
{
  for (std::size_t t = 0; t < parts.Mesh.Triangles.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      if (static_cast<int>(t) < parts.Adjacency.Triangle[t][k])
      {
        visit(t, k);
      }
    }
  }
}

/// A mark on inner edges, which both of their sides have.
class EdgeMarks
{
public:
  explicit EdgeMarks(const SurfaceParts& parts)
    : Parts(&parts), Marks(parts.Mesh.Triangles.size(), { 0, 0, 0 })
  {
  }
  bool operator()(std::size_t t, std::size_t k) const { return this->Marks[t][k] != 0; }
  void Set(std::size_t t, std::size_t k, bool on)
  {
    this->Marks[t][k] = on ? 1 : 0;
    const auto other = static_cast<std::size_t>(this->Parts->Adjacency.Triangle[t][k]);
    this->Marks[other][static_cast<std::size_t>(this->Parts->Adjacency.Side[t][k])] = on ? 1 : 0;
  }
  /// Marks edges, which are ascending.
  void Set(const std::vector<MeshEdge>& edges)
  {
    VisitInnerEdges(*this->Parts,
      [&](std::size_t t, std::size_t k)
      {
        if (std::binary_search(edges.begin(), edges.end(), EdgeOf(*this->Parts, t, k)))
        {
          this->Set(t, k, true);
        }
      });
  }
  /// The marked ones, ascending.
  std::vector<MeshEdge> Edges() const
  {
    std::vector<MeshEdge> edges;
    VisitInnerEdges(*this->Parts,
      [&](std::size_t t, std::size_t k)
      {
        if ((*this)(t, k))
        {
          edges.push_back(EdgeOf(*this->Parts, t, k));
        }
      });
    std::sort(edges.begin(), edges.end());
    return edges;
  }

private:
  const SurfaceParts* Parts;
  std::vector<std::array<char, 3>> Marks;
};

/// Angle between the two sides of an inner edge, side k of triangle t, degrees.
using EdgeAngle = std::function<double(std::size_t t, std::size_t k)>;

Status CheckParams(const MeshFeatureParams& params);

/// Inner edges from SharpAngle on, and those from WeakAngle on that are connected with them by
/// such; ascending.
std::vector<MeshEdge> SharpEdges(
  const SurfaceParts& parts, const MeshFeatureParams& params, const EdgeAngle& angle);

/// Edges of one triangle, ascending.
std::vector<MeshEdge> RimEdges(const SurfaceParts& parts);

/// Chains, corners and regions of edges, those of rims among them.
/// @param edges  ascending.
/// @param reach  one a point, or empty: the turn of a chain at a point is that between the
///        directions to points so far away on both sides; where it is not 0 the point that turns
///        most within that distance is the corner.
MeshFeatures TraceFeatures(const SurfaceParts& parts, const std::vector<MeshEdge>& edges,
  double cornerAngle, const std::vector<double>& reach = {});

/// Regions of triangles that hang together by sides that are not blocked, numbered by their first
/// triangles.
struct RegionLabels
{
  std::vector<int> Of; ///< one a triangle
  int Count = 0;
};
RegionLabels LabelRegions(
  const SurfaceParts& parts, const std::function<bool(std::size_t t, std::size_t k)>& isBlocked);
}
