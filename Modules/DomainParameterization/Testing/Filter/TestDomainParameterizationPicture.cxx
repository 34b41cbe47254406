// SPDX-License-Identifier: BSD-3-Clause
#include "Rendering.h"
#include <knotwork/DomainParameterization/vtkDomainParameterization.h>
#include <knotwork/SplineGrid/vtkSplineRefine.h>
#include <knotwork/SplineGrid/vtkSplineTessellate.h>
#include <knotwork/SplineIO/vtkDomainBoundaryReader.h>

#include <vtkCellData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

#include <gtest/gtest.h>

#include <fstream>

// A square with a deep bite in its south side: the Coons map would fold, this one does not.
TEST(DomainParameterizationPicture, Bite_ImageOracle)
{
  const std::string file = std::string(KNOTWORK_OUTPUT_DIR) + "/domain_bite.json";
  const char* ends = R"("knots": [0, 0, 1, 1], "degree": 1, "control_points")";
  std::ofstream(file)
    << "{\"curves\": [{\"degree\": 3, \"knots\": [0, 0, 0, 0, 0.25, 0.5, 0.75, 1, "
       "1, 1, 1], \"control_points\": [[0, 0], [0.3, 0], [0.2, 0.7], [0.5, 1.1], "
       "[0.8, 0.7], [0.7, 0], [1, 0]]}, {"
    << ends << ": [[0, 1.2], [1, 1.2]]}, {" << ends << ": [[0, 0], [0, 1.2]]}, {" << ends
    << ": [[1, 0], [1, 1.2]]}]}";
  vtkNew<vtkDomainBoundaryReader> reader;
  reader->SetFileName(file.c_str());
  vtkNew<vtkDomainParameterization> domain;
  domain->SetInputConnection(reader->GetOutputPort());
  domain->Update();
  EXPECT_EQ(domain->GetVerdict(), 1);
  vtkNew<vtkSplineRefine> lines; // so that the picture shows more parameter lines
  lines->SetInputConnection(domain->GetOutputPort());
  vtkNew<vtkSplineTessellate> surface;
  surface->SetInputConnection(lines->GetOutputPort());
  surface->SetChordalTolerance(1e-3);
  surface->Update();
  auto* polygons = vtkPolyData::SafeDownCast(surface->GetOutputDataObject(0));
  vtkDataArray* elements = polygons->GetCellData()->GetArray("ElementId");
  ASSERT_TRUE(elements);
  vtkNew<vtkIntArray> colours;
  colours->SetName("Colour");
  for (vtkIdType i = 0; i < elements->GetNumberOfTuples(); ++i)
  {
    colours->InsertNextValue(static_cast<int>(elements->GetTuple1(i)) % 7);
  }
  polygons->GetCellData()->AddArray(colours);
  knotwork::RenderOptions options;
  options.ColorBy = "Colour";
  options.Edges = false;
  EXPECT_TRUE(knotwork::RenderAndCompare(polygons, "DomainParameterization", options));
}
