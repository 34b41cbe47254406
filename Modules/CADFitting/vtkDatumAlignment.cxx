// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDatumAlignment.h"

#include "FitTargetData.h"
#include "ScanData.h"
#include <knotwork/CADFitting/DatumAlignment.h>
#include <knotwork/MeshParameterization/MeshData.h>
#include <knotwork/SplineGrid/TableRow.h>

#include "vtkCellData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointSet.h"

#include <limits>

using namespace knotwork;

vtkStandardNewMacro(vtkDatumAlignment);

namespace
{
/// Numbers that the input brings are those that are found.
Status CheckRegionIds(
  vtkPointSet* input, const DecodedMesh& decoded, const std::vector<int>& regionOfTriangle)
{
  vtkDataArray* const ids = input->GetCellData()->GetArray("RegionId");
  for (std::size_t t = 0; ids && t < regionOfTriangle.size(); ++t)
  {
    const double given = ids->GetComponent(decoded.Cells[t], 0);
    if (regionOfTriangle[t] >= 0 && given != regionOfTriangle[t])
    {
      return { ErrorCode::InvalidParameter,
        "cell " + std::to_string(decoded.Cells[t]) + " has RegionId " +
          std::to_string(static_cast<int>(given)) + ", but region " +
          std::to_string(regionOfTriangle[t]) +
          " is found: give the tolerance and sag that the array was made with, or leave it out" };
    }
  }
  return {};
}
}

vtkDatumAlignment::vtkDatumAlignment()
{
  this->SetInputTypes({ Meshes() });
  this->SetOutputTypes({ "vtkPointSet", "vtkTable" });
}

vtkDatumAlignment::~vtkDatumAlignment()
{
  this->SetDatumPoint(nullptr);
}

int vtkDatumAlignment::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  MakeOutputLike(outputs, 0, vtkDataObject::GetData(inputs[0], 0));
  return this->MakeDeclaredOutputs(outputs);
}

Status vtkDatumAlignment::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPointSet* input = vtkPointSet::GetData(inputs[0], 0);
  auto point =
    ParseNumbers(this->DatumPoint ? this->DatumPoint : "", std::numeric_limits<int>::max(),
      "in the datum point is no number of a region: give some as 0,3,5");
  if (!point)
  {
    return point.Status;
  }
  const auto decoded = DecodeMesh(input);
  if (!decoded)
  {
    return decoded.Status;
  }
  RecognitionParams recognition;
  recognition.Tolerance = this->Tolerance;
  recognition.MaximumSag = this->MaximumSag;
  recognition.Progress = this->Progress();
  const auto found = RecognizeSurfaces(decoded->Mesh, recognition);
  if (!found)
  {
    return found.Status;
  }
  if (Status same = CheckRegionIds(input, decoded.Value, found->RegionOfTriangle); !same)
  {
    return same;
  }
  DatumParams params;
  params.Plane = this->DatumPlane;
  params.Axis = this->DatumAxis;
  params.Point = std::move(point.Value);
  params.Inward = this->Inward;
  const auto datums = AlignToDatums(decoded->Mesh, found->Regions, params);
  if (!datums)
  {
    return datums.Status;
  }
  EncodeMoved(input, datums->Motion, vtkPointSet::GetData(outputs, 0));
  vtkTable* numbers = vtkTable::GetData(outputs, 1);
  AddColumn(numbers, "Regions", static_cast<int>(found->Regions.size()));
  AddColumn(numbers, "FreeMotions", datums->FreeMotions);
  AddTuple(numbers, "Motion", datums->Motion.Matrix());
  return {};
}
