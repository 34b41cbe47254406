// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "GalerkinProblem.h"
#include <knotwork/SplineCore/QuotientRule.h>

namespace knotwork
{
/// Bernstein polynomials of a shape at a point, a row each for the value, the first and (as far as
/// order says) the second derivatives, in the order of QuotientRule.h.
/// @param order  1 or 2.
PointMatrix BasisDerivatives(CellShape shape, const CellDegree& degree, const double* u, int order);

/// The map and the solution at a point of an element; derivatives of the solution are with respect
/// to x. Rows (entries) beyond the solution's components are not set.
template <int Dim>
struct SolutionPoint
{
  using Square = Eigen::Matrix<double, Dim, Dim>;
  Eigen::Matrix<double, Dim, 1> Position;
  Eigen::Matrix<double, Dim, 1> Value;
  Square Gradient; ///< a row a component
  std::array<Square, Dim> Hessian;
  Square Jacobian; ///< dx / d(parameters)
  Square Inverse;
  double Determinant = 0.0;
  /// Length of an element's sides there: the square root of the mean square of the lengths of the
  /// map's derivatives.
  double Length = 0.0;
};

/// A solution on one element in Bernstein form, for derivatives that functions do not give.
template <int Dim>
class ElementSolution
{
public:
  ElementSolution(const GalerkinSpace& space, const PointMatrixView& coefficients, int element);
  /// @param basis  rows of BasisDerivatives. @param order  2: with the Hessian.
  SolutionPoint<Dim> At(const PointMatrixView& basis, int order) const;
  /// At several points, in one product. @param basis  rows of BasisDerivatives, of all points.
  std::vector<SolutionPoint<Dim>> AtAll(const PointMatrixView& basis, int order) const;

private:
  static constexpr int MaxTerms = NumDerivativeTerms(Dim, 2);
  using Terms =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, MaxTerms, 2 * Dim + 1>;
  SolutionPoint<Dim> FromTerms(Terms terms, int order) const;

  int Components;
  bool Rational;
  Eigen::MatrixXd Planes; ///< a row a Bernstein polynomial: (w x, w u, w), or (x, u)
};
}
