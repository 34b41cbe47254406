// SPDX-License-Identifier: BSD-3-Clause
// The models of the kernel are tested there; here: what the filter gives out.
#include "FilterCases.h"
#include <knotwork/SurfaceTrimming/TrimmedGrids.h>
#include <knotwork/SurfaceTrimming/vtkAnalyticModel.h>

#include "vtkAppendPolyData.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCubeSource.h"
#include "vtkCylinderSource.h"
#include "vtkDataArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkTriangleFilter.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVariant.h"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

using namespace knotwork;

namespace
{
constexpr double Pi = 3.14159265358979323846;

/// Of quadrilaterals, with three points a corner.
vtkSmartPointer<vtkPolyData> Cube(double x = 0.0)
{
  vtkNew<vtkCubeSource> source;
  source->SetCenter(x, 0.0, 0.0);
  source->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  source->Update();
  return source->GetOutput();
}

/// About y, radius 0.75, height 2; caps are polygons of 40 corners.
vtkSmartPointer<vtkPolyData> Cylinder(bool capped = true)
{
  vtkNew<vtkCylinderSource> source;
  source->SetRadius(0.75);
  source->SetHeight(2.0);
  source->SetResolution(40);
  source->SetCapping(capped);
  source->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  source->Update();
  return source->GetOutput();
}

vtkSmartPointer<vtkPolyData> Both(vtkPolyData* first, vtkPolyData* second)
{
  vtkNew<vtkAppendPolyData> both;
  both->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  both->AddInputData(first);
  both->AddInputData(second);
  both->Update();
  return both->GetOutput();
}

/// z = f(x, y) over n x n squares.
template <typename Height>
vtkSmartPointer<vtkPolyData> Field(int n, Height height)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> squares;
  for (int i = 0; i < (n + 1) * (n + 1); ++i)
  {
    const double x = static_cast<double>(i % (n + 1)) / n;
    const double y = static_cast<double>(i / (n + 1)) / n;
    points->InsertNextPoint(x, y, height(x, y));
    if (x < 1.0 && y < 1.0)
    {
      const vtkIdType corners[4] = { i, i + 1, i + n + 2, i + n + 1 };
      squares->InsertNextCell(4, corners);
    }
  }
  auto field = vtkSmartPointer<vtkPolyData>::New();
  field->SetPoints(points);
  field->SetPolys(squares);
  return field;
}

double Number(vtkAnalyticModel* filter, const char* name)
{
  const vtkVariant value =
    vtkTable::SafeDownCast(filter->GetOutputDataObject(3))->GetValueByName(0, name);
  EXPECT_TRUE(value.IsValid()) << name;
  return value.ToDouble();
}

void ExpectNumbers(vtkAnalyticModel* filter, const std::map<const char*, double>& wanted)
{
  for (const auto& [name, number] : wanted)
  {
    EXPECT_EQ(Number(filter, name), number) << name;
  }
}

std::string Text(vtkAnalyticModel* filter, const char* name)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(3))->GetValueByName(0, name).ToString();
}

vtkDataArray* CellArray(vtkAnalyticModel* filter, int port, const char* name)
{
  return vtkDataSet::SafeDownCast(filter->GetOutputDataObject(port))->GetCellData()->GetArray(name);
}

/// Faces of every type, as the grids say.
std::map<int, int> TypesOf(vtkAnalyticModel* filter)
{
  const auto model =
    DecodeTrimmedModel(filter->GetOutputDataObject(1), filter->GetOutputDataObject(2));
  EXPECT_TRUE(model) << model.Status.Message();
  std::map<int, int> count;
  for (const TrimmedFace& face : model->Faces)
  {
    ++count[static_cast<int>(face.Type)];
  }
  return count;
}

/// Edges of triangles of output 0 that have no partner in the other direction.
int NumOpenEdges(vtkAnalyticModel* filter)
{
  auto* triangles = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
  std::multiset<std::pair<vtkIdType, vtkIdType>> edges;
  for (vtkIdType t = 0; t < triangles->GetNumberOfCells(); ++t)
  {
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    triangles->GetCellPoints(t, count, corners);
    for (vtkIdType k = 0; k < count; ++k)
    {
      edges.emplace(corners[k], corners[(k + 1) % count]);
    }
  }
  int open = 0;
  for (const auto& [from, to] : edges)
  {
    open += edges.count({ to, from }) == edges.count({ from, to }) ? 0 : 1;
  }
  return open;
}
}

/// Two cylinders of nearly one radius, a little askew, become ones of one radius and direction.
TEST(vtkAnalyticModel, NearlyEqualValuesBecomeEqual)
{
  const auto other = Cylinder();
  vtkPoints* points = other->GetPoints();
  for (vtkIdType p = 0; p < points->GetNumberOfPoints(); ++p)
  {
    double x[3];
    points->GetPoint(p, x);
    points->SetPoint(p, 1.001 * x[0] + 1e-3 * x[1] + 2.0, x[1] - 1e-3 * x[0], 1.001 * x[2]);
  }
  vtkNew<vtkAnalyticModel> filter;
  filter->SetInputDataObject(Both(Cylinder(), other));
  filter->SetTolerance(5e-3);
  filter->Update();
  ExpectNumbers(filter,
    { { "Cylinders", 2 }, { "SnappedSurfaces", 0 }, { "CommonSizes", 0 }, { "MaxTurn", 0 } });
  filter->SetSnapDistance(3e-3);
  filter->Update();
  ExpectNumbers(filter,
    { { "Cylinders", 2 }, { "CommonSizes", 1 }, { "CommonDirections", 1 }, { "LoopsProved", 1 },
      { "WithinTolerance", 1 } });
  EXPECT_NEAR(Number(filter, "MaxTurn"), 0.5e-3 * 180.0 / Pi, 2e-3);
  EXPECT_EQ(Text(filter, "Verdict"), "valid");
}

TEST(vtkAnalyticModel, CubeIsSixPlanesTwelveLinesEightVertices_Exact)
{
  vtkNew<vtkAnalyticModel> filter;
  filter->SetInputDataObject(Cube());
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  ExpectNumbers(filter,
    { { "Faces", 6 }, { "Planes", 6 }, { "Cylinders", 0 }, { "Spheres", 0 }, { "Cones", 0 },
      { "Tori", 0 }, { "Edges", 12 }, { "Lines", 12 }, { "Circles", 0 }, { "SharpEdges", 12 },
      { "Vertices", 8 }, { "Loops", 0 }, { "WithinTolerance", 1 }, { "PoleFaces", 0 },
      { "LoopsProved", 1 }, { "ControlPoints", 24 } });
  EXPECT_EQ(Text(filter, "Verdict"), "valid");
  EXPECT_EQ(Text(filter, "LoopVerdict"), "simple_nested");
  EXPECT_NEAR(Number(filter, "Tolerance"), 1e-3 * std::sqrt(3.0), 1e-15);
  for (const char* name : { "MaxDeviation", "MaxSag", "MaxEdgeDistance", "MaxEdgeGap" })
  {
    EXPECT_LT(Number(filter, name), 1e-14) << name;
  }
  EXPECT_GT(Number(filter, "MinNormalBound"), 0.0);
  EXPECT_NEAR(Number(filter, "Area"), 6.0, 1e-13);
  EXPECT_NEAR(Number(filter, "MeshArea"), 6.0, 1e-13);
  auto* triangles = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_EQ(triangles->GetNumberOfPoints(), 8);
  EXPECT_EQ(triangles->GetNumberOfPolys(), 12);
  EXPECT_EQ(NumOpenEdges(filter), 0);
  std::map<double, int> trianglesOf;
  for (vtkIdType t = 0; t < 12; ++t)
  {
    ++trianglesOf[CellArray(filter, 0, "FaceId")->GetTuple1(t)];
    EXPECT_EQ(CellArray(filter, 0, "SurfaceType")->GetTuple1(t), 0.0);
  }
  EXPECT_EQ(trianglesOf,
    (std::map<double, int>{ { 0, 2 }, { 1, 2 }, { 2, 2 }, { 3, 2 }, { 4, 2 }, { 5, 2 } }));
  auto* types = CellArray(filter, 1, "SurfaceType");
  ASSERT_NE(types, nullptr);
  ASSERT_EQ(types->GetNumberOfTuples(), 6);
  EXPECT_EQ(types->GetRange()[0], 0.0);
  EXPECT_EQ(types->GetRange()[1], 0.0);
  EXPECT_EQ(TypesOf(filter), (std::map<int, int>{ { 0, 6 } }));
  // an edge twice
  auto* uses = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(2));
  EXPECT_EQ(uses->GetNumberOfCells(), 24);
  EXPECT_EQ(CellArray(filter, 2, "EdgeId")->GetRange()[1], 11.0);
}

/// The circle's chords in the rims of output 0 are a quarter of the tolerance from it at most.
TEST(vtkAnalyticModel, CylinderHasTwoCircles_Exact)
{
  vtkNew<vtkAnalyticModel> filter;
  filter->SetInputDataObject(Cylinder());
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  ExpectNumbers(filter,
    { { "Faces", 3 }, { "Planes", 2 }, { "Cylinders", 1 }, { "Edges", 2 }, { "Circles", 2 },
      { "SharpEdges", 2 }, { "Lines", 0 }, { "Vertices", 2 }, { "Loops", 0 },
      { "WithinTolerance", 1 } });
  const double chord = 0.75 * (1.0 - std::cos(Pi / 40));
  for (const char* bound : { "MaxSag", "MaxEdgeDistance" })
  {
    EXPECT_GE(Number(filter, bound), chord * (1.0 - 1e-9)) << bound;
    EXPECT_LE(Number(filter, bound), 1.2 * chord) << bound;
  }
  EXPECT_LT(Number(filter, "MaxDeviation"), 1e-6);
  const double exact = 2.0 * Pi * 0.75 * (2.0 + 0.75);
  const double share = Number(filter, "Tolerance") / (4.0 * 0.75);
  EXPECT_LT(Number(filter, "Area"), exact);
  EXPECT_GT(Number(filter, "Area"), (1.0 - 2.0 * share) * exact);
  EXPECT_GT(Number(filter, "Area"), Number(filter, "MeshArea"));
  EXPECT_EQ(NumOpenEdges(filter), 0);
  EXPECT_EQ(TypesOf(filter), (std::map<int, int>{ { 0, 2 }, { 1, 1 } }));
  EXPECT_EQ(CellArray(filter, 0, "SurfaceType")->GetRange()[1], 1.0);
  // points of the side lie on the circle, normals out
  auto* triangles = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
  auto* normals = triangles->GetPointData()->GetNormals();
  ASSERT_NE(normals, nullptr);
  for (vtkIdType i = 0; i < triangles->GetNumberOfPoints(); ++i)
  {
    double p[3];
    triangles->GetPoint(i, p);
    const double radius = std::hypot(p[0], p[2]);
    EXPECT_LE(radius, 0.75 + 1e-6);
    const double* n = normals->GetTuple3(i);
    EXPECT_GT(n[0] * p[0] + n[1] * p[1] + n[2] * p[2], 0.0);
  }
  filter->SetChordalTolerance(1e-4);
  filter->Update();
  EXPECT_NEAR(Number(filter, "Area"), exact, 2.0 * 1e-4 / 0.75 * exact);
}

TEST(vtkAnalyticModel, OpenMeshesHaveLoops_Exact)
{
  vtkNew<vtkAnalyticModel> filter;
  filter->SetInputDataObject(Cylinder(false));
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  ExpectNumbers(filter,
    { { "Faces", 1 }, { "Cylinders", 1 }, { "Edges", 2 }, { "Circles", 2 }, { "Loops", 2 } });
  EXPECT_GT(NumOpenEdges(filter), 0);
  // one square, whose corners are vertices only where the rim turns by that much
  filter->SetInputDataObject(Field(4, [](double, double) { return 1.0; }));
  filter->Update();
  ExpectNumbers(filter,
    { { "Faces", 1 }, { "Planes", 1 }, { "Edges", 4 }, { "Lines", 4 }, { "SharpEdges", 0 },
      { "Vertices", 4 }, { "Loops", 1 } });
  filter->SetCornerAngle(100.0);
  filter->Update();
  EXPECT_EQ(Number(filter, "Loops"), 1.0);
  EXPECT_LT(Number(filter, "Vertices"), 4.0);
}

TEST(vtkAnalyticModel, PartsAreInOneModel_Exact)
{
  vtkNew<vtkAnalyticModel> filter;
  filter->SetInputDataObject(Both(Cube(3.0), Cylinder()));
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  ExpectNumbers(filter,
    { { "Faces", 9 }, { "Planes", 8 }, { "Cylinders", 1 }, { "Edges", 14 }, { "Vertices", 10 } });
  EXPECT_EQ(NumOpenEdges(filter), 0);
}

TEST(vtkAnalyticModel, Errors)
{
  vtkNew<vtkAnalyticModel> filter;
  vtkNew<vtkPolyData> empty;
  filter->SetInputDataObject(empty);
  ExpectFailure(filter, ErrorCode::EmptyInput, "no triangles");
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputData(Cylinder(false));
  triangles->Update();
  triangles->GetOutput()->GetPoints()->SetPoint(
    7, 0.0, std::numeric_limits<double>::quiet_NaN(), 0.0);
  filter->SetInputDataObject(triangles->GetOutput());
  ExpectFailure(filter, ErrorCode::NonFiniteInput, "1 point (7)");
  filter->SetInputDataObject(
    Field(20, [](double x, double y) { return 0.2 * std::sin(5.0 * x) * std::cos(4.0 * y); }));
  ExpectFailure(filter, ErrorCode::NotInSpace, "% of the area, less than 10 %");
  filter->FreeFormOff();
  ExpectFailure(filter, ErrorCode::NotInSpace, "region");
  // strips that sag more than is allowed are of no surface
  filter->SetInputDataObject(Cylinder());
  filter->SetTolerance(1e-3);
  filter->SetMaximumSag(1.0);
  ExpectFailure(filter, ErrorCode::NotInSpace, "region");
  filter->SetMaximumSag(5.0);
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_EQ(Number(filter, "Tolerance"), 1e-3);
}

TEST(vtkAnalyticModel, ProgressAndAbort)
{
  vtkNew<vtkAnalyticModel> filter;
  filter->SetInputDataObject(Both(Cube(3.0), Cylinder()));
  ExpectProgressAndAbort(filter, 2);
}
