// SPDX-License-Identifier: BSD-3-Clause
#include "vtkJacobianValidator.h"

#include "CellsFromGrid.h"
#include <knotwork/JacobianValidation/CellMaps.h>
#include <knotwork/JacobianValidation/CellMeasures.h>
#include <knotwork/JacobianValidation/JacobianCertificate.h>
#include <knotwork/SplineGrid/NamedArray.h>

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <map>

using knotwork::CellCertificate;
using knotwork::Status;
using knotwork::Verdict;

vtkStandardNewMacro(vtkJacobianValidator);

namespace
{
/// A grid of the input and the one of the output that it becomes.
struct GridPair
{
  vtkUnstructuredGrid* Input = nullptr;
  vtkUnstructuredGrid* Output = nullptr;
  int Block = 0;
  std::size_t FirstCell = 0; ///< of the certificate
};

/// Output 0 as a shallow copy of the input, and the grids in it.
std::vector<GridPair> CopyInput(vtkDataObject* input, vtkDataObject* output)
{
  std::vector<GridPair> pairs;
  output->ShallowCopy(input);
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(output))
  {
    pairs.push_back({ vtkUnstructuredGrid::SafeDownCast(input), grid, 0, 0 });
    return pairs;
  }
  auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(output);
  auto* from = vtkPartitionedDataSetCollection::SafeDownCast(input);
  for (unsigned int b = 0; collection && b < from->GetNumberOfPartitionedDataSets(); ++b)
  {
    vtkPartitionedDataSet* block = from->GetPartitionedDataSet(b);
    vtkNew<vtkPartitionedDataSet> copy;
    copy->ShallowCopy(block);
    for (unsigned int i = 0; block && i < block->GetNumberOfPartitions(); ++i)
    {
      if (auto* grid = vtkUnstructuredGrid::SafeDownCast(block->GetPartition(i)))
      {
        vtkNew<vtkUnstructuredGrid> made;
        made->ShallowCopy(grid);
        copy->SetPartition(i, made);
        pairs.push_back({ grid, made, static_cast<int>(b), 0 });
      }
    }
    collection->SetPartitionedDataSet(b, copy);
  }
  return pairs;
}

/// The grid of a cell of the certificate.
const GridPair& OwnerOf(const std::vector<GridPair>& grids, std::size_t cell)
{
  return *std::prev(std::upper_bound(grids.begin(), grids.end(), cell,
    [](std::size_t i, const GridPair& grid) { return i < grid.FirstCell; }));
}

template <typename ArrayType, typename Cell, typename ValueFunction>
void AddCellArray(const GridPair& grid, const char* name, const std::vector<Cell>& cells,
  const ValueFunction& value)
{
  const vtkIdType n = grid.Output->GetNumberOfCells();
  const auto array = knotwork::NamedArray<ArrayType>(name, 1, n);
  for (vtkIdType i = 0; i < n; ++i)
  {
    array->SetValue(i, value(cells[grid.FirstCell + static_cast<std::size_t>(i)]));
  }
  grid.Output->GetCellData()->AddArray(array);
}

/// As in the array JacobianVerdict.
int VerdictNumber(Verdict verdict)
{
  return verdict == Verdict::Valid ? 1 : verdict == Verdict::Undecided ? 0 : -1;
}

void AddCellArrays(const GridPair& grid, const std::vector<CellCertificate>& cells)
{
  using Cell = CellCertificate;
  AddCellArray<vtkIntArray>(
    grid, "JacobianVerdict", cells, [](const Cell& cell) { return VerdictNumber(cell.Verdict); });
  AddCellArray<vtkIntArray>(grid, "JacobianReversed", cells,
    [](const Cell& cell) { return cell.Verdict == Verdict::Reversed ? 1 : 0; });
  AddCellArray<vtkIntArray>(grid, "JacobianDegenerate", cells,
    [](const Cell& cell) { return cell.Degenerate != 0 ? 1 : 0; });
  AddCellArray<vtkIntArray>(
    grid, "JacobianLimit", cells, [](const Cell& cell) { return static_cast<int>(cell.Limit); });
  AddCellArray<vtkDoubleArray>(
    grid, "JacobianMinLower", cells, [](const Cell& cell) { return cell.MinLower; });
  AddCellArray<vtkDoubleArray>(
    grid, "JacobianMinUpper", cells, [](const Cell& cell) { return cell.MinUpper; });
  AddCellArray<vtkDoubleArray>(
    grid, "JacobianMaxLower", cells, [](const Cell& cell) { return cell.MaxLower; });
  AddCellArray<vtkDoubleArray>(
    grid, "JacobianMaxUpper", cells, [](const Cell& cell) { return cell.MaxUpper; });
  // What is drawn in colours when nothing else is asked for.
  grid.Output->GetCellData()->SetActiveScalars("JacobianVerdict");
  grid.Output->GetPointData()->SetActiveScalars(nullptr);
}

/// Value of the cell array PatchId, 0 without one.
int PatchOf(vtkUnstructuredGrid* grid, vtkIdType cell)
{
  vtkDataArray* ids = grid->GetCellData()->GetArray("PatchId");
  return ids && ids->GetNumberOfTuples() > cell ? static_cast<int>(ids->GetComponent(cell, 0)) : 0;
}

/// Volume of a cell's box in the domain of its patch, from the cell array ParametricBounds; 1
/// without one.
double ParametricVolume(vtkUnstructuredGrid* grid, vtkIdType cell, int parameters)
{
  vtkDataArray* bounds = grid->GetCellData()->GetArray("ParametricBounds");
  double volume = 1.0;
  for (int d = 0; bounds && bounds->GetNumberOfComponents() == 6 && d < parameters; ++d)
  {
    volume *= bounds->GetComponent(cell, 2 * d + 1) - bounds->GetComponent(cell, 2 * d);
  }
  return volume > 0.0 ? volume : 1.0;
}

/// Measures of all cells: those of every plane's map, of volumes, and of surfaces and curves in
/// space by themselves.
knotwork::Result<std::vector<knotwork::CellMeasure>> Measure(const knotwork::BernsteinCells& cells,
  const knotwork::CellMaps& maps, const std::vector<GridPair>& grids,
  knotwork::CellMeasuresParams params)
{
  std::vector<knotwork::CellMeasure> measures(static_cast<std::size_t>(cells.NumCells()));
  const auto add = [&](const std::vector<int>& which, int components) -> Status
  {
    if (which.empty())
    {
      return {};
    }
    params.ParametricVolumes.clear();
    for (const int cell : which)
    {
      const GridPair& owner = OwnerOf(grids, static_cast<std::size_t>(cell));
      params.ParametricVolumes.push_back(
        ParametricVolume(owner.Input, cell - static_cast<vtkIdType>(owner.FirstCell),
          NumParameters(cells.Shapes[static_cast<std::size_t>(cell)])));
    }
    const auto measured = MeasureCells(SelectCells(cells, which, components), params);
    if (!measured)
    {
      return measured.Status;
    }
    for (std::size_t i = 0; i < which.size(); ++i)
    {
      measures[static_cast<std::size_t>(which[i])] = measured->Cells[i];
    }
    return {};
  };
  std::vector<std::pair<std::vector<int>, int>> lists; // and how many components they need
  for (const auto& plane : maps.Planes)
  {
    lists.emplace_back(plane, 2);
  }
  lists.emplace_back(maps.Volumes, 3);
  for (const int parameters : { 1, 2 })
  {
    lists.emplace_back();
    lists.back().second = 3;
    std::copy_if(maps.Others.begin(), maps.Others.end(), std::back_inserter(lists.back().first),
      [&](int cell)
      { return NumParameters(cells.Shapes[static_cast<std::size_t>(cell)]) == parameters; });
  }
  for (const auto& [which, components] : lists)
  {
    if (Status status = add(which, components); !status)
    {
      return status;
    }
  }
  return measures;
}

/// How the cells of the grids fit together.
knotwork::CellComplex ComplexOf(
  const knotwork::GridCells& cells, const std::vector<GridPair>& grids)
{
  knotwork::CellComplex complex;
  const auto all = [&](const char* name)
  {
    return std::all_of(grids.begin(), grids.end(),
      [name](const GridPair& grid)
      { return grid.Input->GetCellData()->GetArray(name) != nullptr; });
  };
  if (all("PatchId"))
  {
    std::map<std::pair<int, int>, int> numbers; // blocks may use the same ids
    for (const GridPair& grid : grids)
    {
      for (vtkIdType i = 0; i < grid.Input->GetNumberOfCells(); ++i)
      {
        const std::pair<int, int> key(grid.Block, PatchOf(grid.Input, i));
        complex.Patches.push_back(
          numbers.emplace(key, static_cast<int>(numbers.size())).first->second);
      }
    }
  }
  if (all("ParametricBounds") && all("PatchId"))
  {
    for (const GridPair& grid : grids)
    {
      vtkDataArray* bounds = grid.Input->GetCellData()->GetArray("ParametricBounds");
      for (vtkIdType i = 0; i < grid.Input->GetNumberOfCells(); ++i)
      {
        knotwork::ParametricBox<3> box;
        for (int d = 0; d < 3 && bounds->GetNumberOfComponents() == 6; ++d)
        {
          const auto direction = static_cast<std::size_t>(d);
          box.Lower[direction] = bounds->GetComponent(i, 2 * d);
          box.Upper[direction] = bounds->GetComponent(i, 2 * d + 1);
        }
        complex.Boxes.push_back(box);
      }
    }
  }
  const bool known = std::all_of(
    cells.Points.begin(), cells.Points.end(), [](vtkIdType point) { return point >= 0; });
  if (known && !complex.Patches.empty())
  {
    vtkIdType firstPoint = 0;
    std::size_t coefficient = 0;
    for (std::size_t g = 0; g < grids.size(); ++g)
    {
      const std::size_t next =
        g + 1 < grids.size() ? grids[g + 1].FirstCell : cells.FirstPoint.size();
      const std::size_t end =
        next < cells.FirstPoint.size() ? cells.FirstPoint[next] : cells.Points.size();
      for (; coefficient < end; ++coefficient)
      {
        complex.PointIds.push_back(firstPoint + cells.Points[coefficient]);
      }
      firstPoint += grids[g].Input->GetNumberOfPoints();
    }
  }
  return complex;
}

/// VTK's linear cell of a shape; its corners in the order of CornerParameters are those of VTK but
/// for quadrilaterals and hexahedra, where VTK goes around.
int LinearCellType(knotwork::CellShape shape)
{
  constexpr int types[knotwork::NumCellShapes] = { VTK_LINE, VTK_QUAD, VTK_HEXAHEDRON, VTK_TRIANGLE,
    VTK_TETRA, VTK_WEDGE };
  return types[static_cast<int>(shape)];
}
std::size_t CornerOfVtk(knotwork::CellShape shape, std::size_t corner)
{
  const bool around =
    shape == knotwork::CellShape::Quadrilateral || shape == knotwork::CellShape::Hexahedron;
  return around ? corner ^ (corner >> 1 & 1) : corner;
}

/// Output 1.
void ShowWitnesses(const knotwork::BernsteinCells& cells,
  const knotwork::JacobianCertificate& certificate,
  const knotwork::InjectivityCertificate& injectivity, const std::vector<GridPair>& grids,
  vtkUnstructuredGrid* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> parameters;
  parameters->SetName("LocalParameters");
  parameters->SetNumberOfComponents(3);
  vtkNew<vtkIdTypeArray> cellIds;
  cellIds->SetName("CellId");
  vtkNew<vtkIntArray> blocks;
  blocks->SetName("Block");
  vtkNew<vtkIntArray> patches;
  patches->SetName("PatchId");
  vtkNew<vtkDoubleArray> uppers;
  uppers->SetName("JacobianUpper");
  vtkNew<vtkIntArray> kinds;
  kinds->SetName("Kind");
  output->Allocate(static_cast<vtkIdType>(2 * certificate.Witnesses.size() + 2));

  vtkNew<vtkIdTypeArray> elements; // in the file, where cells know
  elements->SetName("ElementNumber");
  bool haveNumbers = false;
  const auto addPoint = [&](int cell, const std::array<double, 3>& at)
  {
    double x[3] = {};
    EvaluateCell(cells, cell, at, x);
    parameters->InsertNextTuple(at.data());
    return points->InsertNextPoint(x);
  };
  const auto addCell =
    [&](int kind, int cell, double upper, int type, vtkIdType count, const vtkIdType* ids)
  {
    const GridPair& owner = OwnerOf(grids, static_cast<std::size_t>(cell));
    const vtkIdType local = cell - static_cast<vtkIdType>(owner.FirstCell);
    output->InsertNextCell(type, count, ids);
    kinds->InsertNextValue(kind);
    cellIds->InsertNextValue(local);
    blocks->InsertNextValue(owner.Block);
    patches->InsertNextValue(PatchOf(owner.Input, local));
    uppers->InsertNextValue(upper);
    vtkDataArray* numbers = owner.Input->GetCellData()->GetArray("ElementNumber");
    haveNumbers = haveNumbers || numbers;
    elements->InsertNextValue(
      numbers ? static_cast<vtkIdType>(numbers->GetComponent(local, 0)) : -1);
  };
  for (const knotwork::JacobianWitness& witness : certificate.Witnesses)
  {
    const vtkIdType vertex = addPoint(witness.Cell, witness.Parameters);
    addCell(
      vtkJacobianValidator::FOLDED_POINT, witness.Cell, witness.Upper, VTK_VERTEX, 1, &vertex);
    if (witness.NumCorners > 0)
    {
      const knotwork::CellShape shape = cells.Shapes[static_cast<std::size_t>(witness.Cell)];
      std::array<vtkIdType, 8> corners{};
      for (std::size_t c = 0; c < static_cast<std::size_t>(witness.NumCorners); ++c)
      {
        corners[c] = addPoint(witness.Cell, witness.Corners[CornerOfVtk(shape, c)]);
      }
      addCell(vtkJacobianValidator::FOLDED_BOX, witness.Cell, witness.Upper, LinearCellType(shape),
        witness.NumCorners, corners.data());
    }
  }
  if (injectivity.Verdict == knotwork::InjectivityVerdict::NotInjective &&
    injectivity.Reason == knotwork::InjectivityReason::Overlap && injectivity.HasWitness)
  {
    for (const auto& place : injectivity.Witness.Places)
    {
      const vtkIdType vertex = addPoint(place.Cell, place.Parameters);
      const auto& cell = certificate.Cells[static_cast<std::size_t>(place.Cell)];
      addCell(vtkJacobianValidator::OVERLAP, place.Cell, cell.MaxUpper, VTK_VERTEX, 1, &vertex);
    }
  }
  output->SetPoints(points);
  output->GetPointData()->AddArray(parameters);
  output->GetCellData()->AddArray(kinds);
  output->GetCellData()->AddArray(cellIds);
  output->GetCellData()->AddArray(blocks);
  output->GetCellData()->AddArray(patches);
  output->GetCellData()->AddArray(uppers);
  if (haveNumbers)
  {
    output->GetCellData()->AddArray(elements);
  }
}

/// What a row of the table says.
struct Summary
{
  std::map<Verdict, int> Count;
  int Cells = 0;
  int Degenerate = 0;
  int Undecided = -1; ///< the first such cell, by its number in its grid
  knotwork::JacobianLimit Limit = knotwork::JacobianLimit::None; ///< what stopped it
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

  void Add(const knotwork::CellMeasure& cell)
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
  void Add(const CellCertificate& cell, vtkIdType number)
  {
    ++this->Cells;
    ++this->Count[cell.Verdict];
    this->Degenerate += cell.Degenerate != 0 ? 1 : 0;
    if (cell.Verdict == Verdict::Undecided && this->Undecided < 0)
    {
      this->Undecided = static_cast<int>(number);
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
    if (this->Count[Verdict::Valid] == this->Cells)
    {
      return Verdict::Valid;
    }
    if (this->Count[Verdict::Reversed] == this->Cells)
    {
      return Verdict::Reversed;
    }
    const bool mixed = this->Count[Verdict::Valid] > 0 && this->Count[Verdict::Reversed] > 0;
    return this->Count[Verdict::Invalid] > 0 || mixed ? Verdict::Invalid : Verdict::Undecided;
  }
};

/// Output 2.
void FillTable(std::map<int, Summary>& patches, Summary& all, bool measures, vtkTable* table)
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
    table->AddColumn(knotwork::ArrayOf<ArrayType>(
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
  addColumn(Integers(), "UndecidedCell", [](int, Summary& s) { return s.Undecided; });
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

/// Columns of output 2 that only the last row has.
void FillInjectivity(
  const knotwork::InjectivityCertificate& injectivity, bool applicable, vtkTable* table)
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
  for (const knotwork::InterfaceGap& gap : injectivity.Gaps)
  {
    largest = std::max(largest, gap.Size);
  }
  vtkNew<vtkDoubleArray> sizes;
  addNumber(sizes.Get(), "LargestGap", largest);
}
}

vtkJacobianValidator::vtkJacobianValidator()
{
  this->SetNumberOfOutputPorts(3);
}

int vtkJacobianValidator::FillOutputPortInformation(int port, vtkInformation* info)
{
  if (port == 0)
  {
    return this->Superclass::FillOutputPortInformation(port, info);
  }
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 1 ? "vtkUnstructuredGrid" : "vtkTable");
  return 1;
}

int vtkJacobianValidator::RequestDataObject(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->Superclass::RequestDataObject(request, inputs, outputs);
  return this->MakeDeclaredOutputs(outputs);
}

Status vtkJacobianValidator::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->Verdict = 0;
  std::vector<GridPair> grids =
    CopyInput(vtkDataObject::GetData(inputs[0], 0), vtkDataObject::GetData(outputs, 0));
  std::vector<vtkUnstructuredGrid*> sources;
  std::size_t firstCell = 0;
  for (GridPair& grid : grids)
  {
    grid.FirstCell = firstCell;
    firstCell += static_cast<std::size_t>(grid.Input->GetNumberOfCells());
    sources.push_back(grid.Input);
  }
  if (firstCell == 0)
  {
    return {};
  }
  const auto read = knotwork::ReadGridCells(sources);
  if (!read)
  {
    return read.Status;
  }
  knotwork::JacobianParams params;
  params.RelativeGap = this->RelativeGap;
  params.ComputeMax = this->BoundMaximum;
  params.MaxBoxes = this->MaximumBoxes;
  params.Threads = this->KernelThreads();
  const knotwork::BernsteinCells& cells = read->Cells;
  const knotwork::CellComplex complex = ComplexOf(read.Value, grids);
  const knotwork::CellMaps maps = FindCellMaps(cells, complex.Patches);
  const auto certificate = ValidateMaps(cells, maps, params, this->Progress());
  if (!certificate)
  {
    return certificate.Status;
  }
  knotwork::InjectivityCertificate injectivity;
  if (this->Injectivity && maps.HasMaps())
  {
    knotwork::InjectivityParams injectivityParams;
    injectivityParams.MaxBoxes = this->MaximumBoxes;
    injectivityParams.Threads = this->KernelThreads();
    auto proved = ProveMapsInjective(
      cells, maps, complex, certificate.Value, injectivityParams, this->Progress());
    if (!proved)
    {
      return proved.Status;
    }
    injectivity = std::move(proved.Value);
  }
  std::vector<knotwork::CellMeasure> measures;
  if (this->Measures)
  {
    knotwork::CellMeasuresParams measuresParams;
    measuresParams.SamplesPerEdge = this->SamplesPerEdge;
    measuresParams.BoundBoxes = 0;
    measuresParams.Threads = this->KernelThreads();
    auto measured = Measure(cells, maps, grids, measuresParams);
    if (!measured)
    {
      return measured.Status;
    }
    measures = std::move(measured.Value);
  }
  std::map<int, Summary> patches;
  Summary all;
  for (const GridPair& grid : grids)
  {
    AddCellArrays(grid, certificate->Cells);
    if (this->Measures)
    {
      using Cell = knotwork::CellMeasure;
      AddCellArray<vtkDoubleArray>(
        grid, "CellMeasure", measures, [](const Cell& cell) { return cell.Measure; });
      AddCellArray<vtkDoubleArray>(
        grid, "CellMeasureError", measures, [](const Cell& cell) { return cell.MeasureError; });
      AddCellArray<vtkDoubleArray>(
        grid, "ScaledJacobianMin", measures, [](const Cell& cell) { return cell.ScaledMin; });
    }
    for (vtkIdType i = 0; i < grid.Input->GetNumberOfCells(); ++i)
    {
      const std::size_t cell = grid.FirstCell + static_cast<std::size_t>(i);
      for (Summary* summary : { &patches[PatchOf(grid.Input, i)], &all })
      {
        summary->Add(certificate->Cells[cell], i);
        if (this->Measures)
        {
          summary->Add(measures[cell]);
        }
      }
    }
  }
  vtkTable* table = vtkTable::GetData(outputs, 2);
  FillTable(patches, all, this->Measures, table);
  if (this->Injectivity)
  {
    FillInjectivity(injectivity, maps.HasMaps(), table);
  }
  ShowWitnesses(
    cells, certificate.Value, injectivity, grids, vtkUnstructuredGrid::GetData(outputs, 1));
  this->Verdict = static_cast<int>(certificate->Verdict);
  return {};
}
