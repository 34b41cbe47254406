// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDomainParameterization.h"

#include "LayoutData.h"
#include <knotwork/DomainParameterization/OutlineCurves.h>
#include <knotwork/DomainParameterization/ParameterizeLayout.h>
#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineGrid/SplineModel.h>

#include "vtkCellArray.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <array>
#include <string>

using knotwork::ErrorCode;
using knotwork::Status;

vtkStandardNewMacro(vtkDomainParameterization);

namespace
{
const char* StageName(knotwork::DomainStage stage)
{
  switch (stage)
  {
    case knotwork::DomainStage::Initial:
      return "initial";
    case knotwork::DomainStage::Foldover:
      return "foldover";
    case knotwork::DomainStage::Quality:
      return "quality";
    default:
      return "weights";
  }
}

const char* StopName(knotwork::DomainStop stop)
{
  switch (stop)
  {
    case knotwork::DomainStop::Effort:
      return "effort";
    case knotwork::DomainStop::Time:
      return "time_limit";
    default:
      return "finished";
  }
}

/// Output 2.
void FillTable(const std::vector<knotwork::DomainIteration>& history, vtkTable* table)
{
  using Row = knotwork::DomainIteration;
  const auto whole = [&](const char* name, auto value)
  { table->AddColumn(knotwork::ArrayOf<vtkIntArray>(name, history, value)); };
  const auto real = [&](const char* name, auto value)
  { table->AddColumn(knotwork::ArrayOf<vtkDoubleArray>(name, history, value)); };
  table->AddColumn(knotwork::ArrayOf<vtkStringArray>(
    "Stage", history, [](const Row& row) { return StageName(row.Stage); }));
  whole("Iteration", [](const Row& row) { return row.Iteration; });
  real("Energy", [](const Row& row) { return row.Energy; });
  real("MinDetOverArea", [](const Row& row) { return row.MinDet; });
  real("GradientNorm", [](const Row& row) { return row.GradientNorm; });
  whole("Functions", [](const Row& row) { return row.Functions; });
}

/// A map as a grid, a patch each; a planar one lies at z = height.
template <int Dim>
Status EncodeMap(
  const std::vector<knotwork::Spline<Dim>>& patches, double height, vtkUnstructuredGrid* grid)
{
  knotwork::SplineModel model;
  for (knotwork::Spline<Dim> patch : patches)
  {
    patch.ControlPoints.conservativeResize(Eigen::NoChange, 3);
    patch.ControlPoints.rightCols(3 - Dim).setConstant(height);
    model.Patches.emplace_back();
    model.Patches.back().Id = static_cast<int>(model.Patches.size()) - 1;
    model.Patches.back().Geometry = std::move(patch);
  }
  return EncodeSplineGrid(model, grid);
}

void AddText(vtkUnstructuredGrid* grid, const char* name, const char* text)
{
  vtkNew<vtkStringArray> array;
  array->SetName(name);
  array->InsertNextValue(text);
  grid->GetFieldData()->AddArray(array);
}

void AddNumber(vtkUnstructuredGrid* grid, const char* name, double value)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->InsertNextValue(value);
  grid->GetFieldData()->AddArray(array);
}

/// Polylines, or points in their order, of which the array Line may number the lines.
std::vector<knotwork::PointMatrix> LinesOf(vtkPolyData* drawn)
{
  std::vector<std::vector<vtkIdType>> rows;
  vtkCellArray* cells = drawn->GetLines();
  for (vtkIdType c = 0; c < cells->GetNumberOfCells(); ++c)
  {
    vtkIdType count = 0;
    const vtkIdType* points = nullptr;
    cells->GetCellAtId(c, count, points);
    rows.emplace_back(points, points + count);
  }
  if (rows.empty())
  {
    vtkDataArray* numbers = drawn->GetPointData()->GetArray("Line");
    for (vtkIdType i = 0; i < drawn->GetNumberOfPoints(); ++i)
    {
      const bool begins =
        i == 0 || (numbers && numbers->GetComponent(i, 0) != numbers->GetComponent(i - 1, 0));
      if (begins)
      {
        rows.emplace_back();
      }
      rows.back().push_back(i);
    }
  }
  std::vector<knotwork::PointMatrix> lines;
  for (const std::vector<vtkIdType>& row : rows)
  {
    lines.emplace_back(static_cast<Eigen::Index>(row.size()), 2);
    for (std::size_t i = 0; i < row.size(); ++i)
    {
      std::array<double, 3> point{};
      drawn->GetPoint(row[i], point.data());
      lines.back().row(static_cast<Eigen::Index>(i)) << point[0], point[1];
    }
  }
  return lines;
}

/// The report of a map as field data.
void AddReport(const knotwork::DomainReport& result, vtkUnstructuredGrid* grid)
{
  AddText(grid, "Verdict", ToString(result.Certificate.Verdict));
  AddText(grid, "Injective", ToString(result.Injectivity.Verdict));
  const knotwork::DomainMetrics& metrics = result.Metrics;
  AddNumber(grid, "JacobianMinLower", result.MinDetLower);
  AddNumber(grid, "JacobianMinUpper", result.MinDetUpper);
  AddNumber(grid, "Area", metrics.Area);
  AddNumber(grid, "MinDetOverArea", metrics.MinDetOverArea);
  AddNumber(grid, "MaxDetOverArea", metrics.MaxDetOverArea);
  AddNumber(grid, "MinScaledJacobian", metrics.MinScaledJacobian);
  AddNumber(grid, "MeanScaledJacobian", metrics.MeanScaledJacobian);
  AddNumber(grid, "MeanConditionNumber", metrics.MeanConditionNumber);
  AddNumber(grid, "Iterations", result.Iterations);
  AddNumber(grid, "Work", result.Work);
  AddText(grid, "Stopped", StopName(result.Stop));
}
}

vtkDomainParameterization::vtkDomainParameterization()
{
  InputType boundary = Splines();
  boundary.Classes.emplace_back("vtkPolyData");
  this->SetInputTypes({ boundary, Optional({ { "vtkDataSet" } }) });
  this->SetOutputTypes({ "vtkUnstructuredGrid", "vtkUnstructuredGrid", "vtkTable" });
}

Status vtkDomainParameterization::Compute(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->Verdict = 0;
  this->Injectivity = 0;
  this->SecondsWithCertificate = 0.0;
  vtkDataSet* layout = vtkDataSet::GetData(inputs[1], 0);
  if (auto* drawn = vtkPolyData::GetData(inputs[0], 0))
  {
    return drawn->GetNumberOfPoints() > 0 ? this->ParameterizeDrawn(drawn, layout, outputs)
                                          : Status();
  }
  const auto model = this->DecodeInput(vtkDataObject::GetData(inputs[0], 0));
  if (!model)
  {
    return model.Status;
  }
  if (model->Patches.empty())
  {
    return {};
  }
  return model->Patches.front().Geometry.index() == 0
    ? this->Parameterize<2>(model.Value, layout, outputs)
    : this->Parameterize<3>(model.Value, layout, outputs);
}

Status vtkDomainParameterization::ParameterizeDrawn(
  vtkPolyData* drawn, vtkDataSet* layout, vtkInformationVector* outputs)
{
  std::array<double, 6> box{};
  drawn->GetBounds(box.data());
  constexpr double flat = 1e-9;
  if (box[5] - box[4] > flat * drawn->GetLength())
  {
    return { ErrorCode::DimensionMismatch,
      "the lines lie between z = " + std::to_string(box[4]) + " and " + std::to_string(box[5]) +
        "; draw them in a plane z = constant" };
  }
  knotwork::OutlineParams params;
  params.Tolerance = this->OutlineTolerance;
  params.CornerAngle = this->CornerAngle;
  params.CornerWindow = this->CornerWindow;
  params.NumSides = layout ? 0 : 4;
  const auto outline = knotwork::FitOutline(LinesOf(drawn), params);
  if (!outline)
  {
    return outline.Status;
  }
  for (const std::string& message : outline.Value.Messages)
  {
    vtkWarningMacro("" << message);
  }
  knotwork::SplineModel model;
  for (const knotwork::Spline<1>& side : outline.Value.Sides)
  {
    model.Patches.emplace_back();
    model.Patches.back().Id = static_cast<int>(model.Patches.size()) - 1;
    knotwork::Spline<1> raised = side;
    raised.ControlPoints.conservativeResize(Eigen::NoChange, 3);
    raised.ControlPoints.col(2).setConstant(box[4]);
    model.Patches.back().Geometry = std::move(raised);
  }
  const Status status = this->Parameterize<2>(model, layout, outputs);
  vtkUnstructuredGrid* grid = vtkUnstructuredGrid::GetData(outputs, 0);
  AddNumber(grid, "OutlineDistance", outline.Value.MaxDistance);
  AddNumber(grid, "OutlineCorners", outline.Value.NumCorners);
  AddNumber(grid, "OutlineLines", outline.Value.NumLines);
  AddNumber(grid, "OutlineArcs", outline.Value.NumArcs);
  AddNumber(grid, "OutlineCurves", outline.Value.NumCurves);
  return status;
}

knotwork::DomainParams vtkDomainParameterization::KernelParams() const
{
  knotwork::DomainParams params;
  params.InitialMap = static_cast<knotwork::InitialMapMethod>(this->InitialMap);
  params.Optimizer = static_cast<knotwork::DomainOptimizer>(this->Optimizer);
  params.Foldover = static_cast<knotwork::FoldoverRemoval>(this->Foldover);
  params.Weights = static_cast<knotwork::WeightMode>(this->Weights);
  params.FirstWeights = static_cast<knotwork::InitialWeights>(this->InitialWeights);
  params.Objective = static_cast<knotwork::DomainObjective>(this->Objective);
  params.Effort = this->Effort;
  params.TimeLimit = this->TimeLimit;
  params.FoldoverMargin = this->FoldoverMargin;
  params.WinslowEpsilon = this->WinslowEpsilon;
  params.AlternationTolerance = this->AlternationTolerance;
  params.UniformityWeight = this->UniformityWeight;
  params.MaxIterations = this->MaximumIterations;
  params.EnergyTolerance = this->EnergyTolerance;
  params.MaxAlternations = this->MaximumAlternations;
  params.MaxRefinements = this->MaximumRefinements;
  params.GapTolerance = this->GapTolerance;
  params.MetricSamples = this->MetricSamples == 1 ? 2 : this->MetricSamples;
  params.CertificateGap = this->CertificateGap;
  params.MaxFunctions = this->MaximumFunctions;
  params.Threads = this->KernelThreads();
  return params;
}

template <int Dim>
Status vtkDomainParameterization::Parameterize(
  const knotwork::SplineModel& model, vtkDataSet* layoutData, vtkInformationVector* outputs)
{
  std::vector<knotwork::Spline<Dim - 1>> sides;
  for (const knotwork::SplinePatch& patch : model.Patches)
  {
    const auto* side = std::get_if<knotwork::Spline<Dim - 1>>(&patch.Geometry);
    if (!side)
    {
      return { ErrorCode::DimensionMismatch,
        "patch " + std::to_string(patch.Id) +
          " is not of the same kind as the first: give curves or surfaces, not both" };
    }
    sides.push_back(*side);
  }
  // the plane of the curves
  const double height = Dim == 2 ? sides.front().ControlPoints(0, 2) : 0.0;
  const knotwork::DomainParams params = this->KernelParams();
  vtkUnstructuredGrid* grid = vtkUnstructuredGrid::GetData(outputs, 0);
  if (!layoutData)
  {
    const auto result =
      knotwork::ParameterizeDomain<Dim>({ std::move(sides) }, params, this->Progress());
    if (!result)
    {
      return result.Status;
    }
    const Status status =
      this->Encode<Dim>(result.Value, { result->Map }, { result->InitialMap }, height, outputs);
    AddNumber(grid, "Functions", result->Map.Space->NumFunctions);
    return status;
  }
  auto layout = knotwork::DecodeLayout<Dim>(layoutData);
  if (!layout)
  {
    return layout.Status;
  }
  layout->Sides = std::move(sides);
  knotwork::LayoutParams layoutParams;
  layoutParams.GapTolerance = this->GapTolerance;
  layoutParams.MaxFunctions = this->MaximumFunctions;
  layoutParams.MinDegree = this->MinimumDegree;
  layoutParams.MinElements = this->MinimumElements;
  layoutParams.MoveInterfaces = this->MoveInterfaces;
  const auto result =
    knotwork::ParameterizeLayout<Dim>(layout.Value, layoutParams, params, this->Progress());
  if (!result)
  {
    return result.Status;
  }
  const Status status = this->Encode<Dim>(
    result.Value, result->Map.Patches, result->InitialMap.Patches, height, outputs);
  AddNumber(grid, "Functions", result->Map.NumFunctions());
  return status;
}

/// All outputs.
template <int Dim>
Status vtkDomainParameterization::Encode(const knotwork::DomainReport& report,
  const std::vector<knotwork::Spline<Dim>>& map, const std::vector<knotwork::Spline<Dim>>& firstMap,
  double height, vtkInformationVector* outputs)
{
  for (const std::string& message : report.Messages) // those of folds of the boundary first
  {
    vtkWarningMacro("" << message);
  }
  this->Verdict = static_cast<int>(report.Certificate.Verdict);
  this->Injectivity = static_cast<int>(report.Injectivity.Verdict);
  this->SecondsWithCertificate = report.SecondsOptimization + report.SecondsCertificate;
  vtkUnstructuredGrid* grid = vtkUnstructuredGrid::GetData(outputs, 0);
  FillTable(report.History, vtkTable::GetData(outputs, 2));
  Status status = EncodeMap<Dim>(map, height, grid);
  if (status)
  {
    AddReport(report, grid);
    AddNumber(grid, "Patches", static_cast<double>(map.size()));
    status = EncodeMap<Dim>(firstMap, height, vtkUnstructuredGrid::GetData(outputs, 1));
  }
  return status;
}
