// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BezierForm.h>

namespace knotwork
{
/// Control points found from Bezier points, with what they achieve.
template <int Dim>
struct RecoveryResult
{
  knotwork::Status Status;
  Spline<Dim> Value;
  /// Largest Euclidean distance between a given Bezier point and that of the recovered spline, in
  /// the unit of the points (for coefficients of any component count: norm over the components).
  double Residual = 0.0;
  /// Largest relative distance of a Bezier weight from that of the recovered spline.
  double WeightResidual = 0.0;
  /// Largest row sum of the dual functionals used: rounding of the points grows at most by this
  /// (times the ratio of the weights when rational; times the condition of the system where
  /// functions were found by least squares).
  double Amplification = 1.0;
  /// |points| bound: largest magnitude of a given coordinate.
  double Size = 0.0;
  explicit operator bool() const { return static_cast<bool>(this->Status); }
};

/// Finds the spline of a space from the Bernstein control points of its elements.
///
/// Weights first: cells may carry their weights up to one factor each, which is fixed through faces
/// shared by neighbouring elements (the first element of each connected part keeps its own; weights
/// that fit as they are are not touched); then coefficients by the dual functionals (inverse
/// extraction) of the element with the least amplification among those on which the function's own
/// local coefficient appears (unit row of T; for hierarchical spaces: elements of the function's
/// level, by preservation of coefficients). Functions without such an element are found by one
/// sparse least squares, of minimum norm (SparseLeastSquares.h) if dependent. Inside the space the
/// result is exact to 64 eps * Amplification * Size; outside it is a projection and Residual tells
/// the distance.
/// @param form  Space set; Data may come from anywhere.
/// @param threads  0 = all cores; the result is the same for any number.
/// @return NonFiniteInput, InvalidWeight, SizeMismatch with the element; InvalidWeight with the
/// function when the space would need a weight that is not positive; EmptyInput without a space.
/// @complexity O(NumFunctions * prod(p + 1) * components), plus the sparse least squares if any: on
/// LR B-splines those of all functions but the corners'.
/// @source  Thomas et al., CMAME 284 (2015) 55-105 (reconstruction operators); Giannelli, Juettler,
/// Speleers, CAGD 29 (2012) (preservation of coefficients).
template <int Dim>
RecoveryResult<Dim> RecoverSpline(const BezierForm<Dim>& form, int threads);

/// Coefficients of a field of any component count in the geometry's space with the geometry's
/// weights.
/// @param form  a polynomial form whose planes are the field's Bezier values (not multiplied by
/// weights).
/// @param weights  weights of the geometry (size 0 when polynomial), NumFunctions.
/// @return as RecoverSpline; SizeMismatch also for a rational form or a wrong number of weights.
template <int Dim>
RecoveryResult<Dim> RecoverField(
  const BezierForm<Dim>& form, const Eigen::VectorXd& weights, int threads);
}
