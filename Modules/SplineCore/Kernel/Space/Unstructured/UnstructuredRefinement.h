// SPDX-License-Identifier: BSD-3-Clause
// Splines on unstructured meshes halved and raised in degree, private to the kernel.
#pragma once
#include "Refinement.h"

namespace knotwork
{
/// Every cell into 2^Dim, numbered c 2^Dim + corner; facets keep their continuity, those inside of
/// old cells get C^(p-1).
/// @return NotInSpace when that has no basis.
template <int Dim>
Result<RefinedSpline<Dim>> HalveUnstructured(const Spline<Dim>& spline);
/// The same cells and continuities, with the degree raised by times > 0.
template <int Dim>
Result<Spline<Dim>> ElevateUnstructured(const Spline<Dim>& spline, int times);
}
