// SPDX-License-Identifier: BSD-3-Clause
#include "ElementSolution.h"

#include <knotwork/JacobianValidation/CellPieces.h>

#include <Eigen/LU>

#include <cmath>

namespace knotwork
{
namespace
{
/// The derivative of a Bernstein polynomial along a parameter is the degree times the difference of
/// two of one degree less: with the index lowered in that direction, and with the same index.
std::vector<double> MixedDerivative(CellShape shape, const CellDegree& degree, const double* u,
  const std::vector<std::size_t>& directions)
{
  std::vector<double> values(static_cast<std::size_t>(NumCellCoefficients(shape, degree)), 0.0);
  if (directions.empty())
  {
    EvaluateCellBasis(shape, degree, u, values.data(), nullptr);
    return values;
  }
  const std::size_t d = directions.back();
  const int p = degree[d];
  if (p == 0)
  {
    return values;
  }
  const bool simplex = shape == CellShape::Triangle || shape == CellShape::Tetrahedron;
  CellDegree less = degree;
  for (std::size_t k = 0; k < 3; ++k)
  {
    less[k] -= k == d || (simplex && degree[k] > 0) ? 1 : 0;
  }
  const std::vector<double> lower =
    MixedDerivative(shape, less, u, { directions.begin(), directions.end() - 1 });
  const auto at = [&](const std::array<int, 3>& i)
  {
    const bool exists = i[0] >= 0 && i[1] >= 0 && i[2] >= 0 && i[0] <= less[0] && i[1] <= less[1] &&
      i[2] <= less[2] && (!simplex || i[0] + i[1] + i[2] <= less[0]);
    return exists ? lower[static_cast<std::size_t>(CellCoefficient(shape, less, i[0], i[1], i[2]))]
                  : 0.0;
  };
  for (int k = 0; k <= degree[2]; ++k)
  {
    for (int j = 0; j <= degree[1]; ++j)
    {
      for (int i = 0; i <= degree[0] - (simplex ? j + k : 0); ++i)
      {
        std::array<int, 3> index{ i, j, k };
        const double same = at(index);
        --index[d];
        values[static_cast<std::size_t>(CellCoefficient(shape, degree, i, j, k))] =
          p * (at(index) - same);
      }
    }
  }
  return values;
}
}

PointMatrix BasisDerivatives(CellShape shape, const CellDegree& degree, const double* u, int order)
{
  const int n = NumCellCoefficients(shape, degree);
  const int dimension = NumParameters(shape);
  const int pairs = order > 1 ? dimension * (dimension + 1) / 2 : 0;
  PointMatrix rows(1 + dimension + pairs, n);
  EvaluateCellBasis(shape, degree, u, rows.data(), rows.data() + n);
  Eigen::Index row = 1 + dimension;
  for (int d = 0; d < dimension && order > 1; ++d)
  {
    for (int e = d; e < dimension; ++e)
    {
      const auto second = MixedDerivative(
        shape, degree, u, { static_cast<std::size_t>(d), static_cast<std::size_t>(e) });
      rows.row(row++) = Eigen::Map<const Eigen::RowVectorXd>(second.data(), n);
    }
  }
  return rows;
}

template <int Dim>
ElementSolution<Dim>::ElementSolution(
  const GalerkinSpace& space, const PointMatrixView& coefficients, int element)
  : Components(static_cast<int>(coefficients.cols())), Rational(space.Weights.size() > 0)
{
  const auto e = static_cast<std::size_t>(element);
  const int alive = space.NumAlive(element);
  const int n = NumCellCoefficients(space.Shapes[e], space.Degrees[e]);
  Eigen::MatrixXd rows(alive, Dim + this->Components + (this->Rational ? 1 : 0));
  for (int a = 0; a < alive; ++a)
  {
    const int f = space.Alive(element)[a];
    rows.row(a).head(Dim) = space.Points.row(f);
    rows.row(a).segment(Dim, this->Components) = coefficients.row(f);
    if (this->Rational)
    {
      rows(a, rows.cols() - 1) = 1.0;
      rows.row(a) *= space.Weights[f];
    }
  }
  const Eigen::Map<const PointMatrix> extraction(space.Operator(element), alive, n);
  this->Planes.noalias() = extraction.transpose() * rows;
}

template <int Dim>
SolutionPoint<Dim> ElementSolution<Dim>::At(const PointMatrixView& basis, int order) const
{
  // as sums: the products are too small for Eigen's blocks
  return this->FromTerms(
    basis.topRows(NumDerivativeTerms(Dim, order)).lazyProduct(this->Planes), order);
}

template <int Dim>
std::vector<SolutionPoint<Dim>> ElementSolution<Dim>::AtAll(
  const PointMatrixView& basis, int order) const
{
  const PointMatrix all = basis * this->Planes;
  const Eigen::Index rows = NumDerivativeTerms(Dim, order);
  std::vector<SolutionPoint<Dim>> points;
  points.reserve(static_cast<std::size_t>(all.rows() / rows));
  for (Eigen::Index first = 0; first < all.rows(); first += rows)
  {
    points.push_back(this->FromTerms(all.middleRows(first, rows), order));
  }
  return points;
}

template <int Dim>
SolutionPoint<Dim> ElementSolution<Dim>::FromTerms(Terms terms, int order) const
{
  if (this->Rational)
  {
    for (Eigen::Index plane = 0; plane + 1 < terms.cols(); ++plane)
    {
      DivideTerms<Dim>(order, terms.col(terms.cols() - 1).data(), terms.col(plane).data());
    }
  }
  SolutionPoint<Dim> point;
  point.Position = terms.row(0).template head<Dim>().transpose();
  point.Jacobian = terms.template block<Dim, Dim>(1, 0).transpose();
  point.Inverse = point.Jacobian.inverse();
  point.Determinant = point.Jacobian.determinant();
  point.Length = point.Jacobian.norm() / std::sqrt(static_cast<double>(Dim));
  const auto local = [&](int plane)
  {
    typename SolutionPoint<Dim>::Square second;
    for (int d = 0, row = 1 + Dim; d < Dim; ++d)
    {
      for (int e = d; e < Dim; ++e, ++row)
      {
        second(d, e) = second(e, d) = terms(row, plane);
      }
    }
    return second;
  };
  for (int i = 0; i < this->Components; ++i)
  {
    point.Value[i] = terms(0, Dim + i);
    point.Gradient.row(i) = terms.col(Dim + i).template segment<Dim>(1).transpose() * point.Inverse;
    if (order > 1)
    {
      auto& hessian = point.Hessian[static_cast<std::size_t>(i)];
      hessian = local(Dim + i);
      for (int c = 0; c < Dim; ++c)
      {
        hessian -= point.Gradient(i, c) * local(c);
      }
      hessian = (point.Inverse.transpose() * hessian * point.Inverse).eval();
    }
  }
  return point;
}

template class ElementSolution<2>;
template class ElementSolution<3>;
}
