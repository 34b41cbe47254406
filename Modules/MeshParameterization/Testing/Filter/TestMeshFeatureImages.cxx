// SPDX-License-Identifier: BSD-3-Clause
#include "FeatureCases.h"
#include "MeshPolygons.h"
#include "Rendering.h"
#include <knotwork/MeshParameterization/vtkMeshFeatures.h>

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkLookupTable.h"
#include "vtkMapper.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"

#include <cmath>

using namespace knotwork;

namespace
{
void Add(vtkRenderer* renderer, vtkAlgorithmOutput* source, bool isMesh)
{
  vtkNew<vtkLookupTable> colours;
  const double table[6][3] = { { 0.34, 0.71, 0.91 }, { 0.90, 0.62, 0.00 }, { 0.00, 0.62, 0.45 },
    { 0.95, 0.90, 0.25 }, { 0.84, 0.37, 0.00 }, { 0.80, 0.60, 0.70 } };
  colours->SetNumberOfTableValues(6);
  for (int i = 0; i < 6; ++i)
  {
    colours->SetTableValue(i, table[i][0], table[i][1], table[i][2]);
  }
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(source);
  mapper->SetScalarVisibility(isMesh);
  mapper->SetScalarModeToUseCellFieldData();
  mapper->SelectColorArray("RegionId");
  mapper->SetLookupTable(colours);
  mapper->SetScalarRange(-0.5, 5.5);
  mapper->SetRelativeCoincidentTopologyLineOffsetParameters(0.0, -12.0);
  mapper->SetRelativeCoincidentTopologyPointOffsetParameter(-12.0);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetLineWidth(3);
  actor->GetProperty()->SetPointSize(8);
  actor->GetProperty()->SetColor(0.0, 0.0, 0.0);
  actor->GetProperty()->SetLighting(isMesh);
  actor->GetProperty()->SetInterpolationToFlat();
  renderer->AddActor(actor);
}
}

// A noisy cube: the colours of its regions, lines between them, corners.
TEST(MeshFeatureImages, NoisyCube_GoldenOracle)
{
  TriangleMesh cube = DividedCube(20);
  AddNoise(0.002 * std::sqrt(3.0), 1, cube);
  vtkNew<vtkMeshFeatures> features;
  features->SetInputDataObject(Encode(cube));
  vtkNew<vtkRenderer> renderer;
  vtkMapper::SetResolveCoincidentTopologyToPolygonOffset();
  for (const int port : { 0, 1, 2 })
  {
    Add(renderer, features->GetOutputPort(port), port == 0);
  }
  renderer->GetActiveCamera()->SetPosition(2.5, -1.8, 2.2);
  renderer->GetActiveCamera()->SetFocalPoint(0.5, 0.5, 0.5);
  renderer->GetActiveCamera()->SetViewUp(0.0, 0.0, 1.0);
  renderer->ResetCamera();
  EXPECT_TRUE(RenderAndCompare(renderer, "MeshFeatures", 400));
  vtkMapper::SetResolveCoincidentTopologyToDefault();
}
