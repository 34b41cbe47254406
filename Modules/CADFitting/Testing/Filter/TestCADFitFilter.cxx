// SPDX-License-Identifier: BSD-3-Clause
#include "FilterCases.h"
#include "FitCases.h"
#include "MeshDatasets.h"
#include <knotwork/CADFitting/vtkCADFit.h>
#include <knotwork/SplineGrid/vtkUnstructuredSpline.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIntArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSphere.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVariant.h"

using namespace knotwork;

namespace
{
double Number(vtkCADFit* filter, const char* column)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(1))
    ->GetValueByName(0, column)
    .ToDouble();
}

vtkSmartPointer<vtkPolyData> Triangles(const TriangleMesh& mesh)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(MakePoints(mesh.Points));
  vtkNew<vtkCellArray> cells;
  for (const auto& triangle : mesh.Triangles)
  {
    cells->InsertNextCell({ triangle[0], triangle[1], triangle[2] });
  }
  data->SetPolys(cells);
  return data;
}

vtkSmartPointer<vtkPolyData> SphereMesh(int n)
{
  const auto sphere = fits::Sphere(n);
  return MakePolyData(sphere.Mesh, sphere.Points);
}

vtkSmartPointer<vtkUnstructuredGrid> BoxMesh()
{
  fits::Placer<3> placer;
  fits::AddBlock<3>(
    placer, { 3, 3, 3 }, [](const double* u) { return Eigen::RowVector3d(u[0], u[1], u[2]); });
  const auto box = placer.Done();
  return MakeGrid(box.Mesh, box.Points, VTK_HEXAHEDRON);
}
}

TEST(vtkCADFit, SplineIsThatOfTheKernel_CrossOracle)
{
  const auto mesh = fits::Sphere(4);
  CADFitParams params;
  params.Space.Degree = 2;
  const auto expected =
    FitToTarget<2>(mesh.Mesh, mesh.Points, fits::Ellipsoid(1.0, 1.0, 1.0), params);
  vtkNew<vtkSphere> sphere;
  sphere->SetRadius(1.0);
  vtkNew<vtkCADFit> filter;
  filter->SetInputDataObject(SphereMesh(4));
  filter->SetTargetType(vtkCADFit::IMPLICIT_FUNCTION);
  filter->SetImplicitFunction(sphere);
  filter->SetDegree(2);
  filter->Update();
  const SplineModel model = DecodePatches(filter->GetOutputDataObject(0));
  const auto& found = std::get<Spline<2>>(model.Patches.at(0).Geometry);
  // vtkSphere computes its value in another order
  EXPECT_LE((found.ControlPoints - expected->Value.ControlPoints).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(Number(filter, "Functions"), 152);
  EXPECT_EQ(Number(filter, "Patches"), 6);
  EXPECT_NEAR(Number(filter, "RmsDistance"), expected->Distances.ToTarget.RootMeanSquare, 1e-12);
  auto* const cells = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  auto* const distance = vtkDoubleArray::SafeDownCast(cells->GetCellData()->GetArray("Distance"));
  ASSERT_TRUE(distance);
  EXPECT_EQ(distance->GetRange()[1], Number(filter, "MaxDistance"));
  auto* const verdict = vtkIntArray::SafeDownCast(cells->GetCellData()->GetArray("Verdict"));
  EXPECT_EQ(verdict->GetRange()[0], 1.0);
  auto* const samples = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(3));
  EXPECT_GE(samples->GetNumberOfPoints(), 20000);
  EXPECT_EQ(samples->GetPointData()->GetArray("Distance")->GetRange()[1],
    Number(filter, "MaxDistanceBack"));
}

TEST(vtkCADFit, FitArrayChoosesCells_CrossOracle)
{
  const auto mesh = fits::Sphere(4);
  CADFitParams params;
  params.Space.Degree = 2;
  vtkNew<vtkDoubleArray> chosen;
  chosen->SetName("Chosen");
  for (int c = 0; c < mesh.Mesh.NumCells(); ++c)
  {
    const bool isUp = mesh.Points(mesh.Mesh.Cell(c)[0], 2) > 0.2;
    params.FittedCells.push_back(isUp ? 1 : 0);
    chosen->InsertNextValue(isUp ? -0.5 : 0.0);
  }
  const auto expected =
    FitToTarget<2>(mesh.Mesh, mesh.Points, fits::Ellipsoid(1.05, 1.05, 1.05), params);
  ASSERT_TRUE(expected) << expected.Status.Message();
  const auto input = SphereMesh(4);
  input->GetCellData()->AddArray(chosen);
  vtkNew<vtkSphere> sphere;
  sphere->SetRadius(1.05);
  vtkNew<vtkCADFit> filter;
  filter->SetInputDataObject(input);
  filter->SetTargetType(vtkCADFit::IMPLICIT_FUNCTION);
  filter->SetImplicitFunction(sphere);
  filter->SetDegree(2);
  filter->SetFitArray("Chosen");
  filter->Update();
  const SplineModel model = DecodePatches(filter->GetOutputDataObject(0));
  const auto& found = std::get<Spline<2>>(model.Patches.at(0).Geometry);
  EXPECT_LE((found.ControlPoints - expected->Value.ControlPoints).cwiseAbs().maxCoeff(), 1e-11);
  EXPECT_EQ(Number(filter, "RmsDistanceBack"), -1.0);
  filter->SetFitArray("None");
  filter->Update();
  EXPECT_GE(Number(filter, "RmsDistanceBack"), 0.0);
  filter->SetFitArray("Unknown");
  ExpectFailure(filter, ErrorCode::InvalidParameter, "no cell array 'Unknown'");
  filter->SetFitArray("Chosen");
  filter->SetTargetType(vtkCADFit::INPUT); // without a target
  vtkNew<MessageRecorder> messages;
  messages->Watch(filter);
  filter->Update();
  ASSERT_EQ(messages->Warnings.size(), 1u);
  EXPECT_NE(messages->Warnings.front().find("'Chosen' does not count"), std::string::npos);
  filter->SetTargetType(vtkCADFit::IMPLICIT_FUNCTION);
  chosen->Fill(0.0);
  chosen->Modified();
  input->Modified();
  ExpectFailure(filter, ErrorCode::InvalidParameter, "no cell is to be fitted");
}

TEST(vtkCADFit, HexahedraOntoTriangles_ExactOracle)
{
  vtkNew<vtkCADFit> filter;
  const auto mesh = BoxMesh();
  vtkNew<vtkIntArray> part;
  part->SetName("Part");
  part->SetNumberOfValues(27);
  part->FillValue(4);
  mesh->GetCellData()->AddArray(part);
  filter->SetInputDataObject(mesh);
  filter->SetTargetData(Triangles(fits::BoxTriangles(4)));
  filter->SetDegree(2);
  filter->Update();
  EXPECT_NEAR(Number(filter, "Volume"), 1.0, 1e-12);
  EXPECT_NEAR(Number(filter, "Area"), 6.0, 1e-12);
  EXPECT_LE(Number(filter, "MaxDistance"), 1e-12);
  EXPECT_EQ(Number(filter, "UnmatchedFeatures"), 0);
  auto* const entities = vtkTable::SafeDownCast(filter->GetOutputDataObject(2));
  EXPECT_EQ(entities->GetNumberOfRows(), 6 + 12);
  auto* const cells = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_EQ(cells->GetCellData()->GetArray("Part")->GetRange()[0], 4.0);
}

/// A spline as the target of a coarser one: the boundary of a volume.
TEST(vtkCADFit, SplineTargets_PropertyOracle)
{
  vtkNew<vtkUnstructuredSpline> fine;
  fine->SetInputDataObject(SphereMesh(8));
  vtkNew<vtkCADFit> filter;
  filter->SetInputDataObject(SphereMesh(4));
  filter->SetTargetConnection(fine->GetOutputPort());
  filter->SetDegree(2);
  filter->SetTargetSamples(0);
  filter->Update();
  EXPECT_LE(Number(filter, "RmsDistance"), 4e-4); // as from the sphere, from which it is 1e-5
  EXPECT_EQ(Number(filter, "MaxDistanceBack"), -1.0);
  vtkNew<vtkUnstructuredSpline> box;
  box->SetInputDataObject(BoxMesh());
  filter->SetInputDataObject(BoxMesh());
  filter->SetTargetConnection(box->GetOutputPort());
  filter->Update();
  EXPECT_LE(Number(filter, "MaxDistance"), 1e-12);
  EXPECT_EQ(vtkTable::SafeDownCast(filter->GetOutputDataObject(2))->GetNumberOfRows(), 18);
}

/// The path that was taken, and why one that was asked for was not.
TEST(vtkCADFit, Paths_PropertyOracle)
{
  vtkNew<vtkCADFit> filter;
  filter->SetInputDataObject(BoxMesh());
  filter->SetDegree(2);
  const auto word = [&](const char* column)
  {
    filter->Update();
    return vtkTable::SafeDownCast(filter->GetOutputDataObject(1))
      ->GetValueByName(0, column)
      .ToString();
  };
  EXPECT_EQ(word("Path"), "affine");
  EXPECT_EQ(word("PathNote"), "");
  for (const int path : { vtkCADFit::UNSTRUCTURED, vtkCADFit::COMPOSITE, vtkCADFit::COONS,
         vtkCADFit::MULTILINEAR, vtkCADFit::AFFINE })
  {
    filter->SetPath(path);
    EXPECT_EQ(word("Path"), ToString(static_cast<FitPath>(path)));
    EXPECT_EQ(word("PathTried"), "");
    EXPECT_NEAR(Number(filter, "Volume"), 1.0, 1e-12);
  }
  filter->SetTargetData(Triangles(fits::BoxTriangles(4)));
  EXPECT_EQ(word("Path"), "unstructured");
  EXPECT_EQ(word("PathTried"), "affine");
  EXPECT_NE(word("PathNote").find("another shape"), std::string::npos);
}

TEST(vtkCADFit, Errors)
{
  vtkNew<vtkCADFit> filter;
  filter->SetInputDataObject(SphereMesh(2));
  filter->SetTargetType(vtkCADFit::IMPLICIT_FUNCTION);
  ExpectFailure(filter, ErrorCode::EmptyInput, "set the implicit function");
  filter->SetTargetType(vtkCADFit::INPUT);
  filter->SetTargetData(vtkSmartPointer<vtkPolyData>::New());
  ExpectFailure(filter, ErrorCode::EmptyInput, "no faces");
  filter->SetTargetData(Triangles(fits::BoxTriangles(2)));
  filter->SetInputDataObject(Triangles(fits::BoxTriangles(2)));
  ExpectFailure(filter, ErrorCode::InvalidTopology, "cell 0");
  vtkNew<vtkUnstructuredSpline> box;
  box->SetInputDataObject(BoxMesh());
  filter->SetInputDataObject(BoxMesh());
  filter->SetTargetConnection(box->GetOutputPort());
  filter->SetFaceGroups("0,9");
  ExpectFailure(filter, ErrorCode::InvalidParameter, "'9'");
}
