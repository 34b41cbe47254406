// SPDX-License-Identifier: BSD-3-Clause
// A bent sheet is laid into the plane.
#include "BentSheet.h"

#include <knotwork/MeshParameterization/vtkMeshParameterization.h>
#include <vtkNew.h>
#include <vtkPointData.h>

int main()
{
  vtkNew<vtkPolyData> mesh;
  MakeBentSheet(mesh);
  vtkNew<vtkMeshParameterization> flatten;
  flatten->SetInputDataObject(mesh);
  flatten->Update();
  auto* flat = vtkPolyData::SafeDownCast(flatten->GetOutputDataObject(0));
  return flat && flat->GetPointData()->HasArray("UV") ? 0 : 1;
}
