// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "GalerkinProblem.h"

namespace knotwork
{
/// Adds the integrals of a function times every function of the space. The function is called from
/// the calling thread alone. The same bits for any number of threads.
/// @param components  of the function's values. @param moments  functions x components.
/// @complexity O(elements q (p+1)^Dim) for q quadrature points.
void AddMoments(const GalerkinSpace& space, int components, const PointFunction& function,
  const GalerkinParams& params, Eigen::VectorXd& moments);
}
