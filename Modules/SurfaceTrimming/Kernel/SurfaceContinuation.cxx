// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceContinuation.h"
#include "GrevilleGrid.h"

#include <algorithm>

namespace knotwork
{
namespace
{
/// Clamped knots for interpolation at parameters: means of p parameters in a row.
/// @source  The NURBS Book, (9.8).
KnotVector AveragedKnots(int degree, const std::vector<double>& at)
{
  const auto p = static_cast<std::size_t>(degree);
  std::vector<double> knots(p + 1, at.front());
  for (std::size_t j = 1; j + p < at.size(); ++j)
  {
    double sum = 0.0;
    for (std::size_t k = j; k < j + p; ++k)
    {
      sum += at[k];
    }
    knots.push_back(sum / degree);
  }
  knots.insert(knots.end(), p + 1, at.back());
  return KnotVector::Create(degree, std::move(knots)).Value; // parameters rise
}

std::array<std::vector<double>, 2> EqualLines(
  const ParametricBox<2>& rectangle, const std::array<int, 2>& counts)
{
  std::array<std::vector<double>, 2> lines;
  for (std::size_t d = 0; d < 2; ++d)
  {
    for (int i = 0; i < counts[d]; ++i)
    {
      const double t = static_cast<double>(i) / (counts[d] - 1);
      lines[d].push_back((1.0 - t) * rectangle.Lower[d] + t * rectangle.Upper[d]);
    }
  }
  return lines;
}

/// The spline that interpolates a part of a grid.
struct PartSurface
{
  GridRectangle Part;
  NetKnots Knots;
  PointMatrix Control;
};

PartSurface Interpolate(const KnownGrid& grid, const GridRectangle& part, int degree)
{
  PartSurface made;
  made.Part = part;
  std::array<std::vector<double>, 2> lines;
  for (std::size_t d = 0; d < 2; ++d)
  {
    lines[d].assign(
      grid.Lines[d].begin() + part.First[d], grid.Lines[d].begin() + part.Last[d] + 1);
    made.Knots[d] = AveragedKnots(degree, lines[d]);
  }
  PointMatrix values(static_cast<Eigen::Index>(part.Size(0)) * part.Size(1), 3);
  for (int j = 0; j < part.Size(1); ++j)
  {
    values.middleRows(static_cast<Eigen::Index>(j) * part.Size(0), part.Size(0)) =
      grid.Points.middleRows(grid.Place(part.First[0], part.First[1] + j), part.Size(0));
  }
  made.Control = InterpolateOnGrid(made.Knots, lines, values);
  return made;
}

/// A surface at any parameters; its outermost polynomials are continued.
Eigen::RowVector3d Continued(const PartSurface& surface, double u, double v)
{
  const int p = surface.Knots[0].Degree();
  std::array<std::array<double, MaxDegree + 1>, 2> basis;
  std::array<int, 2> first;
  for (std::size_t d = 0; d < 2; ++d)
  {
    const double at = d == 0 ? u : v;
    const int element = surface.Knots[d].FindElement(at);
    surface.Knots[d].EvaluateFunctions(element, at, 0, basis[d].data());
    first[d] = surface.Knots[d].Span(element) - p;
  }
  Eigen::RowVector3d point = Eigen::RowVector3d::Zero();
  for (int j = 0; j <= p; ++j)
  {
    const Eigen::Index row =
      static_cast<Eigen::Index>(first[1] + j) * surface.Part.Size(0) + first[0];
    for (int i = 0; i <= p; ++i)
    {
      point += basis[0][static_cast<std::size_t>(i)] * basis[1][static_cast<std::size_t>(j)] *
        surface.Control.row(row + i);
    }
  }
  return point;
}

/// Adds a ring of points around a part, as far as the grid goes.
GridRectangle AddRing(const PartSurface& surface, KnownGrid& grid)
{
  GridRectangle next;
  for (std::size_t d = 0; d < 2; ++d)
  {
    next.First[d] = std::max(surface.Part.First[d] - 1, 0);
    next.Last[d] = std::min(surface.Part.Last[d] + 1, grid.Size(d) - 1);
  }
  for (int j = next.First[1]; j <= next.Last[1]; ++j)
  {
    for (int i = next.First[0]; i <= next.Last[0]; ++i)
    {
      if (!grid.IsKnown(i, j))
      {
        const Eigen::Index place = grid.Place(i, j);
        grid.Points.row(place) = Continued(surface, grid.Lines[0][static_cast<std::size_t>(i)],
          grid.Lines[1][static_cast<std::size_t>(j)]);
        grid.Known[static_cast<std::size_t>(place)] = 1;
      }
    }
  }
  return next;
}
}

GridRectangle LargestKnownRectangle(const KnownGrid& grid, int smallest)
{
  GridRectangle largest;
  Eigen::Index most = 0;
  // known points in a row above each point, and rectangles that end in a row: those that a stack
  // of rising heights leaves
  std::vector<int> heights(static_cast<std::size_t>(grid.Size(0)) + 1, 0);
  for (int j = 0; j < grid.Size(1); ++j)
  {
    for (int i = 0; i < grid.Size(0); ++i)
    {
      int& height = heights[static_cast<std::size_t>(i)];
      height = grid.IsKnown(i, j) ? height + 1 : 0;
    }
    std::vector<std::array<int, 2>> rising; // first column and height
    for (int i = 0; i <= grid.Size(0); ++i)
    {
      int first = i;
      const int height = heights[static_cast<std::size_t>(i)]; // 0 beyond the last column
      while (!rising.empty() && rising.back()[1] >= height)
      {
        first = rising.back()[0];
        const int tall = rising.back()[1];
        const Eigen::Index count = static_cast<Eigen::Index>(i - first) * tall;
        if (i - first >= smallest && tall >= smallest && count > most)
        {
          most = count;
          largest.First = { first, j - tall + 1 };
          largest.Last = { i - 1, j };
        }
        rising.pop_back();
      }
      rising.push_back({ first, height });
    }
  }
  return largest;
}

Result<Spline<2>> ContinueSurface(const ChartMesh& chart, const ParametricBox<2>& rectangle,
  int degree, const std::array<int, 2>& counts)
{
  KnownGrid grid = GridOfChart(chart, EqualLines(rectangle, counts));
  GridRectangle part = LargestKnownRectangle(grid, degree + 1);
  if (part.Size(0) <= 0)
  {
    const std::string points = std::to_string(degree + 1);
    return { ErrorCode::SingularSystem,
      "no " + points + " x " + points +
        " points of the grid lie in the chart: nothing to extrapolate; ask for more spans" };
  }
  PartSurface surface = Interpolate(grid, part, degree);
  while (part.Size(0) < grid.Size(0) || part.Size(1) < grid.Size(1))
  {
    part = AddRing(surface, grid);
    surface = Interpolate(grid, part, degree);
  }
  if (!surface.Control.allFinite())
  {
    return { ErrorCode::SingularSystem, "extrapolated points overflow; ask for fewer spans" };
  }
  return SplineOnNet(surface.Knots, std::move(surface.Control));
}
}
