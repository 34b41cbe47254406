// SPDX-License-Identifier: BSD-3-Clause
// A filter without a file does nothing yet.
#include <knotwork/CADMeshing/vtkCADHexahedra.h>
#include <knotwork/CADMeshing/vtkCADQuads.h>
#include <vtkNew.h>

int main()
{
  vtkNew<vtkCADHexahedra> hexahedra;
  vtkNew<vtkCADQuads> quads;
  quads->SetMethod(vtkCADQuads::MAPPED);
  return quads->GetNumberOfOutputPorts() == 3 && hexahedra->GetNumberOfOutputPorts() == 3 &&
      quads->GetMethod() == vtkCADQuads::MAPPED
    ? 0
    : 1;
}
