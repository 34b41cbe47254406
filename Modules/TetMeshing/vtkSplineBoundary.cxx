// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineBoundary.h"

#include "BoundaryData.h"
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SplineGrid/TableRow.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

using namespace knotwork;

vtkStandardNewMacro(vtkSplineBoundary);

namespace
{
void EncodeTriangles(const BoundaryMesh& boundary, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (Eigen::Index i = 0; i < boundary.Mesh.Points.rows(); ++i)
  {
    points->InsertNextPoint(boundary.Mesh.Points.row(i).data());
  }
  vtkNew<vtkCellArray> cells;
  for (const auto& corners : boundary.Mesh.Triangles)
  {
    cells->InsertNextCell({ corners[0], corners[1], corners[2] });
  }
  output->SetPoints(points);
  output->SetPolys(cells);
  const auto itself = [](int id) { return id; };
  output->GetCellData()->AddArray(ArrayOf<vtkIntArray>("PatchId", boundary.Patches, itself));
  output->GetCellData()->AddArray(ArrayOf<vtkIntArray>("FaceId", boundary.Faces, itself));
}

void EncodeNumbers(const BoundaryMesh& boundary, vtkTable* table)
{
  AddColumn(table, "Closed", boundary.Closed ? 1 : 0);
  AddColumn(table, "Points", static_cast<int>(boundary.Mesh.Points.rows()));
  AddColumn(table, "Triangles", static_cast<int>(boundary.Mesh.Triangles.size()));
  AddColumn(table, "Area", boundary.Area);
  AddColumn(table, "Volume", boundary.Volume);
  AddColumn(table, "ChordalBound", boundary.Bound);
}
}

vtkSplineBoundary::vtkSplineBoundary()
{
  this->SetOutputTypes({ "vtkPolyData", "vtkTable" });
}

Status vtkSplineBoundary::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkDataObject* input = vtkDataObject::GetData(inputs[0], 0);
  const auto model = this->DecodeInput(input);
  if (!model)
  {
    return model.Status;
  }
  if (model->Patches.empty())
  {
    return {};
  }
  BoundaryOptions options;
  options.Tolerance = this->ChordalTolerance;
  options.Relative = this->RelativeTolerance;
  options.Threads = this->KernelThreads();
  options.Progress = this->Progress();
  const auto boundary = TriangulateBoundary(input, model.Value, options);
  if (!boundary)
  {
    return boundary.Status;
  }
  EncodeTriangles(boundary.Value, vtkPolyData::GetData(outputs, 0));
  EncodeNumbers(boundary.Value, vtkTable::GetData(outputs, 1));
  return {};
}
