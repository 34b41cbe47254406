// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FitSystem.h"

namespace knotwork
{
/// Normal equations by preconditioned conjugate gradients. Their matrix is never formed: data terms
/// are applied sample by sample, measures point by point, quadratic functionals as one sparse
/// matrix for all coordinates. Only the preconditioner (IncompleteFactor) is, without most of the
/// couplings. Memory of a tricubic space: 512 bytes a sample and what MeasureTerms and
/// IncompleteFactor need.
template <int Dim>
std::unique_ptr<FitEquations<Dim>> MakeGradientFit(SplineSpacePtr<Dim> space, int threads);
}
