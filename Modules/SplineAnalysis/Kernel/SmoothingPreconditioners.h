// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ConjugateGradients.h"
#include "GalerkinSpace.h"

#include <knotwork/MeshParameterization/SparseCholesky.h>

namespace knotwork
{
/// Symmetric Gauss-Seidel within blocks of unknowns: for mass matrices.
template <int Width>
class OneLevel : public Preconditioner<Width>
{
public:
  explicit OneLevel(const SymmetricMatrix<Width>& matrix) : Matrix(matrix) {}
  void Apply(const UnknownColumns<Width>& side, UnknownColumns<Width>& x) override
  {
    this->Matrix.GaussSeidel(side, x);
  }

private:
  const SymmetricMatrix<Width>& Matrix;
};

/// Gauss-Seidel, and the constants of the control points in each cell of a grid.
/// @source  Nicolaides, SIAM J. Numer. Anal. 24 (1987) 355-365 (constants of subdomains).
class TwoLevels : public Preconditioner<1>
{
public:
  /// @param numbers  unknown of each coefficient f * components + component, -1: given.
  TwoLevels(const GalerkinSpace& space, int components, const std::vector<int>& numbers,
    const Eigen::SparseMatrix<double>& lower, const SymmetricMatrix<1>& matrix);
  void Apply(const UnknownColumns<1>& side, UnknownColumns<1>& x) override;

private:
  const SymmetricMatrix<1>& Matrix;
  std::vector<int> CoarseOf; ///< unknowns
  SparseCholesky Coarse;
  bool HasCoarse = false;
  Eigen::MatrixXd Sums;
};
}
