// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "GalerkinProblem.h"

namespace knotwork
{
/// Estimated error in the norm of energy, sqrt(a(u - u_h, u - u_h)). The squares of the parts are
/// sums over the elements, so Total^2 = Interior^2 + Jumps^2 + Loads^2 + Values^2.
struct ErrorEstimate
{
  std::vector<double> Elements; ///< one an element, >= 0; the sum of their squares is Total^2
  double Total = 0.0;
  double Interior = 0.0; ///< equilibrium inside elements: f + div(k grad u_h)
  double Jumps = 0.0;    ///< of the flux (traction) between elements, where functions are only C^0
  double Loads = 0.0;    ///< flux (traction) against its given value, 0 on free sides
  double Values = 0.0;   ///< solution against prescribed values
};

/// Estimates the error of a solution by what it leaves of the equations, on splines of every family
/// and Lagrange elements, in a constant times
///   h^2 / k |f + div(k grad u_h)|^2 inside an element,
///   h / (2 k) |jump of k du_h/dn|^2 on each of its sides inside,
///   h / k |g - k du_h/dn|^2 on sides that are loaded or free,
///   k / h |g - u_h|^2 on sides where values are prescribed
/// with h the length of the element's sides at the point and for elasticity sqrt(2 m (2 m + l)), of
/// Lame's constants l and m, in place of k. Second derivatives are exact through curved and
/// rational maps. Loads along edges and at points, and supports of single coefficients, are not
/// part of it: their functions stand in no equation. The constants depend on the degree. @see the
/// README for the measured ratio to the true error.
/// @param coefficients  functions x components, of a solution. Callables are called from the
/// calling thread alone. @param threads  0 = all cores; the result is the same for any number.
/// @return what SolveGalerkin says of the problem; SizeMismatch for the coefficients;
/// NonFiniteInput for coefficients, sources, loads or values that are no numbers; InvalidTopology
/// for a side of three elements; Aborted.
/// @complexity O(elements (p+1)^Dim (alive functions + (p+1)^Dim)).
/// @source  Verfuerth, A Posteriori Error Estimation Techniques for Finite Element Methods, 2013,
/// 1.4 and 4.1; Buffa, Giannelli, M3AS 26 (2016) 1-25 (hierarchical splines).
Result<ErrorEstimate> EstimateError(const GalerkinSpace& space, const GalerkinProblem& problem,
  const PointMatrixView& coefficients, int threads = 0, const ProgressCallback& progress = {});
}
