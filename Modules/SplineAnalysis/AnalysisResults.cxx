// SPDX-License-Identifier: BSD-3-Clause
#include "AnalysisResults.h"

#include <knotwork/SplineGrid/SplineBlocks.h>
#include <knotwork/SplineGrid/TableRow.h>

#include "vtkCellArray.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace knotwork
{
namespace
{
/// Columns of ResultFields::GaussValues that are one array.
struct FieldColumns
{
  const char* Name;
  Eigen::Index First;
  Eigen::Index Count;
};

std::vector<FieldColumns> ColumnsOf(GalerkinEquation equation)
{
  if (equation == GalerkinEquation::Poisson)
  {
    return { { "Flux", 0, 3 } };
  }
  return { { "Stress", 0, 6 }, { "VonMisesStress", 6, 1 }, { "PrincipalStress", 7, 3 } };
}

/// Three components, as VTK's vectors have.
PointMatrix WithThreeColumns(const PointMatrix& values)
{
  PointMatrix vectors = PointMatrix::Zero(values.rows(), 3);
  vectors.leftCols(values.cols()) = values;
  return vectors;
}

std::array<double, 3> Vector(const Eigen::VectorXd& values)
{
  std::array<double, 3> vector{};
  std::copy(values.begin(), values.end(), vector.begin());
  return vector;
}

const char* NameOf(ConditionKind kind, bool isPoisson)
{
  switch (kind)
  {
    case ConditionKind::Value:
      return isPoisson ? "value" : "displacement";
    case ConditionKind::Load:
      return isPoisson ? "flux" : "traction";
    case ConditionKind::Pressure:
      return "pressure";
    case ConditionKind::Force:
      break;
  }
  return "force";
}

bool IsPoisson(const AnalysisResults& results)
{
  return results.Problem.Equation == GalerkinEquation::Poisson;
}
std::vector<AnalysisField> PointFields(const AnalysisResults& results)
{
  std::vector<AnalysisField> fields;
  const PointMatrix& coefficients = results.Solution.Coefficients;
  if (IsPoisson(results))
  {
    fields.push_back({ "Solution", coefficients });
  }
  else
  {
    fields.push_back({ "Displacement", WithThreeColumns(coefficients) });
  }
  for (const FieldColumns& columns : ColumnsOf(results.Problem.Equation))
  {
    fields.push_back(
      { columns.Name, results.Fields.Projected.middleCols(columns.First, columns.Count) });
  }
  return fields;
}

std::vector<AnalysisCellField> CellFields(const AnalysisResults& results)
{
  const std::vector<double>& errors = results.Estimate.Elements;
  std::vector<AnalysisCellField> fields{ { "Energy", results.Fields.Energy },
    { "EstimatedError",
      Eigen::Map<const Eigen::VectorXd>(
        errors.data(), static_cast<Eigen::Index>(errors.size())) } };
  if (!IsPoisson(results))
  {
    fields.push_back({ "LargestVonMises", results.Fields.LargestVonMises });
  }
  return fields;
}
}

Status EncodeResults(AnalysisResults& results, vtkDataObject* input, vtkDataObject* output)
{
  const Status status =
    EncodeBody(results.Body, PointFields(results), CellFields(results), input, output);
  for (const auto& [block, grid] : GridsByBlock(output))
  {
    // drawn first, and what Warp By Vector takes
    vtkPointData* data = grid->GetPointData();
    data->SetActiveScalars(IsPoisson(results) ? "Solution" : "VonMisesStress");
    data->SetActiveVectors(IsPoisson(results) ? "Flux" : "Displacement");
  }
  return status;
}

void EncodeGaussPoints(const AnalysisResults& results, vtkPolyData* output)
{
  const ResultFields& fields = results.Fields;
  const Eigen::Index count = fields.GaussPoints.rows();
  const PointMatrix places = WithThreeColumns(fields.GaussPoints);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(count);
  vtkNew<vtkCellArray> cells;
  const auto elements = NamedArray<vtkIdTypeArray>("Cell", 1, count);
  for (Eigen::Index i = 0; i < count; ++i)
  {
    points->SetPoint(i, places.row(i).data());
    const vtkIdType id = i;
    cells->InsertNextCell(1, &id);
    elements->SetValue(
      i, results.Body.Space.Label(fields.GaussElements[static_cast<std::size_t>(i)]));
  }
  output->SetPoints(points);
  output->SetVerts(cells);
  output->GetPointData()->AddArray(elements);
  for (const FieldColumns& columns : ColumnsOf(results.Problem.Equation))
  {
    const PointMatrix values = fields.GaussValues.middleCols(columns.First, columns.Count);
    const auto array =
      NamedArray<vtkDoubleArray>(columns.Name, static_cast<int>(columns.Count), count);
    for (Eigen::Index i = 0; i < count; ++i)
    {
      array->SetTuple(i, values.row(i).data());
    }
    output->GetPointData()->AddArray(array);
  }
}

void EncodeConditions(const AnalysisResults& results, vtkTable* table)
{
  const auto kinds = NamedArray<vtkStringArray>("Kind");
  const auto facets = NamedArray<vtkIntArray>("Facets");
  const auto functions = NamedArray<vtkIntArray>("Functions");
  const auto measures = NamedArray<vtkDoubleArray>("Measure");
  const int components = static_cast<int>(results.Solution.Reactions.cols());
  const auto reactions = NamedArray<vtkDoubleArray>("Reaction", components);
  std::set<int> counted; // functions that conditions share are the first one's
  for (std::size_t i = 0; i < results.Places.size(); ++i)
  {
    const ConditionPlace& place = results.Places[i];
    const ConditionKind kind = results.Description.Conditions[i].Kind;
    const std::vector<int> chosen =
      place.Facets.empty() ? place.Functions : FunctionsOnFacets(results.Body.Space, place.Facets);
    Eigen::VectorXd reaction = Eigen::VectorXd::Zero(components);
    for (const int function : chosen)
    {
      if (kind == ConditionKind::Value && counted.insert(function).second)
      {
        reaction += results.Solution.Reactions.row(function).transpose();
      }
    }
    kinds->InsertNextValue(NameOf(kind, IsPoisson(results)));
    facets->InsertNextValue(static_cast<int>(place.Facets.size()));
    functions->InsertNextValue(static_cast<int>(chosen.size()));
    measures->InsertNextValue(place.Edges.empty() ? FacetMeasure(results.Body.Space, place.Facets)
                                                  : EdgeLength(results.Body.Space, place.Edges));
    reactions->InsertNextTuple(reaction.data());
  }
  table->AddColumn(kinds);
  table->AddColumn(facets);
  table->AddColumn(functions);
  table->AddColumn(measures);
  table->AddColumn(reactions);
}

void EncodeHistory(const std::vector<AdaptiveStep>& history, vtkTable* table)
{
  const auto count = [&](const char* name, int AdaptiveStep::*value)
  {
    table->AddColumn(ArrayOf<vtkIntArray>(
      name, history, [value](const AdaptiveStep& step) { return step.*value; }));
  };
  const auto number = [&](const char* name, double AdaptiveStep::*value)
  {
    table->AddColumn(ArrayOf<vtkDoubleArray>(
      name, history, [value](const AdaptiveStep& step) { return step.*value; }));
  };
  count("Functions", &AdaptiveStep::Functions);
  count("Elements", &AdaptiveStep::Elements);
  number("EstimatedError", &AdaptiveStep::Estimate);
  number("Energy", &AdaptiveStep::Energy);
  count("Marked", &AdaptiveStep::Marked);
}

void EncodeNumbers(const AnalysisResults& results, vtkTable* table)
{
  const GalerkinSolution& solution = results.Solution;
  const GalerkinSpace& space = results.Body.Space;
  AddColumn(table, "Elements", space.NumElements());
  AddColumn(table, "Functions", space.NumFunctions());
  AddColumn(table, "Unknowns", solution.Unknowns);
  AddColumn(table, "Conditions", static_cast<int>(results.Places.size()));
  AddColumn(table, "Energy", solution.Energy);
  AddColumn(table, "Potential", solution.Potential);
  AddColumn(table, "EstimatedError", results.Estimate.Total);
  AddColumn(table, "LargestValue", results.Fields.LargestValue);
  if (!IsPoisson(results))
  {
    AddColumn(table, "LargestVonMises", results.Fields.LargestVonMises.maxCoeff());
  }
  AddColumn(table, IsPoisson(results) ? "PeakFlux" : "PeakStress", results.Fields.Peak);
  AddTuple(table, "PeakPosition", Vector(results.Fields.PeakPosition));
  if (results.Exact)
  {
    const ExactErrors& exact = *results.Exact;
    AddColumn(table, "L2Error", exact.Error.L2);
    AddColumn(table, "H1Error", exact.Error.H1);
    AddColumn(table, "EnergyError", exact.EnergyError);
    AddColumn(table, "ExactL2", exact.Size.L2);
    AddColumn(table, "ExactH1", exact.Size.H1);
    AddColumn(table, "ExactEnergy", exact.EnergySize);
  }
  const double scale = std::max(solution.TotalLoad.cwiseAbs().maxCoeff(),
    solution.Reactions.cwiseAbs().colwise().sum().maxCoeff());
  const double rest = (solution.TotalLoad + solution.TotalReaction).cwiseAbs().maxCoeff();
  AddTuple(table, "TotalLoad", Vector(solution.TotalLoad));
  AddTuple(table, "TotalReaction", Vector(solution.TotalReaction));
  AddColumn(table, "Imbalance", scale > 0.0 ? rest / scale : 0.0);
  AddColumn(table, "Residual", solution.Residual);
  AddColumn(table, "Iterations", solution.Iterations);
}

void EncodeComparison(const std::vector<AnalysisResults>& all,
  const std::vector<std::string>& names, double peak, vtkTable* table)
{
  const auto number = [&](const char* name, const auto& value)
  { table->AddColumn(ArrayOf<vtkDoubleArray>(name, all, value)); };
  const auto count = [&](const char* name, const auto& value)
  { table->AddColumn(ArrayOf<vtkIntArray>(name, all, value)); };
  using R = AnalysisResults;
  const auto bodies = NamedArray<vtkStringArray>("Body");
  const auto positions = NamedArray<vtkDoubleArray>("PeakPosition", 3);
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    bodies->InsertNextValue(names[i]);
    positions->InsertNextTuple(Vector(all[i].Fields.PeakPosition).data());
  }
  table->AddColumn(bodies);
  count("Elements", [](const R& r) { return r.Body.Space.NumElements(); });
  count("Functions", [](const R& r) { return r.Body.Space.NumFunctions(); });
  count("Unknowns", [](const R& r) { return r.Solution.Unknowns; });
  number("Energy", [](const R& r) { return r.Solution.Energy; });
  number("Potential", [](const R& r) { return r.Solution.Potential; });
  number("EstimatedError", [](const R& r) { return r.Estimate.Total; });
  number("Peak", [](const R& r) { return r.Fields.Peak; });
  table->AddColumn(positions);
  if (all.front().Exact)
  {
    number("EnergyError", [](const R& r) { return r.Exact->EnergyError / r.Exact->EnergySize; });
    number("L2Error", [](const R& r) { return r.Exact->Error.L2 / r.Exact->Size.L2; });
  }
  else
  {
    // a(u - u_h, u - u_h) is twice what the potential is above the least
    const GalerkinSolution& best = all.back().Solution;
    number("EnergyError",
      [&](const R& r)
      { return std::sqrt(std::abs(r.Solution.Potential - best.Potential) / best.Energy); });
  }
  const double known = peak > 0.0 ? peak : all.size() > 2 ? all.back().Fields.Peak : 0.0;
  if (known > 0.0)
  {
    number("PeakError", [&](const R& r) { return std::abs(r.Fields.Peak - known) / known; });
  }
}
}
