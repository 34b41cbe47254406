// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "AnalysisData.h"
#include <knotwork/SplineAnalysis/AdaptiveSolution.h>
#include <knotwork/SplineAnalysis/ResultFields.h>

class vtkPolyData;
class vtkTable;

namespace knotwork
{
/// All that is known of a solved problem.
struct AnalysisResults
{
  const ProblemDescription& Description;
  const AnalysisBody& Body;
  const GalerkinProblem& Problem;
  const std::vector<ConditionPlace>& Places;
  const GalerkinSolution& Solution;
  const ErrorEstimate& Estimate;
  const ResultFields& Fields;
};

std::vector<AnalysisField> PointFields(const AnalysisResults& results);
std::vector<AnalysisCellField> CellFields(const AnalysisResults& results);
void EncodeGaussPoints(const AnalysisResults& results, vtkPolyData* output);
/// A row a condition.
void EncodeConditions(const AnalysisResults& results, vtkTable* table);
/// A row a step.
void EncodeHistory(const std::vector<AdaptiveStep>& history, vtkTable* table);
/// One row.
void EncodeNumbers(const AnalysisResults& results, vtkTable* table);
}
