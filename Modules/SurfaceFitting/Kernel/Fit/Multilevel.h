// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ElementFunctions.h"
#include "FitDivision.h"
#include "FitPoints.h"

namespace knotwork
{
/// One step of multilevel B-spline approximation: every coefficient moves by the average of what
/// each of its points alone would ask for, weighted as in the paper, so no equations are solved.
/// The step evaluates the surface itself: distances need not be measured before.
///   phi_ic = w_ic r_c / sum_k w_kc^2,   Delta P_i = sum_c w_ic^2 phi_ic / sum_c w_ic^2
/// with w_ic = N_i(u_c, v_c); points weigh Base * Boost in both sums.
/// @param fixed  not 0 where a function's coefficients stay as they are; empty: nowhere.
/// @source  Lee, Wolberg, Shin, IEEE TVCG 3 (1997) 228-244, equations (3) and (5); for LR
/// B-splines Skytt, Barrowclough, Dokken, Computers & Graphics 49 (2015) 58-68.
void MultilevelStep(const SplineSpace<2>& space, const ElementFunctions& functions,
  const FitPoints& points, const std::vector<std::uint8_t>& fixed, const FitDivision& division,
  int threads, PointMatrix& coefficients);
}
