// SPDX-License-Identifier: BSD-3-Clause
#include "ChartGrid.h"

#include <algorithm>

namespace knotwork
{
namespace
{
/// Barycentric coordinates down to minus so much count as inside.
constexpr double Inside = 1e-12;

double Cross(const Eigen::RowVector2d& a, const Eigen::RowVector2d& b)
{
  return a[0] * b[1] - a[1] * b[0];
}

/// Sets the grid points that lie in a triangle and are not known yet.
void SetInside(const ChartMesh& chart, const std::array<int, 3>& corners, KnownGrid& grid)
{
  std::array<Eigen::RowVector2d, 3> p;
  for (std::size_t k = 0; k < 3; ++k)
  {
    p[k] = chart.UV.row(corners[k]);
  }
  const double area = Cross(p[1] - p[0], p[2] - p[0]);
  const auto range = [&](std::size_t d)
  {
    const auto c = static_cast<Eigen::Index>(d);
    const std::vector<double>& lines = grid.Lines[d];
    const double low = std::min({ p[0][c], p[1][c], p[2][c] });
    const double high = std::max({ p[0][c], p[1][c], p[2][c] });
    return std::array<int, 2>{ static_cast<int>(
                                 std::lower_bound(lines.begin(), lines.end(), low) - lines.begin()),
      static_cast<int>(std::upper_bound(lines.begin(), lines.end(), high) - lines.begin()) };
  };
  const auto columns = range(0);
  const auto rows = range(1);
  for (int j = rows[0]; j < rows[1]; ++j)
  {
    for (int i = columns[0]; i < columns[1]; ++i)
    {
      const Eigen::RowVector2d u(
        grid.Lines[0][static_cast<std::size_t>(i)], grid.Lines[1][static_cast<std::size_t>(j)]);
      const double b = Cross(u - p[0], p[2] - p[0]) / area;
      const double c = Cross(p[1] - p[0], u - p[0]) / area;
      if (grid.IsKnown(i, j) || b < -Inside || c < -Inside || b + c > 1.0 + Inside)
      {
        continue;
      }
      const Eigen::Index place = grid.Place(i, j);
      grid.Points.row(place) = (1.0 - b - c) * chart.Points.row(corners[0]) +
        b * chart.Points.row(corners[1]) + c * chart.Points.row(corners[2]);
      grid.Known[static_cast<std::size_t>(place)] = 1;
    }
  }
}
}

KnownGrid GridOfChart(const ChartMesh& chart, std::array<std::vector<double>, 2> lines)
{
  KnownGrid grid;
  grid.Lines = std::move(lines);
  const Eigen::Index size = static_cast<Eigen::Index>(grid.Size(0)) * grid.Size(1);
  grid.Points.setZero(size, 3);
  grid.Known.assign(static_cast<std::size_t>(size), 0);
  for (const auto& triangle : chart.Triangles)
  {
    SetInside(chart, triangle, grid);
  }
  return grid;
}
}
