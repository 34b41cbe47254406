// SPDX-License-Identifier: BSD-3-Clause
#include "SheetArrangement.h"

#include <knotwork/SplineCore/DisjointSets.h>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <Eigen/Geometry>

#include <cmath>
#include <map>
#include <set>

namespace knotwork
{
namespace
{
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Point = Kernel::Point_3;
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

/// Points by their exact place.
class ExactPoints
{
public:
  explicit ExactPoints(const PointMatrix& points)
  {
    for (Eigen::Index i = 0; i < points.rows(); ++i)
    {
      this->Places.emplace_back(points(i, 0), points(i, 1), points(i, 2));
    }
    this->NumGiven = static_cast<int>(points.rows());
  }
  /// Corners of triangles that are divided are found by their places.
  void Register(int point)
  {
    this->Numbers.emplace(this->Places[static_cast<std::size_t>(point)], point);
  }
  int Number(const Point& place)
  {
    const auto [found, isNew] = this->Numbers.emplace(place, static_cast<int>(this->Places.size()));
    if (isNew)
    {
      place.exact(); // the tree of its making is not needed any more
      this->Places.push_back(place);
    }
    return found->second;
  }
  const Point& operator[](int point) const { return this->Places[static_cast<std::size_t>(point)]; }
  int Size() const { return static_cast<int>(this->Places.size()); }
  int NumGiven = 0;

private:
  std::vector<Point> Places;
  std::map<Point, int, Kernel::Less_xyz_3> Numbers;
};

Eigen::RowVector3d Rounded(const Point& p)
{
  return { CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z()) };
}

struct Part
{
  MeshTriangle Corners;
  int Source;
};

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
  const Part& part, const Cuts& cuts, ExactPoints& points, std::vector<Part>& parts)
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
    Part piece{ {}, part.Source };
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
std::vector<Part> Divide(const std::vector<Part>& parts,
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
  std::vector<Part> divided;
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
std::vector<std::pair<int, int>> OverlappingParts(
  const std::vector<Part>& parts, const std::set<int>& overlapping, const ExactPoints& points)
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

std::vector<Part> DivideAll(const std::vector<MeshTriangle>& triangles,
  std::vector<std::pair<int, int>> pairs, ExactPoints& points)
{
  std::vector<Part> parts;
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

/// Takes short edges and flat triangles away that divisions made: rounding and moving would turn
/// them over. Points are put on others, or edges led through points; what is closed stays closed.
class Snapping
{
public:
  Snapping(
    std::vector<Part>& parts, std::vector<char> divided, const ExactPoints& points, double distance)
    : Parts(parts), Divided(std::move(divided)), Points(points), Distance(distance)
  {
  }
  void Run()
  {
    constexpr int MostRounds = 10;
    for (int round = 0; round < MostRounds; ++round)
    {
      const bool any = this->JoinPoints();
      if (!this->LeadEdges() && !any)
      {
        return;
      }
    }
  }

private:
  bool MayGo(const Part& part) const
  {
    return this->Divided[static_cast<std::size_t>(part.Source)] != 0;
  }
  Eigen::Vector3d At(int point) const { return Rounded(this->Points[point]).transpose(); }

  bool JoinPoints()
  {
    std::map<int, int> target;
    const auto find = [&](int point)
    {
      for (auto found = target.find(point); found != target.end(); found = target.find(point))
      {
        point = found->second;
      }
      return point;
    };
    for (const Part& part : this->Parts)
    {
      if (!this->MayGo(part))
      {
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k)
      {
        const int a = find(part.Corners[k]);
        const int b = find(part.Corners[(k + 1) % 3]);
        // points of the input have the lower numbers
        if (a != b && std::max(a, b) >= this->Points.NumGiven &&
          (this->At(a) - this->At(b)).norm() < this->Distance)
        {
          target[std::max(a, b)] = std::min(a, b);
        }
      }
    }
    if (target.empty())
    {
      return false;
    }
    for (Part& part : this->Parts)
    {
      for (int& corner : part.Corners)
      {
        corner = find(corner);
      }
    }
    this->DropFolded();
    return true;
  }

  /// The longest edge of a flat triangle is led through the point across.
  bool LeadEdges()
  {
    std::map<std::pair<int, int>, int> led; // edges, and the points that they are led through
    std::set<int> used;
    for (const Part& part : this->Parts)
    {
      const auto [longest, height] = this->Flatness(part.Corners);
      const int a = part.Corners[longest];
      const int b = part.Corners[(longest + 1) % 3];
      const int c = part.Corners[(longest + 2) % 3];
      if (height < this->Distance && this->MayGo(part) && used.count(a) == 0 &&
        used.count(b) == 0 && used.count(c) == 0)
      {
        led[{ std::min(a, b), std::max(a, b) }] = c;
        used.insert({ a, b, c });
      }
    }
    if (led.empty())
    {
      return false;
    }
    std::vector<Part> next;
    for (const Part& part : this->Parts)
    {
      bool isLed = false;
      for (std::size_t k = 0; k < 3 && !isLed; ++k)
      {
        const int a = part.Corners[k];
        const int b = part.Corners[(k + 1) % 3];
        const int c = part.Corners[(k + 2) % 3];
        const auto found = led.find({ std::min(a, b), std::max(a, b) });
        if (found != led.end())
        {
          isLed = true;
          next.push_back({ { a, found->second, c }, part.Source });
          next.push_back({ { found->second, b, c }, part.Source });
        }
      }
      if (!isLed)
      {
        next.push_back(part);
      }
    }
    this->Parts = std::move(next);
    this->DropFolded();
    return true;
  }
  std::pair<std::size_t, double> Flatness(const MeshTriangle& corners) const
  {
    std::size_t longest = 0;
    double length = -1.0;
    for (std::size_t k = 0; k < 3; ++k)
    {
      const double own = (this->At(corners[(k + 1) % 3]) - this->At(corners[k])).norm();
      if (own > length)
      {
        length = own;
        longest = k;
      }
    }
    const Eigen::Vector3d a = this->At(corners[longest]);
    const Eigen::Vector3d b = this->At(corners[(longest + 1) % 3]);
    const Eigen::Vector3d c = this->At(corners[(longest + 2) % 3]);
    return { longest, length > 0.0 ? (b - a).cross(c - a).norm() / length : 0.0 };
  }
  void DropFolded()
  {
    this->Parts.erase(std::remove_if(this->Parts.begin(), this->Parts.end(),
                        [](const Part& part)
                        {
                          const auto& [a, b, c] = part.Corners;
                          return a == b || b == c || c == a;
                        }),
      this->Parts.end());
  }

  std::vector<Part>& Parts;
  std::vector<char> Divided; ///< triangles of the input
  const ExactPoints& Points;
  double Distance;
};

/// Triangles that lie on each other become as many as remain when opposite ones cancel.
/// @param cancelled  their middles are added.
std::vector<Part> CancelParts(const std::vector<Part>& parts, const ExactPoints& points,
  std::vector<Eigen::Vector3d>& cancelled)
{
  struct Stack
  {
    int Sum = 0;
    int Forward = -1; ///< the first part of either direction
    int Backward = -1;
  };
  std::map<MeshTriangle, Stack> stacks;
  std::vector<MeshTriangle> keys(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    MeshTriangle key = parts[i].Corners;
    std::rotate(key.begin(), std::min_element(key.begin(), key.end()), key.end());
    const bool forward = key[1] < key[2];
    if (!forward)
    {
      std::swap(key[1], key[2]);
    }
    keys[i] = key;
    Stack& stack = stacks[key];
    stack.Sum += forward ? 1 : -1;
    int& first = forward ? stack.Forward : stack.Backward;
    first = first < 0 ? static_cast<int>(i) : first;
  }
  for (const auto& [key, stack] : stacks)
  {
    if (stack.Forward >= 0 && stack.Backward >= 0)
    {
      cancelled.push_back(
        (Rounded(points[key[0]]) + Rounded(points[key[1]]) + Rounded(points[key[2]])).transpose() /
        3.0);
    }
  }
  std::vector<Part> result;
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    const Stack& stack = stacks[keys[i]];
    const int first = stack.Sum > 0 ? stack.Forward : stack.Backward;
    if (stack.Sum != 0 && first == static_cast<int>(i))
    {
      result.insert(result.end(), static_cast<std::size_t>(std::abs(stack.Sum)), parts[i]);
    }
  }
  return result;
}

/// A triangle at an edge.
struct Wing
{
  int Part;
  int Apex;     ///< its third corner
  bool Forward; ///< runs from the lower point of the edge to the higher
  int Copy;     ///< number among those that lie on each other
};

/// Order of wings around an edge, counterclockwise seen from its end, from the first one on.
void SortWings(
  const Point& from, const Point& to, const ExactPoints& points, std::vector<Wing>& wings)
{
  const Point& first = points[wings.front().Apex];
  const auto half = [&](const Point& p)
  {
    const auto side = CGAL::orientation(from, to, first, p);
    if (side != CGAL::COPLANAR)
    {
      return side == CGAL::POSITIVE ? 1 : 3;
    }
    return CGAL::coplanar_orientation(from, to, first, p) == CGAL::POSITIVE ? 0 : 2;
  };
  std::stable_sort(wings.begin(), wings.end(),
    [&](const Wing& a, const Wing& b)
    {
      if (a.Apex != b.Apex)
      {
        const Point& p = points[a.Apex];
        const Point& q = points[b.Apex];
        const int i = half(p);
        const int j = half(q);
        if (i != j)
        {
          return i < j;
        }
        const auto side = CGAL::orientation(from, to, p, q);
        if ((i == 1 || i == 3) && side != CGAL::COPLANAR)
        {
          return side == CGAL::POSITIVE;
        }
        return a.Apex < b.Apex;
      }
      // copies: the winding number steps up or down in the same order at every edge
      return a.Forward ? a.Copy < b.Copy : a.Copy > b.Copy;
    });
}

/// Which wings are joined: each that enters a region of a higher winding number with the one that
/// leaves it.
std::vector<std::pair<int, int>> JoinWings(const std::vector<Wing>& wings)
{
  const int n = static_cast<int>(wings.size());
  int level = 0;
  int lowest = 0;
  int start = 0; // behind the lowest level
  for (int i = 0; i < n; ++i)
  {
    level += wings[static_cast<std::size_t>(i)].Forward ? 1 : -1;
    if (level < lowest)
    {
      lowest = level;
      start = i + 1;
    }
  }
  std::vector<int> open;
  std::vector<std::pair<int, int>> joined;
  for (int i = 0; i < n; ++i)
  {
    const int k = (start + i) % n;
    if (wings[static_cast<std::size_t>(k)].Forward)
    {
      open.push_back(k);
    }
    else
    {
      joined.emplace_back(open.back(), k);
      open.pop_back();
    }
  }
  return joined;
}

class SheetBuilder
{
public:
  SheetBuilder(const std::vector<Part>& parts, const ExactPoints& points)
    : Parts(parts), Points(points), Corners(3 * static_cast<int>(parts.size())),
      Faces(static_cast<int>(parts.size()))
  {
  }

  /// @param divide  edges that sheets have in common; where triangles meet elsewhere that waits.
  SheetMesh Build(bool divide)
  {
    std::map<std::pair<int, int>, std::vector<Wing>> edges;
    int copy = 0;
    for (std::size_t i = 0; i < this->Parts.size(); ++i)
    {
      const MeshTriangle& corners = this->Parts[i].Corners;
      copy = i > 0 && corners == this->Parts[i - 1].Corners ? copy + 1 : 0;
      for (std::size_t k = 0; k < 3; ++k)
      {
        const int a = corners[k];
        const int b = corners[(k + 1) % 3];
        edges[{ std::min(a, b), std::max(a, b) }].push_back(
          { static_cast<int>(i), corners[(k + 2) % 3], a < b, copy });
      }
    }
    for (auto& [edge, wings] : edges)
    {
      this->JoinAtEdge(edge, wings);
    }
    if (!this->Mesh.OpenEdges.empty() || !this->Mesh.TwistedEdges.empty())
    {
      return std::move(this->Mesh);
    }
    this->NumberPoints();
    this->NumberSheets();
    if (divide)
    {
      this->DivideSharedEdges();
    }
    return std::move(this->Mesh);
  }

private:
  void JoinAtEdge(const std::pair<int, int>& edge, std::vector<Wing>& wings)
  {
    const auto middle = [&]() -> Eigen::Vector3d
    {
      return 0.5 *
        (Rounded(this->Points[edge.first]) + Rounded(this->Points[edge.second])).transpose();
    };
    const auto forward = static_cast<std::size_t>(
      std::count_if(wings.begin(), wings.end(), [](const Wing& wing) { return wing.Forward; }));
    if (2 * forward != wings.size())
    {
      (wings.size() == 1 ? this->Mesh.OpenEdges : this->Mesh.TwistedEdges).push_back(middle());
      return;
    }
    if (wings.size() > 2)
    {
      this->Mesh.CrowdedEdges.push_back(middle());
      SortWings(this->Points[edge.first], this->Points[edge.second], this->Points, wings);
    }
    for (const auto& [i, j] : JoinWings(wings))
    {
      const int s = wings[static_cast<std::size_t>(i)].Part;
      const int t = wings[static_cast<std::size_t>(j)].Part;
      if (wings.size() > 2)
      {
        this->Joints.push_back({ edge, s, t });
      }
      this->Faces.Unite(s, t);
      this->Corners.Unite(this->CornerOf(s, edge.first), this->CornerOf(t, edge.first));
      this->Corners.Unite(this->CornerOf(s, edge.second), this->CornerOf(t, edge.second));
    }
  }
  int CornerOf(int part, int point) const
  {
    const MeshTriangle& corners = this->Parts[static_cast<std::size_t>(part)].Corners;
    return 3 * part + (corners[0] == point ? 0 : corners[1] == point ? 1 : 2);
  }
  void NumberPoints()
  {
    std::map<std::pair<int, int>, int> fans; // (point, fan)
    for (int corner = 0; corner < this->Corners.Size(); ++corner)
    {
      fans.emplace(std::make_pair(this->PointOf(corner), this->Corners.Find(corner)), 0);
    }
    this->Mesh.Points.resize(static_cast<Eigen::Index>(fans.size()), 3);
    int count = 0;
    for (auto& [fan, number] : fans)
    {
      number = count++;
      this->Mesh.Points.row(number) = Rounded(this->Points[fan.first]);
      this->Mesh.Places.push_back(fan.first);
      this->Mesh.PointIds.push_back(fan.first < this->Points.NumGiven ? fan.first : -1);
    }
    for (std::size_t i = 0; i < this->Parts.size(); ++i)
    {
      MeshTriangle corners{};
      for (int k = 0; k < 3; ++k)
      {
        const int corner = 3 * static_cast<int>(i) + k;
        corners[static_cast<std::size_t>(k)] =
          fans[{ this->PointOf(corner), this->Corners.Find(corner) }];
      }
      this->Mesh.Triangles.push_back(corners);
      this->Mesh.Sources.push_back(this->Parts[i].Source);
    }
  }
  void NumberSheets()
  {
    std::map<int, int> numbers;
    for (int i = 0; i < this->Faces.Size(); ++i)
    {
      const auto [found, isNew] =
        numbers.emplace(this->Faces.Find(i), static_cast<int>(numbers.size()));
      this->Mesh.Sheets.push_back(found->second);
    }
    this->Mesh.NumSheets = static_cast<int>(numbers.size());
  }
  /// Two sheets, or a sheet and itself, that touch along an edge may have both of its points in
  /// common: each gets a middle of its own.
  void DivideSharedEdges()
  {
    std::map<std::pair<int, int>, std::vector<const Joint*>> shared; // by corners of the mesh
    for (const Joint& joint : this->Joints)
    {
      const MeshTriangle& corners = this->Mesh.Triangles[static_cast<std::size_t>(joint.First)];
      const auto at = [&](int point)
      { return corners[static_cast<std::size_t>(this->CornerOf(joint.First, point) % 3)]; };
      shared[{ at(joint.Edge.first), at(joint.Edge.second) }].push_back(&joint);
    }
    int place = this->Points.Size();
    std::map<int, std::vector<int>> pieces; // of triangles that were divided
    for (const auto& [edge, joints] : shared)
    {
      if (joints.size() < 2)
      {
        continue;
      }
      ++place;
      for (const Joint* joint : joints)
      {
        const auto middle = static_cast<int>(this->Mesh.Points.rows());
        this->Mesh.Points.conservativeResize(middle + 1, Eigen::NoChange);
        this->Mesh.Points.row(middle) =
          0.5 * (this->Mesh.Points.row(edge.first) + this->Mesh.Points.row(edge.second));
        this->Mesh.Places.push_back(place);
        this->Mesh.PointIds.push_back(-1);
        for (const int part : { joint->First, joint->Second })
        {
          std::vector<int>& own = pieces.emplace(part, std::vector<int>{ part }).first->second;
          this->DividePiece(own, edge, middle);
        }
      }
    }
  }
  /// Divides the piece that has an edge.
  void DividePiece(std::vector<int>& pieces, const std::pair<int, int>& edge, int middle)
  {
    for (const int piece : pieces)
    {
      const auto t = static_cast<std::size_t>(piece);
      for (std::size_t k = 0; k < 3; ++k)
      {
        const MeshTriangle corners = this->Mesh.Triangles[t];
        const int a = corners[k];
        const int b = corners[(k + 1) % 3];
        const int c = corners[(k + 2) % 3];
        if (std::minmax(a, b) == std::minmax(edge.first, edge.second))
        {
          this->Mesh.Triangles[t] = { a, middle, c };
          this->Mesh.Triangles.push_back({ middle, b, c });
          this->Mesh.Sources.push_back(this->Mesh.Sources[t]);
          this->Mesh.Sheets.push_back(this->Mesh.Sheets[t]);
          pieces.push_back(static_cast<int>(this->Mesh.Triangles.size()) - 1);
          return;
        }
      }
    }
  }
  int PointOf(int corner) const
  {
    return this->Parts[static_cast<std::size_t>(corner / 3)]
      .Corners[static_cast<std::size_t>(corner % 3)];
  }

  /// Triangles that are joined at an edge of more.
  struct Joint
  {
    std::pair<int, int> Edge;
    int First;
    int Second;
  };

  const std::vector<Part>& Parts;
  const ExactPoints& Points;
  std::vector<Joint> Joints;
  DisjointSets Corners;
  DisjointSets Faces;
  SheetMesh Mesh;
};
}

Result<DividedTriangles> DivideTriangles(const PointMatrix& points,
  const std::vector<MeshTriangle>& triangles, const std::vector<std::pair<int, int>>& pairs)
try
{
  ExactPoints exact(points);
  DividedTriangles result;
  for (const Part& part : DivideAll(triangles, pairs, exact))
  {
    result.Triangles.push_back(part.Corners);
    result.Sources.push_back(part.Source);
  }
  result.Points.resize(exact.Size(), 3);
  for (int i = 0; i < exact.Size(); ++i)
  {
    result.Points.row(i) = Rounded(exact[i]);
  }
  return result;
}
catch (...)
{
  return StatusOfException();
}

DividedTriangles SnapTriangles(
  const PointMatrix& points, const std::vector<MeshTriangle>& triangles, double distance)
{
  ExactPoints exact(points);
  exact.NumGiven = 0; // points of the input may go
  std::vector<Part> parts;
  for (const MeshTriangle& corners : triangles)
  {
    parts.push_back({ corners, static_cast<int>(parts.size()) });
  }
  Snapping(parts, std::vector<char>(triangles.size(), 1), exact, distance).Run();
  DividedTriangles result;
  result.Points = points;
  for (const Part& part : parts)
  {
    result.Triangles.push_back(part.Corners);
    result.Sources.push_back(part.Source);
  }
  return result;
}

Result<SheetMesh> ArrangeSheets(const PointMatrix& points,
  const std::vector<MeshTriangle>& triangles, const std::vector<std::pair<int, int>>& pairs,
  double snap)
try
{
  ExactPoints exact(points);
  std::vector<Part> parts = DivideAll(triangles, pairs, exact);
  if (!pairs.empty())
  {
    std::vector<char> divided(triangles.size(), 0);
    for (const auto& [s, t] : pairs)
    {
      divided[static_cast<std::size_t>(s)] = divided[static_cast<std::size_t>(t)] = 1;
    }
    Snapping(parts, std::move(divided), exact, snap).Run();
  }
  std::vector<Eigen::Vector3d> cancelled;
  parts = CancelParts(parts, exact, cancelled);
  SheetMesh mesh = SheetBuilder(parts, exact).Build(pairs.empty());
  mesh.Cancelled = std::move(cancelled);
  return mesh;
}
catch (...)
{
  return StatusOfException();
}
}
