// SPDX-License-Identifier: BSD-3-Clause
#include "FlipTriangulation.h"

#include <boost/multiprecision/cpp_int.hpp>

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Sign of the determinant that is positive when d lies inside the circle through a, b, c
/// (counterclockwise); exact.
int InCircle(const PlanarPoint& a, const PlanarPoint& b, const PlanarPoint& c, const PlanarPoint& d)
{
  double x[3];
  double y[3];
  const PlanarPoint* corners[3] = { &a, &b, &c };
  for (int i = 0; i < 3; ++i) // exact: differences of whole numbers of 41 bits
  {
    x[i] = (*corners[i])[0] - d[0];
    y[i] = (*corners[i])[1] - d[1];
  }
  double sum = 0.0;
  double magnitude = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    const double lift = x[i] * x[i] + y[i] * y[i];
    const double left = x[j] * y[k];
    const double right = y[j] * x[k];
    sum += lift * (left - right);
    magnitude += lift * (std::abs(left) + std::abs(right));
  }
  // Six roundings of each term, two of the sum.
  if (std::abs(sum) > 16.0 * 1.2e-16 * magnitude)
  {
    return sum > 0.0 ? 1 : -1;
  }
  using Whole = boost::multiprecision::int256_t;
  Whole exact = 0;
  for (int i = 0; i < 3; ++i)
  {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    const Whole xi = static_cast<long long>(x[i]);
    const Whole yi = static_cast<long long>(y[i]);
    const Whole left = Whole(static_cast<long long>(x[j])) * static_cast<long long>(y[k]);
    const Whole right = Whole(static_cast<long long>(y[j])) * static_cast<long long>(x[k]);
    exact += (xi * xi + yi * yi) * (left - right);
  }
  return exact.sign();
}

/// Triangles and, around the hull, triangles with the point at infinity, which has the number
/// after the last one. Corners are counterclockwise; neighbour i is opposite to corner i.
class FlipMesh
{
public:
  explicit FlipMesh(const std::vector<PlanarPoint>& points)
    : Points(points), Infinite(static_cast<int>(points.size())), TriangleAt(points.size() + 1, -1)
  {
  }

  bool InsertPoints();
  bool InsertSegment(int a, int b);
  std::vector<std::array<int, 3>> FiniteTriangles() const;

private:
  struct Triangle
  {
    std::array<int, 3> Corners{};
    std::array<int, 3> Neighbors{};
    std::array<bool, 3> Fixed{};
  };
  struct Edge // of a triangle, opposite to its corner
  {
    int Triangle;
    int Corner;
  };

  bool Start(std::vector<int>& order);
  int Locate(const PlanarPoint& p) const;
  void InsertPoint(int p);
  void SplitTriangle(int t, int p);
  void SplitEdge(Edge edge, int p);
  void Legalize(std::vector<Edge>& edges, int p);
  void Flip(Edge edge);
  void Set(int t, const std::array<int, 3>& corners, const std::array<int, 3>& neighbors);
  int MirrorCorner(Edge edge) const;
  bool IsBad(Edge edge) const;
  bool IsGhost(int t) const
  {
    const auto& c = this->Triangles[At(t)].Corners;
    return c[0] == this->Infinite || c[1] == this->Infinite || c[2] == this->Infinite;
  }
  bool Inside(const Triangle& t, const PlanarPoint& p) const;
  Edge FindEdge(int a, int b) const;
  int Side(int a, int b, int p) const
  {
    return Orientation(this->Points[At(a)], this->Points[At(b)], this->Points[At(p)]);
  }

  const std::vector<PlanarPoint>& Points;
  int Infinite;
  std::vector<Triangle> Triangles;
  std::vector<int> TriangleAt; ///< a triangle at each point
  mutable int Last = 0;        ///< where the search for the next point begins
};

void FlipMesh::Set(int t, const std::array<int, 3>& corners, const std::array<int, 3>& neighbors)
{
  this->Triangles[At(t)] = { corners, neighbors, { false, false, false } };
  for (int corner : corners)
  {
    this->TriangleAt[At(corner)] = t;
  }
}

/// Corner of the neighbour across an edge that is not on the edge.
int FlipMesh::MirrorCorner(Edge edge) const
{
  const int other = this->Triangles[At(edge.Triangle)].Neighbors[At(edge.Corner)];
  const auto& neighbors = this->Triangles[At(other)].Neighbors;
  const auto& mine = this->Triangles[At(edge.Triangle)].Corners;
  for (int i = 0; i < 3; ++i) // two triangles may be neighbours twice while there are few
  {
    if (neighbors[At(i)] == edge.Triangle &&
      this->Triangles[At(other)].Corners[At((i + 1) % 3)] == mine[At((edge.Corner + 2) % 3)])
    {
      return i;
    }
  }
  return -1;
}

/// Whether a point lies inside the circumcircle; for the point at infinity that is the half plane
/// outside the hull's edge.
bool FlipMesh::Inside(const Triangle& t, const PlanarPoint& p) const
{
  for (int i = 0; i < 3; ++i)
  {
    if (t.Corners[At(i)] == this->Infinite)
    {
      return Orientation(this->Points[At(t.Corners[At((i + 1) % 3)])],
               this->Points[At(t.Corners[At((i + 2) % 3)])], p) > 0;
    }
  }
  return InCircle(this->Points[At(t.Corners[0])], this->Points[At(t.Corners[1])],
           this->Points[At(t.Corners[2])], p) > 0;
}

/// Whether an edge is not Delaunay.
bool FlipMesh::IsBad(Edge edge) const
{
  const Triangle& t = this->Triangles[At(edge.Triangle)];
  const Triangle& other = this->Triangles[At(t.Neighbors[At(edge.Corner)])];
  const int p = other.Corners[At(this->MirrorCorner(edge))];
  if (p == this->Infinite)
  {
    const int mine = t.Corners[At(edge.Corner)];
    return mine != this->Infinite && this->Inside(other, this->Points[At(mine)]);
  }
  return this->Inside(t, this->Points[At(p)]);
}

void FlipMesh::Flip(Edge edge)
{
  const int t = edge.Triangle;
  const int i = edge.Corner;
  const int j = this->MirrorCorner(edge);
  const Triangle mine = this->Triangles[At(t)];
  const int u = mine.Neighbors[At(i)];
  const Triangle other = this->Triangles[At(u)];
  const std::size_t i1 = At((i + 1) % 3);
  const std::size_t i2 = At((i + 2) % 3);
  const std::size_t j1 = At((j + 1) % 3);
  const std::size_t j2 = At((j + 2) % 3);
  const int p = mine.Corners[At(i)];
  const int q = other.Corners[At(j)];
  const int a = mine.Corners[i1];
  const int b = mine.Corners[i2];
  const auto replace = [this](int triangle, int corner, int with)
  {
    Triangle& outer = this->Triangles[At(triangle)];
    for (std::size_t k = 0; k < 3; ++k)
    {
      if (outer.Corners[k] == corner)
      {
        outer.Neighbors[k] = with;
      }
    }
  };
  // Outer triangles that change sides, by their corner off the common edge.
  const int acrossA = mine.Neighbors[i1];
  const int cornerA =
    this->Triangles[At(acrossA)].Corners[At(this->MirrorCorner({ t, static_cast<int>(i1) }))];
  const int acrossB = other.Neighbors[j1];
  const int cornerB =
    this->Triangles[At(acrossB)].Corners[At(this->MirrorCorner({ u, static_cast<int>(j1) }))];
  this->Set(t, { p, a, q }, { acrossB, u, mine.Neighbors[i2] });
  this->Set(u, { q, b, p }, { acrossA, t, other.Neighbors[j2] });
  this->Triangles[At(t)].Fixed = { other.Fixed[j1], false, mine.Fixed[i2] };
  this->Triangles[At(u)].Fixed = { mine.Fixed[i1], false, other.Fixed[j2] };
  replace(acrossA, cornerA, u);
  replace(acrossB, cornerB, t);
}

/// Flips edges opposite to a new point until all are Delaunay.
void FlipMesh::Legalize(std::vector<Edge>& edges, int p)
{
  while (!edges.empty())
  {
    const Edge edge = edges.back();
    edges.pop_back();
    if (!this->IsBad(edge))
    {
      continue;
    }
    const int other = this->Triangles[At(edge.Triangle)].Neighbors[At(edge.Corner)];
    this->Flip(edge);
    for (int t : { edge.Triangle, other })
    {
      for (int i = 0; i < 3; ++i)
      {
        if (this->Triangles[At(t)].Corners[At(i)] == p)
        {
          edges.push_back({ t, i });
        }
      }
    }
  }
}

void FlipMesh::SplitTriangle(int t, int p)
{
  const Triangle old = this->Triangles[At(t)];
  const auto& [a, b, c] = old.Corners;
  std::array<int, 3> mirrors;
  for (int i = 0; i < 3; ++i)
  {
    mirrors[At(i)] = this->MirrorCorner({ t, i });
  }
  const int t1 = static_cast<int>(this->Triangles.size());
  const int t2 = t1 + 1;
  this->Triangles.resize(At(t2) + 1);
  this->Set(t, { p, b, c }, { old.Neighbors[0], t1, t2 });
  this->Set(t1, { p, c, a }, { old.Neighbors[1], t2, t });
  this->Set(t2, { p, a, b }, { old.Neighbors[2], t, t1 });
  this->Triangles[At(old.Neighbors[1])].Neighbors[At(mirrors[1])] = t1;
  this->Triangles[At(old.Neighbors[2])].Neighbors[At(mirrors[2])] = t2;
  std::vector<Edge> edges{ { t, 0 }, { t1, 0 }, { t2, 0 } };
  this->Legalize(edges, p);
}

void FlipMesh::SplitEdge(Edge edge, int p)
{
  // (a, b) is the edge, c and d the corners across.
  const int t = edge.Triangle;
  const int j = this->MirrorCorner(edge);
  const Triangle mine = this->Triangles[At(t)];
  const int u = mine.Neighbors[At(edge.Corner)];
  const Triangle other = this->Triangles[At(u)];
  const std::size_t i1 = At((edge.Corner + 1) % 3);
  const std::size_t i2 = At((edge.Corner + 2) % 3);
  const std::size_t j1 = At((j + 1) % 3);
  const std::size_t j2 = At((j + 2) % 3);
  const int c = mine.Corners[At(edge.Corner)];
  const int d = other.Corners[At(j)];
  const int a = mine.Corners[i1];
  const int b = mine.Corners[i2];
  const int acrossA = mine.Neighbors[i1]; // beyond (b, c)
  const int mirrorA = this->MirrorCorner({ t, static_cast<int>(i1) });
  const int acrossB = other.Neighbors[j2]; // beyond (d, b)
  const int mirrorB = this->MirrorCorner({ u, static_cast<int>(j2) });
  const int t1 = static_cast<int>(this->Triangles.size());
  const int u1 = t1 + 1;
  this->Triangles.resize(At(u1) + 1);
  this->Set(t, { p, c, a }, { mine.Neighbors[i2], u, t1 });
  this->Set(t1, { p, b, c }, { acrossA, t, u1 });
  this->Set(u, { p, a, d }, { other.Neighbors[j1], u1, t });
  this->Set(u1, { p, d, b }, { acrossB, t1, u });
  this->Triangles[At(acrossA)].Neighbors[At(mirrorA)] = t1;
  this->Triangles[At(acrossB)].Neighbors[At(mirrorB)] = u1;
  std::vector<Edge> edges{ { t, 0 }, { t1, 0 }, { u, 0 }, { u1, 0 } };
  this->Legalize(edges, p);
}

/// A triangle that has a point inside or on an edge; a triangle beyond the hull when the point is
/// strictly outside the hull's edge. In a Delaunay triangulation the walk towards the point ends.
int FlipMesh::Locate(const PlanarPoint& p) const
{
  int t = this->Last;
  if (this->IsGhost(t))
  {
    const auto& triangle = this->Triangles[At(t)];
    const auto infinite =
      std::find(triangle.Corners.begin(), triangle.Corners.end(), this->Infinite);
    t = triangle.Neighbors[static_cast<std::size_t>(infinite - triangle.Corners.begin())];
  }
  for (bool moved = true; moved && !this->IsGhost(t);)
  {
    moved = false;
    const Triangle& triangle = this->Triangles[At(t)];
    for (int i = 0; i < 3 && !moved; ++i)
    {
      if (Orientation(this->Points[At(triangle.Corners[At((i + 1) % 3)])],
            this->Points[At(triangle.Corners[At((i + 2) % 3)])], p) < 0)
      {
        t = triangle.Neighbors[At(i)];
        moved = true;
      }
    }
  }
  return t;
}

void FlipMesh::InsertPoint(int p)
{
  const PlanarPoint& point = this->Points[At(p)];
  const int t = this->Locate(point);
  this->Last = t;
  if (!this->IsGhost(t))
  {
    const auto& corners = this->Triangles[At(t)].Corners;
    for (int i = 0; i < 3; ++i)
    {
      if (this->Points[At(corners[At(i)])] == point)
      {
        return; // it is there already
      }
    }
    for (int i = 0; i < 3; ++i)
    {
      if (this->Side(corners[At((i + 1) % 3)], corners[At((i + 2) % 3)], p) == 0)
      {
        this->SplitEdge({ t, i }, p);
        return;
      }
    }
  }
  this->SplitTriangle(t, p);
}

/// The first three points that are not on a line make up the first triangle.
bool FlipMesh::Start(std::vector<int>& order)
{
  if (order.size() < 3)
  {
    return false;
  }
  const auto second = std::find_if(order.begin() + 1, order.end(),
    [&](int p) { return this->Points[At(p)] != this->Points[At(order[0])]; });
  if (second == order.end())
  {
    return false;
  }
  std::rotate(order.begin() + 1, second, second + 1);
  const auto third = std::find_if(
    order.begin() + 2, order.end(), [&](int p) { return this->Side(order[0], order[1], p) != 0; });
  if (third == order.end())
  {
    return false;
  }
  std::rotate(order.begin() + 2, third, third + 1);
  std::array<int, 3> c{ order[0], order[1], order[2] };
  if (this->Side(c[0], c[1], c[2]) < 0)
  {
    std::swap(c[1], c[2]);
  }
  this->Triangles.resize(4);
  this->Set(0, c, { 1, 2, 3 });
  this->Set(1, { this->Infinite, c[2], c[1] }, { 0, 3, 2 });
  this->Set(2, { this->Infinite, c[0], c[2] }, { 0, 1, 3 });
  this->Set(3, { this->Infinite, c[1], c[0] }, { 0, 2, 1 });
  return true;
}

bool FlipMesh::InsertPoints()
{
  // Rows of alternating direction: the next point is near the last one.
  std::vector<int> order(this->Points.size());
  std::iota(order.begin(), order.end(), 0);
  double low = 0.0;
  double high = 0.0;
  for (const PlanarPoint& p : this->Points)
  {
    low = std::min(low, p[1]);
    high = std::max(high, p[1]);
  }
  const double rows = std::ceil(std::sqrt(static_cast<double>(order.size())));
  const auto row = [&](int p)
  { return std::floor((this->Points[At(p)][1] - low) / (high - low + 1.0) * rows); };
  std::sort(order.begin(), order.end(),
    [&](int a, int b)
    {
      const double rowA = row(a);
      const double rowB = row(b);
      if (rowA != rowB)
      {
        return rowA < rowB;
      }
      const double xa = this->Points[At(a)][0];
      const double xb = this->Points[At(b)][0];
      if (xa != xb)
      {
        return std::fmod(rowA, 2.0) == 0.0 ? xa < xb : xa > xb;
      }
      return a < b;
    });
  if (!this->Start(order))
  {
    return false;
  }
  this->Triangles.reserve(2 * order.size() + 4);
  for (std::size_t i = 3; i < order.size(); ++i)
  {
    this->InsertPoint(order[i]);
  }
  return true;
}

/// The triangle that has the edge from a to b (in this direction), by its corner opposite to it;
/// -1: none.
FlipMesh::Edge FlipMesh::FindEdge(int a, int b) const
{
  const int first = this->TriangleAt[At(a)];
  int t = first;
  do
  {
    const Triangle& triangle = this->Triangles[At(t)];
    const int i = triangle.Corners[0] == a ? 0 : (triangle.Corners[1] == a ? 1 : 2);
    if (triangle.Corners[At((i + 1) % 3)] == b)
    {
      return { t, (i + 2) % 3 };
    }
    t = triangle.Neighbors[At((i + 1) % 3)];
  } while (t != first);
  return { -1, -1 };
}

/// @return false when a point or a segment is in the way.
bool FlipMesh::InsertSegment(int a, int b)
{
  if (this->TriangleAt[At(a)] < 0 || this->TriangleAt[At(b)] < 0)
  {
    return false; // a copy of another point
  }
  std::deque<std::array<int, 2>> crossed; // edges from the right of the segment to its left
  std::vector<std::array<int, 2>> made;
  if (this->FindEdge(a, b).Triangle < 0)
  {
    // The triangle at a through whose opposite edge the segment leaves.
    const int first = this->TriangleAt[At(a)];
    int t = first;
    Edge exit{ -1, -1 };
    do
    {
      const Triangle& triangle = this->Triangles[At(t)];
      const int i = triangle.Corners[0] == a ? 0 : (triangle.Corners[1] == a ? 1 : 2);
      const int right = triangle.Corners[At((i + 1) % 3)];
      const int left = triangle.Corners[At((i + 2) % 3)];
      if (right != this->Infinite && left != this->Infinite && this->Side(a, b, right) < 0 &&
        this->Side(a, b, left) > 0 && this->Side(right, left, a) != this->Side(right, left, b))
      {
        exit = { t, i };
      }
      t = triangle.Neighbors[At((i + 1) % 3)];
    } while (t != first && exit.Triangle < 0);
    while (exit.Triangle >= 0)
    {
      const Triangle& triangle = this->Triangles[At(exit.Triangle)];
      const int right = triangle.Corners[At((exit.Corner + 1) % 3)];
      const int left = triangle.Corners[At((exit.Corner + 2) % 3)];
      if (triangle.Fixed[At(exit.Corner)])
      {
        return false;
      }
      crossed.push_back({ right, left });
      const int j = this->MirrorCorner(exit);
      const int next = triangle.Neighbors[At(exit.Corner)];
      const int apex = this->Triangles[At(next)].Corners[At(j)];
      if (apex == b)
      {
        break;
      }
      const int side = apex == this->Infinite ? 0 : this->Side(a, b, apex);
      if (side == 0)
      {
        return false;
      }
      // In the neighbour corner j + 1 is left, j + 2 is right.
      exit = { next, side > 0 ? (j + 1) % 3 : (j + 2) % 3 };
    }
    if (crossed.empty())
    {
      return false;
    }
  }
  while (!crossed.empty())
  {
    const auto [right, left] = crossed.front();
    crossed.pop_front();
    const Edge edge = this->FindEdge(right, left);
    const int p = this->Triangles[At(edge.Triangle)].Corners[At(edge.Corner)];
    const int q = this->Triangles[At(this->Triangles[At(edge.Triangle)].Neighbors[At(edge.Corner)])]
                    .Corners[At(this->MirrorCorner(edge))];
    if (this->Side(p, q, right) * this->Side(p, q, left) >= 0) // not convex: later
    {
      crossed.push_back({ right, left });
      continue;
    }
    this->Flip(edge);
    const int sideP = p == a || p == b ? 0 : this->Side(a, b, p);
    const int sideQ = q == a || q == b ? 0 : this->Side(a, b, q);
    if (sideP * sideQ < 0)
    {
      crossed.push_back(sideP < 0 ? std::array<int, 2>{ p, q } : std::array<int, 2>{ q, p });
    }
    else
    {
      made.push_back({ p, q });
    }
  }
  for (const auto& [begin, end] : { std::array<int, 2>{ a, b }, std::array<int, 2>{ b, a } })
  {
    const Edge edge = this->FindEdge(begin, end);
    this->Triangles[At(edge.Triangle)].Fixed[At(edge.Corner)] = true;
  }
  // Edges that were made on the way become Delaunay.
  while (!made.empty())
  {
    const auto [begin, end] = made.back();
    made.pop_back();
    const Edge edge = this->FindEdge(begin, end);
    if (edge.Triangle < 0)
    {
      continue;
    }
    const Triangle mine = this->Triangles[At(edge.Triangle)];
    const int across = mine.Neighbors[At(edge.Corner)];
    if (mine.Fixed[At(edge.Corner)] || this->IsGhost(edge.Triangle) || this->IsGhost(across) ||
      !this->IsBad(edge))
    {
      continue;
    }
    const int p = mine.Corners[At(edge.Corner)];
    const int q = this->Triangles[At(across)].Corners[At(this->MirrorCorner(edge))];
    this->Flip(edge);
    for (int corner : { begin, end })
    {
      made.push_back({ p, corner });
      made.push_back({ q, corner });
    }
  }
  return true;
}

std::vector<std::array<int, 3>> FlipMesh::FiniteTriangles() const
{
  std::vector<std::array<int, 3>> triangles;
  for (std::size_t t = 0; t < this->Triangles.size(); ++t)
  {
    if (!this->IsGhost(static_cast<int>(t)))
    {
      std::array<int, 3> corners = this->Triangles[t].Corners;
      std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
      triangles.push_back(corners);
    }
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}
}

Result<std::vector<std::array<int, 3>>> FlipTriangulation(
  const std::vector<PlanarPoint>& points, const std::vector<PlanarSegment>& segments)
{
  FlipMesh mesh(points);
  if (!mesh.InsertPoints())
  {
    return { ErrorCode::InvalidTopology, "all points lie on a line" };
  }
  for (const PlanarSegment& segment : segments)
  {
    if (!mesh.InsertSegment(segment[0], segment[1]))
    {
      return { ErrorCode::InvalidTopology, "points of segments coincide, or segments cross" };
    }
  }
  return mesh.FiniteTriangles();
}
}
