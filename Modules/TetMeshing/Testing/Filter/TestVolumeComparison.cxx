// SPDX-License-Identifier: BSD-3-Clause
// A cube and a ball of known volumes and distances, as splines and as meshes.
#include "FilterCases.h"
#include <knotwork/TetMeshing/vtkSplineBoundary.h>
#include <knotwork/TetMeshing/vtkTetGenMesher.h>
#include <knotwork/TetMeshing/vtkVolumeComparison.h>

#include "vtkCellType.h"
#include "vtkDataArray.h"
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
double Number(vtkVolumeComparison* filter, int row, const char* name)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(3))
    ->GetValueByName(row, name)
    .ToDouble();
}

/// One hexahedron around the middle of the unit cube.
vtkSmartPointer<vtkUnstructuredGrid> Hexahedron(double size)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  const double low = 0.5 - 0.5 * size;
  const double places[8][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
  for (int i = 0; i < 8; ++i)
  {
    points->InsertNextPoint(
      low + size * places[i % 4][0], low + size * places[i % 4][1], low + size * (i / 4));
  }
  grid->SetPoints(points);
  const vtkIdType ids[] = { 0, 1, 2, 3, 4, 5, 6, 7 };
  grid->InsertNextCell(VTK_HEXAHEDRON, 8, ids);
  return grid;
}
}

TEST(vtkVolumeComparison, SmallerCube_ExactOracle)
{
  vtkNew<vtkVolumeComparison> filter;
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::CUBE));
  const double size = 0.8;
  vtkUnstructuredGrid* const cube =
    vtkUnstructuredGrid::SafeDownCast(filter->GetInputDataObject(0, 0));
  double bounds[6];
  cube->GetBounds(bounds);
  const auto mesh = Hexahedron(size);
  for (vtkIdType i = 0; i < 8; ++i) // around the cube's middle
  {
    double point[3];
    mesh->GetPoint(i, point);
    for (int d = 0; d < 3; ++d)
    {
      point[d] += 0.5 * (bounds[2 * d] + bounds[2 * d + 1]) - 0.5;
    }
    mesh->GetPoints()->SetPoint(i, point);
  }
  filter->SetMeshData(mesh);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  const double inset = 0.5 * (1.0 - size);
  EXPECT_NEAR(Number(filter, 0, "LargestDistance"), 0.0, 1e-6);
  EXPECT_NEAR(Number(filter, 0, "VolumeError"), 0.0, 1e-12);
  EXPECT_NEAR(Number(filter, 1, "ToReference"), inset, 1e-6); // points are float
  EXPECT_NEAR(Number(filter, 1, "FromReference"), inset * std::sqrt(3.0), 1e-6);
  EXPECT_NEAR(Number(filter, 1, "VolumeError"), 1.0 - size * size * size, 1e-6);
  EXPECT_EQ(Number(filter, 1, "Functions"), 8);
  EXPECT_EQ(Number(filter, 1, "ValidElements"), 1);
  EXPECT_LE(Number(filter, 1, "ScaledJacobianLower"), Number(filter, 1, "ScaledJacobianUpper"));
  auto* const table = vtkTable::SafeDownCast(filter->GetOutputDataObject(2));
  double cells = 0.0;
  for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
  {
    cells += table->GetValueByName(row, "SecondAttained").ToDouble();
  }
  EXPECT_EQ(cells, 1.0);
  auto* const boundary = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
  double range[2];
  boundary->GetPointData()->GetArray("Distance")->GetRange(range);
  EXPECT_NEAR(range[0], -inset, 1e-6); // it lies inside
  EXPECT_NEAR(range[1], -inset, 1e-6);
}

TEST(vtkVolumeComparison, CurvedTetrahedraOfABall_ExactOracle)
{
  vtkNew<vtkSplineBoundary> surface;
  surface->SetInputDataObject(ShapeGrid(vtkSplineSource::BALL));
  surface->SetChordalTolerance(0.02);
  double largest = 0.0;
  for (const int order : { 1, 2, 3 })
  {
    SCOPED_TRACE(order);
    vtkNew<vtkTetGenMesher> mesher;
    mesher->SetInputConnection(surface->GetOutputPort());
    mesher->SetTargetData(surface->GetInputDataObject(0, 0));
    mesher->SetOrder(order);
    vtkNew<vtkVolumeComparison> filter;
    filter->SetInputDataObject(surface->GetInputDataObject(0, 0));
    filter->SetMeshConnection(mesher->GetOutputPort());
    filter->SetChordalTolerance(1e-3);
    filter->SetSamples(2000);
    filter->Update();
    ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
    EXPECT_NEAR(Number(filter, 0, "Volume"), 4.0 / 3.0 * M_PI, 1e-9);
    EXPECT_EQ(Number(filter, 1, "ValidElements"), Number(filter, 1, "Elements"));
    // points on the boundary by the formula of the ball
    auto* const boundary = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
    double farthest = 0.0;
    for (vtkIdType i = 0; i < boundary->GetNumberOfPoints(); ++i)
    {
      const double* const p = boundary->GetPoint(i);
      farthest = std::max(farthest, std::abs(std::hypot(p[0], p[1], p[2]) - 1.0));
    }
    EXPECT_NEAR(Number(filter, 1, "ToReference"), farthest, 1e-9);
    EXPECT_GT(farthest, 0.0);
    EXPECT_TRUE(order == 1 || farthest < 0.25 * largest) << farthest << " of " << largest;
    largest = order == 1 ? farthest : largest;
  }
}

TEST(vtkVolumeComparison, OpenReferencesAreRefused)
{
  vtkNew<vtkVolumeComparison> filter;
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::CUBE));
  filter->SetMeshData(Hexahedron(1.0));
  vtkNew<vtkPolyData> triangle;
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(0, 0, 0);
  points->InsertNextPoint(1, 0, 0);
  points->InsertNextPoint(0, 1, 0);
  triangle->SetPoints(points);
  triangle->Allocate();
  const vtkIdType ids[] = { 0, 1, 2 };
  triangle->InsertNextCell(VTK_TRIANGLE, 3, ids);
  filter->SetReferenceData(triangle);
  vtkNew<MessageRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  ASSERT_FALSE(recorder->Errors.empty());
  EXPECT_NE(recorder->Errors.front().find("bounds no solid"), std::string::npos)
    << recorder->Errors.front();
}
