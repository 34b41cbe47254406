// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ConjugateGradients.h"
#include "GalerkinSpace.h"

#include <knotwork/SplineCore/TensorLaplacian.h>

/// On one tensor-product patch, whose functions are products: systems of its parameters, scaled to
/// the diagonal of the matrix, which are solved direction by direction.
namespace knotwork
{
/// The Laplacian of the parameters for each component alone, stretched in each direction as the map
/// does in the mean, on the functions behind sides that are given as a whole.
/// @source  Sangalli, Tani, SIAM J. Sci. Comput. 38 (2016) A3644-A3671.
class FastDiagonalization : public Preconditioner<1>
{
public:
  /// @param numbers  unknown of each coefficient f * components + component, -1: given.
  FastDiagonalization(const GalerkinSpace& space, int components, const std::vector<int>& numbers,
    const Eigen::VectorXd& diagonal, int threads);
  void Apply(const UnknownColumns<1>& side, UnknownColumns<1>& x) override;

private:
  struct Component
  {
    TensorLaplacian Laplacian;
    std::vector<int> Unknowns; ///< of the functions; -1: given
    Eigen::VectorXd Scales;
  };
  Component MakeComponent(const GalerkinSpace& space, int components, int component,
    const std::vector<int>& numbers, const Eigen::VectorXd& diagonal) const;

  std::vector<Component> Components;
  Eigen::VectorXd Values;
  int Threads;
};

/// The mass matrix of the parameters on all functions.
/// @source  Loli, Sangalli, Tani, Comput. Math. Appl. 116 (2022) 245-264.
class TensorMass : public Preconditioner<4>
{
public:
  TensorMass(const GalerkinSpace& space, const Eigen::VectorXd& diagonal, int threads);
  void Apply(const UnknownColumns<4>& side, UnknownColumns<4>& x) override;

private:
  /// Cholesky's factor of a band matrix: row i has its entries (i, i - p) to (i, i - 1), and the
  /// inverse of its diagonal.
  struct BandFactor
  {
    int Band = 0;
    std::vector<double> Rows;
  };
  static BandFactor Factorize(const Eigen::MatrixXd& matrix, int band);
  void SolveDirection(const BandFactor& factor, Eigen::Index inner, UnknownColumns<4>& x) const;

  std::vector<BandFactor> Factors;
  Eigen::VectorXd Scales;
  int Threads;
};
}
