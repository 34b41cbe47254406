// SPDX-License-Identifier: BSD-3-Clause
#include "MeshData.h"

#include "TableRow.h"

#include "vtkCell.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

namespace knotwork
{
namespace
{
/// Rows `ids` of uv as an array.
vtkSmartPointer<vtkDoubleArray> UvArray(const PointMatrix& uv, const std::vector<int>& ids)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName("UV");
  array->SetNumberOfComponents(2);
  array->SetNumberOfTuples(static_cast<vtkIdType>(ids.size()));
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    array->SetTuple2(static_cast<vtkIdType>(i), uv(ids[i], 0), uv(ids[i], 1));
  }
  return array;
}

vtkSmartPointer<vtkPoints> PointsOf(
  const MeshParameterization& map, const std::vector<int>& ids, bool flat, int precision)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataType(flat ? VTK_DOUBLE : precision);
  points->SetNumberOfPoints(static_cast<vtkIdType>(ids.size()));
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    const auto at = static_cast<vtkIdType>(i);
    const Eigen::Vector3d p = map.Mesh.Point(ids[i]);
    flat ? points->SetPoint(at, map.UV(ids[i], 0), map.UV(ids[i], 1), 0.0)
         : points->SetPoint(at, p.data());
  }
  return points;
}
}

Result<DecodedMesh> DecodeMesh(vtkPointSet* data)
{
  Result<DecodedMesh> result;
  TriangleMesh& mesh = result.Value.Mesh;
  const vtkIdType n = data->GetNumberOfPoints();
  mesh.Points.resize(n, 3);
  for (vtkIdType i = 0; i < n; ++i)
  {
    data->GetPoint(i, mesh.Points.row(i).data());
  }
  std::string others;
  int count = 0;
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < data->GetNumberOfCells(); ++cell)
  {
    const int type = data->GetCellType(cell);
    if (type == VTK_EMPTY_CELL || type == VTK_VERTEX || type == VTK_POLY_VERTEX ||
      type == VTK_LINE || type == VTK_POLY_LINE)
    {
      continue;
    }
    data->GetCellPoints(cell, corners);
    if ((type == VTK_TRIANGLE || type == VTK_POLYGON) && corners->GetNumberOfIds() == 3)
    {
      mesh.Triangles.push_back({ static_cast<int>(corners->GetId(0)),
        static_cast<int>(corners->GetId(1)), static_cast<int>(corners->GetId(2)) });
      result.Value.Cells.push_back(static_cast<int>(cell));
    }
    else if (count++ < 5)
    {
      others += (others.empty() ? "" : ", ") + std::to_string(cell);
    }
  }
  if (count > 0)
  {
    return { ErrorCode::InvalidTopology,
      std::to_string(count) + " cells that are no triangles (" + others +
        (count > 5 ? ", ...)" : ")") + "; triangulate the mesh first, with vtkTriangleFilter" };
  }
  return result;
}

void EncodeMesh(const DecodedMesh& decoded, const MeshParameterization& map, vtkPointSet* input,
  bool flat, vtkPolyData* output)
{
  const DiscMesh& mesh = map.Mesh;
  std::vector<int> all(mesh.PointIds.size());
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    all[i] = static_cast<int>(i);
  }
  output->SetPoints(PointsOf(map, all, flat, input->GetPoints()->GetDataType()));
  vtkNew<vtkCellArray> cells;
  for (const auto& corners : mesh.Triangles)
  {
    const vtkIdType ids[3] = { corners[0], corners[1], corners[2] };
    cells->InsertNextCell(3, ids);
  }
  output->SetPolys(cells);
  vtkPointData* points = output->GetPointData();
  points->CopyAllOn();
  points->CopyAllocate(input->GetPointData(), static_cast<vtkIdType>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    points->CopyData(input->GetPointData(), mesh.PointIds[i], static_cast<vtkIdType>(i));
  }
  points->AddArray(UvArray(map.UV, all));
  points->SetActiveTCoords("UV");
  vtkCellData* data = output->GetCellData();
  data->CopyAllOn();
  data->CopyAllocate(input->GetCellData(), static_cast<vtkIdType>(mesh.Triangles.size()));
  vtkNew<vtkDoubleArray> values;
  values->SetName("SingularValues");
  values->SetNumberOfComponents(2);
  vtkNew<vtkUnsignedCharArray> flipped;
  flipped->SetName("Flipped");
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    const auto triangle = static_cast<std::size_t>(mesh.TriangleIds[t]);
    data->CopyData(input->GetCellData(), decoded.Cells[triangle], static_cast<vtkIdType>(t));
    const auto s = map.Measures.SingularValues.row(static_cast<Eigen::Index>(t));
    values->InsertNextTuple2(s[0], s[1]);
    flipped->InsertNextValue(s[1] > 0.0 ? 0 : 1);
  }
  data->AddArray(values);
  data->AddArray(flipped);
}

void EncodeLoops(const MeshParameterization& map, bool flat, vtkPolyData* output)
{
  std::vector<int> all;
  vtkNew<vtkCellArray> lines;
  vtkNew<vtkIntArray> number;
  number->SetName("Loop");
  vtkNew<vtkDoubleArray> length;
  length->SetName("Length");
  for (const std::vector<int>& loop : map.Mesh.Loops)
  {
    lines->InsertNextCell(static_cast<int>(loop.size()) + 1);
    double sum = 0.0;
    for (std::size_t i = 0; i <= loop.size(); ++i)
    {
      const std::size_t at = i % loop.size();
      lines->InsertCellPoint(static_cast<vtkIdType>(all.size() + at));
      sum += i == 0 ? 0.0 : (map.Mesh.Point(loop[at]) - map.Mesh.Point(loop[i - 1])).norm();
    }
    all.insert(all.end(), loop.begin(), loop.end());
    number->InsertNextValue(static_cast<int>(number->GetNumberOfTuples()));
    length->InsertNextValue(sum);
  }
  output->SetPoints(PointsOf(map, all, flat, VTK_DOUBLE));
  output->SetLines(lines);
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("PointIds");
  for (int v : all)
  {
    ids->InsertNextValue(map.Mesh.PointIds[static_cast<std::size_t>(v)]);
  }
  output->GetPointData()->AddArray(UvArray(map.UV, all));
  output->GetPointData()->AddArray(ids);
  output->GetCellData()->AddArray(number);
  output->GetCellData()->AddArray(length);
}

void EncodeSummary(const MeshParameterization& map, FlattenMethod asked, vtkTable* output)
{
  const FlattenMeasures& measures = map.Measures;
  AddColumn(output, "RequestedMethod", std::string(ToString(asked)));
  AddColumn(output, "Method", std::string(ToString(map.Used)));
  AddColumn(output, "Fallback", map.FallbackReason.empty() ? 0 : 1);
  AddColumn(output, "FallbackReason", map.FallbackReason);
  AddColumn(output, "Points", map.Mesh.NumPoints());
  AddColumn(output, "Triangles", static_cast<int>(map.Mesh.Triangles.size()));
  AddColumn(output, "Loops", static_cast<int>(map.Mesh.Loops.size()));
  AddColumn(output, "Components", map.Mesh.Components);
  AddColumn(output, "TurnedTriangles", map.Mesh.Reversed);
  AddColumn(output, "FlippedTriangles", measures.FlippedTriangles);
  AddColumn(output, "MeanStretch", measures.MeanStretch);
  AddColumn(output, "MaxStretch", measures.MaxStretch);
  AddColumn(output, "MinSingularValue", measures.MinSingularValue);
  AddColumn(output, "MaxSingularValue", measures.MaxSingularValue);
  AddColumn(output, "MeanAreaDistortion", measures.MeanAreaDistortion);
  AddColumn(output, "MaxAreaDistortion", measures.MaxAreaDistortion);
  AddColumn(output, "IsometryError", measures.IsometryError);
  AddColumn(output, "DistanceError", measures.DistanceError);
  AddColumn(output, "RejectedEigenvectors", map.RejectedEigenvectors);
  AddColumn(output, "Seconds", map.Seconds);
}
}
