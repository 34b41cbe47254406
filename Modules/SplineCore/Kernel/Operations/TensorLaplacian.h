// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/KnotVector.h>

#include <Eigen/Core>

#include <vector>

namespace knotwork
{
/// Dense integrals of products of derivatives over the domain of a knot vector.
struct LineIntegrals
{
  Eigen::MatrixXd Mass;      ///< int N_i N_j
  Eigen::MatrixXd Stiffness; ///< int N_i' N_j'
  Eigen::MatrixXd Bending;   ///< int N_i'' N_j''
  Eigen::MatrixXd Mixed;     ///< int N_i'' N_j
};
LineIntegrals IntegrateLine(const KnotVector& knots);

/// Eigenvectors of directions, and the sums of their eigenvalues.
struct TensorModes
{
  std::vector<Eigen::MatrixXd> Modes; ///< mass-orthonormal eigenvectors, columns; one a direction
  Eigen::VectorXd Sums; ///< of a tensor product's functions, the first direction fastest
};

/// @param masses, stiffnesses  one symmetric matrix a direction; masses are positive definite.
/// @complexity O(n^3) a direction of n functions.
TensorModes FindTensorModes(
  const std::vector<Eigen::MatrixXd>& masses, const std::vector<Eigen::MatrixXd>& stiffnesses);

/// The inverse of the Galerkin Laplacian of tensor-product functions on their parameters, by the
/// modes of each direction. A constant that it leaves free counts as the next mode.
/// @source  Lynch, Rice, Thomas, Numerische Mathematik 6 (1964) 185-199 (fast diagonalization).
class TensorLaplacian
{
public:
  TensorLaplacian() = default;
  /// @param masses, stiffnesses  one symmetric matrix a direction, of the functions that count.
  /// @param threads  0 = all cores; results have the same bits for any number.
  /// @complexity O(n^3) a direction of n functions.
  TensorLaplacian(const std::vector<Eigen::MatrixXd>& masses,
    const std::vector<Eigen::MatrixXd>& stiffnesses, int threads);

  /// Number of functions.
  Eigen::Index Size() const { return this->Inverse.size(); }
  /// @param values  Size() numbers, the first direction fastest; become the solution.
  /// @complexity O(Size() * sum of n).
  void Apply(double* values);

private:
  void Multiply(bool transposed);

  std::vector<Eigen::MatrixXd> Modes; ///< mass-orthonormal eigenvectors, columns
  Eigen::VectorXd Inverse;            ///< 1 / sum of eigenvalues
  Eigen::VectorXd Values;
  Eigen::VectorXd Other;
  int Threads = 1;
};
}
