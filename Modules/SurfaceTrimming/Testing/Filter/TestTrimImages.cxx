// SPDX-License-Identifier: BSD-3-Clause
// Pictures of trimmed surfaces.
#include "HeightTiles.h"
#include "Rendering.h"
#include <knotwork/SplineGrid/vtkSplineTessellate.h>
#include <knotwork/SurfaceTrimming/vtkFaceIntersections.h>
#include <knotwork/SurfaceTrimming/vtkSplineTrimToPoints.h>

#include "vtkActor.h"
#include "vtkCamera.h"

#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"

#include <cmath>

using namespace knotwork;

TEST(TrimImages, TrimToPoints_GoldenOracle)
{
  // a lattice with a round hole and a corner that is missing
  vtkNew<vtkPoints> points;
  for (int i = 0; i < 61 * 61; ++i)
  {
    const double x = (i % 61) / 30.0;
    const double y = (i / 61) / 30.0;
    if (std::hypot(x - 0.7, y - 1.2) > 0.35 && x + y < 3.3)
    {
      points->InsertNextPoint(x, y, 0.0);
    }
  }
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(points);
  vtkNew<vtkSplineTrimToPoints> trim;
  trim->SetInputDataObject(0,
    GridOfPatches({ HeightTile(0, { { 0, 0 }, { 2, 2 } }, 5,
      [](double u, double v) { return 0.2 * std::sin(2 * u) * v; }) }));
  trim->SetPointsData(cloud);
  trim->Update();
  RenderOptions options;
  options.From = { -0.5, -1.0, 1.6 };
  options.Up = { 0.0, 0.0, 1.0 };
  EXPECT_TRUE(RenderAndCompare(
    vtkPolyData::SafeDownCast(trim->GetOutputDataObject(0)), "SplineTrimToPoints", options));
}

// Two height fields that cross, and a ball where it is found that they do.
TEST(TrimImages, FaceIntersections_GoldenOracle)
{
  const auto grid = GridOfPatches(
    { HeightTile(0, { { 0, 0 }, { 2, 2 } }, 8,
        [](double u, double v) { return 0.3 * std::sin(3.0 * u) * std::cos(2.0 * v); }),
      HeightTile(1, { { 0, 0 }, { 2, 2 } }, 8,
        [](double u, double v) { return 0.25 + 0.1 * std::cos(2.0 * (u + v)); }) });
  vtkNew<vtkFaceIntersections> intersections;
  intersections->SetInputDataObject(grid);
  intersections->Update();
  auto* points = vtkPolyData::SafeDownCast(intersections->GetOutputDataObject(0));
  ASSERT_EQ(points->GetNumberOfPoints(), 1);
  vtkNew<vtkSplineTessellate> tessellate;
  tessellate->SetInputDataObject(grid);
  tessellate->SetChordalTolerance(1e-3);
  vtkNew<vtkSphereSource> ball;
  ball->SetCenter(points->GetPoint(0));
  ball->SetRadius(0.07);
  ball->SetThetaResolution(24);
  ball->SetPhiResolution(24);
  vtkNew<vtkRenderer> renderer;
  const auto add = [&](vtkAlgorithm* source, double red, double green, double blue)
  {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(source->GetOutputPort());
    mapper->ScalarVisibilityOff();
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->SetColor(red, green, blue);
    actor->GetProperty()->SetAmbient(0.3);
    actor->GetProperty()->SetDiffuse(0.7);
    renderer->AddActor(actor);
  };
  add(tessellate, 0.6, 0.7, 0.8);
  add(ball, 0.85, 0.1, 0.1);
  renderer->GetActiveCamera()->SetPosition(2.5, -3.5, 4.0);
  renderer->GetActiveCamera()->SetFocalPoint(1.0, 1.0, 0.0);
  renderer->GetActiveCamera()->SetViewUp(0.0, 0.0, 1.0);
  renderer->ResetCamera();
  EXPECT_TRUE(RenderAndCompare(renderer, "FaceIntersections", 400));
}
