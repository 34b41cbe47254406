// SPDX-License-Identifier: BSD-3-Clause
#include "vtkElementCurving.h"

#include "ElementData.h"
#include "FitTargetData.h"
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SplineGrid/TableRow.h>

#include "vtkCellData.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointSet.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

using namespace knotwork;

vtkStandardNewMacro(vtkElementCurving);

namespace
{
int CountRelaxed(const CurvedElements& curved)
{
  return static_cast<int>(std::count(curved.Relaxed.begin(), curved.Relaxed.end(), 1));
}

void AddCellArrays(const CurvedElements& curved, vtkUnstructuredGrid* grid)
{
  vtkCellData* data = grid->GetCellData();
  data->AddArray(ArrayOf<vtkIntArray>("Verdict", curved.Certificate.Cells,
    [](const CellCertificate& cell) { return static_cast<int>(cell.Verdict); }));
  data->AddArray(ArrayOf<vtkDoubleArray>("MinJacobianLower", curved.Certificate.Cells,
    [](const CellCertificate& cell) { return cell.MinLower; }));
  data->AddArray(
    ArrayOf<vtkIntArray>("Relaxed", curved.Relaxed, [](char relaxed) { return int(relaxed); }));
  data->AddArray(
    ArrayOf<vtkDoubleArray>("Distance", curved.Distance, [](double distance) { return distance; }));
  data->SetActiveScalars("Distance"); // drawn first
}

void EncodeNumbers(const CurvedElements& curved, int numLeftOut, vtkTable* table)
{
  AddColumn(table, "Points", static_cast<int>(curved.Points.rows()));
  AddColumn(table, "Elements", static_cast<int>(curved.Shapes.size()));
  AddColumn(table, "CertifiedElements", curved.Certificate.NumValid);
  AddColumn(table, "RelaxedElements", CountRelaxed(curved));
  AddColumn(table, "TurnedElements", curved.Turned);
  AddColumn(table, "BoundaryElements", curved.BoundaryElements);
  AddColumn(table, "Facets", curved.NumFacets);
  AddColumn(table, "PointsOnVertices", curved.Placed.OnVertices);
  AddColumn(table, "PointsOnCurves", curved.Placed.OnCurves);
  AddColumn(table, "PointsOnFaces", curved.Placed.OnFaces);
  AddColumn(table, "PointsLeft", curved.Placed.Left);
  AddColumn(table, "PointsInside", curved.Following);
  AddColumn(table, "UnmatchedCurves", curved.UnmatchedCurves);
  AddColumn(table, "CellsLeftOut", numLeftOut);
  AddColumn(table, "StraightMaxDistance", curved.StraightToTarget.Largest);
  AddColumn(table, "StraightRmsDistance", curved.StraightToTarget.RootMeanSquare);
  AddColumn(table, "MaxDistance", curved.CurvedToTarget.Largest);
  AddColumn(table, "RmsDistance", curved.CurvedToTarget.RootMeanSquare);
  AddColumn(table, "Area", curved.Area);
  AddColumn(table, "Volume", curved.Volume);
  AddColumn(table, "Verdict", std::string(ToString(curved.Certificate.Verdict)));
  AddColumn(table, "MinJacobianLower", curved.Certificate.MinLower);
}

std::vector<std::string> Warnings(const CurvedElements& curved, int numLeftOut)
{
  std::vector<std::string> warnings;
  if (numLeftOut > 0)
  {
    warnings.push_back(
      std::to_string(numLeftOut) + " cells of fewer dimensions than others are left out");
  }
  if (const int relaxed = CountRelaxed(curved); relaxed > 0)
  {
    warnings.push_back(std::to_string(relaxed) + " of " + std::to_string(curved.Shapes.size()) +
      " elements are not where the target is, for they would fold (cell array Relaxed); refine the "
      "mesh there");
  }
  if (curved.Placed.Left > 0)
  {
    warnings.push_back(std::to_string(curved.Placed.Left) +
      " points stay off the target, for it is farther from them than half of their edges; refine "
      "the mesh there");
  }
  return warnings;
}
}

vtkElementCurving::vtkElementCurving()
{
  this->SetInputTypes({ Meshes(), Shapes() });
  this->SetOutputTypes({ "vtkUnstructuredGrid", "vtkTable" });
}

vtkElementCurving::~vtkElementCurving()
{
  this->SetFaceGroups(nullptr);
  this->SetFeatureArray(nullptr);
}

void vtkElementCurving::SetTargetConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkElementCurving::SetTargetData(vtkDataObject* target)
{
  this->SetInputDataObject(1, target);
}

Status vtkElementCurving::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPointSet* data = vtkPointSet::GetData(inputs[0], 0);
  if (data->GetNumberOfCells() == 0)
  {
    return {}; // as VTK's filters: nothing of nothing
  }
  const auto decoded = DecodeStraightElements(data);
  if (!decoded)
  {
    return decoded.Status;
  }
  CurvedElementsParams params;
  params.Order = this->Order;
  params.Bezier = this->Basis == BEZIER;
  params.Threads = this->KernelThreads();
  params.Progress = this->Progress();
  auto regions = DecodeRegions(data, decoded.Value, this->FeatureArray ? this->FeatureArray : "");
  if (!regions)
  {
    return regions.Status;
  }
  params.Regions = std::move(regions.Value);
  FitTargetOptions options;
  options.SharpAngle = this->SharpAngle;
  options.WeakAngle = this->WeakAngle;
  options.CornerAngle = this->CornerAngle;
  options.FaceGroups = this->FaceGroups ? this->FaceGroups : "";
  auto target =
    DecodeFitTarget(vtkDataObject::GetData(inputs[1], 0), options, this->KernelThreads());
  if (!target)
  {
    target.Status.Detail = "target: " + target.Status.Detail;
    return target.Status;
  }
  const auto curved = CurveElements(decoded->Elements, target.Value.get(), params);
  if (!curved)
  {
    return curved.Status;
  }
  vtkUnstructuredGrid* grid = vtkUnstructuredGrid::GetData(outputs, 0);
  EncodeCurvedElements(curved.Value, this->Order, params.Bezier, grid);
  PassCellData(data, decoded->Cells, grid);
  AddCellArrays(curved.Value, grid);
  EncodeNumbers(curved.Value, decoded->NumLeftOut, vtkTable::GetData(outputs, 1));
  this->ReportWarnings(Warnings(curved.Value, decoded->NumLeftOut));
  return {};
}
