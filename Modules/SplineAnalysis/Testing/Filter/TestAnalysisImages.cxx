// SPDX-License-Identifier: BSD-3-Clause
// Pictures of solved problems.
#include "Rendering.h"
#include <knotwork/SplineAnalysis/vtkSplineAnalysis.h>
#include <knotwork/SplineAnalysis/vtkSplineVersusMesh.h>
#include <knotwork/SplineGrid/vtkSplineSource.h>
#include <knotwork/SplineGrid/vtkSplineTessellate.h>

#include "vtkActor.h"
#include "vtkAppendFilter.h"
#include "vtkDataSetMapper.h"
#include "vtkLookupTable.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"

using namespace knotwork;

namespace
{
// Drawn along x.
const char* const Tension = R"({ "conditions": [
  { "on": { "where": "abs(x) < 1e-9" }, "displacement": [0, null] },
  { "on": { "where": "abs(y) < 1e-9" }, "displacement": [null, 0] },
  { "on": { "where": "x * nx + y * ny > 0.5" }, "traction": ["nx", 0] } ] })";

vtkSmartPointer<vtkSplineSource> Ring(int elements)
{
  auto source = vtkSmartPointer<vtkSplineSource>::New();
  source->SetShape(vtkSplineSource::ANNULUS_SECTOR);
  source->SetDegree(2);
  source->SetElements(elements, elements, 1);
  return source;
}

/// Von Mises' stress, blue 0 to red 6.
vtkSmartPointer<vtkActor> Stress(vtkAlgorithmOutput* body)
{
  vtkNew<vtkLookupTable> colors;
  colors->SetHueRange(0.66, 0.0);
  colors->SetRange(0.0, 6.0);
  colors->Build();
  vtkNew<vtkDataSetMapper> mapper;
  mapper->SetInputConnection(body);
  mapper->SetScalarModeToUsePointFieldData();
  mapper->SelectColorArray("VonMisesStress");
  mapper->SetLookupTable(colors);
  mapper->UseLookupTableScalarRangeOn();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  return actor;
}
}

// Von Mises' stress of a quarter of a ring is largest where it is narrow, at the inner end on the y
// axis, and least inside towards the other end.
TEST(AnalysisImages, StressOfARing_GoldenOracle)
{
  const auto source = Ring(12);
  vtkNew<vtkSplineAnalysis> analysis;
  analysis->SetInputConnection(source->GetOutputPort());
  analysis->SetEquation(vtkSplineAnalysis::ELASTICITY);
  analysis->SetProblem(Tension);
  vtkNew<vtkSplineTessellate> tessellate;
  tessellate->SetInputConnection(analysis->GetOutputPort());
  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(Stress(tessellate->GetOutputPort()));
  renderer->SetBackground(1.0, 1.0, 1.0);
  renderer->ResetCamera();
  EXPECT_TRUE(RenderAndCompare(renderer, "StressOfARing", 400));
}

// The same on a spline of 6 x 6 elements and, to the right, on its tessellation as bilinear
// quadrilaterals: their stress has the same places, coarser and less at the peak.
TEST(AnalysisImages, ARingAgainstItsQuadrilaterals_GoldenOracle)
{
  const auto source = Ring(6);
  vtkNew<vtkSplineTessellate> coarse;
  coarse->SetInputConnection(source->GetOutputPort());
  coarse->SetChordalTolerance(0.01);
  vtkNew<vtkAppendFilter> mesh;
  mesh->AddInputConnection(coarse->GetOutputPort());
  const auto fine = Ring(24);
  vtkNew<vtkSplineVersusMesh> versus;
  versus->SetInputConnection(0, source->GetOutputPort());
  versus->SetInputConnection(1, mesh->GetOutputPort());
  versus->SetInputConnection(2, fine->GetOutputPort());
  versus->SetEquation(vtkSplineVersusMesh::ELASTICITY);
  versus->SetProblem(Tension);
  vtkNew<vtkSplineTessellate> tessellate;
  tessellate->SetInputConnection(versus->GetOutputPort(0));
  const auto right = Stress(versus->GetOutputPort(1));
  right->SetPosition(1.1, 0.0, 0.0);
  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(Stress(tessellate->GetOutputPort()));
  renderer->AddActor(right);
  renderer->SetBackground(1.0, 1.0, 1.0);
  renderer->ResetCamera();
  EXPECT_TRUE(RenderAndCompare(renderer, "RingAgainstQuadrilaterals", 400));
}
