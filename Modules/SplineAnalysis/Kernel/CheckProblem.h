// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "GalerkinProblem.h"

namespace knotwork
{
/// Conditions and materials fit the space, options their ranges. @return what SolveGalerkin says of
/// them.
Status CheckProblem(
  const GalerkinSpace& space, const GalerkinProblem& problem, const GalerkinParams& params);
}
