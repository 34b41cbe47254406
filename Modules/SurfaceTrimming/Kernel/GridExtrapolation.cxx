// SPDX-License-Identifier: BSD-3-Clause
#include "GridExtrapolation.h"
#include "GrevilleGrid.h"
#include "PenalizedFit.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr int FirstElements = 16;
/// Barycentric coordinates down to minus so much count as inside.
constexpr double Inside = 1e-12;

/// Points at the crossings of grid lines, some of them known.
struct KnownGrid
{
  std::array<std::vector<double>, 2> Lines;
  PointMatrix Points; ///< first direction fastest
  std::vector<char> Known;

  int Size(std::size_t direction) const { return static_cast<int>(this->Lines[direction].size()); }
  Eigen::Index Place(int i, int j) const
  {
    return static_cast<Eigen::Index>(j) * this->Size(0) + i;
  }
  bool IsKnown(int i, int j) const
  {
    return i >= 0 && j >= 0 && i < this->Size(0) && j < this->Size(1) &&
      this->Known[static_cast<std::size_t>(this->Place(i, j))];
  }
};

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

Result<PointMatrix> GridPoints(const ChartMesh& chart, const NetKnots& knots)
{
  KnownGrid grid;
  for (std::size_t d = 0; d < 2; ++d)
  {
    for (int i = 0; i < knots[d].NumFunctions(); ++i)
    {
      grid.Lines[d].push_back(knots[d].Greville(i));
    }
  }
  const Eigen::Index size = static_cast<Eigen::Index>(grid.Size(0)) * grid.Size(1);
  grid.Points.setZero(size, 3);
  grid.Known.assign(static_cast<std::size_t>(size), 0);
  for (const auto& triangle : chart.Triangles)
  {
    SetInside(chart, triangle, grid);
  }
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
  return grid.Points;
}
}

Result<BackMap> FitExtrapolated(const ChartMesh& chart, const BackMapParams& params)
{
  const ParametricBox<2> rectangle = BackMapRectangle(chart, params.Margin);
  const std::vector<std::array<int, 2>> boundary = BoundaryEdges(chart.Triangles);
  const bool byNeed = params.Elements == 0;
  int elements = byNeed ? std::min(FirstElements, params.MaxElements) : params.Elements;
  BackMap map;
  while (true)
  {
    const NetKnots knots = UniformNet(rectangle, params.Degree, elements);
    if (Status size = CheckNet(knots, params); !size)
    {
      map.Stop = BackMapStop::Functions; // the nets before it are a result
      return map.Passes > 0 ? Result<BackMap>(std::move(map)) : Result<BackMap>(size);
    }
    Result<PointMatrix> grid = GridPoints(chart, knots);
    if (!grid && byNeed && map.Passes == 0 && elements < params.MaxElements)
    {
      elements = std::min(2 * elements, params.MaxElements); // a grid too coarse for the chart
      continue;
    }
    if (!grid && map.Passes > 0)
    {
      return map; // finer nets overflow
    }
    if (!grid)
    {
      return grid.Status;
    }
    auto surface = SplineOnNet(knots, InterpolateAtGreville(knots, grid.Value));
    if (!surface)
    {
      return surface.Status;
    }
    const BackMapResiduals residuals = MeasureBackMap(MakeBezierForm(surface.Value, params.Threads),
      SampleChart(chart, boundary, knots, params.Threads), params.Threads);
    if (map.Passes == 0 || residuals.Max < map.MaxResidual) // finer nets may be worse
    {
      map.Surface = std::move(surface.Value);
      map.MaxResidual = residuals.Max;
      map.RmsResidual = residuals.Rms;
      map.WithinTolerance = residuals.Max <= params.Tolerance;
    }
    ++map.Passes;
    if (params.Progress &&
      !params.Progress(static_cast<double>(elements) / std::max(elements, params.MaxElements)))
    {
      return { ErrorCode::Aborted, "the back-map was stopped" };
    }
    if (!byNeed || map.WithinTolerance || elements >= params.MaxElements)
    {
      return map;
    }
    elements = std::min(2 * elements, params.MaxElements);
  }
}
}
