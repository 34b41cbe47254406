// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ChartSamples.h"
#include "SplineSpace.h"

namespace knotwork
{
/// Control points of a tensor-product space of one degree, simple inner knots, that minimize
///     sum_i w_i |S(u_i) - x_i|^2 + smoothing int |S_uu|^2 + 2 |S_uv|^2 + |S_vv|^2
///     + stretching int |S_u|^2 + |S_v|^2
/// over the weighted rows of the samples.
/// @param samples  parameters inside the domain.
/// @return SingularSystem.
/// @complexity O(samples (p + 1)^4) plus a sparse Cholesky factorization. Bit-identical for any
/// number of threads.
Result<PointMatrix> SolvePenalized(const SplineSpace<2>& space, const ChartSamples& samples,
  double smoothing, double stretching, int threads);
}
