// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineExtrema.h"

#include "ExtremaData.h"

#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include <knotwork/SplineGrid/ReferenceSystem.h>

using knotwork::Result;
using knotwork::Status;

vtkStandardNewMacro(vtkSplineExtrema);

vtkSplineExtrema::vtkSplineExtrema()
{
  this->SetOutputTypes({ "vtkPolyData", "vtkPolyData", "vtkTable" });
  knotwork::KeepReferenceSystem(this);
}

vtkSplineExtrema::~vtkSplineExtrema()
{
  this->SetFieldName(nullptr);
}

Status vtkSplineExtrema::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  using namespace knotwork;
  const Result<SplineModel> model = this->DecodeInput(vtkDataObject::GetData(inputs[0], 0));
  if (!model)
  {
    return model.Status;
  }
  const std::string name = this->FieldName ? this->FieldName : "";
  const std::string field = name == "None" ? "" : name;
  const ProgressCallback progress = this->Progress();
  const auto count = static_cast<double>(model->Patches.size());
  std::vector<PatchPoints> patches;
  for (const SplinePatch& patch : model->Patches)
  {
    CriticalPointParams params;
    params.Component = this->Component;
    params.Boundary = this->Boundary;
    params.MaxDepth = this->MaximumDepth;
    params.MaxBoxes = this->MaximumBoxes;
    params.Threads = this->KernelThreads();
    const auto done = static_cast<double>(patches.size());
    params.Progress = [&progress, done, count](double share)
    { return progress((done + share) / count); };
    const Result<Spline<2>> function = FunctionOf(patch, field, params.Component);
    if (!function)
    {
      return function.Status;
    }
    Result<CriticalPoints> found = FindCriticalPoints(function.Value, params);
    if (!found)
    {
      return { found.Status.Code,
        "patch " + std::to_string(patch.Id) + ": " + found.Status.Detail };
    }
    patches.push_back({ &patch, std::move(found.Value) });
  }
  EncodeCounts(patches, vtkTable::GetData(outputs, 2));
  return EncodeExtrema(patches,
    { { this->Minima, this->Maxima, this->Saddles }, this->OnSurface, this->KernelThreads() },
    vtkPolyData::GetData(outputs, 0), vtkPolyData::GetData(outputs, 1));
}

Status vtkSplineExtrema::Merge(vtkInformationVector**, vtkInformationVector* outputs)
{
  knotwork::MergeExtrema(vtkPolyData::GetData(outputs, 0), vtkPolyData::GetData(outputs, 1),
    vtkTable::GetData(outputs, 2));
  return {};
}
