// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineExtrema.h"

#include "ExtremaData.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

using knotwork::Result;
using knotwork::Status;

vtkStandardNewMacro(vtkSplineExtrema);

vtkSplineExtrema::vtkSplineExtrema()
{
  this->SetNumberOfOutputPorts(3);
}

vtkSplineExtrema::~vtkSplineExtrema()
{
  this->SetFieldName(nullptr);
}

int vtkSplineExtrema::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 2 ? "vtkTable" : "vtkPolyData");
  return 1;
}

int vtkSplineExtrema::RequestDataObject(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  return this->MakeDeclaredOutputs(outputs);
}

Status vtkSplineExtrema::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  using namespace knotwork;
  const Result<SplineModel> model =
    DecodeSplineModel(vtkDataObject::GetData(inputs[0], 0), this->KernelThreads());
  if (!model)
  {
    return model.Status;
  }
  this->ReportWarnings(model->Warnings);
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
