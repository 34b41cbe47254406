// SPDX-License-Identifier: BSD-3-Clause
#include "FilterCases.h"
#include <knotwork/SplineCore/TensorSpace.h>
#include <knotwork/SplineGrid/vtkSplineControlNet.h>
#include <knotwork/SplineGrid/vtkSplineRefine.h>

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <set>

using namespace knotwork;

namespace
{
vtkSmartPointer<vtkPolyData> NetOf(vtkDataObject* data)
{
  vtkNew<vtkSplineControlNet> filter;
  filter->SetInputDataObject(data);
  filter->Update();
  return vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
}

int IntAt(vtkFieldData* arrays, const char* name, vtkIdType id)
{
  return static_cast<int>(arrays->GetArray(name)->GetTuple1(id));
}
}

TEST(vtkSplineControlNet, PointsAreTheControlPoints_CrossOracle)
{
  const auto grid = ShapeGrid(vtkSplineSource::SOLID_CYLINDER, 2, { 2, 3, 1 });
  const auto net = NetOf(grid);
  ASSERT_TRUE(net);
  vtkIdType next = 0;
  for (const SplinePatch& patch : DecodePatches(grid).Patches)
  {
    const auto& spline = std::get<Spline<3>>(patch.Geometry);
    const PointMatrix greville = GrevillePoints(*spline.Space);
    for (int i = 0; i < spline.Space->NumFunctions; ++i, ++next)
    {
      ASSERT_LT(next, net->GetNumberOfPoints());
      double x[3];
      net->GetPoint(next, x);
      for (int c = 0; c < 3; ++c)
      {
        EXPECT_EQ(x[c], spline.ControlPoints(i, c));
        EXPECT_NEAR(
          net->GetPointData()->GetArray("Greville")->GetComponent(next, c), greville(i, c), 1e-15);
      }
      EXPECT_EQ(net->GetPointData()->GetArray("Weight")->GetTuple1(next),
        spline.IsRational() ? spline.Weights[i] : 1.0);
      EXPECT_EQ(IntAt(net->GetPointData(), "FunctionId", next), i);
      EXPECT_EQ(IntAt(net->GetPointData(), "PatchId", next), patch.Id);
      EXPECT_EQ(IntAt(net->GetPointData(), "Level", next), 0);
    }
  }
  EXPECT_EQ(next, net->GetNumberOfPoints());
}

TEST(vtkSplineControlNet, LinesOfAGrid_GoldenOracle)
{
  const auto net = NetOf(ShapeGrid(vtkSplineSource::SQUARE, 2, { 2, 3, 1 })); // 4 x 5 points
  EXPECT_EQ(net->GetNumberOfVerts(), 20);
  EXPECT_EQ(net->GetNumberOfLines(), 3 * 5 + 4 * 4);
  // point i + 4 j is joined to its right and its upper neighbour
  std::set<std::array<vtkIdType, 3>> expected; // first, last, direction
  for (vtkIdType p = 0; p < 20; ++p)
  {
    if (p % 4 < 3)
    {
      expected.insert({ p, p + 1, 0 });
    }
    if (p / 4 < 4)
    {
      expected.insert({ p, p + 4, 1 });
    }
  }
  std::set<std::array<vtkIdType, 3>> found;
  std::set<vtkIdType> vertices;
  std::array<int, 3> count{};
  for (vtkIdType cell = 0; cell < net->GetNumberOfCells(); ++cell)
  {
    const int direction = IntAt(net->GetCellData(), "Direction", cell);
    ++count[static_cast<std::size_t>(direction + 1)];
    EXPECT_EQ(net->GetCellType(cell), direction < 0 ? VTK_VERTEX : VTK_LINE);
    vtkIdType n;
    const vtkIdType* ids;
    net->GetCellPoints(cell, n, ids);
    if (direction >= 0)
    {
      found.insert({ ids[0], ids[1], direction });
    }
    else
    {
      vertices.insert(ids[0]);
    }
  }
  EXPECT_EQ(count, (std::array<int, 3>{ 20, 15, 16 }));
  EXPECT_EQ(found, expected);
  EXPECT_EQ(vertices.size(), 20u);
}

TEST(vtkSplineControlNet, EveryLevelHasItsOwnNet_PropertyOracle)
{
  auto grid = ShapeGrid(vtkSplineSource::SQUARE, 2, { 8, 8, 1 });
  vtkNew<vtkDoubleArray> error;
  error->SetName("Error");
  for (vtkIdType cell = 0; cell < 64; ++cell)
  {
    error->InsertNextValue(cell == 27 || cell == 28 ? 1.0 : 0.0);
  }
  grid->GetCellData()->AddArray(error);
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputData(grid);
  refine->SetMode(vtkSplineRefine::CELL_ARRAY);
  refine->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "Error");
  refine->SetLowerThreshold(0.5);
  refine->SetNumberOfRefinements(2);
  refine->Update();
  const auto net = NetOf(refine->GetOutputDataObject(0));
  std::set<int> levels;
  int lines = 0;
  for (vtkIdType cell = 0; cell < net->GetNumberOfCells(); ++cell)
  {
    vtkIdType n;
    const vtkIdType* ids;
    net->GetCellPoints(cell, n, ids);
    if (n == 2)
    {
      ++lines;
      const int level = IntAt(net->GetPointData(), "Level", ids[0]);
      EXPECT_EQ(level, IntAt(net->GetPointData(), "Level", ids[1]));
      EXPECT_EQ(level, IntAt(net->GetCellData(), "Level", cell));
      levels.insert(level);
      // neighbours: Greville points differ in the line's direction only
      const int other = 1 - IntAt(net->GetCellData(), "Direction", cell);
      vtkDataArray* greville = net->GetPointData()->GetArray("Greville");
      EXPECT_EQ(greville->GetComponent(ids[0], other), greville->GetComponent(ids[1], other));
    }
  }
  EXPECT_GT(lines, 0);
  EXPECT_EQ(levels, (std::set<int>{ 0, 1, 2 }));
}

TEST(vtkSplineControlNet, OptionsAndCollections_GoldenOracle)
{
  vtkNew<vtkSplineControlNet> filter;
  filter->SetInputDataObject(Collect({ ShapeGrid(vtkSplineSource::SQUARE),
    ShapeGrid(vtkSplineSource::CUBE), ShapeGrid(vtkSplineSource::LINE) }));
  filter->Update();
  auto* nets = vtkPartitionedDataSetCollection::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(nets);
  ASSERT_EQ(nets->GetNumberOfPartitionedDataSets(), 3u);
  const int lines[3] = { 4, 12, 1 };
  for (unsigned int b = 0; b < 3; ++b)
  {
    auto* net = vtkPolyData::SafeDownCast(nets->GetPartition(b, 0));
    ASSERT_TRUE(net);
    EXPECT_EQ(net->GetNumberOfLines(), lines[b]);
    EXPECT_GT(net->GetNumberOfVerts(), 0);
  }
  filter->SetInputDataObject(ShapeGrid(vtkSplineSource::SQUARE));
  filter->VerticesOff();
  filter->Update();
  auto* net = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(net);
  EXPECT_EQ(net->GetNumberOfVerts(), 0);
  EXPECT_EQ(net->GetNumberOfLines(), 4);
  EXPECT_EQ(net->GetNumberOfPoints(), 4);
  filter->LinesOff();
  filter->VerticesOn();
  filter->Update();
  EXPECT_EQ(net->GetNumberOfVerts(), 4);
  EXPECT_EQ(net->GetNumberOfLines(), 0);
}

TEST(vtkSplineControlNet, BadInputIsRefused)
{
  vtkNew<vtkSplineControlNet> filter;
  ExpectBadInputIsRefused(filter);
}
