// SPDX-License-Identifier: BSD-3-Clause
#include "CutMesh.h"

#include "TriangleAdjacency.h"

#include <Eigen/LU>

#include <algorithm>
#include <limits>
#include <numeric>

namespace knotwork
{
namespace
{
/// (1 - weight) a + weight b; both lie in one triangle of the input.
PointOrigin Mean(const PointOrigin& a, const PointOrigin& b, double weight)
{
  PointOrigin mean;
  std::size_t used = 0;
  const auto add = [&](const PointOrigin& origin, double factor)
  {
    for (std::size_t k = 0; k < 3 && origin.Points[k] >= 0; ++k)
    {
      std::size_t at = 0;
      while (at < used && mean.Points[at] != origin.Points[k])
      {
        ++at;
      }
      used = std::max(used, at + 1);
      mean.Points[at] = origin.Points[k];
      mean.Weights[at] += factor * origin.Weights[k];
    }
  };
  add(a, 1.0 - weight);
  add(b, weight);
  return mean;
}

/// Points in the order of the cut mesh.
void SortPoints(std::vector<int>& points, std::vector<std::array<int, 3>>& triangles)
{
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{ 0 });
  std::stable_sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b) { return points[a] < points[b]; });
  std::vector<int> sorted;
  std::vector<int> place(points.size());
  for (std::size_t v : order)
  {
    place[v] = static_cast<int>(sorted.size());
    sorted.push_back(points[v]);
  }
  points = std::move(sorted);
  for (auto& corners : triangles)
  {
    for (int& c : corners)
    {
      c = place[static_cast<std::size_t>(c)];
    }
  }
}
}

CutMesh::CutMesh(const DiscMesh& mesh)
  : Triangles(mesh.Triangles), TriangleIds(mesh.TriangleIds), Charts(mesh.Triangles.size(), 0),
    Sides(mesh.Triangles.size(), 0), UV(mesh.Triangles.size())
{
  for (int v = 0; v < mesh.NumPoints(); ++v)
  {
    this->Points.push_back(mesh.Point(v));
    PointOrigin origin;
    origin.Points[0] = mesh.PointIds[static_cast<std::size_t>(v)];
    origin.Weights[0] = 1.0;
    this->Origins.push_back(origin);
  }
}

std::uint64_t CutMesh::EdgeKey(int a, int b)
{
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 |
    static_cast<std::uint64_t>(std::max(a, b));
}

int CutMesh::AddPoint(int a, int b, double weight)
{
  if (a > b)
  {
    return this->AddPoint(b, a, 1.0 - weight);
  }
  const auto p = static_cast<std::size_t>(a);
  const auto q = static_cast<std::size_t>(b);
  const int point = static_cast<int>(this->Points.size());
  this->Points.push_back((1.0 - weight) * this->Points[p] + weight * this->Points[q]);
  this->Origins.push_back(Mean(this->Origins[p], this->Origins[q], weight));
  this->NewPoints[point] = { a, weight };
  return point;
}

void CutMesh::Divide(std::size_t t, const std::array<int, 3>& points)
{
  struct Node
  {
    int Point;
    Eigen::Vector2d UV;
    Eigen::Vector3d Share; ///< of the triangle's corners
  };
  // corners and points on sides in a circle; side k begins at corner k
  std::vector<Node> ring;
  const std::array<int, 3> corners = this->Triangles[t];
  const Places uv = this->UV[t];
  for (std::size_t k = 0; k < 3; ++k)
  {
    const std::size_t next = (k + 1) % 3;
    const auto row = static_cast<Eigen::Index>(k);
    ring.push_back({ corners[k], uv[k], Eigen::Vector3d::Unit(row) });
    if (points[k] >= 0)
    {
      const OnEdge& on = this->NewPoints.at(points[k]);
      const bool forward = corners[k] == on.A;
      const double weight = forward ? on.Weight : 1.0 - on.Weight; // of the corner `next`
      // the same sum in both triangles beside the edge
      const Eigen::Vector2d& low = forward ? uv[k] : uv[next];
      const Eigen::Vector2d& high = forward ? uv[next] : uv[k];
      Eigen::Vector3d share = Eigen::Vector3d::Zero();
      share[row] = 1.0 - weight;
      share[static_cast<Eigen::Index>(next)] = weight;
      ring.push_back({ points[k], (1.0 - on.Weight) * low + on.Weight * high, share });
    }
  }
  const auto hasArea = [&](std::size_t a, std::size_t b, std::size_t c)
  {
    Eigen::Matrix3d shares; // a row of zeros, hence 0 exactly, for points of one side
    shares << ring[a].Share, ring[b].Share, ring[c].Share;
    return shares.determinant() > 0.0;
  };
  bool first = true;
  const auto emit = [&](std::size_t a, std::size_t b, std::size_t c)
  {
    const std::array<int, 3> triangle = { ring[a].Point, ring[b].Point, ring[c].Point };
    const Places at = { ring[a].UV, ring[b].UV, ring[c].UV };
    if (first)
    {
      this->Triangles[t] = triangle;
      this->UV[t] = at;
      first = false;
      return;
    }
    this->Triangles.push_back(triangle);
    this->UV.push_back(at);
    this->TriangleIds.push_back(this->TriangleIds[t]);
    this->Charts.push_back(this->Charts[t]);
    this->Sides.push_back(this->Sides[t]);
  };
  while (ring.size() > 3) // cut off the ear of the shortest diagonal
  {
    const std::size_t n = ring.size();
    std::size_t best = 0;
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; ++i)
    {
      const std::size_t before = (i + n - 1) % n;
      const std::size_t after = (i + 1) % n;
      const auto p = static_cast<std::size_t>(ring[before].Point);
      const auto q = static_cast<std::size_t>(ring[after].Point);
      const double length = (this->Points[p] - this->Points[q]).norm();
      const bool leavesArea = n > 4 || hasArea(after, (i + 2) % n, before);
      if (length < shortest && leavesArea && hasArea(before, i, after))
      {
        best = i;
        shortest = length;
      }
    }
    emit((best + n - 1) % n, best, (best + 1) % n);
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(best));
  }
  emit(0, 1, 2);
}

void CutMesh::Split(const std::unordered_map<std::uint64_t, int>& points)
{
  std::vector<char> touched(this->Points.size(), 0);
  for (const auto& [key, point] : points)
  {
    touched[static_cast<std::size_t>(key >> 32)] = 1;
    touched[static_cast<std::size_t>(key & 0xffffffffU)] = 1;
  }
  const std::size_t count = this->Triangles.size();
  for (std::size_t t = 0; t < count; ++t)
  {
    const std::array<int, 3> corners = this->Triangles[t];
    std::array<int, 3> onSides{ -1, -1, -1 };
    bool any = false;
    for (std::size_t k = 0; k < 3; ++k)
    {
      const int a = corners[k];
      const int b = corners[(k + 1) % 3];
      if (touched[static_cast<std::size_t>(a)] && touched[static_cast<std::size_t>(b)])
      {
        const auto found = points.find(EdgeKey(a, b));
        onSides[k] = found == points.end() ? -1 : found->second;
        any = any || onSides[k] >= 0;
      }
    }
    if (any)
    {
      this->Divide(t, onSides);
    }
  }
}

std::vector<int> CutMesh::TrianglesOf(int chart) const
{
  std::vector<int> triangles;
  for (std::size_t t = 0; t < this->Charts.size(); ++t)
  {
    if (this->Charts[t] == chart)
    {
      triangles.push_back(static_cast<int>(t));
    }
  }
  return triangles;
}

std::vector<std::vector<int>> Components(const CutMesh& mesh, const std::vector<int>& triangles)
{
  std::vector<std::array<int, 3>> corners;
  corners.reserve(triangles.size());
  for (int t : triangles)
  {
    corners.push_back(mesh.Triangles[static_cast<std::size_t>(t)]);
  }
  const auto adjacency = FindAdjacency(corners); // of a part of a manifold: no failure
  std::vector<std::vector<int>> components;
  std::vector<char> done(triangles.size(), 0);
  const auto side = [&](std::size_t i)
  { return mesh.Sides[static_cast<std::size_t>(triangles[i])]; };
  for (std::size_t start = 0; start < triangles.size(); ++start)
  {
    if (done[start])
    {
      continue;
    }
    done[start] = 1;
    std::vector<std::size_t> found{ start };
    for (std::size_t i = 0; i < found.size(); ++i)
    {
      for (int neighbour : adjacency.Value.Triangle[found[i]])
      {
        const auto other = static_cast<std::size_t>(neighbour);
        if (neighbour >= 0 && !done[other] && side(other) == side(start))
        {
          done[other] = 1;
          found.push_back(other);
        }
      }
    }
    std::sort(found.begin(), found.end());
    components.emplace_back();
    for (std::size_t i : found)
    {
      components.back().push_back(triangles[i]);
    }
  }
  return components;
}

Result<ChartPart> TakePart(const CutMesh& mesh, const std::vector<int>& triangles)
{
  std::vector<std::array<int, 3>> corners;
  corners.reserve(triangles.size());
  for (int t : triangles)
  {
    corners.push_back(mesh.Triangles[static_cast<std::size_t>(t)]);
  }
  const auto adjacency = FindAdjacency(corners);
  if (!adjacency)
  {
    return adjacency.Status;
  }
  // corners of triangles that share an edge at a point get one number
  Result<ChartPart> result;
  TriangleMesh part;
  part.Triangles.assign(triangles.size(), { -1, -1, -1 });
  std::vector<std::array<std::size_t, 2>> stack; // triangle, corner
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      if (part.Triangles[t][k] >= 0)
      {
        continue;
      }
      const int number = static_cast<int>(result.Value.Points.size());
      result.Value.Points.push_back(corners[t][k]);
      part.Triangles[t][k] = number;
      stack.push_back({ t, k });
      while (!stack.empty())
      {
        const auto [at, corner] = stack.back();
        stack.pop_back();
        // the side that begins at the corner and the one that ends there
        for (const std::size_t side : { corner, (corner + 2) % 3 })
        {
          const int other = adjacency.Value.Triangle[at][side];
          if (other < 0)
          {
            continue;
          }
          // sides of neighbours run against each other
          const auto there = static_cast<std::size_t>(other);
          const auto otherSide = static_cast<std::size_t>(adjacency.Value.Side[at][side]);
          const std::size_t otherCorner = side == corner ? (otherSide + 1) % 3 : otherSide;
          if (part.Triangles[there][otherCorner] < 0)
          {
            part.Triangles[there][otherCorner] = number;
            stack.push_back({ there, otherCorner });
          }
        }
      }
    }
  }
  SortPoints(result.Value.Points, part.Triangles);
  part.Points.resize(static_cast<Eigen::Index>(result.Value.Points.size()), 3);
  for (std::size_t v = 0; v < result.Value.Points.size(); ++v)
  {
    part.Points.row(static_cast<Eigen::Index>(v)) =
      mesh.Points[static_cast<std::size_t>(result.Value.Points[v])].transpose();
  }
  auto surface = CheckSurface(part);
  if (!surface)
  {
    return surface.Status;
  }
  result.Value.Mesh = std::move(surface.Value);
  result.Value.Triangles = triangles;
  return result;
}
}
