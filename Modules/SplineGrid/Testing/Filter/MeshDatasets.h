// SPDX-License-Identifier: BSD-3-Clause
// Meshes of quadrilaterals and hexahedra as datasets.
#pragma once
#include "MeshCases.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

namespace knotwork
{
inline vtkSmartPointer<vtkPoints> MakePoints(const PointMatrix& points)
{
  auto made = vtkSmartPointer<vtkPoints>::New();
  made->SetDataTypeToDouble();
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    made->InsertNextPoint(points.row(i).data());
  }
  return made;
}

inline vtkSmartPointer<vtkPolyData> MakePolyData(const CellMesh<2>& mesh, const PointMatrix& points)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(MakePoints(points));
  vtkNew<vtkCellArray> cells;
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    const int* corners = mesh.Cell(c);
    cells->InsertNextCell({ corners[0], corners[1], corners[3], corners[2] });
  }
  data->SetPolys(cells);
  return data;
}

/// @param type  VTK_HEXAHEDRON or VTK_VOXEL.
inline vtkSmartPointer<vtkUnstructuredGrid> MakeGrid(
  const CellMesh<3>& mesh, const PointMatrix& points, int type)
{
  auto data = vtkSmartPointer<vtkUnstructuredGrid>::New();
  data->SetPoints(MakePoints(points));
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    const int* k = mesh.Cell(c);
    vtkIdType ids[8] = { k[0], k[1], k[2], k[3], k[4], k[5], k[6], k[7] };
    if (type == VTK_HEXAHEDRON)
    {
      std::swap(ids[2], ids[3]);
      std::swap(ids[6], ids[7]);
    }
    data->InsertNextCell(type, 8, ids);
  }
  return data;
}

inline PointMatrix GridPoints(const std::array<int, 3>& n)
{
  PointMatrix points((n[0] + 1) * (n[1] + 1) * (n[2] + 1), 3);
  for (int i = 0; i < points.rows(); ++i)
  {
    points.row(i) << i % (n[0] + 1), i / (n[0] + 1) % (n[1] + 1), i / (n[0] + 1) / (n[1] + 1);
  }
  return points;
}

inline vtkSmartPointer<vtkPolyData> Sphere(int n)
{
  const CellMesh<2> mesh = meshes::CubeSphere(n);
  return MakePolyData(mesh, meshes::CubeSpherePoints(mesh, n));
}

inline void AddCellNumbers(vtkDataSet* data)
{
  vtkNew<vtkIntArray> numbers;
  numbers->SetName("Number");
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    numbers->InsertNextValue(static_cast<int>(100 + c));
  }
  data->GetCellData()->AddArray(numbers);
}
}
