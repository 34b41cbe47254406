// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ChartSamples.h"
#include <knotwork/MeshParameterization/SparseCholesky.h>
#include <knotwork/SplineCore/SplineSpace.h>

namespace knotwork
{
/// Control points of a tensor-product space of one degree, simple inner knots, that minimize
///     sum_i w_i |S(u_i) - x_i|^2 + smoothing int |S_uu|^2 + 2 |S_uv|^2 + |S_vv|^2
///     + stretching int |S_u|^2 + |S_v|^2,
/// smoothing a hundred times larger on elements without samples.
/// Bit-identical for any number of threads.
class PenalizedSystem
{
public:
  PenalizedSystem(SplineSpacePtr<2> space, double smoothing, double stretching, int threads);

  /// @param samples  parameters inside the domain.
  /// @param weights  one a sample, >= 0.
  /// @return SingularSystem.
  /// @complexity O(samples (p + 1)^4) plus a sparse Cholesky factorization.
  Result<PointMatrix> Solve(const ChartSamples& samples, const Eigen::VectorXd& weights);

private:
  SplineSpacePtr<2> Space;
  int Threads;
  double Stiffness;                   ///< of elements without samples, beside Energy
  Eigen::SparseMatrix<double> Energy; ///< lower triangle
  SparseCholesky Cholesky;
};
}
