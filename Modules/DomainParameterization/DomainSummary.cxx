// SPDX-License-Identifier: BSD-3-Clause
#include "DomainSummary.h"

#include "FieldNumbers.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
/// Larger is worse.
int Badness(Verdict verdict)
{
  switch (verdict)
  {
    case Verdict::Valid:
      return 0;
    case Verdict::Undecided:
      return 1;
    case Verdict::Reversed:
      return 2;
    case Verdict::Invalid:
      break;
  }
  return 3;
}
int Badness(InjectivityVerdict verdict)
{
  switch (verdict)
  {
    case InjectivityVerdict::Injective:
      return 0;
    case InjectivityVerdict::InjectiveUpToSeam:
      return 1;
    case InjectivityVerdict::Undecided:
      return 2;
    case InjectivityVerdict::NotInjective:
      break;
  }
  return 3;
}
template <typename Kind>
Kind Worse(Kind a, Kind b)
{
  return Badness(b) > Badness(a) ? b : a;
}

const char* StopName(DomainStop stop)
{
  switch (stop)
  {
    case DomainStop::Effort:
      return "effort";
    case DomainStop::Time:
      return "time_limit";
    case DomainStop::Finished:
      break;
  }
  return "finished";
}
}

DomainSummary Summarize(const DomainReport& report, int functions, std::size_t patches)
{
  DomainSummary summary;
  summary.Regularity = report.Certificate.Verdict;
  summary.Injectivity = report.Injectivity.Verdict;
  summary.Stop = report.Stop;
  summary.MinDetLower = report.MinDetLower;
  summary.MinDetUpper = report.MinDetUpper;
  summary.Area = report.Metrics.Area;
  summary.MinDetOverArea = report.Metrics.MinDetOverArea;
  summary.MaxDetOverArea = report.Metrics.MaxDetOverArea;
  summary.MinScaledJacobian = report.Metrics.MinScaledJacobian;
  summary.MeanScaledJacobian = report.Metrics.MeanScaledJacobian;
  summary.MeanConditionNumber = report.Metrics.MeanConditionNumber;
  summary.Iterations = report.Iterations;
  summary.Functions = functions;
  summary.Patches = static_cast<double>(patches);
  summary.Work = report.Work;
  return summary;
}

DomainSummary Combine(const std::vector<DomainSummary>& all)
{
  DomainSummary sum = all.front();
  if (all.size() == 1)
  {
    return sum;
  }
  double size = std::abs(sum.Area);
  sum.MeanScaledJacobian *= size;
  sum.MeanConditionNumber *= size;
  for (auto next = all.begin() + 1; next != all.end(); ++next)
  {
    sum.Regularity = Worse(sum.Regularity, next->Regularity);
    sum.Injectivity = Worse(sum.Injectivity, next->Injectivity);
    sum.Stop = next->Stop == DomainStop::Finished ? sum.Stop : next->Stop;
    sum.MinDetLower = std::min(sum.MinDetLower, next->MinDetLower);
    sum.MinDetUpper = std::min(sum.MinDetUpper, next->MinDetUpper);
    sum.Area += next->Area;
    sum.MinDetOverArea = std::min(sum.MinDetOverArea, next->MinDetOverArea);
    sum.MaxDetOverArea = std::max(sum.MaxDetOverArea, next->MaxDetOverArea);
    sum.MinScaledJacobian = std::min(sum.MinScaledJacobian, next->MinScaledJacobian);
    sum.MeanScaledJacobian += std::abs(next->Area) * next->MeanScaledJacobian;
    sum.MeanConditionNumber += std::abs(next->Area) * next->MeanConditionNumber;
    sum.Iterations += next->Iterations;
    sum.Functions += next->Functions;
    sum.Patches += next->Patches;
    sum.Work += next->Work;
    size += std::abs(next->Area);
  }
  sum.MeanScaledJacobian /= size;
  sum.MeanConditionNumber /= size;
  return sum;
}

void AddSummary(const DomainSummary& summary, vtkUnstructuredGrid* grid)
{
  AddText(grid, "Verdict", ToString(summary.Regularity));
  AddText(grid, "Injective", ToString(summary.Injectivity));
  AddNumber(grid, "JacobianMinLower", summary.MinDetLower);
  AddNumber(grid, "JacobianMinUpper", summary.MinDetUpper);
  AddNumber(grid, "Area", summary.Area);
  AddNumber(grid, "MinDetOverArea", summary.MinDetOverArea);
  AddNumber(grid, "MaxDetOverArea", summary.MaxDetOverArea);
  AddNumber(grid, "MinScaledJacobian", summary.MinScaledJacobian);
  AddNumber(grid, "MeanScaledJacobian", summary.MeanScaledJacobian);
  AddNumber(grid, "MeanConditionNumber", summary.MeanConditionNumber);
  AddNumber(grid, "Iterations", summary.Iterations);
  AddNumber(grid, "Work", summary.Work);
  AddText(grid, "Stopped", StopName(summary.Stop));
  AddNumber(grid, "Patches", summary.Patches);
  AddNumber(grid, "Functions", summary.Functions);
}
}
