// SPDX-License-Identifier: BSD-3-Clause
#include "vtkJacobianValidator.h"

#include "CellMeasures.h"
#include "CellsFromGrid.h"
#include "JacobianCertificate.h"

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
  vtkNew<ArrayType> array;
  array->SetName(name);
  const vtkIdType n = grid.Output->GetNumberOfCells();
  array->SetNumberOfTuples(n);
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
  AddCellArray<vtkDoubleArray>(
    grid, "JacobianMinLower", cells, [](const Cell& cell) { return cell.MinLower; });
  AddCellArray<vtkDoubleArray>(
    grid, "JacobianMinUpper", cells, [](const Cell& cell) { return cell.MinUpper; });
  AddCellArray<vtkDoubleArray>(
    grid, "JacobianMaxLower", cells, [](const Cell& cell) { return cell.MaxLower; });
  AddCellArray<vtkDoubleArray>(
    grid, "JacobianMaxUpper", cells, [](const Cell& cell) { return cell.MaxUpper; });
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

/// The cells with so many parameters.
struct Selection
{
  knotwork::BernsteinCells Cells;
  std::vector<std::size_t> Origin;
};
Selection SelectCells(const knotwork::BernsteinCells& all, int parameters)
{
  Selection result;
  result.Cells.NumComponents = all.NumComponents;
  result.Cells.Rational = all.Rational;
  for (std::size_t cell = 0; cell < all.Shapes.size(); ++cell)
  {
    if (NumParameters(all.Shapes[cell]) == parameters)
    {
      double* block = result.Cells.Block(result.Cells.Add(all.Shapes[cell], all.Degrees[cell]));
      std::copy(all.Data.begin() + static_cast<std::ptrdiff_t>(all.Offsets[cell]),
        all.Data.begin() + static_cast<std::ptrdiff_t>(all.Offsets[cell + 1]), block);
      result.Origin.push_back(cell);
    }
  }
  return result;
}

/// Measures of all cells, those of each dimension by themselves.
knotwork::Result<std::vector<knotwork::CellMeasure>> Measure(const knotwork::BernsteinCells& cells,
  const std::vector<GridPair>& grids, knotwork::CellMeasuresParams params)
{
  std::vector<knotwork::CellMeasure> measures(static_cast<std::size_t>(cells.NumCells()));
  for (int dimension = 1; dimension <= 3; ++dimension)
  {
    const Selection selection = SelectCells(cells, dimension);
    if (selection.Origin.empty())
    {
      continue;
    }
    params.ParametricVolumes.clear();
    for (const std::size_t cell : selection.Origin)
    {
      const GridPair& owner = OwnerOf(grids, cell);
      params.ParametricVolumes.push_back(
        ParametricVolume(owner.Input, static_cast<vtkIdType>(cell - owner.FirstCell), dimension));
    }
    const auto measured = MeasureCells(selection.Cells, params);
    if (!measured)
    {
      return measured.Status;
    }
    for (std::size_t i = 0; i < selection.Origin.size(); ++i)
    {
      measures[selection.Origin[i]] = measured->Cells[i];
    }
  }
  return measures;
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
  const knotwork::JacobianCertificate& certificate, const std::vector<GridPair>& grids,
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
  output->Allocate(static_cast<vtkIdType>(2 * certificate.Witnesses.size()));

  for (const knotwork::JacobianWitness& witness : certificate.Witnesses)
  {
    const auto cell = static_cast<std::size_t>(witness.Cell);
    const GridPair& owner = OwnerOf(grids, cell);
    const auto local = static_cast<vtkIdType>(cell - owner.FirstCell);
    const auto addPoint = [&](const std::array<double, 3>& at)
    {
      double x[3] = {};
      EvaluateCell(cells, witness.Cell, at, x);
      parameters->InsertNextTuple(at.data());
      return points->InsertNextPoint(x);
    };
    const auto describe = [&]
    {
      cellIds->InsertNextValue(local);
      blocks->InsertNextValue(owner.Block);
      patches->InsertNextValue(PatchOf(owner.Input, local));
      uppers->InsertNextValue(witness.Upper);
    };
    const vtkIdType vertex = addPoint(witness.Parameters);
    output->InsertNextCell(VTK_VERTEX, 1, &vertex);
    describe();
    if (witness.NumCorners > 0)
    {
      const knotwork::CellShape shape = cells.Shapes[cell];
      std::array<vtkIdType, 8> corners{};
      for (std::size_t c = 0; c < static_cast<std::size_t>(witness.NumCorners); ++c)
      {
        corners[c] = addPoint(witness.Corners[CornerOfVtk(shape, c)]);
      }
      output->InsertNextCell(LinearCellType(shape), witness.NumCorners, corners.data());
      describe();
    }
  }
  output->SetPoints(points);
  output->GetPointData()->AddArray(parameters);
  output->GetCellData()->AddArray(cellIds);
  output->GetCellData()->AddArray(blocks);
  output->GetCellData()->AddArray(patches);
  output->GetCellData()->AddArray(uppers);
}

/// What a row of the table says.
struct Summary
{
  std::map<Verdict, int> Count;
  int Cells = 0;
  int Degenerate = 0;
  double MinLower = std::numeric_limits<double>::infinity();
  double MinUpper = std::numeric_limits<double>::infinity();
  double MaxLower = -std::numeric_limits<double>::infinity();
  double MaxUpper = -std::numeric_limits<double>::infinity();
  double Measure = 0.0;
  double ScaledMin = std::numeric_limits<double>::infinity();
  double ScaledSum = 0.0;
  double ConditionMax = 0.0;
  double ConditionSum = 0.0;
  double UniformityMin = std::numeric_limits<double>::infinity();
  double UniformityMax = -std::numeric_limits<double>::infinity();

  void Add(const knotwork::CellMeasure& cell)
  {
    this->Measure += cell.Measure;
    this->ScaledMin = std::min(this->ScaledMin, cell.ScaledMin);
    this->ScaledSum += cell.ScaledMean;
    this->ConditionMax = std::max(this->ConditionMax, cell.ConditionMax);
    this->ConditionSum += cell.ConditionMean;
    this->UniformityMin = std::min(this->UniformityMin, cell.UniformityMin);
    this->UniformityMax = std::max(this->UniformityMax, cell.UniformityMax);
  }
  void Add(const CellCertificate& cell)
  {
    ++this->Cells;
    ++this->Count[cell.Verdict];
    this->Degenerate += cell.Degenerate != 0 ? 1 : 0;
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
    vtkNew<ArrayType> column;
    column->SetName(name);
    for (auto& [id, summary] : rows)
    {
      column->InsertNextValue(value(id, *summary));
    }
    table->AddColumn(column);
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
  addColumn(Reals(), "JacobianMinLower", [](int, Summary& s) { return s.MinLower; });
  addColumn(Reals(), "JacobianMinUpper", [](int, Summary& s) { return s.MinUpper; });
  addColumn(Reals(), "JacobianMaxLower", [](int, Summary& s) { return s.MaxLower; });
  addColumn(Reals(), "JacobianMaxUpper", [](int, Summary& s) { return s.MaxUpper; });
  if (measures)
  {
    addColumn(Reals(), "Measure", [](int, Summary& s) { return s.Measure; });
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

vtkJacobianValidator::vtkJacobianValidator()
{
  this->SetNumberOfOutputPorts(3);
}

void vtkJacobianValidator::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "RelativeGap: " << this->RelativeGap << "\n";
  os << indent << "BoundMaximum: " << this->BoundMaximum << "\n";
  os << indent << "MaximumBoxes: " << this->MaximumBoxes << "\n";
  os << indent << "Measures: " << this->Measures << "\n";
  os << indent << "SamplesPerEdge: " << this->SamplesPerEdge << "\n";
  os << indent << "Verdict: " << this->Verdict << "\n";
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
  if (!vtkUnstructuredGrid::GetData(outputs, 1))
  {
    vtkNew<vtkUnstructuredGrid> witnesses;
    outputs->GetInformationObject(1)->Set(vtkDataObject::DATA_OBJECT(), witnesses);
  }
  if (!vtkTable::GetData(outputs, 2))
  {
    vtkNew<vtkTable> table;
    outputs->GetInformationObject(2)->Set(vtkDataObject::DATA_OBJECT(), table);
  }
  return this->Superclass::RequestDataObject(request, inputs, outputs);
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
  const knotwork::BernsteinCells cells = PlanarCells(read->Cells);
  const auto certificate = ValidateJacobian(cells, params, this->Progress());
  if (!certificate)
  {
    return certificate.Status;
  }
  std::vector<knotwork::CellMeasure> measures;
  if (this->Measures)
  {
    knotwork::CellMeasuresParams measuresParams;
    measuresParams.SamplesPerEdge = this->SamplesPerEdge;
    measuresParams.BoundBoxes = 0;
    measuresParams.Threads = this->KernelThreads();
    auto measured = Measure(cells, grids, measuresParams);
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
        grid, "ScaledJacobianMin", measures, [](const Cell& cell) { return cell.ScaledMin; });
    }
    for (vtkIdType i = 0; i < grid.Input->GetNumberOfCells(); ++i)
    {
      const std::size_t cell = grid.FirstCell + static_cast<std::size_t>(i);
      for (Summary* summary : { &patches[PatchOf(grid.Input, i)], &all })
      {
        summary->Add(certificate->Cells[cell]);
        if (this->Measures)
        {
          summary->Add(measures[cell]);
        }
      }
    }
  }
  FillTable(patches, all, this->Measures, vtkTable::GetData(outputs, 2));
  ShowWitnesses(read->Cells, certificate.Value, grids, vtkUnstructuredGrid::GetData(outputs, 1));
  this->Verdict = static_cast<int>(certificate->Verdict);
  return {};
}
