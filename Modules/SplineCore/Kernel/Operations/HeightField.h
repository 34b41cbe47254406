// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BezierForm.h>

namespace knotwork
{
/// Whether the first two components of a polynomial spline are its parameters, up to 1e-7 of the
/// domain's sides (points may have been stored in single precision): z(x, y).
bool IsHeightField(const BezierForm<2>& form);
}
