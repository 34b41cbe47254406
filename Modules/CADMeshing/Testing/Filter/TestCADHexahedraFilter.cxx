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

#include <sstream>
#include <string>

using namespace knotwork;

namespace
{
const std::string Piston = std::string(KNOTWORK_DATA_DIR) + "/Parts/piston.step";
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

TEST(vtkCADHexahedra, CutsAreSaidAsOperationsOfTheModifier)
{
  vtkNew<vtkCADHexahedra> filter;
  filter->SetFileName(Piston.c_str());
  filter->SetEdgeLength(12.0);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  const std::string cuts = TableOf(filter, 1)->GetValueByName(0, "Cuts").ToString();
  std::istringstream stream(cuts);
  int number = 0;
  for (std::string line; std::getline(stream, line); ++number)
  {
    EXPECT_EQ(line.rfind("cut-", 0), 0u) << line;
  }
  EXPECT_EQ(number, 2);
  EXPECT_EQ(TableOf(filter, 1)->GetValueByName(0, "Solids").ToInt(), 4);
  filter->SetMaximumCuts(1);
  ExpectFailure(filter, ErrorCode::InvalidTopology, "solid 0 is neither mapped nor swept");
}

TEST(vtkCADHexahedra, SolidsThatTouchAndShareNothingAreSaid)
{
  vtkNew<vtkCADHexahedra> filter;
  vtkNew<MessageRecorder> messages;
  messages->Watch(filter);
  filter->SetFileName((std::string(KNOTWORK_DATA_DIR) + "/Parts/cylinder_on_cube.step").c_str());
  filter->Update();
  ASSERT_EQ(messages->Warnings.size(), 1U);
  EXPECT_NE(messages->Warnings[0].find("solids 0 and 1 touch in faces that they do not share"),
    std::string::npos)
    << messages->Warnings[0];
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
