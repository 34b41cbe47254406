// SPDX-License-Identifier: BSD-3-Clause
#include "MeshFeatures.h"

#include "SurfaceSides.h"

#include <knotwork/SplineCore/DisjointSets.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double Slack = 1e-6; // degrees
constexpr double Degrees = 57.295779513082320877;

/// Ends of a feature edge, the smaller one first.
using Edge = std::array<int, 2>;

/// Feature edges at each point, as numbers of edges in the order of their other ends.
using Incidence = std::vector<std::vector<int>>;

Status CheckParams(const MeshFeatureParams& params)
{
  const auto error = [](const char* text) { return Status(ErrorCode::InvalidParameter, text); };
  if (!(params.SharpAngle > 0.0 && params.SharpAngle < 180.0))
  {
    return error("SharpAngle must be above 0 and below 180 degrees");
  }
  if (!(params.WeakAngle > 0.0 && params.WeakAngle <= params.SharpAngle))
  {
    return error("WeakAngle must be above 0 and at most SharpAngle");
  }
  if (!(params.CornerAngle > 0.0 && params.CornerAngle <= 180.0))
  {
    return error("CornerAngle must be above 0 and at most 180 degrees");
  }
  return {};
}

/// Rims and sharp edges, in ascending order.
std::vector<Edge> FindEdges(const SurfaceParts& parts, const MeshFeatureParams& params)
{
  std::vector<Edge> rims;
  std::vector<std::pair<Edge, bool>> candidates; // of at least WeakAngle; whether sharp by itself
  for (std::size_t t = 0; t < parts.Mesh.Triangles.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const int a = parts.Mesh.Triangles[t][k];
      const int b = parts.Mesh.Triangles[t][(k + 1) % 3];
      const Edge edge = { std::min(a, b), std::max(a, b) };
      const int other = parts.Adjacency.Triangle[t][k];
      if (other < 0)
      {
        rims.push_back(edge);
      }
      else if (static_cast<int>(t) < other)
      {
        const double angle = Degrees * parts.Dihedral(t, k) + Slack;
        if (angle >= params.WeakAngle)
        {
          candidates.emplace_back(edge, angle >= params.SharpAngle);
        }
      }
    }
  }
  DisjointSets sets(parts.Mesh.NumPoints());
  for (const auto& [edge, sharp] : candidates)
  {
    sets.Unite(edge[0], edge[1]);
  }
  std::vector<char> kept(static_cast<std::size_t>(sets.Size()), 0);
  for (const auto& [edge, sharp] : candidates)
  {
    if (sharp)
    {
      kept[static_cast<std::size_t>(sets.Find(edge[0]))] = 1;
    }
  }
  std::vector<Edge> edges = std::move(rims);
  for (const auto& [edge, sharp] : candidates)
  {
    if (kept[static_cast<std::size_t>(sets.Find(edge[0]))])
    {
      edges.push_back(edge);
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

int OtherEnd(const Edge& edge, int point)
{
  return edge[0] == point ? edge[1] : edge[0];
}

bool IsCorner(const DiscMesh& surface, const std::vector<Edge>& edges, const std::vector<int>& at,
  int point, double cornerAngle)
{
  if (at.size() != 2)
  {
    return !at.empty();
  }
  const Eigen::Vector3d here = surface.Point(point);
  const auto end = [&](std::size_t i)
  { return surface.Point(OtherEnd(edges[static_cast<std::size_t>(at[i])], point)); };
  const Eigen::Vector3d in = here - end(0);
  const Eigen::Vector3d out = end(1) - here;
  return Degrees * std::atan2(in.cross(out).norm(), in.dot(out)) + Slack >= cornerAngle;
}

/// Follows edges that are not yet used from a point to a corner or round to the point.
FeatureChain Follow(const std::vector<Edge>& edges, const Incidence& incidence,
  const std::vector<char>& corner, int start, int first, std::vector<char>& used)
{
  FeatureChain chain;
  int point = start;
  for (int next = first; next >= 0;)
  {
    used[static_cast<std::size_t>(next)] = 1;
    chain.Points.push_back(point);
    point = OtherEnd(edges[static_cast<std::size_t>(next)], point);
    next = -1;
    if (!corner[static_cast<std::size_t>(point)])
    {
      for (int edge : incidence[static_cast<std::size_t>(point)])
      {
        next = used[static_cast<std::size_t>(edge)] ? next : edge;
      }
    }
  }
  chain.Closed = !corner[static_cast<std::size_t>(point)];
  if (!chain.Closed)
  {
    chain.Points.push_back(point);
  }
  return chain;
}

void FindRegions(const SurfaceParts& parts, const std::vector<Edge>& edges, MeshFeatures& features)
{
  const std::size_t count = parts.Mesh.Triangles.size();
  DisjointSets sets(static_cast<int>(count));
  for (std::size_t t = 0; t < count; ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const int a = parts.Mesh.Triangles[t][k];
      const int b = parts.Mesh.Triangles[t][(k + 1) % 3];
      const Edge edge = { std::min(a, b), std::max(a, b) };
      if (!std::binary_search(edges.begin(), edges.end(), edge))
      {
        sets.Unite(static_cast<int>(t), parts.Adjacency.Triangle[t][k]);
      }
    }
  }
  features.Regions.resize(count);
  for (std::size_t t = 0; t < count; ++t)
  {
    const auto root = static_cast<std::size_t>(sets.Find(static_cast<int>(t)));
    features.Regions[t] = root == t ? features.NumRegions++ : features.Regions[root];
  }
}
}

Result<MeshFeatures> FindMeshFeatures(const DiscMesh& surface, const MeshFeatureParams& params)
{
  if (Status status = CheckParams(params); !status)
  {
    return status;
  }
  const std::vector<int> noHoles;
  const SurfaceParts parts(surface, noHoles);
  const std::vector<Edge> edges = FindEdges(parts, params);
  const auto points = static_cast<std::size_t>(surface.NumPoints());
  Incidence incidence(points);
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    for (int end : edges[e])
    {
      incidence[static_cast<std::size_t>(end)].push_back(static_cast<int>(e));
    }
  }
  MeshFeatures features;
  std::vector<char> corner(points, 0);
  for (std::size_t p = 0; p < points; ++p)
  {
    if (IsCorner(surface, edges, incidence[p], static_cast<int>(p), params.CornerAngle))
    {
      corner[p] = 1;
      features.Corners.push_back(static_cast<int>(p));
    }
  }
  std::vector<char> used(edges.size(), 0);
  const auto follow = [&](std::size_t p)
  {
    for (int edge : incidence[p])
    {
      if (!used[static_cast<std::size_t>(edge)])
      {
        features.Chains.push_back(
          Follow(edges, incidence, corner, static_cast<int>(p), edge, used));
      }
    }
  };
  for (int p : features.Corners)
  {
    follow(static_cast<std::size_t>(p));
  }
  for (std::size_t p = 0; p < points; ++p) // what is left has no corner
  {
    follow(p);
  }
  FindRegions(parts, edges, features);
  return features;
}
}
