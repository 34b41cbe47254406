// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "AnalysisData.h"
#include <knotwork/SplineAnalysis/AdaptiveSolution.h>
#include <knotwork/SplineAnalysis/ExactErrors.h>
#include <knotwork/SplineAnalysis/ResultFields.h>

#include <optional>

class vtkPolyData;
class vtkTable;

namespace knotwork
{
/// All that is known of a solved problem.
struct AnalysisResults
{
  ProblemDescription Description;
  AnalysisBody Body; ///< the refined one, where refinement is adaptive
  std::vector<ConditionPlace> Places;
  GalerkinProblem Problem;
  GalerkinSolution Solution;
  ErrorEstimate Estimate;
  std::vector<AdaptiveStep> History;
  ResultFields Fields;
  std::optional<ExactErrors> Exact; ///< where the problem has a known solution
  double SecondsFields = 0.0;
};

/// The input with the solution and what follows from it. @param output  of the input's class.
Status EncodeResults(AnalysisResults& results, vtkDataObject* input, vtkDataObject* output);
void EncodeGaussPoints(const AnalysisResults& results, vtkPolyData* output);
/// A row a condition.
void EncodeConditions(const AnalysisResults& results, vtkTable* table);
/// A row a step.
void EncodeHistory(const std::vector<AdaptiveStep>& history, vtkTable* table);
/// One row.
void EncodeNumbers(const AnalysisResults& results, vtkTable* table);
/// Solutions of one problem on several bodies: a row each. What they are compared with is the exact
/// solution, where the problem has one, else that of the third body. @param names  of the bodies.
/// @param peak  a known peak; 0: that of the third body, if there is one.
void EncodeComparison(const std::vector<AnalysisResults>& all,
  const std::vector<std::string>& names, double peak, vtkTable* table);
}
