// SPDX-License-Identifier: BSD-3-Clause
// The regions of the kernel are tested there; here: what the filter gives out.
#include "FilterCases.h"
#include <knotwork/SurfaceTrimming/vtkSurfaceRecognition.h>

#include "vtkAppendPolyData.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCubeSource.h"
#include "vtkCylinderSource.h"
#include "vtkDataArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkTriangleFilter.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVariant.h"

#include <cmath>
#include <limits>
#include <set>

using namespace knotwork;

namespace
{
constexpr int Plane = 0;
constexpr int Cylinder = 1;

/// Of quadrilaterals, with three points a corner.
vtkSmartPointer<vtkPolyData> Cube(double x)
{
  vtkNew<vtkCubeSource> source;
  source->SetCenter(x, 0.0, 0.0);
  source->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  source->Update();
  return source->GetOutput();
}

/// About y, radius 0.75, height 2, two points at every point of the rims.
vtkSmartPointer<vtkPolyData> CylinderWithCaps()
{
  vtkNew<vtkCylinderSource> source;
  source->SetRadius(0.75);
  source->SetHeight(2.0);
  source->SetResolution(40);
  source->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputConnection(source->GetOutputPort());
  triangles->Update();
  return triangles->GetOutput();
}

vtkSmartPointer<vtkPolyData> Both(vtkPolyData* first, vtkPolyData* second)
{
  vtkNew<vtkAppendPolyData> both;
  both->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  both->AddInputData(first);
  both->AddInputData(second);
  both->Update();
  return both->GetOutput();
}

vtkPolyData* Polygons(vtkSurfaceRecognition* filter, int port)
{
  return vtkPolyData::SafeDownCast(filter->GetOutputDataObject(port));
}

double Cell(vtkPolyData* data, const char* array, vtkIdType cell, int component = 0)
{
  return data->GetCellData()->GetArray(array)->GetComponent(cell, component);
}

vtkTable* Regions(vtkSurfaceRecognition* filter)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(2));
}

double Number(vtkSurfaceRecognition* filter, const char* name)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(3))->GetValueByName(0, name).ToDouble();
}
}

TEST(vtkSurfaceRecognition, CubeIsSixPlanesWithTwelveEdges_Exact)
{
  vtkNew<vtkSurfaceRecognition> filter;
  filter->SetInputDataObject(Cube(0.0));
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  auto* triangles = Polygons(filter, 0);
  ASSERT_EQ(triangles->GetNumberOfPolys(), 12);
  std::set<int> ids;
  for (vtkIdType t = 0; t < 12; ++t)
  {
    ids.insert(static_cast<int>(Cell(triangles, "RegionId", t)));
    EXPECT_EQ(Cell(triangles, "SurfaceType", t), Plane);
    EXPECT_EQ(Cell(triangles, "RegionId", t), Cell(triangles, "RegionId", t - t % 2));
  }
  EXPECT_EQ(ids, (std::set<int>{ 0, 1, 2, 3, 4, 5 }));
  auto* edges = Polygons(filter, 1);
  ASSERT_EQ(edges->GetNumberOfLines(), 12);
  std::set<std::pair<int, int>> pairs;
  for (vtkIdType e = 0; e < 12; ++e)
  {
    double a[3];
    double b[3];
    vtkIdType count = 0;
    const vtkIdType* ends = nullptr;
    edges->GetCellPoints(e, count, ends);
    ASSERT_EQ(count, 2);
    edges->GetPoint(ends[0], a);
    edges->GetPoint(ends[1], b);
    EXPECT_EQ(std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]), 1.0);
    const auto first = static_cast<int>(Cell(edges, "Regions", e, 0));
    const auto second = static_cast<int>(Cell(edges, "Regions", e, 1));
    EXPECT_LT(first, second);
    pairs.emplace(first, second);
  }
  EXPECT_EQ(pairs.size(), 12u);
  vtkTable* regions = Regions(filter);
  ASSERT_EQ(regions->GetNumberOfRows(), 6);
  for (vtkIdType r = 0; r < 6; ++r)
  {
    EXPECT_EQ(regions->GetValueByName(r, "Region").ToInt(), r);
    EXPECT_EQ(regions->GetValueByName(r, "Type").ToString(), "plane");
    EXPECT_EQ(regions->GetValueByName(r, "Triangles").ToInt(), 2);
    EXPECT_NEAR(regions->GetValueByName(r, "Area").ToDouble(), 1.0, 1e-14);
    EXPECT_LT(regions->GetValueByName(r, "MaxDistance").ToDouble(), 1e-14);
  }
  EXPECT_EQ(Number(filter, "Regions"), 6.0);
  EXPECT_EQ(Number(filter, "Planes"), 6.0);
  EXPECT_EQ(Number(filter, "Cylinders"), 0.0);
  EXPECT_NEAR(Number(filter, "Tolerance"), 1e-3 * std::sqrt(3.0), 1e-15);
}

TEST(vtkSurfaceRecognition, CylinderHasItsRadiusAndAxis_Exact)
{
  vtkNew<vtkSurfaceRecognition> filter;
  filter->SetInputDataObject(CylinderWithCaps());
  filter->Update();
  EXPECT_EQ(Number(filter, "Planes"), 2.0);
  EXPECT_EQ(Number(filter, "Cylinders"), 1.0);
  vtkTable* regions = Regions(filter);
  ASSERT_EQ(regions->GetNumberOfRows(), 3);
  EXPECT_EQ(regions->GetValueByName(0, "Type").ToString(), "cylinder"); // of the largest area
  EXPECT_EQ(regions->GetValueByName(0, "Triangles").ToInt(), 80);
  EXPECT_NEAR(regions->GetValueByName(0, "Radius").ToDouble(), 0.75, 1e-9);
  EXPECT_EQ(regions->GetValueByName(0, "Reversed").ToInt(), 0);
  const double sag = 0.75 * (1.0 - std::cos(std::acos(-1.0) / 40.0));
  EXPECT_NEAR(regions->GetValueByName(0, "MaxSag").ToDouble(), sag, 1e-9);
  EXPECT_NEAR(Number(filter, "MaxSag"), sag, 1e-9);
  auto* axes = vtkDataArray::SafeDownCast(regions->GetColumnByName("Axis"));
  auto* points = vtkDataArray::SafeDownCast(regions->GetColumnByName("Point"));
  EXPECT_NEAR(std::abs(axes->GetComponent(0, 1)), 1.0, 1e-9);
  EXPECT_NEAR(points->GetComponent(0, 0), 0.0, 1e-9);
  EXPECT_NEAR(points->GetComponent(0, 2), 0.0, 1e-9);
  auto* edges = Polygons(filter, 1);
  EXPECT_EQ(edges->GetNumberOfLines(), 80); // two circles
  for (vtkIdType e = 0; e < edges->GetNumberOfLines(); ++e)
  {
    EXPECT_EQ(Cell(edges, "Regions", e, 0), 0.0);
  }
  // strips that sag more than is allowed are of no surface
  filter->SetTolerance(1e-3);
  filter->SetMaximumSag(1.0);
  filter->Update();
  EXPECT_EQ(Number(filter, "Cylinders"), 0.0);
  EXPECT_EQ(Number(filter, "Planes"), 2.0);
  EXPECT_EQ(Number(filter, "FreeForms"), 1.0);
}

TEST(vtkSurfaceRecognition, PartsOfOneMeshAreRecognizedEachForItself_Exact)
{
  vtkNew<vtkSurfaceRecognition> filter;
  filter->SetInputDataObject(Both(Cube(3.0), CylinderWithCaps()));
  filter->Update();
  EXPECT_EQ(Number(filter, "Regions"), 9.0);
  EXPECT_EQ(Number(filter, "Planes"), 8.0);
  EXPECT_EQ(Number(filter, "Cylinders"), 1.0);
  auto* triangles = Polygons(filter, 0);
  for (vtkIdType t = 0; t < triangles->GetNumberOfPolys(); ++t)
  {
    const double region = Cell(triangles, "RegionId", t);
    EXPECT_EQ(region < 6.0, t < 12) << t;
    EXPECT_EQ(Cell(triangles, "SurfaceType", t), region == 6.0 ? Cylinder : Plane) << t;
  }
  EXPECT_EQ(Polygons(filter, 1)->GetNumberOfLines(), 92);
}

/// Values of a cube and a cylinder about y are common already; the table tells which.
TEST(vtkSurfaceRecognition, CommonValuesHaveNumbers_Exact)
{
  vtkNew<vtkSurfaceRecognition> filter;
  filter->SetInputDataObject(Both(Cube(3.0), CylinderWithCaps()));
  filter->SetSnapDistance(1e-3);
  filter->Update();
  EXPECT_EQ(Number(filter, "CommonDirections"), 3.0);
  EXPECT_EQ(Number(filter, "CommonPositions"), 0.0);
  EXPECT_EQ(Number(filter, "CommonSizes"), 0.0);
  EXPECT_LT(Number(filter, "MaxTurn"), 1e-6);
  vtkTable* regions = Regions(filter);
  ASSERT_EQ(regions->GetNumberOfRows(), 9);
  auto* axes = vtkDataArray::SafeDownCast(regions->GetColumnByName("Axis"));
  for (vtkIdType r = 0; r < 9; ++r)
  {
    for (vtkIdType q = 0; q < r; ++q)
    {
      double dot = 0.0;
      for (int d = 0; d < 3; ++d)
      {
        dot += axes->GetComponent(r, d) * axes->GetComponent(q, d);
      }
      const bool isCommon = regions->GetValueByName(r, "Direction").ToInt() ==
        regions->GetValueByName(q, "Direction").ToInt();
      EXPECT_NEAR(std::abs(dot), isCommon ? 1.0 : 0.0, 1e-15) << r << " " << q;
    }
    EXPECT_EQ(regions->GetValueByName(r, "Position").ToInt(), -1);
    EXPECT_EQ(regions->GetValueByName(r, "Size").ToInt(), -1);
  }
  filter->SetSnapDistance(0.0);
  filter->Update();
  EXPECT_EQ(Number(filter, "SnappedSurfaces"), 0.0);
  EXPECT_EQ(Number(filter, "CommonDirections"), 0.0);
}

TEST(vtkSurfaceRecognition, Errors)
{
  vtkNew<vtkSurfaceRecognition> filter;
  vtkNew<vtkPolyData> empty;
  filter->SetInputDataObject(empty);
  ExpectFailure(filter, ErrorCode::EmptyInput, "no triangles");
  const auto cylinder = CylinderWithCaps();
  cylinder->GetPoints()->SetPoint(7, 0.0, std::numeric_limits<double>::quiet_NaN(), 0.0);
  filter->SetInputDataObject(cylinder);
  ExpectFailure(filter, ErrorCode::NonFiniteInput, "1 point (7)");
  vtkNew<vtkUnstructuredGrid> solid;
  vtkNew<vtkPoints> points;
  const vtkIdType corners[4] = { 0, 1, 2, 3 };
  points->InsertNextPoint(0.0, 0.0, 0.0);
  points->InsertNextPoint(1.0, 0.0, 0.0);
  points->InsertNextPoint(0.0, 1.0, 0.0);
  points->InsertNextPoint(0.0, 0.0, 1.0);
  solid->SetPoints(points);
  solid->InsertNextCell(VTK_TETRA, 4, corners);
  filter->SetInputDataObject(solid);
  ExpectFailure(filter, ErrorCode::InvalidTopology, "cell");
  vtkNew<vtkPolyData> fins; // three triangles at one edge
  fins->SetPoints(points);
  vtkNew<vtkCellArray> cells;
  points->InsertNextPoint(0.0, -1.0, 0.0);
  for (const vtkIdType tip : { 2, 3, 4 })
  {
    const vtkIdType triangle[3] = { 0, 1, tip };
    cells->InsertNextCell(3, triangle);
  }
  fins->SetPolys(cells);
  filter->SetInputDataObject(fins);
  ExpectFailure(filter, ErrorCode::InvalidTopology, "more than two triangles");
}

TEST(vtkSurfaceRecognition, ProgressAndAbort)
{
  vtkNew<vtkSurfaceRecognition> filter;
  filter->SetInputDataObject(Both(Cube(3.0), CylinderWithCaps()));
  ExpectProgressAndAbort(filter, 2);
}
