// SPDX-License-Identifier: BSD-3-Clause
#include "vtkRigidAlignment.h"

#include "ScanData.h"
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineGrid/TableRow.h>

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointSet.h"

#include <cmath>

using namespace knotwork;

static_assert(vtkRigidAlignment::TUKEY == static_cast<int>(OutlierRule::Tukey) &&
    vtkRigidAlignment::TRIMMED == static_cast<int>(OutlierRule::Trimmed) &&
    vtkRigidAlignment::NO_OUTLIERS == static_cast<int>(OutlierRule::None),
  "the rules are those of the kernel");

vtkStandardNewMacro(vtkRigidAlignment);

namespace
{
void EncodeNumbers(const RigidAlignment& found, bool isSigned, vtkTable* table)
{
  const DistanceProfile& profile = found.Profile;
  AddColumn(table, "Converged", found.Converged ? 1 : 0);
  AddColumn(table, "Iterations", found.Iterations);
  AddColumn(table, "LastStep", found.LastStep);
  AddColumn(table, "Inliers", found.NumInliers);
  AddColumn(table, "InlierFraction", static_cast<double>(found.NumInliers) / profile.NumPoints);
  AddColumn(table, "InlierRms", found.InlierRms);
  AddColumn(
    table, "OutlierDistance", std::isfinite(found.OutlierDistance) ? found.OutlierDistance : -1.0);
  AddProfile(table, "", profile);
  AddTuple(table, "Percentiles", profile.Percentiles);
  AddColumn(table, "Ambiguous", found.EqualPoses == 1 && found.FreeMotions == 0 ? 0 : 1);
  AddColumn(table, "EqualPoses", found.EqualPoses);
  AddColumn(table, "FreeMotions", found.FreeMotions);
  AddColumn(table, "TargetSize", found.TargetSize);
  AddColumn(table, "Signed", isSigned ? 1 : 0);
  AddTuple(table, "Motion", found.Motion.Matrix());
}

constexpr double SmallScan = 0.2; ///< of the target's size: another unit, or a small part

std::vector<std::string> Warnings(const RigidAlignment& found, bool isSearched)
{
  std::vector<std::string> warnings;
  if (isSearched && found.SizeRatio < SmallScan)
  {
    warnings.push_back("the scan is " + Digits(found.SizeRatio, 2) +
      " times as large as the target: it fits in many places; are both in the same unit?");
  }
  if (!found.Converged)
  {
    warnings.push_back("the motion did not settle in " + std::to_string(found.Iterations) +
      " iterations: its last step moved points by " + Digits(found.LastStep) +
      "; raise the maximum of iterations, or leave out what is not the part");
  }
  if (found.FreeMotions > 0)
  {
    warnings.push_back("the scan can slide on the target in " + std::to_string(found.FreeMotions) +
      (found.FreeMotions == 1 ? " way" : " independent ways") +
      " and lies as well everywhere: one place of many was taken");
  }
  else if (found.EqualPoses > 1)
  {
    warnings.push_back("the scan lies as well in " + std::to_string(found.EqualPoses) +
      " poses, as on a symmetric part: one of them was taken");
  }
  return warnings;
}
}

vtkRigidAlignment::vtkRigidAlignment()
{
  this->SetInputTypes({ { { "vtkPointSet" } }, Shapes() });
  this->SetOutputTypes({ "vtkPointSet", "vtkTable" });
}

void vtkRigidAlignment::SetTargetConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkRigidAlignment::SetTargetData(vtkDataObject* target)
{
  this->SetInputDataObject(1, target);
}

int vtkRigidAlignment::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  MakeOutputLike(outputs, 0, vtkDataObject::GetData(inputs[0], 0));
  return this->MakeDeclaredOutputs(outputs);
}

Status vtkRigidAlignment::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPointSet* input = vtkPointSet::GetData(inputs[0], 0);
  vtkPointSet* output = vtkPointSet::GetData(outputs, 0);
  if (input->GetNumberOfPoints() == 0)
  {
    output->ShallowCopy(input);
    return {};
  }
  const auto decoded = DecodeScanAndTarget(inputs, "target", {}, this->KernelThreads());
  if (!decoded)
  {
    return decoded.Status;
  }
  AlignmentParams params;
  params.Coarse = this->Coarse;
  params.Outliers = static_cast<OutlierRule>(this->Outliers);
  params.TrimmedShare = this->TrimmedShare;
  params.Samples = this->Samples;
  params.MaxIterations = this->MaximumIterations;
  params.Tolerance = this->Tolerance;
  params.Threads = this->KernelThreads();
  params.Progress = this->Progress();
  const auto found = AlignToTarget(decoded->Scan, *decoded->Target, params);
  if (!found)
  {
    return found.Status;
  }
  EncodeMoved(input, found->Motion, output);
  EncodeDistances(found->Deviation, output);
  EncodeNumbers(found.Value, decoded->Target->IsClosed(), vtkTable::GetData(outputs, 1));
  this->ReportWarnings(Warnings(found.Value, this->Coarse));
  return {};
}
