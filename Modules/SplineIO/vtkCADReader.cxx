// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCADReader.h"

#include "CADGrids.h"
#include "ForeignFile.h"
#include <knotwork/CADModel/CADExchange.h>

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <fstream>

vtkStandardNewMacro(vtkCADReader);

using namespace knotwork;

vtkCADReader::vtkCADReader()
{
  this->SetNumberOfInputPorts(0);
  this->SetNumberOfOutputPorts(3);
}

vtkCADReader::~vtkCADReader()
{
  this->SetFileName(nullptr);
}

int vtkCADReader::CanReadFile(const char* fileName)
{
  return fileName && HasCADEnding(fileName) && std::ifstream(fileName) ? 1 : 0;
}

int vtkCADReader::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 2 ? "vtkPolyData" : "vtkUnstructuredGrid");
  return 1;
}

int vtkCADReader::RequestDataObject(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  return this->MakeDeclaredOutputs(outputs);
}

Status vtkCADReader::Compute(vtkInformationVector**, vtkInformationVector* outputs)
{
  if (!this->FileName || this->FileName[0] == '\0')
  {
    return { ErrorCode::EmptyInput, "there is no file name" };
  }
  CADReadParams params;
  params.Unit = static_cast<LengthUnit>(this->Unit);
  params.Tolerance = this->Tolerance;
  const auto contents = this->SeparateProcess ? ReadCADInProcess(this->FileName, params)
                                              : ReadCAD(this->FileName, params);
  if (!contents)
  {
    return contents.Status;
  }
  this->ReportLeftOut(contents->LeftOut);
  this->ReportWarnings(contents->Warnings);
  TrimmedMeshParams meshing;
  meshing.Tolerance =
    this->ChordalTolerance * (this->RelativeTolerance ? SizeOf(contents->Model) : 1.0);
  meshing.Threads = this->KernelThreads();
  meshing.Progress = this->Progress();
  return EncodeCAD(contents->Model, this->Triangulation ? &meshing : nullptr,
    vtkUnstructuredGrid::GetData(outputs, 0), vtkUnstructuredGrid::GetData(outputs, 1),
    vtkPolyData::GetData(outputs, 2));
}
