// SPDX-License-Identifier: BSD-3-Clause
// Pictures of what is done with fitted surfaces side by side.
#include "HeightTiles.h"
#include "Rendering.h"
#include <knotwork/SplineGrid/vtkSplineTessellate.h>
#include <knotwork/SurfaceFitting/vtkSplineStitch.h>

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkNew.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkTrivialProducer.h"

using namespace knotwork;

namespace
{
void AddSurface(vtkRenderer* renderer, vtkAlgorithmOutput* surface, double shift)
{
  vtkNew<vtkSplineTessellate> tessellate;
  tessellate->SetInputConnection(surface);
  tessellate->SetChordalTolerance(2e-3);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(tessellate->GetOutputPort());
  mapper->ScalarVisibilityOff();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->SetPosition(0.0, shift, 0.0);
  actor->GetProperty()->SetColor(0.45, 0.7, 0.95);
  actor->GetProperty()->SetSpecular(0.6);
  actor->GetProperty()->SetSpecularPower(30.0);
  renderer->AddActor(actor);
}
}

TEST(TileImages, Stitch_GoldenOracle)
{
  // behind as they came, in front smooth across their edges
  vtkNew<vtkTrivialProducer> tiles;
  const auto grid = GridOfPatches(FourTiles(0.06));
  tiles->SetOutput(grid);
  vtkNew<vtkSplineStitch> stitch;
  stitch->SetInputConnection(tiles->GetOutputPort());
  vtkNew<vtkRenderer> renderer;
  AddSurface(renderer, tiles->GetOutputPort(), 0.0);
  AddSurface(renderer, stitch->GetOutputPort(), -2.3);
  renderer->GetActiveCamera()->SetPosition(2.0, -7.0, 6.5);
  renderer->GetActiveCamera()->SetFocalPoint(1.0, -0.6, 0.0);
  renderer->GetActiveCamera()->SetViewUp(0.0, 0.0, 1.0);
  renderer->ResetCamera();
  renderer->GetActiveCamera()->Zoom(1.15);
  EXPECT_TRUE(RenderAndCompare(renderer, "SplineStitch", 400));
}
