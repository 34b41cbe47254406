// SPDX-License-Identifier: BSD-3-Clause
#include "MeshSlide.h"

#include <knotwork/SplineCore/AngleBetween.h>
#include <knotwork/SplineCore/DisjointSets.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

Eigen::Vector3d AreaVector(const SurfaceQuad& surface, const PointMatrix& points)
{
  const std::array<int, 4>& quad = surface.Corners;
  const Eigen::Vector3d a = points.row(quad[2]) - points.row(quad[0]);
  const Eigen::Vector3d b = points.row(quad[3]) - points.row(quad[1]);
  return a.cross(b);
}

double DegreesBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  return AngleBetween(a, b) * 180.0 / static_cast<double>(EIGEN_PI);
}

/// An edge of a quadrilateral, the lower point first.
struct QuadEdge
{
  std::array<int, 2> Points;
  int Quad;
  bool IsForward;

  bool operator<(const QuadEdge& other) const
  {
    return this->Points != other.Points ? this->Points < other.Points : this->Quad < other.Quad;
  }
};

/// Triangles on only the points that they have.
TriangleIndex<3> MakeGuide(std::vector<MeshTriangle> triangles, const PointMatrix& points)
{
  std::vector<int> used;
  for (const MeshTriangle& triangle : triangles)
  {
    used.insert(used.end(), triangle.begin(), triangle.end());
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  PointMatrix of(static_cast<Eigen::Index>(used.size()), 3);
  for (std::size_t i = 0; i < used.size(); ++i)
  {
    of.row(static_cast<Eigen::Index>(i)) = points.row(used[i]);
  }
  for (MeshTriangle& triangle : triangles)
  {
    for (int& corner : triangle)
    {
      corner = static_cast<int>(std::lower_bound(used.begin(), used.end(), corner) - used.begin());
    }
  }
  return { std::move(of), std::move(triangles) };
}
}

MeshSlide::MeshSlide(const std::vector<SurfaceQuad>& quads, const PointMatrix& points, double angle,
  const std::vector<Edge>& marked)
  : Freedoms(static_cast<std::size_t>(points.rows()), Freedom::Space),
    Guide(static_cast<std::size_t>(points.rows()), -1)
{
  std::vector<int> region;
  const std::vector<Edge> edges = this->FindEdges(quads, points, angle, marked, region);
  const bool isPlane = (points.col(2).array() == points(0, 2)).all();
  for (const SurfaceQuad& quad : quads)
  {
    for (const int point : quad.Corners)
    {
      this->Freedoms[At(point)] = isPlane ? Freedom::Plane : Freedom::Surface;
    }
  }
  this->FindCorners(quads, edges, points);
  this->MakeRegions(quads, points, region);
  this->MakeChains(edges, points);
}

/// @param region  of every quadrilateral: a quadrilateral that it hangs together with.
std::vector<MeshSlide::Edge> MeshSlide::FindEdges(const std::vector<SurfaceQuad>& quads,
  const PointMatrix& points, double angle, const std::vector<Edge>& marked,
  std::vector<int>& region) const
{
  std::vector<Edge> sharp = marked;
  for (Edge& edge : sharp)
  {
    std::sort(edge.begin(), edge.end());
  }
  std::sort(sharp.begin(), sharp.end());
  std::vector<QuadEdge> sides;
  sides.reserve(quads.size() * 4);
  for (std::size_t q = 0; q < quads.size(); ++q)
  {
    for (std::size_t k = 0; k < 4; ++k)
    {
      const auto [low, high] = std::minmax(quads[q].Corners[k], quads[q].Corners[(k + 1) % 4]);
      sides.push_back({ { low, high }, static_cast<int>(q), low == quads[q].Corners[k] });
    }
  }
  std::sort(sides.begin(), sides.end());
  DisjointSets regions(static_cast<int>(quads.size()));
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < sides.size();)
  {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].Points == sides[i].Points)
    {
      ++end;
    }
    const bool isInner = end == i + 2;
    bool isSharp = !isInner || std::binary_search(sharp.begin(), sharp.end(), sides[i].Points);
    if (!isSharp)
    {
      const SurfaceQuad& one = quads[At(sides[i].Quad)];
      const SurfaceQuad& other = quads[At(sides[i + 1].Quad)];
      const double turn = sides[i].IsForward == sides[i + 1].IsForward ? -1.0 : 1.0;
      const double between =
        DegreesBetween(AreaVector(one, points), turn * AreaVector(other, points));
      isSharp = between > angle && !(between > OppositeAngle && (one.IsFolded || other.IsFolded));
    }
    if (!isSharp)
    {
      regions.Unite(sides[i].Quad, sides[i + 1].Quad);
    }
    else
    {
      edges.push_back(sides[i].Points);
    }
    i = end;
  }
  region.resize(quads.size());
  for (std::size_t q = 0; q < quads.size(); ++q)
  {
    region[q] = regions.Find(static_cast<int>(q));
  }
  return edges;
}

void MeshSlide::FindCorners(
  const std::vector<SurfaceQuad>& quads, const std::vector<Edge>& edges, const PointMatrix& points)
{
  std::vector<char> isFolded(this->Freedoms.size(), 0);
  for (const SurfaceQuad& quad : quads)
  {
    for (const int point : quad.Corners)
    {
      isFolded[At(point)] |= quad.IsFolded ? 1 : 0;
    }
  }
  std::vector<std::array<int, 3>> ends(this->Freedoms.size()); // number, and two neighbours
  for (const Edge& edge : edges)
  {
    for (std::size_t e = 0; e < 2; ++e)
    {
      std::array<int, 3>& end = ends[At(edge[e])];
      if (++end[0] <= 2)
      {
        end[At(end[0])] = edge[1 - e];
      }
    }
  }
  for (std::size_t i = 0; i < ends.size(); ++i)
  {
    const auto& [count, before, after] = ends[i];
    if (count == 0)
    {
      continue;
    }
    const auto at = static_cast<Eigen::Index>(i);
    const double turn = count == 2
      ? DegreesBetween(points.row(at) - points.row(before), points.row(after) - points.row(at))
      : 180.0;
    const bool isStraight =
      count == 2 && (turn <= CornerAngle || (turn >= OppositeAngle && isFolded[i] != 0));
    this->Freedoms[i] = isStraight ? Freedom::Edge : Freedom::None;
  }
}

/// Surfaces in four triangles a quadrilateral, around its middle.
void MeshSlide::MakeRegions(
  const std::vector<SurfaceQuad>& quads, const PointMatrix& points, const std::vector<int>& region)
{
  const auto numPoints = points.rows();
  PointMatrix all(numPoints + static_cast<Eigen::Index>(quads.size()), 3);
  all.topRows(numPoints) = points;
  std::vector<std::vector<MeshTriangle>> triangles;
  std::vector<int> numberOf(quads.size(), -1);
  for (std::size_t q = 0; q < quads.size(); ++q)
  {
    int& number = numberOf[At(region[q])];
    if (number < 0)
    {
      number = static_cast<int>(triangles.size());
      triangles.emplace_back();
    }
    const auto middle = numPoints + static_cast<Eigen::Index>(q);
    all.row(middle).setZero();
    for (std::size_t k = 0; k < 4; ++k)
    {
      const int point = quads[q].Corners[k];
      all.row(middle) += 0.25 * points.row(point);
      triangles[At(number)].push_back(
        { point, quads[q].Corners[(k + 1) % 4], static_cast<int>(middle) });
      if (this->Of(point) == Freedom::Surface)
      {
        this->Guide[At(point)] = number;
      }
    }
  }
  for (std::vector<MeshTriangle>& of : triangles)
  {
    this->Guides.push_back(MakeGuide(std::move(of), all));
  }
}

/// Edges between corners, and closed ones.
void MeshSlide::MakeChains(const std::vector<Edge>& edges, const PointMatrix& points)
{
  std::vector<int> first(this->Freedoms.size(), -1); // edge of a point
  DisjointSets chains(static_cast<int>(edges.size()));
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    for (const int point : edges[i])
    {
      if (this->Of(point) == Freedom::Edge)
      {
        if (first[At(point)] < 0)
        {
          first[At(point)] = static_cast<int>(i);
        }
        chains.Unite(first[At(point)], static_cast<int>(i));
      }
    }
  }
  std::vector<int> numberOf(edges.size(), -1);
  std::vector<std::vector<MeshTriangle>> segments;
  const auto before = static_cast<int>(this->Guides.size());
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    int& number = numberOf[At(chains.Find(static_cast<int>(i)))];
    if (number < 0)
    {
      number = static_cast<int>(segments.size());
      segments.emplace_back();
    }
    segments[At(number)].push_back({ edges[i][0], edges[i][1], edges[i][1] });
    for (const int point : edges[i])
    {
      if (this->Of(point) == Freedom::Edge)
      {
        this->Guide[At(point)] = before + number;
      }
    }
  }
  for (std::vector<MeshTriangle>& of : segments)
  {
    this->Guides.push_back(MakeGuide(std::move(of), points));
  }
}

Eigen::RowVector3d MeshSlide::Nearest(int point, const Eigen::RowVector3d& at) const
{
  if (this->Guide[At(point)] < 0)
  {
    return at;
  }
  const TriangleIndex<3>& guide = this->GuideOf(point);
  const TriangleFoot foot = guide.Nearest(at.data());
  return guide.PointAt(foot.Triangle, foot.Second, foot.Third);
}

Eigen::Matrix<double, 3, Eigen::Dynamic> MeshSlide::Directions(
  int point, const Eigen::RowVector3d& at) const
{
  if (this->Of(point) == Freedom::Space)
  {
    return Eigen::Matrix3d::Identity();
  }
  if (this->Of(point) == Freedom::Plane)
  {
    return Eigen::Matrix3d::Identity().leftCols(2);
  }
  if (this->Of(point) == Freedom::None)
  {
    return Eigen::Matrix<double, 3, Eigen::Dynamic>(3, 0);
  }
  const TriangleIndex<3>& guide = this->GuideOf(point);
  const int triangle = guide.Nearest(at.data()).Triangle;
  using Corner = Eigen::Map<const Eigen::Vector3d>;
  const Corner a(guide.Corner(triangle, 0));
  const Corner b(guide.Corner(triangle, 1));
  const Corner c(guide.Corner(triangle, 2));
  const Eigen::Vector3d along = (b - a).normalized();
  if (this->Of(point) == Freedom::Edge)
  {
    return along;
  }
  Eigen::Matrix<double, 3, Eigen::Dynamic> directions(3, 2);
  directions << along, (b - a).cross(c - a).cross(along).normalized();
  return directions;
}
}
