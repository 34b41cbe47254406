// SPDX-License-Identifier: BSD-3-Clause
// Pictures of repaired surfaces.
#include "Rendering.h"
#include "TwoBalls.h"
#include <knotwork/SurfaceRemeshing/vtkSurfaceRepair.h>

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkPolyDataConnectivityFilter.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"

using namespace knotwork;

// Two balls that overlap, as wires, and the wall of what they have in common within.
TEST(RepairImages, SurfaceRepair_GoldenOracle)
{
  vtkNew<vtkSurfaceRepair> repair;
  repair->SetInputData(TwoBalls());
  vtkNew<vtkPolyDataConnectivityFilter> parts;
  parts->SetInputConnection(repair->GetOutputPort());
  parts->SetExtractionModeToAllRegions();
  parts->Update();
  ASSERT_EQ(parts->GetNumberOfExtractedRegions(), 2);
  vtkNew<vtkRenderer> renderer;
  const auto add = [&](bool largest)
  {
    vtkNew<vtkPolyDataConnectivityFilter> part;
    part->SetInputConnection(repair->GetOutputPort());
    part->SetExtractionModeToSpecifiedRegions();
    const bool firstIsLargest =
      parts->GetRegionSizes()->GetValue(0) > parts->GetRegionSizes()->GetValue(1);
    part->AddSpecifiedRegion(largest == firstIsLargest ? 0 : 1);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(part->GetOutputPort());
    mapper->ScalarVisibilityOff();
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    if (largest)
    {
      actor->GetProperty()->SetRepresentationToWireframe();
      actor->GetProperty()->LightingOff();
      actor->GetProperty()->SetColor(0.3, 0.3, 0.3);
    }
    else
    {
      actor->GetProperty()->LightingOff();
      actor->GetProperty()->SetColor(0.15, 0.35, 0.8);
      actor->GetProperty()->EdgeVisibilityOn();
    }
    renderer->AddActor(actor);
  };
  add(true);
  add(false);
  renderer->SetBackground(1.0, 1.0, 1.0);
  renderer->GetActiveCamera()->SetPosition(0.5, 1.0, 3.0);
  renderer->ResetCamera();
  EXPECT_TRUE(RenderAndCompare(renderer, "SurfaceRepair", 400));
}
