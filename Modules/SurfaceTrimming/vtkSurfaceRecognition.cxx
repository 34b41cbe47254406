// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceRecognition.h"

#include "TrimData.h"
#include <knotwork/MeshParameterization/MeshData.h>
#include <knotwork/SplineCore/TriangleIndex.h>
#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineGrid/TableRow.h>
#include <knotwork/SurfaceTrimming/SurfaceRecognition.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkObjectFactory.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <algorithm>
#include <map>

vtkStandardNewMacro(vtkSurfaceRecognition);

namespace
{
using namespace knotwork;

constexpr double Degrees = 57.29577951308232;

vtkSmartPointer<vtkPoints> PointsOf(const TriangleMesh& mesh)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  for (Eigen::Index i = 0; i < mesh.Points.rows(); ++i)
  {
    points->InsertNextPoint(mesh.Points(i, 0), mesh.Points(i, 1), mesh.Points(i, 2));
  }
  return points;
}

void EncodeTriangles(
  const TriangleMesh& mesh, const SurfaceRecognition& found, vtkPoints* points, vtkPolyData* output)
{
  vtkNew<vtkCellArray> cells;
  const auto ids = NamedArray<vtkIntArray>("RegionId");
  const auto types = NamedArray<vtkIntArray>("SurfaceType");
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    const int region = found.RegionOfTriangle[t];
    if (region < 0)
    {
      continue;
    }
    const auto& corners = mesh.Triangles[t];
    const vtkIdType triangle[3] = { corners[0], corners[1], corners[2] };
    cells->InsertNextCell(3, triangle);
    ids->InsertNextValue(region);
    types->InsertNextValue(
      static_cast<int>(found.Regions[static_cast<std::size_t>(region)].Surface.Type));
  }
  output->SetPoints(points);
  output->SetPolys(cells);
  output->GetCellData()->AddArray(ids);
  output->GetCellData()->AddArray(types);
  output->GetCellData()->SetActiveScalars("SurfaceType");
}

/// Edges of triangles of two regions; equal points are one.
void EncodeEdges(
  const TriangleMesh& mesh, const SurfaceRecognition& found, vtkPoints* points, vtkPolyData* output)
{
  vtkNew<vtkCellArray> lines;
  const auto regions = NamedArray<vtkIntArray>("Regions");
  regions->SetNumberOfComponents(2);
  const auto triangles = ReplaceCorners(mesh.Triangles, FirstOfEqualPoints(mesh.Points));
  std::map<std::array<int, 2>, int> open; // region of an edge's first triangle
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    const int own = found.RegionOfTriangle[t];
    for (std::size_t k = 0; own >= 0 && k < 3; ++k)
    {
      const int a = triangles[t][k];
      const int b = triangles[t][(k + 1) % 3];
      const auto [other, isNew] =
        open.emplace(std::array<int, 2>{ std::min(a, b), std::max(a, b) }, own);
      if (!isNew && other->second != own)
      {
        const vtkIdType ends[2] = { a, b };
        lines->InsertNextCell(2, ends);
        const int both[2] = { std::min(own, other->second), std::max(own, other->second) };
        regions->InsertNextTypedTuple(both);
      }
    }
  }
  output->SetPoints(points);
  output->SetLines(lines);
  output->GetCellData()->AddArray(regions);
}

double AreaOf(const TriangleMesh& mesh, const std::vector<int>& triangles)
{
  double area = 0.0;
  for (const int t : triangles)
  {
    area += TriangleArea(mesh.Points, mesh.Triangles[static_cast<std::size_t>(t)]);
  }
  return area;
}

void EncodeRegions(const TriangleMesh& mesh, const SurfaceRecognition& found, vtkTable* table)
{
  const auto numbers = NamedArray<vtkIntArray>("Region");
  const auto types = NamedArray<vtkStringArray>("Type");
  const auto triangles = NamedArray<vtkIntArray>("Triangles");
  const auto points = NamedArray<vtkDoubleArray>("Point");
  const auto axes = NamedArray<vtkDoubleArray>("Axis");
  points->SetNumberOfComponents(3);
  axes->SetNumberOfComponents(3);
  const auto reversed = NamedArray<vtkIntArray>("Reversed");
  std::map<std::string, vtkSmartPointer<vtkDoubleArray>> values;
  std::map<std::string, vtkSmartPointer<vtkIntArray>> common;
  for (const char* name : { "Direction", "Position", "Size" })
  {
    common[name] = NamedArray<vtkIntArray>(name);
  }
  for (const char* name :
    { "Area", "Radius", "MinorRadius", "Angle", "MaxDistance", "MaxSag", "Turn" })
  {
    values[name] = NamedArray<vtkDoubleArray>(name);
  }
  for (std::size_t r = 0; r < found.Regions.size(); ++r)
  {
    const RecognizedRegion& region = found.Regions[r];
    numbers->InsertNextValue(static_cast<int>(r));
    types->InsertNextValue(ToString(region.Surface.Type));
    triangles->InsertNextValue(static_cast<int>(region.Triangles.size()));
    points->InsertNextTypedTuple(region.Surface.Point.data());
    axes->InsertNextTypedTuple(region.Surface.Axis.data());
    reversed->InsertNextValue(region.Reversed ? 1 : 0);
    values["Area"]->InsertNextValue(AreaOf(mesh, region.Triangles));
    values["Radius"]->InsertNextValue(region.Surface.Radius);
    values["MinorRadius"]->InsertNextValue(region.Surface.MinorRadius);
    values["Angle"]->InsertNextValue(Degrees * region.Surface.Angle);
    values["MaxDistance"]->InsertNextValue(region.MaxDistance);
    values["MaxSag"]->InsertNextValue(region.MaxSag);
    values["Turn"]->InsertNextValue(region.Turn);
    common["Direction"]->InsertNextValue(region.Direction);
    common["Position"]->InsertNextValue(region.Position);
    common["Size"]->InsertNextValue(region.Size);
  }
  table->AddColumn(numbers);
  table->AddColumn(types);
  table->AddColumn(triangles);
  table->AddColumn(values["Area"]);
  table->AddColumn(points);
  table->AddColumn(axes);
  for (const char* name : { "Radius", "MinorRadius", "Angle" })
  {
    table->AddColumn(values[name]);
  }
  table->AddColumn(reversed);
  table->AddColumn(values["MaxDistance"]);
  table->AddColumn(values["MaxSag"]);
  for (const char* name : { "Direction", "Position", "Size" })
  {
    table->AddColumn(common[name]);
  }
  table->AddColumn(values["Turn"]);
}

void EncodeNumbers(const SurfaceRecognition& found, vtkTable* table)
{
  const auto count = [&](SurfaceType type)
  { return found.NumOfType[static_cast<std::size_t>(type)]; };
  AddColumn(table, "Regions", static_cast<int>(found.Regions.size()));
  AddColumn(table, "Planes", count(SurfaceType::Plane));
  AddColumn(table, "Cylinders", count(SurfaceType::Cylinder));
  AddColumn(table, "Spheres", count(SurfaceType::Sphere));
  AddColumn(table, "Cones", count(SurfaceType::Cone));
  AddColumn(table, "Tori", count(SurfaceType::Torus));
  AddColumn(table, "Extrusions", count(SurfaceType::Extrusion));
  AddColumn(table, "Revolutions", count(SurfaceType::Revolution));
  AddColumn(table, "FreeForms", count(SurfaceType::FreeForm));
  double distance = 0.0;
  double sag = 0.0;
  for (const RecognizedRegion& region : found.Regions)
  {
    distance = std::max(distance, region.MaxDistance);
    sag = std::max(sag, region.MaxSag);
  }
  AddColumn(table, "MaxDistance", distance);
  AddColumn(table, "MaxSag", sag);
  AddColumn(table, "Noise", found.Noise);
  AddColumn(table, "Tolerance", found.Tolerance);
  EncodeSnapped(found.Snapped, table);
}
}

vtkSurfaceRecognition::vtkSurfaceRecognition()
{
  this->SetInputTypes({ Meshes() });
  this->SetOutputTypes({ "vtkPolyData", "vtkPolyData", "vtkTable", "vtkTable" });
}

knotwork::Status vtkSurfaceRecognition::Compute(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const auto decoded = DecodeMesh(vtkPointSet::GetData(inputs[0], 0));
  if (!decoded)
  {
    return decoded.Status;
  }
  RecognitionParams params;
  params.Tolerance = this->Tolerance;
  params.MaximumSag = this->MaximumSag;
  params.SnapDistance = this->SnapDistance;
  params.Progress = this->Progress();
  const TriangleMesh& mesh = decoded->Mesh;
  const auto found = RecognizeSurfaces(mesh, params);
  if (!found)
  {
    return found.Status;
  }
  const auto points = PointsOf(mesh);
  EncodeTriangles(mesh, found.Value, points, vtkPolyData::GetData(outputs, 0));
  EncodeEdges(mesh, found.Value, points, vtkPolyData::GetData(outputs, 1));
  EncodeRegions(mesh, found.Value, vtkTable::GetData(outputs, 2));
  EncodeNumbers(found.Value, vtkTable::GetData(outputs, 3));
  return {};
}
