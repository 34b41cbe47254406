// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// A tensor-product spline restricted to a box of its domain, which becomes the domain; the ends of
/// its knots are clamped there. An end of the box within 1e-12 of the domain's side of a knot is
/// that knot.
/// @return DimensionMismatch unless the space is of kind Tensor; OutsideDomain unless the box lies
/// in the domain (up to that distance) and has a size in every direction.
/// @source  the control points are blossoms at consecutive knots, as in InsertKnots.
template <int Dim>
Result<Spline<Dim>> RestrictTensor(const Spline<Dim>& spline, const ParametricBox<Dim>& box);
}
