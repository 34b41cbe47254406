// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineAnalysis.h"

#include "AnalysisRun.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>

using namespace knotwork;

vtkStandardNewMacro(vtkSplineAnalysis);

vtkSplineAnalysis::vtkSplineAnalysis()
{
  this->SetNumberOfOutputPorts(5);
}

double vtkSplineAnalysis::GetSeconds(int step)
{
  return step >= 0 && step < 4 ? this->Seconds[static_cast<std::size_t>(step)] : 0.0;
}

int vtkSplineAnalysis::FillOutputPortInformation(int port, vtkInformation* info)
{
  if (port == 0)
  {
    return this->Superclass::FillOutputPortInformation(port, info);
  }
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 1 ? "vtkPolyData" : "vtkTable");
  return 1;
}

int vtkSplineAnalysis::RequestDataObject(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->Superclass::RequestDataObject(request, inputs, outputs);
  return this->MakeDeclaredOutputs(outputs);
}

Status vtkSplineAnalysis::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkDataObject* input = vtkDataObject::GetData(inputs[0], 0);
  this->Seconds = {};
  if (HasNoCells(input))
  {
    return {}; // as VTK's filters: nothing of nothing
  }
  auto options = this->MakeOptions();
  if (!options)
  {
    return options.Status;
  }
  auto body = ReadBody(input, [&](vtkDataObject* data) { return this->DecodeInput(data); });
  if (!body)
  {
    return body.Status;
  }
  if (body->NumLeftOut > 0 && body->Boundary.Groups.empty() && body->Boundary.EdgeGroups.empty())
  {
    this->ReportWarnings(
      { std::to_string(body->NumLeftOut) + " cells of fewer dimensions than others are left out" });
  }
  const std::vector<SplinePatch>& patches = body->Model.Patches;
  const bool losesArrays = this->MaxSteps > 1 &&
    std::any_of(patches.begin(), patches.end(),
      [](const SplinePatch& patch) { return !patch.Fields.empty(); });
  options->KeepsGaussPoints = this->GaussPoints;
  AdaptiveParams& params = options->Params;
  params.Theta = this->Theta;
  params.Tolerance = this->ErrorTolerance;
  params.MaxFunctions = this->MaximumFunctions;
  params.MaxSteps = this->MaxSteps;
  auto results = RunAnalysis(std::move(body.Value), input, options.Value, this->Progress());
  if (!results)
  {
    return results.Status;
  }
  if (losesArrays)
  {
    this->ReportWarnings({ "point arrays of the input are not carried to refined patches; "
                           "solve with MaxSteps 1 to keep them" });
  }
  this->Seconds = { results->Solution.SecondsCertificate, results->Solution.SecondsAssembly,
    results->Solution.SecondsSolve, results->SecondsFields };
  EncodeGaussPoints(results.Value, vtkPolyData::GetData(outputs, 1));
  EncodeConditions(results.Value, vtkTable::GetData(outputs, 2));
  EncodeNumbers(results.Value, vtkTable::GetData(outputs, 3));
  EncodeHistory(results->History, vtkTable::GetData(outputs, 4));
  return EncodeResults(results.Value, input, vtkDataObject::GetData(outputs, 0));
}
