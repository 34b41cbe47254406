// SPDX-License-Identifier: BSD-3-Clause
// Pictures of contours.
#include "HeightTiles.h"
#include "Rendering.h"
#include <knotwork/SplineGrid/vtkSplineTessellate.h>
#include <knotwork/SurfaceFeatures/vtkSplineContour.h>

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"

#include <cmath>

using namespace knotwork;

TEST(ContourImages, EightHillsAndTheirSaddles_GoldenOracle)
{
  vtkNew<vtkSplineContour> contour;
  contour->SetInputData(GridOfPatches({ HeightTile(0, { { 0.0, 0.0 }, { 2.0, 2.0 } }, 24,
    [](double u, double v)
    { return 0.12 * std::sin(7.0 * u) * std::sin(6.0 * v) + 0.08 * std::cos(11.0 * u * v); }) }));
  contour->SetNumberOfLevels(14);
  vtkNew<vtkSplineTessellate> tessellate;
  tessellate->SetInputData(contour->GetInputDataObject(0, 0));
  tessellate->SetChordalTolerance(1e-3);
  vtkNew<vtkRenderer> renderer;
  for (vtkAlgorithm* part : std::initializer_list<vtkAlgorithm*>{ contour, tessellate })
  {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(part->GetOutputPort());
    mapper->ScalarVisibilityOff();
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    const bool lines = part == contour;
    actor->GetProperty()->SetColor(lines ? 0.05 : 0.6, lines ? 0.1 : 0.8, lines ? 0.3 : 0.55);
    actor->GetProperty()->SetLineWidth(2.0);
    actor->GetProperty()->SetLighting(!lines);
    actor->SetPosition(0.0, 0.0, lines ? 0.004 : 0.0);
    renderer->AddActor(actor);
  }
  renderer->GetActiveCamera()->SetPosition(1.0, -2.2, 3.2);
  renderer->GetActiveCamera()->SetFocalPoint(1.0, 1.0, 0.0);
  renderer->GetActiveCamera()->SetViewUp(0.0, 0.0, 1.0);
  renderer->ResetCamera();
  renderer->GetActiveCamera()->Zoom(1.25);
  EXPECT_TRUE(RenderAndCompare(renderer, "SplineContour", 400));
}
