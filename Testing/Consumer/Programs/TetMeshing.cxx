// SPDX-License-Identifier: BSD-3-Clause
// A bent sheet bounds no solid: there is one error, and no cells.
#include "BentSheet.h"

#include <knotwork/TetMeshing/vtkTetGenMesher.h>
#include <vtkCallbackCommand.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>

int main()
{
  vtkNew<vtkPolyData> mesh;
  MakeBentSheet(mesh);
  int errors = 0;
  vtkNew<vtkCallbackCommand> count;
  count->SetClientData(&errors);
  count->SetCallback(
    [](vtkObject*, unsigned long, void* number, void*) { ++*static_cast<int*>(number); });
  vtkNew<vtkTetGenMesher> mesher;
  mesher->AddObserver(vtkCommand::ErrorEvent, count);
  mesher->SetInputDataObject(mesh);
  mesher->Update();
  auto* cells = vtkUnstructuredGrid::SafeDownCast(mesher->GetOutputDataObject(0));
  return errors == 1 && cells && cells->GetNumberOfCells() == 0 ? 0 : 1;
}
