// SPDX-License-Identifier: BSD-3-Clause
#include "vtkJacobianValidator.h"

#include "CellsFromGrid.h"
#include "ValidationPieces.h"
#include <knotwork/JacobianValidation/CellMaps.h>
#include <knotwork/JacobianValidation/CellMeasures.h>
#include <knotwork/JacobianValidation/JacobianCertificate.h>
#include <knotwork/SplineGrid/MergeTables.h>
#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineGrid/Processes.h>

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
#include "vtkVariant.h"

#include <algorithm>
#include <cmath>
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

/// The grids of the input, with their blocks.
std::vector<std::pair<int, vtkUnstructuredGrid*>> GridsOf(vtkDataObject* input)
{
  std::vector<std::pair<int, vtkUnstructuredGrid*>> grids;
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(input))
  {
    grids.emplace_back(0, grid);
  }
  auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(input);
  for (unsigned int b = 0; collection && b < collection->GetNumberOfPartitionedDataSets(); ++b)
  {
    vtkPartitionedDataSet* block = collection->GetPartitionedDataSet(b);
    for (unsigned int i = 0; block && i < block->GetNumberOfPartitions(); ++i)
    {
      if (auto* grid = vtkUnstructuredGrid::SafeDownCast(block->GetPartition(i)))
      {
        grids.emplace_back(static_cast<int>(b), grid);
      }
    }
  }
  return grids;
}

/// Output 0 as a shallow copy of the input; its grids become the outputs of the pairs.
void CopyInput(vtkDataObject* input, vtkDataObject* output, std::vector<GridPair>& pairs)
{
  output->ShallowCopy(input);
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(output))
  {
    pairs.front().Output = grid;
    return;
  }
  auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(output);
  auto* from = vtkPartitionedDataSetCollection::SafeDownCast(input);
  auto next = pairs.begin();
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
        (next++)->Output = made;
      }
    }
    collection->SetPartitionedDataSet(b, copy);
  }
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

/// Cells whose det J is compared with the mean over all of them: those of a plane's map, volumes,
/// and surfaces and curves in space.
struct MeasuredCells
{
  int Parameters = 0;
  int Components = 3;
  double Height = 0.0;  ///< of a plane
  double Measure = 0.0; ///< sums
  double ParametricVolume = 0.0;

  bool IsLike(const MeasuredCells& other) const
  {
    constexpr double tolerance = 1e-12; // planes are told apart by rounding alone
    return this->Parameters == other.Parameters && this->Components == other.Components &&
      std::abs(this->Height - other.Height) <= tolerance * std::abs(this->Height);
  }
};

struct Measurement
{
  std::vector<knotwork::CellMeasure> Cells;
  std::vector<MeasuredCells> Lists;
  std::vector<std::vector<int>> CellsOfLists;

  /// Of pieces: det J over the mean of the cells of all of them.
  /// @pre all processes call it.
  void CompareWithAll()
  {
    const auto all = knotwork::Processes::Exchange(this->Lists);
    for (std::size_t i = 0; i < this->Lists.size(); ++i)
    {
      const MeasuredCells& own = this->Lists[i];
      double measure = 0.0;
      double volume = 0.0;
      for (const std::vector<MeasuredCells>& lists : all)
      {
        for (const MeasuredCells& list : lists)
        {
          measure += own.IsLike(list) ? list.Measure : 0.0;
          volume += own.IsLike(list) ? list.ParametricVolume : 0.0;
        }
      }
      const double factor = own.Measure / own.ParametricVolume / (measure / volume);
      for (const int cell : this->CellsOfLists[i])
      {
        knotwork::CellMeasure& m = this->Cells[static_cast<std::size_t>(cell)];
        m.UniformityMin *= factor;
        m.UniformityMax *= factor;
        if (m.UniformityMin > m.UniformityMax)
        {
          std::swap(m.UniformityMin, m.UniformityMax); // a negative mean turns the order round
        }
      }
    }
  }
};

knotwork::Result<Measurement> Measure(const knotwork::BernsteinCells& cells,
  const knotwork::CellMaps& maps, const std::vector<GridPair>& grids,
  knotwork::CellMeasuresParams params)
{
  Measurement found;
  found.Cells.resize(static_cast<std::size_t>(cells.NumCells()));
  const auto add = [&](std::vector<int> which, MeasuredCells list) -> Status
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
      list.ParametricVolume += params.ParametricVolumes.back();
    }
    const auto measured = MeasureCells(SelectCells(cells, which, list.Components), params);
    if (!measured)
    {
      return measured.Status;
    }
    for (std::size_t i = 0; i < which.size(); ++i)
    {
      found.Cells[static_cast<std::size_t>(which[i])] = measured->Cells[i];
    }
    list.Measure = measured->Total.Measure;
    found.Lists.push_back(list);
    found.CellsOfLists.push_back(std::move(which));
    return {};
  };
  Status status;
  for (const auto& plane : maps.Planes)
  {
    double x[3] = {};
    EvaluateCell(cells, plane.front(), {}, x);
    status = status ? add(plane, { 2, 2, x[2] }) : status;
  }
  status = status ? add(maps.Volumes, { 3, 3 }) : status;
  for (const int parameters : { 1, 2 })
  {
    std::vector<int> others;
    std::copy_if(maps.Others.begin(), maps.Others.end(), std::back_inserter(others),
      [&](int cell)
      { return NumParameters(cells.Shapes[static_cast<std::size_t>(cell)]) == parameters; });
    status = status ? add(std::move(others), { parameters, 3 }) : status;
  }
  return status ? knotwork::Result<Measurement>(std::move(found)) : status;
}

/// Whether all grids have a cell array.
bool HaveCellArray(const std::vector<GridPair>& grids, const char* name)
{
  return std::all_of(grids.begin(), grids.end(),
    [name](const GridPair& grid) { return grid.Input->GetCellData()->GetArray(name) != nullptr; });
}

/// How the cells of the grids fit together.
/// @param isPiece  points are known by their global ids alone.
knotwork::CellComplex ComplexOf(
  const knotwork::GridCells& cells, const std::vector<GridPair>& grids, bool isPiece)
{
  knotwork::CellComplex complex;
  const auto all = [&](const char* name) { return HaveCellArray(grids, name); };
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
  const bool known = std::all_of(cells.Points.begin(), cells.Points.end(),
                       [](vtkIdType point) { return point >= 0; }) &&
    (!isPiece ||
      std::all_of(grids.begin(), grids.end(),
        [](const GridPair& grid) { return grid.Input->GetPointData()->GetGlobalIds(); }));
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
      vtkDataArray* ids = isPiece ? grids[g].Input->GetPointData()->GetGlobalIds() : nullptr;
      for (; coefficient < end; ++coefficient)
      {
        const vtkIdType point = cells.Points[coefficient];
        complex.PointIds.push_back(
          ids ? static_cast<vtkIdType>(ids->GetComponent(point, 0)) : firstPoint + point);
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

using Names = std::function<knotwork::CellName(int)>;

/// By what the cells of grids are called.
/// @param before  cells of their blocks in pieces before these grids.
Names NamesOf(const std::vector<GridPair>& grids, const std::map<int, vtkIdType>& before)
{
  return [&grids, &before](int cell)
  {
    const GridPair& owner = OwnerOf(grids, static_cast<std::size_t>(cell));
    const vtkIdType local = cell - static_cast<vtkIdType>(owner.FirstCell);
    const auto first = before.find(owner.Block);
    vtkDataArray* numbers = owner.Input->GetCellData()->GetArray("ElementNumber");
    knotwork::CellName name;
    name.Number = local + (first == before.end() ? 0 : first->second);
    name.Block = owner.Block;
    name.Patch = PatchOf(owner.Input, local);
    name.Element = numbers ? static_cast<std::int64_t>(numbers->GetComponent(local, 0)) : -1;
    return name;
  };
}

/// Output 1, cell by cell.
class WitnessGrid
{
public:
  WitnessGrid(const knotwork::BernsteinCells& cells, Names names, vtkUnstructuredGrid* output)
    : Cells(cells), NameOf(std::move(names)), Output(output)
  {
    if (!output->GetPoints())
    {
      vtkNew<vtkPoints> points;
      points->SetDataTypeToDouble();
      output->SetPoints(points);
      output->Allocate();
      output->GetPointData()->AddArray(knotwork::NamedArray<vtkDoubleArray>("LocalParameters", 3));
      output->GetCellData()->AddArray(knotwork::NamedArray<vtkIntArray>("Kind"));
      output->GetCellData()->AddArray(knotwork::NamedArray<vtkIdTypeArray>("CellId"));
      output->GetCellData()->AddArray(knotwork::NamedArray<vtkIntArray>("Block"));
      output->GetCellData()->AddArray(knotwork::NamedArray<vtkIntArray>("PatchId"));
      output->GetCellData()->AddArray(knotwork::NamedArray<vtkDoubleArray>("JacobianUpper"));
    }
  }

  void AddPoint(int kind, int cell, double upper, const std::array<double, 3>& at)
  {
    const vtkIdType vertex = this->InsertPoint(cell, at);
    this->AddCell(kind, cell, upper, VTK_VERTEX, 1, &vertex);
  }

  void AddBox(const knotwork::JacobianWitness& witness)
  {
    const knotwork::CellShape shape = this->Cells.Shapes[static_cast<std::size_t>(witness.Cell)];
    std::array<vtkIdType, 8> corners{};
    for (std::size_t c = 0; c < static_cast<std::size_t>(witness.NumCorners); ++c)
    {
      corners[c] = this->InsertPoint(witness.Cell, witness.Corners[CornerOfVtk(shape, c)]);
    }
    this->AddCell(vtkJacobianValidator::FOLDED_BOX, witness.Cell, witness.Upper,
      LinearCellType(shape), witness.NumCorners, corners.data());
  }

private:
  vtkIdType InsertPoint(int cell, const std::array<double, 3>& at)
  {
    double x[3] = {};
    EvaluateCell(this->Cells, cell, at, x);
    this->Output->GetPointData()->GetArray("LocalParameters")->InsertNextTuple(at.data());
    return this->Output->GetPoints()->InsertNextPoint(x);
  }

  void AddCell(int kind, int cell, double upper, int type, vtkIdType count, const vtkIdType* ids)
  {
    const knotwork::CellName name = this->NameOf(cell);
    const vtkIdType number = this->Output->InsertNextCell(type, count, ids);
    vtkCellData* data = this->Output->GetCellData();
    const auto add = [&](const char* array, double value)
    { data->GetArray(array)->InsertTuple1(number, value); };
    add("Kind", kind);
    add("CellId", static_cast<double>(name.Number));
    add("Block", name.Block);
    add("PatchId", name.Patch);
    add("JacobianUpper", upper);
    if (name.Element >= 0 || data->HasArray("ElementNumber") != 0) // in the file, where cells know
    {
      if (data->HasArray("ElementNumber") == 0)
      {
        const auto elements = knotwork::NamedArray<vtkIdTypeArray>("ElementNumber", 1, number);
        elements->FillValue(-1);
        data->AddArray(elements);
      }
      add("ElementNumber", static_cast<double>(name.Element));
    }
  }

  const knotwork::BernsteinCells& Cells;
  Names NameOf;
  vtkUnstructuredGrid* Output;
};

void ShowFolds(const std::vector<knotwork::JacobianWitness>& witnesses, WitnessGrid& output)
{
  for (const knotwork::JacobianWitness& witness : witnesses)
  {
    output.AddPoint(
      vtkJacobianValidator::FOLDED_POINT, witness.Cell, witness.Upper, witness.Parameters);
    if (witness.NumCorners > 0)
    {
      output.AddBox(witness);
    }
  }
}

void ShowOverlap(const knotwork::InjectivityCertificate& injectivity,
  const std::vector<CellCertificate>& certificates, WitnessGrid& output)
{
  if (injectivity.Verdict == knotwork::InjectivityVerdict::NotInjective &&
    injectivity.Reason == knotwork::InjectivityReason::Overlap && injectivity.HasWitness)
  {
    for (const auto& place : injectivity.Witness.Places)
    {
      output.AddPoint(vtkJacobianValidator::OVERLAP, place.Cell,
        certificates[static_cast<std::size_t>(place.Cell)].MaxUpper, place.Parameters);
    }
  }
}

/// What a row of the table says.
struct Summary
{
  std::map<Verdict, int> Count;
  int Cells = 0;
  int Degenerate = 0;
  std::int64_t Undecided = -1; ///< the first such cell, by its number in its grid
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

/// Output 2 of pieces becomes that of all.
/// @return the verdict over all.
Verdict MergePieces(vtkTable* table)
{
  using knotwork::Merging;
  knotwork::MergedTable how;
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
  knotwork::MergeTables(table, how);
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

/// What the steps of an update hand over to each other.
struct vtkJacobianValidator::Work
{
  std::vector<GridPair> Grids;
  knotwork::GridCells Read;
  knotwork::CellComplex Complex;
  knotwork::CellMaps Maps;
  knotwork::JacobianCertificate Certificate;
  Measurement Measured;
  /// Of a piece: its surface cells, and cells of the blocks in the pieces before it.
  std::vector<bool> IsOfPlane;
  std::map<int, vtkIdType> Before;
  bool IsPiece = false;

  const knotwork::BernsteinCells& Cells() const { return this->Read.Cells; }

  Status ReadCells(vtkDataObject* input)
  {
    std::vector<vtkUnstructuredGrid*> sources;
    std::size_t firstCell = 0;
    for (const auto& [block, grid] : GridsOf(input))
    {
      this->Grids.push_back({ grid, nullptr, block, firstCell });
      firstCell += static_cast<std::size_t>(grid->GetNumberOfCells());
      sources.push_back(grid);
    }
    auto read =
      firstCell == 0 ? knotwork::Result<knotwork::GridCells>() : knotwork::ReadGridCells(sources);
    if (read)
    {
      this->Read = std::move(read.Value);
      this->Complex = ComplexOf(this->Read, this->Grids, this->IsPiece);
    }
    return read.Status;
  }

  /// Output 2, without what is known of the map as a whole.
  void FillTable(bool measures, vtkTable* table) const
  {
    std::map<int, Summary> patches;
    Summary all;
    for (const GridPair& grid : this->Grids)
    {
      const auto before = this->Before.find(grid.Block);
      const vtkIdType first = before == this->Before.end() ? 0 : before->second;
      for (vtkIdType i = 0; i < grid.Input->GetNumberOfCells(); ++i)
      {
        const std::size_t cell = grid.FirstCell + static_cast<std::size_t>(i);
        for (Summary* summary : { &patches[PatchOf(grid.Input, i)], &all })
        {
          summary->Add(this->Certificate.Cells[cell], first + i);
          if (measures)
          {
            summary->Add(this->Measured.Cells[cell]);
          }
        }
      }
    }
    if (all.Cells > 0)
    {
      ::FillTable(patches, all, measures, table);
    }
  }

  knotwork::CertifiedPiece Certified() const
  {
    knotwork::CertifiedPiece piece;
    piece.Cells = this->Cells();
    piece.Complex = this->Complex;
    piece.HasPatches = !this->Complex.Patches.empty();
    const Names names = NamesOf(this->Grids, this->Before);
    for (int cell = 0; cell < this->Cells().NumCells(); ++cell)
    {
      piece.Names.push_back(names(cell));
    }
    piece.Certificates = this->Certificate.Cells;
    piece.Witnesses = this->Certificate.Witnesses;
    return piece;
  }
};

vtkJacobianValidator::~vtkJacobianValidator() = default;

Status vtkJacobianValidator::Gather(vtkInformationVector** inputs)
{
  this->Piece = std::make_unique<Work>();
  Work& work = *this->Piece;
  work.IsPiece = true;
  Status status = work.ReadCells(vtkDataObject::GetData(inputs[0], 0));
  // what follows is done by all, come what may
  std::vector<std::int64_t> patches;
  std::vector<std::pair<int, vtkIdType>> counts;
  const bool hasPatches = HaveCellArray(work.Grids, "PatchId");
  for (const GridPair& grid : work.Grids)
  {
    counts.emplace_back(grid.Block, grid.Input->GetNumberOfCells());
    for (vtkIdType i = 0; hasPatches && i < grid.Input->GetNumberOfCells(); ++i)
    {
      constexpr int blockBits = 32;
      patches.push_back((static_cast<std::int64_t>(grid.Block) << blockBits) |
        static_cast<std::uint32_t>(PatchOf(grid.Input, i)));
    }
  }
  work.IsOfPlane = knotwork::FindPlanesOfPieces(work.Cells(), patches);
  std::vector<std::int64_t> flat;
  for (const auto& [block, cells] : counts)
  {
    flat.insert(flat.end(), { block, cells });
  }
  const auto all = knotwork::Processes::Exchange(flat);
  for (int process = 0; process < knotwork::Processes::Own(); ++process)
  {
    const std::vector<std::int64_t>& one = all[static_cast<std::size_t>(process)];
    for (std::size_t i = 0; i < one.size(); i += 2)
    {
      work.Before[static_cast<int>(one[i])] += one[i + 1];
    }
  }
  return status;
}

Status vtkJacobianValidator::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->Verdict = 0;
  vtkDataObject* input = vtkDataObject::GetData(inputs[0], 0);
  if (!this->Piece)
  {
    this->Piece = std::make_unique<Work>();
    if (Status status = this->Piece->ReadCells(input); !status)
    {
      this->Piece.reset();
      return status;
    }
  }
  const Status status = this->Validate(input, outputs);
  if (!this->Piece->IsPiece || !status)
  {
    this->Piece.reset();
  }
  return status;
}

Status vtkJacobianValidator::Validate(vtkDataObject* input, vtkInformationVector* outputs)
{
  Work& work = *this->Piece;
  CopyInput(input, vtkDataObject::GetData(outputs, 0), work.Grids);
  const knotwork::BernsteinCells& cells = work.Cells();
  if (cells.NumCells() == 0)
  {
    return {};
  }
  work.Maps =
    work.IsPiece ? MakeCellMaps(cells, work.IsOfPlane) : FindCellMaps(cells, work.Complex.Patches);
  knotwork::JacobianParams params;
  params.RelativeGap = this->RelativeGap;
  params.ComputeMax = this->BoundMaximum;
  params.MaxBoxes = this->MaximumBoxes;
  params.Threads = this->KernelThreads();
  auto certificate = ValidateMaps(cells, work.Maps, params, this->Progress());
  if (!certificate)
  {
    return certificate.Status;
  }
  work.Certificate = std::move(certificate.Value);
  knotwork::InjectivityCertificate injectivity;
  if (this->Injectivity && !work.IsPiece)
  {
    auto proved = this->ProveInjective(cells, work.Maps, work.Complex, work.Certificate);
    if (!proved)
    {
      return proved.Status;
    }
    injectivity = std::move(proved.Value);
  }
  if (this->Measures)
  {
    knotwork::CellMeasuresParams measuresParams;
    measuresParams.SamplesPerEdge = this->SamplesPerEdge;
    measuresParams.BoundBoxes = 0;
    measuresParams.Threads = this->KernelThreads();
    auto measured = Measure(cells, work.Maps, work.Grids, measuresParams);
    if (!measured)
    {
      return measured.Status;
    }
    work.Measured = std::move(measured.Value);
  }
  const Names names = NamesOf(work.Grids, work.Before);
  for (const GridPair& grid : work.Grids)
  {
    AddCellArrays(grid, work.Certificate.Cells);
    if (this->Measures)
    {
      using Cell = knotwork::CellMeasure;
      const std::vector<Cell>& measured = work.Measured.Cells;
      AddCellArray<vtkDoubleArray>(
        grid, "CellMeasure", measured, [](const Cell& cell) { return cell.Measure; });
      AddCellArray<vtkDoubleArray>(
        grid, "CellMeasureError", measured, [](const Cell& cell) { return cell.MeasureError; });
      AddCellArray<vtkDoubleArray>(
        grid, "ScaledJacobianMin", measured, [](const Cell& cell) { return cell.ScaledMin; });
    }
  }
  vtkTable* table = vtkTable::GetData(outputs, 2);
  if (!work.IsPiece)
  {
    work.FillTable(this->Measures, table);
  }
  WitnessGrid witnesses(cells, names, vtkUnstructuredGrid::GetData(outputs, 1));
  ShowFolds(work.Certificate.Witnesses, witnesses);
  if (this->Injectivity && !work.IsPiece)
  {
    FillInjectivity(injectivity, work.Maps.HasMaps(), table);
    ShowOverlap(injectivity, work.Certificate.Cells, witnesses);
  }
  this->Verdict = static_cast<int>(work.Certificate.Verdict);
  return {};
}

knotwork::Result<knotwork::InjectivityCertificate> vtkJacobianValidator::ProveInjective(
  const knotwork::BernsteinCells& cells, const knotwork::CellMaps& maps,
  const knotwork::CellComplex& complex, const knotwork::JacobianCertificate& certificate)
{
  if (!maps.HasMaps())
  {
    return knotwork::InjectivityCertificate();
  }
  knotwork::InjectivityParams params;
  params.MaxBoxes = this->MaximumBoxes;
  params.Threads = this->KernelThreads();
  return ProveMapsInjective(cells, maps, complex, certificate, params, this->Progress());
}

/// The first process alone can see the whole: to it go the cells and what is proved of each.
Status vtkJacobianValidator::Merge(vtkInformationVector**, vtkInformationVector* outputs)
{
  const std::unique_ptr<Work> work = std::move(this->Piece);
  vtkTable* table = vtkTable::GetData(outputs, 2);
  work->Measured.CompareWithAll();
  work->FillTable(this->Measures, table);
  const auto verdict = MergePieces(table);
  const bool isFirst = knotwork::Processes::Own() == 0;
  this->Verdict = knotwork::Processes::ExchangeNumber(static_cast<int>(verdict)).front();
  if (!this->Injectivity)
  {
    return {};
  }
  auto collected = CollectPieces(work->Certified());
  if (!collected || !isFirst || collected->Names.empty())
  {
    return collected.Status;
  }
  const knotwork::BernsteinCells& cells = collected->Cells;
  const knotwork::CellMaps maps = FindCellMaps(cells, collected->Complex.Patches);
  knotwork::JacobianCertificate certificate;
  certificate.Cells = std::move(collected->Certificates);
  certificate.Witnesses = std::move(collected->Witnesses);
  const auto proved = this->ProveInjective(cells, maps, collected->Complex, certificate);
  if (!proved)
  {
    return proved.Status;
  }
  FillInjectivity(proved.Value, maps.HasMaps(), table);
  WitnessGrid witnesses(
    cells, [&](int cell) { return collected->Names[static_cast<std::size_t>(cell)]; },
    vtkUnstructuredGrid::GetData(outputs, 1));
  ShowOverlap(proved.Value, certificate.Cells, witnesses);
  return {};
}
