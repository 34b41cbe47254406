// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FitSystem.h"

namespace knotwork
{
/// Normal equations by preconditioned conjugate gradients. Data terms are applied sample by sample,
/// quadratic functionals as a sparse matrix shared by the coordinates.
template <int Dim>
std::unique_ptr<FitEquations<Dim>> MakeGradientFit(SplineSpacePtr<Dim> space, int threads);
}
