// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDeviationMap.h"

#include "ScanData.h"
#include <knotwork/CADFitting/DeviationMap.h>
#include <knotwork/SplineGrid/TableRow.h>

#include "vtkCellArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>

using namespace knotwork;

vtkStandardNewMacro(vtkDeviationMap);

namespace
{
void EncodeModel(const DeviationMap& map, vtkPolyData* output)
{
  const vtkIdType count = map.Model.Points.rows();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(count);
  const auto distance = NamedArray<vtkDoubleArray>("Distance", 1, count);
  const auto foot = NamedArray<vtkDoubleArray>("ScanPoint", 3, count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    points->SetPoint(i, map.Model.Points.row(i).data());
    distance->SetValue(i, map.OfModel[i]);
    foot->SetTuple(i, map.ScanPoints.row(i).data());
  }
  vtkNew<vtkCellArray> cells;
  for (const auto& triangle : map.Model.Triangles)
  {
    cells->InsertNextCell({ triangle[0], triangle[1], triangle[2] });
  }
  output->SetPoints(points);
  output->SetPolys(cells);
  output->GetPointData()->AddArray(distance);
  output->GetPointData()->AddArray(foot);
  output->GetPointData()->SetActiveScalars("Distance");
}

void EncodePercentiles(const DeviationMap& map, vtkTable* table)
{
  const auto add = [table](const char* name, const auto& values)
  {
    const auto column = NamedArray<vtkDoubleArray>(name);
    for (const double value : values)
    {
      column->InsertNextValue(value);
    }
    table->AddColumn(column);
  };
  add("Percent", PercentileLevels);
  add("ScanToModel", map.ScanProfile.Percentiles);
  add("ModelToScan", map.ModelProfile.Percentiles);
}
}

vtkDeviationMap::vtkDeviationMap()
{
  this->SetInputTypes({ { { "vtkPointSet" } }, Shapes() });
  this->SetOutputTypes({ "vtkPointSet", "vtkPolyData", "vtkTable", "vtkTable" });
}

void vtkDeviationMap::SetModelConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkDeviationMap::SetModelData(vtkDataObject* model)
{
  this->SetInputDataObject(1, model);
}

int vtkDeviationMap::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  MakeOutputLike(outputs, 0, vtkDataObject::GetData(inputs[0], 0));
  return this->MakeDeclaredOutputs(outputs);
}

Status vtkDeviationMap::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPointSet* input = vtkPointSet::GetData(inputs[0], 0);
  vtkPointSet* output = vtkPointSet::GetData(outputs, 0);
  if (input->GetNumberOfPoints() == 0)
  {
    output->ShallowCopy(input);
    return {};
  }
  const auto part = [progress = this->Progress()](double begin, double end) -> ProgressCallback
  { return [=](double share) { return progress(begin + share * (end - begin)); }; };
  TriangleMesh triangles;
  FitTargetOptions options;
  options.Triangles = &triangles;
  options.Progress = part(0.0, 0.2);
  const auto decoded = DecodeScanAndTarget(inputs, "model", options, this->KernelThreads());
  if (!decoded)
  {
    return decoded.Status;
  }
  DeviationMapParams params;
  params.Samples = this->Samples;
  params.MaximumDistance = this->MaximumDistance;
  params.Threads = this->KernelThreads();
  params.Progress = part(0.2, 1.0);
  const auto map = MapDeviation(decoded->Scan, *decoded->Target, std::move(triangles), params);
  if (!map)
  {
    return map.Status;
  }
  output->ShallowCopy(input);
  EncodeDistances(map->OfScan, output);
  EncodeModel(map.Value, vtkPolyData::GetData(outputs, 1));
  EncodePercentiles(map.Value, vtkTable::GetData(outputs, 2));
  vtkTable* numbers = vtkTable::GetData(outputs, 3);
  AddProfile(numbers, "Scan", map->ScanProfile);
  AddProfile(numbers, "Model", map->ModelProfile);
  AddColumn(numbers, "PointsWithout", map->NumWithout);
  AddColumn(numbers, "Signed", decoded->Target->IsClosed() ? 1 : 0);
  return {};
}
