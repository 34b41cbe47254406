// SPDX-License-Identifier: BSD-3-Clause
#include "CornerFill.h"

#include <Eigen/Geometry>

namespace knotwork
{
namespace
{
using Eigen::Vector3d;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Between the six sides of a grid of n segments in every direction.
/// @source  Gordon, Hall, Int. J. Numer. Meth. Eng. 7 (1973) 461.
template <typename Point>
Vector3d TransfinitePlace(const Point& point, const std::array<std::size_t, 3>& at, std::size_t n)
{
  Vector3d place = Vector3d::Zero();
  // of the 26 places that lie at an end in some directions: sides, less edges, and corners
  for (int mask = 1; mask < 27; ++mask)
  {
    std::array<std::size_t, 3> there = at;
    double weight = -1.0;
    int rest = mask;
    for (std::size_t d = 0; d < 3; ++d, rest /= 3)
    {
      const double share = static_cast<double>(at[d]) / static_cast<double>(n);
      if (rest % 3 > 0)
      {
        there[d] = rest % 3 == 1 ? 0 : n;
        weight *= -(rest % 3 == 1 ? 1.0 - share : share);
      }
    }
    place += weight * point(there[0], there[1], there[2]);
  }
  return place;
}
}

CornerFill::CornerFill(const CADTopology& model, const CornerSolid& solid, const EdgeNodes& nodes,
  const std::map<int, QuadSides>& quads, CADMesh& mesh)
  : Model(model), Solid(solid), Nodes(nodes), Quads(quads), Mesh(mesh)
{
  for (const int edge : solid.Sides.front().Edges)
  {
    this->Half += nodes.Counts[At(edge)];
  }
  this->Half /= 2;
}

int CornerFill::AddPoint(const Vector3d& point)
{
  this->Mesh.Points.push_back(point);
  this->Mesh.PointDimension.push_back(3);
  this->Mesh.PointEntity.push_back(this->Body);
  return static_cast<int>(this->Mesh.Points.size()) - 1;
}

/// Nodes from a corner to the middle of a side.
std::vector<int> CornerFill::HalfSide(int side, int vertex) const
{
  std::vector<int> nodes{ vertex };
  std::vector<int> left = this->Solid.Sides[At(side)].Edges;
  while (static_cast<int>(nodes.size()) <= this->Half)
  {
    const auto next = std::find_if(left.begin(), left.end(),
      [&](int edge)
      {
        const auto& ends = this->Model.Edges[At(edge)].Vertices;
        return ends[0] == nodes.back() || ends[1] == nodes.back();
      });
    const int count = this->Nodes.Counts[At(*next)];
    const bool forward = this->Model.Edges[At(*next)].Vertices[0] == nodes.back();
    for (int i = 1; i <= count && static_cast<int>(nodes.size()) <= this->Half; ++i)
    {
      nodes.push_back(this->Nodes.NodeOf(this->Model, *next, forward ? i : count - i));
    }
    left.erase(next);
  }
  return nodes;
}

/// The grid of a face between the halves of two of its sides: [along][across].
CornerFill::Grid CornerFill::PartOfFace(
  int face, const std::vector<int>& along, const std::vector<int>& across) const
{
  const QuadSides& quads = this->Quads.at(face);
  Grid grid(along.size(), std::vector<int>(across.size(), -1));
  for (std::size_t i = 0; i < along.size(); ++i)
  {
    grid[i][0] = along[i];
  }
  for (std::size_t i = 0; i + 1 < along.size(); ++i)
  {
    int a = along[i];
    int b = along[i + 1];
    int quad = -1;
    for (std::size_t j = 1; j < across.size(); ++j)
    {
      quad = quads.Beside(a, b, quad);
      std::tie(b, a) = quads.Across(quad, a, b);
      grid[i][j] = a;
      grid[i + 1][j] = b;
    }
  }
  return grid;
}

/// A straight line from the middle of a face to that of the solid.
const std::vector<int>& CornerFill::Spoke(int face, int foot)
{
  std::vector<int>& spoke = this->Spokes[face];
  if (spoke.empty())
  {
    spoke.push_back(foot);
    const Vector3d from = this->Mesh.Points[At(foot)];
    const Vector3d to = this->Mesh.Points[At(this->Middle)];
    for (int i = 1; i < this->Half; ++i)
    {
      spoke.push_back(this->AddPoint(from + (to - from) * i / this->Half));
    }
    spoke.push_back(this->Middle);
  }
  return spoke;
}

/// Between the lines from the middle of a side to the middles of its two faces, and the spokes of
/// these: [along the line in a face][along that in the other one].
const CornerFill::Grid& CornerFill::InnerFace(
  int side, int face, const std::vector<int>& first, int other, const std::vector<int>& second)
{
  Grid& grid = this->InnerFaces[side];
  if (!grid.empty())
  {
    return grid;
  }
  const std::vector<int> fromFirst = this->Spoke(face, first.back());
  const std::vector<int> fromSecond = this->Spoke(other, second.back());
  const auto n = At(this->Half);
  grid.assign(n + 1, std::vector<int>(n + 1, -1));
  for (std::size_t i = 0; i <= n; ++i)
  {
    grid[i][0] = first[i];
    grid[0][i] = second[i];
    grid[n][i] = fromFirst[i];
    grid[i][n] = fromSecond[i];
  }
  const auto point = [&](std::size_t i, std::size_t j) -> const Vector3d&
  { return this->Mesh.Points[At(grid[i][j])]; };
  for (std::size_t i = 1; i < n; ++i)
  {
    for (std::size_t j = 1; j < n; ++j)
    {
      const double s = static_cast<double>(i) / this->Half;
      const double t = static_cast<double>(j) / this->Half;
      grid[i][j] = this->AddPoint((1.0 - s) * point(0, j) + s * point(n, j) +
        (1.0 - t) * point(i, 0) + t * point(i, n) -
        ((1.0 - s) * ((1.0 - t) * point(0, 0) + t * point(0, n)) +
          s * ((1.0 - t) * point(n, 0) + t * point(n, n))));
    }
  }
  return grid;
}

std::vector<std::array<int, 8>> CornerFill::Fill(int body)
{
  this->Body = body;
  const auto n = At(this->Half);
  // of a corner: the halves of its sides, the parts of its faces
  struct Parts
  {
    std::array<std::vector<int>, 3> Sides;
    std::array<Grid, 3> Faces; ///< [along Sides[i]][along Sides[(i + 1) % 3]]
  };
  std::vector<Parts> parts;
  std::map<int, int> middles; ///< of faces
  for (const SolidCorner& corner : this->Solid.Corners)
  {
    Parts& of = parts.emplace_back();
    for (std::size_t i = 0; i < 3; ++i)
    {
      of.Sides[i] = this->HalfSide(corner.Sides[i], corner.Vertex);
    }
    for (std::size_t i = 0; i < 3; ++i)
    {
      of.Faces[i] = this->PartOfFace(corner.Faces[i], of.Sides[i], of.Sides[(i + 1) % 3]);
      middles[corner.Faces[i]] = of.Faces[i][n][n];
    }
  }
  Vector3d middle = Vector3d::Zero();
  for (const auto& [face, node] : middles)
  {
    middle += this->Mesh.Points[At(node)] / static_cast<double>(middles.size());
  }
  this->Middle = this->AddPoint(middle);
  std::vector<std::array<int, 8>> hexahedra;
  for (std::size_t c = 0; c < parts.size(); ++c)
  {
    const SolidCorner& corner = this->Solid.Corners[c];
    const Parts& of = parts[c];
    std::vector<int> ids((n + 1) * (n + 1) * (n + 1), -1);
    const auto id = [&](const std::array<std::size_t, 3>& at) -> int&
    { return ids[at[0] + (n + 1) * (at[1] + (n + 1) * at[2])]; };
    for (std::size_t d = 0; d < 3; ++d)
    {
      const std::size_t e = (d + 1) % 3;
      const std::size_t f = (d + 2) % 3;
      // the face between directions d and e, and the inner one at the end of direction d, which
      // begins at the lines in that face and in the one between f and d
      std::vector<int> inFirst;
      std::vector<int> inOther;
      for (std::size_t i = 0; i <= n; ++i)
      {
        inFirst.push_back(of.Faces[d][n][i]);
        inOther.push_back(of.Faces[f][i][n]);
      }
      const CornerSide& side = this->Solid.Sides[At(corner.Sides[d])];
      const bool isFirst = side.Faces[0] == corner.Faces[d];
      const Grid& inner = isFirst
        ? this->InnerFace(corner.Sides[d], side.Faces[0], inFirst, side.Faces[1], inOther)
        : this->InnerFace(corner.Sides[d], side.Faces[0], inOther, side.Faces[1], inFirst);
      for (std::size_t i = 0; i <= n; ++i)
      {
        for (std::size_t j = 0; j <= n; ++j)
        {
          std::array<std::size_t, 3> at{};
          at[d] = i;
          at[e] = j;
          id(at) = of.Faces[d][i][j];
          at[d] = n;
          at[e] = i;
          at[f] = j;
          id(at) = isFirst ? inner[i][j] : inner[j][i];
        }
      }
    }
    const auto point = [&](std::size_t i, std::size_t j, std::size_t k) -> const Vector3d& {
      return this->Mesh.Points[At(id({ i, j, k }))];
    };
    for (std::size_t k = 1; k < n; ++k)
    {
      for (std::size_t j = 1; j < n; ++j)
      {
        for (std::size_t i = 1; i < n; ++i)
        {
          id({ i, j, k }) = this->AddPoint(TransfinitePlace(point, { i, j, k }, n));
        }
      }
    }
    const Vector3d here = point(0, 0, 0);
    const bool isRight =
      (point(1, 0, 0) - here).cross(point(0, 1, 0) - here).dot(point(0, 0, 1) - here) > 0.0;
    for (std::size_t k = 0; k < n; ++k)
    {
      for (std::size_t j = 0; j < n; ++j)
      {
        for (std::size_t i = 0; i < n; ++i)
        {
          std::array<int, 8>& hexahedron = hexahedra.emplace_back();
          for (std::size_t v = 0; v < 8; ++v)
          {
            const std::size_t a = isRight ? v & 1 : (v >> 1) & 1;
            const std::size_t b = isRight ? (v >> 1) & 1 : v & 1;
            hexahedron[v] = id({ i + a, j + b, k + (v >> 2) });
          }
        }
      }
    }
  }
  return hexahedra;
}
}
