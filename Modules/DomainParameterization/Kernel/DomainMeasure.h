// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

#include <array>

namespace knotwork
{
/// Signed area (volume) that the sides of a map on [0, 1]^Dim enclose, from the sides alone by the
/// theorem of Green (Gauss): exact up to rounding for polynomial sides, by a rule of twelve more
/// points a direction for rational ones. Sides are numbered as in CompatibleBoundary.
template <int Dim>
double SignedMeasure(const std::array<Spline<Dim - 1>, 2 * Dim>& sides);

/// Adds what one side contributes to it.
/// @param number  of the side. @param origin  any point, the same for all sides of a domain; near
/// it keeps cancellation small.
template <int Dim>
void AddSideMeasure(const Spline<Dim - 1>& side, int number,
  const Eigen::Matrix<double, 1, Dim>& origin, double& sum);
}
