// SPDX-License-Identifier: BSD-3-Clause
#include "TrimData.h"

#include <knotwork/MeshParameterization/MeshData.h>
#include <knotwork/SplineGrid/TableRow.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <map>
#include <optional>

namespace knotwork
{
namespace
{
/// Up to five ids of a longer list.
std::string FirstOf(const std::vector<vtkIdType>& ids)
{
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(5, ids.size()); ++i)
  {
    text += (i > 0 ? ", " : "") + std::to_string(ids[i]);
  }
  return text + (ids.size() > 5 ? ", ..." : "");
}

Status ReadPlane(vtkPointSet* data, PointMatrix& uv)
{
  vtkDataArray* array = data->GetPointData()->GetArray("UV");
  if (!array || array->GetNumberOfComponents() != 2)
  {
    return { ErrorCode::SizeMismatch,
      "the point array 'UV' with two components is missing; vtkMeshParameterization makes it" };
  }
  uv.resize(array->GetNumberOfTuples(), 2);
  std::vector<vtkIdType> bad;
  for (Eigen::Index i = 0; i < uv.rows(); ++i)
  {
    array->GetTuple(i, uv.row(i).data());
    if (!uv.row(i).allFinite())
    {
      bad.push_back(i);
    }
  }
  if (!bad.empty())
  {
    return { ErrorCode::NonFiniteInput,
      "UV of " + std::to_string(bad.size()) + " points (" + FirstOf(bad) + ")" };
  }
  return {};
}

/// Ids that are equal for points of several charts that are one point of the surface.
Status ReadPointIds(vtkPointSet* data, std::vector<std::int64_t>& ids)
{
  ids.resize(static_cast<std::size_t>(data->GetNumberOfPoints()));
  vtkDataArray* array = data->GetPointData()->GetArray("CutPointId");
  if (array && array->GetNumberOfComponents() != 1)
  {
    return { ErrorCode::SizeMismatch, "the point array 'CutPointId' is not one number a point" };
  }
  std::int64_t next = 0;
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    next = std::max(next, static_cast<std::int64_t>(array->GetComponent(i, 0)) + 1);
  }
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    const double cut = array ? array->GetComponent(static_cast<vtkIdType>(i), 0) : -1.0;
    ids[i] = cut >= 0.0 ? static_cast<std::int64_t>(cut) : next + static_cast<std::int64_t>(i);
  }
  return {};
}

double SignedArea(const PointMatrix& uv, const std::array<int, 3>& t)
{
  const Eigen::RowVector2d a = uv.row(t[1]) - uv.row(t[0]);
  const Eigen::RowVector2d b = uv.row(t[2]) - uv.row(t[0]);
  return 0.5 * (a[0] * b[1] - a[1] * b[0]);
}

/// Charts that are seen from below in the plane are turned; single flipped triangles are refused.
Status OrientChart(std::size_t chart, DecodedCharts& decoded)
{
  ChartMesh& mesh = decoded.Charts[chart];
  std::vector<vtkIdType> flipped;
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    if (!(SignedArea(mesh.UV, mesh.Triangles[t]) > 0.0))
    {
      flipped.push_back(decoded.Cells[chart][t]);
    }
  }
  const auto negative = [&](const std::array<int, 3>& t) { return SignedArea(mesh.UV, t) < 0.0; };
  decoded.Turned[chart] =
    std::all_of(mesh.Triangles.begin(), mesh.Triangles.end(), negative) ? 1 : 0;
  if (decoded.Turned[chart] != 0)
  {
    for (auto& triangle : mesh.Triangles)
    {
      std::swap(triangle[1], triangle[2]);
    }
  }
  else if (!flipped.empty())
  {
    return { ErrorCode::InvalidTopology,
      std::to_string(flipped.size()) + " triangles are flipped in the plane (" + FirstOf(flipped) +
        "); flatten the mesh with a method that flips none" };
  }
  return {};
}

std::string Joined(const std::string& text, const std::string& more)
{
  return text + (text.empty() ? "" : ", ") + more;
}
}

Result<DecodedCharts> DecodeCharts(vtkPointSet* data)
{
  auto read = DecodeMesh(data);
  if (!read)
  {
    return read.Status;
  }
  const TriangleMesh& mesh = read->Mesh;
  if (mesh.Triangles.empty())
  {
    return { ErrorCode::EmptyInput, "a mesh without triangles" };
  }
  PointMatrix uv;
  std::vector<std::int64_t> ids;
  Status status = ReadPlane(data, uv);
  status = status ? ReadPointIds(data, ids) : status;
  vtkDataArray* numbers = data->GetCellData()->GetArray("ChartId");
  if (status && numbers && numbers->GetNumberOfComponents() != 1)
  {
    status = { ErrorCode::SizeMismatch, "the cell array 'ChartId' is not one number a cell" };
  }
  if (!status)
  {
    return status;
  }
  std::map<double, std::vector<std::size_t>> charts;
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    charts[numbers ? numbers->GetComponent(read->Cells[t], 0) : 0.0].push_back(t);
  }
  Result<DecodedCharts> result;
  DecodedCharts& decoded = result.Value;
  decoded.Charts.resize(charts.size());
  decoded.Points.resize(charts.size());
  decoded.Cells.resize(charts.size());
  decoded.Turned.resize(charts.size(), 0);
  std::size_t c = 0;
  for (const auto& [number, triangles] : charts)
  {
    ChartMesh& chart = decoded.Charts[c];
    std::vector<vtkIdType>& points = decoded.Points[c];
    for (std::size_t t : triangles)
    {
      points.insert(points.end(), mesh.Triangles[t].begin(), mesh.Triangles[t].end());
    }
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    for (std::size_t t : triangles)
    {
      std::array<int, 3> corners{};
      for (std::size_t k = 0; k < 3; ++k)
      {
        const auto at = std::lower_bound(points.begin(), points.end(), mesh.Triangles[t][k]);
        corners[k] = static_cast<int>(at - points.begin());
      }
      chart.Triangles.push_back(corners);
      decoded.Cells[c].push_back(read->Cells[t]);
    }
    const auto n = static_cast<Eigen::Index>(points.size());
    chart.Points.resize(n, 3);
    chart.UV.resize(n, 2);
    for (Eigen::Index i = 0; i < n; ++i)
    {
      const vtkIdType point = points[static_cast<std::size_t>(i)];
      chart.Points.row(i) = mesh.Points.row(point);
      chart.UV.row(i) = uv.row(point);
      chart.PointIds.push_back(ids[static_cast<std::size_t>(point)]);
    }
    if (status = OrientChart(c, decoded); !status)
    {
      return status;
    }
    ++c;
  }
  return result;
}

void TurnFaces(const std::vector<char>& turned, TrimmedSurface& trimmed)
{
  for (std::size_t f = 0; f < turned.size(); ++f)
  {
    trimmed.Model.Faces[f].Reversed = turned[f] != 0;
  }
  TrimmedMesh& mesh = trimmed.Mesh;
  std::vector<char> turnedPoint(static_cast<std::size_t>(mesh.Points.rows()), 0);
  for (std::size_t t = mesh.Triangles.size(); t-- > 0;) // the first face gives an edge its normal
  {
    auto& corners = mesh.Triangles[t];
    const char turn = turned[static_cast<std::size_t>(mesh.TriangleFace[t])];
    for (int corner : corners)
    {
      turnedPoint[static_cast<std::size_t>(corner)] = turn;
    }
    if (turn != 0)
    {
      std::swap(corners[1], corners[2]);
      std::swap(mesh.TriangleUV[t][1], mesh.TriangleUV[t][2]);
    }
  }
  for (std::size_t i = 0; i < turnedPoint.size(); ++i)
  {
    if (turnedPoint[i] != 0)
    {
      mesh.Normals.row(static_cast<Eigen::Index>(i)) *= -1.0;
    }
  }
}

void EncodeTriangles(const TrimmedMesh& mesh, vtkPolyData* output)
{
  const auto numPoints = static_cast<std::size_t>(mesh.Points.rows());
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(mesh.Points.rows());
  vtkNew<vtkDoubleArray> normals;
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  normals->SetNumberOfTuples(mesh.Points.rows());
  for (Eigen::Index i = 0; i < mesh.Points.rows(); ++i)
  {
    points->SetPoint(i, mesh.Points.row(i).data());
    normals->SetTuple(i, mesh.Normals.row(i).data());
  }
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkIntArray> faces;
  faces->SetName("FaceId");
  vtkNew<vtkDoubleArray> corners;
  corners->SetName("CornerUV");
  corners->SetNumberOfComponents(6);
  std::vector<std::optional<std::array<double, 2>>> ofPoint(numPoints);
  bool single = true;
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    const auto& triangle = mesh.Triangles[t];
    const vtkIdType ids[3] = { triangle[0], triangle[1], triangle[2] };
    cells->InsertNextCell(3, ids);
    faces->InsertNextValue(mesh.TriangleFace[t]);
    corners->InsertNextTuple(mesh.TriangleUV[t].front().data());
    for (std::size_t k = 0; k < 3; ++k)
    {
      auto& uv = ofPoint[static_cast<std::size_t>(triangle[k])];
      single = single && (!uv || *uv == mesh.TriangleUV[t][k]);
      uv = mesh.TriangleUV[t][k];
    }
  }
  output->SetPoints(points);
  output->SetPolys(cells);
  output->GetPointData()->SetNormals(normals);
  output->GetCellData()->AddArray(faces);
  if (!single)
  {
    output->GetCellData()->AddArray(corners);
    return;
  }
  vtkNew<vtkDoubleArray> uv;
  uv->SetName("UV");
  uv->SetNumberOfComponents(2);
  for (const auto& pair : ofPoint)
  {
    const auto value = pair.value_or(std::array<double, 2>{});
    uv->InsertNextTuple2(value[0], value[1]);
  }
  output->GetPointData()->AddArray(uv);
  output->GetPointData()->SetActiveTCoords("UV");
}

void EncodeDeviation(
  const DecodedCharts& decoded, const TrimmedSurface& trimmed, vtkPointSet* output)
{
  vtkNew<vtkDoubleArray> deviation;
  deviation->SetName("Deviation");
  deviation->SetNumberOfTuples(output->GetNumberOfPoints());
  deviation->Fill(0.0);
  vtkNew<vtkDoubleArray> bound;
  bound->SetName("DeviationBound");
  bound->SetNumberOfTuples(output->GetNumberOfCells());
  bound->Fill(0.0);
  for (std::size_t c = 0; c < decoded.Charts.size(); ++c)
  {
    const ChartDeviation& chart = trimmed.Deviations[c];
    for (std::size_t i = 0; i < decoded.Points[c].size(); ++i)
    {
      const vtkIdType point = decoded.Points[c][i];
      deviation->SetValue(point,
        std::max(deviation->GetValue(point), chart.PointDeviation[static_cast<Eigen::Index>(i)]));
    }
    for (std::size_t t = 0; t < decoded.Cells[c].size(); ++t)
    {
      const vtkIdType cell = decoded.Cells[c][t]; // of several triangles when it was divided
      bound->SetValue(
        cell, std::max(bound->GetValue(cell), chart.TriangleBound[static_cast<Eigen::Index>(t)]));
    }
  }
  output->GetPointData()->AddArray(deviation);
  output->GetCellData()->AddArray(bound);
}

Verdict WorstVerdict(const std::vector<FaceCertificate>& certificates)
{
  Verdict worst = Verdict::Valid;
  for (const FaceCertificate& certificate : certificates)
  {
    const bool worse = certificate.Verdict == Verdict::Invalid ||
      (certificate.Verdict == Verdict::Undecided && worst == Verdict::Valid);
    worst = worse ? certificate.Verdict : worst;
  }
  return worst;
}

LoopVerdict WorstLoops(const std::vector<LoopVerdict>& verdicts)
{
  return verdicts.empty() ? LoopVerdict::Undecided
                          : *std::min_element(verdicts.begin(), verdicts.end());
}

std::vector<std::string> ShortcomingsOfFaces(Verdict regular, LoopVerdict loops)
{
  std::vector<std::string> texts;
  if (regular != Verdict::Valid)
  {
    texts.push_back(std::string("regularity of the faces: ") + ToString(regular));
  }
  if (loops != LoopVerdict::SimpleNested)
  {
    texts.push_back(std::string("trimming loops: ") + ToString(loops));
  }
  return texts;
}

void EncodeSnapped(const SnappedValues& snapped, vtkTable* output)
{
  AddColumn(output, "SnappedSurfaces", snapped.NumSurfaces);
  AddColumn(output, "CommonDirections", snapped.NumDirections);
  AddColumn(output, "CommonPositions", snapped.NumPositions);
  AddColumn(output, "CommonSizes", snapped.NumSizes);
  AddColumn(output, "MaxTurn", snapped.MaxTurn);
}

void EncodeNumbers(const TrimmedSurface& trimmed, vtkTable* output)
{
  double area = 0.0;
  double meshArea = 0.0;
  double found = 0.0;
  for (const ChartDeviation& deviation : trimmed.Deviations)
  {
    area += deviation.Area;
    meshArea += deviation.MeshArea;
    found = std::max(found, deviation.MaxFound);
  }
  int controlPoints = 0;
  int centres = 0;
  int passes = 0;
  std::string nets;
  for (std::size_t f = 0; f < trimmed.Model.Faces.size(); ++f)
  {
    const SplineSpace<2>& space = *trimmed.Model.Faces[f].Surface.Space;
    controlPoints += space.NumFunctions;
    centres += trimmed.BackMaps[f].Centres;
    passes += trimmed.BackMaps[f].Passes;
    nets = Joined(nets,
      std::to_string(space.Knots[0].NumFunctions()) + " x " +
        std::to_string(space.Knots[1].NumFunctions()));
  }
  AddColumn(output, "Tolerance", trimmed.Tolerance);
  AddColumn(output, "WithinTolerance", trimmed.WithinTolerance ? 1 : 0);
  AddColumn(output, "MaxDeviation", trimmed.MaxDeviation);
  AddColumn(output, "MaxDeviationFound", found);
  AddColumn(output, "RmsDeviation", trimmed.RmsDeviation);
  AddColumn(output, "MaxBoundaryDistance", trimmed.Loops.MaxBoundaryDistance);
  AddColumn(output, "MaxEdgeGap", trimmed.Loops.MaxEdgeGap);
  AddColumn(output, "Faces", static_cast<int>(trimmed.Model.Faces.size()));
  AddColumn(output, "Loops", trimmed.Loops.NumBoundaryLoops);
  AddColumn(output, "Edges", trimmed.Model.NumEdges);
  AddColumn(output, "Vertices", trimmed.Model.NumVertices);
  AddColumn(output, "LoopVerdict", std::string(ToString(WorstLoops(trimmed.Loops.Verdicts))));
  AddColumn(
    output, "LoopsProved", WorstLoops(trimmed.Loops.Verdicts) == LoopVerdict::SimpleNested ? 1 : 0);
  AddColumn(output, "Verdict", std::string(ToString(WorstVerdict(trimmed.Certificates))));
  AddColumn(output, "MinNormalBound", trimmed.MinNormal);
  AddColumn(output, "Area", area);
  AddColumn(output, "MeshArea", meshArea);
  AddColumn(output, "Nets", nets);
  AddColumn(output, "ControlPoints", controlPoints);
  AddColumn(output, "Centres", centres);
  AddColumn(output, "Passes", passes);
  AddColumn(output, "Stopped", std::string(ToString(trimmed.Stop)));
  AddColumn(output, "Work", trimmed.Work);
  AddColumn(output, "Triangles", static_cast<int>(trimmed.Mesh.Triangles.size()));
  AddColumn(output, "TriangleBound", trimmed.Mesh.Bound);
}
}
