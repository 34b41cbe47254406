// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "GluedMap.h"

#include <Eigen/SparseCholesky>

namespace knotwork
{
enum class GluedOperator
{
  Laplacian, ///< int grad . grad over the parameter domains of all patches
  Rational,  ///< the same of the rational functions with the map's weights
  Spring     ///< neighbours in a control net are joined by springs of length zero, each pair once
};

/// A symmetric positive definite operator on the functions of patches (Spring: tensor-product
/// ones), factorized for those that are not fixed: makes first maps, and as preconditioner does for
/// several patches and refined spaces what FastLaplacian does for one tensor-product patch.
/// @complexity a sparse Cholesky factorization; a plane O(its entries).
template <int Dim>
class GluedSystem
{
public:
  /// @param map  spaces, numbers and what is fixed; its control points are not looked at.
  GluedSystem(const GluedMap<Dim>& map, GluedOperator kind);

  /// The inverse, by planes of as many numbers as there are free functions, in their order.
  void Apply(Eigen::VectorXd& planes) const;

  /// Free control points become those of least energy for the fixed ones.
  /// @return SingularSystem when a patch hangs on nothing fixed.
  Status Fill(GluedMap<Dim>& map) const;

private:
  std::vector<int> Unknown;          ///< position of each number among the free ones, -1: fixed
  Eigen::SparseMatrix<double> ToAll; ///< free rows, columns of all numbers
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> Solver;
  Eigen::Index NumFree = 0;
};
}
