// SPDX-License-Identifier: BSD-3-Clause
// A square goes onto a plane.
#include <knotwork/CADFitting/vtkCADFit.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

int main()
{
  vtkNew<vtkPoints> points;
  for (const double y : { 0.0, 1.0 })
  {
    for (const double x : { 0.0, 1.0 })
    {
      points->InsertNextPoint(x, y, 0.1 * x);
    }
  }
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell({ 0, 1, 3, 2 });
  vtkNew<vtkPolyData> mesh;
  mesh->SetPoints(points);
  mesh->SetPolys(cells);
  vtkNew<vtkPlane> plane;
  vtkNew<vtkCADFit> fit;
  fit->SetInputDataObject(mesh);
  fit->SetTargetType(vtkCADFit::IMPLICIT_FUNCTION);
  fit->SetImplicitFunction(plane);
  fit->Update();
  auto* const spline = vtkUnstructuredGrid::SafeDownCast(fit->GetOutputDataObject(0));
  const double* const bounds = spline->GetBounds();
  return spline->GetNumberOfCells() == 1 && bounds[4] == 0.0 && bounds[5] < 1e-12 ? 0 : 1;
}
