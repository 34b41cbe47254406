// SPDX-License-Identifier: BSD-3-Clause
// Pictures of trimmed surfaces.
#include "HeightTiles.h"
#include "Rendering.h"
#include <knotwork/SplineGrid/vtkSplineTessellate.h>
#include <knotwork/SurfaceTrimming/vtkAnalyticModel.h>
#include <knotwork/SurfaceTrimming/vtkFaceIntersections.h>
#include <knotwork/SurfaceTrimming/vtkSplineTrimToPoints.h>
#include <knotwork/SurfaceTrimming/vtkSurfaceRecognition.h>

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkLookupTable.h"
#include "vtkMapper.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkSphereSource.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

using namespace knotwork;

namespace
{
/// Triangles of a turned part: plane, cylinder, fillet (torus), plane, cone, half a ball.
vtkSmartPointer<vtkPolyData> TurnedPart()
{
  std::vector<std::array<double, 2>> corners = { { 0.0, 0.0 }, { 2.0, 0.0 }, { 2.0, 0.6 } };
  const auto arc = [&](double radius, double height, double size)
  {
    for (int i = 1; i < 8; ++i)
    {
      const double angle = std::acos(0.0) * i / 8.0;
      corners.push_back({ radius + size * std::cos(angle), height + size * std::sin(angle) });
    }
    corners.push_back({ radius, height + size });
  };
  arc(1.6, 0.6, 0.4);
  corners.insert(corners.end(), { { 1.2, 1.0 }, { 0.7, 2.0 } });
  arc(0.0, 2.0, 0.7);
  constexpr int sides = 48;
  vtkNew<vtkPoints> points; // those on the axis are there for every side
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> triangles;
  for (const auto& [radius, height] : corners)
  {
    const vtkIdType ring = points->GetNumberOfPoints();
    for (int i = 0; i < sides; ++i)
    {
      const double angle = 4.0 * std::acos(0.0) * i / sides;
      points->InsertNextPoint(radius * std::cos(angle), radius * std::sin(angle), height);
      const vtkIdType next = (i + 1) % sides;
      const vtkIdType lower[3] = { ring - sides + i, ring - sides + next, ring + next };
      const vtkIdType upper[3] = { ring - sides + i, ring + next, ring + i };
      if (ring > 0)
      {
        triangles->InsertNextCell(3, lower);
        triangles->InsertNextCell(3, upper);
      }
    }
  }
  auto part = vtkSmartPointer<vtkPolyData>::New();
  part->SetPoints(points);
  part->SetPolys(triangles);
  return part;
}

/// Triangles in the colours of the cell array SurfaceType, and black lines; seen aslant from above.
void ShowTypes(vtkPolyData* triangles, vtkPolyData* lines, const std::string& name)
{
  vtkNew<vtkLookupTable> colours;
  const double table[6][3] = { { 0.34, 0.71, 0.91 }, { 0.90, 0.62, 0.00 }, { 0.00, 0.62, 0.45 },
    { 0.95, 0.90, 0.25 }, { 0.84, 0.37, 0.00 }, { 0.60, 0.60, 0.60 } };
  colours->SetNumberOfTableValues(6);
  for (int i = 0; i < 6; ++i)
  {
    colours->SetTableValue(i, table[i][0], table[i][1], table[i][2]);
  }
  vtkNew<vtkRenderer> renderer;
  vtkMapper::SetResolveCoincidentTopologyToPolygonOffset();
  for (vtkPolyData* data : { triangles, lines })
  {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(data);
    mapper->SetScalarVisibility(data == triangles);
    mapper->SetRelativeCoincidentTopologyLineOffsetParameters(0.0, -6.0);
    mapper->SetScalarModeToUseCellFieldData();
    mapper->SelectColorArray("SurfaceType");
    mapper->SetLookupTable(colours);
    mapper->SetScalarRange(-0.5, 5.5);
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->SetLineWidth(3);
    actor->GetProperty()->SetColor(0.0, 0.0, 0.0);
    actor->GetProperty()->LightingOff();
    renderer->AddActor(actor);
  }
  renderer->GetActiveCamera()->SetPosition(0.0, -6.0, 5.0);
  renderer->GetActiveCamera()->SetFocalPoint(0.0, 0.0, 1.2);
  renderer->GetActiveCamera()->SetViewUp(0.0, 0.0, 1.0);
  renderer->ResetCamera();
  renderer->GetActiveCamera()->Zoom(1.3);
  EXPECT_TRUE(RenderAndCompare(renderer, name, 400));
  vtkMapper::SetResolveCoincidentTopologyToDefault();
}
}

TEST(TrimImages, TrimToPoints_GoldenOracle)
{
  // a lattice with a round hole and a corner that is missing
  vtkNew<vtkPoints> points;
  for (int i = 0; i < 61 * 61; ++i)
  {
    const double x = (i % 61) / 30.0;
    const double y = (i / 61) / 30.0;
    if (std::hypot(x - 0.7, y - 1.2) > 0.35 && x + y < 3.3)
    {
      points->InsertNextPoint(x, y, 0.0);
    }
  }
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(points);
  vtkNew<vtkSplineTrimToPoints> trim;
  trim->SetInputDataObject(0,
    GridOfPatches({ HeightTile(0, { { 0, 0 }, { 2, 2 } }, 5,
      [](double u, double v) { return 0.2 * std::sin(2 * u) * v; }) }));
  trim->SetPointsData(cloud);
  trim->Update();
  RenderOptions options;
  options.From = { -0.5, -1.0, 1.6 };
  options.Up = { 0.0, 0.0, 1.0 };
  EXPECT_TRUE(RenderAndCompare(
    vtkPolyData::SafeDownCast(trim->GetOutputDataObject(0)), "SplineTrimToPoints", options));
}

// Two height fields that cross, and a ball where it is found that they do.
TEST(TrimImages, FaceIntersections_GoldenOracle)
{
  const auto grid = GridOfPatches(
    { HeightTile(0, { { 0, 0 }, { 2, 2 } }, 8,
        [](double u, double v) { return 0.3 * std::sin(3.0 * u) * std::cos(2.0 * v); }),
      HeightTile(1, { { 0, 0 }, { 2, 2 } }, 8,
        [](double u, double v) { return 0.25 + 0.1 * std::cos(2.0 * (u + v)); }) });
  vtkNew<vtkFaceIntersections> intersections;
  intersections->SetInputDataObject(grid);
  intersections->Update();
  auto* points = vtkPolyData::SafeDownCast(intersections->GetOutputDataObject(0));
  ASSERT_EQ(points->GetNumberOfPoints(), 1);
  vtkNew<vtkSplineTessellate> tessellate;
  tessellate->SetInputDataObject(grid);
  tessellate->SetChordalTolerance(1e-3);
  vtkNew<vtkSphereSource> ball;
  ball->SetCenter(points->GetPoint(0));
  ball->SetRadius(0.07);
  ball->SetThetaResolution(24);
  ball->SetPhiResolution(24);
  vtkNew<vtkRenderer> renderer;
  const auto add = [&](vtkAlgorithm* source, double red, double green, double blue)
  {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(source->GetOutputPort());
    mapper->ScalarVisibilityOff();
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->SetColor(red, green, blue);
    actor->GetProperty()->SetAmbient(0.3);
    actor->GetProperty()->SetDiffuse(0.7);
    renderer->AddActor(actor);
  };
  add(tessellate, 0.6, 0.7, 0.8);
  add(ball, 0.85, 0.1, 0.1);
  renderer->GetActiveCamera()->SetPosition(2.5, -3.5, 4.0);
  renderer->GetActiveCamera()->SetFocalPoint(1.0, 1.0, 0.0);
  renderer->GetActiveCamera()->SetViewUp(0.0, 0.0, 1.0);
  renderer->ResetCamera();
  EXPECT_TRUE(RenderAndCompare(renderer, "FaceIntersections", 400));
}

// A turned part in the colours of its surfaces' types, and the edges between them.
TEST(TrimImages, SurfaceRecognition_GoldenOracle)
{
  vtkNew<vtkSurfaceRecognition> recognition;
  recognition->SetInputData(TurnedPart());
  recognition->Update();
  ShowTypes(vtkPolyData::SafeDownCast(recognition->GetOutputDataObject(0)),
    vtkPolyData::SafeDownCast(recognition->GetOutputDataObject(1)), "SurfaceRecognition");
}

// The faces that are made of the same part, and their edges, with the seams.
TEST(TrimImages, AnalyticModel_GoldenOracle)
{
  vtkNew<vtkAnalyticModel> model;
  model->SetInputData(TurnedPart());
  model->Update();
  vtkNew<vtkSplineTessellate> edges;
  edges->SetInputConnection(model->GetOutputPort(2));
  edges->SetChordalTolerance(1e-3);
  edges->Update();
  ShowTypes(vtkPolyData::SafeDownCast(model->GetOutputDataObject(0)),
    vtkPolyData::SafeDownCast(edges->GetOutputDataObject(0)), "AnalyticModel");
}
