// SPDX-License-Identifier: BSD-3-Clause
// Pictures of surfaces against each other and against points.
#include "HeightTiles.h"
#include "Rendering.h"
#include <knotwork/SplineGrid/vtkSplineTessellate.h>
#include <knotwork/SurfaceFitting/vtkSplineCombine.h>
#include <knotwork/SurfaceFitting/vtkSplinePointDistance.h>

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkElevationFilter.h"
#include "vtkLookupTable.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkTrivialProducer.h"
#include "vtkVertexGlyphFilter.h"

#include <cmath>

using namespace knotwork;

namespace
{
const ParametricBox<2> Box{ { 0, 0 }, { 2, 1.4 } };

double Ground(double u, double v)
{
  return 0.15 * std::sin(2.5 * u) * std::cos(2.0 * v);
}

double Hill(double u, double v, double atU, double atV)
{
  return 0.25 * std::exp(-18.0 * ((u - atU) * (u - atU) + (v - atV) * (v - atV)));
}

/// Blue below, grey at, red above zero.
void ColourBySign(vtkPolyDataMapper* mapper, double largest, double grey)
{
  constexpr int Half = 32;
  vtkNew<vtkLookupTable> table;
  table->SetNumberOfTableValues(2 * Half + 1);
  for (int i = -Half; i <= Half; ++i)
  {
    const double share = static_cast<double>(std::abs(i)) / Half;
    const double fade = grey * (1.0 - share);
    const double full = fade + 0.9 * share;
    table->SetTableValue(i + Half, i > 0 ? full : fade, fade + 0.2 * share, i < 0 ? full : fade);
  }
  mapper->SetLookupTable(table);
  mapper->SetScalarRange(-largest, largest);
  mapper->ScalarVisibilityOn();
}

/// The surface at a shift in y; colours by height when a largest height is given.
vtkSmartPointer<vtkActor> AddSurface(
  vtkRenderer* renderer, vtkAlgorithmOutput* surface, double shift, double largest)
{
  vtkNew<vtkSplineTessellate> tessellate;
  tessellate->SetInputConnection(surface);
  tessellate->SetChordalTolerance(1e-3);
  vtkNew<vtkElevationFilter> elevation;
  elevation->SetInputConnection(tessellate->GetOutputPort());
  elevation->SetLowPoint(0.0, 0.0, -1.0);
  elevation->SetHighPoint(0.0, 0.0, 1.0);
  elevation->SetScalarRange(-1.0, 1.0);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(elevation->GetOutputPort());
  mapper->ScalarVisibilityOff();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->SetPosition(0.0, shift, 0.0);
  actor->GetProperty()->SetColor(0.62, 0.76, 0.56);
  actor->GetProperty()->SetAmbient(0.25);
  actor->GetProperty()->SetDiffuse(0.75);
  if (largest > 0.0)
  {
    ColourBySign(mapper, largest, 0.85);
  }
  renderer->AddActor(actor);
  return actor;
}

void LookFrom(vtkRenderer* renderer, double y, double z, double zoom)
{
  renderer->GetActiveCamera()->SetPosition(0.0, y, z);
  renderer->GetActiveCamera()->SetViewUp(0.0, 0.0, 1.0);
  renderer->ResetCamera();
  renderer->GetActiveCamera()->Zoom(zoom);
}
}

TEST(ComparisonImages, Combine_GoldenOracle)
{
  // from behind: before, after (a hill has come, a hollow was dug), what has changed
  vtkNew<vtkTrivialProducer> before;
  vtkNew<vtkTrivialProducer> after;
  const auto old = GridOfPatches({ HeightTile(0, Box, 16, Ground) });
  const auto now = GridOfPatches({ HeightTile(0, Box, 20,
    [](double u, double v)
    { return Ground(u, v) + Hill(u, v, 0.6, 0.7) - Hill(u, v, 1.4, 0.6); }) });
  before->SetOutput(old);
  after->SetOutput(now);
  vtkNew<vtkSplineCombine> combine;
  combine->SetInputConnection(after->GetOutputPort());
  combine->SetSecondConnection(before->GetOutputPort());
  vtkNew<vtkRenderer> renderer;
  AddSurface(renderer, before->GetOutputPort(), 3.4, 0.0);
  AddSurface(renderer, after->GetOutputPort(), 1.7, 0.0);
  AddSurface(renderer, combine->GetOutputPort(), 0.0, 0.25);
  LookFrom(renderer, -3.0, 3.6, 1.15);
  EXPECT_TRUE(RenderAndCompare(renderer, "SplineCombine", 400));
}

TEST(ComparisonImages, PointDistance_GoldenOracle)
{
  // points of a survey with a new hill and a hollow over the old surface: above it, below it,
  // within
  vtkNew<vtkTrivialProducer> surface;
  const auto grid = GridOfPatches({ HeightTile(0, Box, 16, Ground) });
  surface->SetOutput(grid);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int i = 0; i < 51 * 36; ++i)
  {
    const double x = (i % 51) / 25.0;
    const double y = (i / 51) / 25.0;
    points->InsertNextPoint(
      x, y, Ground(x, y) + 0.003 + Hill(x, y, 0.6, 0.7) - Hill(x, y, 1.4, 0.6));
  }
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(points);
  vtkNew<vtkVertexGlyphFilter> dots;
  dots->SetInputData(cloud);
  vtkNew<vtkSplinePointDistance> distance;
  distance->SetInputConnection(dots->GetOutputPort());
  distance->SetSurfaceConnection(surface->GetOutputPort());
  for (const double tolerance : { 0.02, 0.1, 0.2 })
  {
    distance->AddTolerance(tolerance);
  }
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(distance->GetOutputPort());
  mapper->SetScalarModeToUsePointFieldData();
  mapper->SelectColorArray("DistanceClass");
  ColourBySign(mapper, 3.0, 0.25);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetPointSize(4);
  actor->GetProperty()->LightingOff();
  vtkNew<vtkRenderer> renderer;
  // points below it are seen through it
  AddSurface(renderer, surface->GetOutputPort(), 0.0, 0.0)->GetProperty()->SetOpacity(0.4);
  renderer->AddActor(actor);
  LookFrom(renderer, -2.0, 2.2, 1.1);
  EXPECT_TRUE(RenderAndCompare(renderer, "SplinePointDistance", 400));
}
