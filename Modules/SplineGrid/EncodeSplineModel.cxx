// SPDX-License-Identifier: BSD-3-Clause
#include "SplineSchema.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/SpaceFamily.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataAssembly.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

namespace knotwork
{
namespace
{
constexpr unsigned char CellTypes[4] = { 0, VTK_BEZIER_CURVE, VTK_BEZIER_QUADRILATERAL,
  VTK_BEZIER_HEXAHEDRON };

// A field of the grid; patches without it have zeros.
struct GridField
{
  std::string Name;
  vtkSmartPointer<vtkDoubleArray> Values;
};

// Fills one grid patch after patch.
class GridWriter
{
public:
  Status Check(const SplinePatch& patch);
  void Prepare(const std::vector<const SplinePatch*>& patches);
  void Add(const SplinePatch& patch, int id);
  void Finish(const PatchTopology& topology, vtkUnstructuredGrid* grid);

private:
  template <int Dim>
  void AddSpline(const SplinePatch& patch, const Spline<Dim>& spline, int id);
  template <int Dim>
  void PutPoints(
    const Spline<Dim>& spline, const ElementPoints& numbering, double* values, double* weights);
  double* ArrayOf(const SplineField& field) const;

  bool Rational = false;
  bool Domain = false;
  std::map<std::string, Eigen::Index> FieldComponents;
  std::vector<ElementPoints> Numberings;
  std::size_t NextPatch = 0;
  vtkIdType FirstPoint = 0;
  vtkNew<vtkPoints> Points;
  vtkNew<vtkDoubleArray> Weights;
  std::vector<GridField> Fields;
  vtkNew<vtkIdTypeArray> Offsets;
  vtkNew<vtkIdTypeArray> Connectivity;
  vtkNew<vtkUnsignedCharArray> Types;
  vtkNew<vtkIntArray> PatchIds;
  vtkNew<vtkIntArray> ElementIds;
  vtkNew<vtkIntArray> Levels;
  vtkNew<vtkIntArray> Bases;
  vtkNew<vtkDoubleArray> Degrees;
  vtkNew<vtkDoubleArray> DegreesCopy;
  vtkNew<vtkDoubleArray> Bounds;
  SplineSchema Schema;
};

bool IsReserved(const std::string& fieldName)
{
  return fieldName.empty() || fieldName == name::Weights || fieldName == name::WeightsCopy;
}

Status GridWriter::Check(const SplinePatch& patch)
{
  const std::string where = "patch " + std::to_string(patch.Id);
  const auto [status, numFunctions, components] = std::visit(
    [](const auto& spline)
    {
      return std::make_tuple(
        spline.Space ? spline.Check() : Status(ErrorCode::EmptyInput, "no spline space"),
        spline.Space ? spline.Space->NumFunctions : 0, spline.NumComponents());
    },
    patch.Geometry);
  if (!status)
  {
    return { status.Code, where + ": " + status.Detail };
  }
  if (components != 3)
  {
    return { ErrorCode::DimensionMismatch,
      where + ": control points have " + std::to_string(components) + " components instead of 3" };
  }
  std::set<std::string> names;
  for (const SplineField& field : patch.Fields)
  {
    const std::string what = where + ", field '" + field.Name + "': ";
    if (IsReserved(field.Name) || !names.insert(field.Name).second)
    {
      return { ErrorCode::InvalidParameter, what + "the name is reserved, empty or used twice" };
    }
    if (field.Coefficients.rows() != numFunctions || field.Coefficients.cols() < 1)
    {
      return { ErrorCode::SizeMismatch,
        what + std::to_string(field.Coefficients.rows()) + " coefficients for " +
          std::to_string(numFunctions) + " functions" };
    }
    if (!field.Coefficients.allFinite())
    {
      return { ErrorCode::NonFiniteInput, what + "a coefficient is not a finite number" };
    }
    const auto known =
      this->FieldComponents.emplace(field.Name, field.Coefficients.cols()).first->second;
    if (known != field.Coefficients.cols())
    {
      return { ErrorCode::SizeMismatch,
        what + std::to_string(field.Coefficients.cols()) + " components, in another patch " +
          std::to_string(known) };
    }
  }
  return {};
}

void GridWriter::Prepare(const std::vector<const SplinePatch*>& patches)
{
  vtkIdType numPoints = 0;
  vtkIdType numCells = 0;
  vtkIdType numIds = 0;
  for (const SplinePatch* patch : patches)
  {
    std::visit(
      [&](const auto& spline)
      {
        this->Numberings.push_back(FamilyOf(*spline.Space).NumberPoints(*spline.Space));
        this->Rational = this->Rational || spline.IsRational();
        this->Domain = this->Domain || spline.Space->HasDomain();
        numCells += spline.Space->NumElements();
      },
      patch->Geometry);
    numPoints += this->Numberings.back().Count;
    numIds += static_cast<vtkIdType>(this->Numberings.back().Ids.size());
  }
  this->Points->SetDataTypeToDouble();
  this->Points->SetNumberOfPoints(numPoints);
  this->Weights->SetName(name::Weights);
  this->Weights->SetNumberOfTuples(this->Rational ? numPoints : 0);
  this->Weights->Fill(1.0);
  for (const SplinePatch* patch : patches) // in the order of their first appearance
  {
    for (const SplineField& field : patch->Fields)
    {
      const auto same = [&](const GridField& other) { return other.Name == field.Name; };
      if (std::none_of(this->Fields.begin(), this->Fields.end(), same))
      {
        GridField made{ field.Name, vtkSmartPointer<vtkDoubleArray>::New() };
        made.Values->SetName(field.Name.c_str());
        made.Values->SetNumberOfComponents(static_cast<int>(field.Coefficients.cols()));
        made.Values->SetNumberOfTuples(numPoints);
        made.Values->Fill(0.0);
        this->Fields.push_back(made);
      }
    }
  }
  this->Offsets->Allocate(numCells + 1);
  this->Offsets->InsertNextValue(0);
  this->Connectivity->Allocate(numIds);
  this->Types->Allocate(numCells);
  this->PatchIds->SetName(name::PatchId);
  this->PatchIds->Allocate(numCells);
  this->ElementIds->SetName(name::ElementId);
  this->ElementIds->Allocate(numCells);
  this->Levels->SetName(name::Level);
  this->Levels->Allocate(numCells);
  this->Bases->SetName(name::Basis);
  this->Bases->Allocate(numCells);
  this->Degrees->SetName(name::Degrees);
  this->Degrees->SetNumberOfComponents(3);
  this->Degrees->Allocate(3 * numCells);
  this->DegreesCopy->SetName(name::DegreesCopy);
  this->DegreesCopy->SetNumberOfComponents(4);
  this->DegreesCopy->Allocate(4 * numCells);
  this->Bounds->SetName(name::Bounds);
  this->Bounds->SetNumberOfComponents(6);
  this->Bounds->Allocate(this->Domain ? 6 * numCells : 0);
}

void GridWriter::Add(const SplinePatch& patch, int id)
{
  std::visit([&](const auto& spline) { this->AddSpline(patch, spline, id); }, patch.Geometry);
}

double* GridWriter::ArrayOf(const SplineField& field) const
{
  const auto same = [&](const GridField& other) { return other.Name == field.Name; };
  return std::find_if(this->Fields.begin(), this->Fields.end(), same)->Values->GetPointer(0);
}

/// Bezier points of a patch's elements, into the rows of its points. @param weights  likewise; may
/// be null.
template <int Dim>
void GridWriter::PutPoints(
  const Spline<Dim>& spline, const ElementPoints& numbering, double* values, double* weights)
{
  const BezierElements<Dim> elements(spline, 1);
  const Eigen::Index columns = spline.ControlPoints.cols();
  std::vector<double> block;
  std::size_t firstId = 0;
  for (int e = 0; e < spline.Space->NumElements(); ++e)
  {
    const int n =
      NumTensorFunctions<Dim>(spline.Space->Elements[static_cast<std::size_t>(e)].Degree);
    block.resize(static_cast<std::size_t>(elements.NumPlanes()) * static_cast<std::size_t>(n));
    elements.Block(e, block.data());
    const double* w = spline.IsRational() ? block.data() + columns * n : nullptr;
    for (int i = 0; i < n; ++i)
    {
      const vtkIdType point = this->FirstPoint + numbering.Ids[firstId + i];
      for (Eigen::Index c = 0; c < columns; ++c)
      {
        values[point * columns + c] = block[static_cast<std::size_t>(c * n + i)] / (w ? w[i] : 1.0);
      }
      if (w && weights)
      {
        weights[point] = w[i];
      }
    }
    firstId += static_cast<std::size_t>(n);
  }
}

template <int Dim>
void GridWriter::AddSpline(const SplinePatch& patch, const Spline<Dim>& spline, int id)
{
  const SplineSpace<Dim>& space = *spline.Space;
  const ElementPoints& numbering = this->Numberings[this->NextPatch++];

  PatchRecord record;
  record.Id = id;
  record.Basis = FamilyOf(space).Describe(space);
  record.Rational = spline.IsRational();
  record.NumElements = space.NumElements();
  record.NumFunctions = space.NumFunctions;
  const int basisHash = HashOf(record.Basis);

  double* const xyz = static_cast<double*>(this->Points->GetVoidPointer(0));
  this->PutPoints<Dim>({ spline.Space, spline.ControlPoints, spline.Weights }, numbering, xyz,
    spline.IsRational() ? this->Weights->GetPointer(0) : nullptr);
  for (const SplineField& field : patch.Fields)
  {
    this->PutPoints<Dim>({ spline.Space, field.Coefficients, spline.Weights }, numbering,
      this->ArrayOf(field), nullptr);
  }

  std::map<IntArray<Dim>, std::vector<int>> orders;
  std::vector<IntArray<Dim>> degrees;
  std::size_t firstId = 0;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const auto& element = space.Elements[static_cast<std::size_t>(e)];
    const int n = NumTensorFunctions<Dim>(element.Degree);
    auto& order = orders[element.Degree];
    if (order.empty())
    {
      order = VtkPointOrder<Dim>(element.Degree);
    }
    for (int lexicographic : order)
    {
      this->Connectivity->InsertNextValue(
        this->FirstPoint + numbering.Ids[firstId + lexicographic]);
    }
    this->Offsets->InsertNextValue(this->Connectivity->GetNumberOfValues());
    this->Types->InsertNextValue(CellTypes[Dim]);
    this->PatchIds->InsertNextValue(id);
    this->ElementIds->InsertNextValue(e);
    this->Levels->InsertNextValue(element.Level);
    this->Bases->InsertNextValue(basisHash);
    std::array<double, 4> p{};
    std::copy(element.Degree.begin(), element.Degree.end(), p.begin());
    this->Degrees->InsertNextTuple(p.data());
    this->DegreesCopy->InsertNextTuple(p.data());
    if (this->Domain)
    {
      std::array<double, 6> bounds{};
      for (std::size_t d = 0; d < Dim; ++d)
      {
        bounds[2 * d] = element.Box.Lower[d];
        bounds[2 * d + 1] = element.Box.Upper[d];
      }
      this->Bounds->InsertNextTuple(bounds.data());
    }
    degrees.push_back(element.Degree);
    firstId += static_cast<std::size_t>(n);
  }

  if (basisHash != 0) // else the points are the control points
  {
    record.ControlPoints.Rows.setOnes(space.NumFunctions, 4);
    record.ControlPoints.Rows.leftCols(3) = spline.ControlPoints;
    if (spline.IsRational())
    {
      record.ControlPoints.Rows.col(3) = spline.Weights;
    }
    // of the elements' points what stands in the grid, since a shared point has one owner
    Checksum geometry = BeginGeometryChecksum<Dim>(degrees);
    const double* const weights = spline.IsRational() ? this->Weights->GetPointer(0) : nullptr;
    for (const auto own : numbering.Ids)
    {
      const vtkIdType point = this->FirstPoint + own;
      std::for_each_n(xyz + 3 * point, 3, [&](double value) { geometry.Add(value); });
      geometry.Add(weights ? weights[point] : 1.0);
    }
    record.ControlPoints.Stored = record.ControlPoints.With(geometry);
    for (const SplineField& field : patch.Fields)
    {
      const Eigen::Index columns = field.Coefficients.cols();
      const double* const values = this->ArrayOf(field) + this->FirstPoint * columns;
      Checksum sum;
      sum.Add(static_cast<std::uint64_t>(columns));
      for (const auto own : numbering.Ids)
      {
        std::for_each_n(values + own * columns, columns, [&](double value) { sum.Add(value); });
      }
      CoefficientCache cache{ 0, field.Coefficients };
      cache.Stored = cache.With(sum);
      record.Fields.push_back({ field.Name, std::move(cache) });
    }
    this->Schema.Patches.push_back(std::move(record));
  }
  this->FirstPoint += numbering.Count;
}

void GridWriter::Finish(const PatchTopology& topology, vtkUnstructuredGrid* grid)
{
  vtkNew<vtkCellArray> cells;
  cells->SetData(this->Offsets, this->Connectivity);
  grid->SetPoints(this->Points);
  grid->SetCells(this->Types, cells);
  vtkPointData* pointData = grid->GetPointData();
  if (this->Rational)
  {
    pointData->SetRationalWeights(this->Weights);
    vtkNew<vtkDoubleArray> copy;
    copy->DeepCopy(this->Weights);
    copy->SetName(name::WeightsCopy);
    pointData->AddArray(copy);
  }
  for (const GridField& field : this->Fields)
  {
    pointData->AddArray(field.Values);
  }
  vtkCellData* cellData = grid->GetCellData();
  cellData->AddArray(this->PatchIds);
  cellData->AddArray(this->ElementIds);
  cellData->AddArray(this->Levels);
  if (this->Domain)
  {
    cellData->AddArray(this->Bounds);
  }
  cellData->AddArray(this->Bases);
  cellData->SetHigherOrderDegrees(this->Degrees);
  cellData->AddArray(this->DegreesCopy);
  this->Schema.Topology = topology;
  WriteSchema(this->Schema, grid->GetFieldData());
}

/// What concerns the patches with an id alone, with their ids.
PatchTopology NumberedBy(const std::map<int, int>& ids, const PatchTopology& topology)
{
  PatchTopology numbered;
  const auto number = [&](PatchSide& side)
  {
    const auto found = ids.find(side.Patch);
    side.Patch = found == ids.end() ? -1 : found->second;
    return found != ids.end();
  };
  for (PatchInterface interface : topology.Interfaces)
  {
    if (number(interface.Sides[0]) && number(interface.Sides[1]))
    {
      numbered.Interfaces.push_back(interface);
    }
  }
  for (PatchSide side : topology.Boundary)
  {
    if (number(side))
    {
      numbered.Boundary.push_back(side);
    }
  }
  return numbered;
}

Status EncodePatches(const SplineModel& model, const std::vector<const SplinePatch*>& patches,
  vtkUnstructuredGrid* grid)
{
  if (Status status = CheckTopology(model.Topology, static_cast<int>(model.Patches.size()), 3);
      !status)
  {
    return status;
  }
  grid->Initialize();
  GridWriter writer;
  std::set<int> used;
  for (const SplinePatch* patch : patches)
  {
    if (Status status = writer.Check(*patch); !status)
    {
      return status;
    }
    used.insert(patch->Id);
  }
  writer.Prepare(patches);
  std::set<int> taken;
  std::map<int, int> ids; // of indices
  int next = 0;
  for (const SplinePatch* patch : patches)
  {
    int id = patch->Id;
    if (!taken.insert(id).second) // patches of two blocks with the same number
    {
      while (used.count(next) > 0)
      {
        ++next;
      }
      id = next;
      used.insert(id);
      taken.insert(id);
    }
    writer.Add(*patch, id);
    ids[static_cast<int>(patch - model.Patches.data())] = id;
  }
  writer.Finish(NumberedBy(ids, model.Topology), grid);
  return {};
}
}

Status EncodeSplineGrid(const SplineModel& model, vtkUnstructuredGrid* grid)
{
  std::vector<const SplinePatch*> patches;
  for (const SplinePatch& patch : model.Patches)
  {
    patches.push_back(&patch);
  }
  return EncodePatches(model, patches, grid);
}

Status EncodeSplineModel(const SplineModel& model, vtkDataObject* like, vtkDataObject* output)
{
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(output))
  {
    return EncodeSplineGrid(model, grid);
  }
  auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(output);
  auto* input = vtkPartitionedDataSetCollection::SafeDownCast(like);
  if (!collection)
  {
    return { ErrorCode::InvalidParameter,
      "splines are written to unstructured grids and collections of partitioned datasets" };
  }
  std::map<int, std::vector<const SplinePatch*>> blocks;
  for (const SplinePatch& patch : model.Patches)
  {
    if (patch.Block < 0)
    {
      return { ErrorCode::InvalidParameter,
        "patch " + std::to_string(patch.Id) + " belongs to block " + std::to_string(patch.Block) };
    }
    blocks[patch.Block].push_back(&patch);
  }
  const unsigned int inputBlocks = input ? input->GetNumberOfPartitionedDataSets() : 0;
  const unsigned int modelBlocks =
    blocks.empty() ? 0 : static_cast<unsigned int>(blocks.rbegin()->first) + 1;
  collection->Initialize();
  if (input)
  {
    collection->CopyStructure(input);
    collection->SetDataAssembly(nullptr);
    if (vtkDataAssembly* assembly = input->GetDataAssembly())
    {
      vtkNew<vtkDataAssembly> copy;
      copy->DeepCopy(assembly);
      collection->SetDataAssembly(copy);
    }
    collection->GetFieldData()->PassData(input->GetFieldData());
  }
  collection->SetNumberOfPartitionedDataSets(std::max(inputBlocks, modelBlocks));
  for (unsigned int b = 0; b < collection->GetNumberOfPartitionedDataSets(); ++b)
  {
    vtkNew<vtkPartitionedDataSet> block;
    vtkPartitionedDataSet* from = b < inputBlocks ? input->GetPartitionedDataSet(b) : nullptr;
    bool hadGrid = false;
    for (unsigned int i = 0; from && i < from->GetNumberOfPartitions(); ++i)
    {
      vtkDataSet* piece = from->GetPartition(i);
      hadGrid = hadGrid || vtkUnstructuredGrid::SafeDownCast(piece);
      if (piece && !vtkUnstructuredGrid::SafeDownCast(piece)) // not ours: passes as it is
      {
        vtkSmartPointer<vtkDataSet> copy;
        copy.TakeReference(piece->NewInstance());
        copy->ShallowCopy(piece);
        block->SetPartition(block->GetNumberOfPartitions(), copy);
      }
    }
    const auto patches = blocks.find(static_cast<int>(b));
    if (patches != blocks.end() || hadGrid)
    {
      vtkNew<vtkUnstructuredGrid> grid;
      const Status status = EncodePatches(
        model, patches != blocks.end() ? patches->second : std::vector<const SplinePatch*>(), grid);
      if (!status)
      {
        return { status.Code, "block " + std::to_string(b) + ": " + status.Detail };
      }
      block->SetPartition(block->GetNumberOfPartitions(), grid);
    }
    collection->SetPartitionedDataSet(b, block);
  }
  return {};
}

void PassCellData(vtkDataSet* input, const std::vector<vtkIdType>& sourceCells, vtkDataSet* output)
{
  static const std::set<std::string> ours{ name::PatchId, name::ElementId, name::Level,
    name::Bounds, name::Basis, name::Degrees, name::DegreesCopy };
  if (static_cast<vtkIdType>(sourceCells.size()) != output->GetNumberOfCells())
  {
    return;
  }
  vtkCellData* from = input->GetCellData();
  const vtkIdType numSources = input->GetNumberOfCells();
  for (int a = 0; a < from->GetNumberOfArrays(); ++a)
  {
    vtkAbstractArray* source = from->GetAbstractArray(a);
    if (!source || !source->GetName() || ours.count(source->GetName()) > 0 ||
      source == from->GetHigherOrderDegrees())
    {
      continue;
    }
    vtkSmartPointer<vtkAbstractArray> copy;
    copy.TakeReference(source->NewInstance());
    copy->SetName(source->GetName());
    copy->SetNumberOfComponents(source->GetNumberOfComponents());
    copy->CopyComponentNames(source);
    copy->SetNumberOfTuples(output->GetNumberOfCells());
    const std::vector<double> zeros(static_cast<std::size_t>(source->GetNumberOfComponents()), 0.0);
    for (vtkIdType cell = 0; cell < output->GetNumberOfCells(); ++cell)
    {
      const vtkIdType id = sourceCells[static_cast<std::size_t>(cell)];
      if (id >= 0 && id < numSources)
      {
        copy->SetTuple(cell, id, source);
      }
      else if (auto* numbers = vtkDataArray::SafeDownCast(copy))
      {
        numbers->SetTuple(cell, zeros.data());
      }
    }
    output->GetCellData()->AddArray(copy);
  }
}
}
