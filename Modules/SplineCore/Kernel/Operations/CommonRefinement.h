// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/SizeLimit.h>
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// Brings two splines of one degree and one domain into one space; the maps do not change. Both
/// spaces have the same functions in the same order afterwards (their knots may differ by
/// rounding).
/// @param threads  0 = all cores. @param maxFunctions  of the common space.
/// @return what the insertions return; NotInSpace; TooLarge.
Status MakeCommon(Spline<2>& a, Spline<2>& b, int threads, int maxFunctions = DefaultMaxFunctions);
}
