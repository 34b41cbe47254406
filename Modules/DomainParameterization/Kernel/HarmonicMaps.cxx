// SPDX-License-Identifier: BSD-3-Clause
#include "HarmonicMaps.h"

#include "InitialMaps.h"
#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/Quadrature.h>

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <string>

namespace knotwork
{
namespace
{
constexpr int Rounds = 100;    // of the coefficients of the variational harmonic map
constexpr double Still = 1e-9; // change of control points, of the domain's size
/// Part of the new map in the next one: whole steps may swing.
constexpr double Damping = 0.7;

template <int Dim>
using Square = Eigen::Matrix<double, Dim, Dim>;

/// Inner control points of least sum over quadrature points of |terms^T x|^2.
/// @param order  of the derivatives that are read.
/// @param rows   terms at a point, a row an alive function, from the map before and the functions.
template <int Dim, typename Rows>
Status SolveLeastSquares(Spline<Dim>& map, int order, const Rows& rows)
{
  const SplineSpace<Dim>& space = *map.Space;
  const std::vector<bool> fixed = BoundaryFunctions<Dim>(space);
  std::vector<int> unknown(fixed.size(), -1);
  int n = 0;
  for (std::size_t i = 0; i < fixed.size(); ++i)
  {
    unknown[i] = fixed[i] ? -1 : n++;
  }
  if (n == 0)
  {
    return {};
  }
  std::vector<Eigen::Triplet<double>> triplets;
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n, Dim);
  FunctionValues basis;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const auto& element = space.Elements[static_cast<std::size_t>(e)];
    IntArray<Dim> counts;
    double volume = 1.0;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      counts[d] = element.Degree[d] + 2; // one more than polynomials need
      volume *= element.Box.Upper[d] - element.Box.Lower[d];
    }
    const ElementQuadrature<Dim> rule = MakeElementQuadrature<Dim>(counts);
    Eigen::MatrixXd sums;
    for (Eigen::Index q = 0; q < rule.Local.rows(); ++q)
    {
      EvaluateFunctions<Dim>(space, e, rule.Local.row(q).data(), order,
        map.IsRational() ? &map.Weights : nullptr, basis);
      const Eigen::MatrixXd terms = rows(map, basis); // functions x terms
      if (q == 0)
      {
        sums = Eigen::MatrixXd::Zero(terms.rows(), terms.rows());
      }
      sums.noalias() += volume * rule.Weights[q] * terms * terms.transpose();
    }
    for (std::size_t a = 0; a < basis.Functions.size(); ++a)
    {
      const int row = unknown[static_cast<std::size_t>(basis.Functions[a])];
      for (std::size_t b = 0; row >= 0 && b < basis.Functions.size(); ++b)
      {
        const int column = unknown[static_cast<std::size_t>(basis.Functions[b])];
        const double value = sums(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
        if (column >= 0)
        {
          triplets.emplace_back(row, column, value);
        }
        else
        {
          right.row(row) -= value * map.ControlPoints.row(basis.Functions[b]);
        }
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  const Eigen::MatrixXd solution =
    solver.info() == Eigen::Success ? Eigen::MatrixXd(solver.solve(right)) : Eigen::MatrixXd();
  if (solution.rows() != n || !solution.allFinite())
  {
    return { ErrorCode::SingularSystem, "the equations of the first map have no unique solution" };
  }
  for (std::size_t i = 0; i < fixed.size(); ++i)
  {
    if (unknown[i] >= 0)
    {
      map.ControlPoints.row(static_cast<Eigen::Index>(i)) = solution.row(unknown[i]);
    }
  }
  return {};
}

template <int Dim>
int LeastDegree(const Spline<Dim>& map)
{
  int least = map.Space->Knots[0].Degree();
  for (const KnotVector& knots : map.Space->Knots)
  {
    least = std::min(least, knots.Degree());
  }
  return least;
}

/// Second derivatives sum_kl a_kl d_kl of the functions, symmetric a.
template <int Dim>
Eigen::VectorXd Combine(const FunctionValues& basis, const Square<Dim>& a)
{
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(basis.Values.rows());
  Eigen::Index column = 1 + Dim;
  for (Eigen::Index k = 0; k < Dim; ++k)
  {
    for (Eigen::Index l = k; l < Dim; ++l)
    {
      sum += (k == l ? 1.0 : 2.0) * a(k, l) * basis.Values.col(column++);
    }
  }
  return sum;
}

/// Adjugate of J^T J over its trace.
template <int Dim>
Square<Dim> Coefficients(const Spline<Dim>& map, const FunctionValues& basis)
{
  Square<Dim> jacobian = Square<Dim>::Zero(); // columns: derivatives
  for (std::size_t f = 0; f < basis.Functions.size(); ++f)
  {
    jacobian += map.ControlPoints.row(basis.Functions[f]).transpose() *
      basis.Values.row(static_cast<Eigen::Index>(f)).segment(1, Dim);
  }
  const Square<Dim> g = jacobian.transpose() * jacobian;
  Square<Dim> adjugate;
  if constexpr (Dim == 2)
  {
    adjugate << g(1, 1), -g(0, 1), -g(1, 0), g(0, 0);
  }
  else
  {
    for (Eigen::Index k = 0; k < 3; ++k)
    {
      const Eigen::Vector3d cross =
        g.row((k + 1) % 3).transpose().cross(g.row((k + 2) % 3).transpose());
      adjugate.row(k) = cross.transpose();
    }
  }
  const double trace = adjugate.trace();
  return trace > 0.0 ? Square<Dim>(adjugate / trace) : Square<Dim>::Identity() / Dim;
}
}

template <int Dim>
Status FillRationalHarmonic(Spline<Dim>& map)
{
  if (LeastDegree<Dim>(map) == 1)
  {
    return SolveLeastSquares<Dim>(map, 1,
      [](const Spline<Dim>&, const FunctionValues& basis)
      { return Eigen::MatrixXd(basis.Values.middleCols(1, Dim)); });
  }
  return SolveLeastSquares<Dim>(map, 2,
    [](const Spline<Dim>&, const FunctionValues& basis)
    { return Eigen::MatrixXd(Combine<Dim>(basis, Square<Dim>::Identity())); });
}

template <int Dim>
Status FillVariationalHarmonic(Spline<Dim>& map)
{
  if (LeastDegree<Dim>(map) == 1)
  {
    return { ErrorCode::InvalidDegree,
      "the variational harmonic map needs sides of degree 2 or more in every direction; raise the "
      "degree, or begin with another map" };
  }
  Status status = FillHarmonic<Dim>(map);
  const Eigen::RowVectorXd lower = map.ControlPoints.colwise().minCoeff();
  const double size = (map.ControlPoints.rowwise() - lower).maxCoeff();
  for (int round = 0; status && round < Rounds; ++round)
  {
    const PointMatrix before = map.ControlPoints;
    status = SolveLeastSquares<Dim>(map, 2,
      [](const Spline<Dim>& present, const FunctionValues& basis)
      { return Eigen::MatrixXd(Combine<Dim>(basis, Coefficients<Dim>(present, basis))); });
    const double change = (map.ControlPoints - before).cwiseAbs().maxCoeff();
    if (change <= Still * size)
    {
      break;
    }
    map.ControlPoints = (1.0 - Damping) * before + Damping * map.ControlPoints;
  }
  return status;
}

template Status FillRationalHarmonic<2>(Spline<2>&);
template Status FillRationalHarmonic<3>(Spline<3>&);
template Status FillVariationalHarmonic<2>(Spline<2>&);
template Status FillVariationalHarmonic<3>(Spline<3>&);
}
