// SPDX-License-Identifier: BSD-3-Clause
// Glued Bezier elements halved and raised in degree, private to the kernel.
#pragma once
#include "Refinement.h"

namespace knotwork
{
/// @return InvalidTopology when an element has a function twice.
template <int Dim>
Result<RefinedSpline<Dim>> SplitBezierElements(const Spline<Dim>& spline);
/// The same, with all degrees raised by times > 0.
template <int Dim>
Result<Spline<Dim>> ElevateBezierElements(const Spline<Dim>& spline, int times);
}
