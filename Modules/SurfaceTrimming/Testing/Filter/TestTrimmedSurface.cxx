// SPDX-License-Identifier: BSD-3-Clause
// A rolled plate with a hole, whose plane coordinates are known, as trimmed faces.
#include <knotwork/SurfaceTrimming/vtkTrimmedSurface.h>

#include "FilterCases.h"
#include <knotwork/SurfaceTrimming/TrimmedGrids.h>

#include "vtkAppendFilter.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFeatureEdges.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataConnectivityFilter.h"
#include "vtkTable.h"
#include "vtkTriangle.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

using namespace knotwork;

namespace
{
constexpr double Radius = 0.8;
constexpr double HoleArea = 0.16;

/// The rectangle [0, 2] x [0, 1] without [0.3, 0.7]^2, in squares of 1/20, rolled around the z
/// axis.
struct Plate
{
  bool Charts = false;   ///< chart 3: u < 1, chart 5: the rest
  bool Cut = false;      ///< their common points are doubled
  bool Mirrored = false; ///< UV is (-u, v)
};

vtkSmartPointer<vtkPolyData> MakePlate(const Plate& plate)
{
  constexpr int n = 20;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> uv;
  uv->SetName("UV");
  uv->SetNumberOfComponents(2);
  vtkNew<vtkIntArray> cut;
  cut->SetName("CutPointId");
  vtkNew<vtkIntArray> chart;
  chart->SetName("ChartId");
  vtkNew<vtkCellArray> triangles;
  std::map<std::array<int, 3>, vtkIdType> known;
  const auto point = [&](int i, int j, int side)
  {
    const bool doubled = plate.Cut && i == n;
    const auto [entry, isNew] =
      known.emplace(std::array<int, 3>{ i, j, doubled ? side : 0 }, points->GetNumberOfPoints());
    if (isNew)
    {
      const double u = 1.0 * i / n;
      const double v = 1.0 * j / n;
      points->InsertNextPoint(Radius * std::cos(u / Radius), Radius * std::sin(u / Radius), v);
      uv->InsertNextTuple2(plate.Mirrored ? -u : u, v);
      cut->InsertNextValue(doubled ? j : -1);
    }
    return entry->second;
  };
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < 2 * n; ++i)
    {
      if (i >= 6 && i < 14 && j >= 6 && j < 14)
      {
        continue;
      }
      const int side = i < n ? 0 : 1;
      const vtkIdType a = point(i, j, side);
      const vtkIdType b = point(i + 1, j, side);
      const vtkIdType c = point(i + 1, j + 1, side);
      const vtkIdType d = point(i, j + 1, side);
      triangles->InsertNextCell({ a, b, c });
      triangles->InsertNextCell({ a, c, d });
      chart->InsertNextValue(3 + 2 * side);
      chart->InsertNextValue(3 + 2 * side);
    }
  }
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(points);
  mesh->SetPolys(triangles);
  mesh->GetPointData()->AddArray(uv);
  if (plate.Charts)
  {
    mesh->GetCellData()->AddArray(chart);
  }
  if (plate.Cut)
  {
    mesh->GetPointData()->AddArray(cut);
  }
  return mesh;
}

double Number(vtkTrimmedSurface* filter, const char* name)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(4))->GetValueByName(0, name).ToDouble();
}

std::string Text(vtkTrimmedSurface* filter, const char* name)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(4))->GetValueByName(0, name).ToString();
}

/// Closed boundary loops of triangles; the test fails where an edge has more than two triangles.
int BoundaryLoops(vtkPolyData* mesh)
{
  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputData(mesh);
  edges->FeatureEdgesOff();
  edges->ManifoldEdgesOff();
  edges->NonManifoldEdgesOn();
  edges->BoundaryEdgesOff();
  edges->Update();
  EXPECT_EQ(edges->GetOutput()->GetNumberOfCells(), 0);
  edges->NonManifoldEdgesOff();
  edges->BoundaryEdgesOn();
  edges->Update();
  EXPECT_EQ(edges->GetOutput()->GetNumberOfCells(), edges->GetOutput()->GetNumberOfPoints());
  vtkNew<vtkPolyDataConnectivityFilter> parts;
  parts->SetInputConnection(edges->GetOutputPort());
  parts->SetExtractionModeToAllRegions();
  parts->Update();
  return parts->GetNumberOfExtractedRegions();
}

double Area(vtkPolyData* mesh)
{
  double sum = 0.0;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    double corners[3][3];
    for (int k = 0; k < 3; ++k)
    {
      mesh->GetPoint(mesh->GetCell(cell)->GetPointId(k), corners[k]);
    }
    sum += vtkTriangle::TriangleArea(corners[0], corners[1], corners[2]);
  }
  return sum;
}

/// Points near the cylinder, corners counterclockwise seen from outside, normals outwards.
void ExpectFacesOfThePlate(vtkTrimmedSurface* filter, double tolerance)
{
  auto* mesh = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_EQ(BoundaryLoops(mesh), 2);
  // the mesh is inscribed: its area is less by (edge / radius)^2 / 24
  EXPECT_NEAR(Area(mesh), 2.0 - HoleArea, 5e-3);
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    double p[3];
    mesh->GetPoint(i, p);
    EXPECT_NEAR(std::hypot(p[0], p[1]), Radius, tolerance) << "point " << i;
    const double* normal = mesh->GetPointData()->GetNormals()->GetTuple(i);
    EXPECT_GT((normal[0] * p[0] + normal[1] * p[1]) / Radius, 0.9) << "point " << i;
  }
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    double p[3][3];
    for (int k = 0; k < 3; ++k)
    {
      mesh->GetPoint(mesh->GetCell(cell)->GetPointId(k), p[k]);
    }
    double normal[3];
    vtkTriangle::ComputeNormal(p[0], p[1], p[2], normal);
    EXPECT_GT(normal[0] * p[0][0] + normal[1] * p[0][1], 0.0) << "triangle " << cell;
  }
}

TEST(TrimmedSurface, APlateWithAHole_ExactOracle)
{
  vtkNew<vtkTrimmedSurface> filter;
  vtkNew<MessageRecorder> recorder;
  recorder->Watch(filter);
  filter->SetInputDataObject(MakePlate({}));
  filter->Update();
  EXPECT_TRUE(recorder->Errors.empty());
  EXPECT_TRUE(recorder->Warnings.empty());
  const double width = Radius - Radius * std::cos(2.0 / Radius);
  const double depth = Radius; // sin reaches 1
  const double diagonal = std::sqrt(width * width + depth * depth + 1.0);
  EXPECT_NEAR(Number(filter, "Tolerance"), 1e-3 * diagonal, 1e-5 * diagonal);
  const double tolerance = Number(filter, "Tolerance");
  // chords of the mesh are (1 / 20)^2 / (8 Radius) inside
  ExpectFacesOfThePlate(filter, 1.25 * tolerance + 0.0004);
  EXPECT_EQ(Number(filter, "Faces"), 1);
  EXPECT_EQ(Number(filter, "Loops"), 2);
  EXPECT_EQ(Number(filter, "WithinTolerance"), 1);
  EXPECT_LE(Number(filter, "MaxDeviation"), tolerance);
  EXPECT_LE(Number(filter, "MaxDeviationFound"), Number(filter, "MaxDeviation"));
  EXPECT_EQ(Number(filter, "LoopsProved"), 1);
  EXPECT_EQ(Text(filter, "Verdict"), "valid");
  // near isometric plane coordinates: |S_u x S_v| is about 1
  EXPECT_GT(Number(filter, "MinNormalBound"), 0.5);
  EXPECT_LT(Number(filter, "MinNormalBound"), 1.1);
  EXPECT_NEAR(Number(filter, "Area"), 2.0 - HoleArea, 2e-3);
  EXPECT_NEAR(Number(filter, "MeshArea"), 2.0 - HoleArea, 1e-3);

  const auto model =
    DecodeTrimmedModel(filter->GetOutputDataObject(1), filter->GetOutputDataObject(2));
  ASSERT_TRUE(model) << model.Status.Message();
  ASSERT_EQ(model->Faces.size(), 1U);
  EXPECT_EQ(model->Faces[0].Loops.size(), 2U);
  EXPECT_EQ(model->Faces[0].Loops[0].Curves.size(), 4U) << "an edge between two corners";
  EXPECT_EQ(model->Faces[0].Loops[1].Curves.size(), 4U);
  EXPECT_FALSE(model->Faces[0].Reversed);

  auto* triangles = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_EQ(Number(filter, "Triangles"), triangles->GetNumberOfCells());
  EXPECT_TRUE(triangles->GetPointData()->GetArray("UV"));
  EXPECT_FALSE(triangles->GetCellData()->HasArray("CornerUV"));

  auto* mesh = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(3));
  ASSERT_TRUE(mesh);
  vtkDataArray* deviation = mesh->GetPointData()->GetArray("Deviation");
  vtkDataArray* bound = mesh->GetCellData()->GetArray("DeviationBound");
  ASSERT_TRUE(deviation && bound && mesh->GetPointData()->GetArray("UV"));
  double largest = 0.0;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    largest = std::max(largest, bound->GetTuple1(cell));
    for (int k = 0; k < 3; ++k)
    {
      EXPECT_LE(deviation->GetTuple1(mesh->GetCell(cell)->GetPointId(k)), bound->GetTuple1(cell));
    }
  }
  EXPECT_GT(largest, 0.0);
  EXPECT_LE(largest, Number(filter, "MaxDeviation"));
}

TEST(TrimmedSurface, TwoChartsMakeOneWatertightSurface_PropertyOracle)
{
  for (bool cut : { false, true })
  {
    SCOPED_TRACE(cut ? "points of the cut are doubled" : "points are shared");
    vtkNew<vtkTrimmedSurface> filter;
    filter->SetInputDataObject(MakePlate({ true, cut, false }));
    filter->Update();
    ExpectFacesOfThePlate(filter, 1.25 * Number(filter, "Tolerance") + 0.0004);
    EXPECT_EQ(Number(filter, "Faces"), 2);
    EXPECT_EQ(Number(filter, "Loops"), 2) << "of the whole surface";
    EXPECT_EQ(Number(filter, "WithinTolerance"), 1);
    auto* triangles = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
    double faces[2];
    triangles->GetCellData()->GetArray("FaceId")->GetRange(faces);
    EXPECT_EQ(faces[0], 0.0);
    EXPECT_EQ(faces[1], 1.0);
    const auto model =
      DecodeTrimmedModel(filter->GetOutputDataObject(1), filter->GetOutputDataObject(2));
    ASSERT_TRUE(model) << model.Status.Message();
    // four sides of the plate, two of them in two parts, four of the hole, the common edge
    EXPECT_EQ(model->NumEdges, 6 + 4 + 1);
    EXPECT_EQ(model->NumVertices, 6 + 4);
  }
  // without the ids of the doubled points the surface falls into two
  auto apart = MakePlate({ true, true, false });
  apart->GetPointData()->RemoveArray("CutPointId");
  vtkNew<vtkTrimmedSurface> filter;
  filter->SetInputDataObject(apart);
  filter->Update();
  EXPECT_EQ(Number(filter, "Loops"), 3);
}

TEST(TrimmedSurface, AMirroredPlaneGivesAReversedFace_PropertyOracle)
{
  vtkNew<vtkTrimmedSurface> filter;
  filter->SetInputDataObject(MakePlate({ false, false, true }));
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  ExpectFacesOfThePlate(filter, 1.25 * Number(filter, "Tolerance") + 0.0004);
  const auto model =
    DecodeTrimmedModel(filter->GetOutputDataObject(1), filter->GetOutputDataObject(2));
  ASSERT_TRUE(model) << model.Status.Message();
  EXPECT_TRUE(model->Faces[0].Reversed);
}

TEST(TrimmedSurface, PropertiesReachTheKernel_PropertyOracle)
{
  vtkNew<vtkTrimmedSurface> filter;
  filter->SetInputDataObject(MakePlate({}));
  filter->SetElements(12);
  filter->SetDegree(2);
  filter->TriangulationOff();
  filter->Update();
  const auto surface = [&]
  {
    return std::get<Spline<2>>(
      DecodePatches(filter->GetOutputDataObject(1)).Patches.front().Geometry);
  };
  EXPECT_EQ(surface().Space->Knots[0].Degree(), 2);
  EXPECT_EQ(surface().Space->Knots[0].NumElements(), 12);
  EXPECT_EQ(Number(filter, "Triangles"), 0);
  const double narrow = surface().Space->Domain().Lower[0];
  filter->SetMargin(0.3);
  filter->Update();
  EXPECT_LT(surface().Space->Domain().Lower[0], narrow - 0.3);
  filter->TriangulationOn();
  filter->SetChordalTolerance(0.05);
  filter->Update();
  const double coarse = Number(filter, "Triangles");
  filter->SetChordalTolerance(0.0005);
  filter->Update();
  EXPECT_GT(Number(filter, "Triangles"), 2 * coarse);
  EXPECT_LE(Number(filter, "TriangleBound"), 0.0005);
  filter->SetCornerAngle(120.0); // no corners: one edge a loop
  filter->SetTolerance(0.05);
  filter->Update();
  EXPECT_EQ(Number(filter, "Edges"), 2);
  filter->SetElements(0);
  filter->SetTolerance(0.01);
  filter->SetMaximumElements(1);
  filter->SetDegree(1);
  vtkNew<MessageRecorder> recorder;
  recorder->Watch(filter);
  filter->Update();
  EXPECT_TRUE(recorder->Errors.empty());
  EXPECT_EQ(Number(filter, "WithinTolerance"), 0);
  ASSERT_FALSE(recorder->Warnings.empty());
  EXPECT_NE(recorder->Warnings[0].find("above the tolerance 0.01"), std::string::npos)
    << recorder->Warnings[0];
}

TEST(TrimmedSurface, SmoothingAndCentresReachTheKernel_PropertyOracle)
{
  vtkNew<vtkTrimmedSurface> filter;
  filter->SetInputDataObject(MakePlate({}));
  filter->SetElements(12);
  filter->Update();
  const double deviation = Number(filter, "MaxDeviation");
  filter->SetSmoothing(1e-1); // stiff: away from the points
  filter->Update();
  EXPECT_GT(Number(filter, "MaxDeviation"), 2.0 * deviation);
  filter->SetMethod(vtkTrimmedSurface::RBF);
  filter->SetCentres(40);
  filter->Update();
  EXPECT_EQ(Number(filter, "Centres"), 40);
}

TEST(TrimmedSurface, EveryMethodMakesTheFace_PropertyOracle)
{
  for (int method = vtkTrimmedSurface::NURBS; method <= vtkTrimmedSurface::CONTINUED_LINES;
       ++method)
  {
    SCOPED_TRACE("method " + std::to_string(method));
    vtkNew<vtkTrimmedSurface> filter;
    filter->SetInputDataObject(MakePlate({}));
    filter->SetMethod(method);
    filter->Update();
    EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
    // what the published method continues into the hole spoils the rings around it
    EXPECT_EQ(Number(filter, "WithinTolerance"), method != vtkTrimmedSurface::NURBS);
    EXPECT_EQ(Number(filter, "Loops"), 2);
    EXPECT_EQ(Number(filter, "Centres") > 0,
      method == vtkTrimmedSurface::RBF || method == vtkTrimmedSurface::HYBRID);
  }
}

TEST(TrimmedSurface, UnstructuredGridsAreMeshesToo_PropertyOracle)
{
  vtkNew<vtkAppendFilter> append;
  append->AddInputData(MakePlate({}));
  append->Update();
  vtkNew<vtkTrimmedSurface> filter;
  filter->SetInputDataObject(MakePlate({}));
  filter->Update();
  const double deviation = Number(filter, "MaxDeviation");
  filter->SetInputDataObject(append->GetOutput());
  filter->Update();
  EXPECT_EQ(Number(filter, "MaxDeviation"), deviation);
  EXPECT_TRUE(vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(3)));
}

TEST(TrimmedSurface, BadInputIsRefused)
{
  struct Damage
  {
    const char* Name;
    std::function<void(vtkPolyData*)> Do;
    ErrorCode Code;
    const char* Words;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto wide = [](vtkFieldData* data, const char* name, int components, vtkIdType tuples)
  {
    vtkNew<vtkDoubleArray> array;
    array->SetName(name);
    array->SetNumberOfComponents(components);
    array->SetNumberOfTuples(tuples);
    array->Fill(0.0);
    data->AddArray(array);
  };
  const Damage damages[] = {
    { "no plane coordinates", [](vtkPolyData* mesh) { mesh->GetPointData()->RemoveArray("UV"); },
      ErrorCode::SizeMismatch, "vtkMeshParameterization" },
    { "plane coordinates of three components",
      [&](vtkPolyData* mesh) { wide(mesh->GetPointData(), "UV", 3, mesh->GetNumberOfPoints()); },
      ErrorCode::SizeMismatch, "two components" },
    { "NaN in UV",
      [&](vtkPolyData* mesh) { mesh->GetPointData()->GetArray("UV")->SetComponent(17, 1, nan); },
      ErrorCode::NonFiniteInput, "UV of 1 points (17)" },
    { "infinity in a point",
      [](vtkPolyData* mesh)
      { mesh->GetPoints()->SetPoint(5, std::numeric_limits<double>::infinity(), 0, 0); },
      ErrorCode::NonFiniteInput, "" },
    { "a flipped triangle",
      [](vtkPolyData* mesh) { mesh->GetPointData()->GetArray("UV")->SetTuple2(50, 0.0, 0.0); },
      ErrorCode::InvalidTopology, "flipped in the plane" },
    { "all points in one place of the plane",
      [](vtkPolyData* mesh)
      {
        auto* uv = vtkDoubleArray::SafeDownCast(mesh->GetPointData()->GetArray("UV"));
        uv->Fill(1.0);
      },
      ErrorCode::InvalidTopology, "flipped in the plane" },
    { "a quadrilateral without area",
      [](vtkPolyData* mesh)
      {
        vtkNew<vtkCellArray> cells;
        cells->InsertNextCell({ 0, 1, 0, 1 });
        mesh->SetPolys(cells);
      },
      ErrorCode::InvalidTopology, "1 cells (0) cannot be divided into triangles" },
    { "no triangles", [](vtkPolyData* mesh) { mesh->SetPolys(vtkNew<vtkCellArray>()); },
      ErrorCode::EmptyInput, "without triangles" },
    { "an edge of three triangles",
      [](vtkPolyData* mesh)
      {
        vtkNew<vtkCellArray> cells;
        cells->DeepCopy(mesh->GetPolys());
        const vtkIdType first[3] = { 0, 1, 2 };
        cells->InsertNextCell(3, first);
        mesh->SetPolys(cells);
      },
      ErrorCode::InvalidTopology, "" },
    { "chart numbers of two components",
      [&](vtkPolyData* mesh) { wide(mesh->GetCellData(), "ChartId", 2, mesh->GetNumberOfCells()); },
      ErrorCode::SizeMismatch, "ChartId" },
    { "cut points of two components",
      [&](vtkPolyData* mesh)
      { wide(mesh->GetPointData(), "CutPointId", 2, mesh->GetNumberOfPoints()); },
      ErrorCode::SizeMismatch, "CutPointId" },
    { "nothing", [](vtkPolyData* mesh) { mesh->Initialize(); }, ErrorCode::EmptyInput, "" },
  };
  vtkNew<vtkTrimmedSurface> filter;
  for (const Damage& damage : damages)
  {
    SCOPED_TRACE(damage.Name);
    auto mesh = MakePlate({});
    damage.Do(mesh);
    filter->SetInputDataObject(mesh);
    ExpectFailure(filter, damage.Code, damage.Words);
    for (int port = 1; port < 4; ++port)
    {
      EXPECT_EQ(filter->GetOutputDataObject(port)->GetNumberOfElements(vtkDataObject::POINT), 0);
    }
    EXPECT_EQ(vtkTable::SafeDownCast(filter->GetOutputDataObject(4))->GetNumberOfRows(), 0);
  }
  filter->SetInputDataObject(MakePlate({}));
  filter->SetTolerance(nan);
  ExpectFailure(filter, ErrorCode::InvalidParameter, "Tolerance");
  filter->SetTolerance(0.0);
  filter->SetChordalTolerance(nan);
  ExpectFailure(filter, ErrorCode::InvalidParameter, "ChordalTolerance");
  filter->SetChordalTolerance(0.0);
  for (const auto set : { &vtkTrimmedSurface::SetMargin, &vtkTrimmedSurface::SetSmoothing,
         &vtkTrimmedSurface::SetCornerAngle })
  {
    vtkNew<vtkTrimmedSurface> other;
    other->SetInputDataObject(MakePlate({}));
    (other->*set)(nan);
    ExpectFailure(other, ErrorCode::InvalidParameter, "");
  }
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError) << "the filter works again";
  EXPECT_EQ(Number(filter, "Loops"), 2);
  vtkNew<MessageRecorder> recorder;
  recorder->Watch(filter);
  vtkNew<vtkImageData> image;
  filter->SetInputDataObject(image);
  filter->Update();
  EXPECT_FALSE(recorder->Errors.empty());
}

TEST(TrimmedSurface, CanBeStopped_PropertyOracle)
{
  vtkNew<vtkTrimmedSurface> filter;
  filter->SetInputDataObject(MakePlate({}));
  ExpectProgressAndAbort(filter, 3);
}
}
