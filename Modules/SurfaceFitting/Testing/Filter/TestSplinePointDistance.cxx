// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SurfaceFitting/vtkSplinePointDistance.h>

#include "FilterCases.h"
#include "HeightTiles.h"
#include <knotwork/SurfaceFitting/SurfaceDistance.h>

#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <cmath>
#include <limits>

using namespace knotwork;

namespace
{
vtkSmartPointer<vtkPolyData> PointsOf(const PointMatrix& rows)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
  {
    points->InsertNextPoint(rows(i, 0), rows(i, 1), rows(i, 2));
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  return data;
}

/// 11 x 11 points over [0, 2]^2 at height 0.1; one more outside.
PointMatrix Lattice()
{
  PointMatrix rows(122, 3);
  for (int i = 0; i < 121; ++i)
  {
    rows.row(i) << 0.2 * (i % 11), 0.2 * (i / 11), 0.1;
  }
  rows.row(121) << 9, 9, 9;
  return rows;
}

}

TEST(SplinePointDistanceFilter, IsTheKernelsResult_CrossOracle)
{
  const std::vector<SplinePatch> patches = FourTiles(0.05);
  const PointMatrix rows = Lattice();
  std::vector<Spline<2>> surfaces;
  for (const SplinePatch& patch : patches)
  {
    surfaces.push_back(std::get<Spline<2>>(patch.Geometry));
  }
  for (const int kind : { vtkSplinePointDistance::AUTOMATIC, vtkSplinePointDistance::CLOSEST })
  {
    vtkNew<vtkSplinePointDistance> filter;
    filter->SetKind(kind);
    filter->AddTolerance(0.05);
    filter->AddTolerance(0.2);
    filter->SetInputDataObject(0, PointsOf(rows));
    filter->SetSurfaceData(GridOfPatches(patches));
    filter->Update();
    SurfaceDistanceParams params;
    params.Kind = static_cast<DistanceKind>(kind);
    params.Tolerances = { 0.05, 0.2 };
    const auto kernel = MeasureSurfaceDistances(rows, surfaces, params);
    ASSERT_TRUE(kernel) << kernel.Status.Message();
    auto* output = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
    vtkPointData* arrays = output->GetPointData();
    std::size_t classes[5] = {};
    for (vtkIdType i = 0; i < 122; ++i)
    {
      const auto at = static_cast<std::size_t>(i);
      const double distance = arrays->GetArray("Distance")->GetTuple1(i);
      EXPECT_TRUE(distance == kernel->Distances[at] ||
        (std::isnan(distance) && std::isnan(kernel->Distances[at])));
      EXPECT_EQ(arrays->GetArray("DistanceClass")->GetTuple1(i), kernel->Classes[at]);
      EXPECT_EQ(arrays->GetArray("SurfacePatchId")->GetTuple1(i), kernel->Surfaces[at]);
      classes[kernel->Classes[at] + 2] += std::isnan(distance) ? 0 : 1;
    }
    auto* table = vtkTable::SafeDownCast(filter->GetOutputDataObject(1));
    ASSERT_EQ(table->GetNumberOfRows(), 5);
    for (vtkIdType row = 0; row < 5; ++row)
    {
      EXPECT_EQ(table->GetValueByName(row, "Class").ToInt(), row - 2);
      EXPECT_EQ(
        table->GetValueByName(row, "Points").ToLongLong(), static_cast<long long>(classes[row]));
    }
    EXPECT_EQ(table->GetValueByName(1, "Lower").ToDouble(), -0.2);
    EXPECT_EQ(table->GetValueByName(1, "Upper").ToDouble(), -0.05);
    EXPECT_EQ(table->GetValueByName(2, "Upper").ToDouble(), 0.05);
    auto* numbers = vtkTable::SafeDownCast(filter->GetOutputDataObject(2));
    const bool vertical = kind == vtkSplinePointDistance::AUTOMATIC;
    EXPECT_EQ(numbers->GetValueByName(0, "Kind").ToString(), vertical ? "vertical" : "closest");
    EXPECT_EQ(numbers->GetValueByName(0, "PointsWithout").ToInt(), vertical ? 1 : 0);
    EXPECT_EQ(numbers->GetValueByName(0, "Rms").ToDouble(), kernel->All.Rms);
  }
}

TEST(SplinePointDistanceFilter, BadInput_ExactOracle)
{
  vtkNew<vtkSplinePointDistance> filter;
  filter->SetInputDataObject(0, PointsOf(Lattice()));
  vtkNew<vtkUnstructuredGrid> nothing;
  filter->SetSurfaceData(nothing);
  ExpectFailure(filter, ErrorCode::EmptyInput, "no surface");
  filter->SetSurfaceData(ShapeGrid(vtkSplineSource::CUBE));
  ExpectFailure(filter, ErrorCode::DimensionMismatch, "not a surface");
  PointMatrix bad = Lattice();
  bad(7, 1) = std::numeric_limits<double>::quiet_NaN();
  filter->SetInputDataObject(0, PointsOf(bad));
  filter->SetSurfaceData(GridOfPatches(FourTiles(0.0)));
  ExpectFailure(filter, ErrorCode::NonFiniteInput, "point 7");
  filter->SetInputDataObject(0, PointsOf(Lattice()));
  filter->AddTolerance(-1.0);
  ExpectFailure(filter, ErrorCode::InvalidParameter, "positive");
  filter->ClearTolerances();
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError) << "the filter works again";
  vtkNew<vtkPolyData> noPoints;
  filter->SetInputDataObject(0, noPoints);
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError) << "no points: no output, no error";
}

TEST(SplinePointDistanceFilter, ReportsProgressAndAborts_PropertyOracle)
{
  vtkNew<vtkSplinePointDistance> filter;
  filter->SetInputDataObject(0, PointsOf(Lattice()));
  filter->SetSurfaceData(GridOfPatches(FourTiles(0.0)));
  ExpectProgressAndAbort(filter, 1);
}
