// SPDX-License-Identifier: BSD-3-Clause
// A spline source, refined, drawn as triangles.
#include <knotwork/SplineGrid/vtkSplineRefine.h>
#include <knotwork/SplineGrid/vtkSplineSource.h>
#include <knotwork/SplineGrid/vtkSplineTessellate.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

#include <iostream>

int main()
{
  vtkNew<vtkSplineSource> source;
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputConnection(source->GetOutputPort());
  vtkNew<vtkSplineTessellate> tessellate;
  tessellate->SetInputConnection(refine->GetOutputPort());
  tessellate->Update();
  auto* mesh = vtkPolyData::SafeDownCast(tessellate->GetOutputDataObject(0));
  const vtkIdType cells = mesh ? mesh->GetNumberOfCells() : 0;
  std::cout << cells << " cells\n";
  return cells > 0 ? 0 : 1;
}
