// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// Moves the inner control points of a polynomial map until its folds are gone: foldover removal of
/// domain parameterization. Those of the domain's boundary stay.
/// @return the map, proved regular; InvalidParameter when folds remain.
template <int Dim>
Result<Spline<Dim>> RemoveFolds(const Spline<Dim>& map, int threads);
}
