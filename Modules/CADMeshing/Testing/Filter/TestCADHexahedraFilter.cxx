// SPDX-License-Identifier: BSD-3-Clause
// What is meshed how is tested with the kernel; here: what the filter gives out.
#include "FilterCases.h"
#include <knotwork/CADMeshing/vtkCADHexahedra.h>

#include "vtkCellData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVariant.h"

#include <string>

using namespace knotwork;

namespace
{
/// A square plate with a round hole.
const std::string Plate = std::string(KNOTWORK_DATA_DIR) + "/Hostile/sound.brep";

vtkTable* TableOf(vtkCADHexahedra* filter, int port)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(port));
}
}

TEST(vtkCADHexahedra, GivesHexahedraWithTheirEntitiesAndTables)
{
  vtkNew<vtkCADHexahedra> filter;
  filter->SetFileName(Plate.c_str());
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  auto* mesh = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  vtkTable* numbers = TableOf(filter, 1);
  ASSERT_GT(mesh->GetNumberOfCells(), 0);
  EXPECT_EQ(numbers->GetValueByName(0, "Hexahedra").ToInt(), mesh->GetNumberOfCells());
  EXPECT_EQ(numbers->GetValueByName(0, "Points").ToInt(), mesh->GetNumberOfPoints());
  EXPECT_EQ(numbers->GetValueByName(0, "Solids").ToInt(), 1);
  EXPECT_EQ(numbers->GetValueByName(0, "Verdict").ToString(), "valid");
  EXPECT_EQ(numbers->GetValueByName(0, "ValidCells").ToInt(), mesh->GetNumberOfCells());
  vtkTable* solids = TableOf(filter, 2);
  ASSERT_EQ(solids->GetNumberOfRows(), 1);
  const int layers = solids->GetValueByName(0, "Layers").ToInt();
  double range[2] = { 0.0, 0.0 };
  mesh->GetCellData()->GetArray("Layer")->GetRange(range);
  EXPECT_EQ(range[0], 0.0);
  EXPECT_EQ(range[1], layers - 1.0);
  EXPECT_EQ(mesh->GetCellData()->GetArray("SolidId")->GetTuple1(0), 0.0);
  EXPECT_EQ(mesh->GetCellData()->GetArray("Verdict")->GetTuple1(0), 1.0);
  EXPECT_GT(mesh->GetCellData()->GetArray("ScaledJacobian")->GetTuple1(0), 0.3);
  mesh->GetPointData()->GetArray("CADEntityDimension")->GetRange(range);
  EXPECT_EQ(range[0], 0.0);
  EXPECT_EQ(range[1], layers > 1 ? 3.0 : 2.0);
  EXPECT_FALSE(solids->GetValueByName(0, "SourceFaces").ToString().empty());
}

TEST(vtkCADHexahedra, ErrorsNameTheFileOrTheOption)
{
  vtkNew<vtkCADHexahedra> filter;
  ExpectFailure(filter, ErrorCode::EmptyInput, "there is no file name");
  filter->SetFileName("missing.step");
  ExpectFailure(filter, ErrorCode::FileError, "missing.step");
  filter->SetFileName(Plate.c_str());
  filter->SetMaximumHexahedra(3);
  ExpectFailure(filter, ErrorCode::TooLarge, "MaximumHexahedra");
}
