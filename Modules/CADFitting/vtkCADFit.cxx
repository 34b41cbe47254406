// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCADFit.h"

#include "FitTargetData.h"
#include <knotwork/CADFitting/CADFit.h>
#include <knotwork/SplineCore/MeshGeometry.h>
#include <knotwork/SplineCore/MeshPatches.h>
#include <knotwork/SplineGrid/CellMeshData.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SplineGrid/TableRow.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkImplicitFunction.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

using namespace knotwork;

static_assert(vtkCADFit::MINIMAL == static_cast<int>(CreasePolicy::Minimal) &&
    vtkCADFit::MOTORCYCLE == static_cast<int>(CreasePolicy::Motorcycle) &&
    vtkCADFit::FULL == static_cast<int>(CreasePolicy::Full),
  "the policies are those of the kernel");
static_assert(vtkCADFit::CERTIFICATE == static_cast<int>(FitSmoothing::Certificate) &&
    vtkCADFit::NET == static_cast<int>(FitSmoothing::Net),
  "the methods are those of the kernel");

static_assert(vtkCADFit::AFFINE == static_cast<int>(FitPath::Affine) &&
    vtkCADFit::COMPOSITE == static_cast<int>(FitPath::Composite),
  "the paths are those of the kernel");
static_assert(vtkCADFit::PLAIN == static_cast<int>(RestrictionKind::Plain),
  "the weights are those of the kernel");

vtkStandardNewMacro(vtkCADFit);
vtkCxxSetObjectMacro(vtkCADFit, ImplicitFunction, vtkImplicitFunction);

namespace
{
constexpr const char* EntityNames[] = { "surface", "face", "curve", "corner" };

/// What the filter gives its outputs to.
struct Outputs
{
  vtkUnstructuredGrid* Spline;
  vtkTable* Numbers;
  vtkTable* Entities;
  vtkPolyData* TargetPoints;
  vtkPolyData* Unmatched;
};

struct Choices
{
  CADFitParams Fit;
  double FeatureAngle = 180.0;
  std::string FeatureArray;
  std::string FitArray;
};

template <int Dim>
void AddCellArrays(const CADFit<Dim>& fit, vtkUnstructuredGrid* grid)
{
  const vtkIdType count = grid->GetNumberOfCells();
  const auto distance = NamedArray<vtkDoubleArray>("Distance");
  const auto verdict = NamedArray<vtkIntArray>("Verdict");
  const auto lower = NamedArray<vtkDoubleArray>("MinJacobianLower");
  distance->SetNumberOfValues(count);
  distance->FillValue(0.0);
  verdict->SetNumberOfValues(count);
  lower->SetNumberOfValues(count);
  for (std::size_t i = 0; i < fit.Distances.OfElements.size(); ++i)
  {
    const int cell = fit.SurfaceElements[i].Cell;
    distance->SetValue(cell, std::max(distance->GetValue(cell), fit.Distances.OfElements[i]));
  }
  if (!fit.Bound.OfElements.empty())
  {
    const auto bound = NamedArray<vtkDoubleArray>("DistanceBound");
    bound->SetNumberOfValues(count);
    bound->FillValue(0.0);
    for (std::size_t i = 0; i < fit.Bound.OfElements.size(); ++i)
    {
      const int cell = fit.SurfaceElements[i].Cell;
      bound->SetValue(cell, std::max(bound->GetValue(cell), fit.Bound.OfElements[i]));
    }
    grid->GetCellData()->AddArray(bound);
  }
  for (vtkIdType c = 0; c < count; ++c)
  {
    const CellCertificate& certificate = fit.Certificate.Cells[static_cast<std::size_t>(c)];
    verdict->SetValue(c, static_cast<int>(certificate.Verdict));
    lower->SetValue(c, certificate.MinLower);
  }
  grid->GetCellData()->AddArray(distance);
  grid->GetCellData()->AddArray(verdict);
  grid->GetCellData()->AddArray(lower);
  grid->GetCellData()->SetActiveScalars("Distance"); // drawn first
}

template <int Dim>
void EncodeNumbers(const CADFit<Dim>& fit, vtkTable* table)
{
  const FitDistances& distances = fit.Distances;
  AddColumn(table, "Functions", fit.Value.Space->NumFunctions);
  AddColumn(table, "Elements", fit.Value.Space->NumElements());
  AddColumn(table, "Patches", static_cast<int>(FindSpacePatches(*fit.Value.Space).Patches.size()));
  AddColumn(table, "MaxDistance", distances.ToTarget.Largest);
  AddColumn(table, "RmsDistance", distances.ToTarget.RootMeanSquare);
  AddColumn(table, "MaxDistanceBack", distances.FromTarget.Largest);
  AddColumn(table, "RmsDistanceBack", distances.FromTarget.RootMeanSquare);
  AddColumn(table, "MaxDistanceBound", fit.Bound.OfSurface);
  AddColumn(table, "MaxDistanceBackBound", fit.Bound.OfMesh);
  AddColumn(table, "MeshMaxDistance", distances.MeshToTarget.Largest);
  AddColumn(table, "MeshRmsDistance", distances.MeshToTarget.RootMeanSquare);
  AddColumn(table, "MeshMaxDistanceBack", distances.MeshFromTarget.Largest);
  AddColumn(table, "MeshRmsDistanceBack", distances.MeshFromTarget.RootMeanSquare);
  AddColumn(table, "Verdict", std::string(ToString(fit.Certificate.Verdict)));
  AddColumn(table, "MinJacobianLower",
    fit.Certificate.Verdict == Verdict::Reversed ? -fit.Certificate.MaxUpper
                                                 : fit.Certificate.MinLower);
  AddColumn(table, "UncertifiedElements", static_cast<int>(fit.Uncertified.size()));
  AddColumn(table, "InvalidElementsBefore", fit.InvalidBefore);
  AddColumn(table, "SmoothedElements", fit.Smoothed);
  AddColumn(table, "LayerElements", fit.LayerCells);
  AddColumn(table, "FoldedCells", fit.FoldedCells);
  AddColumn(table, "StillFolded", fit.StillFolded);
  AddColumn(table, "UnmatchedFeatures", static_cast<int>(fit.UnmatchedFeatures.size()));
  AddColumn(table, "Area", fit.Area);
  AddColumn(table, "Volume", fit.Volume);
  AddColumn(table, "KnotIntervals", std::string(fit.HasMeanLengths ? "mean" : "uniform"));
  AddColumn(table, "Path", std::string(ToString(fit.Path)));
  AddColumn(table, "PathTried",
    fit.PathNote.empty() ? std::string() : std::string(ToString(fit.PathTried)));
  AddColumn(table, "PathNote", fit.PathNote);
}

void EncodeEntities(const FitDistances& distances, vtkTable* table)
{
  const auto kind = NamedArray<vtkStringArray>("Entity");
  const auto id = NamedArray<vtkIntArray>("Id");
  const auto count = NamedArray<vtkIntArray>("Elements");
  const auto rms = NamedArray<vtkDoubleArray>("RmsDistance");
  const auto largest = NamedArray<vtkDoubleArray>("MaxDistance");
  const auto place = NamedArray<vtkDoubleArray>("Place");
  place->SetNumberOfComponents(3);
  for (const EntityDistance& entity : distances.Entities)
  {
    kind->InsertNextValue(EntityNames[static_cast<int>(entity.Part.Entity)]);
    id->InsertNextValue(entity.Part.Id);
    count->InsertNextValue(entity.Count);
    rms->InsertNextValue(entity.Distance.RootMeanSquare);
    largest->InsertNextValue(entity.Distance.Largest);
    place->InsertNextTuple(entity.Distance.Place.data());
  }
  for (vtkAbstractArray* column :
    std::initializer_list<vtkAbstractArray*>{ kind, id, count, rms, largest, place })
  {
    table->AddColumn(column);
  }
}

/// Points as vertices.
void SetVertices(const PointMatrix& rows, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
  {
    const vtkIdType point = points->InsertNextPoint(rows(i, 0), rows(i, 1), rows(i, 2));
    cells->InsertNextCell(1, &point);
  }
  output->SetPoints(points);
  output->SetVerts(cells);
}

template <int Dim>
void EncodePoints(const CADFit<Dim>& fit, const Outputs& outputs)
{
  const FitDistances& distances = fit.Distances;
  SetVertices(distances.Samples.Points, outputs.TargetPoints);
  const auto distance = NamedArray<vtkDoubleArray>("Distance");
  const auto face = NamedArray<vtkIntArray>("Face");
  for (std::size_t i = 0; i < distances.Samples.Faces.size(); ++i)
  {
    distance->InsertNextValue(distances.OfSamples[static_cast<Eigen::Index>(i)]);
    face->InsertNextValue(distances.Samples.Faces[i]);
  }
  outputs.TargetPoints->GetPointData()->AddArray(distance);
  outputs.TargetPoints->GetPointData()->AddArray(face);
  PointMatrix places(static_cast<Eigen::Index>(fit.UnmatchedFeatures.size()), 3);
  const auto kind = NamedArray<vtkStringArray>("Entity");
  const auto id = NamedArray<vtkIntArray>("Id");
  for (std::size_t i = 0; i < fit.UnmatchedFeatures.size(); ++i)
  {
    const auto& feature = fit.UnmatchedFeatures[i];
    places.row(static_cast<Eigen::Index>(i)) =
      Eigen::Map<const Eigen::RowVector3d>(feature.Place.data());
    kind->InsertNextValue(EntityNames[static_cast<int>(feature.Part.Entity)]);
    id->InsertNextValue(feature.Part.Id);
  }
  SetVertices(places, outputs.Unmatched);
  outputs.Unmatched->GetPointData()->AddArray(kind);
  outputs.Unmatched->GetPointData()->AddArray(id);
}

template <int Dim>
std::vector<std::string> Warnings(const CADFit<Dim>& fit)
{
  std::vector<std::string> warnings = fit.Warnings;
  if (!fit.UnmatchedFeatures.empty())
  {
    const auto& first = fit.UnmatchedFeatures.front();
    warnings.push_back(std::to_string(fit.UnmatchedFeatures.size()) +
      " sharp edges or corners of the target have no edges or points of the mesh, the first is " +
      EntityNames[static_cast<int>(first.Part.Entity)] + " " + std::to_string(first.Part.Id) +
      " at (" + std::to_string(first.Place[0]) + ", " + std::to_string(first.Place[1]) + ", " +
      std::to_string(first.Place[2]) +
      "): the spline is round there; refine the mesh, or take "
      "edges for smooth (SharpAngle, --sharp-angle)");
  }
  if (!fit.PathNote.empty())
  {
    warnings.push_back("the path " + std::string(ToString(fit.PathTried)) +
      " is not taken but unstructured: " + fit.PathNote);
  }
  if (!fit.Uncertified.empty())
  {
    warnings.push_back(std::to_string(fit.Uncertified.size()) +
      " elements are not proved valid, the first is " + std::to_string(fit.Uncertified.front()) +
      ": see the cell array Verdict; refine the mesh there, or let more control points move "
      "(SmoothingRings, --smoothing-rings)");
  }
  return warnings;
}

template <int Dim>
Status FitMesh(vtkPointSet* data, const DecodedMeshCells& decoded, const CellMesh<Dim>& mesh,
  const FitTargetPtr& target, Choices choices, const Outputs& outputs,
  std::vector<std::string>& warnings)
{
  const auto topology = MakeConforming<Dim>(mesh, decoded);
  if (!topology)
  {
    return topology.Status;
  }
  auto features = FindFeatures<Dim>(
    data, decoded, mesh, topology.Value, choices.FeatureAngle, choices.FeatureArray);
  Status status = features.Status;
  choices.Fit.Space.Features = std::move(features.Value);
  if (status && !choices.FitArray.empty() && choices.FitArray != "None")
  {
    const auto labels = CellLabels(data, choices.FitArray, decoded);
    status = labels.Status;
    choices.Fit.FittedCells.resize(labels->size());
    std::transform(labels->begin(), labels->end(), choices.Fit.FittedCells.begin(),
      [](double label) { return static_cast<char>(label != 0.0); });
  }
  const PointMatrix points = decoded.Points.leftCols(3);
  if (!status)
  {
    return status;
  }
  const auto fit = FitToTarget<Dim>(mesh, points, target, choices.Fit);
  if (!fit)
  {
    return fit.Status;
  }
  SplineModel model;
  model.Patches.emplace_back();
  model.Patches.front().Geometry = fit->Value;
  if (Status encoded = EncodeSplineGrid(model, outputs.Spline); !encoded)
  {
    return encoded;
  }
  std::vector<vtkIdType> cells;
  for (const int cell : fit->CellOf)
  {
    cells.push_back(decoded.Cells[static_cast<std::size_t>(cell)]);
  }
  PassCellData(data, cells, outputs.Spline);
  AddCellArrays(fit.Value, outputs.Spline);
  EncodeNumbers(fit.Value, outputs.Numbers);
  EncodeEntities(fit->Distances, outputs.Entities);
  EncodePoints(fit.Value, outputs);
  warnings = Warnings(fit.Value);
  if (!target && !choices.Fit.FittedCells.empty())
  {
    warnings.push_back("the cell array '" + choices.FitArray +
      "' does not count: there is no target that its cells could be fitted to");
  }
  return {};
}
}

vtkCADFit::vtkCADFit()
{
  this->SetInputTypes({ Meshes(), Optional(Shapes()) });
  this->SetOutputTypes(
    { "vtkUnstructuredGrid", "vtkTable", "vtkTable", "vtkPolyData", "vtkPolyData" });
}

vtkCADFit::~vtkCADFit()
{
  this->SetImplicitFunction(nullptr);
  this->SetFaceGroups(nullptr);
  this->SetFeatureArray(nullptr);
  this->SetFitArray(nullptr);
}

void vtkCADFit::SetTargetConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkCADFit::SetTargetData(vtkDataObject* target)
{
  this->SetInputDataObject(1, target);
}

vtkMTimeType vtkCADFit::GetMTime()
{
  vtkMTimeType time = this->Superclass::GetMTime();
  if (this->ImplicitFunction)
  {
    time = std::max(time, this->ImplicitFunction->GetMTime());
  }
  return time;
}

Status vtkCADFit::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPointSet* data = vtkPointSet::GetData(inputs[0], 0);
  const auto decoded = DecodeMeshCells(data, this->SplitPolygons);
  if (!decoded)
  {
    return decoded.Status;
  }
  Choices choices;
  choices.Fit.Space.Degree = this->Degree;
  choices.Fit.Space.Policy = static_cast<CreasePolicy>(this->Policy);
  choices.Fit.Path = static_cast<FitPath>(this->Path);
  choices.Fit.CompositeWeights = static_cast<RestrictionKind>(this->CompositeWeights);
  choices.Fit.Surfaces = this->FitSurfaces;
  choices.Fit.Curves = this->FitCurves;
  choices.Fit.Points = this->FitPoints;
  choices.Fit.Untangle = this->Untangle;
  choices.Fit.UntanglingRings = this->UntangleRings;
  choices.Fit.Smoothing = static_cast<FitSmoothing>(this->Smoothing);
  choices.Fit.SmoothingRings = this->SmoothingRings;
  choices.Fit.Layer = this->Layer;
  choices.Fit.Constrain = this->Constrain;
  choices.Fit.Projections = this->Projections;
  choices.Fit.ExtraPoints = this->ExtraPoints;
  choices.Fit.TargetSamples = this->TargetSamples;
  choices.Fit.BoundedElements = this->BoundedElements;
  choices.Fit.Threads = this->KernelThreads();
  choices.Fit.Progress = this->Progress();
  choices.Fit.Lengths = static_cast<FitLengths>(this->Lengths);
  choices.FeatureAngle = this->FeatureAngle;
  choices.FeatureArray = this->FeatureArray ? this->FeatureArray : "";
  choices.FitArray = this->FitArray ? this->FitArray : "";
  Result<FitTargetPtr> target;
  if (this->TargetType == IMPLICIT_FUNCTION)
  {
    double box[6];
    data->GetBounds(box);
    const double margin = 0.1 * data->GetLength();
    for (int d = 0; d < 3; ++d)
    {
      box[2 * d] -= margin;
      box[2 * d + 1] += margin;
    }
    target = AdaptImplicitFunction(this->ImplicitFunction, box);
    choices.Fit.Threads = 1; // functions of VTK need not bear several threads
  }
  else if (vtkDataObject* given = vtkDataObject::GetData(inputs[1], 0))
  {
    FitTargetOptions options;
    options.SharpAngle = this->SharpAngle;
    options.WeakAngle = this->WeakAngle;
    options.CornerAngle = this->CornerAngle;
    options.FaceGroups = this->FaceGroups ? this->FaceGroups : "";
    target = DecodeFitTarget(given, options, this->KernelThreads());
  }
  if (!target)
  {
    target.Status.Detail = "target: " + target.Status.Detail;
    return target.Status;
  }
  const Outputs to{ vtkUnstructuredGrid::GetData(outputs, 0), vtkTable::GetData(outputs, 1),
    vtkTable::GetData(outputs, 2), vtkPolyData::GetData(outputs, 3),
    vtkPolyData::GetData(outputs, 4) };
  std::vector<std::string> warnings;
  Status status = std::visit([&](const auto& mesh)
    { return FitMesh(data, decoded.Value, mesh, target.Value, choices, to, warnings); },
    decoded->Mesh);
  this->ReportWarnings(warnings);
  return status;
}
