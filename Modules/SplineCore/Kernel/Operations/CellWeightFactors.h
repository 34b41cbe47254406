// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "BezierForm.h"
#include "DualFunctionals.h"

namespace knotwork
{
/// Factors that bring the cells of a rational form to common weights: block e divided by factor e.
/// A rational cell is the same map whatever positive number multiplies its homogeneous points, but
/// in a spline the weight function is continuous wherever functions of the space are. In a space
/// with a domain neighbours are compared at the middle of their shared face; without one, at the
/// coefficients of shared functions. Factors spread breadth first, from factor 1 in the first
/// element of each set of connected elements.
/// @pre form is rational and its weights are positive. @param threads  0 = all cores.
template <int Dim>
std::vector<double> CellWeightFactors(
  const BezierForm<Dim>& form, const DualFunctionals<Dim>& duals, int threads);
}
