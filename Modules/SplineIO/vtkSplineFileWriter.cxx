// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineFileWriter.h"

#include "FileText.h"
#include "SplineFileModel.h"
#include <knotwork/SplineCore/TensorForm.h>
#include <knotwork/SplineGrid/PatchSplit.h>

#include "vtkDataObject.h"
#include "vtkInformation.h"

#include <functional>
#include <string>
#include <variant>

namespace
{
using namespace knotwork;

/// A patch as a tensor product, unless the format has its kind or words for the lack of it.
Status ExpandPatch(
  SplinePatch& patch, const std::function<bool(SpaceKind)>& holds, std::string& warning)
{
  return std::visit(
    [&](auto& spline) -> Status
    {
      const SpaceKind kind = spline.Space->Kind;
      if (kind == SpaceKind::Bezier || holds(kind))
      {
        return {};
      }
      const std::string where = "patch " + std::to_string(patch.Id);
      auto tensor = ToTensor(spline, 1);
      if (!tensor)
      {
        return { tensor.Status.Code, where + " as a tensor product: " + tensor.Status.Detail };
      }
      warning = where + " is written as a tensor product of " +
        std::to_string(tensor.Value.Space->NumFunctions) + " functions instead of " +
        std::to_string(spline.Space->NumFunctions) + ", as the format has no other kind";
      spline = std::move(tensor.Value);
      return {};
    },
    patch.Geometry);
}
}

vtkSplineFileWriter::vtkSplineFileWriter() = default;

vtkSplineFileWriter::~vtkSplineFileWriter()
{
  this->SetFileName(nullptr);
}

int vtkSplineFileWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPartitionedDataSetCollection");
  return 1;
}

knotwork::Status vtkSplineFileWriter::MakeText(std::string& text)
{
  using namespace knotwork;
  Result<SplineModel> model = DecodeSplineModel(this->GetInput(), 1);
  if (!model)
  {
    return model.Status;
  }
  if (!this->Holds(SpaceKind::Unstructured))
  {
    if (Status status = SplitUnstructuredPatches(model.Value, 1); !status)
    {
      return status;
    }
  }
  for (SplinePatch& patch : model->Patches)
  {
    std::string warning;
    const auto holds = [this](SpaceKind kind) { return this->Holds(kind); };
    if (Status status = ExpandPatch(patch, holds, warning); !status)
    {
      return status;
    }
    if (!warning.empty())
    {
      vtkWarningMacro("" << warning);
    }
  }
  Result<SplineFile> file = FileFromModel(model.Value, this->Coordinates);
  if (!file)
  {
    return file.Status;
  }
  if (Status status = this->AddMore(file.Value); !status)
  {
    return status;
  }
  for (const std::string& warning : file->Warnings)
  {
    vtkWarningMacro("" << warning);
  }
  Result<std::string> made = this->Format(file.Value);
  text = std::move(made.Value);
  return made.Status;
}

void vtkSplineFileWriter::WriteData()
{
  const knotwork::WriteOutcome outcome = knotwork::WriteText(
    this->GetInput(), this->FileName, [this](std::string& text) { return this->MakeText(text); });
  this->SetErrorCode(outcome.Code);
  if (!outcome.Message.empty())
  {
    vtkErrorMacro("" << outcome.Message);
  }
}
