// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/SplineSpace.h>

namespace knotwork
{
/// Gauss-Legendre rule on [0, 1]: exact for degree 2n - 1. n in [1, 64].
struct QuadratureRule
{
  std::vector<double> Nodes;
  std::vector<double> Weights;
};
QuadratureRule GaussLegendre(int numPoints);

/// Tensor rule on [0, 1]^Dim, first direction fastest.
template <int Dim>
struct ElementQuadrature
{
  PointMatrix Local;       ///< n x Dim
  Eigen::VectorXd Weights; ///< n, sum 1; multiply by the element's parametric volume
};
template <int Dim>
ElementQuadrature<Dim> MakeElementQuadrature(const IntArray<Dim>& numPoints);
}
