// SPDX-License-Identifier: BSD-3-Clause
#include "FilterCases.h"
#include "MeshDatasets.h"
#include <knotwork/SplineCore/MeshPatches.h>
#include <knotwork/SplineGrid/vtkMeshPatches.h>

#include "vtkTable.h"
#include "vtkVariant.h"

#include <limits>

using namespace knotwork;

namespace
{
vtkPolyData* Cuts(vtkMeshPatches* filter)
{
  return vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
}

int Entry(vtkMeshPatches* filter, vtkIdType row, const char* column)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(2))
    ->GetValueByName(row, column)
    .ToInt();
}

/// Cells are at the places that the kernel tells, and the table has their grids.
template <int Dim>
void ExpectPlaces(vtkMeshPatches* filter, const MeshPatches<Dim>& expected)
{
  auto* output = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  auto* ids = output->GetCellData()->GetArray("PatchId");
  auto* places = output->GetCellData()->GetArray("PatchIndex");
  ASSERT_TRUE(ids && places);
  ASSERT_EQ(output->GetNumberOfCells(), static_cast<vtkIdType>(expected.PatchOf.size()));
  for (vtkIdType c = 0; c < output->GetNumberOfCells(); ++c)
  {
    EXPECT_EQ(ids->GetTuple1(c), expected.PatchOf[static_cast<std::size_t>(c)]);
    for (int d = 0; d < 3; ++d)
    {
      EXPECT_EQ(places->GetComponent(c, d),
        d < Dim ? expected.IndexOf[static_cast<std::size_t>(c)][static_cast<std::size_t>(d % Dim)]
                : 0);
    }
  }
  auto* table = vtkTable::SafeDownCast(filter->GetOutputDataObject(2));
  ASSERT_EQ(table->GetNumberOfRows(), static_cast<vtkIdType>(expected.Patches.size()));
  for (vtkIdType p = 0; p < table->GetNumberOfRows(); ++p)
  {
    const auto& patch = expected.Patches[static_cast<std::size_t>(p)];
    EXPECT_EQ(Entry(filter, p, "PatchId"), p);
    EXPECT_EQ(Entry(filter, p, "Cells"), static_cast<int>(patch.Cells.size()));
    EXPECT_EQ(Entry(filter, p, "Size0"), patch.Size[0]);
    EXPECT_EQ(Entry(filter, p, "Size1"), patch.Size[1]);
    EXPECT_EQ(Entry(filter, p, "Size2"), Dim == 3 ? patch.Size[Dim - 1] : 1);
  }
  EXPECT_EQ(Cuts(filter)->GetNumberOfVerts(), static_cast<vtkIdType>(expected.TJoints.size()));
  EXPECT_EQ(Cuts(filter)->GetNumberOfCells() - Cuts(filter)->GetNumberOfVerts(),
    static_cast<vtkIdType>(expected.Cuts.size()));
}
}

TEST(vtkMeshPatches, PatchesAreThoseOfTheKernel_CrossOracle)
{
  const CellMesh<2> sphere = meshes::CubeSphere(3);
  for (const bool tracks : { false, true })
  {
    vtkNew<vtkMeshPatches> filter;
    filter->SetInputDataObject(Sphere(3));
    filter->SetLayout(tracks ? vtkMeshPatches::MOTORCYCLE_GRAPH : vtkMeshPatches::BASE_COMPLEX);
    filter->Update();
    ExpectPlaces<2>(filter,
      FindMeshPatches<2>(sphere, tracks ? CreasePolicy::Motorcycle : CreasePolicy::Full).Value);
  }
  // five sectors of two layers
  const CellMesh<3> layers = meshes::Sweep(meshes::Star(5, 2), 2);
  PointMatrix points = PointMatrix::Random(layers.NumPoints, 3);
  vtkNew<vtkMeshPatches> filter;
  filter->SetInputDataObject(MakeGrid(layers, points, VTK_HEXAHEDRON));
  filter->Update();
  ExpectPlaces<3>(filter, FindMeshPatches<3>(layers).Value);
  EXPECT_EQ(Cuts(filter)->GetNumberOfPolys(), 5 * 2 * 2);
  EXPECT_EQ(Cuts(filter)->GetCellType(0), VTK_QUAD);
}

TEST(vtkMeshPatches, CutsLieBetweenPatches_ExactOracle)
{
  // 4 x 2 cells with a feature after the first column
  const CellMesh<2> mesh = meshes::Grid<2>({ 4, 2 });
  const auto data = MakePolyData(mesh, GridPoints({ 4, 2, 0 }));
  vtkNew<vtkIntArray> part;
  part->SetName("Part");
  for (int c = 0; c < 8; ++c)
  {
    part->InsertNextValue(c % 4 == 0 ? 3 : 5);
  }
  data->GetCellData()->AddArray(part);
  vtkNew<vtkMeshPatches> filter;
  filter->SetInputDataObject(data);
  filter->Update();
  EXPECT_EQ(Cuts(filter)->GetNumberOfCells(), 0);
  filter->SetFeatureArray("Part");
  filter->Update();
  ASSERT_EQ(Cuts(filter)->GetNumberOfLines(), 2);
  EXPECT_EQ(Entry(filter, 0, "Size0"), 1);
  EXPECT_EQ(Entry(filter, 1, "Size0"), 3);
  auto* beside = Cuts(filter)->GetCellData()->GetArray("Patches");
  for (vtkIdType i = 0; i < 2; ++i)
  {
    EXPECT_EQ(beside->GetComponent(i, 0), 0);
    EXPECT_EQ(beside->GetComponent(i, 1), 1);
    double bounds[6];
    Cuts(filter)->GetCellBounds(i, bounds);
    EXPECT_EQ(bounds[0], 1.0);
    EXPECT_EQ(bounds[1], 1.0);
    EXPECT_EQ(bounds[3] - bounds[2], 1.0);
  }
  auto* output = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_EQ(output->GetCellData()->GetArray("Part")->GetTuple1(4), 3.0);
}

TEST(vtkMeshPatches, TracksThatEndOnOthersHaveJoints_ExactOracle)
{
  vtkNew<vtkMeshPatches> filter;
  vtkIdType joints = 0;
  meshes::Random random(1);
  for (int trial = 0; trial < 40; ++trial)
  {
    const CellMesh<2> mesh = meshes::RandomMesh<2>(random, 60);
    const auto expected = FindMeshPatches<2>(mesh, CreasePolicy::Motorcycle);
    PointMatrix points = PointMatrix::Random(mesh.NumPoints, 3);
    filter->SetInputDataObject(MakePolyData(mesh, points));
    filter->SetLayout(vtkMeshPatches::MOTORCYCLE_GRAPH);
    filter->Update();
    ExpectPlaces<2>(filter, expected.Value);
    joints += Cuts(filter)->GetNumberOfVerts();
  }
  EXPECT_GT(joints, 5);
}

TEST(vtkMeshPatches, EveryFailureIsReachable_ExactOracle)
{
  vtkNew<vtkMeshPatches> filter;
  const auto expect = [&](vtkDataObject* data, ErrorCode code, const char* words)
  {
    SCOPED_TRACE(words);
    filter->SetInputDataObject(data);
    ExpectFailure(filter, code, words);
  };
  vtkNew<vtkPolyData> nothing;
  expect(nothing, ErrorCode::EmptyInput, "the mesh has no cells");
  const auto sphere = Sphere(2);
  filter->SetFeatureArray("Absent");
  expect(sphere, ErrorCode::InvalidParameter, "no cell array 'Absent'");
  filter->SetFeatureArray(nullptr);
  const auto hexahedra =
    MakeGrid(meshes::Grid<3>({ 1, 1, 1 }), GridPoints({ 1, 1, 1 }), VTK_HEXAHEDRON);
  filter->SetFeatureAngle(20.0);
  expect(hexahedra, ErrorCode::InvalidParameter, "FeatureAngle is for quadrilaterals");
  filter->SetFeatureAngle(180.0);
  filter->SetLayout(vtkMeshPatches::MOTORCYCLE_GRAPH);
  expect(hexahedra, ErrorCode::InvalidParameter, "of quadrilaterals between tracks");
  filter->SetLayout(vtkMeshPatches::BASE_COMPLEX);
  auto holes = Sphere(2);
  holes->GetPoints()->SetPoint(3, 0.0, std::numeric_limits<double>::infinity(), 0.0);
  expect(holes, ErrorCode::NonFiniteInput, "point 3");
  auto twice = Sphere(2);
  twice->GetPolys()->InsertNextCell({ 0, 1, 2, 3 });
  expect(twice, ErrorCode::InvalidTopology, "cell");
  filter->SetInputDataObject(sphere);
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
}
