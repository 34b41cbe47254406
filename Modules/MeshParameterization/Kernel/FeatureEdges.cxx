// SPDX-License-Identifier: BSD-3-Clause
#include "FeatureEdges.h"

#include <knotwork/SplineCore/AngleBetween.h>
#include <knotwork/SplineCore/DisjointSets.h>
#include <knotwork/SplineCore/Numbers.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double Slack = 1e-6; // degrees

/// Feature edges at each point, as numbers of edges in the order of their other ends.
using Incidence = std::vector<std::vector<int>>;

int OtherEnd(const MeshEdge& edge, int point)
{
  return edge[0] == point ? edge[1] : edge[0];
}

/// Edges as a graph of points.
struct Network
{
  const DiscMesh& Surface;
  const std::vector<MeshEdge>& Edges;
  Incidence At;

  Network(const DiscMesh& surface, const std::vector<MeshEdge>& edges)
    : Surface(surface), Edges(edges), At(static_cast<std::size_t>(surface.NumPoints()))
  {
    for (std::size_t e = 0; e < edges.size(); ++e)
    {
      for (const int end : edges[e])
      {
        this->At[static_cast<std::size_t>(end)].push_back(static_cast<int>(e));
      }
    }
  }
  const std::vector<int>& Of(int point) const { return this->At[static_cast<std::size_t>(point)]; }
  const MeshEdge& Edge(int e) const { return this->Edges[static_cast<std::size_t>(e)]; }
};

/// The points after one, along an edge, up to the first that is `reach` away or where chains meet.
std::vector<int> Walk(const Network& network, int point, int edge, double reach)
{
  std::vector<int> points;
  for (int at = point;;)
  {
    at = OtherEnd(network.Edge(edge), at);
    points.push_back(at);
    const auto& next = network.Of(at);
    if ((network.Surface.Point(at) - network.Surface.Point(point)).norm() >= reach ||
      next.size() != 2 || at == point)
    {
      return points;
    }
    edge = next[0] == edge ? next[1] : next[0];
  }
}

/// Turn of a chain at a point where two edges meet, degrees.
double TurnAt(const Network& network, int point, double reach)
{
  const Eigen::Vector3d here = network.Surface.Point(point);
  const auto end = [&](std::size_t i)
  { return network.Surface.Point(Walk(network, point, network.Of(point)[i], reach).back()); };
  const Eigen::Vector3d in = here - end(0);
  const Eigen::Vector3d out = end(1) - here;
  return Degrees * AngleBetween(in, out) + Slack;
}

/// Whether within the reach no chains meet and no point turns more, or as much and comes earlier.
bool TurnsMost(const Network& network, int point, double turn, const std::vector<double>& reach)
{
  for (const int edge : network.Of(point))
  {
    for (const int other : Walk(network, point, edge, reach[static_cast<std::size_t>(point)]))
    {
      if (other == point)
      {
        continue;
      }
      if (network.Of(other).size() != 2)
      {
        return false;
      }
      const double its = TurnAt(network, other, reach[static_cast<std::size_t>(other)]);
      if (its > turn || (its == turn && other < point))
      {
        return false;
      }
    }
  }
  return true;
}

bool IsCorner(
  const Network& network, int point, double cornerAngle, const std::vector<double>& reach)
{
  if (network.Of(point).size() != 2)
  {
    return !network.Of(point).empty();
  }
  const double own = reach.empty() ? 0.0 : reach[static_cast<std::size_t>(point)];
  const double turn = TurnAt(network, point, own);
  return turn >= cornerAngle && (own == 0.0 || TurnsMost(network, point, turn, reach));
}

/// Follows edges that are not yet used from a point to a corner or round to the point.
FeatureChain Follow(const std::vector<MeshEdge>& edges, const Incidence& incidence,
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
}

Status CheckParams(const MeshFeatureParams& params)
{
  const auto error = [](const std::string& text)
  { return Status(ErrorCode::InvalidParameter, text); };
  if (!(params.SharpAngle > 0.0 && params.SharpAngle < 180.0))
  {
    return error(
      "SharpAngle must be above 0 and below 180 degrees; it is " + Digits(params.SharpAngle));
  }
  if (!(params.WeakAngle > 0.0 && params.WeakAngle <= params.SharpAngle))
  {
    return error("WeakAngle must be above 0 and at most SharpAngle; it is " +
      Digits(params.WeakAngle) + " degrees and SharpAngle " + Digits(params.SharpAngle) +
      (params.WeakAngle > 0.0 ? ": lower it to that, or raise SharpAngle" : ""));
  }
  if (!(params.CornerAngle > 0.0 && params.CornerAngle <= 180.0))
  {
    return error(
      "CornerAngle must be above 0 and at most 180 degrees; it is " + Digits(params.CornerAngle));
  }
  return {};
}

std::vector<MeshEdge> SharpEdges(
  const SurfaceParts& parts, const MeshFeatureParams& params, const EdgeAngle& angle)
{
  std::vector<std::pair<MeshEdge, bool>> candidates; // of WeakAngle; whether sharp by itself
  DisjointSets sets(parts.Mesh.NumPoints());
  VisitInnerEdges(parts,
    [&](std::size_t t, std::size_t k)
    {
      const double degrees = angle(t, k) + Slack;
      if (degrees >= params.WeakAngle)
      {
        const MeshEdge edge = EdgeOf(parts, t, k);
        candidates.emplace_back(edge, degrees >= params.SharpAngle);
        sets.Unite(edge[0], edge[1]);
      }
    });
  std::vector<char> kept(static_cast<std::size_t>(sets.Size()), 0);
  for (const auto& [edge, sharp] : candidates)
  {
    if (sharp)
    {
      kept[static_cast<std::size_t>(sets.Find(edge[0]))] = 1;
    }
  }
  std::vector<MeshEdge> edges;
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

std::vector<MeshEdge> RimEdges(const SurfaceParts& parts)
{
  std::vector<MeshEdge> edges;
  for (std::size_t t = 0; t < parts.Mesh.Triangles.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      if (parts.Adjacency.Triangle[t][k] < 0)
      {
        edges.push_back(EdgeOf(parts, t, k));
      }
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

RegionLabels LabelRegions(
  const SurfaceParts& parts, const std::function<bool(std::size_t t, std::size_t k)>& isBlocked)
{
  const std::size_t count = parts.Mesh.Triangles.size();
  DisjointSets sets(static_cast<int>(count));
  VisitInnerEdges(parts,
    [&](std::size_t t, std::size_t k)
    {
      if (!isBlocked(t, k))
      {
        sets.Unite(static_cast<int>(t), parts.Adjacency.Triangle[t][k]);
      }
    });
  RegionLabels labels;
  labels.Of.resize(count);
  for (std::size_t t = 0; t < count; ++t)
  {
    const auto root = static_cast<std::size_t>(sets.Find(static_cast<int>(t)));
    labels.Of[t] = root == t ? labels.Count++ : labels.Of[root];
  }
  return labels;
}

MeshFeatures TraceFeatures(const SurfaceParts& parts, const std::vector<MeshEdge>& edges,
  double cornerAngle, const std::vector<double>& reach)
{
  const auto points = static_cast<std::size_t>(parts.Mesh.NumPoints());
  const Network network(parts.Mesh, edges);
  MeshFeatures features;
  std::vector<char> corner(points, 0);
  for (std::size_t p = 0; p < points; ++p)
  {
    if (IsCorner(network, static_cast<int>(p), cornerAngle, reach))
    {
      corner[p] = 1;
      features.Corners.push_back(static_cast<int>(p));
    }
  }
  std::vector<char> used(edges.size(), 0);
  const auto follow = [&](std::size_t p)
  {
    for (int edge : network.At[p])
    {
      if (!used[static_cast<std::size_t>(edge)])
      {
        features.Chains.push_back(
          Follow(edges, network.At, corner, static_cast<int>(p), edge, used));
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
  RegionLabels labels = LabelRegions(parts,
    [&](std::size_t t, std::size_t k)
    { return std::binary_search(edges.begin(), edges.end(), EdgeOf(parts, t, k)); });
  features.Regions = std::move(labels.Of);
  features.NumRegions = labels.Count;
  return features;
}
}
