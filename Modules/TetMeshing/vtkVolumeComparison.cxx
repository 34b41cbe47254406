// SPDX-License-Identifier: BSD-3-Clause
#include "vtkVolumeComparison.h"

#include "BoundaryData.h"
#include <knotwork/CADFitting/ElementData.h>
#include <knotwork/CADFitting/FitTargetData.h>
#include <knotwork/JacobianValidation/CellMaps.h>
#include <knotwork/JacobianValidation/CellsFromGrid.h>
#include <knotwork/MeshParameterization/MeshData.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SplineGrid/TableRow.h>
#include <knotwork/TetMeshing/VolumeComparison.h>

#include "vtkCellArray.h"
#include "vtkCellType.h"
#include "vtkIdList.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>
#include <set>

using namespace knotwork;

vtkStandardNewMacro(vtkVolumeComparison);

namespace
{
using DecodeSpline = std::function<Result<SplineModel>(vtkDataObject*)>;

/// What both are measured against.
struct Reference
{
  FitTargetPtr Target;
  BoundaryMesh Surface;
  double Volume = 0.0;
  double VolumeBound = 0.0; ///< of the error of Volume, where it is one of triangles
  double Diagonal = 0.0;
};

/// A grid of cells that fill a solid.
struct Candidate
{
  BernsteinCells Cells;
  BoundaryMesh Boundary;
  int Functions = 0; ///< that one component of a solution has
  double Memory = 0.0;
  ComparedVolume Compared;
};

bool IsSplineVolume(vtkUnstructuredGrid* grid)
{
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    if (grid->GetCellType(cell) != VTK_BEZIER_HEXAHEDRON)
    {
      return false;
    }
  }
  return grid->GetNumberOfCells() > 0;
}

double DiagonalOf(const PointMatrix& points)
{
  return (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
}

Result<BoundaryMesh> SurfaceOf(
  vtkDataObject* data, const DecodeSpline& decode, const BoundaryOptions& options)
{
  if (HasSplineCells(data))
  {
    const auto model = decode(data);
    return model ? TriangulateBoundary(data, model.Value, options)
                 : Result<BoundaryMesh>(model.Status);
  }
  auto* const points = vtkPointSet::SafeDownCast(data);
  auto mesh = points ? DecodeMesh(points) : Result<DecodedMesh>(Status());
  if (!mesh)
  {
    return mesh.Status;
  }
  BoundaryMesh surface;
  surface.Mesh = std::move(mesh->Mesh);
  surface.Patches.assign(surface.Mesh.Triangles.size(), 0);
  surface.Faces = surface.Patches;
  const Status status = FinishBoundary(surface);
  return status ? Result<BoundaryMesh>(std::move(surface)) : Result<BoundaryMesh>(status);
}

Result<Reference> DecodeReference(
  vtkDataObject* data, const DecodeSpline& decode, const BoundaryOptions& options)
{
  auto surface = SurfaceOf(data, decode, options);
  if (!surface)
  {
    return surface.Status;
  }
  if (!surface->Closed)
  {
    return { ErrorCode::InvalidTopology,
      "the reference bounds no solid, for it has open edges: repair it" };
  }
  auto target = DecodeFitTarget(data, {}, options.Threads);
  if (!target)
  {
    return target.Status;
  }
  Reference reference;
  reference.Target = std::move(target.Value);
  reference.Surface = std::move(surface.Value);
  reference.Volume = reference.Surface.Volume;
  reference.VolumeBound = reference.Surface.Area * reference.Surface.Bound;
  reference.Diagonal = DiagonalOf(reference.Surface.Mesh.Points);
  auto* const grid = vtkUnstructuredGrid::SafeDownCast(data);
  if (grid && IsSplineVolume(grid)) // exact, but for rounding
  {
    const auto cells = ReadGridCells({ grid });
    CellMeasuresParams params;
    params.BoundBoxes = 0;
    params.Threads = options.Threads;
    const auto measures =
      cells ? MeasureCells(cells->Cells, params) : Result<CellMeasures>(cells.Status);
    if (!measures)
    {
      return measures.Status;
    }
    reference.Volume = std::abs(measures->Total.Measure);
    reference.VolumeBound = measures->Total.MeasureError;
  }
  return reference;
}

/// The cells and the boundary of a mesh.
Status DecodeMeshCells(vtkUnstructuredGrid* grid, double tolerance, Candidate& candidate)
{
  const auto elements = DecodeStraightElements(grid);
  if (!elements)
  {
    return elements.Status;
  }
  auto cells = ReadGridCells({ grid });
  if (!cells)
  {
    return cells.Status;
  }
  std::vector<int> which;
  std::set<vtkIdType> points;
  vtkNew<vtkIdList> ids;
  for (const vtkIdType cell : elements->Cells)
  {
    which.push_back(static_cast<int>(cell));
    grid->GetCellPoints(cell, ids);
    points.insert(ids->begin(), ids->end());
  }
  candidate.Cells = SelectCells(cells->Cells, which, 3);
  candidate.Functions = static_cast<int>(points.size());
  auto boundary = TriangulateFacets(candidate.Cells, elements->Elements.Corners, tolerance);
  if (boundary)
  {
    candidate.Boundary = std::move(boundary.Value);
  }
  return boundary.Status;
}

Result<Candidate> DecodeCandidate(
  vtkUnstructuredGrid* grid, const DecodeSpline& decode, const BoundaryOptions& options)
{
  Candidate candidate;
  candidate.Memory = static_cast<double>(grid->GetActualMemorySize()) * 1024.0;
  if (!IsSplineVolume(grid))
  {
    const Status status = DecodeMeshCells(grid, options.Tolerance, candidate);
    return status ? Result<Candidate>(std::move(candidate)) : Result<Candidate>(status);
  }
  const auto model = decode(grid);
  if (!model)
  {
    return model.Status;
  }
  for (const SplinePatch& patch : model->Patches)
  {
    candidate.Functions +=
      static_cast<int>(std::get<Spline<3>>(patch.Geometry).ControlPoints.rows());
  }
  auto cells = ReadGridCells({ grid });
  if (!cells)
  {
    return cells.Status;
  }
  candidate.Cells = std::move(cells->Cells);
  auto boundary = TriangulateBoundary(grid, model.Value, options);
  if (!boundary)
  {
    return boundary.Status;
  }
  candidate.Boundary = std::move(boundary.Value);
  return candidate;
}

void EncodeBoundary(const Candidate& candidate, vtkPolyData* output)
{
  const TriangleMesh& mesh = candidate.Boundary.Mesh;
  const TargetDistances& distances = candidate.Compared.Deviation.OfScan;
  const vtkIdType count = mesh.Points.rows();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(count);
  const auto distance = NamedArray<vtkDoubleArray>("Distance", 1, count);
  const auto foot = NamedArray<vtkDoubleArray>("ReferencePoint", 3, count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    points->SetPoint(i, mesh.Points.row(i).data());
    distance->SetValue(i, distances.Distances[i]);
    foot->SetTuple(i, distances.Feet.Points.row(i).data());
  }
  vtkNew<vtkCellArray> cells;
  for (const auto& triangle : mesh.Triangles)
  {
    cells->InsertNextCell({ triangle[0], triangle[1], triangle[2] });
  }
  output->SetPoints(points);
  output->SetPolys(cells);
  output->GetPointData()->AddArray(foot);
  output->GetPointData()->AddArray(distance);
  output->GetPointData()->SetActiveScalars("Distance");
}

void EncodeHistogram(const std::vector<Candidate>& candidates, int bins, vtkTable* table)
{
  const auto add = [table](const std::string& name, auto begin, auto end)
  {
    const auto column = NamedArray<vtkDoubleArray>(name.c_str());
    for (auto value = begin; value != end; ++value)
    {
      column->InsertNextValue(*value);
    }
    table->AddColumn(column);
  };
  const char* const names[] = { "First", "Second" };
  for (std::size_t i = 0; i < candidates.size(); ++i)
  {
    const QualityHistogram histogram = MakeHistogram(candidates[i].Compared.Measures, bins);
    if (i == 0)
    {
      add("From", histogram.Edges.begin(), histogram.Edges.end() - 1);
      add("To", histogram.Edges.begin() + 1, histogram.Edges.end());
    }
    const std::string name = names[i];
    add(name + "Guaranteed", histogram.Guaranteed.begin(), histogram.Guaranteed.end());
    add(name + "Attained", histogram.Attained.begin(), histogram.Attained.end());
  }
}

double LeastOf(const CellMeasures& measures, double CellMeasure::*value)
{
  double least = 1.0;
  for (const CellMeasure& cell : measures.Cells)
  {
    least = std::min(least, cell.*value);
  }
  return least;
}

void EncodeNumbers(
  const std::vector<Candidate>& candidates, const Reference& reference, vtkTable* table)
{
  const auto number = [&](const char* name, const auto& value)
  { table->AddColumn(ArrayOf<vtkDoubleArray>(name, candidates, value)); };
  const auto count = [&](const char* name, const auto& value)
  { table->AddColumn(ArrayOf<vtkIntArray>(name, candidates, value)); };
  using C = Candidate;
  const auto volume = [](const C& c) { return std::abs(c.Compared.Measures.Total.Measure); };
  count("Elements", [](const C& c) { return c.Cells.NumCells(); });
  count("Functions", [](const C& c) { return c.Functions; });
  count("ValidElements", [](const C& c) { return c.Compared.Certificate.NumValid; });
  count("ReversedElements", [](const C& c) { return c.Compared.Certificate.NumReversed; });
  count("InvalidElements", [](const C& c) { return c.Compared.Certificate.NumInvalid; });
  count("UndecidedElements", [](const C& c) { return c.Compared.Certificate.NumUndecided; });
  number("MinJacobianLower", [](const C& c) { return c.Compared.Certificate.MinLower; });
  number("ScaledJacobianLower",
    [](const C& c) { return LeastOf(c.Compared.Measures, &CellMeasure::ScaledLower); });
  number("ScaledJacobianUpper",
    [](const C& c) { return LeastOf(c.Compared.Measures, &CellMeasure::ScaledMin); });
  number("ScaledJacobianMean", [](const C& c) { return c.Compared.Measures.Total.ScaledMean; });
  number("Volume", volume);
  number("ReferenceVolume", [&](const C&) { return reference.Volume; });
  number("ReferenceVolumeBound", [&](const C&) { return reference.VolumeBound; });
  number("VolumeError",
    [&](const C& c) { return std::abs(volume(c) - reference.Volume) / reference.Volume; });
  number("ToReference", [](const C& c) { return c.Compared.ToReference; });
  number("FromReference", [](const C& c) { return c.Compared.FromReference; });
  number("LargestDistance",
    [](const C& c) { return std::max(c.Compared.ToReference, c.Compared.FromReference); });
  number("RmsToReference", [](const C& c) { return c.Compared.Deviation.ScanProfile.Rms; });
  number("RmsFromReference", [](const C& c) { return c.Compared.Deviation.ModelProfile.Rms; });
  number("ChordalBound", [](const C& c) { return c.Boundary.Bound; });
  number("Diagonal", [&](const C&) { return reference.Diagonal; });
  count(
    "BoundaryPoints", [](const C& c) { return static_cast<int>(c.Boundary.Mesh.Points.rows()); });
  number("Memory", [](const C& c) { return c.Memory; });
}
}

vtkVolumeComparison::vtkVolumeComparison()
{
  this->SetInputTypes(
    { { { "vtkUnstructuredGrid" } }, { { "vtkUnstructuredGrid" } }, Optional(Shapes()) });
  this->SetOutputTypes({ "vtkPolyData", "vtkPolyData", "vtkTable", "vtkTable" });
}

void vtkVolumeComparison::SetMeshConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkVolumeComparison::SetMeshData(vtkDataObject* mesh)
{
  this->SetInputDataObject(1, mesh);
}

void vtkVolumeComparison::SetReferenceConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(2, output);
}

void vtkVolumeComparison::SetReferenceData(vtkDataObject* reference)
{
  this->SetInputDataObject(2, reference);
}

double vtkVolumeComparison::GetSeconds(int input, int step)
{
  const bool known = input >= 0 && input < 2 && step >= 0 && step < 3;
  return known ? this->Seconds[static_cast<std::size_t>(input)][static_cast<std::size_t>(step)]
               : 0.0;
}

Status vtkVolumeComparison::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkUnstructuredGrid* const grids[] = { vtkUnstructuredGrid::GetData(inputs[0], 0),
    vtkUnstructuredGrid::GetData(inputs[1], 0) };
  this->Seconds = {};
  if (grids[0]->GetNumberOfCells() == 0 || grids[1]->GetNumberOfCells() == 0)
  {
    return {};
  }
  vtkDataObject* shape = vtkDataObject::GetData(inputs[2], 0);
  const DecodeSpline decode = [this](vtkDataObject* data) { return this->DecodeInput(data); };
  BoundaryOptions options{ this->ChordalTolerance, true, this->KernelThreads(), {} };
  options.Progress = [progress = this->Progress()](double share) { return progress(0.1 * share); };
  const auto reference = DecodeReference(shape ? shape : grids[0], decode, options);
  if (!reference)
  {
    return reference.Status;
  }
  options.Relative = false;
  options.Tolerance = this->ChordalTolerance * reference->Diagonal;
  std::vector<Candidate> candidates;
  for (int i = 0; i < 2; ++i)
  {
    const double begin = 0.1 + 0.45 * i;
    options.Progress = [begin, progress = this->Progress()](double share)
    { return progress(begin + 0.05 * share); };
    auto candidate = DecodeCandidate(grids[i], decode, options);
    VolumeComparisonParams params;
    params.Samples = this->Samples;
    params.BoundBoxes = this->BoundBoxes;
    params.Threads = this->KernelThreads();
    params.Progress = [begin, progress = this->Progress()](double share)
    { return progress(begin + 0.05 + 0.4 * share); };
    auto compared = candidate ? CompareVolume(candidate->Cells, candidate->Boundary,
                                  *reference->Target, reference->Surface.Mesh, params)
                              : Result<ComparedVolume>(candidate.Status);
    if (!compared)
    {
      return { compared.Status.Code,
        std::string(i == 0 ? "first" : "second") + " input: " + compared.Status.Detail };
    }
    candidate->Compared = std::move(compared.Value);
    this->Seconds[static_cast<std::size_t>(i)] = { candidate->Compared.CertificateSeconds,
      candidate->Compared.MeasureSeconds, candidate->Compared.DistanceSeconds };
    EncodeBoundary(candidate.Value, vtkPolyData::GetData(outputs, i));
    candidates.push_back(std::move(candidate.Value));
  }
  EncodeHistogram(candidates, this->Bins, vtkTable::GetData(outputs, 2));
  EncodeNumbers(candidates, reference.Value, vtkTable::GetData(outputs, 3));
  return {};
}
