// SPDX-License-Identifier: BSD-3-Clause
// Dense systems that are symmetric and definite, private to the kernel.
#pragma once
#include <Eigen/Core>

namespace knotwork
{
/// A = L L^T, L in the place of the lower triangle of A; what is above the diagonal does not count,
/// before or after.
/// @return false for a matrix that is not positive definite in double precision.
/// @complexity n^3 / 3 products, by panels, for the vectors that the processor at hand has and for
/// all threads; the bits do not depend on either.
bool FactorInPlace(Eigen::Ref<Eigen::MatrixXd> matrix, int threads);

/// x with L L^T x = b, a column each. @param factor  of FactorInPlace.
void SolveFactored(const Eigen::Ref<const Eigen::MatrixXd>& factor, Eigen::Ref<Eigen::MatrixXd> b);
}
