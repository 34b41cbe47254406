// SPDX-License-Identifier: BSD-3-Clause
#include "GrevilleGrid.h"
#include <knotwork/SplineCore/TensorSpace.h>

#include <Eigen/SparseLU>

namespace knotwork
{
namespace
{
/// Solves for the coefficients of the functions that take the values, a column a right-hand side.
Eigen::MatrixXd SolveCollocation(
  const KnotVector& knots, const std::vector<double>& lines, const Eigen::MatrixXd& values)
{
  const int p = knots.Degree();
  std::vector<Eigen::Triplet<double>> entries;
  std::array<double, MaxDegree + 1> basis;
  for (std::size_t i = 0; i < lines.size(); ++i)
  {
    const int e = knots.FindElement(lines[i]);
    knots.EvaluateFunctions(e, lines[i], 0, basis.data());
    for (int k = 0; k <= p; ++k)
    {
      entries.emplace_back(
        static_cast<int>(i), knots.Span(e) - p + k, basis[static_cast<std::size_t>(k)]);
    }
  }
  Eigen::SparseMatrix<double> matrix(knots.NumFunctions(), knots.NumFunctions());
  matrix.setFromTriplets(entries.begin(), entries.end());
  // banded and totally positive: the natural order has no fill but the band
  Eigen::SparseLU<Eigen::SparseMatrix<double>, Eigen::NaturalOrdering<int>> solver(matrix);
  return solver.solve(values);
}
}

std::array<std::vector<double>, 2> GrevilleLines(const NetKnots& knots)
{
  std::array<std::vector<double>, 2> lines;
  for (std::size_t d = 0; d < 2; ++d)
  {
    for (int i = 0; i < knots[d].NumFunctions(); ++i)
    {
      lines[d].push_back(knots[d].Greville(i));
    }
  }
  return lines;
}

PointMatrix InterpolateOnGrid(
  const NetKnots& knots, const std::array<std::vector<double>, 2>& grid, const PointMatrix& values)
{
  const Eigen::Index nu = knots[0].NumFunctions();
  const Eigen::Index nv = knots[1].NumFunctions();
  const Eigen::Index c = values.cols();
  Eigen::MatrixXd lines(nu, nv * c);
  for (Eigen::Index j = 0; j < nv; ++j)
  {
    lines.middleCols(j * c, c) = values.middleRows(j * nu, nu);
  }
  lines = SolveCollocation(knots[0], grid[0], lines);
  Eigen::MatrixXd columns(nv, nu * c);
  for (Eigen::Index j = 0; j < nv; ++j)
  {
    for (Eigen::Index i = 0; i < nu; ++i)
    {
      columns.row(j).segment(i * c, c) = lines.row(i).segment(j * c, c);
    }
  }
  columns = SolveCollocation(knots[1], grid[1], columns);
  PointMatrix control(nu * nv, c);
  for (Eigen::Index j = 0; j < nv; ++j)
  {
    for (Eigen::Index i = 0; i < nu; ++i)
    {
      control.row(j * nu + i) = columns.row(j).segment(i * c, c);
    }
  }
  return control;
}

PointMatrix ElementCentres(const NetKnots& knots)
{
  const int nu = knots[0].NumElements();
  const int nv = knots[1].NumElements();
  PointMatrix centres(static_cast<Eigen::Index>(nu) * nv, 2);
  for (Eigen::Index row = 0; row < centres.rows(); ++row)
  {
    const std::array<std::size_t, 2> element{ static_cast<std::size_t>(row % nu),
      static_cast<std::size_t>(row / nu) };
    for (std::size_t d = 0; d < 2; ++d)
    {
      const std::vector<double>& breaks = knots[d].Breaks();
      centres(row, static_cast<Eigen::Index>(d)) =
        0.5 * (breaks[element[d]] + breaks[element[d] + 1]);
    }
  }
  return centres;
}

Result<Spline<2>> SplineOnNet(const NetKnots& knots, PointMatrix control)
{
  const auto space = MakeTensorSpace<2>(knots);
  if (!space)
  {
    return space.Status;
  }
  Spline<2> surface;
  surface.Space = space.Value;
  surface.ControlPoints = std::move(control);
  return surface;
}
}
