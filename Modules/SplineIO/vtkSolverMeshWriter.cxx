// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSolverMeshWriter.h"

#include "ElementGrid.h"
#include "FileText.h"
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineIO/GmshMesh.h>
#include <knotwork/SplineIO/MfemWriter.h>

#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkUnstructuredGrid.h"

vtkStandardNewMacro(vtkSolverMeshWriter);

vtkSolverMeshWriter::vtkSolverMeshWriter() = default;

vtkSolverMeshWriter::~vtkSolverMeshWriter()
{
  this->SetFileName(nullptr);
}

int vtkSolverMeshWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  return 1;
}

knotwork::Status vtkSolverMeshWriter::MakeText(std::string& text)
{
  using namespace knotwork;
  const std::string ending = LowerEnding(this->FileName);
  if (ending != ".msh" && ending != ".mesh")
  {
    return { ErrorCode::InvalidParameter,
      std::string("'") + this->FileName + "': meshes are written as .msh .mesh" };
  }
  const Result<ElementMesh> mesh =
    DecodeElements(vtkUnstructuredGrid::SafeDownCast(this->GetInput()));
  if (!mesh)
  {
    return mesh.Status;
  }
  if (ending == ".mesh")
  {
    Result<MfemText> made = WriteMfemMesh(mesh.Value);
    for (const std::string& part : made->LeftOut)
    {
      vtkWarningMacro("left out: " << part);
    }
    text = std::move(made->Text);
    return made.Status;
  }
  Result<std::string> made = WriteGmshMesh(mesh.Value, this->Binary);
  text = std::move(made.Value);
  return made.Status;
}

void vtkSolverMeshWriter::WriteData()
{
  const knotwork::WriteOutcome outcome = knotwork::WriteText(
    this->GetInput(), this->FileName, [this](std::string& text) { return this->MakeText(text); });
  this->SetErrorCode(outcome.Code);
  if (!outcome.Message.empty())
  {
    vtkErrorMacro("" << outcome.Message);
  }
}
