// SPDX-License-Identifier: BSD-3-Clause
// The verdicts of the kernel are tested there; here: what the filter gives out.
#include "FilterCases.h"
#include "ModelCases.h"
#include "TrimmedGrids.h"
#include <knotwork/SplineCore/Shapes.h>
#include <knotwork/SplineGrid/vtkSplineSource.h>
#include <knotwork/SurfaceTrimming/vtkFaceIntersections.h>

#include "vtkDataArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVariant.h"

using namespace knotwork;

namespace
{
/// A sphere, and where asked for a square of side 4 at a height through it.
vtkSmartPointer<vtkUnstructuredGrid> SphereAndPlate(bool hasPlate, double height)
{
  TrimmedModel model;
  ShapeParams params;
  params.Kind = ShapeKind::PolarSphereSurface;
  params.Angle = 360.0;
  model.Faces.emplace_back().Surface = std::get<Spline<2>>(MakeShape(params).Value.front());
  if (hasPlate)
  {
    params = {};
    params.Size = { 4.0, 4.0, 1.0 };
    params.Center = { 0.0, 0.0, height };
    model.Faces.emplace_back().Surface = std::get<Spline<2>>(MakeShape(params).Value.front());
  }
  vtkNew<vtkUnstructuredGrid> surfaces;
  vtkNew<vtkUnstructuredGrid> curves;
  EXPECT_TRUE(EncodeTrimmedModel(model, surfaces, curves));
  return surfaces.Get();
}

std::string Verdict(vtkFaceIntersections* filter)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(1))
    ->GetValueByName(0, "Verdict")
    .ToString();
}
}

TEST(vtkFaceIntersections, PointsAndNumbers_Exact)
{
  vtkNew<vtkFaceIntersections> filter;
  filter->SetInputDataObject(SphereAndPlate(false, 0.0));
  filter->Update();
  EXPECT_EQ(Verdict(filter), "absent");
  filter->SetInputDataObject(SphereAndPlate(true, 0.25));
  filter->Update();
  EXPECT_EQ(Verdict(filter), "found");
  auto* points = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_EQ(points->GetNumberOfPoints(), 1);
  EXPECT_EQ(points->GetNumberOfVerts(), 1);
  double x[3];
  points->GetPoint(0, x);
  EXPECT_NEAR(x[2], 0.25, 1e-9);
  EXPECT_NEAR(x[0] * x[0] + x[1] * x[1], 1.0 - 0.0625, 1e-9);
  const double* faces = points->GetPointData()->GetArray("Faces")->GetTuple2(0);
  EXPECT_EQ(faces[0], 0.0);
  EXPECT_EQ(faces[1], 1.0);
  EXPECT_EQ(points->GetPointData()->GetArray("Verdict")->GetTuple1(0), 2.0);
  auto* table = vtkTable::SafeDownCast(filter->GetOutputDataObject(1));
  EXPECT_EQ(table->GetValueByName(0, "Found").ToInt(), 1);
  EXPECT_EQ(table->GetValueByName(0, "Undecided").ToInt(), 0);
  EXPECT_EQ(table->GetValueByName(0, "Faces").ToInt(), 2);
  EXPECT_GT(table->GetValueByName(0, "Tolerance").ToDouble(), 0.0);
  // beside it, and with few pairs
  filter->SetInputDataObject(SphereAndPlate(true, 1.1));
  filter->Update();
  EXPECT_EQ(Verdict(filter), "absent");
  filter->SetMaximumPairs(1);
  filter->Update();
  EXPECT_EQ(Verdict(filter), "undecided");
}

TEST(vtkFaceIntersections, Errors)
{
  vtkNew<vtkFaceIntersections> filter;
  vtkNew<vtkUnstructuredGrid> empty;
  filter->SetInputDataObject(empty);
  ExpectFailure(filter, ErrorCode::EmptyInput, "surfaces");
  filter->SetInputDataObject(ShapeGrid(static_cast<int>(ShapeKind::Cube)));
  ExpectFailure(filter, ErrorCode::DimensionMismatch, "");
}

TEST(vtkFaceIntersections, ProgressAndAbort)
{
  vtkNew<vtkFaceIntersections> filter;
  filter->SetInputDataObject(SphereAndPlate(true, 0.25));
  ExpectProgressAndAbort(filter, 1);
}
