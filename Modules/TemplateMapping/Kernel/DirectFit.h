// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FitSystem.h"

namespace knotwork
{
/// Normal equations as a sparse matrix, factored (LDL^T, minimum-degree order). The pattern is that
/// of the space and is analysed once; steps then only fill and factor.
template <int Dim>
std::unique_ptr<FitEquations<Dim>> MakeDirectFit(
  SplineSpacePtr<Dim> space, bool coupled, int threads);
}
