// SPDX-License-Identifier: BSD-3-Clause
// A bent sheet becomes a trimmed face.
#include <vtkCellArray.h>
#include <vtkMeshParameterization.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTrimmedSurface.h>

int main()
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
  vtkNew<vtkPolyData> mesh;
  mesh->SetPoints(points);
  mesh->SetPolys(triangles);
  vtkNew<vtkMeshParameterization> flatten;
  flatten->SetInputDataObject(mesh);
  vtkNew<vtkTrimmedSurface> trim;
  trim->SetInputConnection(flatten->GetOutputPort());
  trim->Update();
  auto* surfaces = vtkDataSet::SafeDownCast(trim->GetOutputDataObject(1));
  return surfaces && surfaces->GetNumberOfCells() > 0 ? 0 : 1;
}
