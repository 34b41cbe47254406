// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

#include <Eigen/SparseCore>

namespace knotwork
{
/// Functions alive at one point with values and derivatives: what fitting and assembly take.
struct FunctionValues
{
  std::vector<int> Functions; ///< ascending ids
  PointMatrix Values; ///< one row a function: value, Dim first derivatives, then second derivatives
                      ///< (pairs 00, 01, 11 / 00, 01, 02, 11, 12, 22), as far as asked for
};

/// Evaluates the functions alive on an element at local parameters; derivatives are with respect to
/// the domain's parameters. The result's memory is reused between calls.
/// @param order    0, 1 or 2.
/// @param weights  nullptr, or NumFunctions weights: then the rational functions w_i N_i / W.
template <int Dim>
void EvaluateFunctions(const SplineSpace<Dim>& space, int element, const double* local, int order,
  const Eigen::VectorXd* weights, FunctionValues& result);

/// Values and derivatives with respect to the domain's parameter of the local functions of one
/// direction of an element; those of the element are their products.
/// @param factor  SplineSpace::Factor of the direction.
/// @param t       local parameter in [0, 1]. @param length  of the element's box.
/// @param order   0, 1 or 2.
/// @param rows    one row an order, of MaxDegree + 1 numbers; degree + 1 are written.
void EvaluateLocalLine(
  int degree, const double* factor, double t, double length, int order, double* rows);

/// Sparse n x NumFunctions matrix of function values at n domain parameters (rows of points outside
/// the domain: OutsideDomain, naming the first). @param threads  0 = all cores.
template <int Dim>
Result<Eigen::SparseMatrix<double, Eigen::RowMajor>> CollocationMatrix(
  const SplineSpace<Dim>& space, const PointMatrixView& parameters, int threads);
}
