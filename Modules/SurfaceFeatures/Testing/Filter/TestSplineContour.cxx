// SPDX-License-Identifier: BSD-3-Clause
// Contours of surfaces whose contours are circles, and of tiles with a field.
#include <knotwork/SurfaceFeatures/vtkSplineContour.h>

#include "FilterCases.h"
#include "HeightTiles.h"
#include <knotwork/SplineCore/TensorSpace.h>

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIdList.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <cmath>
#include <limits>

using namespace knotwork;

namespace
{
vtkSmartPointer<vtkUnstructuredGrid> Bowl(int id = 0, double x = 0.0)
{
  return GridOfPatches({ HeightTile(id, { { x, 0.0 }, { x + 1.0, 1.0 } }, 4,
    [x](double u, double v) { return std::hypot(u - x - 0.5, v - 0.5); }) });
}

int Total(vtkSplineContour* filter, const char* column)
{
  vtkTable* table = vtkTable::SafeDownCast(filter->GetOutputDataObject(2));
  int total = 0;
  for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
  {
    total += table->GetValueByName(row, column).ToInt();
  }
  return total;
}
}

TEST(SplineContourFilter, TorusAtAHeightIsTwoCircles_ExactOracle)
{
  vtkNew<vtkSplineSource> torus;
  torus->SetShape(vtkSplineSource::TORUS_SURFACE);
  torus->SetAngle(360.0);
  vtkNew<vtkSplineContour> filter;
  filter->SetInputConnection(torus->GetOutputPort());
  filter->SetNumberOfLevels(3);
  filter->SetTolerance(1e-6);
  filter->SetCurves(true);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), 0u);
  auto* lines = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_EQ(lines->GetNumberOfLines(), 6);
  EXPECT_EQ(Total(filter, "Components"), 6);
  EXPECT_EQ(Total(filter, "Closed"), 6);
  EXPECT_EQ(Total(filter, "Undecided"), 0);
  auto* level = lines->GetCellData()->GetArray("Level");
  auto* value = lines->GetPointData()->GetArray("Value");
  for (vtkIdType cell = 0; cell < 6; ++cell)
  {
    vtkNew<vtkIdList> ids;
    lines->GetCellPoints(cell, ids);
    EXPECT_EQ(ids->GetId(0), ids->GetId(ids->GetNumberOfIds() - 1));
    EXPECT_EQ(lines->GetCellData()->GetArray("Closed")->GetTuple1(cell), 1.0);
    EXPECT_LE(lines->GetCellData()->GetArray("MaxError")->GetTuple1(cell), 1e-6);
    double first[3];
    lines->GetPoint(ids->GetId(0), first);
    for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
    {
      double x[3];
      lines->GetPoint(ids->GetId(i), x);
      EXPECT_NEAR(x[2], level->GetTuple1(cell), 1e-6);
      EXPECT_EQ(x[2], value->GetTuple1(ids->GetId(i)));
      // a height off by 1e-6 moves the circle of a tube by that over its slope, at least 1/2 here
      EXPECT_NEAR(std::hypot(x[0], x[1]), std::hypot(first[0], first[1]), 4e-6);
    }
  }
  auto* curves = filter->GetOutputDataObject(1);
  const SplineModel model = DecodePatches(curves);
  ASSERT_EQ(model.Patches.size(), 6u);
  for (const SplinePatch& patch : model.Patches)
  {
    const auto& curve = std::get<Spline<1>>(patch.Geometry);
    EXPECT_EQ(curve.ControlPoints.row(0), curve.ControlPoints.bottomRows(1).row(0));
    ASSERT_EQ(patch.Fields.size(), 1u);
    EXPECT_EQ(patch.Fields[0].Name, "UV");
  }
}

TEST(SplineContourFilter, RangeAndSeams_ExactOracle)
{
  // a coordinate across the seam of a closed cylinder: two straight lines, whatever the seam; its
  // height: circles, which the seam cuts when they are not joined
  vtkNew<vtkSplineSource> cylinder;
  cylinder->SetShape(vtkSplineSource::CYLINDER_SURFACE);
  cylinder->SetAngle(360.0);
  cylinder->Update();
  double box[6];
  vtkUnstructuredGrid::SafeDownCast(cylinder->GetOutputDataObject(0))->GetBounds(box);
  const double height = box[5] - box[4];
  vtkNew<vtkSplineContour> filter;
  filter->SetInputConnection(cylinder->GetOutputPort());
  filter->SetRange(box[4] + 0.25 * height, box[4] + 0.75 * height);
  filter->SetNumberOfLevels(3);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), 0u);
  auto* table = vtkTable::SafeDownCast(filter->GetOutputDataObject(2));
  ASSERT_EQ(table->GetNumberOfRows(), 3); // evenly, ends included
  for (vtkIdType row = 0; row < 3; ++row)
  {
    EXPECT_NEAR(table->GetValueByName(row, "Level").ToDouble(),
      box[4] + (0.25 + 0.25 * static_cast<double>(row)) * height, 1e-14);
  }
  EXPECT_EQ(Total(filter, "Closed"), 3);
  EXPECT_EQ(Total(filter, "Components"), 3);
  filter->JoinSeamsOff();
  filter->Update();
  EXPECT_EQ(Total(filter, "Closed"), 0);
  EXPECT_GE(Total(filter, "Components"), 3);
}

TEST(SplineContourFilter, FieldsAndCollections_ExactOracle)
{
  vtkNew<vtkSplineContour> filter;
  filter->SetInputData(Collect({ Bowl(0), Bowl(1, 3.0) }));
  filter->AddLevel(0.3);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), 0u);
  auto* lines = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_EQ(lines->GetNumberOfLines(), 2);
  EXPECT_EQ(lines->GetCellData()->GetArray("PatchId")->GetTuple1(1), 1.0);

  // the field's coefficients are squares of the heights': another function, level by level
  filter->SetFieldName("Slope");
  filter->ClearLevels();
  filter->AddLevel(0.09);
  filter->SetProjectToLevel(true);
  filter->SetTolerance(1e-5);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), 0u);
  EXPECT_EQ(lines->GetNumberOfLines(), 2);
  for (vtkIdType i = 0; i < lines->GetNumberOfPoints(); ++i)
  {
    double x[3];
    lines->GetPoint(i, x);
    EXPECT_EQ(x[2], 0.09);
    EXPECT_NEAR(lines->GetPointData()->GetArray("Value")->GetTuple1(i), 0.09, 1e-5);
  }
  // a coordinate: one straight line on one of the tiles
  filter->SetFieldName("");
  filter->SetComponent(0);
  filter->ClearLevels();
  filter->AddLevel(3.25);
  filter->Update();
  EXPECT_EQ(lines->GetNumberOfLines(), 1);
  EXPECT_EQ(Total(filter, "Closed"), 0);
  // levels beside the values are no error
  filter->ClearLevels();
  filter->AddLevel(-7.0);
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), 0u);
  EXPECT_EQ(lines->GetNumberOfLines(), 0);
  EXPECT_EQ(Total(filter, "Components"), 0);
}

TEST(SplineContourFilter, WhatStaysUndecidedIsShown_ExactOracle)
{
  // z = -(x + y / 2 - 0.1)^2 on [-1, 1]^2 by its Bernstein coefficients: a ridge at the level 0
  const KnotVector knots = KnotVector::Create(2, { -1, -1, -1, 1, 1, 1 }).Value;
  Spline<2> surface;
  surface.Space = MakeTensorSpace<2>({ knots, knots }).Value;
  surface.ControlPoints.resize(9, 3);
  for (int j = -1; j <= 1; ++j)
  {
    for (int i = -1; i <= 1; ++i)
    {
      const int square[2] = { i == 0 ? -1 : 1, j == 0 ? -1 : 1 };
      surface.ControlPoints.row(3 * j + i + 4) << i, j,
        -square[0] - i * j - 0.25 * square[1] + 0.2 * i + 0.1 * j - 0.01;
    }
  }
  SplinePatch patch;
  patch.Geometry = surface;
  const auto grid = GridOfPatches({ patch });
  vtkNew<vtkSplineContour> filter;
  vtkNew<MessageRecorder> recorder;
  recorder->Watch(filter);
  filter->SetInputData(grid);
  filter->SetMaximumCells(512);
  filter->AddLevel(0.0);
  filter->AddLevel(-1.0);
  filter->Update();
  auto* boxes = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(3));
  EXPECT_EQ(boxes->GetNumberOfPolys(), Total(filter, "Undecided"));
  ASSERT_GT(boxes->GetNumberOfPolys(), 0);
  EXPECT_NE(boxes->GetCellData()->GetArray("ParametricBounds"), nullptr);
  ASSERT_FALSE(recorder->Warnings.empty());
  EXPECT_NE(recorder->Warnings[0].find("MaximumCells"), std::string::npos);
}

TEST(SplineContourFilter, FailuresNamePlaceAndRemedy_ExactOracle)
{
  vtkNew<vtkSplineContour> filter;
  filter->SetComponent(0); // the good grid among the bad ones is flat
  ExpectBadInputIsRefused(filter);
  filter->SetComponent(-1);
  filter->SetInputData(Bowl(4));
  filter->SetFieldName("Heat");
  ExpectFailure(filter, ErrorCode::InvalidParameter, "patch 4: there is no field 'Heat'");
  filter->SetFieldName("Slope");
  filter->SetComponent(1);
  ExpectFailure(filter, ErrorCode::InvalidParameter, "choose 0 to 0");
  filter->SetFieldName("");
  filter->SetComponent(3);
  ExpectFailure(filter, ErrorCode::InvalidParameter, "choose 0 to 2");
  filter->SetComponent(-1);
  filter->SetTolerance(1e-17);
  ExpectFailure(filter, ErrorCode::InvalidParameter, "within rounding");
  filter->SetTolerance(0.0);
  filter->SetMaximumPoints(10);
  ExpectFailure(filter, ErrorCode::TooLarge, "raise MaximumPoints");
  filter->SetMaximumPoints(5000000);
  filter->AddLevel(std::numeric_limits<double>::quiet_NaN());
  ExpectFailure(filter, ErrorCode::InvalidParameter, "finite");
  filter->ClearLevels();
  filter->SetInputData(ShapeGrid(vtkSplineSource::CUBE));
  ExpectFailure(filter, ErrorCode::DimensionMismatch, "select the surfaces");
}

TEST(SplineContourFilter, ReportsProgressAndAborts_PropertyOracle)
{
  vtkNew<vtkSplineContour> filter;
  filter->SetInputData(Bowl());
  ExpectProgressAndAbort(filter, 1);
}
