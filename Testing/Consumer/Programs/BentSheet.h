// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

/// Triangles of a sheet that is bent in one direction.
inline void MakeBentSheet(vtkPolyData* mesh)
{
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> triangles;
  constexpr int n = 6;
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i <= n; ++i)
    {
      const vtkIdType a = points->InsertNextPoint(i, j, 0.1 * i * i);
      if (i < n && j < n)
      {
        triangles->InsertNextCell({ a, a + 1, a + n + 2 });
        triangles->InsertNextCell({ a, a + n + 2, a + n + 1 });
      }
    }
  }
  mesh->SetPoints(points);
  mesh->SetPolys(triangles);
}
