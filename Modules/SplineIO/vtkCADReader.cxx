// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCADReader.h"

#include "ForeignFile.h"
#include <knotwork/CADModel/CADComposite.h>
#include <knotwork/CADModel/CADExchange.h>
#include <knotwork/SurfaceTrimming/TrimData.h>
#include <knotwork/SurfaceTrimming/TrimmedGrids.h>
#include <knotwork/SurfaceTrimming/TrimmedMesh.h>

#include "vtkCellData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <fstream>

vtkStandardNewMacro(vtkCADReader);

namespace
{
using namespace knotwork;

/// The composites of faces, on cells that have a FaceId; nothing where there are none.
void AddComposites(const TrimmedModel& model, vtkDataSet* cells)
{
  std::vector<std::string> names;
  for (const TrimmedFace& face : model.Faces)
  {
    names.push_back(face.Name);
  }
  const std::vector<int> ids = CompositeIds(names);
  vtkDataArray* faces = cells->GetCellData()->GetArray("FaceId");
  if (!faces || std::all_of(ids.begin(), ids.end(), [](int id) { return id < 0; }))
  {
    return;
  }
  vtkNew<vtkIntArray> composites;
  composites->SetName("CompositeId");
  for (vtkIdType c = 0; c < faces->GetNumberOfTuples(); ++c)
  {
    composites->InsertNextValue(ids[static_cast<std::size_t>(faces->GetTuple1(c))]);
  }
  cells->GetCellData()->AddArray(composites);
}

/// What the file says of the faces, on their triangles.
void AddAttributes(const TrimmedModel& model, const TrimmedMesh& mesh, vtkPolyData* triangles)
{
  vtkNew<vtkIntArray> patches;
  patches->SetName("PatchId");
  vtkNew<vtkStringArray> names;
  names->SetName("Name");
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetName("Color");
  colors->SetNumberOfComponents(3);
  for (int f : mesh.TriangleFace)
  {
    const TrimmedFace& face = model.Faces[static_cast<std::size_t>(f)];
    patches->InsertNextValue(f);
    names->InsertNextValue(face.Name);
    for (double share : face.Color)
    {
      colors->InsertNextValue(
        static_cast<unsigned char>(face.HasColor ? std::lround(255.0 * share) : 255));
    }
  }
  AddComposites(model, triangles);
  triangles->GetCellData()->AddArray(patches);
  triangles->GetCellData()->AddArray(names);
  triangles->GetCellData()->AddArray(colors);
}
}

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
  const TrimmedModel& model = contents->Model;
  Status status = EncodeTrimmedModel(
    model, vtkUnstructuredGrid::GetData(outputs, 0), vtkUnstructuredGrid::GetData(outputs, 1));
  if (status)
  {
    AddComposites(model, vtkUnstructuredGrid::GetData(outputs, 0));
  }
  if (!status || !this->Triangulation)
  {
    return status;
  }
  TrimmedMeshParams meshing;
  meshing.Tolerance = this->ChordalTolerance * (this->RelativeTolerance ? SizeOf(model) : 1.0);
  meshing.Threads = this->KernelThreads();
  meshing.Progress = this->Progress();
  const auto mesh = TriangulateFaces(model, meshing);
  if (!mesh)
  {
    return { mesh.Status.Code, "the triangles of output 2: " + mesh.Status.Detail };
  }
  vtkPolyData* triangles = vtkPolyData::GetData(outputs, 2);
  EncodeTriangles(mesh.Value, triangles);
  AddAttributes(model, mesh.Value, triangles);
  return {};
}
