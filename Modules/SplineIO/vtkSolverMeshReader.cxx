// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSolverMeshReader.h"

#include "ElementGrid.h"
#include "FileText.h"
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineIO/AbaqusInput.h>
#include <knotwork/SplineIO/GmshMesh.h>

#include "vtkObjectFactory.h"
#include "vtkUnstructuredGrid.h"

vtkStandardNewMacro(vtkSolverMeshReader);

namespace
{
bool IsAbaqus(const std::string& file)
{
  return knotwork::LowerEnding(file) == ".inp";
}
}

vtkSolverMeshReader::vtkSolverMeshReader()
{
  this->SetNumberOfInputPorts(0);
}

vtkSolverMeshReader::~vtkSolverMeshReader()
{
  this->SetFileName(nullptr);
}

int vtkSolverMeshReader::CanReadFile(const char* fileName)
{
  using namespace knotwork;
  const std::string file = fileName ? fileName : "";
  const std::string beginning = BeginningOfFile(file);
  return (IsAbaqus(file) ? LooksLikeAbaqusInput(beginning) : LooksLikeGmshMesh(beginning)) ? 1 : 0;
}

knotwork::Status vtkSolverMeshReader::Compute(vtkInformationVector**, vtkInformationVector* outputs)
{
  using namespace knotwork;
  const std::string file = this->FileName ? this->FileName : "";
  Result<std::string> text = TextOfFile(file);
  if (!text)
  {
    return text.Status;
  }
  const Result<ElementMesh> mesh =
    IsAbaqus(file) ? ReadAbaqusInput(text.Value) : ReadGmshMesh(text.Value);
  text.Value = {};
  if (!mesh)
  {
    return { mesh.Status.Code, "'" + file + "': " + mesh.Status.Detail };
  }
  this->ReportLeftOut(mesh->LeftOut);
  return EncodeElements(mesh.Value, vtkUnstructuredGrid::GetData(outputs));
}
