// SPDX-License-Identifier: BSD-3-Clause
#include "FlatCorners.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>

namespace knotwork
{
namespace
{
/// Of the volume of the three unit vectors along the edges of a corner that counts as flat: 1 at
/// that of a cube, 0.7 where a smooth surface turns by 45 degrees from one edge's end to the other.
constexpr double FlatVolume = 0.5;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

using Edge = std::array<int, 2>;
Edge MakeEdge(int a, int b)
{
  return { std::min(a, b), std::max(a, b) };
}

class CornerDivider
{
public:
  explicit CornerDivider(Tetrahedra& mesh) : Mesh(mesh)
  {
    for (const auto& triangle : mesh.Triangles)
    {
      for (std::size_t i = 0; i < 3; ++i)
      {
        this->Surface.push_back(MakeEdge(triangle[i], triangle[(i + 1) % 3]));
      }
    }
    std::sort(this->Surface.begin(), this->Surface.end());
    this->Surface.erase(
      std::unique(this->Surface.begin(), this->Surface.end()), this->Surface.end());
    for (const auto& point : mesh.Points.rowwise())
    {
      this->Points.emplace_back(point);
    }
  }

  /// One round, in which no cell is divided twice. @return points that were added.
  int Divide(int maxPoints)
  {
    std::map<Edge, std::vector<int>> wanted; // edges, with their cells
    std::vector<int> middles;
    for (std::size_t c = 0; c < this->Mesh.Cells.size(); ++c)
    {
      const int corner = this->FlatCorner(static_cast<int>(c));
      if (corner < 0)
      {
        continue;
      }
      const Edge edge = this->LongestInside(static_cast<int>(c), corner);
      if (edge[0] < 0)
      {
        middles.push_back(static_cast<int>(c));
      }
      else
      {
        wanted[edge];
      }
    }
    if (!wanted.empty())
    {
      this->FindCells(wanted);
    }
    std::vector<char> isDivided(this->Mesh.Cells.size(), 0);
    int count = 0;
    for (const auto& [edge, cells] : wanted)
    {
      if (count < maxPoints &&
        std::none_of(cells.begin(), cells.end(), [&](int c) { return isDivided[At(c)] != 0; }))
      {
        this->Halve(edge, cells, isDivided);
        ++count;
      }
    }
    for (const int c : middles)
    {
      if (count < maxPoints && isDivided[At(c)] == 0)
      {
        this->AddMiddle(c, isDivided);
        ++count;
      }
    }
    return count;
  }

  void Finish()
  {
    this->Mesh.Points.resize(static_cast<Eigen::Index>(this->Points.size()), 3);
    for (std::size_t i = 0; i < this->Points.size(); ++i)
    {
      this->Mesh.Points.row(static_cast<Eigen::Index>(i)) = this->Points[i];
    }
  }

private:
  bool IsOnSurface(int a, int b) const
  {
    return std::binary_search(this->Surface.begin(), this->Surface.end(), MakeEdge(a, b));
  }

  /// Position in the cell; -1: there is none.
  int FlatCorner(int cell) const
  {
    const auto& corners = this->Mesh.Cells[At(cell)];
    for (int i = 0; i < 4; ++i)
    {
      Eigen::Matrix3d ways;
      bool isAlong = true;
      for (int k = 1; k < 4 && isAlong; ++k)
      {
        const int other = corners[At((i + k) % 4)];
        isAlong = this->IsOnSurface(corners[At(i)], other);
        ways.row(k - 1) = (this->Points[At(other)] - this->Points[At(corners[At(i)])]).normalized();
      }
      if (isAlong && std::abs(ways.determinant()) < FlatVolume)
      {
        return i;
      }
    }
    return -1;
  }

  /// Of the edges against a corner; numbers -1: all are on the surface.
  Edge LongestInside(int cell, int corner) const
  {
    const auto& corners = this->Mesh.Cells[At(cell)];
    Edge best{ -1, -1 };
    double longest = 0.0;
    for (int i = 0; i < 4; ++i)
    {
      for (int k = i + 1; k < 4; ++k)
      {
        const Edge edge = MakeEdge(corners[At(i)], corners[At(k)]);
        const double length = (this->Points[At(edge[0])] - this->Points[At(edge[1])]).norm();
        if (i != corner && k != corner && length > longest && !this->IsOnSurface(edge[0], edge[1]))
        {
          best = edge;
          longest = length;
        }
      }
    }
    return best;
  }

  void FindCells(std::map<Edge, std::vector<int>>& wanted) const
  {
    for (std::size_t c = 0; c < this->Mesh.Cells.size(); ++c)
    {
      const auto& corners = this->Mesh.Cells[c];
      for (std::size_t i = 0; i < 4; ++i)
      {
        for (std::size_t k = i + 1; k < 4; ++k)
        {
          const auto found = wanted.find(MakeEdge(corners[i], corners[k]));
          if (found != wanted.end())
          {
            found->second.push_back(static_cast<int>(c));
          }
        }
      }
    }
  }

  void Halve(const Edge& edge, const std::vector<int>& cells, std::vector<char>& isDivided)
  {
    const auto middle = static_cast<int>(this->Points.size());
    this->Points.emplace_back(0.5 * (this->Points[At(edge[0])] + this->Points[At(edge[1])]));
    for (const int c : cells)
    {
      isDivided[At(c)] = 1;
      auto other = this->Mesh.Cells[At(c)];
      std::replace(other.begin(), other.end(), edge[0], middle);
      auto& own = this->Mesh.Cells[At(c)];
      std::replace(own.begin(), own.end(), edge[1], middle);
      this->AddCell(other, c);
    }
  }

  /// @param from  the cell that it is a part of.
  void AddCell(const std::array<int, 4>& corners, int from)
  {
    this->Mesh.Cells.push_back(corners);
    if (!this->Mesh.Labels.empty())
    {
      this->Mesh.Labels.push_back(this->Mesh.Labels[At(from)]);
    }
  }

  void AddMiddle(int cell, std::vector<char>& isDivided)
  {
    const auto middle = static_cast<int>(this->Points.size());
    const auto corners = this->Mesh.Cells[At(cell)];
    isDivided[At(cell)] = 1;
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (const int corner : corners)
    {
      sum += this->Points[At(corner)];
    }
    this->Points.emplace_back(0.25 * sum);
    this->Mesh.Cells[At(cell)][0] = middle;
    for (std::size_t i = 1; i < 4; ++i)
    {
      auto part = corners;
      part[i] = middle;
      this->AddCell(part, cell);
    }
  }

  Tetrahedra& Mesh;
  std::vector<Edge> Surface;
  std::vector<Eigen::RowVector3d> Points;
};
}

int DivideFlatCorners(Tetrahedra& mesh, int maxPoints)
{
  CornerDivider divider(mesh);
  int total = 0;
  // a point inside is in every part, so that parts are not flat: rounds end
  for (int count = 1; count > 0; total += count)
  {
    count = divider.Divide(maxPoints - total);
  }
  divider.Finish();
  return total;
}
}
