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

/// The lower triangle of zeros where elements have entries, unknown f * components + component.
Eigen::SparseMatrix<double> MakePattern(const GalerkinSpace& space, int components);
/// Adds an element's dense matrix to such a pattern.
void AddElement(const Eigen::MatrixXd& block, const int* alive, int count, int components,
  Eigen::SparseMatrix<double>& matrix);

/// Lower triangle of the matrix in all coefficients, unknown f * components + component. Element
/// matrices are made in parallel and added in the order of the elements.
/// @return InvalidTopology when the Jacobian is not finite at a point; Aborted.
Result<Eigen::SparseMatrix<double>> AssembleStiffness(const GalerkinSpace& space,
  const GalerkinProblem& problem, const GalerkinParams& params, const ProgressCallback& progress);
}
