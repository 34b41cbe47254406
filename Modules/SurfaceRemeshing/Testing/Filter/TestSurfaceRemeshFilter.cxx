// SPDX-License-Identifier: BSD-3-Clause
// What is remeshed how is tested with the kernel; here: what the filter takes and gives out.
#include "FilterCases.h"
#include "TwoBalls.h"
#include <knotwork/SurfaceRemeshing/vtkSurfaceRemesh.h>

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
/// Of quadrilaterals, with three points a corner, numbered, and lengths of edges at the points.
vtkSmartPointer<vtkPolyData> Cube()
{
  vtkNew<vtkCubeSource> source;
  source->Update();
  auto cube = vtkSmartPointer<vtkPolyData>::New();
  cube->SetPoints(source->GetOutput()->GetPoints());
  cube->SetPolys(source->GetOutput()->GetPolys());
  vtkNew<vtkDoubleArray> number;
  number->SetName("Number");
  for (vtkIdType f = 0; f < 6; ++f)
  {
    number->InsertNextValue(static_cast<double>(f));
  }
  cube->GetCellData()->AddArray(number);
  vtkNew<vtkDoubleArray> length;
  length->SetName("Length");
  for (vtkIdType i = 0; i < cube->GetNumberOfPoints(); ++i)
  {
    length->InsertNextValue(cube->GetPoint(i)[0] > 0.0 ? 0.3 : 0.1);
  }
  cube->GetPointData()->AddArray(length);
  return cube;
}

double Number(vtkSurfaceRemesh* filter, const char* name)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(2))->GetValueByName(0, name).ToDouble();
}
}

TEST(vtkSurfaceRemesh, CellsHaveTheDataOfThoseBelow_ExactOracle)
{
  vtkNew<vtkSurfaceRemesh> filter;
  filter->SetInputDataObject(Cube());
  filter->SetSize(0.2);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  auto* surface = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_GT(surface->GetNumberOfPolys(), 200);
  // faces of the source: -x, +x, -y, +y, -z, +z
  for (vtkIdType t = 0; t < surface->GetNumberOfPolys(); ++t)
  {
    const int face = static_cast<int>(surface->GetCellData()->GetArray("CellIds")->GetTuple1(t));
    EXPECT_EQ(surface->GetCellData()->GetArray("Number")->GetTuple1(t), face);
    double bounds[6];
    surface->GetCellBounds(t, bounds);
    const double side = face % 2 == 0 ? -0.5 : 0.5;
    EXPECT_NEAR(bounds[face / 2 * 2], side, 1e-12);
    EXPECT_NEAR(bounds[face / 2 * 2 + 1], side, 1e-12);
  }
  EXPECT_EQ(surface->GetCellData()->GetArray("RegionId")->GetRange()[1], 5.0);
  EXPECT_EQ(surface->GetPointData()->GetArray("EdgeSize")->GetTuple1(0), 0.2);
  auto* lines = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
  EXPECT_EQ(lines->GetNumberOfVerts(), 8);
  EXPECT_EQ(lines->GetCellData()->GetArray("ChainId")->GetRange()[1], 11.0);
  EXPECT_NEAR(Number(filter, "VolumeAfter"), 1.0, 1e-12);
  EXPECT_EQ(Number(filter, "EulerAfter"), 2);
  EXPECT_EQ(Number(filter, "Intersections"), 0);
}

TEST(vtkSurfaceRemesh, LengthsComeFromAnArray_PropertyOracle)
{
  vtkNew<vtkSurfaceRemesh> filter;
  filter->SetInputDataObject(Cube());
  filter->SetSizing(vtkSurfaceRemesh::ARRAY);
  filter->SetSizeArray("Length");
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  auto* surface = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    EXPECT_NEAR(surface->GetPointData()->GetArray("EdgeSize")->GetTuple1(i),
      0.2 + 0.2 * surface->GetPoint(i)[0], 1e-12);
  }
}

TEST(vtkSurfaceRemesh, ErrorsNameThePlace)
{
  vtkNew<vtkSurfaceRemesh> filter;
  filter->SetInputDataObject(Cube());
  filter->SetSizing(vtkSurfaceRemesh::ARRAY);
  ExpectFailure(filter, ErrorCode::InvalidParameter, "there is no point array ''");
  filter->SetSizeArray("Normals");
  ExpectFailure(filter, ErrorCode::InvalidParameter, "there is no point array 'Normals'");
  const auto cube = Cube();
  filter->SetInputDataObject(cube);
  filter->SetSizeArray("Length");
  cube->GetPointData()->GetArray("Length")->SetTuple1(7, -1.0);
  ExpectFailure(filter, ErrorCode::InvalidParameter, "at point 7 is -1");
  const auto other = Cube();
  other->GetPointData()->GetArray("Length")->SetTuple1(3, std::numeric_limits<double>::quiet_NaN());
  filter->SetInputDataObject(other);
  ExpectFailure(filter, ErrorCode::NonFiniteInput, "no number at point 3");
  filter->SetSizing(vtkSurfaceRemesh::CONSTANT);
  filter->SetSize(1e-6);
  ExpectFailure(filter, ErrorCode::TooLarge, "ask for longer edges");
}

TEST(vtkSurfaceRemesh, ProgressRisesAndStops)
{
  vtkNew<vtkSurfaceRemesh> filter;
  filter->SetInputDataObject(TwoBalls());
  filter->SetLimit(0.05);
  ExpectProgressAndAbort(filter, 3);
}

TEST(vtkSurfaceRemesh, NothingGivesNothing)
{
  vtkNew<vtkSurfaceRemesh> filter;
  filter->SetInputDataObject(vtkSmartPointer<vtkPolyData>::New());
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
}
