// SPDX-License-Identifier: BSD-3-Clause
// usage: filters OUTPUT.vtp      a spline source, refined, drawn as triangles
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSplineRefine.h>
#include <vtkSplineSource.h>
#include <vtkSplineTessellate.h>
#include <vtkXMLPolyDataWriter.h>

#include <iostream>

int main(int argc, char* argv[])
{
  if (argc != 2)
  {
    return 2;
  }
  vtkNew<vtkSplineSource> source;
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputConnection(source->GetOutputPort());
  vtkNew<vtkSplineTessellate> tessellate;
  tessellate->SetInputConnection(refine->GetOutputPort());
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputConnection(tessellate->GetOutputPort());
  writer->SetFileName(argv[1]);
  if (!writer->Write())
  {
    return 1;
  }
  const auto* mesh = vtkPolyData::SafeDownCast(tessellate->GetOutputDataObject(0));
  const vtkIdType cells = mesh ? const_cast<vtkPolyData*>(mesh)->GetNumberOfCells() : 0;
  std::cout << cells << " cells\n";
  return cells > 0 ? 0 : 1;
}
