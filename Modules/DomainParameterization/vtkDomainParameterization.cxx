// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDomainParameterization.h"

#include "DomainSummary.h"
#include "FieldNumbers.h"
#include "LayoutData.h"
#include <knotwork/DomainParameterization/OutlineCurves.h>
#include <knotwork/DomainParameterization/ParameterizeLayout.h>
#include <knotwork/SplineGrid/DistributedInput.h>
#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineGrid/Processes.h>
#include <knotwork/SplineGrid/SplineBlocks.h>
#include <knotwork/SplineGrid/SplineModel.h>

#include "vtkCellArray.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

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

/// A row of the convergence table.
struct HistoryRow
{
  int Domain = 0;
  knotwork::DomainIteration Iteration;
};

/// Output 2. @param isOfDomains  whether there is a column of them.
void FillTable(const std::vector<HistoryRow>& history, bool isOfDomains, vtkTable* table)
{
  using Row = HistoryRow;
  const auto whole = [&](const char* name, auto value)
  { table->AddColumn(knotwork::ArrayOf<vtkIntArray>(name, history, value)); };
  const auto real = [&](const char* name, auto value)
  { table->AddColumn(knotwork::ArrayOf<vtkDoubleArray>(name, history, value)); };
  if (isOfDomains)
  {
    whole("Domain", [](const Row& row) { return row.Domain; });
  }
  table->AddColumn(knotwork::ArrayOf<vtkStringArray>(
    "Stage", history, [](const Row& row) { return StageName(row.Iteration.Stage); }));
  whole("Iteration", [](const Row& row) { return row.Iteration.Iteration; });
  real("Energy", [](const Row& row) { return row.Iteration.Energy; });
  real("MinDetOverArea", [](const Row& row) { return row.Iteration.MinDet; });
  real("GradientNorm", [](const Row& row) { return row.Iteration.GradientNorm; });
  whole("Functions", [](const Row& row) { return row.Iteration.Functions; });
}

/// The patches of a map behind those that there are; a planar one lies at z = height.
/// @param domain  number of the one patch; -1: patches have numbers of their own.
template <int Dim>
void AddPatches(const std::vector<knotwork::Spline<Dim>>& patches, double height, int domain,
  knotwork::SplineModel& model)
{
  for (knotwork::Spline<Dim> patch : patches)
  {
    patch.ControlPoints.conservativeResize(Eigen::NoChange, 3);
    patch.ControlPoints.rightCols(3 - Dim).setConstant(height);
    model.Patches.emplace_back();
    model.Patches.back().Id = domain >= 0 ? domain : static_cast<int>(model.Patches.size()) - 1;
    model.Patches.back().Geometry = std::move(patch);
  }
}

/// Which inputs processes have of a filter that is asked together.
enum class Holding
{
  Nothing,
  Domains,
  Whole ///< what makes one domain
};
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

/// The sides of a domain a block; none where blocks are something else.
std::vector<knotwork::SplineModel> SidesByBlock(vtkDataObject* input, int threads)
{
  std::vector<knotwork::SplineModel> domains;
  if (!vtkPartitionedDataSetCollection::SafeDownCast(input))
  {
    return domains;
  }
  for (const auto& [block, grid] : knotwork::GridsByBlock(input))
  {
    if (grid->GetNumberOfCells() == 0)
    {
      continue;
    }
    auto sides = knotwork::DecodeSplineModel(grid, threads);
    const std::size_t count = sides ? sides->Patches.size() : 0;
    const bool areCurves = count == 4 && sides->Patches.front().Geometry.index() == 0;
    const bool areFaces = count == 6 && sides->Patches.front().Geometry.index() == 1;
    if (!areCurves && !areFaces)
    {
      return {};
    }
    sides->Patches.front().Block = block;
    domains.push_back(std::move(sides.Value));
  }
  return domains;
}
}

/// What the outputs are made of.
struct vtkDomainParameterization::Made
{
  knotwork::SplineModel Map;
  knotwork::SplineModel FirstMap;
  std::vector<HistoryRow> History;
  std::vector<knotwork::DomainSummary> Summaries; ///< a domain each
  bool IsOfDomains = false;
};

vtkDomainParameterization::vtkDomainParameterization()
{
  InputType boundary = Splines();
  boundary.Classes.emplace_back("vtkPolyData");
  this->SetInputTypes({ boundary, Optional({ { "vtkDataSet" } }) });
  this->SetOutputTypes({ "vtkUnstructuredGrid", "vtkUnstructuredGrid", "vtkTable" });
}

vtkDomainParameterization::~vtkDomainParameterization() = default;

bool vtkDomainParameterization::HoldsDomains(vtkDataObject* boundary)
{
  return !SidesByBlock(boundary, 0).empty();
}

Status vtkDomainParameterization::Gather(vtkInformationVector** inputs)
{
  this->Last.reset();
  vtkDataObject* boundary = vtkDataObject::GetData(inputs[0], 0);
  const Holding own = !knotwork::HasData(inputs, 1)                ? Holding::Nothing
    : !vtkDataSet::GetData(inputs[1], 0) && HoldsDomains(boundary) ? Holding::Domains
                                                                   : Holding::Whole;
  const std::vector<int> all = knotwork::Processes::ExchangeNumber(static_cast<int>(own));
  const auto count = [&all](Holding holding)
  { return std::count(all.begin(), all.end(), static_cast<int>(holding)); };
  const auto holders = count(Holding::Whole) + count(Holding::Domains);
  return count(Holding::Whole) == 0 || holders == 1
    ? Status()
    : Status(ErrorCode::InvalidTopology,
        "the whole input is needed, and it is spread over " + std::to_string(holders) + " of " +
          std::to_string(all.size()) +
          " processes; give each of them whole domains as blocks of a collection, or work in one "
          "process");
}

Status vtkDomainParameterization::Merge(vtkInformationVector**, vtkInformationVector* outputs)
{
  using knotwork::Processes::Exchange;
  const auto join = [](const auto& parts)
  {
    auto all = parts.front();
    for (auto part = parts.begin() + 1; part != parts.end(); ++part)
    {
      all.insert(all.end(), part->begin(), part->end());
    }
    return all;
  };
  const Made none;
  const Made& own = this->Last ? *this->Last : none;
  const auto summaries = join(Exchange(own.Summaries));
  const auto history = join(Exchange(own.History));
  const auto flags = knotwork::Processes::ExchangeNumber(own.IsOfDomains ? 1 : 0);
  if (!summaries.empty())
  {
    this->Tell(summaries, outputs);
  }
  vtkTable* table = vtkTable::GetData(outputs, 2);
  table->Initialize();
  if (knotwork::Processes::Own() == 0)
  {
    FillTable(history, std::count(flags.begin(), flags.end(), 1) > 0, table);
  }
  return {};
}

Status vtkDomainParameterization::Compute(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->Verdict = 0;
  this->Injectivity = 0;
  this->SecondsWithCertificate = 0.0;
  this->Last = std::make_unique<Made>();
  vtkDataObject* boundary = vtkDataObject::GetData(inputs[0], 0);
  vtkDataSet* layout = vtkDataSet::GetData(inputs[1], 0);
  if (auto* drawn = vtkPolyData::SafeDownCast(boundary))
  {
    return drawn->GetNumberOfPoints() > 0 ? this->ParameterizeDrawn(drawn, layout, outputs)
                                          : Status();
  }
  if (!layout)
  {
    const std::vector<knotwork::SplineModel> domains =
      SidesByBlock(boundary, this->KernelThreads());
    if (!domains.empty())
    {
      return this->ParameterizeEach(domains, outputs);
    }
  }
  const auto model = this->DecodeInput(boundary);
  if (!model)
  {
    return model.Status;
  }
  if (model->Patches.empty())
  {
    return {};
  }
  const Status status = model->Patches.front().Geometry.index() == 0
    ? this->Parameterize<2>(model.Value, layout, -1, this->Progress())
    : this->Parameterize<3>(model.Value, layout, -1, this->Progress());
  return status ? this->Encode(outputs) : status;
}

Status vtkDomainParameterization::ParameterizeEach(
  const std::vector<knotwork::SplineModel>& domains, vtkInformationVector* outputs)
{
  this->Last->IsOfDomains = true;
  const auto count = static_cast<double>(domains.size());
  for (std::size_t i = 0; i < domains.size(); ++i)
  {
    const int block = domains[i].Patches.front().Block;
    this->ReportWarnings(domains[i].Warnings);
    const auto progress = [&, whole = this->Progress()](double share)
    { return whole((static_cast<double>(i) + share) / count); };
    const Status status = domains[i].Patches.front().Geometry.index() == 0
      ? this->Parameterize<2>(domains[i], nullptr, block, progress)
      : this->Parameterize<3>(domains[i], nullptr, block, progress);
    if (!status)
    {
      return { status.Code, "block " + std::to_string(block) + ": " + status.Detail };
    }
  }
  return this->Encode(outputs);
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
  Status status = this->Parameterize<2>(model, layout, -1, this->Progress());
  status = status ? this->Encode(outputs) : status;
  vtkUnstructuredGrid* grid = vtkUnstructuredGrid::GetData(outputs, 0);
  using knotwork::AddNumber;
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
Status vtkDomainParameterization::Parameterize(const knotwork::SplineModel& model,
  vtkDataSet* layoutData, int domain, const knotwork::ProgressCallback& progress)
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
  const auto keep =
    [&](const knotwork::DomainReport& report, const auto& map, const auto& firstMap, int functions)
  {
    AddPatches<Dim>(map, height, domain, this->Last->Map);
    AddPatches<Dim>(firstMap, height, domain, this->Last->FirstMap);
    this->Last->Summaries.push_back(knotwork::Summarize(report, functions, map.size()));
    for (const knotwork::DomainIteration& iteration : report.History)
    {
      this->Last->History.push_back({ domain, iteration });
    }
    for (const std::string& message : report.Messages) // those of folds of the boundary first
    {
      vtkWarningMacro(
        "" << (domain < 0 ? std::string() : "block " + std::to_string(domain) + ": ") << message);
    }
    this->SecondsWithCertificate += report.SecondsOptimization + report.SecondsCertificate;
  };
  if (!layoutData)
  {
    const auto result = knotwork::ParameterizeDomain<Dim>({ std::move(sides) }, params, progress);
    if (result)
    {
      const std::vector<knotwork::Spline<Dim>> map{ result->Map };
      const std::vector<knotwork::Spline<Dim>> firstMap{ result->InitialMap };
      keep(result.Value, map, firstMap, result->Map.Space->NumFunctions);
    }
    return result.Status;
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
    knotwork::ParameterizeLayout<Dim>(layout.Value, layoutParams, params, progress);
  if (result)
  {
    keep(result.Value, result->Map.Patches, result->InitialMap.Patches, result->Map.NumFunctions());
  }
  return result.Status;
}

Status vtkDomainParameterization::Encode(vtkInformationVector* outputs)
{
  FillTable(this->Last->History, this->Last->IsOfDomains, vtkTable::GetData(outputs, 2));
  Status status = EncodeSplineGrid(this->Last->Map, vtkUnstructuredGrid::GetData(outputs, 0));
  status = status ? EncodeSplineGrid(this->Last->FirstMap, vtkUnstructuredGrid::GetData(outputs, 1))
                  : status;
  if (status)
  {
    this->Tell(this->Last->Summaries, outputs);
  }
  this->Last->Map = {}; // the outputs have them
  this->Last->FirstMap = {};
  return status;
}

void vtkDomainParameterization::Tell(
  const std::vector<knotwork::DomainSummary>& summaries, vtkInformationVector* outputs)
{
  const knotwork::DomainSummary sum = Combine(summaries);
  this->Verdict = static_cast<int>(sum.Regularity);
  this->Injectivity = static_cast<int>(sum.Injectivity);
  AddSummary(sum, vtkUnstructuredGrid::GetData(outputs, 0));
}
