// SPDX-License-Identifier: BSD-3-Clause
// usage: refine_and_tessellate OUTPUT.vtp
// An exact disc of five rational patches, refined around a point of its rim, as polygons that
// deviate from it by no more than 1e-3 of its size.
#include <knotwork/SplineGrid/vtkSplineRefine.h>
#include <knotwork/SplineGrid/vtkSplineSource.h>
#include <knotwork/SplineGrid/vtkSplineTessellate.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSphere.h>
#include <vtkXMLPolyDataWriter.h>

#include <cstdlib>
#include <iostream>

int main(int argc, char* argv[])
{
  if (argc != 2)
  {
    std::cerr << "usage: refine_and_tessellate OUTPUT.vtp\n";
    return 2;
  }

  vtkNew<vtkSplineSource> disc;
  disc->SetShape(vtkSplineSource::DISC);
  disc->SetElements(2, 2, 1);

  vtkNew<vtkSphere> where;
  where->SetCenter(0.75, 0.66, 0.0);
  where->SetRadius(0.15);
  vtkNew<vtkSplineRefine> refine; // the map stays what it is
  refine->SetInputConnection(disc->GetOutputPort());
  refine->SetMode(vtkSplineRefine::IMPLICIT_FUNCTION);
  refine->SetImplicitFunction(where);
  refine->SetNumberOfRefinements(3);

  vtkNew<vtkSplineTessellate> tessellate;
  tessellate->SetInputConnection(refine->GetOutputPort());
  tessellate->SetChordalTolerance(1e-3);

  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputConnection(tessellate->GetOutputPort());
  writer->SetFileName(argv[1]);
  writer->SetDataModeToBinary(); // which every ParaView reads
  if (!writer->Write() || tessellate->GetErrorCode() != 0)
  {
    return EXIT_FAILURE; // VTK has said why
  }

  auto* mesh = vtkPolyData::SafeDownCast(tessellate->GetOutputDataObject(0));
  auto* bound = vtkDoubleArray::SafeDownCast(mesh->GetFieldData()->GetArray("ChordalBound"));
  std::cout << mesh->GetNumberOfCells() << " cells, nowhere farther from the disc than "
            << bound->GetValue(0) << "\n";
  return EXIT_SUCCESS;
}
