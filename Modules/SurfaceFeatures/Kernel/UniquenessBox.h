// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CriticalSearch.h"

/// Private to FindCriticalPoints: the proof that a box holds exactly one zero of the gradient.
namespace knotwork
{
/// A 2 x 2 matrix of intervals, row-major.
using IntervalMatrix = std::array<Interval, 4>;

/// Bounds of the Hessians (or Jacobians of numerators) of pieces on a box.
IntervalMatrix BoundHessian(
  const ScalarPieces& pieces, const std::vector<int>& elements, const PlaneBox& box);

Interval Determinant(const IntervalMatrix& m);

/// Krawczyk's operator K = z - Y F(z) + (I - Y H)(B - z) with Y the inverse of the middle of H.
/// Every zero in the box B is in K; when K lies in the interior of B there is exactly one.
struct KrawczykStep
{
  bool Valid = false; ///< H's middle is regular
  PlaneBox K;
  int Sign = 0; ///< of the determinant of H's middle
};
/// @param home  a piece that holds z.
KrawczykStep Krawczyk(const ScalarPieces& pieces, int home, const RealArray<2>& z,
  const PlaneBox& box, const IntervalMatrix& hessian);

/// Proves a box around z; it is cut where it crosses a crease or the boundary.
/// @param home   a piece that holds z. @param reach  false: stay on that piece.
/// @return false when nothing is proved.
bool ProveUniqueness(const ScalarPieces& pieces, int home, const RealArray<2>& z, PlaneBox box,
  bool reach, FoundPoint& point);

/// Newton's method from a point of a piece, on the pieces as they come.
/// @param limit  largest distance from the start, a direction. @param home  in and out.
bool FindZero(const ScalarPieces& pieces, const RealArray<2>& limit, RealArray<2>& z, int& home);
}
