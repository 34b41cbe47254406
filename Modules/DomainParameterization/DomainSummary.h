// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/DomainParameterization/DomainParameterization.h>

#include <vector>

class vtkUnstructuredGrid;

/// Private to the filter: what a report says in numbers.
namespace knotwork
{
/// Of a map, or of the maps of several domains together. Sent between processes as it is.
struct DomainSummary
{
  Verdict Regularity = Verdict::Valid;
  InjectivityVerdict Injectivity = InjectivityVerdict::Injective;
  DomainStop Stop = DomainStop::Finished;
  double MinDetLower = 0.0;
  double MinDetUpper = 0.0;
  double Area = 0.0;
  double MinDetOverArea = 0.0;
  double MaxDetOverArea = 0.0;
  double MinScaledJacobian = 0.0;
  double MeanScaledJacobian = 0.0;
  double MeanConditionNumber = 0.0;
  double Iterations = 0.0;
  double Functions = 0.0;
  double Patches = 0.0;
  double Work = 0.0;
};

DomainSummary Summarize(const DomainReport& report, int functions, std::size_t patches);

/// Of all: the worst verdicts, sums, extrema, and means by area.
/// @param all  at least one; one alone stays as it is.
DomainSummary Combine(const std::vector<DomainSummary>& all);

/// As field data.
void AddSummary(const DomainSummary& summary, vtkUnstructuredGrid* grid);
}
