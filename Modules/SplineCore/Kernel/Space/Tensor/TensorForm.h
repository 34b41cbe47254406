// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/SizeLimit.h>
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// The same map as a tensor-product spline, exact up to rounding: lines of LR splines become as
/// long as the domain, hierarchical splines are refined to their finest level everywhere.
/// @param threads  0 = all cores. @return TooLarge above maxFunctions; DimensionMismatch for Bezier
/// elements, which have no common domain; Spline::Check's codes.
/// @complexity O(functions of the result) times a small power of the degree.
template <int Dim>
Result<Spline<Dim>> ToTensor(
  const Spline<Dim>& spline, int threads, int maxFunctions = DefaultMaxFunctions);
}
