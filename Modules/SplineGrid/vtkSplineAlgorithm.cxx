// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineAlgorithm.h"

#include "DistributedInput.h"
#include "FilterErrorCode.h"
#include "Processes.h"
#include "ReferenceSystem.h"
#include "SplineModel.h"

#include "vtkDataObject.h"
#include "vtkDataObjectTypes.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkSmartPointer.h"
#include "vtkTable.h"

#include <functional>

namespace
{
/// Outputs of filters that say so lie in the coordinates of the first input.
void PassReferenceSystem(
  vtkAlgorithm* filter, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const std::string system = knotwork::KeepsReferenceSystem(filter)
    ? knotwork::ReferenceSystemOf(vtkDataObject::GetData(inputs[0], 0))
    : std::string();
  for (int port = 0; !system.empty() && port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkDataObject* output = vtkDataObject::GetData(outputs, port);
    if (output && !vtkTable::SafeDownCast(output))
    {
      knotwork::SetReferenceSystem(output, system);
    }
  }
}
}

vtkSplineAlgorithm::vtkSplineAlgorithm() = default;

vtkSplineAlgorithm::InputType vtkSplineAlgorithm::Splines()
{
  return { { "vtkUnstructuredGrid", "vtkPartitionedDataSetCollection" } };
}

vtkSplineAlgorithm::InputType vtkSplineAlgorithm::Meshes()
{
  return { { "vtkPolyData", "vtkUnstructuredGrid" } };
}

vtkSplineAlgorithm::InputType vtkSplineAlgorithm::Shapes()
{
  return { { "vtkPolyData", "vtkUnstructuredGrid", "vtkPartitionedDataSetCollection" } };
}

vtkSplineAlgorithm::InputType vtkSplineAlgorithm::Optional(InputType type)
{
  type.IsOptional = true;
  return type;
}

void vtkSplineAlgorithm::SetInputTypes(std::vector<InputType> types)
{
  this->InputTypes = std::move(types);
  this->SetNumberOfInputPorts(static_cast<int>(this->InputTypes.size()));
}

int vtkSplineAlgorithm::FillInputPortInformation(int port, vtkInformation* info)
{
  const InputType type =
    this->InputTypes.empty() ? Splines() : this->InputTypes[static_cast<std::size_t>(port)];
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  for (const std::string& name : type.Classes)
  {
    info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), name.c_str());
  }
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), type.IsOptional ? 1 : 0);
  return 1;
}

void vtkSplineAlgorithm::SetOutputTypes(std::vector<std::string> types)
{
  this->OutputTypes = std::move(types);
  this->SetNumberOfOutputPorts(static_cast<int>(this->OutputTypes.size()));
}

int vtkSplineAlgorithm::FillOutputPortInformation(int port, vtkInformation* info)
{
  if (this->OutputTypes.empty())
  {
    return this->Superclass::FillOutputPortInformation(port, info);
  }
  info->Set(
    vtkDataObject::DATA_TYPE_NAME(), this->OutputTypes[static_cast<std::size_t>(port)].c_str());
  return 1;
}

void vtkSplineAlgorithm::MakeOutput(vtkInformationVector* outputs, int port, const char* type)
{
  vtkInformation* info = outputs->GetInformationObject(port);
  vtkDataObject* output = info->Get(vtkDataObject::DATA_OBJECT());
  if (!output || !output->IsA(type))
  {
    const auto made = vtkSmartPointer<vtkDataObject>::Take(vtkDataObjectTypes::NewDataObject(type));
    info->Set(vtkDataObject::DATA_OBJECT(), made);
  }
}

void vtkSplineAlgorithm::MakeOutputLike(
  vtkInformationVector* outputs, int port, vtkDataObject* input)
{
  vtkInformation* info = outputs->GetInformationObject(port);
  vtkDataObject* output = info->Get(vtkDataObject::DATA_OBJECT());
  if (input && (!output || !output->IsA(input->GetClassName())))
  {
    const auto made = vtkSmartPointer<vtkDataObject>::Take(input->NewInstance());
    info->Set(vtkDataObject::DATA_OBJECT(), made);
  }
}

int vtkSplineAlgorithm::MakeDeclaredOutputs(vtkInformationVector* outputs)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    MakeOutput(
      outputs, port, this->GetOutputPortInformation(port)->Get(vtkDataObject::DATA_TYPE_NAME()));
  }
  return 1;
}

int vtkSplineAlgorithm::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  if (!this->OutputTypes.empty())
  {
    return this->MakeDeclaredOutputs(outputs);
  }
  const bool collection = this->GetNumberOfInputPorts() > 0 &&
    vtkPartitionedDataSetCollection::GetData(inputs[0], 0) != nullptr;
  if (outputs->GetInformationObject(0))
  {
    MakeOutput(outputs, 0, collection ? "vtkPartitionedDataSetCollection" : "vtkUnstructuredGrid");
  }
  return 1;
}

int vtkSplineAlgorithm::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->SetErrorCode(vtkErrorCode::NoError);
  this->LeftOut.clear();
  knotwork::Status status;
  bool speaks = true;
  const auto attempt = [&status](const std::function<knotwork::Status()>& act)
  {
    try
    {
      status = status ? act() : status;
    }
    catch (...) // of a library below the kernel, out of memory
    {
      status = knotwork::StatusOfException();
    }
  };
  const int ports = this->GetNumberOfInputPorts();
  const int wholePort = this->WholeInputPort();
  const bool together = ports > 0 && this->WorksOnPieces() &&
    (this->SumsUpPieces() || wholePort >= 0) && knotwork::IsPieceOfEveryProcess(outputs);
  const auto agree = [&]
  {
    if (together)
    {
      int speaker = 0;
      status = knotwork::Processes::Agree(status, &speaker);
      speaks = speaker == knotwork::Processes::Own();
    }
  };
  // Sources run in the first of several processes alone.
  if (ports > 0 && !together && (!this->WorksOnPieces() || this->SumsUpPieces()))
  {
    attempt([&] { return knotwork::CheckWholeInput(inputs, ports, outputs, speaks); });
  }
  if (together && wholePort >= 0)
  {
    attempt(
      [&]
      {
        auto whole = knotwork::WholeForAll(vtkDataObject::GetData(inputs[wholePort], 0));
        this->Whole = whole.Value;
        return whole.Status;
      });
    agree();
  }
  if (together && this->SumsUpPieces())
  {
    attempt([&] { return this->Gather(inputs); });
    agree();
  }
  const bool idle =
    ports > 0 && knotwork::NumberOfPieces(outputs) > 1 && !knotwork::HasData(inputs, ports);
  if (!idle)
  {
    attempt([&] { return this->Compute(inputs, outputs); });
  }
  agree();
  if (together && this->SumsUpPieces() && status)
  {
    attempt([&] { return this->Merge(inputs, outputs); });
    agree();
  }
  this->Whole = nullptr;
  if (status)
  {
    PassReferenceSystem(this, inputs, outputs);
    return 1;
  }
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    if (vtkDataObject* output = vtkDataObject::GetData(outputs, port))
    {
      output->Initialize();
    }
  }
  this->SetErrorCode(knotwork::FilterErrorCode(status));
  if (status.Code == knotwork::ErrorCode::Aborted) // as asked for: no error
  {
    return 1;
  }
  if (speaks)
  {
    vtkErrorMacro("" << status.Message());
  }
  // Of several processes all go on, with empty outputs: filters behind this one may wait for all.
  return knotwork::NumberOfPieces(outputs) > 1 ? 1 : 0;
}

vtkDataObject* vtkSplineAlgorithm::WholeInput(vtkInformationVector** inputs) const
{
  return this->Whole ? this->Whole.Get()
                     : vtkDataObject::GetData(inputs[this->WholeInputPort()], 0);
}

knotwork::Result<knotwork::SplineModel> vtkSplineAlgorithm::DecodeInput(vtkDataObject* input)
{
  auto model = knotwork::DecodeSplineModel(input, this->KernelThreads());
  this->ReportWarnings(model->Warnings);
  return model;
}

void vtkSplineAlgorithm::ReportWarnings(const std::vector<std::string>& warnings)
{
  for (const std::string& warning : warnings)
  {
    vtkWarningMacro("" << warning);
  }
}

void vtkSplineAlgorithm::ReportLeftOut(const std::vector<std::string>& parts)
{
  this->LeftOut = parts;
  this->ReportWarnings(parts);
}

std::string vtkSplineAlgorithm::GetPartLeftOut(int i) const
{
  return i >= 0 && i < this->GetNumberOfPartsLeftOut() ? this->LeftOut[static_cast<std::size_t>(i)]
                                                       : std::string();
}

knotwork::ProgressCallback vtkSplineAlgorithm::Progress()
{
  return [this](double share)
  {
    this->UpdateProgress(share);
    return this->GetAbortExecute() == 0;
  };
}

int vtkSplineAlgorithm::KernelThreads() const
{
  if (this->Threads > 0)
  {
    return this->Threads;
  }
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  return controller && controller->GetNumberOfProcesses() > 1 ? 1 : 0;
}
