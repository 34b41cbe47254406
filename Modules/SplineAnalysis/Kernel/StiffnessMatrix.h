// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "GalerkinProblem.h"

#include <Eigen/SparseCore>

namespace knotwork
{
/// Values that the solution has at a point.
int NumSolutionComponents(GalerkinEquation equation);

/// Lame's constants that a material acts with: in plane stress the first is the plate's.
struct LameConstants
{
  double First = 0.0;
  double Shear = 0.0;
};
LameConstants MakeLameConstants(GalerkinEquation equation, const GalerkinMaterial& material);
const GalerkinMaterial& MaterialOf(const GalerkinProblem& problem, int element);

/// The lower triangle of zeros where elements have entries. @return TooLarge.
/// @param matrix  filled in place: Eigen's matrices copy their entries when they are moved.
Status MakePattern(
  const GalerkinSpace& space, int components, int threads, Eigen::SparseMatrix<double>& matrix);
/// Places of an element's functions in ascending order.
void SortFunctions(const GalerkinSpace& space, int element, std::vector<int>& order);
/// Pairs of an element's functions are numbered by the places a >= b of these in that order.
inline std::size_t PairOf(int a, int b)
{
  return static_cast<std::size_t>(a) * static_cast<std::size_t>(a + 1) / 2 +
    static_cast<std::size_t>(b);
}
/// Adds the matrices of consecutive elements to such a pattern, in the order of the elements.
/// @param pairs  `width` entries an element: components x components a pair, the one of the trial
/// function's component j and the test function's component i at j * components + i.
void AddElements(const GalerkinSpace& space, int first, std::size_t count,
  const std::vector<double>& pairs, std::size_t width, int components, int threads,
  Eigen::SparseMatrix<double>& matrix);
/// The most functions that an element has.
int MostFunctions(const GalerkinSpace& space);

/// Lower triangle of the matrix in all coefficients, unknown f * components + component. Element
/// matrices are made in parallel and added in the order of the elements.
/// @return InvalidTopology when the Jacobian is not finite at a point; Aborted.
Result<Eigen::SparseMatrix<double>> AssembleStiffness(const GalerkinSpace& space,
  const GalerkinProblem& problem, const GalerkinParams& params, const ProgressCallback& progress);
}
