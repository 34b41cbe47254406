// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
// First maps by sums over quadrature points: inner control points of a tensor-product map of the
// unit square (cube) from those of the boundary, which stay as they are, as do all weights.

/// Least int |Laplacian|^2, or int |grad|^2 when a degree is 1, of the rational map with the
/// weights that it has.
/// @return SingularSystem never in exact arithmetic.
template <int Dim>
Status FillRationalHarmonic(Spline<Dim>& map);

/// The map whose inverse is harmonic. With G = J^T J and A its adjugate that means sum_kl A_kl
/// d_kl x = 0; minimized is int |sum_kl A_kl d_kl x|^2 / (trace A)^2 by linear least squares with
/// the A of the map before, from the harmonic map on, until it stands still. Reproduces maps of the
/// space whose inverse is harmonic: conformal ones, and those after a linear map of the parameters.
/// @return InvalidDegree when a degree is 1: there are no second derivatives then; SingularSystem.
/// @complexity some 20 to 100 sums over quadrature points, each with a sparse factorization.
/// @source  Xu, Mourrain, Duvigneau, Galligo, J. Comput. Phys. 252 (2013) 275-289.
template <int Dim>
Status FillVariationalHarmonic(Spline<Dim>& map);
}
