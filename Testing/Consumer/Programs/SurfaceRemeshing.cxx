// SPDX-License-Identifier: BSD-3-Clause
// The corners of a cube, three points each, become one each.
#include <knotwork/SurfaceRemeshing/vtkSurfaceRepair.h>
#include <vtkCubeSource.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

int main()
{
  vtkNew<vtkCubeSource> cube;
  vtkNew<vtkSurfaceRepair> repair;
  repair->SetInputConnection(cube->GetOutputPort());
  repair->Update();
  auto* surface = vtkPolyData::SafeDownCast(repair->GetOutputDataObject(0));
  return surface && surface->GetNumberOfPoints() == 8 ? 0 : 1;
}
