// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/KnotVector.h>

#include <Eigen/Core>

#include <vector>

namespace knotwork
{
/// The inverse of the Galerkin Laplacian on the inner functions of a tensor-product space, for
/// vectors of several planes: the functionals' Hessian is spectrally like it, so as preconditioner
/// it makes the number of iterations nearly independent of the space.
/// @complexity set up O(n^3) a direction; a plane O(functions * sum of n).
/// @source  Lynch, Rice, Thomas, Numerische Mathematik 6 (1964) 185-199 (fast diagonalization).
template <int Dim>
class FastLaplacian
{
public:
  explicit FastLaplacian(const std::array<KnotVector, Dim>& knots);
  /// Number of inner functions.
  Eigen::Index Size() const { return this->Inverse.size(); }
  /// @param planes  any number of planes of Size() numbers.
  void Apply(Eigen::VectorXd& planes);

private:
  std::vector<Eigen::MatrixXd> Modes; ///< mass-orthonormal eigenvectors, columns
  Eigen::VectorXd Inverse;            ///< 1 / sum of eigenvalues
  Eigen::VectorXd Temporary;
};
}
