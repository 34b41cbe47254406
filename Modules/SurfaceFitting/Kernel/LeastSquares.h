// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ElementFunctions.h"
#include "ElementMoments.h"

namespace knotwork
{
struct LeastSquaresParams
{
  double Smoothing = 1e-9;
  double Accuracy = 0.0; ///< of the coefficients, > 0
  int MaxIterations = 300;
  int Threads = 0;
};

/// Coefficients that minimize the weighted sum of squared distances plus a thin-plate energy:
/// Smoothing times the mean weight of the points of an element times the energy of every element in
/// its own parameters, so that it means the same on every level of refinement. Conjugate gradients
/// from the given coefficients on; the sums have a fixed order.
/// @param coefficients  NumFunctions x c. @return false when a direction of negative curvature or
/// what is not finite was met; coefficients are what was reached before.
bool SolveLeastSquares(const ElementFunctions& functions, const ElementMoments& moments,
  const IntArray<2>& degree, const LeastSquaresParams& params, PointMatrix& coefficients);
}
