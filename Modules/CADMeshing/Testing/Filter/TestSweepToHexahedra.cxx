// SPDX-License-Identifier: BSD-3-Clause
// How points move is tested with the kernel; here: what the filter takes and gives out.
#include "FilterCases.h"
#include <knotwork/CADMeshing/vtkSweepToHexahedra.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVariant.h"

#include <cmath>

using namespace knotwork;

namespace
{
/// Two unit squares beside each other in z = 0, with a number each.
vtkSmartPointer<vtkPolyData> TwoSquares()
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int j = 0; j < 2; ++j)
  {
    for (int i = 0; i < 3; ++i)
    {
      points->InsertNextPoint(i, j, 0.0);
    }
  }
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell({ 0, 1, 4, 3 });
  cells->InsertNextCell({ 1, 2, 5, 4 });
  vtkNew<vtkIntArray> materials;
  materials->SetName("Material");
  materials->InsertNextValue(7);
  materials->InsertNextValue(8);
  const auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(points);
  mesh->SetPolys(cells);
  mesh->GetCellData()->AddArray(materials);
  return mesh;
}

vtkSmartPointer<vtkPolyData> Line(const std::vector<std::array<double, 3>>& places)
{
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell(static_cast<int>(places.size()));
  for (const auto& place : places)
  {
    lines->InsertCellPoint(points->InsertNextPoint(place.data()));
  }
  const auto line = vtkSmartPointer<vtkPolyData>::New();
  line->SetPoints(points);
  line->SetLines(lines);
  return line;
}

vtkUnstructuredGrid* Mesh(vtkSweepToHexahedra* filter)
{
  return vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
}

double Number(vtkSweepToHexahedra* filter, const char* name)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(1))->GetValueByName(0, name).ToDouble();
}
}

TEST(vtkSweepToHexahedra, CellsHaveTheDataOfTheirSource)
{
  vtkNew<vtkSweepToHexahedra> filter;
  filter->SetInputDataObject(TwoSquares());
  filter->SetDirection(0.0, 0.0, 3.0);
  filter->SetLayers(4);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  vtkUnstructuredGrid* mesh = Mesh(filter);
  ASSERT_EQ(mesh->GetNumberOfCells(), 8);
  EXPECT_EQ(mesh->GetNumberOfPoints(), 30);
  for (vtkIdType c = 0; c < 8; ++c)
  {
    EXPECT_EQ(mesh->GetCellType(c), VTK_HEXAHEDRON);
    const auto value = [&](const char* name)
    { return mesh->GetCellData()->GetArray(name)->GetComponent(c, 0); };
    EXPECT_EQ(value("Material"), 7 + c % 2);
    EXPECT_EQ(value("SourceCellId"), c % 2);
    EXPECT_EQ(value("Layer"), c / 2);
    EXPECT_EQ(value("Verdict"), 1);
    EXPECT_NEAR(value("ScaledJacobian"), 1.0, 1e-12);
  }
  EXPECT_EQ(mesh->GetPointData()->GetArray("SourcePointId")->GetComponent(29, 0), 5);
  EXPECT_EQ(mesh->GetPointData()->GetArray("PointLayer")->GetComponent(29, 0), 4);
  EXPECT_NEAR(Number(filter, "Volume"), 6.0, 1e-12);
  EXPECT_NEAR(Number(filter, "MinJacobianLower"), 0.75, 1e-12);
  EXPECT_EQ(Number(filter, "ValidCells"), 8);
}

TEST(vtkSweepToHexahedra, APathThatTurnsTooSharplyIsNotValid)
{
  // two wide squares around a corner about a point in their middle: they fold inside of the turn
  vtkNew<vtkSweepToHexahedra> filter;
  filter->SetInputDataObject(TwoSquares());
  std::vector<std::array<double, 3>> arc;
  for (int k = 0; k <= 16; ++k)
  {
    const double angle = M_PI * k / 16.0;
    arc.push_back({ 0.5 + 0.5 * std::cos(angle), 0.5, 0.5 * std::sin(angle) });
  }
  filter->SetPathData(Line(arc));
  vtkNew<MessageRecorder> messages;
  messages->Watch(filter);
  filter->Update();
  ASSERT_EQ(messages->Warnings.size(), 1u);
  EXPECT_NE(
    messages->Warnings[0].find("of 16 hexahedra are folded, the first is cell"), std::string::npos)
    << messages->Warnings[0];
  EXPECT_EQ(
    Number(filter, "ValidCells") + Number(filter, "ReversedCells") + Number(filter, "InvalidCells"),
    16);
  EXPECT_GT(Number(filter, "ReversedCells") + Number(filter, "InvalidCells"), 0);

  for (auto& place : arc) // the same turn, wide enough
  {
    place[0] -= 4.0 * (0.5 - place[0]) + 4.0;
    place[2] *= 5.0;
  }
  filter->SetPathData(Line(arc));
  filter->Update();
  EXPECT_EQ(Number(filter, "ValidCells"), 16);
}

TEST(vtkSweepToHexahedra, WrongInputIsOneError)
{
  vtkNew<vtkSweepToHexahedra> filter;
  filter->SetInputDataObject(TwoSquares());
  filter->SetDirection(0.0, 0.0, 0.0);
  ExpectFailure(filter, ErrorCode::InvalidTopology, "the path has no length");
  filter->SetDirection(0.0, 0.0, std::nan(""));
  ExpectFailure(filter, ErrorCode::NonFiniteInput, "the path, Twist or Scale is not finite");
  filter->SetDirection(0.0, 0.0, 1.0);
  filter->SetPathData(TwoSquares());
  ExpectFailure(filter, ErrorCode::InvalidTopology, "0 lines and 2 other cells");
  filter->SetPathData(Line({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 0, 1 }, { 0, 0, 0 } }));
  filter->SetScale(2.0);
  ExpectFailure(filter, ErrorCode::InvalidParameter, "a multiple of 360 degrees");
  filter->SetPathData(nullptr);
  vtkNew<vtkSweepToHexahedra> first;
  first->SetInputDataObject(TwoSquares());
  filter->SetInputConnection(first->GetOutputPort());
  ExpectFailure(filter, ErrorCode::InvalidTopology, "the source (input 0) has hexahedra");
}
