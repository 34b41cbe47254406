// SPDX-License-Identifier: BSD-3-Clause
// One picture of every filter that draws.
#include "Rendering.h"
#include "vtkSplineControlNet.h"
#include "vtkSplineParametricMesh.h"
#include "vtkSplineRefine.h"
#include "vtkSplineSource.h"

#include "vtkDataSetSurfaceFilter.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkSphere.h"
#include "vtkTubeFilter.h"
#include "vtkUnstructuredGrid.h"

using namespace knotwork;

namespace
{
/// The plate with a hole, refined around a point of its rim.
void RefinePlate(vtkSplineSource* source, vtkSplineRefine* refine)
{
  source->SetShape(vtkSplineSource::QUARTER_PLATE_WITH_HOLE);
  source->SetInnerRadius(0.4);
  source->SetSize(2.0, 2.0, 1.0);
  source->SetDegree(2);
  source->SetElements(4, 4, 1);
  vtkNew<vtkSphere> sphere;
  sphere->SetCenter(0.0, 0.4, 0.0);
  sphere->SetRadius(0.1);
  refine->SetInputConnection(source->GetOutputPort());
  refine->SetMode(vtkSplineRefine::IMPLICIT_FUNCTION);
  refine->SetImplicitFunction(sphere);
  refine->SetNumberOfRefinements(3);
}
}

TEST(SplineImages, Source_GoldenOracle)
{
  vtkNew<vtkSplineSource> source;
  source->SetShape(vtkSplineSource::SOLID_TORUS);
  source->SetAngle(270.0);
  source->SetOuterRadius(1.5);
  source->SetInnerRadius(0.6);
  vtkNew<vtkDataSetSurfaceFilter> surface;
  surface->SetInputConnection(source->GetOutputPort());
  surface->SetNonlinearSubdivisionLevel(4);
  surface->Update();
  RenderOptions options;
  options.From = { 1.0, -2.0, 1.5 };
  options.Up = { 0.0, 0.0, 1.0 };
  options.ColorBy = "PatchId";
  options.Edges = false;
  EXPECT_TRUE(RenderAndCompare(surface->GetOutput(), "SplineSource", options));
}

TEST(SplineImages, Refine_GoldenOracle)
{
  vtkNew<vtkSplineSource> source;
  vtkNew<vtkSplineRefine> refine;
  RefinePlate(source, refine);
  vtkNew<vtkDataSetSurfaceFilter> surface;
  surface->SetInputConnection(refine->GetOutputPort());
  surface->SetNonlinearSubdivisionLevel(3);
  surface->Update();
  RenderOptions options;
  options.ColorBy = "Level";
  options.Edges = false;
  EXPECT_TRUE(RenderAndCompare(surface->GetOutput(), "SplineRefine", options));
}

TEST(SplineImages, ControlNet_GoldenOracle)
{
  vtkNew<vtkSplineSource> source;
  vtkNew<vtkSplineRefine> refine;
  RefinePlate(source, refine);
  vtkNew<vtkSplineControlNet> net;
  net->SetInputConnection(refine->GetOutputPort());
  net->VerticesOff();
  vtkNew<vtkTubeFilter> tubes;
  tubes->SetInputConnection(net->GetOutputPort());
  tubes->SetRadius(0.004);
  tubes->Update();
  RenderOptions options;
  options.ColorBy = "Level";
  options.Edges = false;
  EXPECT_TRUE(RenderAndCompare(tubes->GetOutput(), "SplineControlNet", options));
}

TEST(SplineImages, ParametricMesh_GoldenOracle)
{
  vtkNew<vtkSplineSource> source;
  vtkNew<vtkSplineRefine> refine;
  RefinePlate(source, refine);
  vtkNew<vtkSplineParametricMesh> mesh;
  mesh->SetInputConnection(refine->GetOutputPort());
  vtkNew<vtkDataSetSurfaceFilter> surface;
  surface->SetInputConnection(mesh->GetOutputPort());
  surface->Update();
  RenderOptions options;
  options.ColorBy = "Level";
  EXPECT_TRUE(RenderAndCompare(surface->GetOutput(), "SplineParametricMesh", options));
}
