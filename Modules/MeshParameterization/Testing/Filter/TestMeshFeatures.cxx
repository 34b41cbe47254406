// SPDX-License-Identifier: BSD-3-Clause
// The features are tested in the kernel; here: what the filter takes and gives out.
#include "FeatureCases.h"
#include "FilterCases.h"
#include "MeshPolygons.h"
#include <knotwork/MeshParameterization/vtkMeshFeatures.h>

#include "vtkCell.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkIdList.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkTable.h"
#include "vtkTypeInt64Array.h"
#include "vtkTypeUInt64Array.h"
#include "vtkVariant.h"

#include <cmath>
#include <limits>
#include <set>

using namespace knotwork;

namespace
{
/// A line through points.
vtkSmartPointer<vtkPolyData> Line(const std::vector<std::array<double, 3>>& places)
{
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell(static_cast<int>(places.size()));
  for (const auto& place : places)
  {
    lines->InsertCellPoint(points->InsertNextPoint(place.data()));
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetLines(lines);
  return data;
}

vtkPolyData* Polygons(vtkMeshFeatures* filter, int port)
{
  return vtkPolyData::SafeDownCast(filter->GetOutputDataObject(port));
}

double Cell(vtkPolyData* data, const char* array, vtkIdType cell)
{
  return data->GetCellData()->GetArray(array)->GetComponent(cell, 0);
}

double Number(vtkMeshFeatures* filter, const char* name)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(3))->GetValueByName(0, name).ToDouble();
}
}

TEST(vtkMeshFeatures, NoisyCubeHasTwelveLinesEightCornersSixRegions_Exact)
{
  TriangleMesh cube = DividedCube(20);
  AddNoise(0.002 * std::sqrt(3.0), 1, cube);
  vtkNew<vtkMeshFeatures> filter;
  filter->SetInputDataObject(Encode(cube));
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  auto* triangles = Polygons(filter, 0);
  ASSERT_EQ(triangles->GetNumberOfPolys(), 4800);
  std::set<double> regions;
  for (vtkIdType t = 0; t < 4800; ++t)
  {
    regions.insert(Cell(triangles, "RegionId", t));
    EXPECT_EQ(Cell(triangles, "RegionId", t), static_cast<double>(t / 800));
  }
  EXPECT_EQ(regions.size(), 6u);
  auto* lines = Polygons(filter, 1);
  ASSERT_EQ(lines->GetNumberOfLines(), 12);
  for (vtkIdType line = 0; line < 12; ++line)
  {
    EXPECT_EQ(Cell(lines, "ChainId", line), static_cast<double>(line));
    EXPECT_EQ(Cell(lines, "Closed", line), 0.0);
    EXPECT_EQ(Cell(lines, "Rim", line), 0.0);
    EXPECT_NEAR(Cell(lines, "MeanAngle", line), 90.0, 5.0);
    EXPECT_GE(Cell(lines, "Angle", line), Cell(lines, "MeanAngle", line));
    EXPECT_NEAR(Cell(lines, "Length", line), 1.0, 0.05);
    EXPECT_EQ(lines->GetCell(line)->GetNumberOfPoints(), 21);
  }
  // points of lines and corners are those of the mesh, which their ids tell
  for (const int port : { 1, 2 })
  {
    vtkPolyData* data = Polygons(filter, port);
    vtkDataArray* ids = data->GetPointData()->GetArray("PointIds");
    ASSERT_EQ(ids->GetNumberOfTuples(), data->GetNumberOfPoints());
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
    {
      const auto id = static_cast<Eigen::Index>(ids->GetComponent(i, 0));
      EXPECT_EQ(data->GetPoint(i)[0], cube.Points(id, 0));
      EXPECT_EQ(data->GetPoint(i)[2], cube.Points(id, 2));
    }
  }
  EXPECT_EQ(Polygons(filter, 2)->GetNumberOfVerts(), 8);
  EXPECT_EQ(Number(filter, "SharpEdges"), 240.0);
  EXPECT_EQ(Number(filter, "RimEdges"), 0.0);
  EXPECT_EQ(Number(filter, "Chains"), 12.0);
  EXPECT_EQ(Number(filter, "ClosedChains"), 0.0);
  EXPECT_EQ(Number(filter, "Corners"), 8.0);
  EXPECT_EQ(Number(filter, "Regions"), 6.0);
  EXPECT_NEAR(Number(filter, "NoiseLevel"), 0.002 * std::sqrt(3.0), 3e-4);
}

TEST(vtkMeshFeatures, ClosedChainsRepeatTheirFirstPoint_Exact)
{
  vtkNew<vtkMeshFeatures> filter;
  filter->SetInputDataObject(Encode(Turned({ { 0, 0 }, { 1, 0 }, { 1, 2 } }, 30))); // a cup
  filter->Update();
  EXPECT_EQ(Number(filter, "ClosedChains"), 2.0);
  EXPECT_EQ(Number(filter, "Corners"), 0.0);
  EXPECT_EQ(Number(filter, "SharpEdges"), 30.0);
  EXPECT_EQ(Number(filter, "RimEdges"), 30.0);
  auto* lines = Polygons(filter, 1);
  ASSERT_EQ(lines->GetNumberOfLines(), 2);
  EXPECT_EQ(lines->GetNumberOfPoints(), 60);
  vtkNew<vtkIdList> ids;
  int rims = 0;
  for (vtkIdType line = 0; line < 2; ++line)
  {
    lines->GetCellPoints(line, ids);
    ASSERT_EQ(ids->GetNumberOfIds(), 31);
    EXPECT_EQ(ids->GetId(0), ids->GetId(30));
    EXPECT_EQ(Cell(lines, "Closed", line), 1.0);
    EXPECT_NEAR(Cell(lines, "Length", line), 60.0 * std::sin(Pi / 30.0), 1e-12);
    const bool isRim = Cell(lines, "Rim", line) == 1.0;
    rims += isRim ? 1 : 0;
    EXPECT_NEAR(Cell(lines, "MeanAngle", line), isRim ? 0.0 : 90.0, 1e-9);
  }
  EXPECT_EQ(rims, 1);
}

TEST(vtkMeshFeatures, OptionsReachTheKernel_Property)
{
  const double w = 0.004;
  vtkNew<vtkMeshFeatures> filter;
  filter->SetInputDataObject(
    Encode(Turned({ { 0, 0 }, { 1, 0 }, { 1, 1 - w }, { 1 - w, 1 }, { 0, 1 } }, 40)));
  const auto number = [&](const char* name)
  {
    filter->Update();
    return Number(filter, name);
  };
  EXPECT_EQ(number("Chains"), 2.0);
  EXPECT_EQ(number("JoinedRegions"), 1.0);
  filter->SetNarrowWidth(0.0);
  EXPECT_EQ(number("Chains"), 3.0);
  filter->SetSmallestRegion(0.1);
  EXPECT_EQ(number("Chains"), 2.0);
  filter->SetSharpAngle(91.0);
  EXPECT_EQ(number("Chains"), 0.0);
  filter->SetSharpAngle(40.0);
  filter->SetSmallestRegion(0.0);
  filter->SetWeakAngle(5.0); // of the sides of the cylinder, too
  EXPECT_GT(number("Chains"), 40.0);
  filter->SetNoiseLevel(0.5);
  EXPECT_EQ(number("NoiseLevel"), 0.5);
}

TEST(vtkMeshFeatures, EdgesAndRegionsExtendOrReplace_Exact)
{
  const auto mesh = Encode(DividedCube(4));
  vtkNew<vtkMeshFeatures> filter;
  filter->SetInputDataObject(mesh);
  filter->SetEdgesData(Line({ { 0.5, 0, 1 }, { 0.5, 1, 1 } })); // over the points between
  filter->Update();
  EXPECT_EQ(Number(filter, "Regions"), 7.0);
  EXPECT_EQ(Number(filter, "SharpEdges"), 52.0);
  filter->SetMode(vtkMeshFeatures::REPLACE);
  filter->Update();
  EXPECT_EQ(Number(filter, "Regions"), 1.0);
  EXPECT_EQ(Number(filter, "SharpEdges"), 4.0);
  filter->SetEdgesData(nullptr);
  vtkNew<vtkIntArray> halves;
  halves->SetName("Halves");
  for (vtkIdType t = 0; t < mesh->GetNumberOfPolys(); ++t)
  {
    halves->InsertNextValue(t < 96 ? 5 : -5); // three faces and three
  }
  mesh->GetCellData()->AddArray(halves);
  filter->SetRegionArray("Halves");
  filter->Update();
  EXPECT_EQ(Number(filter, "Regions"), 2.0);
  EXPECT_EQ(Cell(Polygons(filter, 0), "Halves", 0), 5.0); // data is kept
  filter->SetRegionArray("None");
  filter->SetMode(vtkMeshFeatures::EXTEND);
  filter->Update();
  EXPECT_EQ(Number(filter, "Regions"), 6.0);
}

/// Beyond 2^53 doubles are the same for several integers.
TEST(vtkMeshFeatures, LargeRegionNumbersStayApart_Exact)
{
  const auto mesh = Encode(DividedCube(4));
  vtkNew<vtkTypeInt64Array> halves;
  vtkNew<vtkTypeUInt64Array> unsignedHalves;
  halves->SetName("Halves");
  unsignedHalves->SetName("UnsignedHalves");
  const vtkTypeInt64 large = vtkTypeInt64(1) << 53;
  for (vtkIdType t = 0; t < mesh->GetNumberOfPolys(); ++t)
  {
    halves->InsertNextValue(t < 96 ? large : large + 1); // three faces and three
    unsignedHalves->InsertNextValue(~vtkTypeUInt64(0) - (t < 96 ? 0 : 1));
  }
  mesh->GetCellData()->AddArray(halves);
  mesh->GetCellData()->AddArray(unsignedHalves);
  vtkNew<vtkMeshFeatures> filter;
  filter->SetInputDataObject(mesh);
  filter->SetMode(vtkMeshFeatures::REPLACE);
  for (const char* name : { "Halves", "UnsignedHalves" })
  {
    filter->SetRegionArray(name);
    filter->Update();
    EXPECT_EQ(Number(filter, "Regions"), 2.0) << name;
  }
}

TEST(vtkMeshFeatures, ItsOwnLinesGiveTheSameAgain_Property)
{
  TriangleMesh cube = DividedCube(10);
  AddNoise(0.005, 7, cube);
  vtkNew<vtkMeshFeatures> first;
  first->SetInputDataObject(Encode(cube));
  vtkNew<vtkMeshFeatures> second;
  second->SetInputDataObject(Encode(cube));
  second->SetEdgesConnection(first->GetOutputPort(1));
  second->SetMode(vtkMeshFeatures::REPLACE);
  second->Update();
  for (const char* name : { "SharpEdges", "Regions", "Corners", "Chains" })
  {
    EXPECT_EQ(Number(first, name), Number(second, name)) << name;
  }
}

TEST(vtkMeshFeatures, Errors)
{
  vtkNew<vtkMeshFeatures> filter;
  vtkNew<vtkPolyData> empty;
  filter->SetInputDataObject(empty);
  ExpectFailure(filter, ErrorCode::EmptyInput, "no triangles");
  const auto cube = Encode(DividedCube(2));
  cube->GetPoints()->SetPoint(7, 0.0, std::numeric_limits<double>::quiet_NaN(), 0.0);
  filter->SetInputDataObject(cube);
  ExpectFailure(filter, ErrorCode::NonFiniteInput, "1 point (7)");
  filter->SetEdgesData(Line({ { 0, 0, 0 }, { 1, 0, 0 } }));
  ExpectFailure(filter, ErrorCode::NonFiniteInput, "1 point (7)");
  const auto mesh = Encode(DividedCube(2));
  filter->SetInputDataObject(mesh);
  filter->SetEdgesData(Line({ { 0, 0, 0 }, { 0.3, 0, 0 } }));
  ExpectFailure(filter, ErrorCode::OutsideDomain, "1 point (1) of the known edges");
  filter->SetEdgesData(Line({ { 0, 0, 0 }, { 0, std::numeric_limits<double>::infinity(), 0 } }));
  ExpectFailure(filter, ErrorCode::NonFiniteInput, "point 1 of the known edges");
  filter->SetEdgesData(empty);
  ExpectFailure(filter, ErrorCode::EmptyInput, "have no lines");
  filter->SetEdgesData(nullptr);
  filter->SetRegionArray("Parts");
  ExpectFailure(filter, ErrorCode::InvalidParameter, "no cell array 'Parts'");
  vtkNew<vtkDoubleArray> parts;
  parts->SetName("Parts");
  parts->SetNumberOfComponents(2);
  parts->SetNumberOfTuples(48);
  parts->Fill(0.0);
  mesh->GetCellData()->AddArray(parts);
  ExpectFailure(filter, ErrorCode::InvalidParameter, "has 2 components");
  parts->SetNumberOfComponents(1);
  parts->SetNumberOfTuples(48);
  parts->Fill(0.0);
  parts->SetValue(3, std::numeric_limits<double>::quiet_NaN());
  ExpectFailure(filter, ErrorCode::NonFiniteInput, "no number at cell 3");
  filter->SetRegionArray(nullptr);
  filter->SetSharpAngle(10.0);
  ExpectFailure(filter, ErrorCode::InvalidParameter, "WeakAngle");
  filter->SetSharpAngle(40.0);
  filter->SetMode(vtkMeshFeatures::REPLACE);
  ExpectFailure(filter, ErrorCode::InvalidParameter, "none are given");
}

TEST(vtkMeshFeatures, ProgressAndAbort)
{
  vtkNew<vtkMeshFeatures> filter;
  filter->SetInputDataObject(Encode(DividedCube(20)));
  ExpectProgressAndAbort(filter, 2);
}
