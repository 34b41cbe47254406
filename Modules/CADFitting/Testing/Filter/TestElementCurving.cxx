// SPDX-License-Identifier: BSD-3-Clause
// Elements are tested in the kernel; here: what the filter takes and gives out.
#include "FilterCases.h"
#include <knotwork/CADFitting/vtkElementCurving.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkGenericCell.h"
#include "vtkIntArray.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVariant.h"

#include <cmath>
#include <limits>

using namespace knotwork;

namespace
{
double Number(vtkAlgorithm* filter, const char* name)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(1))->GetValueByName(0, name).ToDouble();
}

/// A cube on the unit sphere, of one hexahedron or of its six sides, with its vertices as cells.
vtkSmartPointer<vtkUnstructuredGrid> Cube(bool isSolid)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  const double a = 1.0 / std::sqrt(3.0);
  for (int i = 0; i < 8; ++i)
  {
    points->InsertNextPoint(i & 1 ? a : -a, i & 2 ? a : -a, i & 4 ? a : -a);
  }
  points->InsertNextPoint(9.0, 9.0, 9.0); // of no cell
  grid->SetPoints(points);
  const vtkIdType vertex[] = { 3 };
  grid->InsertNextCell(VTK_VERTEX, 1, vertex);
  const vtkIdType solid[] = { 0, 1, 3, 2, 4, 5, 7, 6 };
  const vtkIdType sides[6][4] = { { 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 },
    { 0, 4, 6, 2 }, { 1, 3, 7, 5 } };
  if (isSolid)
  {
    grid->InsertNextCell(VTK_HEXAHEDRON, 8, solid);
  }
  for (const auto& side : sides)
  {
    grid->InsertNextCell(VTK_QUAD, 4, side);
  }
  vtkNew<vtkIntArray> numbers;
  numbers->SetName("Number");
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    numbers->InsertNextValue(static_cast<int>(10 * c));
  }
  grid->GetCellData()->AddArray(numbers);
  return grid;
}

vtkSmartPointer<vtkDataObject> Sphere()
{
  return ShapeGrid(vtkSplineSource::SPHERE_SURFACE);
}

void Set(vtkElementCurving* filter, vtkDataObject* mesh, vtkDataObject* target)
{
  filter->SetInputDataObject(mesh);
  filter->SetTargetData(target);
}
}

/// Middles of VTK's own cells lie on the sphere but for the elements' order.
TEST(vtkElementCurving, CellsOfVTK_ExactOracle)
{
  vtkNew<vtkElementCurving> filter;
  Set(filter, Cube(false), Sphere());
  const double allowed[] = { 0.2, 0.1, 0.01 };
  for (int order = 2; order <= 4; ++order)
  {
    filter->SetOrder(order);
    for (const int basis : { vtkElementCurving::LAGRANGE, vtkElementCurving::BEZIER })
    {
      filter->SetBasis(basis);
      filter->Update();
      ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
      auto* const grid = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
      ASSERT_EQ(grid->GetNumberOfCells(), 6);
      EXPECT_EQ(Number(filter, "CellsLeftOut"), 1);
      EXPECT_EQ(Number(filter, "CertifiedElements"), 6);
      EXPECT_EQ(grid->GetNumberOfPoints(), 8 + 12 * (order - 1) + 6 * (order - 1) * (order - 1));
      EXPECT_EQ(grid->GetCellType(0),
        basis == vtkElementCurving::BEZIER ? VTK_BEZIER_QUADRILATERAL : VTK_LAGRANGE_QUADRILATERAL);
      EXPECT_EQ(grid->GetCellData()->GetArray("Number")->GetTuple1(0), 10.0);
      vtkNew<vtkGenericCell> cell;
      for (vtkIdType c = 0; c < 6; ++c)
      {
        grid->GetCell(c, cell);
        double at[] = { 0.31, 0.47, 0.0 };
        double x[3];
        double weights[125];
        int sub = 0;
        cell->EvaluateLocation(sub, at, x, weights);
        EXPECT_NEAR(std::hypot(x[0], x[1], x[2]), 1.0, allowed[order - 2]);
      }
    }
  }
}

TEST(vtkElementCurving, CellsOfFewerDimensionsAreLeftOut_ExactOracle)
{
  vtkNew<vtkElementCurving> filter;
  Set(filter, Cube(true), Sphere());
  filter->Update();
  EXPECT_EQ(Number(filter, "Elements"), 1);
  EXPECT_EQ(Number(filter, "CellsLeftOut"), 7);
  EXPECT_GT(Number(filter, "Volume"), 8.0 / std::sqrt(27.0));
  auto* const grid = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_EQ(grid->GetCellType(0), VTK_LAGRANGE_HEXAHEDRON);
  EXPECT_EQ(grid->GetNumberOfPoints(), 27);
}

TEST(vtkElementCurving, Errors)
{
  vtkNew<vtkElementCurving> filter;
  vtkNew<vtkUnstructuredGrid> empty;
  Set(filter, empty, Sphere());
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  Set(filter, Cube(true), empty);
  ExpectFailure(filter, ErrorCode::EmptyInput, "target: ");
  auto mesh = Cube(false);
  const vtkIdType pyramid[] = { 0, 1, 3, 2, 7 };
  mesh->InsertNextCell(VTK_PYRAMID, 5, pyramid);
  Set(filter, mesh, Sphere());
  ExpectFailure(filter, ErrorCode::InvalidTopology, "cell 7 is a vtkPyramid of 5 points");
  vtkNew<vtkUnstructuredGrid> lines;
  lines->SetPoints(mesh->GetPoints());
  lines->InsertNextCell(VTK_LINE, 2, pyramid);
  Set(filter, lines, Sphere());
  ExpectFailure(filter, ErrorCode::EmptyInput, "no triangles");
  mesh = Cube(true);
  mesh->GetPoints()->SetPoint(2, 0.0, std::numeric_limits<double>::infinity(), 0.0);
  Set(filter, mesh, Sphere());
  ExpectFailure(filter, ErrorCode::NonFiniteInput, "point 2");
  mesh = Cube(true);
  mesh->GetPoints()->SetPoint(0, 1.0, 1.0, 1.0);
  Set(filter, mesh, Sphere());
  ExpectFailure(filter, ErrorCode::NotConverged, "element 1 at");
  Set(filter, Cube(true), Sphere());
  filter->SetFeatureArray("Nothing");
  ExpectFailure(filter, ErrorCode::InvalidParameter, "no cell array 'Nothing'");
  filter->SetFeatureArray(nullptr);
  filter->SetFaceGroups("0,99");
  ExpectFailure(filter, ErrorCode::InvalidParameter, "no number of a face");
}

TEST(vtkElementCurving, ProgressAndAbort)
{
  vtkNew<vtkElementCurving> filter;
  Set(filter, Cube(true), Sphere());
  ExpectProgressAndAbort(filter, 2);
}
