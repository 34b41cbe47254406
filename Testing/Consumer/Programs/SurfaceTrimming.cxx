// SPDX-License-Identifier: BSD-3-Clause
// A bent sheet becomes a trimmed face.
#include "BentSheet.h"

#include <knotwork/MeshParameterization/vtkMeshParameterization.h>
#include <knotwork/SurfaceTrimming/vtkTrimmedSurface.h>
#include <vtkNew.h>

int main()
{
  vtkNew<vtkPolyData> mesh;
  MakeBentSheet(mesh);
  vtkNew<vtkMeshParameterization> flatten;
  flatten->SetInputDataObject(mesh);
  vtkNew<vtkTrimmedSurface> trim;
  trim->SetInputConnection(flatten->GetOutputPort());
  trim->Update();
  auto* surfaces = vtkDataSet::SafeDownCast(trim->GetOutputDataObject(1));
  return surfaces && surfaces->GetNumberOfCells() > 0 ? 0 : 1;
}
