// SPDX-License-Identifier: BSD-3-Clause
#include "vtkUnstructuredSpline.h"

#include "CellMeshData.h"
#include "PatchFields.h"
#include "TableRow.h"
#include <knotwork/SplineCore/MeshGeometry.h>
#include <knotwork/SplineCore/MeshSpline.h>
#include <knotwork/SplineCore/TangentPlanes.h>
#include <knotwork/SplineCore/UntangledSpline.h>

#include "vtkDataObject.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointSet.h"
#include "vtkUnstructuredGrid.h"

#include <sstream>

using namespace knotwork;

static_assert(vtkUnstructuredSpline::MINIMAL == static_cast<int>(CreasePolicy::Minimal) &&
    vtkUnstructuredSpline::MOTORCYCLE == static_cast<int>(CreasePolicy::Motorcycle) &&
    vtkUnstructuredSpline::FULL == static_cast<int>(CreasePolicy::Full),
  "the policies are those of the kernel");
static_assert(vtkUnstructuredSpline::CELLS == static_cast<int>(UntanglingScope::Cells) &&
    vtkUnstructuredSpline::ELEMENTS == static_cast<int>(UntanglingScope::Elements),
  "the scopes are those of the kernel");

vtkStandardNewMacro(vtkUnstructuredSpline);

namespace
{
constexpr const char* PolicyNames[] = { "Automatic", "Full", "Motorcycle", "Minimal" };

struct Choices
{
  UnstructuredParams Space;
  UntangledSplineParams Points;
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
Result<int> FlattenStars(Spline<Dim>& spline, const PointMatrix& vertices, const Choices& choices)
{
  if constexpr (Dim == 2)
  {
    auto made = MakeTangentPlanes(
      spline, choices.Space.Features, choices.Points.IsCage ? PointMatrix() : vertices);
    spline = std::move(made->Value);
    return made ? Result<int>(made->NumVertices) : Result<int>(made.Status);
  }
  return { ErrorCode::InvalidParameter,
    "TangentPlanes is for quadrilaterals; hexahedra have none" };
}

template <int Dim>
void EncodeNumbers(const UnstructuredResult<Dim>& made, const UntangledSpline<Dim>& untangled,
  const DecodedMeshCells& decoded, const Choices& choices, vtkTable* table)
{
  const Spline<Dim>& spline = untangled.Value;
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
  AddColumn(table, "FoldedCells",
    choices.Points.Scope == UntanglingScope::None ? -1
                                                  : static_cast<int>(untangled.FoldedCells.size()));
  AddColumn(table, "StillFolded", static_cast<int>(untangled.StillFolded.size()));
  AddColumn(table, "FoldedElements", untangled.FoldedElements);
  AddColumn(table, "MovedPoints", untangled.NumMoved);
  AddColumn(table, "LargestMove", untangled.LargestMove);
  AddColumn(table, "SplitPolygons", decoded.NumSplit);
  AddColumn(table, "Orientable", made.IsOrientable ? 1 : 0);
}

/// What became of folded cells, in sentences.
template <int Dim>
std::vector<std::string> Warnings(const UntangledSpline<Dim>& made)
{
  const char* const cells = Dim == 2 ? " quadrilaterals" : " hexahedra";
  std::vector<std::string> warnings;
  if (made.NumMoved > 0)
  {
    std::ostringstream text;
    text << made.FoldedCells.size() << cells << " of the mesh are folded: " << made.NumMoved
         << " points moved, by at most " << made.LargestMove << " (Untangle, --untangle)";
    warnings.push_back(text.str());
  }
  if (!made.StillFolded.empty())
  {
    warnings.push_back(std::to_string(made.StillFolded.size()) + cells +
      " stay folded, the first is cell " + std::to_string(made.StillFolded.front()) +
      ": the spline turns over there; mend the mesh, or let more points move (UntangleRings, "
      "--untangle-rings)");
  }
  return warnings;
}

template <int Dim>
Status MakeSpline(vtkPointSet* data, const DecodedMeshCells& decoded, const CellMesh<Dim>& mesh,
  Choices choices, vtkUnstructuredGrid* output, vtkTable* table, std::vector<std::string>& warnings)
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
  choices.Points.Threads = choices.Threads;
  choices.Points.Progress = choices.Progress;
  if constexpr (Dim == 2)
  {
    choices.Points.Mesh.Features = choices.Space.Features;
  }
  auto untangled = MakeUntangledSpline<Dim>(made->Space, decoded.Points, 3, choices.Points);
  if (!untangled)
  {
    return untangled.Status;
  }
  warnings = Warnings(untangled.Value);
  Spline<Dim>& spline = untangled->Value;
  const double before = CreaseAngle(spline, choices);
  const auto planes =
    choices.HasTangentPlanes ? FlattenStars(spline, untangled->Vertices, choices) : Result<int>(0);
  if (!planes)
  {
    return planes.Status;
  }
  SplineModel model;
  model.Patches.emplace_back();
  model.Patches.front().Fields = decoded.Fields;
  SeparateFields<Dim>(spline, model.Patches.front());
  if (Status encoded = EncodeSplineGrid(model, output); !encoded)
  {
    return encoded;
  }
  PassCellData(data, decoded.Cells, output);
  EncodeNumbers<Dim>(made.Value, untangled.Value, decoded, choices, table);
  AddColumn(table, "MaxNormalAngleBefore", before);
  AddColumn(table, "TangentPlanes", planes.Value);
  return {};
}
}

vtkUnstructuredSpline::vtkUnstructuredSpline()
{
  this->SetInputTypes({ Meshes() });
  this->SetOutputTypes({ "vtkUnstructuredGrid", "vtkTable" });
}

vtkUnstructuredSpline::~vtkUnstructuredSpline()
{
  this->SetFeatureArray(nullptr);
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
  choices.Points.IsCage = this->Construction == CONTROL_CAGE;
  choices.Points.Scope = static_cast<UntanglingScope>(this->Untangle);
  choices.Points.Mesh.Rings = this->UntangleRings;
  choices.HasMeanLengths = this->Lengths == MEAN;
  choices.HasTangentPlanes = this->TangentPlanes;
  choices.FeatureAngle = this->FeatureAngle;
  choices.FeatureArray = this->FeatureArray ? this->FeatureArray : "";
  choices.Threads = this->KernelThreads();
  choices.Progress = this->Progress();
  std::vector<std::string> warnings;
  Status status = std::visit(
    [&](const auto& mesh)
    {
      return MakeSpline(data, decoded.Value, mesh, choices,
        vtkUnstructuredGrid::GetData(outputs, 0), vtkTable::GetData(outputs, 1), warnings);
    },
    decoded->Mesh);
  this->ReportWarnings(warnings);
  if (!status && this->SplitPolygons)
  {
    status.Detail += " (numbers are those of the mesh of split polygons)";
  }
  return status;
}
