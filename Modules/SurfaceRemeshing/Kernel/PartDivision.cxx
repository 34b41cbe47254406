// SPDX-License-Identifier: BSD-3-Clause
#include "PartDivision.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace knotwork
{
namespace
{
using Kernel = ExactKernel;
using Point = ExactPoint;
using Segment = Kernel::Segment_3;
using Triangle = Kernel::Triangle_3;
using PlanePoint = Kernel::Point_2;

struct PlaneVertex
{
  int Point = -1;
};
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<PlaneVertex, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Division = CGAL::Constrained_Delaunay_triangulation_2<Kernel,
  CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>, CGAL::Exact_intersections_tag>;

/// What a triangle is divided along: numbers of points.
struct Cuts
{
  std::set<int> Points;
  std::set<std::pair<int, int>> Segments;
};

void AddCut(const std::vector<int>& points, bool closed, Cuts& cuts)
{
  cuts.Points.insert(points.begin(), points.end());
  for (std::size_t i = 0; i + (closed ? 0 : 1) < points.size(); ++i)
  {
    const int a = points[i];
    const int b = points[(i + 1) % points.size()];
    if (a != b)
    {
      cuts.Segments.emplace(std::min(a, b), std::max(a, b));
    }
  }
}

/// The common points of two triangles as cuts of both.
/// @return whether they overlap in an area.
bool CutEachOther(const Triangle& s, const Triangle& t, ExactPoints& points, Cuts& ofS, Cuts& ofT)
{
  const auto common = CGAL::intersection(s, t);
  if (!common)
  {
    return false;
  }
  std::vector<int> numbers;
  bool closed = false;
  if (const Point* point = boost::get<Point>(&*common))
  {
    numbers = { points.Number(*point) };
  }
  else if (const Segment* segment = boost::get<Segment>(&*common))
  {
    numbers = { points.Number(segment->source()), points.Number(segment->target()) };
  }
  else if (const Triangle* triangle = boost::get<Triangle>(&*common))
  {
    numbers = { points.Number((*triangle)[0]), points.Number((*triangle)[1]),
      points.Number((*triangle)[2]) };
    closed = true;
  }
  else if (const auto* polygon = boost::get<std::vector<Point>>(&*common))
  {
    for (const Point& corner : *polygon)
    {
      numbers.push_back(points.Number(corner));
    }
    closed = true;
  }
  AddCut(numbers, closed, ofS);
  AddCut(numbers, closed, ofT);
  return closed;
}

/// Divides one triangle along its cuts.
void DivideTriangle(
  const TrianglePart& part, const Cuts& cuts, ExactPoints& points, std::vector<TrianglePart>& parts)
{
  const Point& a = points[part.Corners[0]];
  const Point& b = points[part.Corners[1]];
  const Point& c = points[part.Corners[2]];
  const Kernel::Plane_3 plane(a, b, c);
  const double normal[3] = { std::abs(CGAL::to_double(plane.a())),
    std::abs(CGAL::to_double(plane.b())), std::abs(CGAL::to_double(plane.c())) };
  int axis = normal[1] > normal[0] ? 1 : 0;
  axis = normal[2] > normal[axis] ? 2 : axis;
  const auto coefficient = [&](int k) {
    return k == 0 ? plane.a() : k == 1 ? plane.b() : plane.c();
  };
  if (coefficient(axis) == 0)
  {
    axis = coefficient(0) != 0 ? 0 : coefficient(1) != 0 ? 1 : 2;
  }
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const auto flat = [&](const Point& p) { return PlanePoint(p[u], p[v]); };
  const auto lift = [&](const PlanePoint& p)
  {
    Kernel::FT xyz[3];
    xyz[u] = p.x();
    xyz[v] = p.y();
    xyz[axis] = -(coefficient(u) * p.x() + coefficient(v) * p.y() + plane.d()) / coefficient(axis);
    return Point(xyz[0], xyz[1], xyz[2]);
  };
  Division division;
  std::map<int, Division::Vertex_handle> vertices;
  const auto insert = [&](int point)
  {
    const auto found = vertices.find(point);
    if (found != vertices.end())
    {
      return found->second;
    }
    const auto vertex = division.insert(flat(points[point]));
    vertex->info().Point = point;
    vertices.emplace(point, vertex);
    return vertex;
  };
  for (int k = 0; k < 3; ++k)
  {
    insert(part.Corners[static_cast<std::size_t>(k)]);
  }
  for (const int point : cuts.Points)
  {
    insert(point);
  }
  for (int k = 0; k < 3; ++k)
  {
    division.insert_constraint(insert(part.Corners[static_cast<std::size_t>(k)]),
      insert(part.Corners[static_cast<std::size_t>((k + 1) % 3)]));
  }
  for (const auto& [first, second] : cuts.Segments)
  {
    division.insert_constraint(insert(first), insert(second));
  }
  const bool turned = coefficient(axis) < 0;
  for (auto face = division.finite_faces_begin(); face != division.finite_faces_end(); ++face)
  {
    TrianglePart piece{ {}, part.Source };
    for (int k = 0; k < 3; ++k)
    {
      const auto vertex = face->vertex(k);
      if (vertex->info().Point < 0)
      {
        vertex->info().Point = points.Number(lift(vertex->point()));
      }
      piece.Corners[static_cast<std::size_t>(k)] = vertex->info().Point;
    }
    if (turned)
    {
      std::swap(piece.Corners[1], piece.Corners[2]);
    }
    parts.push_back(piece);
  }
}

/// Divides parts along what pairs of them have in common.
/// @param overlapping  sources of parts that overlap others in an area.
std::vector<TrianglePart> Divide(const std::vector<TrianglePart>& parts,
  const std::vector<std::pair<int, int>>& pairs, ExactPoints& points, std::set<int>& overlapping)
{
  std::map<int, Cuts> cuts;
  for (const auto& [s, t] : pairs)
  {
    for (const int part : { s, t })
    {
      for (const int corner : parts[static_cast<std::size_t>(part)].Corners)
      {
        points.Register(corner);
      }
    }
  }
  const auto triangle = [&](int part)
  {
    const MeshTriangle& corners = parts[static_cast<std::size_t>(part)].Corners;
    return Triangle(points[corners[0]], points[corners[1]], points[corners[2]]);
  };
  for (const auto& [s, t] : pairs)
  {
    if (CutEachOther(triangle(s), triangle(t), points, cuts[s], cuts[t]))
    {
      overlapping.insert(parts[static_cast<std::size_t>(s)].Source);
      overlapping.insert(parts[static_cast<std::size_t>(t)].Source);
    }
  }
  std::vector<TrianglePart> divided;
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    const auto found = cuts.find(static_cast<int>(i));
    if (found == cuts.end())
    {
      divided.push_back(parts[i]);
    }
    else
    {
      DivideTriangle(parts[i], found->second, points, divided);
    }
  }
  return divided;
}

/// Pairs of parts of overlapping triangles that have an area in common without being the same:
/// triangulations of the common region may differ where four points lie on a circle.
std::vector<std::pair<int, int>> OverlappingParts(const std::vector<TrianglePart>& parts,
  const std::set<int>& overlapping, const ExactPoints& points)
{
  std::vector<int> candidates;
  PointMatrix lower(static_cast<Eigen::Index>(parts.size()), 3);
  PointMatrix upper(static_cast<Eigen::Index>(parts.size()), 3);
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    if (overlapping.count(parts[i].Source) > 0)
    {
      const MeshTriangle& corners = parts[i].Corners;
      const CGAL::Bbox_3 box =
        points[corners[0]].bbox() + points[corners[1]].bbox() + points[corners[2]].bbox();
      const auto row = static_cast<Eigen::Index>(candidates.size());
      lower.row(row) << box.xmin(), box.ymin(), box.zmin();
      upper.row(row) << box.xmax(), box.ymax(), box.zmax();
      candidates.push_back(static_cast<int>(i));
    }
  }
  std::vector<std::pair<int, int>> pairs;
  if (candidates.empty())
  {
    return pairs;
  }
  lower.conservativeResize(static_cast<Eigen::Index>(candidates.size()), Eigen::NoChange);
  upper.conservativeResize(static_cast<Eigen::Index>(candidates.size()), Eigen::NoChange);
  const BoxTree tree(lower, upper);
  for (std::size_t i = 0; i < candidates.size(); ++i)
  {
    const auto row = static_cast<Eigen::Index>(i);
    std::vector<std::size_t> others;
    tree.ForNear(lower.row(row).data(), upper.row(row).data(),
      [&](int j)
      {
        if (static_cast<std::size_t>(j) > i)
        {
          others.push_back(static_cast<std::size_t>(j));
        }
      });
    std::sort(others.begin(), others.end());
    for (const std::size_t j : others)
    {
      MeshTriangle a = parts[static_cast<std::size_t>(candidates[i])].Corners;
      MeshTriangle b = parts[static_cast<std::size_t>(candidates[j])].Corners;
      std::sort(a.begin(), a.end());
      std::sort(b.begin(), b.end());
      if (a == b)
      {
        continue;
      }
      const Triangle s(points[a[0]], points[a[1]], points[a[2]]);
      const Triangle t(points[b[0]], points[b[1]], points[b[2]]);
      if (s.supporting_plane().has_on(t[0]) && s.supporting_plane().has_on(t[1]) &&
        s.supporting_plane().has_on(t[2]))
      {
        const auto common = CGAL::intersection(s, t);
        if (common && (boost::get<Triangle>(&*common) || boost::get<std::vector<Point>>(&*common)))
        {
          pairs.emplace_back(candidates[i], candidates[j]);
        }
      }
    }
  }
  return pairs;
}
}

std::vector<TrianglePart> DivideAll(const std::vector<MeshTriangle>& triangles,
  std::vector<std::pair<int, int>> pairs, ExactPoints& points)
{
  std::vector<TrianglePart> parts;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    parts.push_back({ triangles[t], static_cast<int>(t) });
  }
  std::set<int> overlapping;
  constexpr int MostRounds = 8;
  for (int round = 0; round < MostRounds && !pairs.empty(); ++round)
  {
    parts = Divide(parts, pairs, points, overlapping);
    pairs = OverlappingParts(parts, overlapping, points);
  }
  return parts;
}
}
