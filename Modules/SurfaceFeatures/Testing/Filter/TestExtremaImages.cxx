// SPDX-License-Identifier: BSD-3-Clause
// Summits, pits and passes on a surface, with their boxes.
#include "HeightTiles.h"
#include "Rendering.h"
#include <knotwork/SplineGrid/vtkSplineTessellate.h>
#include <knotwork/SurfaceFeatures/vtkSplineExtrema.h>

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkGlyph3D.h"
#include "vtkLookupTable.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"

#include <cmath>

using namespace knotwork;

namespace
{
void AddSurface(vtkRenderer* renderer, vtkUnstructuredGrid* grid)
{
  vtkNew<vtkSplineTessellate> tessellate;
  tessellate->SetInputDataObject(grid);
  tessellate->SetChordalTolerance(1e-3);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(tessellate->GetOutputPort());
  mapper->ScalarVisibilityOff();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(0.6, 0.7, 0.8);
  actor->GetProperty()->SetAmbient(0.3);
  actor->GetProperty()->SetDiffuse(0.7);
  renderer->AddActor(actor);
}

/// Balls in the colours of the kinds.
void AddPoints(vtkRenderer* renderer, vtkSplineExtrema* extrema)
{
  vtkNew<vtkSphereSource> ball;
  ball->SetRadius(0.035);
  ball->SetThetaResolution(24);
  ball->SetPhiResolution(24);
  extrema->Update();
  auto* points = vtkPolyData::SafeDownCast(extrema->GetOutputDataObject(0));
  points->GetPointData()->SetActiveScalars("Kind");
  vtkNew<vtkGlyph3D> balls;
  balls->SetInputData(points);
  balls->SetSourceConnection(ball->GetOutputPort());
  balls->SetScaleModeToDataScalingOff();
  balls->SetColorModeToColorByScalar();
  vtkNew<vtkLookupTable> colours;
  colours->SetNumberOfTableValues(3);
  colours->SetTableRange(0.0, 2.0);
  colours->SetTableValue(0, 0.0, 0.3, 0.8);
  colours->SetTableValue(1, 0.8, 0.1, 0.1);
  colours->SetTableValue(2, 0.95, 0.8, 0.1);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(balls->GetOutputPort());
  mapper->SetLookupTable(colours);
  mapper->UseLookupTableScalarRangeOn();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  renderer->AddActor(actor);
}
}

TEST(ExtremaImages, Extrema_GoldenOracle)
{
  const auto grid = GridOfPatches({ HeightTile(0, { { 0.0, 0.0 }, { 2.0, 2.0 } }, 12,
    [](double u, double v) { return 0.3 * std::sin(5.0 * u + 0.5) * std::cos(4.0 * v); }) });
  vtkNew<vtkSplineExtrema> extrema;
  extrema->SetInputDataObject(grid);
  vtkNew<vtkRenderer> renderer;
  AddSurface(renderer, grid);
  AddPoints(renderer, extrema);
  renderer->GetActiveCamera()->SetPosition(2.5, -3.5, 4.5);
  renderer->GetActiveCamera()->SetFocalPoint(1.0, 1.0, 0.0);
  renderer->GetActiveCamera()->SetViewUp(0.0, 0.0, 1.0);
  renderer->ResetCamera();
  renderer->GetActiveCamera()->Zoom(1.0);
  EXPECT_TRUE(RenderAndCompare(renderer, "SplineExtrema", 400));
}
