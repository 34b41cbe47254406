// SPDX-License-Identifier: BSD-3-Clause
// A surface through the points of a bent sheet.
#include <knotwork/SurfaceFitting/vtkSplineSurfaceFit.h>
#include <vtkDataSet.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

int main()
{
  vtkNew<vtkPoints> points;
  constexpr int n = 20;
  for (int i = 0; i < n * n; ++i)
  {
    const double x = i % n;
    const double y = i / n;
    points->InsertNextPoint(x, y, 0.01 * x * y * y);
  }
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(points);
  vtkNew<vtkSplineSurfaceFit> fit;
  fit->SetInputDataObject(cloud);
  fit->Update();
  auto* surface = vtkDataSet::SafeDownCast(fit->GetOutputDataObject(0));
  return surface && surface->GetNumberOfCells() > 0 ? 0 : 1;
}
