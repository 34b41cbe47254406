// SPDX-License-Identifier: BSD-3-Clause
#include "MeshData.h"

#include <knotwork/MeshParameterization/PolygonTriangles.h>
#include <knotwork/SplineGrid/InputChecks.h>
#include <knotwork/SplineGrid/TableRow.h>

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
#include <set>
#include <utility>

namespace knotwork
{
namespace
{
/// A point of the output: a point of a chart.
struct ChartPoint
{
  const MeshParameterization* Chart = nullptr;
  int Point = 0;

  int CutPoint() const { return this->Chart->Mesh.PointIds[static_cast<std::size_t>(this->Point)]; }
};

/// Points with `UV` and `CutPointId`.
void SetPoints(const std::vector<ChartPoint>& from, bool flat, int precision, vtkPolyData* output)
{
  const auto n = static_cast<vtkIdType>(from.size());
  vtkNew<vtkPoints> points;
  points->SetDataType(flat ? VTK_DOUBLE : precision);
  points->SetNumberOfPoints(n);
  vtkNew<vtkDoubleArray> places;
  places->SetName("UV");
  places->SetNumberOfComponents(2);
  places->SetNumberOfTuples(n);
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("CutPointId");
  ids->SetNumberOfTuples(n);
  for (vtkIdType i = 0; i < n; ++i)
  {
    const ChartPoint& point = from[static_cast<std::size_t>(i)];
    const auto uv = point.Chart->UV.row(point.Point);
    const Eigen::Vector3d p = point.Chart->Mesh.Point(point.Point);
    flat ? points->SetPoint(i, uv[0], uv[1], 0.0) : points->SetPoint(i, p.data());
    places->SetTuple2(i, uv[0], uv[1]);
    ids->SetValue(i, point.CutPoint());
  }
  output->SetPoints(points);
  output->GetPointData()->AddArray(places);
  output->GetPointData()->AddArray(ids);
}

bool IsInputPoint(const PointOrigin& origin)
{
  return origin.Points[1] < 0;
}

/// Point data of the input; no global ids where points have copies or are new.
void CopyPointData(const std::vector<ChartPoint>& from, const std::vector<PointOrigin>& origins,
  vtkPointData* input, vtkPointData* output)
{
  const bool same =
    from.size() == origins.size() && std::all_of(origins.begin(), origins.end(), IsInputPoint);
  output->CopyAllOn();
  output->SetCopyGlobalIds(same);
  output->CopyAllocate(input, static_cast<vtkIdType>(from.size()));
  vtkNew<vtkIdList> ids;
  for (std::size_t i = 0; i < from.size(); ++i)
  {
    const PointOrigin& origin = origins[static_cast<std::size_t>(from[i].CutPoint())];
    const auto to = static_cast<vtkIdType>(i);
    if (IsInputPoint(origin))
    {
      output->CopyData(input, origin.Points[0], to);
      continue;
    }
    ids->Reset();
    std::array<double, 3> weights = origin.Weights;
    for (int id : origin.Points)
    {
      if (id >= 0)
      {
        ids->InsertNextId(id);
      }
    }
    output->InterpolatePoint(input, to, ids, weights.data());
  }
}

/// Cells for a message, the first ones by their ids.
struct CellList
{
  int Count = 0;
  std::string Ids;

  void Add(vtkIdType cell)
  {
    if (this->Count++ < 5)
    {
      this->Ids += (this->Ids.empty() ? "" : ", ") + std::to_string(cell);
    }
  }
  std::string Text() const
  {
    return std::to_string(this->Count) + " cells (" + this->Ids +
      (this->Count > 5 ? ", ...)" : ")");
  }
};

bool IsFace(int type)
{
  return type == VTK_TRIANGLE || type == VTK_QUAD || type == VTK_PIXEL || type == VTK_POLYGON ||
    type == VTK_TRIANGLE_STRIP;
}

/// Triangles between the corners of a face, in its orientation.
bool DivideFace(
  vtkPointSet* data, int type, vtkIdList* corners, std::vector<std::array<int, 3>>& triangles)
{
  const vtkIdType n = corners->GetNumberOfIds();
  const auto add = [&](vtkIdType a, vtkIdType b, vtkIdType c)
  {
    triangles.push_back({ static_cast<int>(corners->GetId(a)), static_cast<int>(corners->GetId(b)),
      static_cast<int>(corners->GetId(c)) });
  };
  if (n < 3)
  {
    return false;
  }
  if (type == VTK_TRIANGLE_STRIP || n == 3)
  {
    for (vtkIdType i = 0; i + 2 < n; ++i)
    {
      add(i, i + 1 + i % 2, i + 2 - i % 2);
    }
    return true;
  }
  if (type == VTK_PIXEL)
  {
    std::swap(*corners->GetPointer(2), *corners->GetPointer(3));
  }
  PointMatrix points(n, 3);
  for (vtkIdType i = 0; i < n; ++i)
  {
    data->GetPoint(corners->GetId(i), points.row(i).data());
  }
  for (const auto& [a, b, c] : DividePolygon(points))
  {
    add(a, b, c);
  }
  return !triangles.empty();
}
}

Result<DecodedMesh> DecodeMesh(vtkPointSet* data)
{
  if (Status status = CheckCellSizes(data); !status)
  {
    return status;
  }
  Result<DecodedMesh> result;
  TriangleMesh& mesh = result.Value.Mesh;
  const vtkIdType n = data->GetNumberOfPoints();
  mesh.Points.resize(n, 3);
  for (vtkIdType i = 0; i < n; ++i)
  {
    data->GetPoint(i, mesh.Points.row(i).data());
  }
  CellList undivided;
  CellList others;
  vtkNew<vtkIdList> corners;
  std::vector<std::array<int, 3>> triangles;
  for (vtkIdType cell = 0; cell < data->GetNumberOfCells(); ++cell)
  {
    const int type = data->GetCellType(cell);
    if (type == VTK_EMPTY_CELL || type == VTK_VERTEX || type == VTK_POLY_VERTEX ||
      type == VTK_LINE || type == VTK_POLY_LINE)
    {
      continue;
    }
    data->GetCellPoints(cell, corners);
    triangles.clear();
    if (!IsFace(type))
    {
      others.Add(cell);
    }
    else if (!DivideFace(data, type, corners, triangles))
    {
      undivided.Add(cell);
    }
    result.Value.Divided += triangles.size() > 1;
    for (const auto& triangle : triangles)
    {
      mesh.Triangles.push_back(triangle);
      result.Value.Cells.push_back(static_cast<int>(cell));
    }
  }
  if (others.Count > 0)
  {
    return { ErrorCode::InvalidTopology,
      others.Text() + " are no faces of a mesh; take their surface first, with vtkGeometryFilter" };
  }
  if (undivided.Count > 0)
  {
    return { ErrorCode::InvalidTopology,
      undivided.Text() +
        " cannot be divided into triangles: they cross themselves, have no area, or fewer than "
        "three corners; mend or remove them" };
  }
  return result;
}

void EncodeMesh(const DecodedMesh& decoded, const ChartedMesh& charted, vtkPointSet* input,
  bool flat, vtkPolyData* output)
{
  std::vector<ChartPoint> from;
  vtkNew<vtkCellArray> cells;
  vtkCellData* data = output->GetCellData();
  data->CopyAllOn();
  data->SetCopyGlobalIds(decoded.Divided == 0 && charted.Triangles.size() <= decoded.Cells.size());
  data->CopyAllocate(input->GetCellData(), static_cast<vtkIdType>(charted.Triangles.size()));
  vtkNew<vtkIntArray> number;
  number->SetName("ChartId");
  vtkNew<vtkDoubleArray> values;
  values->SetName("SingularValues");
  values->SetNumberOfComponents(2);
  vtkNew<vtkUnsignedCharArray> flipped;
  flipped->SetName("Flipped");
  for (std::size_t c = 0; c < charted.Charts.size(); ++c)
  {
    const DiscMesh& mesh = charted.Charts[c].Mesh;
    const auto first = static_cast<vtkIdType>(from.size());
    for (int v = 0; v < mesh.NumPoints(); ++v)
    {
      from.push_back({ &charted.Charts[c], v });
    }
    for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
    {
      const auto& corners = mesh.Triangles[t];
      const vtkIdType ids[3] = { first + corners[0], first + corners[1], first + corners[2] };
      const vtkIdType cell = cells->InsertNextCell(3, ids);
      const auto triangle = static_cast<std::size_t>(mesh.TriangleIds[t]);
      const auto origin = static_cast<std::size_t>(charted.TriangleIds[triangle]);
      data->CopyData(input->GetCellData(), decoded.Cells[origin], cell);
      const auto s = charted.Charts[c].Measures.SingularValues.row(static_cast<Eigen::Index>(t));
      number->InsertNextValue(static_cast<int>(c));
      values->InsertNextTuple2(s[0], s[1]);
      flipped->InsertNextValue(s[1] > 0.0 ? 0 : 1);
    }
  }
  CopyPointData(from, charted.Origins, input->GetPointData(), output->GetPointData());
  SetPoints(from, flat, input->GetPoints()->GetDataType(), output);
  output->GetPointData()->SetActiveTCoords("UV");
  output->SetPolys(cells);
  data->AddArray(number);
  data->AddArray(values);
  data->AddArray(flipped);
}

void EncodeLoops(const ChartedMesh& charted, bool flat, vtkPolyData* output)
{
  std::vector<ChartPoint> from;
  vtkNew<vtkCellArray> lines;
  vtkNew<vtkIntArray> chart;
  chart->SetName("Chart");
  vtkNew<vtkIntArray> number;
  number->SetName("Loop");
  vtkNew<vtkDoubleArray> length;
  length->SetName("Length");
  for (std::size_t c = 0; c < charted.Charts.size(); ++c)
  {
    const DiscMesh& mesh = charted.Charts[c].Mesh;
    for (std::size_t l = 0; l < mesh.Loops.size(); ++l)
    {
      const std::vector<int>& loop = mesh.Loops[l];
      const auto first = static_cast<vtkIdType>(from.size());
      const auto n = static_cast<vtkIdType>(loop.size());
      lines->InsertNextCell(static_cast<int>(n) + 1);
      for (vtkIdType i = 0; i <= n; ++i)
      {
        lines->InsertCellPoint(first + i % n);
      }
      double sum = 0.0;
      for (std::size_t i = 0; i < loop.size(); ++i)
      {
        from.push_back({ &charted.Charts[c], loop[i] });
        sum += (mesh.Point(loop[(i + 1) % loop.size()]) - mesh.Point(loop[i])).norm();
      }
      chart->InsertNextValue(static_cast<int>(c));
      number->InsertNextValue(static_cast<int>(l));
      length->InsertNextValue(sum);
    }
  }
  SetPoints(from, flat, VTK_DOUBLE, output);
  output->SetLines(lines);
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("PointIds");
  for (const ChartPoint& point : from)
  {
    const PointOrigin& origin = charted.Origins[static_cast<std::size_t>(point.CutPoint())];
    ids->InsertNextValue(IsInputPoint(origin) ? origin.Points[0] : -1);
  }
  output->GetPointData()->AddArray(ids);
  output->GetCellData()->AddArray(chart);
  output->GetCellData()->AddArray(number);
  output->GetCellData()->AddArray(length);
}

std::string DescribeFallbacks(const ChartedMesh& charted)
{
  std::set<std::string> methods;
  std::string reason; // of the first chart that has one
  int count = 0;
  for (const MeshParameterization& chart : charted.Charts)
  {
    if (!chart.FallbackReason.empty())
    {
      methods.insert(ToString(chart.Used));
      reason = count++ == 0 ? chart.FallbackReason : reason;
    }
  }
  if (count == 0 || charted.Charts.size() == 1)
  {
    return reason;
  }
  return std::to_string(count) + " of " + std::to_string(charted.Charts.size()) +
    " charts, the first one: " + reason;
}

std::string DescribeMethods(const ChartedMesh& charted)
{
  std::string methods;
  std::set<FlattenMethod> used;
  for (const MeshParameterization& chart : charted.Charts)
  {
    if (used.insert(chart.Used).second)
    {
      methods += (methods.empty() ? "" : ", ") + std::string(ToString(chart.Used));
    }
  }
  return methods;
}

void EncodeSummary(
  const DecodedMesh& decoded, const ChartedMesh& charted, FlattenMethod asked, vtkTable* output)
{
  const FlattenMeasures measures = TotalMeasures(charted);
  const std::string reason = DescribeFallbacks(charted);
  int loops = 0;
  int points = 0;
  int rejected = 0;
  for (const MeshParameterization& chart : charted.Charts)
  {
    loops += static_cast<int>(chart.Mesh.Loops.size());
    points += chart.Mesh.NumPoints();
    rejected += chart.RejectedEigenvectors;
  }
  AddColumn(output, "RequestedMethod", std::string(ToString(asked)));
  AddColumn(output, "Method", DescribeMethods(charted));
  AddColumn(output, "Fallback", reason.empty() ? 0 : 1);
  AddColumn(output, "FallbackReason", reason);
  AddColumn(output, "Charts", static_cast<int>(charted.Charts.size()));
  AddColumn(output, "Points", points);
  AddColumn(output, "Triangles", static_cast<int>(charted.Triangles.size()));
  AddColumn(output, "Loops", loops);
  AddColumn(output, "Components", charted.Components);
  AddColumn(output, "TurnedTriangles", charted.Reversed);
  const bool injective = std::all_of(charted.Charts.begin(), charted.Charts.end(),
    [](const MeshParameterization& chart) { return static_cast<bool>(chart.Injective); });
  AddColumn(output, "Injective", injective ? 1 : 0);
  AddColumn(output, "FlippedTriangles", measures.FlippedTriangles);
  AddColumn(output, "MeanStretch", measures.MeanStretch);
  AddColumn(output, "MaxStretch", measures.MaxStretch);
  AddColumn(output, "MinSingularValue", measures.MinSingularValue);
  AddColumn(output, "MaxSingularValue", measures.MaxSingularValue);
  AddColumn(output, "MeanAreaDistortion", measures.MeanAreaDistortion);
  AddColumn(output, "MaxAreaDistortion", measures.MaxAreaDistortion);
  AddColumn(output, "IsometryError", measures.IsometryError);
  AddColumn(output, "DistanceError", measures.DistanceError);
  AddColumn(output, "RejectedEigenvectors", rejected);
  AddColumn(output, "DividedFaces", decoded.Divided);
}
}
