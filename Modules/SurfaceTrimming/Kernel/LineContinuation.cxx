// SPDX-License-Identifier: BSD-3-Clause
#include "LineContinuation.h"
#include "ChartGrid.h"
#include "GrevilleGrid.h"

#include <algorithm>

namespace knotwork
{
namespace
{
/// What a direction says about a grid point: the polynomial through the known points next to it,
/// degree + 1 of them at most (Lagrange).
struct Continued
{
  Eigen::RowVector3d Point = Eigen::RowVector3d::Zero();
  int Count = 0; ///< of the points
};

Continued Extrapolate(const KnownGrid& grid, int i, int j, int di, int dj, int degree)
{
  const std::size_t d = di != 0 ? 0 : 1;
  Continued line;
  std::vector<double> at;
  while (line.Count <= degree && grid.IsKnown(i + (line.Count + 1) * di, j + (line.Count + 1) * dj))
  {
    ++line.Count;
    at.push_back(
      grid.Lines[d][static_cast<std::size_t>(d == 0 ? i + line.Count * di : j + line.Count * dj)]);
  }
  const double u = grid.Lines[d][static_cast<std::size_t>(d == 0 ? i : j)];
  for (std::size_t k = 0; k < at.size(); ++k)
  {
    double factor = 1.0;
    for (std::size_t m = 0; m < at.size(); ++m)
    {
      factor *= m == k ? 1.0 : (u - at[m]) / (at[k] - at[m]);
    }
    const int steps = static_cast<int>(k) + 1;
    line.Point += factor * grid.Points.row(grid.Place(i + steps * di, j + steps * dj));
  }
  return line;
}

/// One layer: of the grid points beside known ones those with polynomials of the highest degree.
/// @return how many.
std::size_t Grow(KnownGrid& grid, int degree)
{
  int best = 1;
  std::vector<Eigen::Index> places;
  std::vector<Eigen::RowVector3d> values;
  for (int j = 0; j < grid.Size(1); ++j)
  {
    for (int i = 0; i < grid.Size(0); ++i)
    {
      Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
      int count = 0;
      for (const auto& step : { std::array<int, 2>{ -1, 0 }, { 1, 0 }, { 0, -1 }, { 0, 1 } })
      {
        const Continued line =
          grid.IsKnown(i, j) ? Continued() : Extrapolate(grid, i, j, step[0], step[1], degree);
        if (line.Count > best)
        {
          best = line.Count;
          places.clear();
          values.clear();
          sum.setZero();
          count = 0;
        }
        if (line.Count == best)
        {
          sum += line.Point;
          ++count;
        }
      }
      if (count > 0)
      {
        places.push_back(grid.Place(i, j));
        values.push_back(sum / count);
      }
    }
  }
  for (std::size_t k = 0; k < places.size(); ++k)
  {
    grid.Points.row(places[k]) = values[k];
    grid.Known[static_cast<std::size_t>(places[k])] = 1;
  }
  return places.size();
}
}

Result<Spline<2>> ContinueLines(const ChartMesh& chart, const NetKnots& knots)
{
  KnownGrid grid = GridOfChart(chart, GrevilleLines(knots));
  while (Grow(grid, knots[0].Degree()) > 0)
  {
  }
  if (std::count(grid.Known.begin(), grid.Known.end(), 0) > 0)
  {
    return { ErrorCode::SingularSystem,
      "no point of the grid lies in the chart: nothing to extrapolate; ask for more spans" };
  }
  if (!grid.Points.allFinite())
  {
    return { ErrorCode::SingularSystem, "extrapolated points overflow; ask for fewer spans" };
  }
  return SplineOnNet(knots, InterpolateOnGrid(knots, grid.Lines, grid.Points));
}
}
