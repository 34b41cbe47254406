// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/MeshParameterization/TriangleMesh.h>

#include "vtkCellArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

namespace knotwork
{
inline vtkSmartPointer<vtkPolyData> Encode(const TriangleMesh& mesh)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (Eigen::Index i = 0; i < mesh.Points.rows(); ++i)
  {
    points->InsertNextPoint(mesh.Points.row(i).data());
  }
  vtkNew<vtkCellArray> cells;
  for (const auto& [a, b, c] : mesh.Triangles)
  {
    const vtkIdType corners[3] = { a, b, c };
    cells->InsertNextCell(3, corners);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(cells);
  return data;
}
}
