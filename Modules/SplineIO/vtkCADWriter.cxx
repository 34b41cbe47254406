// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCADWriter.h"
#include <knotwork/SplineGrid/DistributedInput.h>

#include <knotwork/CADModel/BoundaryFaces.h>
#include <knotwork/CADModel/CADExchange.h>
#include <knotwork/SplineCore/TensorForm.h>
#include <knotwork/SplineGrid/FilterErrorCode.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SurfaceTrimming/TrimmedGrids.h>

#include "vtkAlgorithmOutput.h"
#include "vtkCellData.h"
#include "vtkDataObject.h"
#include "vtkErrorCode.h"
#include "vtkExecutive.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <exception>

vtkStandardNewMacro(vtkCADWriter);

namespace
{
using namespace knotwork;

/// The faces that a filter gives beside triangles of them; null: there are none. ParaView puts
/// filters of its own between.
vtkDataObject* FacesBeside(vtkAlgorithmOutput* triangles)
{
  vtkAlgorithm* producer = triangles ? triangles->GetProducer() : nullptr;
  while (
    producer && producer->IsA("vtkPVPostFilter") && producer->GetNumberOfInputConnections(0) == 1)
  {
    producer = producer->GetInputAlgorithm(0, 0);
  }
  for (int port = 0; producer && port < producer->GetNumberOfOutputPorts(); ++port)
  {
    auto* grid = vtkUnstructuredGrid::SafeDownCast(producer->GetOutputDataObject(port));
    vtkCellData* cells = grid ? grid->GetCellData() : nullptr;
    if (cells && cells->HasArray("FaceReversed") && cells->HasArray("TrimmingCurves"))
    {
      return grid;
    }
  }
  return nullptr;
}

/// Faces of surfaces, with their trimming curves, or the boundary of volumes.
Result<TrimmedModel> DecodeFaces(
  vtkDataObject* grid, vtkDataObject* curves, double tolerance, std::vector<std::string>& warnings)
{
  Result<SplineModel> model = DecodeSplineModel(grid, 1);
  if (!model)
  {
    return model.Status;
  }
  const auto isVolume = [](const SplinePatch& patch)
  { return std::holds_alternative<Spline<3>>(patch.Geometry); };
  if (std::none_of(model->Patches.begin(), model->Patches.end(), isVolume))
  {
    return DecodeTrimmedModel(grid, curves, &warnings);
  }
  std::vector<Spline<3>> volumes;
  for (const SplinePatch& patch : model->Patches)
  {
    if (const auto* volume = std::get_if<Spline<3>>(&patch.Geometry))
    {
      auto tensor = volume->Space->Kind == SpaceKind::Unstructured ? Result<Spline<3>>(*volume)
                                                                   : ToTensor(*volume, 1);
      if (!tensor)
      {
        return { tensor.Status.Code,
          "patch " + std::to_string(patch.Id) + ": " + tensor.Status.Detail };
      }
      volumes.push_back(std::move(tensor.Value));
    }
  }
  if (volumes.size() != model->Patches.size())
  {
    return { ErrorCode::DimensionMismatch,
      "the grid has volumes and patches of other dimensions; write them to files of their own" };
  }
  auto boundary = BoundaryFaces(volumes, tolerance, &warnings);
  warnings.insert(warnings.end(), model->Warnings.begin(), model->Warnings.end());
  if (curves)
  {
    warnings.emplace_back("volumes are not trimmed: the curves are left out");
  }
  return boundary;
}
}

vtkCADWriter::vtkCADWriter()
{
  this->SetNumberOfInputPorts(2);
}

vtkCADWriter::~vtkCADWriter()
{
  this->SetFileName(nullptr);
  this->SetProductName(nullptr);
}

int vtkCADWriter::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPartitionedDataSetCollection");
  if (port == 0)
  {
    info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  }
  else
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

Status vtkCADWriter::WriteModel()
{
  if (!this->FileName || this->FileName[0] == '\0')
  {
    return { ErrorCode::InvalidParameter, "there is no file name" };
  }
  bool idle = false;
  if (const Status one = CheckOneWriter(this->GetInput(), idle); idle || !one)
  {
    return one;
  }
  vtkDataObject* curves =
    this->GetNumberOfInputConnections(1) > 0 ? this->GetInputDataObject(1, 0) : nullptr;
  vtkDataObject* faces = this->GetInput();
  if (vtkPolyData::SafeDownCast(faces))
  {
    faces = FacesBeside(this->GetInputConnection(0, 0));
    if (!faces)
    {
      return { ErrorCode::InvalidTopology,
        "triangles are no faces of a CAD model: make faces of them with Analytic Model "
        "(vtkAnalyticModel, knotwork trim)" };
    }
  }
  std::vector<std::string> warnings;
  const auto model = DecodeFaces(faces, curves, this->SewTolerance, warnings);
  if (!model)
  {
    return model.Status;
  }
  for (const std::string& warning : warnings)
  {
    vtkWarningMacro("" << warning);
  }
  CADWriteParams params;
  params.Unit = static_cast<LengthUnit>(this->Unit);
  params.Schema = this->Schema == 1 ? STEPSchema::AP242 : STEPSchema::AP214;
  params.SewTolerance = this->SewTolerance;
  if (this->ProductName && this->ProductName[0] != '\0')
  {
    params.Name = this->ProductName;
  }
  return WriteCAD(model.Value, this->FileName, params);
}

void vtkCADWriter::WriteData()
{
  this->SetErrorCode(vtkErrorCode::NoError);
  Status status;
  try
  {
    status = this->WriteModel();
  }
  catch (...) // of a library below the kernel, out of memory
  {
    status = knotwork::StatusOfException();
  }
  if (!status)
  {
    this->SetErrorCode(knotwork::FilterErrorCode(status));
    vtkErrorMacro("" << status.Message());
  }
}
