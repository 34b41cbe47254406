// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "GalerkinProblem.h"

namespace knotwork
{
/// Looks for parts of the body whose motions without energy (constants for Poisson's equation) no
/// given coefficient prevents.
/// @param isGiven  by unknown: function * components + component.
/// @return SingularSystem that names the motions of the first such part and an element of it.
Status CheckRigidMotions(
  const GalerkinSpace& space, GalerkinEquation equation, const std::vector<char>& isGiven);
}
