// SPDX-License-Identifier: BSD-3-Clause
// Datums and deviation maps are tested in the kernel; here: what the filters take and give out.
#include "FilterCases.h"
#include <knotwork/CADFitting/vtkDatumAlignment.h>
#include <knotwork/CADFitting/vtkDeviationMap.h>

#include "vtkCellData.h"
#include "vtkCubeSource.h"
#include "vtkFieldData.h"
#include "vtkIntArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkTransform.h"
#include "vtkTransformFilter.h"
#include "vtkTriangleFilter.h"
#include "vtkVariant.h"

#include <cmath>
#include <limits>

using namespace knotwork;

namespace
{
/// Of quadrilaterals, 3 x 2 x 1 about the origin, or larger.
vtkSmartPointer<vtkPolyData> Box(double larger = 0.0)
{
  vtkNew<vtkCubeSource> source;
  source->SetXLength(3.0 + larger);
  source->SetYLength(2.0 + larger);
  source->SetZLength(1.0 + larger);
  source->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  source->Update();
  return source->GetOutput();
}

vtkSmartPointer<vtkPolyData> Turned(vtkPolyData* data)
{
  vtkNew<vtkTransform> transform;
  transform->Translate(5.0, 1.0, -4.0);
  transform->RotateWXYZ(70.0, 1.0, -2.0, 0.5);
  vtkNew<vtkTransformFilter> filter;
  filter->SetTransform(transform);
  filter->SetInputData(data);
  filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  filter->Update();
  return filter->GetPolyDataOutput();
}

vtkSmartPointer<vtkPolyData> Triangles(vtkPolyData* data)
{
  vtkNew<vtkTriangleFilter> filter;
  filter->SetInputData(data);
  filter->Update();
  return filter->GetOutput();
}

double Number(vtkAlgorithm* filter, int port, const char* name, vtkIdType row = 0)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(port))
    ->GetValueByName(row, name)
    .ToDouble();
}
}

TEST(vtkDatumAlignment, ThreeSidesOfABoxMeetInTheOrigin_ExactOracle)
{
  vtkNew<vtkDatumAlignment> filter;
  filter->SetInputDataObject(Turned(Box()));
  // regions are the largest first: 3 x 2 twice, 3 x 1 twice, 2 x 1 twice
  filter->SetDatumPlane(0);
  filter->SetDatumAxis(2);
  filter->SetDatumPoint("4");
  filter->InwardOn();
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_EQ(Number(filter, 1, "Regions"), 6.0);
  EXPECT_EQ(Number(filter, 1, "FreeMotions"), 0.0);
  auto* const output = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
  double bounds[6];
  output->GetBounds(bounds);
  // z has the shortest side, x the middle one
  const double expected[] = { 0.0, 2.0, bounds[2], bounds[2] + 3.0, 0.0, 1.0 };
  for (int k = 0; k < 6; ++k)
  {
    EXPECT_NEAR(bounds[k], expected[k], 1e-9) << k;
  }
  EXPECT_NEAR(std::min(std::abs(bounds[2]), std::abs(bounds[3])), 0.0, 1e-9);
  EXPECT_EQ(output->GetFieldData()->GetArray("Motion")->GetNumberOfComponents(), 16);
}

TEST(vtkDatumAlignment, Errors)
{
  vtkNew<vtkDatumAlignment> filter;
  const auto box = Box();
  filter->SetInputDataObject(box);
  ExpectFailure(filter, ErrorCode::InvalidParameter, "give the region");
  filter->SetDatumPlane(6);
  ExpectFailure(filter, ErrorCode::InvalidParameter, "region 6");
  filter->SetDatumPlane(0);
  filter->SetDatumPoint("2,x");
  ExpectFailure(filter, ErrorCode::InvalidParameter, "'x'");
  filter->SetDatumPoint("");
  vtkNew<vtkIntArray> ids; // of another recognition
  ids->SetName("RegionId");
  ids->SetNumberOfValues(box->GetNumberOfCells());
  ids->FillValue(3);
  box->GetCellData()->AddArray(ids);
  ExpectFailure(filter, ErrorCode::InvalidParameter, "RegionId 3");
  vtkNew<vtkPolyData> empty;
  filter->SetInputDataObject(empty);
  ExpectFailure(filter, ErrorCode::EmptyInput, "no triangles");
  const auto bad = Triangles(Box());
  bad->GetPoints()->SetPoint(1, 0.0, std::numeric_limits<double>::quiet_NaN(), 0.0);
  filter->SetInputDataObject(bad);
  ExpectFailure(filter, ErrorCode::NonFiniteInput, "point");
}

TEST(vtkDatumAlignment, ProgressAndAbort)
{
  vtkNew<vtkDatumAlignment> filter;
  filter->SetInputDataObject(Box());
  filter->SetDatumPlane(0);
  ExpectProgressAndAbort(filter, 1);
}

TEST(vtkDeviationMap, LargerBox_ExactOracle)
{
  vtkNew<vtkDeviationMap> filter;
  filter->SetInputDataObject(Box(0.2));
  // the same box as triangles, and as a spline volume
  for (const bool isSpline : { false, true })
  {
    vtkNew<vtkSplineSource> solid;
    solid->SetShape(vtkSplineSource::CUBE);
    solid->SetSize(3.0, 2.0, 1.0);
    solid->Update();
    double bounds[6];
    vtkUnstructuredGrid::SafeDownCast(solid->GetOutputDataObject(0))->GetBounds(bounds);
    vtkNew<vtkTransform> middle;
    middle->Translate(-0.5 * (bounds[0] + bounds[1]), -0.5 * (bounds[2] + bounds[3]),
      -0.5 * (bounds[4] + bounds[5]));
    vtkNew<vtkTransformFilter> centred;
    centred->SetTransform(middle);
    centred->SetInputConnection(solid->GetOutputPort());
    if (isSpline)
    {
      filter->SetModelConnection(centred->GetOutputPort());
    }
    else
    {
      filter->SetModelData(Box());
    }
    filter->Update();
    ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
    EXPECT_EQ(Number(filter, 3, "Signed"), 1.0);
    // corners are the scan's points, and sides the model's nearest
    EXPECT_NEAR(Number(filter, 3, "ScanMin"), 0.1 * std::sqrt(3.0), 1e-6);
    EXPECT_NEAR(Number(filter, 3, "ModelMin"), 0.1, 1e-6);
    EXPECT_NEAR(Number(filter, 3, "ModelMax"), 0.1, 1e-6);
    EXPECT_NEAR(Number(filter, 2, "ModelToScan", 5), 0.1, 1e-6);
    EXPECT_EQ(Number(filter, 2, "Percent", 4), 99.9);
    auto* const model = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
    EXPECT_GE(model->GetNumberOfPoints(), 20000);
    EXPECT_EQ(model->GetPointData()->GetScalars(), model->GetPointData()->GetArray("Distance"));
    EXPECT_EQ(Number(filter, 3, "ModelPoints"), model->GetNumberOfPoints());
    auto* const scan = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
    EXPECT_TRUE(scan->GetPointData()->GetArray("TargetPoint"));
    EXPECT_EQ(scan->GetNumberOfCells(), 6);
  }
}

TEST(vtkDeviationMap, Errors)
{
  vtkNew<vtkDeviationMap> filter;
  vtkNew<vtkPolyData> empty;
  filter->SetInputDataObject(empty);
  filter->SetModelData(Box());
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  filter->SetInputDataObject(Box());
  filter->SetModelData(empty);
  ExpectFailure(filter, ErrorCode::EmptyInput, "model: ");
  filter->SetModelData(ShapeGrid(vtkSplineSource::ARC));
  ExpectFailure(filter, ErrorCode::EmptyInput, "no faces");
  const auto bad = Triangles(Box());
  bad->GetPoints()->SetPoint(1, 0.0, std::numeric_limits<double>::quiet_NaN(), 0.0);
  filter->SetInputDataObject(bad);
  filter->SetModelData(Box());
  ExpectFailure(filter, ErrorCode::NonFiniteInput, "point 1");
  vtkNew<vtkTransform> away;
  away->Translate(10.0, 0.0, 0.0);
  vtkNew<vtkTransformFilter> moved;
  moved->SetTransform(away);
  moved->SetInputData(Box());
  filter->SetInputConnection(moved->GetOutputPort());
  filter->SetMaximumDistance(0.5);
  ExpectFailure(filter, ErrorCode::InvalidParameter, "within 0.5 of the scan");
  filter->SetMaximumDistance(0.0);
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::SQUARE));
  ExpectFailure(filter, ErrorCode::InvalidParameter, "the scan");
}

TEST(vtkDeviationMap, ProgressAndAbort)
{
  vtkNew<vtkDeviationMap> filter;
  filter->SetInputDataObject(Box(0.2));
  filter->SetModelData(Box());
  ExpectProgressAndAbort(filter, 2);
  // a model whose faces are made triangles first
  filter->SetModelData(ShapeGrid(vtkSplineSource::CUBE));
  ExpectProgressAndAbort(filter, 2);
}
