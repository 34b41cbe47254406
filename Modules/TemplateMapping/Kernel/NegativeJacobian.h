// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BezierForm.h>

namespace knotwork
{
/// Share of the points of a regular grid over the domain (end points included) at which the
/// Jacobian determinant is negative; |det J| within rounding of zero is not. Equal to trying all
/// points, but elements whose determinant is seen to be of one sign are not tried.
/// It is a sample: it proves nothing between the points.
/// @param form                polynomial, of a spline with a parameter domain and Dim components.
/// @param pointsPerDirection  in [2, 100000], in space [2, 2000].
/// @return DimensionMismatch or InvalidParameter.
/// @complexity O(elements * p^4) plus a few operations a point of the other elements.
template <int Dim>
Result<double> NegativeJacobianShare(
  const BezierForm<Dim>& form, int pointsPerDirection, int threads = 0);
}
