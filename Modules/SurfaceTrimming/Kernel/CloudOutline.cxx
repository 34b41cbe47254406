// SPDX-License-Identifier: BSD-3-Clause
#include "CloudOutline.h"

#include <knotwork/SplineCore/Numbers.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double PointsPerSide = 2.5; // of a cell, on average: few cells inside are empty
constexpr double MaxCells = 1e7;
constexpr int SmoothingSteps = 2;

std::size_t At(std::ptrdiff_t i)
{
  return static_cast<std::size_t>(i);
}

/// Cells of the points' box with a frame of one empty cell around.
struct CellGrid
{
  RealArray<2> Lower{};
  double Size = 0.0;
  std::array<int, 2> Count{}; ///< with the frame
  std::vector<char> Cells;

  char& Cell(int i, int j) { return this->Cells[At(i + std::ptrdiff_t{ this->Count[0] } * j)]; }
  char Cell(int i, int j) const
  {
    return this->Cells[At(i + std::ptrdiff_t{ this->Count[0] } * j)];
  }
};

struct Box
{
  RealArray<2> Lower{};
  RealArray<2> Length{};
};

Result<CellGrid> Rasterize(const PointMatrixView& points, const Box& box, double size)
{
  CellGrid grid;
  grid.Lower = box.Lower;
  grid.Size = size;
  double cells = 1.0;
  for (std::size_t d = 0; d < 2; ++d)
  {
    const double count = std::max(1.0, std::ceil(box.Length[d] / size)) + 2.0;
    cells *= count;
    if (!(cells <= MaxCells))
    {
      return { ErrorCode::TooLarge,
        "cells of size " + Digits(size) + " are more than " + Digits(MaxCells) +
          "; choose a larger cell size" };
    }
    grid.Count[d] = static_cast<int>(count);
  }
  grid.Cells.assign(static_cast<std::size_t>(cells), 0);
  for (Eigen::Index p = 0; p < points.rows(); ++p)
  {
    std::array<int, 2> cell;
    for (std::size_t d = 0; d < 2; ++d)
    {
      const double at = (points(p, static_cast<Eigen::Index>(d)) - box.Lower[d]) / size;
      cell[d] = std::min(static_cast<int>(at), grid.Count[d] - 3) + 1;
    }
    grid.Cell(cell[0], cell[1]) = 1;
  }
  return grid;
}

/// Cells get `value` that have it at most `reach` cells before (or behind) them along a direction.
void Spread(CellGrid& grid, char value, std::size_t d, int reach, bool before)
{
  const auto [columns, rows] = grid.Count;
  std::vector<int> since(At(d == 0 ? rows : columns), reach + 1); // a cell with the value
  for (int step = 0; step < rows; ++step)
  {
    const int j = before ? step : rows - 1 - step;
    for (int k = 0; k < columns; ++k)
    {
      const int i = before ? k : columns - 1 - k;
      char& cell = grid.Cell(i, j);
      int& distance = since[At(d == 0 ? j : i)];
      distance = cell == value ? 0 : std::min(distance, reach) + 1;
      cell = distance <= reach ? value : cell;
    }
  }
}

/// Fills cells that are in no square of empty cells with sides of gap + 1 cells, which may reach
/// beyond the grid: dilation with such a square that ends at a cell, erosion with one that begins
/// there.
void CloseGaps(CellGrid& grid, double gap)
{
  CellGrid wide = grid;
  std::array<int, 2> reach;
  for (std::size_t d = 0; d < 2; ++d)
  {
    // a square as long as the grid is as long as any
    reach[d] = static_cast<int>(std::min(gap, static_cast<double>(grid.Count[d])));
    wide.Count[d] += reach[d];
  }
  wide.Cells.assign(At(std::ptrdiff_t{ wide.Count[0] } * wide.Count[1]), 0);
  for (int j = 0; j < grid.Count[1]; ++j)
  {
    std::copy_n(&grid.Cell(0, j), grid.Count[0], &wide.Cell(0, j));
  }
  for (const char value : { char(1), char(0) })
  {
    Spread(wide, value, 0, reach[0], value == 1);
    Spread(wide, value, 1, reach[1], value == 1);
  }
  for (int j = 0; j < grid.Count[1]; ++j)
  {
    std::copy_n(&wide.Cell(0, j), grid.Count[0], &grid.Cell(0, j));
  }
}

/// Fills cells until no two touch in a corner only.
void JoinCorners(CellGrid& grid)
{
  for (bool changed = true; changed;)
  {
    changed = false;
    for (int j = 0; j + 1 < grid.Count[1]; ++j)
    {
      for (int i = 0; i + 1 < grid.Count[0]; ++i)
      {
        const bool a = grid.Cell(i, j) != 0;
        const bool b = grid.Cell(i + 1, j) != 0;
        const bool c = grid.Cell(i, j + 1) != 0;
        const bool d = grid.Cell(i + 1, j + 1) != 0;
        if (a == d && b == c && a != b)
        {
          // within the points' box, which the frame surrounds
          (a ? grid.Cell(i + 1, j) : grid.Cell(i, j)) = 1;
          changed = true;
        }
      }
    }
  }
}

/// Numbers of the connected parts of occupied cells from 1 on, and how many cells they have.
std::vector<int> FindParts(const CellGrid& grid, std::vector<int>& sizes)
{
  std::vector<int> part(grid.Cells.size(), 0);
  std::vector<std::size_t> stack;
  const std::ptrdiff_t steps[] = { -1, 1, -std::ptrdiff_t{ grid.Count[0] }, grid.Count[0] };
  for (std::size_t start = 0; start < part.size(); ++start)
  {
    if (!grid.Cells[start] || part[start])
    {
      continue;
    }
    sizes.push_back(0);
    part[start] = static_cast<int>(sizes.size());
    stack.push_back(start);
    while (!stack.empty())
    {
      const std::size_t cell = stack.back();
      stack.pop_back();
      ++sizes.back();
      for (const std::ptrdiff_t step : steps) // the frame is empty, so neighbours exist
      {
        const std::size_t next = At(static_cast<std::ptrdiff_t>(cell) + step);
        if (grid.Cells[next] && !part[next])
        {
          part[next] = part[start];
          stack.push_back(next);
        }
      }
    }
  }
  return part;
}

double TurnedArea(const PointMatrix& p, const std::array<int, 3>& t)
{
  return (p(t[1], 0) - p(t[0], 0)) * (p(t[2], 1) - p(t[0], 1)) -
    (p(t[2], 0) - p(t[0], 0)) * (p(t[1], 1) - p(t[0], 1));
}

/// Moves boundary points towards the mean of their neighbours on the boundary.
void SmoothBoundary(OutlinePart& part, const Box& box)
{
  // boundary edges are those without an opposite one
  std::vector<std::array<int, 2>> edges;
  for (const auto& t : part.Triangles)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      edges.push_back({ t[k], t[(k + 1) % 3] });
    }
  }
  std::sort(edges.begin(), edges.end());
  const auto n = part.Points.rows();
  std::vector<int> next(At(n), -1);
  std::vector<int> previous(At(n), -1);
  for (const auto& edge : edges)
  {
    if (!std::binary_search(edges.begin(), edges.end(), std::array<int, 2>{ edge[1], edge[0] }))
    {
      next[At(edge[0])] = edge[1];
      previous[At(edge[1])] = edge[0];
    }
  }
  const auto isFree = [&](Eigen::Index i)
  {
    bool inside = next[At(i)] >= 0;
    for (std::size_t d = 0; d < 2; ++d)
    {
      const double x = part.Points(i, static_cast<Eigen::Index>(d)) - box.Lower[d];
      inside = inside && x > 0.0 && x < box.Length[d];
    }
    return inside;
  };
  for (int step = 0; step < SmoothingSteps; ++step)
  {
    const PointMatrix before = part.Points;
    PointMatrix move = PointMatrix::Zero(n, 2);
    for (Eigen::Index i = 0; i < n; ++i)
    {
      if (isFree(i))
      {
        move.row(i) =
          0.25 * (before.row(next[At(i)]) + before.row(previous[At(i)])) - 0.5 * before.row(i);
      }
    }
    for (int attempt = 0; attempt < 8; ++attempt)
    {
      part.Points = before + move;
      bool turned = false;
      for (const auto& t : part.Triangles)
      {
        if (!(TurnedArea(part.Points, t) > 0.05 * TurnedArea(before, t)))
        {
          for (const int corner : t)
          {
            move.row(corner) *= 0.5;
          }
          turned = true;
        }
      }
      if (!turned)
      {
        break;
      }
      part.Points = before; // unless a later attempt succeeds
    }
  }
}

OutlinePart MakePart(
  const CellGrid& grid, const std::vector<int>& numbers, int number, const Box& box)
{
  OutlinePart part;
  std::vector<int> ids(At((grid.Count[0] + 1) * std::ptrdiff_t{ grid.Count[1] + 1 }), -1);
  std::vector<RealArray<2>> points;
  const auto corner = [&](int i, int j)
  {
    int& id = ids[At(i + std::ptrdiff_t{ grid.Count[0] + 1 } * j)];
    if (id < 0)
    {
      id = static_cast<int>(points.size());
      RealArray<2> at;
      const std::array<int, 2> index{ i - 1, j - 1 };
      for (std::size_t d = 0; d < 2; ++d)
      {
        const double x = std::max(0.0, std::min(index[d] * grid.Size, box.Length[d]));
        at[d] = x == box.Length[d] ? box.Lower[d] + box.Length[d] : box.Lower[d] + x;
      }
      points.push_back(at);
    }
    return id;
  };
  for (int j = 0; j < grid.Count[1]; ++j)
  {
    for (int i = 0; i < grid.Count[0]; ++i)
    {
      if (numbers[At(i + std::ptrdiff_t{ grid.Count[0] } * j)] == number)
      {
        const int a = corner(i, j);
        const int b = corner(i + 1, j);
        const int c = corner(i + 1, j + 1);
        const int d = corner(i, j + 1);
        part.Triangles.push_back({ a, b, c });
        part.Triangles.push_back({ a, c, d });
      }
    }
  }
  part.Points.resize(static_cast<Eigen::Index>(points.size()), 2);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    part.Points.row(static_cast<Eigen::Index>(i)) << points[i][0], points[i][1];
  }
  SmoothBoundary(part, box);
  return part;
}

Status CheckInput(const PointMatrixView& points, const CloudOutlineParams& params, Box& box)
{
  if (points.rows() < 3 || points.cols() != 2)
  {
    return { ErrorCode::EmptyInput, "an outline needs three points in the plane" };
  }
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    if (!points.row(i).allFinite())
    {
      return { ErrorCode::NonFiniteInput, "point " + std::to_string(i) };
    }
  }
  if (!(params.CellSize >= 0.0 && params.MaxGap >= 0.0 && std::isfinite(params.CellSize) &&
        std::isfinite(params.MaxGap) && params.MinCells >= 1))
  {
    return { ErrorCode::InvalidParameter,
      "cell size and gap must be 0 or more, the number of cells 1 or more" };
  }
  for (std::size_t d = 0; d < 2; ++d)
  {
    const auto column = points.col(static_cast<Eigen::Index>(d));
    box.Lower[d] = column.minCoeff();
    box.Length[d] = column.maxCoeff() - box.Lower[d];
    if (!(box.Length[d] > 0.0))
    {
      return { ErrorCode::SingularSystem, "all points lie on a line" };
    }
  }
  return {};
}

/// 2.5 times the mean spacing, where the points are.
double DefaultSize(const PointMatrixView& points, const Box& box)
{
  const auto n = static_cast<double>(points.rows());
  double size = PointsPerSide * std::sqrt(box.Length[0] * box.Length[1] / n);
  for (int pass = 0; pass < 2; ++pass)
  {
    const auto grid = Rasterize(points, box, size);
    if (!grid)
    {
      break;
    }
    const auto occupied = std::count(grid->Cells.begin(), grid->Cells.end(), char(1));
    size *= std::min(1.0, PointsPerSide * std::sqrt(static_cast<double>(occupied) / n));
  }
  return size;
}
}

Result<CloudOutline> FindCloudOutline(
  const PointMatrixView& points, const CloudOutlineParams& params)
{
  Box box;
  if (Status status = CheckInput(points, params, box); !status)
  {
    return status;
  }
  CloudOutline outline;
  outline.CellSize = params.CellSize > 0.0 ? params.CellSize : DefaultSize(points, box);
  outline.MaxGap = params.MaxGap > 0.0 ? params.MaxGap : 2.0 * outline.CellSize;
  auto grid = Rasterize(points, box, outline.CellSize);
  if (!grid)
  {
    return grid.Status;
  }
  CloseGaps(grid.Value, std::floor(outline.MaxGap / outline.CellSize * (1.0 + 1e-12)));
  JoinCorners(grid.Value);
  std::vector<int> sizes;
  const std::vector<int> numbers = FindParts(grid.Value, sizes);
  std::vector<int> order;
  for (std::size_t k = 0; k < sizes.size(); ++k)
  {
    if (sizes[k] >= params.MinCells)
    {
      order.push_back(static_cast<int>(k));
    }
  }
  if (order.empty())
  {
    return { ErrorCode::EmptyInput,
      "no " + std::to_string(params.MinCells) +
        " cells with points lie side by side; choose a larger cell size or gap" };
  }
  std::stable_sort(
    order.begin(), order.end(), [&](int a, int b) { return sizes[At(a)] > sizes[At(b)]; });
  for (const int k : order)
  {
    outline.Parts.push_back(MakePart(grid.Value, numbers, k + 1, box));
  }
  return outline;
}
}
