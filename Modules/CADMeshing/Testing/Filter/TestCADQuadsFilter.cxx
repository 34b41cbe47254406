// SPDX-License-Identifier: BSD-3-Clause
// What is meshed how is tested with the kernel; here: what the filter gives out.
#include "FilterCases.h"
#include <knotwork/CADMeshing/vtkCADQuads.h>

#include "vtkCellData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <string>

using namespace knotwork;

namespace
{
/// One rectangular face.
const std::string Face = std::string(KNOTWORK_DATA_DIR) + "/Hostile/sound.step";

vtkTable* TableOf(vtkCADQuads* filter, int port)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(port));
}
}

TEST(vtkCADQuads, GivesQuadsWithTheirEntitiesAndTables)
{
  vtkNew<vtkCADQuads> filter;
  filter->SetFileName(Face.c_str());
  filter->SetMinimumDivisions(4);
  filter->SetEdgeLength(1e6);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  auto* mesh = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_EQ(mesh->GetNumberOfPolys(), 16);
  ASSERT_EQ(mesh->GetNumberOfPoints(), 25);
  int counts[3] = { 0, 0, 0 };
  for (vtkIdType p = 0; p < 25; ++p)
  {
    ++counts[static_cast<int>(mesh->GetPointData()->GetArray("CADEntityDimension")->GetTuple1(p))];
  }
  EXPECT_EQ(counts[0], 4);
  EXPECT_EQ(counts[1], 12);
  EXPECT_EQ(counts[2], 9);
  EXPECT_EQ(mesh->GetCellData()->GetArray("CADFaceId")->GetTuple1(3), 0);
  EXPECT_EQ(mesh->GetCellData()->GetArray("SecondSolidId")->GetTuple1(3), -1);
  EXPECT_GT(mesh->GetCellData()->GetArray("ScaledJacobian")->GetTuple1(3), 0.9);
  vtkTable* numbers = TableOf(filter, 1);
  EXPECT_EQ(numbers->GetValueByName(0, "Quads").ToInt(), 16);
  EXPECT_EQ(numbers->GetValueByName(0, "MappedFaces").ToInt(), 1);
  EXPECT_EQ(numbers->GetValueByName(0, "EulerNumber").ToInt(), 1);
  EXPECT_EQ(numbers->GetValueByName(0, "Closed").ToInt(), 0);
  ASSERT_EQ(TableOf(filter, 2)->GetNumberOfRows(), 1);
  EXPECT_EQ(TableOf(filter, 2)->GetValueByName(0, "Quads").ToInt(), 16);
  filter->SetMethod(vtkCADQuads::UNSTRUCTURED);
  filter->Update();
  EXPECT_EQ(TableOf(filter, 1)->GetValueByName(0, "UnstructuredFaces").ToInt(), 1);
}

TEST(vtkCADQuads, SolidsThatTouchAndShareNothingAreSaid)
{
  vtkNew<vtkCADQuads> filter;
  vtkNew<MessageRecorder> messages;
  messages->Watch(filter);
  filter->SetFileName((std::string(KNOTWORK_DATA_DIR) + "/Parts/cylinder_on_cube.step").c_str());
  filter->Update();
  ASSERT_EQ(messages->Warnings.size(), 1U);
  EXPECT_NE(messages->Warnings[0].find("solids 0 and 1 touch in faces that they do not share"),
    std::string::npos)
    << messages->Warnings[0];
}

TEST(vtkCADQuads, ErrorsNameTheFileOrTheOption)
{
  vtkNew<vtkCADQuads> filter;
  ExpectFailure(filter, ErrorCode::EmptyInput, "there is no file name");
  filter->SetFileName("missing.step");
  ExpectFailure(filter, ErrorCode::FileError, "missing.step");
  filter->SetFileName(Face.c_str());
  filter->SetMaximumQuads(3);
  ExpectFailure(filter, ErrorCode::TooLarge, "MaximumQuads");
}
