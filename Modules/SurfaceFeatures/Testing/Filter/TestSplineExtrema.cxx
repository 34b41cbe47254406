// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SurfaceFeatures/vtkSplineExtrema.h>

#include "FilterCases.h"
#include "HeightTiles.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/LRSpace.h>
#include <knotwork/SurfaceFeatures/CriticalPoints.h>

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <cmath>

using namespace knotwork;

namespace
{
double Hills(double u, double v)
{
  return std::sin(6.0 * u + 0.5) * std::cos(5.0 * v) + 0.3 * u * v;
}

std::vector<SplinePatch> TwoPatches()
{
  return { HeightTile(0, { { 0.0, 0.0 }, { 2.0, 2.0 } }, 9, Hills),
    HeightTile(7, { { 3.0, 0.0 }, { 4.0, 1.0 } }, 5,
      [](double u, double v) { return (u - 3.4) * (u - 3.4) + (v + 0.2) * (v + 0.2); }) };
}

int Number(vtkSplineExtrema* filter, const char* name)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(2))->GetValueByName(0, name).ToInt();
}

vtkPolyData* Output(vtkSplineExtrema* filter, int port)
{
  return vtkPolyData::SafeDownCast(filter->GetOutputDataObject(port));
}

double At(vtkDataArray* array, vtkIdType tuple, int component = 0)
{
  return array->GetComponent(tuple, component);
}
}

TEST(SplineExtremaFilter, Defaults_ExactOracle)
{
  vtkNew<vtkSplineExtrema> filter;
  EXPECT_EQ(filter->GetFieldName(), nullptr);
  EXPECT_EQ(filter->GetComponent(), 2);
  EXPECT_TRUE(filter->GetMinima() && filter->GetMaxima() && filter->GetSaddles());
  EXPECT_TRUE(filter->GetBoundary() && filter->GetOnSurface());
  EXPECT_EQ(filter->GetMaximumDepth(), 32);
  EXPECT_EQ(filter->GetMaximumBoxes(), 64);
}

TEST(SplineExtremaFilter, PointsBoxesAndNumbersAreTheKernels_CrossOracle)
{
  const std::vector<SplinePatch> patches = TwoPatches();
  vtkNew<vtkSplineExtrema> filter;
  filter->SetInputDataObject(GridOfPatches(patches));
  filter->Update();
  vtkPolyData* points = Output(filter, 0);
  vtkPolyData* boxes = Output(filter, 1);
  vtkPointData* data = points->GetPointData();
  vtkIdType id = 0;
  int sum = 0;
  for (const SplinePatch& patch : patches)
  {
    CriticalPointParams params;
    params.Component = 2;
    const auto& surface = std::get<Spline<2>>(patch.Geometry);
    const auto found = FindCriticalPoints(surface, params);
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->Proved);
    sum += found->IndexSum;
    for (const CriticalPoint& point : found->Points)
    {
      ASSERT_LT(id, points->GetNumberOfPoints());
      EXPECT_EQ(At(data->GetArray("Kind"), id), static_cast<int>(point.Kind));
      EXPECT_EQ(At(data->GetArray("Place"), id), static_cast<int>(point.Place));
      EXPECT_EQ(At(data->GetArray("Value"), id), point.Value);
      EXPECT_EQ(At(data->GetArray("ValueBounds"), id, 1), point.ValueBounds[1]);
      EXPECT_EQ(At(data->GetArray("Parameters"), id, 1), point.Parameters[1]);
      EXPECT_EQ(At(data->GetArray("Eigenvalues"), id), point.Eigenvalues[0]);
      EXPECT_EQ(At(data->GetArray("Index"), id), point.Index);
      EXPECT_EQ(At(data->GetArray("InwardSign"), id), point.InwardSign);
      EXPECT_EQ(At(data->GetArray("ElementId"), id), point.Element);
      EXPECT_EQ(At(data->GetArray("PatchId"), id), patch.Id);
      // the surface is (u, v, z)
      double x[3];
      points->GetPoint(id, x);
      EXPECT_NEAR(x[0], point.Parameters[0], 1e-13);
      EXPECT_NEAR(x[1], point.Parameters[1], 1e-13);
      EXPECT_NEAR(x[2], point.Value, 1e-12);
      vtkCellData* cells = boxes->GetCellData();
      EXPECT_EQ(At(cells->GetArray("Unique"), id), 1);
      EXPECT_EQ(At(cells->GetArray("PointId"), id), static_cast<double>(id));
      EXPECT_EQ(At(cells->GetArray("ParametricBounds"), id, 0), point.Box.Lower[0]);
      EXPECT_EQ(At(cells->GetArray("ParametricBounds"), id, 3), point.Box.Upper[1]);
      ++id;
    }
  }
  EXPECT_EQ(id, points->GetNumberOfPoints());
  EXPECT_EQ(points->GetNumberOfVerts(), id);
  EXPECT_EQ(boxes->GetNumberOfPolys(), id);
  EXPECT_EQ(Number(filter, "Minima") + Number(filter, "Maxima") + Number(filter, "Saddles"), id);
  EXPECT_GT(Number(filter, "Saddles"), 3);
  EXPECT_EQ(Number(filter, "IndexSum"), sum);
  EXPECT_EQ(Number(filter, "EulerCharacteristic"), 2);
  EXPECT_EQ(Number(filter, "Clusters"), 0);
  EXPECT_EQ(Number(filter, "Proved"), 1);
}

TEST(SplineExtremaFilter, KindsAreChosen_PropertyOracle)
{
  vtkNew<vtkSplineExtrema> filter;
  filter->SetInputDataObject(GridOfPatches(TwoPatches()));
  filter->MaximaOff();
  filter->SaddlesOff();
  filter->OnSurfaceOff();
  filter->Update();
  EXPECT_EQ(Output(filter, 0)->GetNumberOfPoints(), Number(filter, "Minima"));
  EXPECT_EQ(Output(filter, 1)->GetNumberOfCells(), Number(filter, "Minima"));
  EXPECT_GT(Number(filter, "Saddles"), 0); // counted, not shown
  double bounds[6];
  Output(filter, 0)->GetBounds(bounds);
  EXPECT_EQ(bounds[4], 0.0);
  EXPECT_EQ(bounds[5], 0.0);
  const int all = Number(filter, "Minima");
  const int onBoundary = Number(filter, "OnBoundary");
  filter->MaximaOn();
  filter->SaddlesOn();
  filter->MinimaOff();
  filter->Update();
  EXPECT_EQ(Number(filter, "Minima"), all); // counted, not shown
  EXPECT_EQ(
    Output(filter, 0)->GetNumberOfPoints(), Number(filter, "Maxima") + Number(filter, "Saddles"));
  filter->MinimaOn();
  filter->BoundaryOff();
  filter->Update();
  EXPECT_EQ(Number(filter, "OnBoundary"), 0);
  EXPECT_LT(Number(filter, "Minima"), all);
  EXPECT_GT(onBoundary, 0);
}

// A valley along a curve is one cluster of critical points; limits say how coarse its boxes are.
TEST(SplineExtremaFilter, LimitsOfTheSearchReachTheKernel_CrossOracle)
{
  const auto patches = std::vector<SplinePatch>{ HeightTile(
    0, { { 0.0, 0.0 }, { 1.0, 1.0 } }, 4, [](double u, double) { return (u - 0.7) * (u - 0.7); }) };
  double widths[3];
  const std::array<std::array<int, 2>, 3> limits{ { { 32, 64 }, { 32, 4 }, { 2, 64 } } };
  for (std::size_t k = 0; k < limits.size(); ++k)
  {
    vtkNew<vtkSplineExtrema> filter;
    filter->SetInputDataObject(GridOfPatches(patches));
    filter->SetMaximumDepth(limits[k][0]);
    filter->SetMaximumBoxes(limits[k][1]);
    filter->Update();
    CriticalPointParams params;
    params.Component = 2;
    params.MaxDepth = limits[k][0];
    params.MaxBoxes = limits[k][1];
    const auto kernel = FindCriticalPoints(std::get<Spline<2>>(patches[0].Geometry), params);
    ASSERT_TRUE(kernel) << kernel.Status.Message();
    EXPECT_EQ(Number(filter, "Clusters"), static_cast<int>(kernel->Clusters.size()));
    EXPECT_GT(Number(filter, "Clusters"), 0);
    widths[k] = 0.0; // area of all boxes
    vtkDataArray* bounds = Output(filter, 1)->GetCellData()->GetArray("ParametricBounds");
    for (vtkIdType c = 0; c < bounds->GetNumberOfTuples(); ++c)
    {
      widths[k] += (At(bounds, c, 1) - At(bounds, c, 0)) * (At(bounds, c, 3) - At(bounds, c, 2));
    }
  }
  EXPECT_GT(widths[1], widths[0]);
  EXPECT_GT(widths[2], widths[0]);
}

TEST(SplineExtremaFilter, AFieldOfOneComponent_CrossOracle)
{
  std::vector<SplinePatch> patches = TwoPatches();
  for (SplinePatch& patch : patches)
  {
    // the height with its sign turned
    const auto& surface = std::get<Spline<2>>(patch.Geometry);
    patch.Fields[0].Coefficients = -surface.ControlPoints.col(2);
  }
  vtkNew<vtkSplineExtrema> heights;
  heights->SetInputDataObject(GridOfPatches(patches));
  heights->Update();
  vtkNew<vtkSplineExtrema> field;
  field->SetInputDataObject(GridOfPatches(patches));
  field->SetFieldName("Slope");
  field->Update();
  EXPECT_EQ(Number(field, "Minima"), Number(heights, "Maxima"));
  EXPECT_EQ(Number(field, "Maxima"), Number(heights, "Minima"));
  EXPECT_EQ(Number(field, "Saddles"), Number(heights, "Saddles"));
}

TEST(SplineExtremaFilter, ClustersAreBoxes_ExactOracle)
{
  // z = u^2 on [-1, 1]^2
  SplinePatch patch =
    HeightTile(0, { { -1.0, -1.0 }, { 1.0, 1.0 } }, 4, [](double, double) { return 0.0; });
  auto& surface = std::get<Spline<2>>(patch.Geometry);
  const LRBasis& basis = surface.Space->LocallyRefined->Basis;
  for (int f = 0; f < basis.NumFunctions(); ++f)
  {
    const int* local = basis.Local(f, 0);
    surface.ControlPoints(f, 2) = basis.Knots[0][static_cast<std::size_t>(local[1])] *
      basis.Knots[0][static_cast<std::size_t>(local[2])];
  }
  vtkNew<vtkSplineExtrema> filter;
  filter->SetInputDataObject(GridOfPatches({ patch }));
  filter->Update();
  EXPECT_EQ(Number(filter, "Proved"), 0);
  EXPECT_GE(Number(filter, "Clusters"), 1);
  vtkPolyData* boxes = Output(filter, 1);
  EXPECT_EQ(Number(filter, "ClusterBoxes"), boxes->GetNumberOfPolys());
  EXPECT_EQ(At(boxes->GetCellData()->GetArray("Unique"), 0), 0);
  EXPECT_EQ(At(boxes->GetCellData()->GetArray("PointId"), 0), -1);
  EXPECT_GE(At(boxes->GetCellData()->GetArray("ClusterId"), 0), 0);
}

TEST(SplineExtremaFilter, ACollectionIsOneResult_CrossOracle)
{
  const std::vector<SplinePatch> patches = TwoPatches();
  vtkNew<vtkSplineExtrema> one;
  one->SetInputDataObject(GridOfPatches(patches));
  one->Update();
  vtkNew<vtkSplineExtrema> many;
  many->SetInputDataObject(
    Collect({ GridOfPatches({ patches[0] }), GridOfPatches({ patches[1] }) }));
  many->Update();
  EXPECT_EQ(Output(one, 0)->GetNumberOfPoints(), Output(many, 0)->GetNumberOfPoints());
  vtkDataArray* block = Output(many, 0)->GetPointData()->GetArray("Block");
  EXPECT_EQ(At(block, 0), 0);
  EXPECT_EQ(At(block, block->GetNumberOfTuples() - 1), 1);
}

TEST(SplineExtremaFilter, EveryFailureIsReachable_ExactOracle)
{
  vtkNew<vtkSplineExtrema> filter;
  filter->SetInputDataObject(GridOfPatches(TwoPatches()));
  filter->SetComponent(3);
  ExpectFailure(filter, ErrorCode::InvalidParameter, "has 3 components");
  filter->SetComponent(2);
  filter->SetFieldName("Depth");
  ExpectFailure(filter, ErrorCode::InvalidParameter, "patch 0 has no field 'Depth'");
  filter->SetFieldName("");
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::CUBE));
  ExpectFailure(filter, ErrorCode::DimensionMismatch, "patch 0 is no surface");
}

TEST(SplineExtremaFilter, ReportsProgressAndAborts_PropertyOracle)
{
  vtkNew<vtkSplineExtrema> filter;
  filter->SetInputDataObject(GridOfPatches(TwoPatches()));
  ExpectProgressAndAbort(filter, 1);
}

TEST(SplineExtremaFilter, BadInputIsRefused_PropertyOracle)
{
  vtkNew<vtkSplineExtrema> filter;
  filter->SetComponent(0); // the plane sectors are a plateau of z
  ExpectBadInputIsRefused(filter);
}
