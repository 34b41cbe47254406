// SPDX-License-Identifier: BSD-3-Clause
#include "vtkJacobianValidator.h"

#include "CellMeasurement.h"
#include "ValidationTable.h"
#include "WitnessGrid.h"
#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineGrid/Processes.h>

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

using knotwork::CellCertificate;
using knotwork::Status;
using knotwork::Verdict;

vtkStandardNewMacro(vtkJacobianValidator);

namespace
{
template <typename ArrayType, typename Cell, typename ValueFunction>
void AddCellArray(const knotwork::GridPair& grid, const char* name, const std::vector<Cell>& cells,
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

void AddCellArrays(const knotwork::GridPair& grid, const std::vector<CellCertificate>& cells)
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
  std::vector<knotwork::GridPair> Grids;
  knotwork::GridCells Read;
  knotwork::CellComplex Complex;
  knotwork::CellMaps Maps;
  knotwork::JacobianCertificate Certificate;
  knotwork::Measurement Measured;
  /// Of a piece: its surface cells, and cells of the blocks in the pieces before it.
  std::vector<bool> IsOfPlane;
  std::map<int, vtkIdType> Before;
  bool IsPiece = false;

  const knotwork::BernsteinCells& Cells() const { return this->Read.Cells; }

  Status ReadCells(vtkDataObject* input)
  {
    std::vector<vtkUnstructuredGrid*> sources;
    std::size_t firstCell = 0;
    for (const auto& [block, grid] : knotwork::GridsOf(input))
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

  knotwork::CertifiedPiece Certified() const
  {
    knotwork::CertifiedPiece piece;
    piece.Cells = this->Cells();
    piece.Complex = this->Complex;
    piece.HasPatches = !this->Complex.Patches.empty();
    const knotwork::CellNames names = NamesOf(this->Grids, this->Before);
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
  for (const knotwork::GridPair& grid : work.Grids)
  {
    counts.emplace_back(grid.Block, grid.Input->GetNumberOfCells());
    for (vtkIdType i = 0; hasPatches && i < grid.Input->GetNumberOfCells(); ++i)
    {
      constexpr int blockBits = 32;
      patches.push_back((static_cast<std::int64_t>(grid.Block) << blockBits) |
        static_cast<std::uint32_t>(knotwork::PatchOf(grid.Input, i)));
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
    auto measured = MeasureGrids(cells, work.Maps, work.Grids, measuresParams);
    if (!measured)
    {
      return measured.Status;
    }
    work.Measured = std::move(measured.Value);
  }
  for (const knotwork::GridPair& grid : work.Grids)
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
    FillTable(work.Grids, work.Before, work.Certificate.Cells, work.Measured.Cells, table);
  }
  const knotwork::CellNames names = NamesOf(work.Grids, work.Before);
  auto* witnesses = vtkUnstructuredGrid::GetData(outputs, 1);
  ShowFolds(cells, names, work.Certificate.Witnesses, witnesses);
  if (this->Injectivity && !work.IsPiece)
  {
    FillInjectivity(injectivity, work.Maps.HasMaps(), table);
    ShowOverlap(cells, names, work.Certificate.Cells, injectivity, witnesses);
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
  FillTable(work->Grids, work->Before, work->Certificate.Cells, work->Measured.Cells, table);
  const auto verdict = knotwork::MergePieces(table);
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
  ShowOverlap(
    cells, [&](int cell) { return collected->Names[static_cast<std::size_t>(cell)]; },
    certificate.Cells, proved.Value, vtkUnstructuredGrid::GetData(outputs, 1));
  return {};
}
