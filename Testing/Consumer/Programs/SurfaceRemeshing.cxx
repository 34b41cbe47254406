// SPDX-License-Identifier: BSD-3-Clause
// A bent sheet is no solid: its triangles stay, and it is said to be open.
#include "BentSheet.h"

#include <knotwork/SurfaceRemeshing/vtkSurfaceRepair.h>
#include <vtkNew.h>

int main()
{
  vtkNew<vtkPolyData> mesh;
  MakeBentSheet(mesh);
  vtkNew<vtkSurfaceRepair> repair;
  repair->AllowOpenOn();
  repair->SetInputDataObject(mesh);
  repair->Update();
  auto* surface = vtkPolyData::SafeDownCast(repair->GetOutputDataObject(0));
  return surface && surface->GetNumberOfPolys() == mesh->GetNumberOfPolys() ? 0 : 1;
}
