// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "Spline.h"

#include <Eigen/SparseCholesky>

namespace knotwork
{
/// Points that a spline map should take somewhere: rows of equal number.
template <int Dim>
struct FitSamples
{
  PointMatrix Parameters; ///< n x Dim, inside the domain
  PointMatrix Residuals;  ///< n x Dim, p_i - s(u_i) under the present control points
  PointMatrix Normals;    ///< n x Dim unit normals; not read when the normal weight is 0
};

/// Weights of the terms of a fit, >= 0.
struct FitWeights
{
  double Point = 0.0;    ///< of sum |s(u_i) - p_i|^2
  double Normal = 0.0;   ///< of sum ((s(u_i) - p_i) . N_i)^2
  double Proximal = 0.0; ///< of sum |c - c_present|^2 over the control points
};

/// Normal equations of one linear least-squares step for the control points of a polynomial spline
/// map. The pattern of the matrix is that of the space and is analysed once; steps then only fill
/// and factor (sparse LDL^T, minimum-degree order).
template <int Dim>
class FitSystem
{
public:
  /// @param coupled  true when normal terms couple the coordinates: Dim n unknowns instead of n.
  FitSystem(SplineSpacePtr<Dim> space, bool coupled);

  /// Change of the control points, NumFunctions x Dim, that minimizes the weighted sum.
  /// @param weights  Normal must be 0 unless coupled.
  /// @return OutsideDomain for a parameter outside, SingularSystem when a control point is
  /// determined by nothing (possible without a proximal term).
  /// @complexity O(samples * (p+1)^(2 Dim)) plus the factorization.
  Result<PointMatrix> Step(const FitSamples<Dim>& samples, const FitWeights& weights);

private:
  SplineSpacePtr<Dim> Space;
  bool Coupled;
  Eigen::SparseMatrix<double> Matrix; // lower triangle; unknown f * Dim + d when coupled, else f
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> Solver;
};
}
