// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "GalerkinProblem.h"

namespace knotwork
{
/// Which coefficients are given, with their values: unknown f * components + component.
struct GivenCoefficients
{
  std::vector<char> IsGiven;
  Eigen::VectorXd Values;
};

/// Least squares on the facets of every component, then supports of single coefficients.
/// @return InvalidParameter with the condition: a facet or function that does not exist, one that
/// is given twice; NonFiniteInput for values that are no numbers; SingularSystem when functions are
/// dependent on the facets.
Result<GivenCoefficients> ProjectPrescribed(
  const GalerkinSpace& space, const GalerkinProblem& problem, const GalerkinParams& params);
}
