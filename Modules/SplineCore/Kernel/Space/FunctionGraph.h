// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// The graph (u, v, f(u, v)) of a polynomial function f, in the function's space. The parameters
/// are exact to rounding: their coefficients are the means of local knots where these give them
/// (tensor products), and are recovered from Bernstein coefficients where local refinement takes
/// that away (RecoverField, of the small rest only).
/// @return DimensionMismatch unless f has one component; InvalidParameter for a rational function,
/// whose graph is not in its space; Spline::Check's codes; RecoverField's. @param threads  0 = all
/// cores.
/// @complexity O(size of the Bezier form), plus that of RecoverField where it is needed.
Result<Spline<2>> GraphOfFunction(const Spline<2>& function, int threads);
}
