// SPDX-License-Identifier: BSD-3-Clause
// usage: SplineIO FOLDER      a square goes to a STEP file and comes back
#include <knotwork/SplineGrid/vtkSplineSource.h>
#include <knotwork/SplineIO/vtkCADReader.h>
#include <knotwork/SplineIO/vtkCADWriter.h>
#include <vtkDataSet.h>
#include <vtkNew.h>

#include <string>

int main(int argc, char* argv[])
{
  if (argc != 2)
  {
    return 2;
  }
  const std::string file = argv[1] + std::string("/module.step");
  vtkNew<vtkSplineSource> square;
  vtkNew<vtkCADWriter> writer;
  writer->SetInputConnection(square->GetOutputPort());
  writer->SetFileName(file.c_str());
  writer->Write();
  vtkNew<vtkCADReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  auto* surfaces = vtkDataSet::SafeDownCast(reader->GetOutputDataObject(0));
  return surfaces && surfaces->GetNumberOfCells() == 1 ? 0 : 1;
}
