// SPDX-License-Identifier: BSD-3-Clause
// What control points may do when elements of a fit are mended, private to the kernel.
#pragma once
#include "ElementUnfolding.h"
#include "FittedSpline.h"

namespace knotwork
{
/// Functions of the surface, which stay: 1, or HeldFast for those that no attraction moves.
/// @return one a function.
template <int Dim>
std::vector<char> HeldControlPoints(const FittedMesh<Dim>& mesh, const FittedSpline<Dim>& spline);

/// What control points may do when elements unfold: those on curves stay, others of a surface on
/// its target slide.
template <int Dim>
ControlPointPlaces PlacesOnTarget(const FittedMesh<Dim>& mesh, const FittedSpline<Dim>& spline);
}
