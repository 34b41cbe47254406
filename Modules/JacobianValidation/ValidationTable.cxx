// SPDX-License-Identifier: BSD-3-Clause
#include "ValidationTable.h"

#include <knotwork/SplineGrid/MergeTables.h>
#include <knotwork/SplineGrid/NamedArray.h>

#include "vtkDoubleArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVariant.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace knotwork
{
namespace
{
/// What a row of the table says.
struct Summary
{
  std::map<Verdict, int> Count;
  int Cells = 0;
  int Degenerate = 0;
  std::int64_t Undecided = -1;               ///< the first such cell, by its number in its grid
  JacobianLimit Limit = JacobianLimit::None; ///< what stopped it
  double Rounding = 0.0;
  double MinLower = std::numeric_limits<double>::infinity();
  double MinUpper = std::numeric_limits<double>::infinity();
  double MaxLower = -std::numeric_limits<double>::infinity();
  double MaxUpper = -std::numeric_limits<double>::infinity();
  double Measure = 0.0;
  double MeasureError = 0.0;
  double ScaledMin = std::numeric_limits<double>::infinity();
  double ScaledSum = 0.0;
  double ConditionMax = 0.0;
  double ConditionSum = 0.0;
  double UniformityMin = std::numeric_limits<double>::infinity();
  double UniformityMax = -std::numeric_limits<double>::infinity();

  void Add(const CellMeasure& cell)
  {
    this->Measure += cell.Measure;
    this->MeasureError += cell.MeasureError;
    this->ScaledMin = std::min(this->ScaledMin, cell.ScaledMin);
    this->ScaledSum += cell.ScaledMean;
    this->ConditionMax = std::max(this->ConditionMax, cell.ConditionMax);
    this->ConditionSum += cell.ConditionMean;
    this->UniformityMin = std::min(this->UniformityMin, cell.UniformityMin);
    this->UniformityMax = std::max(this->UniformityMax, cell.UniformityMax);
  }
  void Add(const CellCertificate& cell, std::int64_t number)
  {
    ++this->Cells;
    ++this->Count[cell.Verdict];
    this->Degenerate += cell.Degenerate != 0 ? 1 : 0;
    if (cell.Verdict == Verdict::Undecided && this->Undecided < 0)
    {
      this->Undecided = number;
      this->Limit = cell.Limit;
    }
    this->Rounding = std::max(this->Rounding, cell.Rounding);
    this->MinLower = std::min(this->MinLower, cell.MinLower);
    this->MinUpper = std::min(this->MinUpper, cell.MinUpper);
    this->MaxLower = std::max(this->MaxLower, cell.MaxLower);
    this->MaxUpper = std::max(this->MaxUpper, cell.MaxUpper);
  }
  Verdict Of()
  {
    return OfCounts(this->Cells, this->Count[Verdict::Valid], this->Count[Verdict::Reversed],
      this->Count[Verdict::Invalid]);
  }
  static Verdict OfCounts(int cells, int valid, int reversed, int invalid)
  {
    if (valid == cells || reversed == cells)
    {
      return valid == cells ? Verdict::Valid : Verdict::Reversed;
    }
    const bool mixed = valid > 0 && reversed > 0;
    return invalid > 0 || mixed ? Verdict::Invalid : Verdict::Undecided;
  }
};

void AddRows(std::map<int, Summary>& patches, Summary& all, bool measures, vtkTable* table)
{
  std::vector<std::pair<int, Summary*>> rows;
  for (auto& [id, summary] : patches)
  {
    rows.emplace_back(id, &summary);
  }
  rows.emplace_back(-1, &all);
  const auto addColumn = [&](auto kind, const char* name, const auto& value)
  {
    using ArrayType = typename decltype(kind)::ElementType;
    table->AddColumn(ArrayOf<ArrayType>(
      name, rows, [&](const auto& row) { return value(row.first, *row.second); }));
  };
  struct Integers
  {
    using ElementType = vtkIntArray;
  };
  struct Reals
  {
    using ElementType = vtkDoubleArray;
  };
  struct Texts
  {
    using ElementType = vtkStringArray;
  };
  const auto counted = [&](const char* name, Verdict verdict)
  { addColumn(Integers(), name, [verdict](int, Summary& s) { return s.Count[verdict]; }); };
  addColumn(Integers(), "PatchId", [](int id, Summary&) { return id; });
  addColumn(Texts(), "Verdict", [](int, Summary& s) { return ToString(s.Of()); });
  addColumn(Integers(), "Cells", [](int, Summary& s) { return s.Cells; });
  counted("ValidCells", Verdict::Valid);
  counted("InvalidCells", Verdict::Invalid);
  counted("UndecidedCells", Verdict::Undecided);
  counted("ReversedCells", Verdict::Reversed);
  addColumn(Integers(), "DegenerateCells", [](int, Summary& s) { return s.Degenerate; });
  addColumn(Texts(), "UndecidedReason", [](int, Summary& s) { return ToString(s.Limit); });
  addColumn(
    Integers(), "UndecidedCell", [](int, Summary& s) { return static_cast<int>(s.Undecided); });
  addColumn(Reals(), "Rounding", [](int, Summary& s) { return s.Rounding; });
  addColumn(Reals(), "JacobianMinLower", [](int, Summary& s) { return s.MinLower; });
  addColumn(Reals(), "JacobianMinUpper", [](int, Summary& s) { return s.MinUpper; });
  addColumn(Reals(), "JacobianMaxLower", [](int, Summary& s) { return s.MaxLower; });
  addColumn(Reals(), "JacobianMaxUpper", [](int, Summary& s) { return s.MaxUpper; });
  if (measures)
  {
    addColumn(Reals(), "Measure", [](int, Summary& s) { return s.Measure; });
    addColumn(Reals(), "MeasureError", [](int, Summary& s) { return s.MeasureError; });
    addColumn(Reals(), "ScaledJacobianMin", [](int, Summary& s) { return s.ScaledMin; });
    addColumn(Reals(), "ScaledJacobianMean", [](int, Summary& s) { return s.ScaledSum / s.Cells; });
    addColumn(Reals(), "ConditionNumberMax", [](int, Summary& s) { return s.ConditionMax; });
    addColumn(
      Reals(), "ConditionNumberMean", [](int, Summary& s) { return s.ConditionSum / s.Cells; });
    addColumn(Reals(), "JacobianOverMeanMin", [](int, Summary& s) { return s.UniformityMin; });
    addColumn(Reals(), "JacobianOverMeanMax", [](int, Summary& s) { return s.UniformityMax; });
  }
}
}

void FillTable(const std::vector<GridPair>& grids, const std::map<int, vtkIdType>& before,
  const std::vector<CellCertificate>& certificates, const std::vector<CellMeasure>& measured,
  vtkTable* table)
{
  std::map<int, Summary> patches;
  Summary all;
  for (const GridPair& grid : grids)
  {
    const auto found = before.find(grid.Block);
    const vtkIdType first = found == before.end() ? 0 : found->second;
    for (vtkIdType i = 0; i < grid.Input->GetNumberOfCells(); ++i)
    {
      const std::size_t cell = grid.FirstCell + static_cast<std::size_t>(i);
      for (Summary* summary : { &patches[PatchOf(grid.Input, i)], &all })
      {
        summary->Add(certificates[cell], first + i);
        if (!measured.empty())
        {
          summary->Add(measured[cell]);
        }
      }
    }
  }
  if (all.Cells > 0)
  {
    AddRows(patches, all, !measured.empty(), table);
  }
}

Verdict MergePieces(vtkTable* table)
{
  MergedTable how;
  how.Key = "PatchId";
  how.Weight = "Cells";
  how.LastKey = -1.0;
  for (const auto& [columns, merging] :
    { std::pair(std::vector<const char*>{ "Cells", "ValidCells", "InvalidCells", "UndecidedCells",
                  "ReversedCells", "DegenerateCells", "Measure", "MeasureError" },
        Merging::Sum),
      std::pair(std::vector<const char*>{ "JacobianMinLower", "JacobianMinUpper",
                  "ScaledJacobianMin", "JacobianOverMeanMin" },
        Merging::Least),
      std::pair(std::vector<const char*>{ "Rounding", "JacobianMaxLower", "JacobianMaxUpper",
                  "ConditionNumberMax", "JacobianOverMeanMax" },
        Merging::Largest),
      std::pair(
        std::vector<const char*>{ "ScaledJacobianMean", "ConditionNumberMean" }, Merging::Mean) })
  {
    for (const char* column : columns)
    {
      how.Columns.push_back({ column, merging });
    }
  }
  MergeTables(table, how);
  Verdict all = Verdict::Undecided;
  for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
  {
    const auto count = [&](const char* column)
    { return table->GetValueByName(row, column).ToInt(); };
    all = Summary::OfCounts(
      count("Cells"), count("ValidCells"), count("ReversedCells"), count("InvalidCells"));
    table->SetValueByName(row, "Verdict", vtkVariant(ToString(all)));
  }
  return all;
}

void FillInjectivity(const InjectivityCertificate& injectivity, bool applicable, vtkTable* table)
{
  const vtkIdType last = table->GetNumberOfRows() - 1;
  const auto addText = [&](const char* name, const std::string& text)
  {
    vtkNew<vtkStringArray> column;
    column->SetName(name);
    column->SetNumberOfValues(last + 1);
    column->SetValue(last, text.c_str());
    table->AddColumn(column);
  };
  const auto addNumber = [&](auto* column, const char* name, auto value)
  {
    column->SetName(name);
    column->SetNumberOfTuples(last + 1);
    column->Fill(0);
    column->SetValue(last, value);
    table->AddColumn(column);
  };
  addText("Injective", applicable ? ToString(injectivity.Verdict) : "not_applicable");
  addText("InjectivityReason", applicable ? ToString(injectivity.Reason) : "");
  vtkNew<vtkIntArray> interfaces;
  addNumber(interfaces.Get(), "Interfaces", injectivity.NumInterfaces);
  vtkNew<vtkIntArray> gaps;
  addNumber(gaps.Get(), "InterfaceGaps", static_cast<int>(injectivity.Gaps.size()));
  double largest = 0.0;
  for (const InterfaceGap& gap : injectivity.Gaps)
  {
    largest = std::max(largest, gap.Size);
  }
  vtkNew<vtkDoubleArray> sizes;
  addNumber(sizes.Get(), "LargestGap", largest);
}
}
