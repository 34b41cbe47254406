// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BernsteinCells.h>

#include <vector>

/// Private to the injectivity proof: the sign of the Jacobian of a piece of a surface that is
/// projected to a plane.
namespace knotwork
{
/// A projected quadrilateral or triangle.
struct PlanePiece
{
  CellShape Shape = CellShape::Quadrilateral;
  CellDegree Degree{};
  std::vector<double> X;
  std::vector<double> Y;
  std::vector<double> W; ///< empty: polynomial. Else X and Y are homogeneous, (w x, w y)
  /// X, Y and W are off by at most so much.
  double Error = 0.0;
  double WeightError = 0.0;
  /// Polynomials: two neighbours of a lattice line that are one point. Their difference is zero
  /// exactly, whatever the rounding.
  std::vector<char> SameNextS; ///< one a coefficient: the next one in s is the same point
  std::vector<char> SameNextT; ///< the next one in t
};

/// Whether x_s y_t - x_t y_s, times orientation, is proved to be positive inside of the piece: all
/// its Bernstein coefficients are positive but for those that are exactly zero, and not all are
/// zero. Every Bernstein polynomial is positive inside.
bool HasPositiveInside(const PlanePiece& piece, double orientation);
}
