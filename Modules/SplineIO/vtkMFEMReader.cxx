// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMFEMReader.h"

#include "FileText.h"
#include "MfemGrid.h"
#include "SplineFileModel.h"

#include "vtkObjectFactory.h"
#include "vtkUnstructuredGrid.h"

vtkStandardNewMacro(vtkMFEMReader);

vtkMFEMReader::vtkMFEMReader()
{
  this->SetNumberOfInputPorts(0);
}

vtkMFEMReader::~vtkMFEMReader()
{
  this->SetFileName(nullptr);
}

int vtkMFEMReader::CanReadFile(const char* fileName)
{
  const std::string beginning = knotwork::BeginningOfFile(fileName ? fileName : "");
  return knotwork::LooksLikeMfemMesh(beginning) ? 1 : 0;
}

knotwork::Status vtkMFEMReader::Compute(vtkInformationVector**, vtkInformationVector* outputs)
{
  using namespace knotwork;
  const Result<std::string> text = TextOfFile(this->FileName ? this->FileName : "");
  if (!text)
  {
    return text.Status;
  }
  const std::string name = std::string("'") + this->FileName + "'";
  const Result<MfemMesh> mesh = ReadMfemMesh(text.Value);
  if (!mesh)
  {
    return { mesh.Status.Code, name + ": " + mesh.Status.Detail };
  }
  this->ReportWarnings(mesh->Warnings);
  auto* grid = vtkUnstructuredGrid::GetData(outputs);
  if (!mesh->IsSpline)
  {
    EncodeMfemCells(mesh.Value, grid);
    return {};
  }
  const Result<SplineModel> model = ModelFromFile(mesh->Splines);
  if (!model)
  {
    return { model.Status.Code, name + ": " + model.Status.Detail };
  }
  const Status status = EncodeSplineGrid(model.Value, grid);
  if (status)
  {
    AddPatchAttributes(mesh.Value, grid);
  }
  return status;
}
