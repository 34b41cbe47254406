// SPDX-License-Identifier: BSD-3-Clause
// Pictures of remeshed surfaces.
#include "Rendering.h"
#include <knotwork/SurfaceRemeshing/vtkSurfaceRemesh.h>

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkCylinderSource.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"

using namespace knotwork;

// A cylinder by curvature: small triangles around, larger ones within the ends, its sharp edges.
TEST(RemeshImages, SurfaceRemesh_GoldenOracle)
{
  vtkNew<vtkCylinderSource> cylinder;
  cylinder->SetResolution(48);
  vtkNew<vtkSurfaceRemesh> remesh;
  remesh->SetInputConnection(cylinder->GetOutputPort());
  remesh->SetSizing(vtkSurfaceRemesh::CURVATURE);
  remesh->SetTolerance(0.003);
  vtkNew<vtkRenderer> renderer;
  for (int port = 0; port < 2; ++port)
  {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(remesh->GetOutputPort(port));
    mapper->ScalarVisibilityOff();
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->LightingOff();
    if (port == 0)
    {
      actor->GetProperty()->SetColor(0.85, 0.85, 0.8);
      actor->GetProperty()->EdgeVisibilityOn();
    }
    else
    {
      actor->GetProperty()->SetColor(0.85, 0.15, 0.1);
      actor->GetProperty()->SetLineWidth(4.0F);
    }
    renderer->AddActor(actor);
  }
  renderer->SetBackground(1.0, 1.0, 1.0);
  renderer->GetActiveCamera()->SetPosition(0.5, 1.5, 3.0);
  renderer->ResetCamera();
  EXPECT_TRUE(RenderAndCompare(renderer, "SurfaceRemesh", 400));
}
