// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceRemesh.h"

#include "OriginData.h"
#include <knotwork/MeshParameterization/MeshData.h>
#include <knotwork/SplineGrid/TableRow.h>
#include <knotwork/SurfaceRemeshing/SurfaceRemesh.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <cmath>
#include <map>
#include <string>

using namespace knotwork;

vtkStandardNewMacro(vtkSurfaceRemesh);

namespace
{
/// Lengths of edges, one a point.
Result<std::vector<double>> DecodeSizes(vtkPointSet* input, const std::string& name)
{
  vtkDataArray* array = input->GetPointData()->GetArray(name.c_str());
  if (!array || array->GetNumberOfComponents() != 1)
  {
    return { ErrorCode::InvalidParameter,
      (array
          ? "the point array '" + name + "' has " + std::to_string(array->GetNumberOfComponents()) +
            " components; name one of one component"
          : "there is no point array '" + name + "' of numbers; name one of the mesh") +
        " (SizeArray)" };
  }
  std::vector<double> sizes;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    sizes.push_back(array->GetComponent(i, 0));
    if (!std::isfinite(sizes.back()))
    {
      return { ErrorCode::NonFiniteInput,
        "the point array '" + name + "' has no number at point " + std::to_string(i) +
          " (SizeArray)" };
    }
  }
  return sizes;
}

void EncodeTriangles(const SurfaceRemesh& made, const std::vector<int>& cellsOfTriangles,
  vtkPointSet* input, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (Eigen::Index i = 0; i < made.Mesh.Points.rows(); ++i)
  {
    points->InsertNextPoint(made.Mesh.Points.row(i).data());
  }
  vtkNew<vtkCellArray> cells;
  std::vector<int> ids;
  for (std::size_t t = 0; t < made.Mesh.Triangles.size(); ++t)
  {
    const auto& corners = made.Mesh.Triangles[t];
    cells->InsertNextCell({ corners[0], corners[1], corners[2] });
    ids.push_back(cellsOfTriangles[static_cast<std::size_t>(made.TriangleIds[t])]);
  }
  output->SetPoints(points);
  output->SetPolys(cells);
  vtkCellData* data = output->GetCellData();
  CopyOriginData(input->GetCellData(), ids, "CellIds", data);
  data->AddArray(
    ArrayOf<vtkIntArray>("RegionId", made.RegionIds, [](int region) { return region; }));
  data->AddArray(ArrayOf<vtkIntArray>("PartId", made.PartIds, [](int part) { return part; }));
  output->GetPointData()->AddArray(
    ArrayOf<vtkDoubleArray>("EdgeSize", made.Sizes, [](double size) { return size; }));
}

void EncodeLines(const SurfaceRemesh& made, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  std::map<int, vtkIdType> numbers;
  const auto number = [&](int point)
  {
    const auto [found, isNew] = numbers.emplace(point, static_cast<vtkIdType>(numbers.size()));
    if (isNew)
    {
      points->InsertNextPoint(made.Mesh.Points.row(point).data());
    }
    return found->second;
  };
  vtkNew<vtkCellArray> corners;
  vtkNew<vtkCellArray> lines;
  const auto chains = NamedArray<vtkIntArray>("ChainId"); // vertices come before lines
  for (const int corner : made.Corners)
  {
    const vtkIdType id = number(corner);
    corners->InsertNextCell(1, &id);
    chains->InsertNextValue(-1);
  }
  for (std::size_t i = 0; i < made.Lines.size(); ++i)
  {
    lines->InsertNextCell({ number(made.Lines[i][0]), number(made.Lines[i][1]) });
    chains->InsertNextValue(made.LineChains[i]);
  }
  output->SetPoints(points);
  output->SetVerts(corners);
  output->SetLines(lines);
  output->GetCellData()->AddArray(chains);
}

void AddNumbers(vtkTable* table, const std::string& suffix, const RemeshNumbers& numbers)
{
  AddColumn(table, ("Points" + suffix).c_str(), numbers.Points);
  AddColumn(table, ("Triangles" + suffix).c_str(), numbers.Triangles);
  AddColumn(table, ("Parts" + suffix).c_str(), numbers.Parts);
  AddColumn(table, ("Euler" + suffix).c_str(), numbers.Euler);
  AddColumn(table, ("Area" + suffix).c_str(), numbers.Area);
  AddColumn(table, ("Volume" + suffix).c_str(), numbers.Volume);
  AddColumn(table, ("LeastAngle" + suffix).c_str(), numbers.LeastAngle);
  AddColumn(table, ("MeanEdge" + suffix).c_str(), numbers.MeanEdge);
}

void EncodeNumbers(const SurfaceRemesh& made, vtkTable* table)
{
  AddNumbers(table, "Before", made.Before);
  AddNumbers(table, "After", made.After);
  AddColumn(table, "FittingEdges", made.FittingEdges);
  AddColumn(table, "Intersections", made.Intersections);
  AddColumn(table, "DistanceFromInput", made.DistanceFromInput);
  AddColumn(table, "DistanceToInput", made.DistanceToInput);
  AddColumn(table, "Diagonal", made.Diagonal);
}
}

vtkSurfaceRemesh::vtkSurfaceRemesh()
{
  this->SetInputTypes({ Meshes() });
  this->SetOutputTypes({ "vtkPolyData", "vtkPolyData", "vtkTable" });
}

vtkSurfaceRemesh::~vtkSurfaceRemesh()
{
  this->SetSizeArray(nullptr);
}

Status vtkSurfaceRemesh::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPointSet* input = vtkPointSet::GetData(inputs[0], 0);
  if (input->GetNumberOfPoints() == 0)
  {
    return {};
  }
  const auto decoded = DecodeMesh(input);
  if (!decoded)
  {
    return decoded.Status;
  }
  SurfaceRemeshParams params;
  switch (this->Sizing)
  {
    case CURVATURE:
      params.Sizing = EdgeSizing::Curvature;
      break;
    case ARRAY:
    {
      auto sizes = DecodeSizes(input, this->SizeArray ? this->SizeArray : "");
      if (!sizes)
      {
        return sizes.Status;
      }
      params.Sizing = EdgeSizing::PerPoint;
      params.Sizes = std::move(sizes.Value);
      break;
    }
    default:
      params.Sizing = EdgeSizing::Constant;
  }
  params.Size = this->Size;
  params.Tolerance = this->Tolerance;
  params.SmallestSize = this->SmallestSize;
  params.LargestSize = this->LargestSize;
  params.Features = { this->SharpAngle, this->WeakAngle, this->CornerAngle };
  params.Iterations = this->Iterations;
  params.Limit = this->Limit;
  params.Threads = this->KernelThreads();
  params.Progress = this->Progress();
  const auto made = RemeshSurface(decoded->Mesh, params);
  if (!made)
  {
    return made.Status;
  }
  EncodeTriangles(made.Value, decoded->Cells, input, vtkPolyData::GetData(outputs, 0));
  EncodeLines(made.Value, vtkPolyData::GetData(outputs, 1));
  EncodeNumbers(made.Value, vtkTable::GetData(outputs, 2));
  return {};
}
