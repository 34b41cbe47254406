// SPDX-License-Identifier: BSD-3-Clause
#include "vtkUnstructuredSpline.h"

#include "CellMeshData.h"
#include "PatchFields.h"
#include "TableRow.h"
#include <knotwork/SplineCore/MeshGeometry.h>
#include <knotwork/SplineCore/MeshSpline.h>
#include <knotwork/SplineCore/TangentPlanes.h>

#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointSet.h"
#include "vtkUnstructuredGrid.h"

using namespace knotwork;

static_assert(vtkUnstructuredSpline::MINIMAL == static_cast<int>(CreasePolicy::Minimal) &&
    vtkUnstructuredSpline::MOTORCYCLE == static_cast<int>(CreasePolicy::Motorcycle) &&
    vtkUnstructuredSpline::FULL == static_cast<int>(CreasePolicy::Full),
  "the policies are those of the kernel");

vtkStandardNewMacro(vtkUnstructuredSpline);

namespace
{
constexpr const char* PolicyNames[] = { "Automatic", "Full", "Motorcycle", "Minimal" };

struct Choices
{
  UnstructuredParams Space;
  bool IsCage = false;
  bool HasMeanLengths = false;
  bool HasTangentPlanes = false;
  double FeatureAngle = 180.0;
  std::string FeatureArray;
  int Threads = 0;
  ProgressCallback Progress;
};

/// Of a surface from both sides of creases that are no features; volumes have none.
template <int Dim>
double CreaseAngle(const Spline<Dim>& spline, const Choices& choices)
{
  if constexpr (Dim == 2)
  {
    return LargestCreaseAngle(spline, choices.Space.Features, choices.Threads);
  }
  return -1.0;
}

/// Points that get a tangent plane.
template <int Dim>
Result<int> FlattenStars(
  Spline<Dim>& spline, const DecodedMeshCells& decoded, const Choices& choices)
{
  if constexpr (Dim == 2)
  {
    auto made = MakeTangentPlanes(
      spline, choices.Space.Features, choices.IsCage ? PointMatrix() : decoded.Points);
    spline = std::move(made->Value);
    return made ? Result<int>(made->NumVertices) : Result<int>(made.Status);
  }
  return { ErrorCode::InvalidParameter,
    "TangentPlanes is for quadrilaterals; hexahedra have none" };
}

template <int Dim>
void EncodeNumbers(const UnstructuredResult<Dim>& made, const Spline<Dim>& spline,
  const DecodedMeshCells& decoded, const Choices& choices, vtkTable* table)
{
  Spline<Dim> geometry = spline;
  geometry.ControlPoints = spline.ControlPoints.leftCols(3);
  const VertexDistance distance =
    DistanceFromVertices<Dim>(geometry, decoded.Points.leftCols(3), choices.Threads);
  AddColumn(table, "Policy", std::string(PolicyNames[static_cast<int>(made.Policy)]));
  AddColumn(table, "Functions", made.Space->NumFunctions);
  AddColumn(table, "Elements", made.Space->NumElements());
  AddColumn(table, "CreasedFacets", static_cast<int>(made.CreasedFacets));
  AddColumn(table, "InnerFacets", static_cast<int>(made.InnerFacets));
  AddColumn(table, "ExtraordinaryPoints", static_cast<int>(made.ExtraordinaryRidges));
  AddColumn(table, "Repairs", static_cast<int>(made.Repairs));
  AddColumn(table, "MaxNormalAngle", CreaseAngle(spline, choices));
  AddColumn(table, "MaxVertexDistance", distance.Largest);
  AddColumn(table, "RmsVertexDistance", distance.RootMeanSquare);
  AddColumn(table, "SplitPolygons", decoded.NumSplit);
  AddColumn(table, "Orientable", made.IsOrientable ? 1 : 0);
}

template <int Dim>
Status MakeSpline(vtkPointSet* data, const DecodedMeshCells& decoded, const CellMesh<Dim>& mesh,
  Choices choices, vtkUnstructuredGrid* output, vtkTable* table)
{
  const auto topology = MakeConforming<Dim>(mesh, decoded);
  if (!topology)
  {
    return topology.Status;
  }
  auto features = FindFeatures<Dim>(
    data, decoded, mesh, topology.Value, choices.FeatureAngle, choices.FeatureArray);
  Status status = features.Status;
  choices.Space.Features = std::move(features.Value);
  if (status && choices.HasMeanLengths)
  {
    auto lengths = MeanSheetLengths<Dim>(mesh, topology.Value, decoded.Points.leftCols(3));
    status = lengths.Status;
    choices.Space.Lengths = std::move(lengths.Value);
  }
  if (!status)
  {
    return status;
  }
  const auto made = MakeUnstructuredSpace<Dim>(mesh, choices.Space);
  if (!made)
  {
    return made.Status;
  }
  auto spline = choices.IsCage
    ? SplineOfCage<Dim>(made->Space, decoded.Points)
    : SplineThroughVertices<Dim>(made->Space, decoded.Points, choices.Threads, choices.Progress);
  if (!spline)
  {
    return spline.Status;
  }
  const double before = CreaseAngle(spline.Value, choices);
  const auto planes =
    choices.HasTangentPlanes ? FlattenStars(spline.Value, decoded, choices) : Result<int>(0);
  if (!planes)
  {
    return planes.Status;
  }
  SplineModel model;
  model.Patches.emplace_back();
  model.Patches.front().Fields = decoded.Fields;
  SeparateFields<Dim>(spline.Value, model.Patches.front());
  if (Status encoded = EncodeSplineGrid(model, output); !encoded)
  {
    return encoded;
  }
  PassCellData(data, decoded.Cells, output);
  EncodeNumbers<Dim>(made.Value, spline.Value, decoded, choices, table);
  AddColumn(table, "MaxNormalAngleBefore", before);
  AddColumn(table, "TangentPlanes", planes.Value);
  return {};
}
}

vtkUnstructuredSpline::vtkUnstructuredSpline()
{
  this->SetNumberOfInputPorts(1);
  this->SetOutputTypes({ "vtkUnstructuredGrid", "vtkTable" });
}

vtkUnstructuredSpline::~vtkUnstructuredSpline()
{
  this->SetFeatureArray(nullptr);
}

int vtkUnstructuredSpline::FillInputPortInformation(int, vtkInformation* info)
{
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  return 1;
}

Status vtkUnstructuredSpline::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPointSet* data = vtkPointSet::GetData(inputs[0], 0);
  const auto decoded = DecodeMeshCells(data, this->SplitPolygons);
  if (!decoded)
  {
    return decoded.Status;
  }
  Choices choices;
  choices.Space.Degree = this->Degree;
  choices.Space.Policy = static_cast<CreasePolicy>(this->Policy);
  choices.IsCage = this->Construction == CONTROL_CAGE;
  choices.HasMeanLengths = this->Lengths == MEAN;
  choices.HasTangentPlanes = this->TangentPlanes;
  choices.FeatureAngle = this->FeatureAngle;
  choices.FeatureArray = this->FeatureArray ? this->FeatureArray : "";
  choices.Threads = this->KernelThreads();
  choices.Progress = this->Progress();
  Status status = std::visit(
    [&](const auto& mesh)
    {
      return MakeSpline(data, decoded.Value, mesh, choices,
        vtkUnstructuredGrid::GetData(outputs, 0), vtkTable::GetData(outputs, 1));
    },
    decoded->Mesh);
  if (!status && this->SplitPolygons)
  {
    status.Detail += " (numbers are those of the mesh of split polygons)";
  }
  return status;
}
