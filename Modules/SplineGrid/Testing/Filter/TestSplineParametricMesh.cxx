// SPDX-License-Identifier: BSD-3-Clause
#include "FilterCases.h"
#include <knotwork/SplineGrid/vtkSplineParametricMesh.h>
#include <knotwork/SplineGrid/vtkSplineRefine.h>

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkPointData.h"
#include "vtkSphere.h"

#include <cmath>
#include <map>

using namespace knotwork;

namespace
{
vtkSmartPointer<vtkUnstructuredGrid> MeshOf(vtkDataObject* data, bool sideBySide = true)
{
  vtkNew<vtkSplineParametricMesh> filter;
  filter->SetSideBySide(sideBySide);
  filter->SetInputDataObject(data);
  filter->Update();
  return vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
}

/// The grid of a shape refined locally inside a sphere.
vtkSmartPointer<vtkUnstructuredGrid> LocallyRefined(int shape, std::array<int, 3> elements)
{
  vtkNew<vtkSphere> sphere;
  sphere->SetRadius(0.3);
  sphere->SetCenter(0.3, 0.3, 0.0);
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputData(ShapeGrid(shape, 2, elements));
  refine->SetMode(vtkSplineRefine::IMPLICIT_FUNCTION);
  refine->SetImplicitFunction(sphere);
  refine->SetNumberOfRefinements(2);
  refine->Update();
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->DeepCopy(refine->GetOutputDataObject(0));
  return grid;
}
}

TEST(vtkSplineParametricMesh, CellsAreTheElementsBoxes_CrossOracle)
{
  for (const int shape : { vtkSplineSource::SQUARE, vtkSplineSource::CUBE })
  {
    const auto grid = LocallyRefined(shape, { 4, 3, 2 });
    const auto mesh = MeshOf(grid, false);
    ASSERT_TRUE(mesh);
    ASSERT_EQ(mesh->GetNumberOfCells(), grid->GetNumberOfCells());
    vtkDataArray* bounds = grid->GetCellData()->GetArray("ParametricBounds");
    double volume = 0.0;
    for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
    {
      double box[6];
      mesh->GetCellBounds(cell, box);
      double size = 1.0;
      for (int d = 0; d < (shape == vtkSplineSource::CUBE ? 3 : 2); ++d)
      {
        EXPECT_EQ(box[2 * d], bounds->GetComponent(cell, 2 * d));
        EXPECT_EQ(box[2 * d + 1], bounds->GetComponent(cell, 2 * d + 1));
        size *= box[2 * d + 1] - box[2 * d];
      }
      volume += size;
      for (const char* name : { "PatchId", "ElementId", "Level" })
      {
        EXPECT_EQ(mesh->GetCellData()->GetArray(name)->GetTuple1(cell),
          grid->GetCellData()->GetArray(name)->GetTuple1(cell));
      }
    }
    EXPECT_NEAR(volume, 1.0, 1e-14); // the boxes tile the domain
    EXPECT_EQ(mesh->GetCellData()->GetArray("Level")->GetRange()[1], 2.0);
  }
}

TEST(vtkSplineParametricMesh, CornersAreInTheOrderOfVTK_PropertyOracle)
{
  const auto mesh = MeshOf(ShapeGrid(vtkSplineSource::CUBE, 1, { 2, 2, 2 }));
  EXPECT_EQ(mesh->GetNumberOfPoints(), 27);
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    ASSERT_EQ(mesh->GetCellType(cell), VTK_HEXAHEDRON);
    vtkIdType n;
    const vtkIdType* ids;
    mesh->GetCellPoints(cell, n, ids);
    const auto edge = [&](int a, int b)
    {
      double x[3];
      double y[3];
      mesh->GetPoint(ids[a], x);
      mesh->GetPoint(ids[b], y);
      return std::array<double, 3>{ y[0] - x[0], y[1] - x[1], y[2] - x[2] };
    };
    const std::array<double, 3> u{ 0.5, 0.0, 0.0 };
    const std::array<double, 3> v{ 0.0, 0.5, 0.0 };
    const std::array<double, 3> w{ 0.0, 0.0, 0.5 };
    for (const int k : { 0, 4 })
    {
      EXPECT_EQ(edge(k, k + 1), u);
      EXPECT_EQ(edge(k + 3, k + 2), u);
      EXPECT_EQ(edge(k, k + 3), v);
    }
    EXPECT_EQ(edge(0, 4), w);
  }
}

TEST(vtkSplineParametricMesh, PatchesStandSideBySide_GoldenOracle)
{
  vtkNew<vtkSplineParametricMesh> filter;
  filter->SetInputData(ShapeGrid(vtkSplineSource::DISC, 2, { 2, 3, 1 }));
  filter->SetGap(0.25);
  filter->Update();
  auto* mesh = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(mesh);
  std::map<int, std::array<double, 2>> ranges;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    const int patch = static_cast<int>(mesh->GetCellData()->GetArray("PatchId")->GetTuple1(cell));
    double box[6];
    mesh->GetCellBounds(cell, box);
    auto [found, isNew] = ranges.emplace(patch, std::array<double, 2>{ box[0], box[1] });
    found->second[0] = std::min(found->second[0], box[0]);
    found->second[1] = std::max(found->second[1], box[1]);
  }
  ASSERT_EQ(ranges.size(), 5u);
  for (const auto& [patch, range] : ranges)
  {
    EXPECT_EQ(range[0], 1.25 * patch);
    EXPECT_EQ(range[1], 1.25 * patch + 1.0);
  }
  double parameters[2];
  mesh->GetPointData()->GetArray("Parameters")->GetRange(parameters, 0);
  EXPECT_EQ(parameters[0], 0.0);
  EXPECT_EQ(parameters[1], 1.0);
}

TEST(vtkSplineParametricMesh, CellArraysPass_CrossOracle)
{
  auto grid = ShapeGrid(vtkSplineSource::DISC, 2, { 2, 3, 1 });
  vtkNew<vtkDoubleArray> tag;
  tag->SetName("Tag");
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    tag->InsertNextValue(0.5 * static_cast<double>(cell));
  }
  grid->GetCellData()->AddArray(tag);
  vtkNew<vtkSplineParametricMesh> filter;
  filter->SetInputDataObject(Collect({ ShapeGrid(vtkSplineSource::LINE), grid }));
  filter->Update();
  auto* meshes = vtkPartitionedDataSetCollection::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(meshes);
  auto* line = vtkUnstructuredGrid::SafeDownCast(meshes->GetPartition(0, 0));
  auto* disc = vtkUnstructuredGrid::SafeDownCast(meshes->GetPartition(1, 0));
  ASSERT_TRUE(line && disc);
  EXPECT_EQ(line->GetCellType(0), VTK_LINE);
  ASSERT_TRUE(disc->GetCellData()->GetArray("Tag"));
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    EXPECT_EQ(disc->GetCellData()->GetArray("Tag")->GetTuple1(cell), tag->GetValue(cell));
  }
  EXPECT_GE(disc->GetBounds()[0], 1.0) << "blocks stand beside each other too";
}

TEST(vtkSplineParametricMesh, BezierElementsStandInRows_GoldenOracle)
{
  auto grid = ShapeGrid(vtkSplineSource::SQUARE, 2, { 3, 2, 1 });
  grid->GetFieldData()->Initialize();
  for (const char* name : { "ElementId", "Level", "ParametricBounds", "PatchBasis" })
  {
    grid->GetCellData()->RemoveArray(name);
  }
  const auto mesh = MeshOf(grid);
  ASSERT_EQ(mesh->GetNumberOfCells(), 6);
  EXPECT_EQ(mesh->GetNumberOfPoints(), 24); // nothing shared
  double box[6];
  mesh->GetCellBounds(4, box); // rows of three
  EXPECT_EQ(box[0], 1.0);
  EXPECT_EQ(box[2], 1.0);
  EXPECT_EQ(box[3], 2.0);
}

TEST(vtkSplineParametricMesh, BadInputIsRefused)
{
  vtkNew<vtkSplineParametricMesh> filter;
  ExpectBadInputIsRefused(filter);
}
