// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineVersusMesh.h"

#include "AnalysisRun.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkTable.h"

using namespace knotwork;

vtkStandardNewMacro(vtkSplineVersusMesh);

namespace
{
constexpr int Reference = 2; ///< input
constexpr int Numbers = 2;   ///< output
constexpr std::array<const char*, 3> Names = { "spline", "mesh", "reference" };
}

vtkSplineVersusMesh::vtkSplineVersusMesh()
{
  this->SetInputTypes({ Splines(), Splines(), Optional(Splines()) });
  this->SetOutputTypes({ "vtkUnstructuredGrid", "vtkUnstructuredGrid", "vtkTable" });
}

void vtkSplineVersusMesh::SetMeshConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkSplineVersusMesh::SetMeshData(vtkDataObject* mesh)
{
  this->SetInputDataObject(1, mesh);
}

void vtkSplineVersusMesh::SetReferenceConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(Reference, output);
}

void vtkSplineVersusMesh::SetReferenceData(vtkDataObject* reference)
{
  this->SetInputDataObject(Reference, reference);
}

double vtkSplineVersusMesh::GetSeconds(int input, int step)
{
  return input >= 0 && input < 3 && step >= 0 && step < 3
    ? this->Seconds[static_cast<std::size_t>(input)][static_cast<std::size_t>(step)]
    : 0.0;
}

int vtkSplineVersusMesh::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  for (int port = 0; port < Numbers; ++port)
  {
    MakeOutputLike(outputs, port, vtkDataObject::GetData(inputs[port], 0));
  }
  MakeOutput(outputs, Numbers, "vtkTable");
  return 1;
}

Status vtkSplineVersusMesh::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->Seconds = {};
  const auto options = this->MakeOptions();
  if (!options)
  {
    return options.Status;
  }
  std::vector<AnalysisResults> all;
  const bool hasReference = inputs[Reference]->GetNumberOfInformationObjects() > 0;
  const int count = hasReference ? 3 : 2;
  for (int i = 0; i < count; ++i)
  {
    const std::string place = std::string("the ") + Names[static_cast<std::size_t>(i)] + ": ";
    vtkDataObject* const input = vtkDataObject::GetData(inputs[i], 0);
    auto body = HasNoCells(input)
      ? Result<AnalysisBody>(Status{ ErrorCode::EmptyInput, "it has no elements; give a body" })
      : ReadBody(input, [&](vtkDataObject* data) { return this->DecodeInput(data); });
    auto results = body
      ? RunAnalysis(std::move(body.Value), input, options.Value,
          [whole = this->Progress(), i, count](double share) { return whole((i + share) / count); })
      : Result<AnalysisResults>(body.Status);
    if (!results)
    {
      return { results.Status.Code, place + results.Status.Detail };
    }
    if (!hasReference && !results->Exact)
    {
      return { ErrorCode::EmptyInput,
        "there is nothing to compare with: give a finer body as reference (input 2), or the "
        "solution as \"exact\" in the problem" };
    }
    const GalerkinSolution& solution = results->Solution;
    this->Seconds[static_cast<std::size_t>(i)] = { solution.SecondsCertificate,
      solution.SecondsAssembly, solution.SecondsSolve };
    all.push_back(std::move(results.Value));
  }
  EncodeComparison(all, { Names.begin(), Names.begin() + count }, this->ReferencePeak,
    vtkTable::GetData(outputs, Numbers));
  for (int i = 0; i < Numbers; ++i)
  {
    if (const Status status = EncodeResults(all[static_cast<std::size_t>(i)],
          vtkDataObject::GetData(inputs[i], 0), vtkDataObject::GetData(outputs, i));
        !status)
    {
      return status;
    }
  }
  return {};
}
