// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Types.h>

#include <vector>

/// Private to FitContourCurves: polynomials of two parameters along a cubic curve.
namespace knotwork
{
/// Bernstein coefficients times the binomials: products are convolutions.
using ScaledPolynomial = std::vector<double>;

ScaledPolynomial Multiply(const ScaledPolynomial& a, const ScaledPolynomial& b);
/// Of a cubic's Bernstein coefficients.
ScaledPolynomial ScaledCubic(const std::array<double, 4>& coefficients);
/// Largest magnitude of the Bernstein coefficients: a bound on [0, 1].
double LargestCoefficient(const ScaledPolynomial& a);
/// Smallest Bernstein coefficient.
double SmallestCoefficient(const ScaledPolynomial& a);

/// A plane cubic in Bernstein form.
using PlaneCubic = std::array<RealArray<2>, 4>;

/// Composes polynomials of one bidegree with one cubic after the other.
class CubicComposition
{
public:
  /// @param curve  control points in [0, 1]^2 keep the composition stable.
  CubicComposition(const IntArray<2>& degree, const PlaneCubic& curve);
  /// The polynomial along the curve, of degree 3 (p + q).
  ScaledPolynomial Of(const double* coefficients) const;

private:
  IntArray<2> Degree;
  std::array<std::vector<ScaledPolynomial>, 2> Basis; // B_i(u(t)), B_j(v(t))
};
}
