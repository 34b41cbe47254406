// SPDX-License-Identifier: BSD-3-Clause
// What is repaired how is tested with the kernel; here: what the filter gives out.
#include "FilterCases.h"
#include "TwoBalls.h"
#include <knotwork/SurfaceRemeshing/vtkSurfaceRepair.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCubeSource.h"
#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <limits>

using namespace knotwork;

namespace
{
/// Of quadrilaterals, with three points a corner, without the last face when it is open.
vtkSmartPointer<vtkPolyData> Cube(bool open)
{
  vtkNew<vtkCubeSource> source;
  source->Update();
  auto cube = vtkSmartPointer<vtkPolyData>::New();
  cube->SetPoints(source->GetOutput()->GetPoints());
  vtkNew<vtkCellArray> faces;
  vtkNew<vtkDoubleArray> number;
  number->SetName("Number");
  for (vtkIdType f = 0; f < (open ? 5 : 6); ++f)
  {
    faces->InsertNextCell(source->GetOutput()->GetCell(f));
    number->InsertNextValue(static_cast<double>(f));
  }
  cube->SetPolys(faces);
  cube->GetCellData()->AddArray(number);
  return cube;
}

vtkSmartPointer<vtkPolyData> OneCell(int type, double y)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->InsertNextPoint(0.0, 0.0, 0.0);
  points->InsertNextPoint(1.0, 0.0, 0.0);
  points->InsertNextPoint(2.0, y, 0.0);
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->AllocateExact(1, 3);
  const vtkIdType corners[3] = { 0, 1, 2 };
  data->InsertNextCell(type, 3, corners);
  return data;
}

double Number(vtkSurfaceRepair* filter, const char* name)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(2))->GetValueByName(0, name).ToDouble();
}
}

TEST(vtkSurfaceRepair, GivesTheDataOfTheInput_Exact)
{
  vtkNew<vtkSurfaceRepair> filter;
  filter->SetInputDataObject(Cube(true));
  filter->SetLargestHole(1.0);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  auto* surface = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_EQ(surface->GetNumberOfPoints(), 8);
  ASSERT_EQ(surface->GetNumberOfPolys(), 12);
  for (vtkIdType t = 0; t < 12; ++t)
  {
    const double cell = surface->GetCellData()->GetArray("CellIds")->GetTuple1(t);
    EXPECT_EQ(cell, t < 10 ? static_cast<double>(t / 2) : -1.0);
    EXPECT_EQ(surface->GetCellData()->GetArray("Number")->GetTuple1(t), std::max(cell, 0.0));
  }
  auto* actions = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
  ASSERT_EQ(actions->GetNumberOfVerts(), 1);
  EXPECT_EQ(
    actions->GetCellData()->GetAbstractArray("Action")->GetVariantValue(0).ToString(), "holes");
  EXPECT_EQ(Number(filter, "Holes"), 1);
  EXPECT_EQ(Number(filter, "MergedPoints"), 12);
  EXPECT_EQ(Number(filter, "Closed"), 1);
  EXPECT_NEAR(Number(filter, "VolumeAfter"), 1.0, 1e-14);
  EXPECT_EQ(Number(filter, "EulerAfter"), 2);
}

TEST(vtkSurfaceRepair, ErrorsNameThePlace)
{
  vtkNew<vtkSurfaceRepair> filter;
  filter->SetInputDataObject(Cube(true));
  ExpectFailure(filter, ErrorCode::InvalidTopology, "1 hole stays, at (");
  filter->SetInputDataObject(OneCell(VTK_TRIANGLE, std::numeric_limits<double>::quiet_NaN()));
  ExpectFailure(filter, ErrorCode::NonFiniteInput, "point 2 is not finite");
  filter->SetInputDataObject(OneCell(VTK_TRIANGLE, 1e300));
  ExpectFailure(filter, ErrorCode::NonFiniteInput, "point 2");
  filter->SetInputDataObject(OneCell(VTK_TRIANGLE, 0.0)); // on a line
  ExpectFailure(filter, ErrorCode::EmptyInput, "no triangle of the mesh has an area");
  filter->SetInputDataObject(OneCell(VTK_POLY_LINE, 1.0));
  ExpectFailure(filter, ErrorCode::EmptyInput, "the mesh has no triangles");
}

TEST(vtkSurfaceRepair, ProgressRisesAndStops)
{
  vtkNew<vtkSurfaceRepair> filter;
  filter->SetInputDataObject(TwoBalls());
  ExpectProgressAndAbort(filter, 3);
}

TEST(vtkSurfaceRepair, NothingGivesNothing)
{
  vtkNew<vtkSurfaceRepair> filter;
  filter->SetInputDataObject(vtkSmartPointer<vtkPolyData>::New());
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
}
