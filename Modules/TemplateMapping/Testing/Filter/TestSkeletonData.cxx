// SPDX-License-Identifier: BSD-3-Clause
#include "../Kernel/SurfaceCases.h"
#include "SkeletonData.h"
#include <knotwork/SplineCore/Shapes.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/TemplateMapping/ClosestPoints.h>
#include <knotwork/TemplateMapping/SkeletonSampling.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCubeSource.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSphereSource.h>
#include <vtkStripper.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

using namespace knotwork;

namespace
{
vtkSmartPointer<vtkIntArray> Ids(const std::vector<int>& values)
{
  auto ids = vtkSmartPointer<vtkIntArray>::New();
  ids->SetName("PatchId");
  for (int value : values)
  {
    ids->InsertNextValue(value);
  }
  return ids;
}

/// Six points of a roof: polygons (0 1 4 3) and (1 2 5 4), whose common edge is the ridge.
vtkSmartPointer<vtkPolyData> Roof(const std::vector<int>& ids = { 7, 3 })
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int k = 0; k < 6; ++k)
  {
    points->InsertNextPoint(k % 3, k / 3, k % 3 == 1 ? 0.5 : 0.0);
  }
  vtkNew<vtkCellArray> polygons;
  polygons->InsertNextCell({ 0, 1, 4, 3 });
  polygons->InsertNextCell({ 1, 2, 5, 4 });
  auto roof = vtkSmartPointer<vtkPolyData>::New();
  roof->SetPoints(points);
  roof->SetPolys(polygons);
  roof->GetCellData()->AddArray(Ids(ids));
  return roof;
}

vtkSmartPointer<vtkPolyData> Lines()
{
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(0, 0, 0);
  points->InsertNextPoint(1, 0, 0);
  points->InsertNextPoint(1, 1, 0);
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell({ 0, 1, 2 });
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetLines(lines);
  data->GetCellData()->AddArray(Ids({ 0 }));
  return data;
}

/// Patches of a shape as a grid.
vtkSmartPointer<vtkUnstructuredGrid> ShapeGrid(ShapeKind kind, int elements)
{
  ShapeParams params;
  params.Kind = kind;
  params.Angle = 360.0;
  params.Elements = { elements, elements, 1 };
  SplineModel model;
  for (AnySpline& patch : MakeShape(params).Value)
  {
    model.Patches.emplace_back();
    model.Patches.back().Id = 10 + static_cast<int>(model.Patches.size());
    model.Patches.back().Geometry = std::move(patch);
  }
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  EXPECT_TRUE(EncodeSplineGrid(model, grid));
  return grid;
}

/// A Bezier triangle of degree 2, z = x y, in VTK's order of points, and beside it a bilinear
/// Bezier quadrilateral on [1, 2] x [0, 1] at z = y, one id each or one for both.
vtkSmartPointer<vtkUnstructuredGrid> TriangleGrid(bool together)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  const double rows[10][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0.5, 0, 0 },
    { 0.5, 0.5, 0.5 }, { 0, 0.5, 0 }, { 1, 0, 0 }, { 2, 0, 0 }, { 2, 1, 1 }, { 1, 1, 1 } };
  for (const double* row : rows)
  {
    points->InsertNextPoint(row);
  }
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(points);
  grid->Allocate(2);
  const vtkIdType triangle[6] = { 0, 1, 2, 3, 4, 5 };
  const vtkIdType quadrilateral[4] = { 6, 7, 8, 9 };
  grid->InsertNextCell(VTK_BEZIER_TRIANGLE, 6, triangle);
  grid->InsertNextCell(VTK_BEZIER_QUADRILATERAL, 4, quadrilateral);
  vtkNew<vtkIntArray> degrees;
  degrees->SetName("HigherOrderDegrees");
  degrees->SetNumberOfComponents(3);
  degrees->InsertNextTuple3(2, 2, 0);
  degrees->InsertNextTuple3(1, 1, 0);
  grid->GetCellData()->SetHigherOrderDegrees(degrees);
  grid->GetCellData()->AddArray(Ids({ 4, together ? 4 : 5 }));
  return grid;
}

template <int Dim>
void ExpectError(ErrorCode code, const std::string& words, vtkDataSet* data)
{
  SCOPED_TRACE(words);
  const auto skeleton = DecodeSkeleton<Dim>(data, "template");
  EXPECT_EQ(skeleton.Status.Code, code);
  EXPECT_NE(skeleton.Status.Detail.find(words), std::string::npos) << skeleton.Status.Message();
}

template <typename Data>
vtkSmartPointer<Data> Damaged(Data* data, const std::function<void(Data*)>& damage)
{
  auto copy = vtkSmartPointer<Data>::New();
  copy->DeepCopy(data);
  damage(copy);
  return copy;
}
}

TEST(SkeletonData, FacesBecomeTrianglesOfTheirPatches_ExactOracle)
{
  const auto roof = Roof();
  vtkNew<vtkFloatArray> normals;
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  vtkNew<vtkDoubleArray> parameters;
  parameters->SetName("Parameter");
  parameters->SetNumberOfComponents(2);
  for (int k = 0; k < 6; ++k)
  {
    normals->InsertNextTuple3(k, 1, 2);
    parameters->InsertNextTuple2(k % 3, 10.0 * (k / 3));
  }
  roof->GetPointData()->AddArray(normals);
  roof->GetPointData()->AddArray(parameters);
  const auto skeleton = DecodeSkeleton<3>(roof, "template");
  ASSERT_TRUE(skeleton) << skeleton.Status.Message();
  ASSERT_EQ(skeleton.Value.size(), 2u);
  const int points[2][4] = { { 0, 1, 3, 4 }, { 1, 2, 4, 5 } }; // the ridge is in both
  for (std::size_t p = 0; p < 2; ++p)
  {
    const SkeletonPatch<3>& patch = skeleton.Value[p];
    EXPECT_EQ(patch.Id, p == 0 ? 7 : 3);
    ASSERT_EQ(patch.Points.rows(), 4);
    for (int k = 0; k < 4; ++k)
    {
      const int id = points[p][k];
      EXPECT_EQ(patch.Points.row(k), Eigen::RowVector3d(id % 3, id / 3, id % 3 == 1 ? 0.5 : 0.0));
      EXPECT_EQ(patch.Normals.row(k), Eigen::RowVector3d(id, 1, 2));
      EXPECT_EQ(patch.Parameters.row(k), Eigen::RowVector2d(id % 3, 10 * (id / 3)));
    }
    EXPECT_EQ(patch.Simplices, (cases::Triangles{ { 0, 1, 3 }, { 0, 3, 2 } }));
  }
  EXPECT_TRUE(CheckSkeletons<3>(skeleton.Value, skeleton.Value));
  EXPECT_EQ(SkeletonDimension(roof, roof).Value, 3);
}

TEST(SkeletonData, StripsAndPixelsAndGridsAreFaces_CrossOracle)
{
  // A sphere as triangles, as strips, and as an unstructured grid is one and the same patch.
  vtkNew<vtkSphereSource> source;
  source->SetThetaResolution(9);
  source->SetPhiResolution(7);
  source->Update();
  vtkPolyData* sphere = source->GetOutput();
  sphere->GetCellData()->AddArray(
    Ids(std::vector<int>(static_cast<std::size_t>(sphere->GetNumberOfCells()), 2)));
  vtkNew<vtkStripper> stripper;
  stripper->SetInputData(sphere);
  stripper->Update();
  vtkPolyData* strips = stripper->GetOutput();
  ASSERT_GT(strips->GetNumberOfStrips(), 0);
  strips->GetCellData()->AddArray(
    Ids(std::vector<int>(static_cast<std::size_t>(strips->GetNumberOfCells()), 2)));
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(sphere->GetPoints());
  grid->SetCells(VTK_TRIANGLE, sphere->GetPolys());
  grid->GetCellData()->AddArray(sphere->GetCellData()->GetArray("PatchId"));
  grid->GetPointData()->AddArray(sphere->GetPointData()->GetArray("Normals"));

  const auto sorted = [](const SkeletonPatch<3>& patch)
  {
    cases::Triangles triangles;
    for (std::array<int, 3> t : patch.Simplices)
    {
      while (t[0] > t[1] || t[0] > t[2]) // keeps the sense
      {
        t = { t[1], t[2], t[0] };
      }
      triangles.push_back(t);
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
  };
  const auto expected = DecodeSkeleton<3>(sphere, "target");
  ASSERT_TRUE(expected) << expected.Status.Message();
  ASSERT_EQ(expected.Value.size(), 1u);
  for (vtkDataSet* other : { static_cast<vtkDataSet*>(strips), static_cast<vtkDataSet*>(grid) })
  {
    const auto found = DecodeSkeleton<3>(other, "target");
    ASSERT_TRUE(found) << found.Status.Message();
    ASSERT_EQ(found.Value.size(), 1u);
    EXPECT_EQ(found.Value[0].Points, expected.Value[0].Points);
    EXPECT_EQ(found.Value[0].Normals, expected.Value[0].Normals);
    EXPECT_EQ(sorted(found.Value[0]), sorted(expected.Value[0]));
    EXPECT_TRUE(CheckSkeletons<3>(found.Value, expected.Value));
  }

  vtkNew<vtkUnstructuredGrid> pixel;
  pixel->SetPoints(Roof()->GetPoints());
  pixel->Allocate(1);
  const vtkIdType corners[4] = { 0, 1, 3, 4 };
  pixel->InsertNextCell(VTK_PIXEL, 4, corners);
  pixel->GetCellData()->AddArray(Ids({ 7 }));
  const auto one = DecodeSkeleton<3>(pixel, "template");
  ASSERT_TRUE(one);
  EXPECT_EQ(one.Value[0].Simplices, (cases::Triangles{ { 0, 1, 3 }, { 0, 3, 2 } }));
}

TEST(SkeletonData, BezierCurvesBecomePolylines_CrossOracle)
{
  ShapeParams params;
  params.Kind = ShapeKind::Arc;
  params.Angle = 360.0;
  params.Elements = { 3, 3, 1 };
  const auto grid = ShapeGrid(ShapeKind::Arc, 3);
  const auto skeleton = DecodeSkeleton<2>(grid, "template", 500);
  ASSERT_TRUE(skeleton) << skeleton.Status.Message();
  ASSERT_EQ(skeleton.Value.size(), 1u);
  const auto expected = SampleCurve(11, std::get<Spline<1>>(MakeShape(params).Value[0]), 500);
  EXPECT_EQ(skeleton.Value[0].Id, 11);
  EXPECT_EQ(skeleton.Value[0].Points, expected.Value.Points);
  EXPECT_EQ(skeleton.Value[0].Normals, expected.Value.Normals);
  EXPECT_EQ(skeleton.Value[0].Parameters, expected.Value.Parameters);
  EXPECT_EQ(SkeletonDimension(grid, Lines()).Value, 2);
  EXPECT_EQ(DecodeSkeleton<2>(grid, "template").Value[0].Points.rows(), 2005);

  using Grid = vtkUnstructuredGrid;
  const auto lifted = Damaged<Grid>(grid,
    [](auto* d)
    {
      for (vtkIdType i = 0; i < d->GetNumberOfPoints(); ++i)
      {
        const double* p = d->GetPoint(i);
        d->GetPoints()->SetPoint(i, p[0], p[1], 0.25);
      }
    });
  ExpectError<2>(
    ErrorCode::DimensionMismatch, "template patch 11: control point 0 has z = 0.25", lifted);
  // What the decoder of spline grids has to say is passed on.
  const auto bent =
    Damaged<Grid>(grid, [](auto* d) { d->GetPoints()->SetPoint(4, 0.4, 0.5, 0.0); });
  std::vector<std::string> warnings;
  EXPECT_TRUE(DecodeSkeleton<2>(bent, "target", 0, &warnings));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].find("the target: patch 11: the points are not those of a spline"), 0u);
  ExpectError<3>(ErrorCode::InvalidTopology, "the template has curves", grid);
}

TEST(SkeletonData, BezierSurfacesBecomeMeshes_ExactOracle)
{
  const auto grid = ShapeGrid(ShapeKind::SphereSurface, 2);
  std::vector<std::string> warnings;
  const auto skeleton = DecodeSkeleton<3>(grid, "target", 0, &warnings);
  ASSERT_TRUE(skeleton) << skeleton.Status.Message();
  EXPECT_TRUE(warnings.empty());
  ASSERT_EQ(skeleton.Value.size(), 6u);
  for (const SkeletonPatch<3>& patch : skeleton.Value)
  {
    EXPECT_GE(patch.Points.rows(), DefaultSurfaceSamples);
    EXPECT_EQ(patch.Parameters.rows(), patch.Points.rows());
    EXPECT_LE((patch.Points.rowwise().norm().array() - 1.0).abs().maxCoeff(), 1e-13);
    for (Eigen::Index i = 0; i < patch.Points.rows(); ++i)
    {
      EXPECT_NEAR(std::abs(patch.Points.row(i).dot(patch.Normals.row(i))), 1.0, 1e-12);
    }
  }
  EXPECT_EQ(skeleton.Value[5].Id, 16);
  EXPECT_TRUE(CheckSkeletons<3>(skeleton.Value, skeleton.Value));

  // Cells of foreign origin, triangles among them: each patch by itself, or both in one.
  const auto apart = DecodeSkeleton<3>(TriangleGrid(false), "template", 40);
  ASSERT_TRUE(apart) << apart.Status.Message();
  ASSERT_EQ(apart.Value.size(), 2u);
  EXPECT_EQ(apart.Value[0].Points.rows(), 45);
  EXPECT_EQ(apart.Value[1].Points.rows(), 49);
  for (Eigen::Index i = 0; i < 45; ++i)
  {
    const auto p = apart.Value[0].Points.row(i);
    EXPECT_NEAR(p.z(), p.x() * p.y(), 1e-15);
    EXPECT_NEAR(apart.Value[0].Parameters(i, 0), p.x(), 1e-15);
    const Eigen::RowVector3d normal(-p.y(), -p.x(), 1);
    EXPECT_LE((apart.Value[0].Normals.row(i) - normal.normalized()).norm(), 1e-14);
  }
  for (Eigen::Index i = 0; i < 49; ++i)
  {
    const auto p = apart.Value[1].Points.row(i);
    EXPECT_NEAR(p.z(), p.y(), 1e-15);
    EXPECT_NEAR(apart.Value[1].Parameters(i, 0), p.x() - 1.0, 1e-15);
  }
  const auto together = DecodeSkeleton<3>(TriangleGrid(true), "template", 40);
  ASSERT_TRUE(together);
  ASSERT_EQ(together.Value.size(), 1u);
  EXPECT_EQ(together.Value[0].Parameters.rows(), 0);
  EXPECT_TRUE(CheckSkeletons<3>(together.Value, together.Value));
}

TEST(SkeletonData, EveryFaultIsNamed)
{
  using Poly = vtkPolyData;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto roof = Roof();
  ExpectError<2>(ErrorCode::InvalidTopology, "the template has faces", roof);
  ExpectError<3>(ErrorCode::InvalidTopology, "the template has curves", Lines());
  ExpectError<3>(ErrorCode::InvalidTopology, "no cell array PatchId",
    Damaged<Poly>(roof, [](auto* d) { d->GetCellData()->RemoveArray("PatchId"); }));
  ExpectError<3>(ErrorCode::InvalidTopology,
    "cell 0 of the template is a polyline, cell 1 a polygon: the patches of a skeleton are all",
    Damaged<Poly>(roof,
      [](auto* d)
      {
        vtkNew<vtkCellArray> lines;
        lines->InsertNextCell({ 0, 1 });
        d->SetLines(lines);
      }));
  ExpectError<3>(ErrorCode::InvalidTopology, "the template has vertices",
    Damaged<Poly>(roof,
      [](auto* d)
      {
        vtkNew<vtkCellArray> vertices;
        vertices->InsertNextCell({ 0 });
        d->SetVerts(vertices);
      }));
  const auto polygon = [&](std::initializer_list<vtkIdType> ids)
  {
    return Damaged<Poly>(roof,
      [&](auto* d)
      {
        vtkNew<vtkCellArray> cells;
        cells->InsertNextCell({ 0, 1, 4, 3 });
        cells->InsertNextCell(ids);
        d->SetPolys(cells);
      });
  };
  ExpectError<3>(ErrorCode::InvalidTopology, "cell 1 of the template has the point id 6 of 6",
    polygon({ 1, 2, 6 }));
  ExpectError<3>(ErrorCode::InvalidTopology, "template patch 3: cell 1 has a corner twice",
    polygon({ 1, 2, 5, 1 }));
  ExpectError<3>(
    ErrorCode::InvalidTopology, "template patch 3: cell 1 has 2 points", polygon({ 1, 2 }));
  // Not convex (crossed), not flat.
  const std::string notFlat = "template patch 3: cell 1 is a polygon of 4 corners that is not flat";
  ExpectError<3>(ErrorCode::InvalidTopology, notFlat, polygon({ 1, 2, 4, 5 }));
  ExpectError<3>(ErrorCode::InvalidTopology, notFlat,
    Damaged<Poly>(roof, [](auto* d) { d->GetPoints()->SetPoint(5, 2, 1, 1.0); }));
  ExpectError<3>(ErrorCode::InvalidTopology, notFlat, // a dart
    Damaged<Poly>(roof, [](auto* d) { d->GetPoints()->SetPoint(5, 1.2, 0.3, 0.4); }));
  EXPECT_TRUE(DecodeSkeleton<3>( // a little warped is fine
    Damaged<Poly>(roof, [](auto* d) { d->GetPoints()->SetPoint(5, 2, 1, 0.1); }), "template"));
  ExpectError<3>(ErrorCode::SizeMismatch, "Parameter of the template has 1 components, not 2",
    Damaged<Poly>(roof,
      [](auto* d)
      {
        vtkNew<vtkDoubleArray> wrong;
        wrong->SetName("Parameter");
        wrong->SetNumberOfTuples(6);
        d->GetPointData()->AddArray(wrong);
      }));
  ExpectError<3>(ErrorCode::InvalidTopology, "PatchId of cell 1 of the template is not an integer",
    Damaged<Poly>(roof,
      [](auto* d)
      {
        vtkNew<vtkDoubleArray> ids;
        ids->SetName("PatchId");
        ids->InsertNextValue(1);
        ids->InsertNextValue(0.5);
        d->GetCellData()->AddArray(ids);
      }));
  // NaN goes through to the kernel's check, which names it.
  const auto withNan =
    Damaged<Poly>(roof, [&](auto* d) { d->GetPoints()->SetPoint(5, nan, 1, 0.0); });
  const auto skeleton = DecodeSkeleton<3>(withNan, "target");
  ASSERT_TRUE(skeleton);
  EXPECT_EQ(CheckSkeletons<3>(skeleton.Value, skeleton.Value).Detail, "template patch 3, point 3");

  // Both together.
  const Status mixed = SkeletonDimension(roof, Lines()).Status;
  EXPECT_EQ(mixed.Code, ErrorCode::InvalidTopology);
  EXPECT_NE(
    mixed.Detail.find("the template consists of faces, the target of curves"), std::string::npos);
  vtkNew<Poly> empty;
  EXPECT_EQ(SkeletonDimension(empty, roof).Value, 3);
  EXPECT_EQ(SkeletonDimension(Lines(), empty).Value, 2);
  EXPECT_EQ(SkeletonDimension(empty, empty).Value, 0);
  EXPECT_TRUE(DecodeSkeleton<3>(empty, "template").Value.empty());

  // Grids.
  using Grid = vtkUnstructuredGrid;
  const auto sphere = ShapeGrid(ShapeKind::SphereSurface, 1);
  vtkNew<Grid> tetrahedron;
  tetrahedron->SetPoints(roof->GetPoints());
  tetrahedron->Allocate(1);
  const vtkIdType corners[4] = { 0, 1, 2, 3 };
  tetrahedron->InsertNextCell(VTK_TETRA, 4, corners);
  ExpectError<3>(ErrorCode::InvalidTopology,
    "cell 0 of the template is a vtkTetra (type 10): patches are", tetrahedron);
  ExpectError<3>(ErrorCode::InvalidTopology,
    "cell 6 a polygon: give the Bezier cells as polylines or polygons too",
    Damaged<Grid>(sphere,
      [](auto* d)
      {
        const vtkIdType triangle[3] = { 0, 1, 2 };
        d->InsertNextCell(VTK_TRIANGLE, 3, triangle);
      }));
  ExpectError<3>(ErrorCode::InvalidTopology, "no cell array PatchId",
    Damaged<Grid>(sphere, [](auto* d) { d->GetCellData()->RemoveArray("PatchId"); }));
  ExpectError<3>(ErrorCode::NonFiniteInput, "the template: ",
    Damaged<Grid>(sphere, [&](auto* d) { d->GetPoints()->SetPoint(5, nan, 1, 0.0); }));
  ExpectError<3>(ErrorCode::NonFiniteInput, "the template: cell 0",
    Damaged<Grid>(TriangleGrid(true), [&](auto* d) { d->GetPoints()->SetPoint(5, nan, 1, 0.0); }));
  EXPECT_EQ(DecodeSkeleton<3>(sphere, "template", 1).Status.Code, ErrorCode::InvalidParameter);
}

TEST(SkeletonData, MappedMeshesAreTriangles_ExactOracle)
{
  std::vector<MappedSkeletonPatch> patches(2);
  patches[0].Id = 4;
  patches[0].Points = Eigen::RowVector3d(1, 2, 3).replicate(3, 1);
  patches[0].Places = PointMatrix::Zero(3, 3);
  patches[0].Distances = Eigen::Vector3d(0.1, 0.2, 0.3);
  patches[0].Triangles = { { 0, 1, 2 } };
  patches[1] = patches[0];
  patches[1].Id = 2;
  patches[1].Triangles = { { 0, 2, 1 }, { 2, 1, 0 } };
  vtkNew<vtkPolyData> output;
  EncodeMappedSkeleton(patches, output);
  ASSERT_EQ(output->GetNumberOfPoints(), 6);
  EXPECT_EQ(output->GetNumberOfLines(), 0);
  ASSERT_EQ(output->GetNumberOfPolys(), 3);
  EXPECT_EQ(output->GetPoint(5)[2], 3.0);
  EXPECT_FALSE(output->GetPointData()->HasArray("Parameter"));
  EXPECT_EQ(output->GetPointData()->GetArray("Distance")->GetTuple1(4), 0.2);
  EXPECT_EQ(output->GetPointData()->GetArray("PatchId")->GetTuple1(3), 2);
  EXPECT_EQ(output->GetCellData()->GetArray("PatchId")->GetTuple1(0), 4);
  EXPECT_EQ(output->GetCellData()->GetArray("PatchId")->GetTuple1(2), 2);
  vtkNew<vtkIdList> corners;
  output->GetCellPoints(1, corners);
  EXPECT_EQ(corners->GetId(0), 3);
  EXPECT_EQ(corners->GetId(1), 5);
  EXPECT_EQ(corners->GetId(2), 4);
  // It is a skeleton again.
  const auto again = DecodeSkeleton<3>(output, "template");
  ASSERT_TRUE(again);
  EXPECT_EQ(again.Value[1].Simplices, patches[1].Triangles);
}
