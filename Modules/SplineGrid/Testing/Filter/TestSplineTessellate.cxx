// SPDX-License-Identifier: BSD-3-Clause
#include "FilterCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineGrid/vtkSplineEvaluate.h>
#include <knotwork/SplineGrid/vtkSplineRefine.h>
#include <knotwork/SplineGrid/vtkSplineTessellate.h>

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFeatureEdges.h"
#include "vtkFieldData.h"
#include "vtkMassProperties.h"
#include "vtkMath.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTetra.h"
#include "vtkTriangleFilter.h"

#include <cmath>
#include <set>

using namespace knotwork;

namespace
{
vtkSmartPointer<vtkPolyData> Tessellate(vtkDataObject* data, double tolerance)
{
  vtkNew<vtkSplineTessellate> filter;
  filter->SetInputDataObject(data);
  filter->SetChordalTolerance(tolerance);
  filter->RelativeToleranceOff();
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  return vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
}

vtkIdType OpenEdges(vtkPolyData* data)
{
  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputData(data);
  edges->BoundaryEdgesOn();
  edges->NonManifoldEdgesOn();
  edges->FeatureEdgesOff();
  edges->ManifoldEdgesOff();
  edges->Update();
  return edges->GetOutput()->GetNumberOfCells();
}

/// Signed volume of a hexahedron with plane faces, as six tetrahedra around a diagonal.
double PrismVolume(vtkPoints* corners)
{
  constexpr int around[7] = { 1, 2, 3, 7, 4, 5, 1 };
  double x[4][3];
  corners->GetPoint(0, x[0]);
  corners->GetPoint(6, x[3]);
  double volume = 0.0;
  for (int k = 0; k < 6; ++k)
  {
    corners->GetPoint(around[k], x[1]);
    corners->GetPoint(around[k + 1], x[2]);
    volume += vtkTetra::ComputeVolume(x[0], x[1], x[2], x[3]);
  }
  return volume;
}

/// A field f = x + 2 y on a grid whose coordinates are in its own space: the Bezier values of a
/// linear function of the points.
vtkSmartPointer<vtkDoubleArray> LinearField(vtkUnstructuredGrid* grid)
{
  auto field = vtkSmartPointer<vtkDoubleArray>::New();
  field->SetName("Height");
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    const double* x = grid->GetPoint(i);
    field->InsertNextValue(x[0] + 2.0 * x[1]);
  }
  return field;
}
}

TEST(SplineTessellate, SphereIsClosedAndWithinTolerance_ExactOracle)
{
  auto sphere = Tessellate(ShapeGrid(vtkSplineSource::SPHERE_SURFACE), 1e-3);
  EXPECT_EQ(OpenEdges(sphere), 0);
  EXPECT_EQ(sphere->GetPoints()->GetDataType(), VTK_DOUBLE);
  double deepest = 1.0;
  for (vtkIdType c = 0; c < sphere->GetNumberOfCells(); ++c)
  {
    double centre[3] = { 0.0, 0.0, 0.0 };
    vtkCell* cell = sphere->GetCell(c);
    for (vtkIdType k = 0; k < cell->GetNumberOfPoints(); ++k)
    {
      for (int d = 0; d < 3; ++d)
      {
        centre[d] += cell->GetPoints()->GetPoint(k)[d] / double(cell->GetNumberOfPoints());
      }
    }
    deepest = std::min(deepest, std::hypot(centre[0], centre[1], centre[2]));
  }
  EXPECT_GE(deepest, 1.0 - 1e-3);
  EXPECT_LT(deepest, 1.0 - 1e-5) << "the tolerance is used";
  vtkDataArray* normals = sphere->GetPointData()->GetNormals();
  ASSERT_TRUE(normals);
  for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
  {
    for (int d = 0; d < 3; ++d)
    {
      EXPECT_NEAR(normals->GetComponent(i, d), sphere->GetPoint(i)[d], 1e-12);
    }
  }
  const double bound =
    vtkDataArray::SafeDownCast(sphere->GetFieldData()->GetAbstractArray("ChordalBound"))
      ->GetTuple1(0);
  EXPECT_LE(bound, 1e-3);
  EXPECT_GE(bound, 1.0 - deepest);
}

TEST(SplineTessellate, RefinedLevelsKeepTheirArrays_PropertyOracle)
{
  // A torus sector refined at one element: open edges are those of its two ends.
  vtkNew<vtkSplineRefine> refine;
  auto grid = ShapeGrid(vtkSplineSource::TORUS_SURFACE, 2, { 2, 2, 1 });
  vtkNew<vtkDoubleArray> mark;
  mark->SetName("Mark");
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    mark->InsertNextValue(c == 5 ? 1.0 : 0.0);
  }
  grid->GetCellData()->AddArray(mark);
  refine->SetInputData(grid);
  refine->SetMode(vtkSplineRefine::CELL_ARRAY);
  refine->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "Mark");
  refine->SetLowerThreshold(0.5);
  refine->SetNumberOfRefinements(3);
  refine->SetExtension(0);
  refine->Update();
  auto whole = Tessellate(grid, 0.05);
  auto refined = Tessellate(refine->GetOutputDataObject(0), 0.05);
  const vtkIdType open = OpenEdges(whole);
  EXPECT_GT(open, 0) << "a torus sector of 90 degrees has two ends";
  // the rim is cut as fine or finer; cracks are what the kernel's tests look for
  EXPECT_GE(OpenEdges(refined), open);
  EXPECT_GT(refined->GetNumberOfCells(), whole->GetNumberOfCells());
  EXPECT_EQ(refined->GetCellData()->GetArray("Level")->GetRange()[1], 3.0);
  EXPECT_EQ(refined->GetCellData()->GetArray("Mark")->GetRange()[1], 1.0);
}

TEST(SplineTessellate, FieldsAndPlacesAreExact_CrossOracle)
{
  for (const int shape : { vtkSplineSource::DISC, vtkSplineSource::BALL })
  {
    auto grid = ShapeGrid(shape, 0, { 1, 2, 1 });
    grid->GetPointData()->AddArray(LinearField(grid));
    auto mesh = Tessellate(grid, 1e-2);
    vtkDataArray* field = mesh->GetPointData()->GetArray("Height");
    ASSERT_TRUE(field);
    for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
    {
      const double* x = mesh->GetPoint(i);
      EXPECT_NEAR(field->GetTuple1(i), x[0] + 2.0 * x[1], 1e-13);
    }
    // PatchId, ElementId, LocalParameters lead back to the point.
    const SplineModel model = DecodePatches(grid);
    vtkDataArray* patchId = mesh->GetPointData()->GetArray("PatchId");
    vtkDataArray* elementId = mesh->GetPointData()->GetArray("ElementId");
    vtkDataArray* local = mesh->GetPointData()->GetArray("LocalParameters");
    ASSERT_TRUE(patchId && elementId && local);
    for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); i += 7)
    {
      for (const SplinePatch& patch : model.Patches)
      {
        if (patch.Id != int(patchId->GetTuple1(i)))
        {
          continue;
        }
        std::visit(
          [&](const auto& spline)
          {
            const auto form = MakeBezierForm(spline, 1);
            constexpr int dim = std::tuple_size_v<decltype(spline.Space->Domain().Lower)>;
            PointMatrix u(1, dim);
            for (int d = 0; d < dim; ++d)
            {
              u(0, d) = local->GetComponent(i, d);
            }
            EvaluationBatch batch;
            ASSERT_TRUE(
              EvaluateElements<dim>(form, { int(elementId->GetTuple1(i)) }, u, {}, batch));
            for (int d = 0; d < 3; ++d)
            {
              EXPECT_NEAR(batch.Values(0, d), mesh->GetPoint(i)[d], 1e-14);
            }
          },
          patch.Geometry);
      }
    }
  }
}

TEST(SplineTessellate, SolidsBecomeSurfacesOrHexahedra_ExactOracle)
{
  auto ball = Tessellate(ShapeGrid(vtkSplineSource::BALL), 1e-2);
  EXPECT_EQ(OpenEdges(ball), 0);
  for (vtkIdType i = 0; i < ball->GetNumberOfPoints(); ++i)
  {
    const double* x = ball->GetPoint(i);
    EXPECT_NEAR(std::hypot(x[0], x[1], x[2]), 1.0, 1e-12) << "inner faces are not drawn";
  }
  // chords at most 1e-2 below the sphere: of its volume at least (1 - 1e-2)^3 is inside
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputData(ball);
  vtkNew<vtkMassProperties> enclosed;
  enclosed->SetInputConnection(triangles->GetOutputPort());
  enclosed->Update();
  const double sphere = 4.0 / 3.0 * vtkMath::Pi();
  EXPECT_LE(enclosed->GetVolume(), sphere);
  EXPECT_GE(enclosed->GetVolume(), std::pow(1.0 - 1e-2, 3) * sphere);
  vtkNew<vtkSplineTessellate> filter;
  auto cylinder = ShapeGrid(vtkSplineSource::SOLID_CYLINDER); // radius 1
  double box[6];
  cylinder->GetBounds(box);
  filter->SetInputDataObject(cylinder);
  filter->SetCells(vtkSplineTessellate::VOLUME);
  filter->SetRelativeTolerance(false);
  filter->SetChordalTolerance(1e-2);
  filter->Update();
  auto* grid = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(grid);
  EXPECT_TRUE(grid->IsHomogeneous());
  EXPECT_EQ(grid->GetCellType(0), VTK_HEXAHEDRON);
  // every hexahedron is upright, none overlap: prisms inscribed in the cylinder fill its polygon
  double volume = 0.0;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    const double one = PrismVolume(grid->GetCell(c)->GetPoints());
    EXPECT_GT(one, 0.0);
    volume += one;
  }
  const double whole = vtkMath::Pi() * (box[5] - box[4]);
  EXPECT_LE(volume, whole);
  EXPECT_GE(volume, std::pow(1.0 - 1e-2, 2) * whole);
  // Back to the surface: the output changes its type, and encloses the same.
  filter->SetCells(vtkSplineTessellate::SURFACE);
  filter->Update();
  auto* surface = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(surface);
  EXPECT_EQ(OpenEdges(surface), 0);
  triangles->SetInputData(surface);
  enclosed->Update();
  EXPECT_LE(enclosed->GetVolume(), whole);
  EXPECT_GE(enclosed->GetVolume(), std::pow(1.0 - 1e-2, 2) * whole);
}

TEST(SplineTessellate, ToleranceIsRelativeToTheSize_PropertyOracle)
{
  vtkNew<vtkSplineSource> source;
  source->SetShape(vtkSplineSource::SPHERE_SURFACE);
  vtkNew<vtkSplineTessellate> filter;
  filter->SetInputConnection(source->GetOutputPort());
  filter->Update();
  const vtkIdType cells = filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL);
  source->SetOuterRadius(100.0);
  source->SetInnerRadius(50.0);
  filter->Update();
  EXPECT_EQ(filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL), cells);
  filter->RelativeToleranceOff();
  filter->Update();
  EXPECT_GT(filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL), cells);
}

TEST(SplineTessellate, LimitIsReported_PropertyOracle)
{
  vtkNew<vtkSplineTessellate> filter;
  vtkNew<MessageRecorder> recorder;
  recorder->Watch(filter);
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::SPHERE_SURFACE));
  filter->SetMaximumSubdivision(1);
  filter->Update();
  EXPECT_TRUE(recorder->Errors.empty());
  ASSERT_EQ(recorder->Warnings.size(), 1u);
  EXPECT_NE(recorder->Warnings[0].find("MaximumSubdivision"), std::string::npos);
  filter->SetMaximumSubdivision(8);
  filter->Update();
  EXPECT_EQ(recorder->Warnings.size(), 1u);
}

TEST(SplineTessellate, MixedModelsAndCollections_PropertyOracle)
{
  auto curve = ShapeGrid(vtkSplineSource::ARC);
  auto solid = ShapeGrid(vtkSplineSource::CUBE);
  vtkNew<vtkSplineTessellate> filter;
  filter->SetInputDataObject(Collect({ curve, solid }));
  filter->Update();
  auto* output = vtkPartitionedDataSetCollection::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(output);
  ASSERT_EQ(output->GetNumberOfPartitionedDataSets(), 2u);
  auto* lines = vtkPolyData::SafeDownCast(output->GetPartition(0, 0));
  auto* faces = vtkPolyData::SafeDownCast(output->GetPartition(1, 0));
  ASSERT_TRUE(lines && faces);
  EXPECT_GT(lines->GetNumberOfLines(), 4);
  EXPECT_EQ(faces->GetNumberOfPolys(), 6);
  // One model with both: cell arrays follow the order lines, polygons.
  SplineModel model = DecodePatches(solid);
  model.Patches.push_back(DecodePatches(curve).Patches[0]);
  model.Patches[1].Id = 7;
  vtkNew<vtkUnstructuredGrid> both;
  ASSERT_TRUE(EncodeSplineGrid(model, both));
  auto mesh = Tessellate(both, 1e-2);
  vtkDataArray* patchId = mesh->GetCellData()->GetArray("PatchId");
  for (vtkIdType c = 0; c < mesh->GetNumberOfCells(); ++c)
  {
    EXPECT_EQ(patchId->GetTuple1(c), mesh->GetCellType(c) == VTK_LINE ? 7.0 : 0.0);
  }
}

TEST(SplineTessellate, BezierGridsOfForeignOriginAreAccepted_PropertyOracle)
{
  auto grid = ShapeGrid(vtkSplineSource::SPHERE_SURFACE);
  grid->GetFieldData()->Initialize();
  for (const char* name : { "PatchBasis", "ParametricBounds", "Level", "ElementId" })
  {
    grid->GetCellData()->RemoveArray(name);
  }
  auto mesh = Tessellate(grid, 1e-2);
  EXPECT_EQ(OpenEdges(mesh), 0);
}

TEST(SplineTessellate, BadInputIsRefused)
{
  vtkNew<vtkSplineTessellate> filter;
  ExpectBadInputIsRefused(filter);
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::TORUS_SURFACE, 2, { 20, 20, 1 }));
  filter->SetChordalTolerance(1e-12);
  filter->SetMaximumSubdivision(10);
  ExpectFailure(filter, ErrorCode::TooLarge, "tolerance");
}
