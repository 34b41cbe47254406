// SPDX-License-Identifier: BSD-3-Clause
// From a dataset and a problem's text to results: what the module's filters share.
#pragma once
#include "AnalysisResults.h"
#include "Expression.h"

namespace knotwork
{
/// What is solved, and how.
struct AnalysisOptions
{
  bool IsPoisson = true;
  bool IsPlaneStrain = false; ///< elasticity in the plane; else plane stress
  std::string Problem;        ///< as JSON
  CompileExpression Compile = MakeCompiler({});
  GalerkinMaterial Material; ///< where the problem gives none
  bool KeepsGaussPoints = false;
  AdaptiveParams Params; ///< MaxSteps 1: one solution
};

/// The problem's text, which stands in a property or in a file.
/// @return InvalidParameter for both; FileError.
Result<std::string> ReadProblemText(const char* text, const char* file);

/// Whether a dataset has no cells.
bool HasNoCells(vtkDataObject* data);

/// @param input  splines, or elements in one grid. @param decode  what reads splines.
/// @return MakeBody's failures; InvalidTopology.
Result<AnalysisBody> ReadBody(
  vtkDataObject* input, const std::function<Result<SplineModel>(vtkDataObject*)>& decode);

/// Solves and finds what is drawn. @param input  of the body, for its arrays.
/// @return what the kernels return.
Result<AnalysisResults> RunAnalysis(AnalysisBody body, vtkDataObject* input,
  const AnalysisOptions& options, const ProgressCallback& progress);
}
