// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ElementRule.h"
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
Status MakePattern(const GalerkinSpace& space, int components, const GalerkinParams& params,
  Eigen::SparseMatrix<double>& matrix);
/// Places of an element's functions in ascending order. @return whether these are 0, 1, 2 and so
/// on.
bool SortFunctions(const GalerkinSpace& space, int element, std::vector<int>& order);

/// The lower triangle of an element's matrix, functions in ascending order and a block of them
/// (FunctionBlock) at a time: for each b, components x components rows with the entries of the
/// functions from the block of b on, of which those before b are not defined. Row j * components +
/// i is of the trial function's component j and the test function's component i.
/// @param padded  number of functions, as PaddedFunctions. @return numbers before those of b, for
/// one component.
inline std::ptrdiff_t FirstEntry(int b, int padded)
{
  const std::ptrdiff_t block = b / FunctionBlock;
  return FunctionBlock * (block * padded - FunctionBlock * block * (block - 1) / 2) +
    (b - block * FunctionBlock) * (padded - block * FunctionBlock);
}
/// Numbers in a row of b.
inline std::ptrdiff_t RowLength(int b, int padded)
{
  return padded - b / FunctionBlock * FunctionBlock;
}
/// Numbers that the matrix of any element has room in.
std::size_t NumEntries(const GalerkinSpace& space, int components);
/// Adds the matrices of consecutive elements to such a pattern, in the order of the elements.
/// @param matrices  `width` numbers an element, as FirstEntry says.
void AddElements(const GalerkinSpace& space, int first, std::size_t count,
  const std::vector<double>& matrices, std::size_t width, int components, int threads,
  Eigen::SparseMatrix<double>& matrix);
/// The most functions that an element has.
int MostFunctions(const GalerkinSpace& space);

/// Lower triangle of the matrix in all coefficients, unknown f * components + component. Element
/// matrices are made in parallel and added in the order of the elements.
/// @return InvalidTopology when the Jacobian is not finite at a point; Aborted.
Result<Eigen::SparseMatrix<double>> AssembleStiffness(const GalerkinSpace& space,
  const GalerkinProblem& problem, const GalerkinParams& params, const ProgressCallback& progress);
}
