// SPDX-License-Identifier: BSD-3-Clause
#include "Rendering.h"

#include "Baselines.h"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellData.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkWindowToImageFilter.h>

namespace knotwork
{

namespace
{

constexpr int NumberOfColors = 8;
constexpr double Colors[NumberOfColors][3] = { { 0.10, 0.45, 0.90 }, { 0.95, 0.55, 0.05 },
  { 0.10, 0.65, 0.25 }, { 0.85, 0.10, 0.15 }, { 0.55, 0.30, 0.80 }, { 0.95, 0.85, 0.10 },
  { 0.05, 0.75, 0.80 }, { 0.90, 0.40, 0.70 } };

}

::testing::AssertionResult RenderAndCompare(
  vtkRenderer* renderer, const std::string& name, int size)
{
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetSize(size, size);
  renderer->SetBackground(1, 1, 1);
  window->AddRenderer(renderer);
  window->Render();

  vtkNew<vtkWindowToImageFilter> grab;
  grab->SetInput(window);
  grab->ReadFrontBufferOff();
  const std::string rendering = std::string(KNOTWORK_OUTPUT_DIR) + "/" + name + ".png";
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(grab->GetOutputPort());
  writer->SetFileName(rendering.c_str());
  writer->Write();

  const std::string problem =
    CompareWithBaseline(rendering, std::string(KNOTWORK_BASELINE_DIR) + "/" + name + ".png");
  if (problem.empty())
  {
    return ::testing::AssertionSuccess();
  }
  return ::testing::AssertionFailure() << problem;
}

::testing::AssertionResult RenderAndCompare(
  vtkPolyData* data, const std::string& name, const RenderOptions& options)
{
  vtkNew<vtkLookupTable> table;
  table->SetNumberOfTableValues(NumberOfColors);
  for (int i = 0; i < NumberOfColors; ++i)
  {
    table->SetTableValue(i, Colors[i][0], Colors[i][1], Colors[i][2]);
  }
  table->SetTableRange(-0.5, NumberOfColors - 0.5);

  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->SetLookupTable(table);
  mapper->UseLookupTableScalarRangeOn();
  mapper->ScalarVisibilityOff();
  if (!options.ColorBy.empty())
  {
    const bool byCell = data->GetCellData()->HasArray(options.ColorBy.c_str()) != 0;
    if (!byCell && !data->GetPointData()->HasArray(options.ColorBy.c_str()))
    {
      return ::testing::AssertionFailure() << "no array " << options.ColorBy << " to colour by";
    }
    mapper->ScalarVisibilityOn();
    mapper->SetColorModeToMapScalars();
    byCell ? mapper->SetScalarModeToUseCellFieldData() : mapper->SetScalarModeToUsePointFieldData();
    mapper->SelectColorArray(options.ColorBy.c_str());
  }

  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  vtkProperty* property = actor->GetProperty();
  property->SetColor(Colors[0][0], Colors[0][1], Colors[0][2]);
  property->LightingOff();
  property->SetLineWidth(2);
  property->SetPointSize(5);
  property->SetEdgeVisibility(options.Edges);
  property->SetEdgeColor(0, 0, 0);

  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(actor);
  vtkCamera* camera = renderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetFocalPoint(0, 0, 0);
  camera->SetPosition(options.From[0], options.From[1], options.From[2]);
  camera->SetViewUp(options.Up[0], options.Up[1], options.Up[2]);
  renderer->ResetCamera();
  return RenderAndCompare(renderer, name, options.Size);
}

}
