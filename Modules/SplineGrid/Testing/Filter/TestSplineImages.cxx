// SPDX-License-Identifier: BSD-3-Clause
// One picture of every filter that draws.
#include "MeshDatasets.h"
#include "Rendering.h"
#include <knotwork/SplineGrid/vtkMeshPatches.h>
#include <knotwork/SplineGrid/vtkSplineControlNet.h>
#include <knotwork/SplineGrid/vtkSplineEvaluate.h>
#include <knotwork/SplineGrid/vtkSplineExtract.h>
#include <knotwork/SplineGrid/vtkSplineParametricMesh.h>
#include <knotwork/SplineGrid/vtkSplineRefine.h>
#include <knotwork/SplineGrid/vtkSplineSource.h>
#include <knotwork/SplineGrid/vtkSplineTessellate.h>
#include <knotwork/SplineGrid/vtkSplineWarp.h>
#include <knotwork/SplineGrid/vtkUnstructuredSpline.h>

#include "vtkActor.h"
#include "vtkArrowSource.h"
#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataSetSurfaceFilter.h"
#include "vtkGlyph3D.h"
#include "vtkIntArray.h"
#include "vtkLookupTable.h"
#include "vtkNew.h"
#include "vtkPlaneSource.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkSphere.h"
#include "vtkTrivialProducer.h"
#include "vtkTubeFilter.h"
#include "vtkUnstructuredGrid.h"

#include <array>

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

/// Polydata in one colour.
vtkSmartPointer<vtkActor> Draw(vtkAlgorithm* data, double red, double green, double blue)
{
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(data->GetOutputPort());
  mapper->ScalarVisibilityOff();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(red, green, blue);
  return actor;
}
/// The same without light, for plane pictures; higher ones cover lower ones.
vtkSmartPointer<vtkActor> DrawFlat(
  vtkAlgorithm* data, double red, double green, double blue, double height)
{
  auto actor = Draw(data, red, green, blue);
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetLineWidth(2);
  actor->SetPosition(0.0, 0.0, height);
  return actor;
}

/// Lines of n x n cells over the unit square, each of so many points and one more.
vtkSmartPointer<vtkPolyData> Lattice(int n, int points)
{
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  for (int line = 0; line < 2 * (n + 1); ++line)
  {
    const double fixed = (line / 2) / double(n);
    lines->InsertNextCell(points + 1);
    for (int i = 0; i <= points; ++i)
    {
      const double along = i / double(points);
      lines->InsertCellPoint(
        places->InsertNextPoint(line % 2 == 0 ? fixed : along, line % 2 == 0 ? along : fixed, 0.0));
    }
  }
  auto lattice = vtkSmartPointer<vtkPolyData>::New();
  lattice->SetPoints(places);
  lattice->SetLines(lines);
  return lattice;
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

TEST(SplineImages, Tessellate_GoldenOracle)
{
  // A torus refined around one point: triangles bridge the levels, normals are exact.
  vtkNew<vtkSplineSource> source;
  source->SetShape(vtkSplineSource::TORUS_SURFACE);
  source->SetAngle(270.0);
  source->SetElements(2, 2, 1);
  vtkNew<vtkSphere> sphere;
  sphere->SetCenter(0.7, 0.7, 0.5);
  sphere->SetRadius(0.2);
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputConnection(source->GetOutputPort());
  refine->SetMode(vtkSplineRefine::IMPLICIT_FUNCTION);
  refine->SetImplicitFunction(sphere);
  refine->SetExtension(0);
  refine->SetNumberOfRefinements(4);
  vtkNew<vtkSplineTessellate> tessellate;
  tessellate->SetInputConnection(refine->GetOutputPort());
  tessellate->SetChordalTolerance(6e-3);
  auto torus = Draw(tessellate, 0.45, 0.7, 0.95);
  torus->GetProperty()->EdgeVisibilityOn();
  torus->GetProperty()->SetEdgeColor(0.1, 0.1, 0.2);
  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(torus);
  renderer->GetActiveCamera()->SetPosition(3.0, 3.0, 5.0);
  renderer->GetActiveCamera()->SetViewUp(0.0, 0.0, 1.0);
  renderer->ResetCamera();
  renderer->GetActiveCamera()->Zoom(1.4);
  EXPECT_TRUE(RenderAndCompare(renderer, "SplineTessellate", 400));
}

TEST(SplineImages, Evaluate_GoldenOracle)
{
  // Points of an annulus with the derivatives of the map there: arrows along u and along v.
  vtkNew<vtkSplineSource> annulus;
  annulus->SetShape(vtkSplineSource::ANNULUS_SECTOR);
  vtkNew<vtkSplineTessellate> surface;
  surface->SetInputConnection(annulus->GetOutputPort());
  vtkNew<vtkPlaneSource> parameters;
  parameters->SetOrigin(0.0, 0.0, 0.0);
  parameters->SetPoint1(1.0, 0.0, 0.0);
  parameters->SetPoint2(0.0, 1.0, 0.0);
  parameters->SetResolution(2, 4);
  vtkNew<vtkSplineEvaluate> evaluate;
  evaluate->SetInputConnection(annulus->GetOutputPort());
  evaluate->SetPointsConnection(parameters->GetOutputPort());
  evaluate->SetDerivatives(1);
  vtkNew<vtkArrowSource> arrow;
  arrow->SetTipResolution(24);
  arrow->SetShaftResolution(16);
  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(DrawFlat(surface, 0.85, 0.9, 0.97, -0.2));
  std::array<vtkNew<vtkGlyph3D>, 2> arrows;
  for (std::size_t k = 0; k < 2; ++k)
  {
    arrows[k]->SetInputConnection(evaluate->GetOutputPort());
    arrows[k]->SetSourceConnection(arrow->GetOutputPort());
    arrows[k]->SetInputArrayToProcess(
      1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, k == 0 ? "Derivative_u" : "Derivative_v");
    arrows[k]->SetVectorModeToUseVector();
    arrows[k]->SetScaleModeToScaleByVector();
    arrows[k]->SetScaleFactor(k == 0 ? 0.35 : 0.15);
    renderer->AddActor(
      DrawFlat(arrows[k], k == 0 ? 0.84 : 0.0, k == 0 ? 0.37 : 0.45, k == 0 ? 0.0 : 0.7, 0.0));
  }
  renderer->GetActiveCamera()->ParallelProjectionOn();
  renderer->ResetCamera();
  renderer->GetActiveCamera()->Zoom(1.3);
  EXPECT_TRUE(RenderAndCompare(renderer, "SplineEvaluate", 400));
}

TEST(SplineImages, Extract_GoldenOracle)
{
  // A surface, its part over a box lifted above it, and curves of that part.
  vtkNew<vtkSplineSource> source;
  source->SetShape(vtkSplineSource::ANNULUS_SECTOR);
  source->SetDegree(2);
  source->SetElements(4, 8, 1);
  vtkNew<vtkSplineTessellate> whole;
  whole->SetInputConnection(source->GetOutputPort());
  whole->SetChordalTolerance(1e-3);
  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(DrawFlat(whole, 0.85, 0.9, 0.97, -0.02));
  vtkNew<vtkSplineExtract> part;
  part->SetInputConnection(source->GetOutputPort());
  part->RestrictToBoxOn();
  part->SetBox(0.25, 0.8, 0.2, 0.6);
  vtkNew<vtkSplineTessellate> mesh;
  mesh->SetInputConnection(part->GetOutputPort());
  mesh->SetChordalTolerance(1e-3);
  renderer->AddActor(DrawFlat(mesh, 0.95, 0.75, 0.3, 0.0));
  for (const int direction : { vtkSplineExtract::FIRST, vtkSplineExtract::SECOND })
  {
    for (const double value : { 0.3, 0.4, 0.5 })
    {
      vtkNew<vtkSplineExtract> curve;
      curve->SetInputConnection(part->GetOutputPort());
      curve->SetIsoCurve(direction);
      curve->SetIsoValue(value);
      vtkNew<vtkSplineTessellate> line;
      line->SetInputConnection(curve->GetOutputPort());
      line->SetChordalTolerance(1e-3);
      const bool first = direction == vtkSplineExtract::FIRST;
      renderer->AddActor(
        DrawFlat(line, first ? 0.8 : 0.0, first ? 0.1 : 0.3, first ? 0.1 : 0.6, 0.02));
    }
  }
  renderer->GetActiveCamera()->ParallelProjectionOn();
  renderer->ResetCamera();
  renderer->GetActiveCamera()->Zoom(1.3);
  EXPECT_TRUE(RenderAndCompare(renderer, "SplineExtract", 400));
}

TEST(SplineImages, Warp_GoldenOracle)
{
  // A disc of five patches and a lattice of lines, as they are and sent through the map of an
  // annulus: splines stay splines, points move.
  vtkNew<vtkSplineSource> disc;
  disc->SetShape(vtkSplineSource::DISC);
  disc->SetCenter(0.5, 0.5, 0.0);
  disc->SetOuterRadius(0.4);
  disc->SetInnerRadius(0.2);
  disc->SetDegree(3);
  vtkNew<vtkSplineSource> annulus;
  annulus->SetShape(vtkSplineSource::ANNULUS_SECTOR);
  annulus->SetOuterRadius(1.5);
  vtkNew<vtkRenderer> renderer;
  for (const bool warped : { false, true })
  {
    vtkNew<vtkSplineWarp> image;
    image->SetInputConnection(disc->GetOutputPort());
    image->SetMapConnection(annulus->GetOutputPort());
    image->SetTolerance(1e-4);
    vtkNew<vtkSplineTessellate> mesh;
    mesh->SetInputConnection(warped ? image->GetOutputPort() : disc->GetOutputPort());
    mesh->Update();
    vtkSmartPointer<vtkActor> patches = DrawFlat(mesh, 1.0, 1.0, 1.0, 0.0);
    vtkNew<vtkLookupTable> colours;
    colours->SetNumberOfTableValues(5);
    for (int i = 0; i < 5; ++i)
    {
      colours->SetTableValue(i, i < 3 ? 0.95 : 0.4, 0.9 - 0.15 * i, i < 3 ? 0.2 : 0.9);
    }
    colours->SetTableRange(-0.5, 4.5);
    vtkMapper* mapper = patches->GetMapper();
    mapper->ScalarVisibilityOn();
    mapper->SetLookupTable(colours);
    mapper->UseLookupTableScalarRangeOn();
    mapper->SetScalarModeToUseCellFieldData();
    mapper->SelectColorArray("PatchId");

    vtkNew<vtkSplineWarp> moved;
    moved->SetInputDataObject(Lattice(8, 64));
    moved->SetMapConnection(annulus->GetOutputPort());
    vtkNew<vtkTrivialProducer> still;
    still->SetOutput(Lattice(8, 64));
    vtkAlgorithm* lattice = warped ? static_cast<vtkAlgorithm*>(moved) : still;
    vtkSmartPointer<vtkActor> lines = DrawFlat(lattice, 0.15, 0.25, 0.45, 0.01);
    for (vtkActor* actor : { patches.Get(), lines.Get() })
    {
      actor->AddPosition(warped ? 0.0 : -1.3, warped ? 0.0 : 0.25, 0.0);
      renderer->AddActor(actor);
    }
  }
  renderer->GetActiveCamera()->ParallelProjectionOn();
  renderer->ResetCamera();
  renderer->GetActiveCamera()->Zoom(1.1);
  EXPECT_TRUE(RenderAndCompare(renderer, "SplineWarp", 400));
}

TEST(SplineImages, Unstructured_GoldenOracle)
{
  // The sphere of a cube's mesh of 3 x 3 quadrilaterals a side: 54 elements around eight points of
  // three elements.
  const auto data = Sphere(3);
  vtkNew<vtkUnstructuredSpline> spline;
  spline->SetInputDataObject(data);
  vtkNew<vtkSplineTessellate> fine;
  fine->SetInputConnection(spline->GetOutputPort());
  fine->Update();
  auto* drawn = vtkPolyData::SafeDownCast(fine->GetOutputDataObject(0));
  vtkDataArray* elements = drawn->GetCellData()->GetArray("ElementId");
  vtkNew<vtkIntArray> colours;
  colours->SetName("Colour");
  for (vtkIdType i = 0; i < drawn->GetNumberOfCells(); ++i)
  {
    const int element = static_cast<int>(elements->GetTuple1(i));
    colours->InsertNextValue(element / 9 % 2 * 2 + element % 2); // sides of the cube, and a board
  }
  drawn->GetCellData()->AddArray(colours);
  RenderOptions options;
  options.ColorBy = "Colour";
  options.Edges = false;
  options.From = { 1.0, 0.7, 0.5 };
  options.Up = { 0.0, 0.0, 1.0 };
  EXPECT_TRUE(RenderAndCompare(drawn, "UnstructuredSpline", options));
}

TEST(SplineImages, MeshPatches_GoldenOracle)
{
  // A cube's mesh on the sphere: a patch a side.
  vtkNew<vtkMeshPatches> patches;
  patches->SetInputDataObject(Sphere(3));
  vtkNew<vtkDataSetSurfaceFilter> surface;
  surface->SetInputConnection(patches->GetOutputPort());
  surface->Update();
  RenderOptions options;
  options.ColorBy = "PatchId";
  options.From = { 1.0, 0.7, 0.5 };
  options.Up = { 0.0, 0.0, 1.0 };
  EXPECT_TRUE(RenderAndCompare(surface->GetOutput(), "MeshPatches", options));
}
