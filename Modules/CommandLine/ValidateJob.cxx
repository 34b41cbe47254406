// SPDX-License-Identifier: BSD-3-Clause
#include "FilterJob.h"

#include <knotwork/JacobianValidation/vtkJacobianValidator.h>
#include <knotwork/SplineGrid/Processes.h>

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>

#include <iostream>
#include <sstream>

namespace knotwork
{
namespace
{
constexpr int InvalidStatus = 3;
constexpr int UndecidedStatus = 4;

/// A fold and an overlap are both proved, so either makes the map invalid. Where only the
/// injectivity of the whole is open, the cells are valid all the same.
int ExitStatus(const nlohmann::ordered_json& report)
{
  const std::string verdict = report["verdict"];
  const bool overlaps = report.value("injective", "") == "not_injective";
  if (overlaps || verdict == "invalid" || verdict == "reversed")
  {
    return InvalidStatus;
  }
  return verdict == "undecided" ? UndecidedStatus : 0;
}

constexpr std::size_t MostNamed = 100;

/// Numbers in their file of cells that are not valid: of the folded ones, or of all where all are
/// reversed.
std::vector<long long> ElementsNotValid(vtkUnstructuredGrid* grid, bool reversed)
{
  std::vector<long long> elements;
  vtkDataArray* numbers = grid->GetCellData()->GetArray("ElementNumber");
  vtkDataArray* verdicts = grid->GetCellData()->GetArray("JacobianVerdict");
  vtkDataArray* turned = grid->GetCellData()->GetArray("JacobianReversed");
  for (vtkIdType c = 0; c < grid->GetNumberOfCells() && elements.size() < MostNamed; ++c)
  {
    if (verdicts->GetComponent(c, 0) < 0 && (turned->GetComponent(c, 0) != 0) == reversed)
    {
      elements.push_back(static_cast<long long>(numbers->GetComponent(c, 0)));
    }
  }
  return elements;
}

/// ": element 17 is folded", as the file numbers them.
std::string FoldedSentence(const nlohmann::ordered_json& report)
{
  constexpr std::size_t most = 5;
  const auto& elements = report["folded_elements"];
  std::string text;
  for (std::size_t i = 0; i < elements.size() && i < most; ++i)
  {
    text += (i == 0 ? "" : ", ") + std::to_string(elements[i].get<long long>());
  }
  const auto count = report["invalid_cells"].get<std::size_t>();
  return text.empty() ? ""
    : count == 1      ? ": element " + text + " is folded"
                      : ": elements " + text + (count > most ? ", ..." : "") + " are folded";
}

/// Both verdicts, and the reason where the second is neither yes nor without meaning.
std::string Sentence(const nlohmann::ordered_json& report)
{
  std::string text = report["verdict"];
  if (text == "undecided")
  {
    std::ostringstream why;
    why.precision(3);
    why << ": " << report["undecided_reason"].get<std::string>() << " (cell "
        << report["undecided_cell"].get<int>();
    if (report.contains("undecided_element"))
    {
      why << ", element " << report["undecided_element"].get<long long>();
    }
    if (report["rounding"].get<double>() > 0.0)
    {
      why << ", det J down to " << report["min_jacobian_upper"].get<double>()
          << "; coordinates exact to " << report["rounding"].get<double>() << " would decide";
    }
    text += why.str() + ")";
  }
  if (text == "invalid" && report.contains("folded_elements"))
  {
    text += FoldedSentence(report);
  }
  const std::string injective = report.value("injective", "not_applicable");
  if (injective == "injective")
  {
    text += ", injective";
  }
  else if (injective != "not_applicable")
  {
    text += injective == "undecided" ? ", injectivity undecided"
      : injective == "not_injective" ? ", not injective"
                                     : ", injective up to a seam";
    text += ": " + report["injectivity_reason"].get<std::string>();
  }
  return text;
}

class ValidateJob : public FilterJob<vtkJacobianValidator>
{
public:
  explicit ValidateJob(CLI::App& app) : FilterJob(app)
  {
    this->AddInput(0, "input",
      "grid of Bezier, Lagrange, linear or quadratic cells (.vtu .vtpc .vtk .mesh .msh .inp)");
    this->Divide(0, Share::Cells);
    this
      ->AddOutput(
        0, "--output", Endings::Splines, "the grid with verdicts and bounds as cell arrays")
      ->required(false);
    this->AddOutput(1, "--witnesses", Endings::Grid, "points and boxes where cells are invalid");
    this->AddOutput(2, "--table", Endings::Table, "the verdict of every patch and of all");
    this->AddProperties();
  }

protected:
  Status Prepare(Session& session) override
  {
    return session.CheckGridFormat(this->Input(0), this->MainOutput());
  }

  /// Elements are named by their numbers in the file.
  bool NeedsWholeOutput() const override
  {
    auto* grid = vtkUnstructuredGrid::SafeDownCast(this->Input(0));
    return grid && grid->GetCellData()->HasArray("ElementNumber") != 0;
  }

  Status AddNumbers(Session& session) override
  {
    if (Session::Total(this->Input(0)->GetNumberOfElements(vtkDataObject::CELL)) == 0)
    {
      return { ErrorCode::EmptyInput, "'" + this->InputFile(0) + "' has no cells to validate" };
    }
    nlohmann::ordered_json& report = session.Report;
    vtkTable* table = this->Table(2);
    const vtkIdType all = table->GetNumberOfRows() - 1;
    const auto number = [&](const char* column)
    { return table->GetValueByName(all, column).ToDouble(); };
    const auto count = [&](const char* column)
    { return table->GetValueByName(all, column).ToTypeInt64(); };
    report["verdict"] = table->GetValueByName(all, "Verdict").ToString();
    report["cells"] = count("Cells");
    report["valid_cells"] = count("ValidCells");
    report["invalid_cells"] = count("InvalidCells");
    report["undecided_cells"] = count("UndecidedCells");
    report["reversed_cells"] = count("ReversedCells");
    report["degenerate_cells"] = count("DegenerateCells");
    report["undecided_reason"] = table->GetValueByName(all, "UndecidedReason").ToString();
    report["undecided_cell"] = nullptr;
    if (const int cell = table->GetValueByName(all, "UndecidedCell").ToInt(); cell >= 0)
    {
      report["undecided_cell"] = cell;
    }
    report["rounding"] = number("Rounding");
    report["min_jacobian_lower"] = number("JacobianMinLower");
    report["min_jacobian_upper"] = number("JacobianMinUpper");
    report["max_jacobian_lower"] = number("JacobianMaxLower");
    report["max_jacobian_upper"] = number("JacobianMaxUpper");
    if (this->Filter->GetMeasures())
    {
      report["measure"] = number("Measure");
      report["measure_error"] = number("MeasureError");
      report["min_scaled_jacobian"] = number("ScaledJacobianMin");
      report["mean_scaled_jacobian"] = number("ScaledJacobianMean");
      report["max_condition_number"] = number("ConditionNumberMax");
      report["mean_condition_number"] = number("ConditionNumberMean");
    }
    if (this->Filter->GetInjectivity())
    {
      report["injective"] = table->GetValueByName(all, "Injective").ToString();
      report["injectivity_reason"] = table->GetValueByName(all, "InjectivityReason").ToString();
      report["interfaces"] = count("Interfaces");
      report["interface_gaps"] = count("InterfaceGaps");
      report["largest_gap"] = number("LargestGap");
    }
    report["witness"] = nullptr;
    auto* witnesses = vtkUnstructuredGrid::SafeDownCast(this->Filter->GetOutputDataObject(1));
    if (witnesses->GetNumberOfCells() > 0)
    {
      double x[3];
      witnesses->GetPoint(0, x);
      const double* u = witnesses->GetPointData()->GetArray("LocalParameters")->GetTuple3(0);
      report["witness"] = std::vector<double>{ x[0], x[1], x[2] };
      report["witness_cell"] =
        static_cast<long long>(witnesses->GetCellData()->GetArray("CellId")->GetTuple1(0));
      report["witness_parameters"] = std::vector<double>{ u[0], u[1], u[2] };
    }
    auto* grid = vtkUnstructuredGrid::SafeDownCast(this->Filter->GetOutputDataObject(0));
    if (Processes::Own() != 0)
    {
      return {}; // the first process has the whole, and speaks
    }
    if (grid && grid->GetCellData()->GetArray("ElementNumber"))
    {
      this->NameElements(grid, report);
    }
    session.ExitStatus = ExitStatus(report);
    if (!session.Quiet)
    {
      std::cout << Sentence(report) << "\n";
    }
    return {};
  }

private:
  /// By their numbers in the file that they were read from.
  static void NameElements(vtkUnstructuredGrid* grid, nlohmann::ordered_json& report)
  {
    vtkDataArray* numbers = grid->GetCellData()->GetArray("ElementNumber");
    const auto name = [&](const char* cell, const char* element)
    {
      if (report.contains(cell) && !report[cell].is_null())
      {
        report[element] =
          static_cast<long long>(numbers->GetComponent(report[cell].get<vtkIdType>(), 0));
      }
    };
    name("undecided_cell", "undecided_element");
    name("witness_cell", "witness_element");
    report["folded_elements"] = ElementsNotValid(grid, false);
    report["reversed_elements"] = ElementsNotValid(grid, true);
  }
};

const JobRegistration Registration{ "validate", "prove a grid valid or show where it is not",
  "plate.vtu --report valid.json", MakeJob<ValidateJob>, JobProcesses::Several };
}
}
