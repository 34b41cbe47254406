// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceSides.h"

#include "GraphCut.h"
#include "HeatFlow.h"
#include "MeshWeights.h"
#include "SmallEigenpairs.h"

#include <knotwork/SplineCore/AngleBetween.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr double CutPrice = 0.05;   // of a unit of length, over the root of the area
constexpr double SharpPrice = 0.05; // of it across a sharp edge
constexpr double SmoothAngle = 0.7; // radians where the price has fallen to 1/e
constexpr double LeastShare = 0.01; // of the area on a side
constexpr int LloydIterations = 8;
constexpr int ManyNodes = 60000;    // of a graph: of more, nodes become groups of triangles
constexpr int MostNodes = 20000;    // after that
constexpr double LeastCosine = 0.9; // of normals of nodes that are joined
constexpr double LeastJoined = 0.1; // of the nodes, in a round of joining

/// Triangles at a hole are one node.
struct Nodes
{
  std::vector<int> OfTriangle;
  int Count = 0;
};

Nodes FindNodes(const SurfaceParts& parts)
{
  Nodes nodes;
  const int holes =
    parts.Holes.empty() ? 0 : 1 + *std::max_element(parts.Holes.begin(), parts.Holes.end());
  std::vector<int> ofHole(static_cast<std::size_t>(std::max(holes, 0)), -1);
  for (const auto& corners : parts.Mesh.Triangles)
  {
    int hole = -1;
    for (int c : corners)
    {
      hole = std::max(hole, parts.Holes[static_cast<std::size_t>(c)]);
    }
    if (hole < 0)
    {
      nodes.OfTriangle.push_back(nodes.Count++);
      continue;
    }
    int& node = ofHole[static_cast<std::size_t>(hole)];
    node = node < 0 ? nodes.Count++ : node;
    nodes.OfTriangle.push_back(node);
  }
  return nodes;
}

/// Sides of nodes as sides of triangles; empty when one of them is too small.
Sides ToTriangles(const SurfaceParts& parts, const Nodes& nodes, const std::vector<char>& ofNode)
{
  Sides sides;
  double area = 0.0;
  for (std::size_t t = 0; t < nodes.OfTriangle.size(); ++t)
  {
    sides.push_back(ofNode[static_cast<std::size_t>(nodes.OfTriangle[t])]);
    area += sides.back() ? parts.Areas[t] : 0.0;
  }
  const double share = area / parts.Mesh.Area;
  return share >= LeastShare && share <= 1.0 - LeastShare ? sides : Sides{};
}

/// By the sign of a value a triangle, mean by area over a node.
Sides BySign(const SurfaceParts& parts, const std::vector<double>& values)
{
  const Nodes nodes = FindNodes(parts);
  std::vector<double> sums(static_cast<std::size_t>(nodes.Count), 0.0);
  for (std::size_t t = 0; t < values.size(); ++t)
  {
    sums[static_cast<std::size_t>(nodes.OfTriangle[t])] += parts.Areas[t] * values[t];
  }
  std::vector<char> ofNode;
  for (double sum : sums)
  {
    ofNode.push_back(sum > 0.0 ? 1 : 0);
  }
  return ToTriangles(parts, nodes, ofNode);
}

Sides ByPoints(const SurfaceParts& parts, const Eigen::VectorXd& values)
{
  std::vector<double> means;
  for (const auto& corners : parts.Mesh.Triangles)
  {
    means.push_back(values[corners[0]] + values[corners[1]] + values[corners[2]]);
  }
  return BySign(parts, means);
}

/// Sums up edges between the same nodes and drops those within one.
void SumEdges(std::vector<GraphEdge>& edges)
{
  std::sort(edges.begin(), edges.end(),
    [](const GraphEdge& p, const GraphEdge& q) {
      return p.A != q.A ? p.A < q.A : p.B != q.B ? p.B < q.B : p.Weight < q.Weight;
    });
  std::size_t count = 0;
  for (const GraphEdge& edge : edges)
  {
    if (count > 0 && edges[count - 1].A == edge.A && edges[count - 1].B == edge.B)
    {
      edges[count - 1].Weight += edge.Weight;
    }
    else if (edge.A != edge.B)
    {
      edges[count++] = edge;
    }
  }
  edges.resize(count);
}

/// Joins neighbouring nodes in pairs, small ones with long smooth borders first, until there are
/// not too many: the time of a cut grows faster than their number, and the line of the cut is
/// smoothed afterwards over more than a group.
void JoinNodes(const SurfaceParts& parts, Nodes& nodes, std::vector<GraphEdge>& edges)
{
  const bool tooMany = nodes.Count > ManyNodes;
  while (tooMany && nodes.Count > MostNodes)
  {
    std::vector<double> areas(static_cast<std::size_t>(nodes.Count), 0.0);
    std::vector<Eigen::Vector3d> normals(areas.size(), Eigen::Vector3d::Zero());
    for (std::size_t t = 0; t < parts.Areas.size(); ++t)
    {
      const auto node = static_cast<std::size_t>(nodes.OfTriangle[t]);
      areas[node] += parts.Areas[t];
      normals[node] += parts.Areas[t] * parts.Normals[t];
    }
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < edges.size(); ++i)
    {
      const Eigen::Vector3d& n = normals[static_cast<std::size_t>(edges[i].A)];
      const Eigen::Vector3d& m = normals[static_cast<std::size_t>(edges[i].B)];
      if (n.dot(m) < LeastCosine * n.norm() * m.norm())
      {
        continue; // a group across a crease would not let the cut run along it
      }
      const double area =
        areas[static_cast<std::size_t>(edges[i].A)] + areas[static_cast<std::size_t>(edges[i].B)];
      order.emplace_back(-edges[i].Weight / area, i);
    }
    std::sort(order.begin(), order.end());
    std::vector<int> number(static_cast<std::size_t>(nodes.Count), -1);
    const int most = static_cast<int>((1.0 - LeastJoined) * nodes.Count);
    int count = 0;
    for (const auto& [score, i] : order)
    {
      int& a = number[static_cast<std::size_t>(edges[i].A)];
      int& b = number[static_cast<std::size_t>(edges[i].B)];
      if (a < 0 && b < 0)
      {
        a = b = count++;
      }
    }
    for (int& node : number)
    {
      node = node < 0 ? count++ : node;
    }
    for (int& node : nodes.OfTriangle)
    {
      node = number[static_cast<std::size_t>(node)];
    }
    for (GraphEdge& edge : edges)
    {
      const int a = number[static_cast<std::size_t>(edge.A)];
      const int b = number[static_cast<std::size_t>(edge.B)];
      edge.A = std::min(a, b);
      edge.B = std::max(a, b);
    }
    SumEdges(edges);
    nodes.Count = count;
    if (count > most)
    {
      break;
    }
  }
}

struct NormalCut
{
  Sides Of;
  double Energy = std::numeric_limits<double>::infinity();
};

/// Directions and sides in turn, from given sides of triangles.
NormalCut ImproveSides(
  const SurfaceParts& parts, const Nodes& nodes, const std::vector<GraphEdge>& edges, Sides sides)
{
  const auto count = static_cast<std::size_t>(nodes.Count);
  NormalCut cut;
  for (int iteration = 0; iteration < LloydIterations; ++iteration)
  {
    std::array<Eigen::Vector3d, 2> directions{ Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero() };
    for (std::size_t t = 0; t < sides.size(); ++t)
    {
      directions[sides[t] != 0 ? 1 : 0] += parts.Areas[t] * parts.Normals[t];
    }
    std::vector<double> costs(count, 0.0);
    double energy = 0.0;
    directions[0].normalize();
    directions[1].normalize();
    for (std::size_t t = 0; t < sides.size(); ++t)
    {
      const double zero = parts.Areas[t] * (parts.Normals[t] - directions[0]).squaredNorm();
      const double one = parts.Areas[t] * (parts.Normals[t] - directions[1]).squaredNorm();
      costs[static_cast<std::size_t>(nodes.OfTriangle[t])] += one - zero;
      energy += zero;
    }
    const std::vector<char> ofNode = CutGraph(costs, edges);
    const Sides next = ToTriangles(parts, nodes, ofNode);
    if (next.empty())
    {
      break;
    }
    for (std::size_t i = 0; i < count; ++i)
    {
      energy += ofNode[i] ? costs[i] : 0.0;
    }
    for (const GraphEdge& edge : edges)
    {
      const bool between =
        ofNode[static_cast<std::size_t>(edge.A)] != ofNode[static_cast<std::size_t>(edge.B)];
      energy += between ? edge.Weight : 0.0;
    }
    const bool same = next == cut.Of;
    cut.Of = next;
    cut.Energy = energy;
    sides = next;
    if (same)
    {
      break;
    }
  }
  return cut;
}
}

SurfaceParts::SurfaceParts(const DiscMesh& mesh, const std::vector<int>& holes)
  : Mesh(mesh), Adjacency(FindAdjacency(mesh.Triangles).Value), Holes(holes)
{
  for (const auto& corners : mesh.Triangles)
  {
    const Eigen::Vector3d a = mesh.Point(corners[0]);
    const Eigen::Vector3d normal = (mesh.Point(corners[1]) - a).cross(mesh.Point(corners[2]) - a);
    this->Areas.push_back(0.5 * normal.norm());
    this->Normals.push_back(normal.normalized());
  }
}

double SurfaceParts::Dihedral(std::size_t t, std::size_t k) const
{
  const int other = this->Adjacency.Triangle[t][k];
  if (other < 0)
  {
    return 0.0;
  }
  return AngleBetween(this->Normals[t], this->Normals[static_cast<std::size_t>(other)]);
}

double SurfaceParts::SideLength(std::size_t t, std::size_t k) const
{
  const auto& corners = this->Mesh.Triangles[t];
  return (this->Mesh.Point(corners[(k + 1) % 3]) - this->Mesh.Point(corners[k])).norm();
}

Sides DivideByNormals(const SurfaceParts& parts)
{
  Nodes nodes = FindNodes(parts);
  std::vector<GraphEdge> edges;
  const double price = CutPrice * std::sqrt(parts.Mesh.Area);
  for (std::size_t t = 0; t < parts.Areas.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const int other = parts.Adjacency.Triangle[t][k];
      const int a = nodes.OfTriangle[t];
      const int b = other < 0 ? a : nodes.OfTriangle[static_cast<std::size_t>(other)];
      if (a < b)
      {
        const double angle = parts.Dihedral(t, k) / SmoothAngle;
        const double weight = SharpPrice + (1.0 - SharpPrice) * std::exp(-angle * angle);
        edges.push_back({ a, b, price * weight * parts.SideLength(t, k) });
      }
    }
  }
  JoinNodes(parts, nodes, edges);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
  for (std::size_t t = 0; t < parts.Areas.size(); ++t)
  {
    const double share = parts.Areas[t] / parts.Mesh.Area;
    mean += share * parts.Normals[t];
    square += share * parts.Normals[t] * parts.Normals[t].transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(square - mean * mean.transpose());
  NormalCut best;
  for (int axis = 2; axis >= 0; --axis)
  {
    const Eigen::Vector3d direction = axes.eigenvectors().col(axis);
    std::vector<double> values;
    for (const Eigen::Vector3d& normal : parts.Normals)
    {
      values.push_back((normal - mean).dot(direction));
    }
    const Sides start = BySign(parts, values);
    if (start.empty())
    {
      continue;
    }
    NormalCut cut = ImproveSides(parts, nodes, edges, start);
    if (cut.Energy < best.Energy)
    {
      best = std::move(cut);
    }
  }
  return best.Of;
}

Sides DivideBetween(
  const SurfaceParts& parts, const std::vector<int>& first, const std::vector<int>& second)
{
  Eigen::VectorXd values = Eigen::VectorXd::Zero(parts.Mesh.NumPoints());
  std::vector<char> held(static_cast<std::size_t>(parts.Mesh.NumPoints()), 0);
  for (int v : first)
  {
    values[v] += 1.0;
    held[static_cast<std::size_t>(v)] = 1;
  }
  for (int v : second)
  {
    values[v] -= 1.0;
    held[static_cast<std::size_t>(v)] = 1;
  }
  if (!FlowHeat(parts.Mesh, held, std::numeric_limits<double>::infinity(), 1, values))
  {
    return {};
  }
  return ByPoints(parts, values);
}

Sides DivideByLength(const SurfaceParts& parts)
{
  if (parts.Mesh.NumPoints() < 8)
  {
    return {};
  }
  // the shift lies below the first eigenvalue of a membrane of this area, by far
  const auto pairs = FindSmallEigenpairs(
    CotangentLaplacian(parts.Mesh), VertexAreas(parts.Mesh), 1e-2 / parts.Mesh.Area, 1);
  if (!pairs)
  {
    return {};
  }
  return ByPoints(parts, pairs.Value.Vectors.col(0));
}

Sides DivideByPosition(const SurfaceParts& parts)
{
  const std::size_t n = parts.Areas.size();
  if (n < 2)
  {
    return {};
  }
  PointMatrix centres(static_cast<Eigen::Index>(n), 3);
  for (std::size_t t = 0; t < n; ++t)
  {
    const auto& corners = parts.Mesh.Triangles[t];
    centres.row(static_cast<Eigen::Index>(t)) =
      ((parts.Mesh.Point(corners[0]) + parts.Mesh.Point(corners[1]) +
         parts.Mesh.Point(corners[2])) /
        3.0)
        .transpose();
  }
  const PointMatrix centred = centres.rowwise() - Eigen::RowVector3d(centres.colwise().mean());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(centred.transpose() * centred);
  const Eigen::VectorXd values = centred * axes.eigenvectors().col(2);
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{ 0 });
  std::stable_sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b)
    { return values[static_cast<Eigen::Index>(a)] < values[static_cast<Eigen::Index>(b)]; });
  Sides sides(n, 0);
  for (std::size_t i = n / 2; i < n; ++i)
  {
    sides[order[i]] = 1;
  }
  return sides;
}

void JoinIslands(
  const TriangleAdjacency& adjacency, const std::vector<double>& areas, double share, Sides& sides)
{
  const std::size_t n = sides.size();
  std::vector<int> component(n, -1);
  std::vector<double> sizes;
  std::vector<char> sideOf;
  for (std::size_t start = 0; start < n; ++start)
  {
    if (component[start] >= 0)
    {
      continue;
    }
    const int number = static_cast<int>(sizes.size());
    sizes.push_back(0.0);
    sideOf.push_back(sides[start]);
    component[start] = number;
    std::vector<std::size_t> stack{ start };
    while (!stack.empty())
    {
      const std::size_t t = stack.back();
      stack.pop_back();
      sizes.back() += areas[t];
      for (int neighbour : adjacency.Triangle[t])
      {
        const auto other = static_cast<std::size_t>(neighbour);
        if (neighbour >= 0 && component[other] < 0 && sides[other] == sides[start])
        {
          component[other] = number;
          stack.push_back(other);
        }
      }
    }
  }
  std::array<double, 2> largest{ 0.0, 0.0 };
  for (std::size_t c = 0; c < sizes.size(); ++c)
  {
    double& size = largest[sideOf[c] != 0 ? 1 : 0];
    size = std::max(size, sizes[c]);
  }
  const double least = share * std::accumulate(areas.begin(), areas.end(), 0.0);
  for (std::size_t t = 0; t < n; ++t)
  {
    const auto c = static_cast<std::size_t>(component[t]);
    if (sizes[c] < least && sizes[c] < largest[sideOf[c] != 0 ? 1 : 0])
    {
      sides[t] = static_cast<char>(1 - sideOf[c]);
    }
  }
}
}
