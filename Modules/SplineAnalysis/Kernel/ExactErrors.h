// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "GalerkinProblem.h"

namespace knotwork
{
/// What a solution differs by from a known one, and how large that one is.
struct ExactErrors
{
  ErrorNorms Error;
  ErrorNorms Size;
  double EnergyError = 0.0; ///< root of a(u - u_h, u - u_h)
  double EnergySize = 0.0;  ///< root of a(u, u)
};

/// Compares a solution with a known one, which is called near the Gauss points of the elements,
/// from the calling thread alone: its gradient is found by differences of the fourth order over a
/// thousandth of the element, right to about 1e-11 of it. @param exact  fills as many values as the
/// solution has. @param coefficients  of the solution.
/// @return NonFiniteInput with the place where the known solution is no number.
/// @complexity O(elements q) calls, 4 Dim + 1 at each of q quadrature points.
Result<ExactErrors> CompareWithExact(const GalerkinSpace& space, const GalerkinProblem& problem,
  const PointMatrixView& coefficients, const PointFunction& exact);
}
