// SPDX-License-Identifier: BSD-3-Clause
#include "GrevilleGrid.h"
#include <knotwork/SplineCore/TensorSpace.h>

#include <Eigen/LU>

namespace knotwork
{
namespace
{
/// Values of all functions (columns) at all Greville points (rows).
Eigen::MatrixXd GrevilleCollocation(const KnotVector& knots)
{
  const int p = knots.Degree();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(knots.NumFunctions(), knots.NumFunctions());
  for (int i = 0; i < knots.NumFunctions(); ++i)
  {
    const double u = knots.Greville(i);
    const int e = knots.FindElement(u);
    Eigen::VectorXd values(p + 1);
    knots.EvaluateFunctions(e, u, 0, values.data());
    matrix.row(i).segment(knots.Span(e) - p, p + 1) = values.transpose();
  }
  return matrix;
}
}

PointMatrix InterpolateAtGreville(const NetKnots& knots, const PointMatrix& values)
{
  const Eigen::Index nu = knots[0].NumFunctions();
  const Eigen::Index nv = knots[1].NumFunctions();
  const Eigen::Index c = values.cols();
  Eigen::MatrixXd lines(nu, nv * c);
  for (Eigen::Index j = 0; j < nv; ++j)
  {
    lines.middleCols(j * c, c) = values.middleRows(j * nu, nu);
  }
  lines = GrevilleCollocation(knots[0]).partialPivLu().solve(lines).eval();
  Eigen::MatrixXd columns(nv, nu * c);
  for (Eigen::Index j = 0; j < nv; ++j)
  {
    for (Eigen::Index i = 0; i < nu; ++i)
    {
      columns.row(j).segment(i * c, c) = lines.row(i).segment(j * c, c);
    }
  }
  columns = GrevilleCollocation(knots[1]).partialPivLu().solve(columns).eval();
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
