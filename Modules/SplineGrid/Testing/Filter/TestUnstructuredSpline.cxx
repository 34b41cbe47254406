// SPDX-License-Identifier: BSD-3-Clause
#include "FilterCases.h"
#include "MeshDatasets.h"
#include <knotwork/SplineCore/MeshGeometry.h>
#include <knotwork/SplineCore/MeshSpline.h>
#include <knotwork/SplineCore/MeshUntangling.h>
#include <knotwork/SplineCore/TangentPlanes.h>
#include <knotwork/SplineGrid/PatchSplit.h>
#include <knotwork/SplineGrid/vtkUnstructuredSpline.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkIntArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <cmath>
#include <limits>

using namespace knotwork;

namespace
{
double Number(vtkUnstructuredSpline* filter, const char* column)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(1))
    ->GetValueByName(0, column)
    .ToDouble();
}

/// The one patch of the output.
template <int Dim>
Spline<Dim> MadeSpline(vtkUnstructuredSpline* filter)
{
  filter->Update();
  SplineModel model = DecodePatches(filter->GetOutputDataObject(0));
  EXPECT_EQ(model.Patches.size(), 1U);
  return model.Patches.empty() ? Spline<Dim>() : std::get<Spline<Dim>>(model.Patches[0].Geometry);
}
}

TEST(vtkUnstructuredSpline, SplineIsThatOfTheKernel_CrossOracle)
{
  const int n = 4;
  const auto data = Sphere(n);
  const CellMesh<2> mesh = meshes::CubeSphere(n);
  const PointMatrix points = meshes::CubeSpherePoints(mesh, n);
  for (const int degree : { 1, 2, 3 })
  {
    for (const bool cage : { false, true })
    {
      UnstructuredParams params;
      params.Degree = degree;
      params.Policy = CreasePolicy::Full;
      const auto space = MakeUnstructuredSpace<2>(mesh, params);
      const auto expected = cage ? SplineOfCage<2>(space->Space, points)
                                 : SplineThroughVertices<2>(space->Space, points, 1);
      vtkNew<vtkUnstructuredSpline> filter;
      filter->SetInputDataObject(data);
      filter->SetDegree(degree);
      filter->SetPolicy(vtkUnstructuredSpline::FULL);
      filter->SetConstruction(
        cage ? vtkUnstructuredSpline::CONTROL_CAGE : vtkUnstructuredSpline::INTERPOLATION);
      const Spline<2> found = MadeSpline<2>(filter);
      EXPECT_EQ(found.Space->Kind, SpaceKind::Unstructured);
      EXPECT_EQ(found.ControlPoints, expected->ControlPoints);
      EXPECT_EQ(Number(filter, "Functions"), space->Space->NumFunctions);
      EXPECT_EQ(Number(filter, "Elements"), 6 * n * n);
      EXPECT_EQ(Number(filter, "CreasedFacets"), degree == 1 ? 0 : 12 * n);
      EXPECT_EQ(Number(filter, "InnerFacets"), 12 * n * n);
      EXPECT_EQ(Number(filter, "ExtraordinaryPoints"), 8);
      EXPECT_EQ(Number(filter, "Repairs"), 0);
      EXPECT_EQ(Number(filter, "Orientable"), 1);
      EXPECT_EQ(Number(filter, "MaxNormalAngle"), LargestCreaseAngle(expected.Value, {}, 1));
      EXPECT_EQ(Number(filter, "MaxVertexDistance"),
        DistanceFromVertices<2>(expected.Value, points, 1).Largest);
      EXPECT_EQ(vtkTable::SafeDownCast(filter->GetOutputDataObject(1))
                  ->GetValueByName(0, "Policy")
                  .ToString(),
        "Full");
    }
  }
}

TEST(vtkUnstructuredSpline, FieldsFollowLikePointsAndCellArraysPass_ExactOracle)
{
  const auto data = Sphere(3);
  vtkNew<vtkDoubleArray> field;
  field->SetName("Place");
  field->SetNumberOfComponents(3);
  vtkNew<vtkIntArray> ids;
  ids->SetName("Ids");
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    field->InsertNextTuple(data->GetPoint(i));
    ids->InsertNextValue(static_cast<int>(i));
  }
  data->GetPointData()->AddArray(field);
  data->GetPointData()->AddArray(ids);
  AddCellNumbers(data);
  vtkNew<vtkUnstructuredSpline> filter;
  filter->SetInputDataObject(data);
  filter->Update();
  const SplineModel model = DecodePatches(filter->GetOutputDataObject(0));
  ASSERT_EQ(model.Patches.size(), 1U);
  ASSERT_EQ(model.Patches[0].Fields.size(), 1U);
  EXPECT_EQ(model.Patches[0].Fields[0].Coefficients,
    std::get<Spline<2>>(model.Patches[0].Geometry).ControlPoints);
  auto* output = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  auto* numbers = output->GetCellData()->GetArray("Number");
  ASSERT_NE(numbers, nullptr);
  for (vtkIdType c = 0; c < output->GetNumberOfCells(); ++c)
  {
    EXPECT_EQ(numbers->GetTuple1(c), 100.0 + static_cast<double>(c));
  }
}

TEST(vtkUnstructuredSpline, HexahedraAndVoxelsAreOneVolume_ExactOracle)
{
  const std::array<int, 3> n{ 3, 4, 2 };
  const CellMesh<3> mesh = meshes::Grid<3>(n);
  const PointMatrix points = GridPoints(n);
  for (const int type : { VTK_HEXAHEDRON, VTK_VOXEL })
  {
    vtkNew<vtkUnstructuredSpline> filter;
    filter->SetInputDataObject(MakeGrid(mesh, points, type));
    filter->SetDegree(2);
    const Spline<3> found = MadeSpline<3>(filter);
    EXPECT_EQ(MeshOf(*found.Space).Corners, mesh.Corners);
    EXPECT_EQ(found.Space->NumFunctions, 5 * 6 * 4);
    // the identity is in the space
    EXPECT_LE(Number(filter, "MaxVertexDistance"), 1e-12);
    EXPECT_EQ(Number(filter, "MaxNormalAngle"), -1.0);
  }
  // pixels have the corners of voxels
  vtkNew<vtkUnstructuredGrid> pixels;
  pixels->SetPoints(MakePoints(GridPoints({ 2, 1, 0 })));
  for (vtkIdType c = 0; c < 2; ++c)
  {
    const vtkIdType ids[4] = { c, c + 1, c + 3, c + 4 };
    pixels->InsertNextCell(VTK_PIXEL, 4, ids);
  }
  vtkNew<vtkUnstructuredSpline> filter;
  filter->SetInputDataObject(pixels);
  filter->SetDegree(1);
  EXPECT_EQ(MeshOf(*MadeSpline<2>(filter).Space).Corners, meshes::Grid<2>({ 2, 1 }).Corners);
}

TEST(vtkUnstructuredSpline, FeaturesAreCreases_ExactOracle)
{
  // a cube: its edges are features by angle, or by an array of its sides
  const int n = 4;
  const CellMesh<2> mesh = meshes::CubeSphere(n);
  PointMatrix points = meshes::CubeSpherePoints(mesh, n);
  for (auto row : points.rowwise())
  {
    row /= row.cwiseAbs().maxCoeff();
  }
  const auto data = MakePolyData(mesh, points);
  vtkNew<vtkIntArray> sides;
  sides->SetName("Side");
  for (int c = 0; c < mesh.NumCells(); ++c)
  {
    sides->InsertNextValue(c / (n * n));
  }
  data->GetCellData()->AddArray(sides);
  for (const bool byAngle : { true, false })
  {
    vtkNew<vtkUnstructuredSpline> filter;
    filter->SetInputDataObject(data);
    filter->SetPolicy(vtkUnstructuredSpline::MINIMAL);
    filter->SetFeatureAngle(byAngle ? 60.0 : 180.0);
    filter->SetFeatureArray(byAngle ? "None" : "Side");
    const Spline<2> cube = MadeSpline<2>(filter);
    // the sides are planes, and angles at features do not count
    EXPECT_LE(Number(filter, "MaxNormalAngle"), 1e-6);
    EXPECT_NEAR(LargestCreaseAngle(cube), 90.0, 1e-6);
    filter->SetFeatureAngle(180.0);
    filter->SetFeatureArray(nullptr);
    filter->Update();
    EXPECT_GT(Number(filter, "MaxVertexDistance"), 1e-3); // round edges
  }
}

TEST(vtkUnstructuredSpline, TangentPlanesAreThoseOfTheKernel_CrossOracle)
{
  const int n = 4;
  const CellMesh<2> mesh = meshes::CubeSphere(n);
  const PointMatrix points = meshes::CubeSpherePoints(mesh, n);
  for (const bool cage : { false, true })
  {
    vtkNew<vtkUnstructuredSpline> filter;
    filter->SetInputDataObject(Sphere(n));
    filter->SetDegree(2);
    filter->SetConstruction(
      cage ? vtkUnstructuredSpline::CONTROL_CAGE : vtkUnstructuredSpline::INTERPOLATION);
    const Spline<2> before = MadeSpline<2>(filter);
    EXPECT_EQ(Number(filter, "TangentPlanes"), 0);
    EXPECT_EQ(Number(filter, "MaxNormalAngle"), Number(filter, "MaxNormalAngleBefore"));
    filter->TangentPlanesOn();
    const Spline<2> after = MadeSpline<2>(filter);
    EXPECT_EQ(Number(filter, "TangentPlanes"), 8);
    EXPECT_EQ(Number(filter, "MaxNormalAngleBefore"), LargestCreaseAngle(before));
    EXPECT_EQ(Number(filter, "MaxNormalAngle"), LargestCreaseAngle(after));
    const auto expected = MakeTangentPlanes(before, {}, cage ? PointMatrix() : points);
    EXPECT_EQ(after.ControlPoints, expected->Value.ControlPoints);
  }
}

TEST(vtkUnstructuredSpline, LengthsAreMeansOfSheets_CrossOracle)
{
  const std::array<int, 3> n{ 5, 3, 0 };
  PointMatrix points = GridPoints(n);
  points.col(0) = points.col(0).array().square().matrix();
  const CellMesh<2> mesh = meshes::Grid<2>({ n[0], n[1] });
  vtkNew<vtkUnstructuredSpline> filter;
  filter->SetInputDataObject(MakePolyData(mesh, points));
  filter->SetLengths(vtkUnstructuredSpline::MEAN);
  const Spline<2> found = MadeSpline<2>(filter);
  // the map of such intervals is linear
  EXPECT_LE(Number(filter, "MaxVertexDistance"), 1e-10);
  UnstructuredParams params;
  params.Lengths = MeanSheetLengths<2>(mesh, MeshTopology<2>::Make(mesh).Value, points).Value;
  const auto space = MakeUnstructuredSpace<2>(mesh, params);
  EXPECT_EQ(found.ControlPoints, SplineThroughVertices<2>(space->Space, points, 1)->ControlPoints);
}

TEST(vtkUnstructuredSpline, PolygonsAreSplit_ExactOracle)
{
  vtkNew<vtkPolyData> data;
  data->SetPoints(MakePoints(GridPoints({ 2, 1, 0 })));
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell({ 0, 1, 4, 3 });
  cells->InsertNextCell({ 1, 2, 5 });
  cells->InsertNextCell({ 1, 5, 4 });
  data->SetPolys(cells);
  AddCellNumbers(data);
  vtkNew<vtkUnstructuredSpline> filter;
  filter->SetInputDataObject(data);
  filter->SetDegree(1);
  ExpectFailure(filter, ErrorCode::InvalidTopology, "cell 1 is a vtkTriangle of 3 points");
  filter->SplitPolygonsOn();
  filter->Update();
  EXPECT_EQ(Number(filter, "Elements"), 4 + 3 + 3);
  EXPECT_EQ(Number(filter, "SplitPolygons"), 2);
  auto* output = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_EQ(output->GetCellData()->GetArray("Number")->GetTuple1(4), 101.0);
  EXPECT_LE(Number(filter, "MaxVertexDistance"), 1e-14);
}

TEST(vtkUnstructuredSpline, FoldedCellsAreUntangledAndThatIsSaid_CrossOracle)
{
  const CellMesh<2> mesh = meshes::Grid<2>({ 6, 6 });
  PointMatrix points = GridPoints({ 6, 6, 0 });
  points(24, 0) += 1.6; // in the middle, past the next point
  const auto data = MakePolyData(mesh, points);
  const auto space = MakeUnstructuredSpace<2>(mesh, {});
  vtkNew<vtkUnstructuredSpline> filter;
  vtkNew<MessageRecorder> messages;
  messages->Watch(filter);
  filter->SetInputDataObject(data);
  filter->SetUntangle(vtkUnstructuredSpline::OFF);
  EXPECT_EQ(MadeSpline<2>(filter).ControlPoints,
    SplineThroughVertices<2>(space->Space, points, 1)->ControlPoints);
  EXPECT_EQ(Number(filter, "FoldedCells"), -1);
  EXPECT_EQ(Number(filter, "MovedPoints"), 0);
  EXPECT_TRUE(messages->Warnings.empty());

  const auto topology = MeshTopology<2>::Make(mesh);
  for (const int rings : { 1, 2 })
  {
    UntanglingParams params;
    params.Rings = rings;
    const auto untangled = UntangleMesh<2>(mesh, topology.Value, points, params);
    messages->Warnings.clear();
    filter->SetUntangle(vtkUnstructuredSpline::CELLS);
    filter->SetUntangleRings(rings);
    EXPECT_EQ(MadeSpline<2>(filter).ControlPoints,
      SplineThroughVertices<2>(space->Space, untangled->Points, 1)->ControlPoints);
    EXPECT_EQ(Number(filter, "FoldedCells"), 2);
    EXPECT_EQ(Number(filter, "StillFolded"), 0);
    EXPECT_EQ(Number(filter, "FoldedElements"), -1);
    EXPECT_EQ(Number(filter, "MovedPoints"), untangled->NumMoved);
    EXPECT_EQ(Number(filter, "LargestMove"), untangled->LargestMove);
    EXPECT_GT(Number(filter, "MaxVertexDistance"), 1.0); // from where the point was
    ASSERT_EQ(messages->Warnings.size(), 1U);
    EXPECT_NE(
      messages->Warnings[0].find("2 quadrilaterals of the mesh are folded: "), std::string::npos);
  }
  filter->SetUntangle(vtkUnstructuredSpline::ELEMENTS);
  filter->Update();
  EXPECT_EQ(Number(filter, "FoldedElements"), 0);

  // where all points are fixed cells stay folded: corners alone
  const CellMesh<2> one = meshes::Grid<2>({ 1, 1 });
  PointMatrix corners = GridPoints({ 1, 1, 0 });
  corners.row(3) = Eigen::RowVector3d(0.2, 0.2, 0.0);
  filter->SetInputDataObject(MakePolyData(one, corners));
  messages->Warnings.clear();
  filter->Update();
  EXPECT_EQ(Number(filter, "StillFolded"), 1);
  ASSERT_EQ(messages->Warnings.size(), 1U);
  EXPECT_NE(messages->Warnings[0].find("1 quadrilaterals stay folded, the first is cell 0"),
    std::string::npos);
}

TEST(vtkUnstructuredSpline, PatchesOfTheSplineAreTheSameGeometry_PropertyOracle)
{
  vtkNew<vtkUnstructuredSpline> filter;
  filter->SetInputDataObject(Sphere(4));
  filter->Update();
  SplineModel model = DecodePatches(filter->GetOutputDataObject(0));
  SplinePatch other;
  other.Id = 7;
  other.Geometry =
    std::get<Spline<2>>(DecodePatches(ShapeGrid(vtkSplineSource::SQUARE)).Patches[0].Geometry);
  model.Patches.insert(model.Patches.begin(), other);
  model.Topology.Boundary = { { 0, 1 } };
  ASSERT_TRUE(SplitUnstructuredPatches(model, 1));
  ASSERT_EQ(model.Patches.size(), 7U);
  std::vector<int> ids;
  for (const SplinePatch& patch : model.Patches)
  {
    ids.push_back(patch.Id);
    EXPECT_EQ(std::get<Spline<2>>(patch.Geometry).Space->Kind, SpaceKind::Tensor);
  }
  EXPECT_EQ(ids, (std::vector<int>{ 7, 0, 8, 9, 10, 11, 12 }));
  EXPECT_EQ(model.Topology.Boundary, (std::vector<PatchSide>{ { 0, 1 } }));
  EXPECT_EQ(model.Topology.Interfaces.size(), 12U);
  EXPECT_EQ(model.Warnings.size(), 1U);
  // patches that are none of these stay as they are
  SplineModel square;
  square.Patches.push_back(other);
  ASSERT_TRUE(SplitUnstructuredPatches(square, 1));
  EXPECT_TRUE(square.Warnings.empty());
}

TEST(vtkUnstructuredSpline, EveryFailureIsReachable_ExactOracle)
{
  vtkNew<vtkUnstructuredSpline> filter;
  const auto expect = [&](vtkDataObject* data, ErrorCode code, const char* words)
  {
    SCOPED_TRACE(words);
    filter->SetInputDataObject(data);
    ExpectFailure(filter, code, words);
  };
  vtkNew<vtkPolyData> nothing;
  expect(nothing, ErrorCode::EmptyInput, "the mesh has no cells");
  const auto plane = [](std::initializer_list<std::initializer_list<vtkIdType>> faces)
  {
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(MakePoints(GridPoints({ 3, 3, 0 })));
    vtkNew<vtkCellArray> cells;
    for (const auto& face : faces)
    {
      cells->InsertNextCell(face);
    }
    data->SetPolys(cells);
    return data;
  };
  vtkNew<vtkPolyData> curves;
  curves->SetPoints(MakePoints(GridPoints({ 1, 0, 0 })));
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell({ 0, 1 });
  curves->SetLines(lines);
  expect(curves, ErrorCode::InvalidTopology, "cell 0 is a vtkLine of 2 points");
  expect(plane({ { 0, 1, 5, 4 }, { 1, 2, 6, 10, 5 } }), ErrorCode::InvalidTopology,
    "cell 1 is a vtkPolygon of 5 points");
  expect(plane({ { 0, 1 } }), ErrorCode::InvalidTopology, "cell 0");
  expect(plane({ { 0, 1, 5, 4 } }), ErrorCode::InvalidTopology, "point 2 belongs to no cell");
  expect(ShapeGrid(vtkSplineSource::SQUARE), ErrorCode::InvalidParameter, "is a spline");
  const auto grid = [&](std::array<int, 2> n) {
    return MakePolyData(meshes::Grid<2>(n), GridPoints({ n[0], n[1], 0 }));
  };
  auto twice = grid({ 2, 2 });
  twice->GetPolys()->InsertNextCell({ 0, 1, 4, 3 });
  expect(twice, ErrorCode::InvalidTopology, "cells 0 and 4");
  auto folded = grid({ 2, 2 });
  folded->GetPoints()->SetPoint(4, 1.0, std::numeric_limits<double>::quiet_NaN(), 0.0);
  expect(folded, ErrorCode::NonFiniteInput, "point 4");
  // a point on an edge of a larger cell
  vtkNew<vtkPolyData> hanging;
  PointMatrix places(8, 3);
  places << 0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0, 2, 1, 0, 3, 0, 0, 3, 1, 0, 3, 2, 0;
  hanging->SetPoints(MakePoints(places));
  vtkNew<vtkCellArray> three;
  three->InsertNextCell({ 0, 1, 2, 3 });
  three->InsertNextCell({ 1, 5, 6, 4 });
  three->InsertNextCell({ 4, 6, 7, 2 });
  hanging->SetPolys(three);
  expect(hanging, ErrorCode::InvalidTopology, "lies on an edge of cell 0");
  auto mixed = MakeGrid(meshes::Grid<3>({ 1, 1, 1 }), GridPoints({ 1, 1, 1 }), VTK_HEXAHEDRON);
  const vtkIdType side[4] = { 0, 1, 3, 2 };
  mixed->InsertNextCell(VTK_QUAD, 4, side);
  expect(mixed, ErrorCode::InvalidTopology, "take either the surface or the volume");
  auto quadratic = MakeGrid(meshes::Grid<3>({ 1, 1, 1 }), GridPoints({ 1, 1, 1 }), VTK_HEXAHEDRON);
  const vtkIdType six[6] = { 0, 1, 2, 3, 4, 5 };
  quadratic->InsertNextCell(VTK_WEDGE, 6, six);
  expect(quadratic, ErrorCode::InvalidTopology, "cell 1 is a vtkWedge");
  const auto hexahedra =
    MakeGrid(meshes::Grid<3>({ 2, 1, 1 }), GridPoints({ 2, 1, 1 }), VTK_HEXAHEDRON);
  filter->SetPolicy(vtkUnstructuredSpline::MOTORCYCLE);
  expect(hexahedra, ErrorCode::InvalidParameter, "quadrilaterals");
  filter->SetPolicy(vtkUnstructuredSpline::AUTOMATIC);
  filter->SetFeatureAngle(30.0);
  expect(hexahedra, ErrorCode::InvalidParameter, "FeatureAngle is for quadrilaterals");
  filter->SetFeatureAngle(180.0);
  filter->TangentPlanesOn();
  expect(hexahedra, ErrorCode::InvalidParameter, "TangentPlanes is for quadrilaterals");
  filter->TangentPlanesOff();
  filter->SplitPolygonsOn();
  expect(hexahedra, ErrorCode::InvalidParameter, "polygons can be split");
  expect(plane({ { 0, 1, 5 } }), ErrorCode::InvalidTopology, "mesh of split polygons");
  filter->SplitPolygonsOff();
  filter->SetFeatureArray("Absent");
  expect(grid({ 2, 2 }), ErrorCode::InvalidParameter, "no cell array 'Absent'");
  filter->SetFeatureArray("");
  filter->SetLengths(vtkUnstructuredSpline::MEAN);
  auto collapsed = grid({ 1, 1 });
  for (vtkIdType i = 0; i < 4; ++i)
  {
    collapsed->GetPoints()->SetPoint(i, 0.0, 0.0, 0.0);
  }
  expect(collapsed, ErrorCode::InvalidParameter, "have no length");
  filter->SetInputDataObject(grid({ 3, 3 }));
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
}

TEST(vtkUnstructuredSpline, ProgressAndAbort_PropertyOracle)
{
  vtkNew<vtkUnstructuredSpline> filter;
  filter->SetInputDataObject(Sphere(10));
  ExpectProgressAndAbort(filter, 2);
}
