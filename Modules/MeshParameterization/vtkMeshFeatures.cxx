// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshFeatures.h"

#include "MeshData.h"

#include <knotwork/MeshParameterization/KnownEdges.h>
#include <knotwork/MeshParameterization/ScanFeatures.h>
#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineGrid/TableRow.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIdList.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

vtkStandardNewMacro(vtkMeshFeatures);

namespace
{
using namespace knotwork;

/// Pairs of points of the mesh from lines of a data set.
Result<std::vector<std::array<int, 2>>> DecodeEdges(const TriangleMesh& mesh, vtkPolyData* data)
{
  const vtkIdType count = data->GetNumberOfPoints();
  PointMatrix points(count, 3);
  for (vtkIdType i = 0; i < count; ++i)
  {
    data->GetPoint(i, points.row(i).data());
  }
  std::vector<std::vector<int>> lines;
  vtkNew<vtkIdList> ids;
  vtkCellArray* cells = data->GetLines();
  for (vtkIdType cell = 0; cell < cells->GetNumberOfCells(); ++cell)
  {
    cells->GetCellAtId(cell, ids);
    std::vector<int>& line = lines.emplace_back();
    for (const vtkIdType id : *ids)
    {
      if (id < 0 || id >= count)
      {
        return { ErrorCode::InvalidTopology,
          "line " + std::to_string(cell) + " of the known edges has the point " +
            std::to_string(id) + " of " + std::to_string(count) + "; mend the file" };
      }
      line.push_back(static_cast<int>(id));
    }
  }
  if (lines.empty())
  {
    return { ErrorCode::EmptyInput, "the known edges (input 1) have no lines" };
  }
  return EdgesOfLines(mesh, points, lines);
}

/// The number of a value: how many others came before it.
template <class Value>
int NumberOf(Value value, std::map<Value, int>& numbers)
{
  return numbers.emplace(value, static_cast<int>(numbers.size())).first->second;
}

/// A number for each value of a cell array, one a triangle.
Result<std::vector<int>> DecodeRegions(
  const DecodedMesh& decoded, vtkPointSet* input, const std::string& name)
{
  vtkDataArray* array = input->GetCellData()->GetArray(name.c_str());
  if (!array || array->GetNumberOfComponents() != 1)
  {
    return { ErrorCode::InvalidParameter,
      (array
          ? "the cell array '" + name + "' has " + std::to_string(array->GetNumberOfComponents()) +
            " components; name one of one component"
          : "there is no cell array '" + name + "' of numbers; name one of the mesh") +
        " (RegionArray)" };
  }
  const bool isReal = array->GetDataType() == VTK_DOUBLE || array->GetDataType() == VTK_FLOAT;
  std::map<double, int> numbers;
  std::map<vtkTypeInt64, int> integers; // doubles would make one of those beyond 2^53
  std::vector<int> regions;
  for (const int cell : decoded.Cells)
  {
    if (!isReal)
    {
      regions.push_back(NumberOf(array->GetVariantValue(cell).ToTypeInt64(), integers));
      continue;
    }
    const double value = array->GetComponent(cell, 0);
    if (std::isnan(value))
    {
      return { ErrorCode::NonFiniteInput,
        "the cell array '" + name + "' has no number at cell " + std::to_string(cell) +
          " (RegionArray)" };
    }
    regions.push_back(NumberOf(value, numbers));
  }
  return regions;
}

void EncodeTriangles(
  const DecodedMesh& decoded, const ScanFeatures& found, vtkPointSet* input, vtkPolyData* output)
{
  vtkNew<vtkCellArray> cells;
  vtkCellData* data = output->GetCellData();
  data->CopyAllOn();
  data->SetCopyGlobalIds(decoded.Divided == 0);
  data->CopyAllocate(input->GetCellData(), static_cast<vtkIdType>(decoded.Mesh.Triangles.size()));
  const auto regions = NamedArray<vtkIntArray>("RegionId");
  for (std::size_t t = 0; t < decoded.Mesh.Triangles.size(); ++t)
  {
    if (found.RegionOfTriangle[t] < 0)
    {
      continue;
    }
    const auto& corners = decoded.Mesh.Triangles[t];
    const vtkIdType ids[3] = { corners[0], corners[1], corners[2] };
    const vtkIdType cell = cells->InsertNextCell(3, ids);
    data->CopyData(input->GetCellData(), decoded.Cells[t], cell);
    regions->InsertNextValue(found.RegionOfTriangle[t]);
  }
  output->SetPoints(input->GetPoints());
  output->GetPointData()->ShallowCopy(input->GetPointData());
  output->SetPolys(cells);
  data->AddArray(regions);
  data->SetActiveScalars("RegionId");
}

/// The points of cells, those of the mesh, in the order in which they come.
class LinePoints
{
public:
  explicit LinePoints(const TriangleMesh& mesh) : Mesh(mesh)
  {
    this->Points->SetDataTypeToDouble();
  }
  vtkIdType Add(int point)
  {
    const auto [found, isNew] =
      this->Numbers.emplace(point, static_cast<vtkIdType>(this->Numbers.size()));
    if (isNew)
    {
      this->Points->InsertNextPoint(this->Mesh.Points.row(point).data());
      this->Ids->InsertNextValue(point);
    }
    return found->second;
  }
  void Set(vtkPolyData* output) const
  {
    output->SetPoints(this->Points);
    output->GetPointData()->AddArray(this->Ids);
  }

private:
  const TriangleMesh& Mesh;
  std::map<int, vtkIdType> Numbers;
  vtkNew<vtkPoints> Points;
  vtkSmartPointer<vtkIntArray> Ids = NamedArray<vtkIntArray>("PointIds");
};

void EncodeLines(const TriangleMesh& mesh, const ScanFeatures& found, vtkPolyData* output)
{
  LinePoints points(mesh);
  vtkNew<vtkCellArray> cells;
  const auto ids = NamedArray<vtkIntArray>("ChainId");
  for (std::size_t i = 0; i < found.Lines.size(); ++i)
  {
    const FeatureChain& chain = found.Lines[i].Chain;
    cells->InsertNextCell(static_cast<int>(chain.Points.size()) + (chain.Closed ? 1 : 0));
    for (const int point : chain.Points)
    {
      cells->InsertCellPoint(points.Add(point));
    }
    if (chain.Closed)
    {
      cells->InsertCellPoint(points.Add(chain.Points.front()));
    }
    ids->InsertNextValue(static_cast<int>(i));
  }
  points.Set(output);
  output->SetLines(cells);
  vtkCellData* data = output->GetCellData();
  const auto add = [&](const char* name, auto value)
  { data->AddArray(ArrayOf<vtkDoubleArray>(name, found.Lines, value)); };
  data->AddArray(ids);
  data->AddArray(ArrayOf<vtkIntArray>(
    "Closed", found.Lines, [](const FeatureLine& line) { return line.Chain.Closed ? 1 : 0; }));
  data->AddArray(ArrayOf<vtkIntArray>(
    "Rim", found.Lines, [](const FeatureLine& line) { return line.IsRim ? 1 : 0; }));
  add("Angle", [](const FeatureLine& line) { return line.MaxAngle; });
  add("MeanAngle", [](const FeatureLine& line) { return line.MeanAngle; });
  add("Length", [](const FeatureLine& line) { return line.Length; });
}

void EncodeCorners(const TriangleMesh& mesh, const ScanFeatures& found, vtkPolyData* output)
{
  LinePoints points(mesh);
  vtkNew<vtkCellArray> cells;
  for (const int corner : found.Corners)
  {
    const vtkIdType id = points.Add(corner);
    cells->InsertNextCell(1, &id);
  }
  points.Set(output);
  output->SetVerts(cells);
}

void EncodeNumbers(const ScanFeatures& found, vtkTable* table)
{
  AddColumn(table, "SharpEdges", found.NumSharpEdges);
  AddColumn(table, "RimEdges", found.NumRimEdges);
  AddColumn(table, "Chains", static_cast<int>(found.Lines.size()));
  AddColumn(table, "ClosedChains",
    static_cast<int>(std::count_if(found.Lines.begin(), found.Lines.end(),
      [](const FeatureLine& line) { return line.Chain.Closed; })));
  AddColumn(table, "Corners", static_cast<int>(found.Corners.size()));
  AddColumn(table, "Regions", found.NumRegions);
  AddColumn(table, "JoinedRegions", found.NumJoined);
  AddColumn(table, "ClosedGaps", found.NumClosedGaps);
  AddColumn(table, "NoiseLevel", found.Noise);
}
}

vtkMeshFeatures::vtkMeshFeatures()
{
  this->SetInputTypes({ Meshes(), Optional({ { "vtkPolyData" } }) });
  this->SetOutputTypes({ "vtkPolyData", "vtkPolyData", "vtkPolyData", "vtkTable" });
}

vtkMeshFeatures::~vtkMeshFeatures()
{
  this->SetRegionArray(nullptr);
}

void vtkMeshFeatures::SetEdgesConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkMeshFeatures::SetEdgesData(vtkDataObject* edges)
{
  this->SetInputDataObject(1, edges);
}

knotwork::Status vtkMeshFeatures::Compute(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPointSet* input = vtkPointSet::GetData(inputs[0], 0);
  const auto decoded = DecodeMesh(input);
  if (!decoded)
  {
    return decoded.Status;
  }
  const TriangleMesh& mesh = decoded->Mesh;
  ScanFeatureParams params;
  params.Angles = { this->SharpAngle, this->WeakAngle, this->CornerAngle };
  params.Noise = this->NoiseLevel;
  params.SmallestRegion = this->SmallestRegion;
  params.NarrowWidth = this->NarrowWidth;
  params.LargestGap = this->LargestGap;
  params.Threads = this->KernelThreads();
  params.Progress = this->Progress();
  params.Known.Only = this->Mode == REPLACE;
  if (vtkPolyData* lines = vtkPolyData::GetData(inputs[1], 0))
  {
    auto edges = DecodeEdges(mesh, lines);
    if (!edges)
    {
      return edges.Status;
    }
    params.Known.Edges = std::move(edges.Value);
  }
  const std::string array = this->RegionArray ? this->RegionArray : "";
  if (!array.empty() && array != "None")
  {
    auto regions = DecodeRegions(decoded.Value, input, array);
    if (!regions)
    {
      return regions.Status;
    }
    params.Known.Regions = std::move(regions.Value);
  }
  const auto found = FindScanFeatures(mesh, params);
  if (!found)
  {
    return found.Status;
  }
  EncodeTriangles(decoded.Value, found.Value, input, vtkPolyData::GetData(outputs, 0));
  EncodeLines(mesh, found.Value, vtkPolyData::GetData(outputs, 1));
  EncodeCorners(mesh, found.Value, vtkPolyData::GetData(outputs, 2));
  EncodeNumbers(found.Value, vtkTable::GetData(outputs, 3));
  return {};
}
