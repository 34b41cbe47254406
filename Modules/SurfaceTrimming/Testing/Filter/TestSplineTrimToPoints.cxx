// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SurfaceTrimming/vtkSplineTrimToPoints.h>

#include "FilterCases.h"
#include "HeightTiles.h"
#include <knotwork/SurfaceTrimming/CloudOutline.h>
#include <knotwork/SurfaceTrimming/TrimmedGrids.h>

#include "vtkMassProperties.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <cmath>

using namespace knotwork;

namespace
{
/// A lattice of 81 x 81 points over [0, 2]^2 at height 0, without those in a disc.
vtkSmartPointer<vtkPolyData> LatticeWithHole()
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int i = 0; i < 81 * 81; ++i)
  {
    const double x = 0.025 * (i % 81);
    const double y = 0.025 * (i / 81);
    if (std::hypot(x - 0.8, y - 1.1) > 0.4)
    {
      points->InsertNextPoint(x, y, 0.0);
    }
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  return data;
}

vtkSmartPointer<vtkUnstructuredGrid> FlatSurface()
{
  return GridOfPatches(
    { HeightTile(0, { { 0, 0 }, { 2, 2 } }, 4, [](double, double) { return 0.0; }) });
}

double Number(vtkSplineTrimToPoints* filter, const char* name)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(3))->GetValueByName(0, name).ToDouble();
}
}

TEST(SplineTrimToPointsFilter, ASquareWithAHoleIsItsOutline_CrossOracle)
{
  vtkNew<vtkSplineTrimToPoints> filter;
  filter->SetInputDataObject(0, FlatSurface());
  const auto points = LatticeWithHole();
  filter->SetPointsData(points);
  filter->SetChordalTolerance(1e-4);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_EQ(Number(filter, "Faces"), 1);
  EXPECT_EQ(Number(filter, "Loops"), 2);
  EXPECT_EQ(Number(filter, "LoopsProved"), 1);
  EXPECT_EQ(Number(filter, "FacesRegular"), 1);
  vtkNew<vtkMassProperties> mass;
  mass->SetInputData(vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0)));
  PointMatrix places(points->GetNumberOfPoints(), 2);
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    const double* x = points->GetPoint(i);
    places.row(i) << x[0], x[1];
  }
  const auto outline = FindCloudOutline(places);
  ASSERT_TRUE(outline) << outline.Status.Message();
  ASSERT_EQ(outline->Parts.size(), 1u);
  double area = 0.0;
  const PointMatrix& p = outline->Parts[0].Points;
  for (const auto& [a, b, c] : outline->Parts[0].Triangles)
  {
    area +=
      0.5 * ((p(b, 0) - p(a, 0)) * (p(c, 1) - p(a, 1)) - (p(c, 0) - p(a, 0)) * (p(b, 1) - p(a, 1)));
  }
  // half a cell around the circle would be 1.25
  EXPECT_NEAR(mass->GetSurfaceArea(), area, 0.05 * Number(filter, "CellSize"));
  const auto model =
    DecodeTrimmedModel(filter->GetOutputDataObject(1), filter->GetOutputDataObject(2));
  ASSERT_TRUE(model) << model.Status.Message();
  EXPECT_EQ(model->Faces[0].Loops.size(), 2u);
}

TEST(SplineTrimToPointsFilter, GapsAndSmallPartsAreChosen_PropertyOracle)
{
  // the lattice without its points beyond x = 1.5, but for a few far from the others
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  const auto lattice = LatticeWithHole();
  for (vtkIdType i = 0; i < lattice->GetNumberOfPoints(); ++i)
  {
    const double* x = lattice->GetPoint(i);
    if (x[0] < 1.5 || (x[0] > 1.87 && x[1] > 1.87))
    {
      points->InsertNextPoint(x);
    }
  }
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(points);
  vtkNew<vtkSplineTrimToPoints> filter;
  filter->SetInputDataObject(0, FlatSurface());
  filter->SetPointsData(cloud);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_EQ(Number(filter, "Faces"), 2);
  EXPECT_EQ(Number(filter, "Loops"), 3); // the hole of width 0.8 stays
  // the smaller part alone is left out by a number between those of both
  const double cells = std::pow(0.13 / Number(filter, "CellSize"), 2);
  filter->SetMinimumCells(static_cast<int>(3 * cells) + 3);
  filter->Update();
  EXPECT_EQ(Number(filter, "Faces"), 1);
  EXPECT_EQ(Number(filter, "Loops"), 2);
  filter->SetMaximumGap(1.0);
  filter->Update();
  EXPECT_EQ(Number(filter, "Faces"), 1);
  EXPECT_EQ(Number(filter, "Loops"), 1);
}

TEST(SplineTrimToPointsFilter, BadInput_ExactOracle)
{
  vtkNew<vtkSplineTrimToPoints> filter;
  filter->SetPointsData(LatticeWithHole());
  filter->SetInputDataObject(0, ShapeGrid(vtkSplineSource::CUBE));
  ExpectFailure(filter, ErrorCode::DimensionMismatch, "one surface");
  filter->SetInputDataObject(0, GridOfPatches(FourTiles(0.0)));
  ExpectFailure(filter, ErrorCode::DimensionMismatch, "one surface");
  filter->SetInputDataObject(0, ShapeGrid(vtkSplineSource::CYLINDER_SURFACE));
  ExpectFailure(filter, ErrorCode::InvalidParameter, "UV");
  filter->SetInputDataObject(0, FlatSurface());
  vtkNew<vtkPolyData> nothing;
  filter->SetPointsData(nothing);
  ExpectFailure(filter, ErrorCode::EmptyInput, "three points");
  filter->SetPointsData(LatticeWithHole());
  filter->SetCellSize(1e-6);
  ExpectFailure(filter, ErrorCode::TooLarge, "larger cell size");
  filter->SetCellSize(0.0);
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError) << "the filter works again";
}

TEST(SplineTrimToPointsFilter, ReportsProgressAndAborts_PropertyOracle)
{
  vtkNew<vtkSplineTrimToPoints> filter;
  filter->SetInputDataObject(0, FlatSurface());
  filter->SetPointsData(LatticeWithHole());
  ExpectProgressAndAbort(filter, 1);
}
