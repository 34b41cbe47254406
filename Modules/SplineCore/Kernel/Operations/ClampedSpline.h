// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// The same map with clamped knots: the ends of the domain degree + 1 times, nothing beyond.
/// @pre a tensor-product space. @return failures of InsertKnots.
template <int Dim>
Result<Spline<Dim>> Clamped(const Spline<Dim>& spline);
}
