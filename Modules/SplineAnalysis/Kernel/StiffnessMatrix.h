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
/// Adds an element's matrix of one component to such a pattern.
/// @param block  symmetric, by the alive functions.
void AddElement(const GalerkinSpace& space, int element, const Eigen::MatrixXd& block,
  Eigen::SparseMatrix<double>& matrix);

/// Lower triangle of the matrix in all coefficients, unknown f * components + component. Element
/// matrices are made in parallel and added in the order of the elements.
/// @return InvalidTopology when the Jacobian is not finite at a point; Aborted.
Result<Eigen::SparseMatrix<double>> AssembleStiffness(const GalerkinSpace& space,
  const GalerkinProblem& problem, const GalerkinParams& params, const ProgressCallback& progress);
}
