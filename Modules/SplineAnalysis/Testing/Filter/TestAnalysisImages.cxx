// SPDX-License-Identifier: BSD-3-Clause
// Pictures of solved problems.
#include "Rendering.h"
#include <knotwork/SplineAnalysis/vtkSplineAnalysis.h>
#include <knotwork/SplineGrid/vtkSplineSource.h>
#include <knotwork/SplineGrid/vtkSplineTessellate.h>

#include "vtkActor.h"
#include "vtkDataSetMapper.h"
#include "vtkLookupTable.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"

using namespace knotwork;

// A quarter of a ring drawn along x: von Mises' stress is largest where it is narrow, at the inner
// end on the y axis, and least inside towards the other end.
TEST(AnalysisImages, StressOfARing_GoldenOracle)
{
  vtkNew<vtkSplineSource> source;
  source->SetShape(vtkSplineSource::ANNULUS_SECTOR);
  source->SetDegree(2);
  source->SetElements(12, 12, 1);
  vtkNew<vtkSplineAnalysis> analysis;
  analysis->SetInputConnection(source->GetOutputPort());
  analysis->SetEquation(vtkSplineAnalysis::ELASTICITY);
  analysis->SetProblem(R"({ "conditions": [
    { "on": { "where": "abs(x) < 1e-9" }, "displacement": [0, null] },
    { "on": { "where": "abs(y) < 1e-9" }, "displacement": [null, 0] },
    { "on": { "where": "x * nx + y * ny > 0.5" }, "traction": ["nx", 0] } ] })");
  vtkNew<vtkSplineTessellate> tessellate;
  tessellate->SetInputConnection(analysis->GetOutputPort());
  vtkNew<vtkLookupTable> colors;
  colors->SetHueRange(0.66, 0.0);
  colors->SetRange(0.0, 6.0);
  colors->Build();
  vtkNew<vtkDataSetMapper> mapper;
  mapper->SetInputConnection(tessellate->GetOutputPort());
  mapper->SetScalarModeToUsePointFieldData();
  mapper->SelectColorArray("VonMisesStress");
  mapper->SetLookupTable(colors);
  mapper->UseLookupTableScalarRangeOn();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(actor);
  renderer->SetBackground(1.0, 1.0, 1.0);
  renderer->ResetCamera();
  EXPECT_TRUE(RenderAndCompare(renderer, "StressOfARing", 400));
}
