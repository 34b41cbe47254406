// SPDX-License-Identifier: BSD-3-Clause
#include "SheetArrangement.h"

#include "PartDivision.h"
#include "PartSnapping.h"

#include <knotwork/SplineCore/DisjointSets.h>

#include <algorithm>
#include <cstdlib>
#include <map>

namespace knotwork
{
namespace
{
/// Triangles that lie on each other become as many as remain when opposite ones cancel.
/// @param cancelled  their middles are added.
std::vector<TrianglePart> CancelParts(const std::vector<TrianglePart>& parts,
  const ExactPoints& points, std::vector<Eigen::Vector3d>& cancelled)
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
  std::vector<TrianglePart> result;
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
  const ExactPoint& from, const ExactPoint& to, const ExactPoints& points, std::vector<Wing>& wings)
{
  const ExactPoint& first = points[wings.front().Apex];
  const auto half = [&](const ExactPoint& p)
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
        const ExactPoint& p = points[a.Apex];
        const ExactPoint& q = points[b.Apex];
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
  SheetBuilder(const std::vector<TrianglePart>& parts, const ExactPoints& points)
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

  const std::vector<TrianglePart>& Parts;
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
  for (const TrianglePart& part : DivideAll(triangles, pairs, exact))
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
  std::vector<TrianglePart> parts;
  for (const MeshTriangle& corners : triangles)
  {
    parts.push_back({ corners, static_cast<int>(parts.size()) });
  }
  SnapParts(parts, std::vector<char>(triangles.size(), 1), exact, distance);
  DividedTriangles result;
  result.Points = points;
  for (const TrianglePart& part : parts)
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
  std::vector<TrianglePart> parts = DivideAll(triangles, pairs, exact);
  if (!pairs.empty())
  {
    std::vector<char> divided(triangles.size(), 0);
    for (const auto& [s, t] : pairs)
    {
      divided[static_cast<std::size_t>(s)] = divided[static_cast<std::size_t>(t)] = 1;
    }
    SnapParts(parts, divided, exact, snap);
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
