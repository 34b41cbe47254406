// SPDX-License-Identifier: BSD-3-Clause
#include "BezierCells.h"
#include "SplineSchema.h"
#include "TopologyTable.h"
#include <knotwork/SplineCore/BezierSpace.h>
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineCore/Recovery.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkCellTypes.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkFieldData.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>

namespace knotwork
{
namespace
{
using AnySpace = std::variant<SplineSpacePtr<1>, SplineSpacePtr<2>, SplineSpacePtr<3>>;

std::string Patch(int id)
{
  return "patch " + std::to_string(id);
}

// Whole numbers of a cell array, whatever type a filter gave them.
Status ReadCellIntegers(vtkUnstructuredGrid* grid, const char* arrayName, std::vector<int>& values)
{
  vtkAbstractArray* any = grid->GetCellData()->GetAbstractArray(arrayName);
  if (!any)
  {
    return {};
  }
  vtkDataArray* array = vtkDataArray::SafeDownCast(any);
  const std::string what = std::string("cell array ") + arrayName;
  if (!array || array->GetNumberOfComponents() != 1 ||
    array->GetNumberOfTuples() != grid->GetNumberOfCells())
  {
    return { ErrorCode::InvalidTopology, what + " is not one number a cell" };
  }
  values.resize(static_cast<std::size_t>(array->GetNumberOfTuples()));
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    const double value = array->GetComponent(static_cast<vtkIdType>(i), 0);
    if (!(std::abs(value) <= std::numeric_limits<int>::max()) || value != std::floor(value))
    {
      return { ErrorCode::InvalidTopology,
        what + (" is " + Digits(value)) + " at " + CellName(static_cast<vtkIdType>(i)) +
          ": not a whole number" };
    }
    values[i] = static_cast<int>(value);
  }
  return {};
}

// Cells that belong together, in the order of the grid.
struct CellGroup
{
  int Id = 0;
  int Basis = 0; // PatchBasis
  std::vector<vtkIdType> Cells;
};

// The cells of one patch in element order with what they consist of.
template <int Dim>
struct PatchCells
{
  std::vector<vtkIdType> Cells;
  std::vector<IntArray<Dim>> Degrees;
  std::vector<vtkIdType> Points; // ids, first direction fastest within an element
  Checksum Sum;                  // of their geometry
  bool Weighted = false;         // whether a point has a weight that is not 1
};

class GridReader
{
public:
  GridReader(vtkUnstructuredGrid* grid, int block, vtkIdType firstCell, std::set<int>& usedIds,
    int threads, SplineModel& model)
    : Grid(grid), Bezier(grid), Block(block), FirstCell(firstCell), UsedIds(usedIds),
      Threads(threads), Model(model)
  {
  }
  Status Read();

private:
  Status CheckCells();
  Status FindArrays();
  Status GroupCells(std::vector<CellGroup>& groups);
  Status ReadGroup(const CellGroup& group);
  Status SplitCopies(
    const CellGroup& group, int numElements, std::vector<std::vector<vtkIdType>>& copies);
  template <int Dim>
  Status ReadStructured(const CellGroup& group, const PatchRecord& record);
  template <int Dim>
  Status ReadBezier(const CellGroup& group);
  template <int Dim>
  Status Gather(
    const std::string& where, const SplineSpace<Dim>* space, PatchCells<Dim>& cells) const;
  template <int Dim>
  Status CheckBounds(const std::string& where, const SplineSpace<Dim>& space,
    const std::vector<vtkIdType>& cells) const;
  template <int Dim>
  Status ReadFields(const std::string& where, const PatchRecord& record,
    const PatchCells<Dim>& cells, const Spline<Dim>& spline, SplinePatch& patch);
  template <int Dim>
  Result<SplineSpacePtr<Dim>> Space(const PatchRecord& record);
  template <int Dim>
  PointMatrix RowsOf(const PatchCells<Dim>& cells) const;
  Status CheckField(const std::string& where, vtkDataArray* array,
    const std::vector<vtkIdType>& points, Checksum& sum, bool& isZero) const;
  const PatchRecord* FindRecord(const CellGroup& group) const;
  void ReadSides(const std::map<int, PatchPlace>& places);
  int TakeId(int wanted);
  void Warn(const std::string& text)
  {
    const auto& all = this->Model.Warnings;
    if (std::find(all.begin(), all.end(), text) == all.end())
    {
      this->Model.Warnings.push_back(text);
    }
  }
  double Epsilon() const
  {
    return this->Grid->GetPoints()->GetDataType() == VTK_FLOAT
      ? static_cast<double>(std::numeric_limits<float>::epsilon())
      : std::numeric_limits<double>::epsilon();
  }

  vtkUnstructuredGrid* Grid;
  BezierCells Bezier;
  int Block;
  vtkIdType FirstCell;
  std::set<int>& UsedIds;
  int Threads;
  SplineModel& Model;
  SplineSchema Schema;
  std::vector<int> PatchIds, ElementIds, Bases;
  std::vector<vtkDataArray*> Fields;
  std::map<int, std::pair<SpaceDefinition, AnySpace>> Spaces;
};

Status GridReader::CheckCells()
{
  const vtkIdType numPoints = this->Grid->GetNumberOfPoints();
  std::vector<vtkIdType> lastCell(static_cast<std::size_t>(numPoints), -1);
  for (vtkIdType cell = 0; cell < this->Grid->GetNumberOfCells(); ++cell)
  {
    const int type = this->Grid->GetCellType(cell);
    if (BezierCellDimension(type) == 0)
    {
      const char* typeName = vtkCellTypes::GetClassNameFromTypeId(type);
      return { ErrorCode::InvalidTopology,
        CellName(cell) + " is a " + (typeName ? typeName : "cell") + " (type " +
          std::to_string(type) + "): splines are Bezier curves, quadrilaterals and hexahedra" };
    }
    vtkIdType count = 0;
    const vtkIdType* points = nullptr;
    this->Grid->GetCellPoints(cell, count, points);
    const auto where = [&]
    {
      return (this->PatchIds.empty()
                 ? std::string()
                 : Patch(this->PatchIds[static_cast<std::size_t>(cell)]) + ", ") +
        CellName(cell);
    };
    for (vtkIdType i = 0; i < count; ++i)
    {
      if (points[i] < 0 || points[i] >= numPoints)
      {
        return { ErrorCode::InvalidTopology,
          where() + " uses point " + std::to_string(points[i]) + " of " +
            std::to_string(numPoints) };
      }
      if (lastCell[static_cast<std::size_t>(points[i])] == cell)
      {
        return { ErrorCode::InvalidTopology,
          where() + " has point " + std::to_string(points[i]) +
            " twice: points of a Bezier cell must not be merged" };
      }
      lastCell[static_cast<std::size_t>(points[i])] = cell;
    }
  }
  return {};
}

Status GridReader::FindArrays()
{
  for (auto [arrayName, values] : { std::make_pair(name::PatchId, &this->PatchIds),
         std::make_pair(name::ElementId, &this->ElementIds),
         std::make_pair(name::Basis, &this->Bases) })
  {
    if (Status status = ReadCellIntegers(this->Grid, arrayName, *values); !status)
    {
      return status;
    }
  }
  vtkPointData* pointData = this->Grid->GetPointData();
  for (int a = 0; a < pointData->GetNumberOfArrays(); ++a)
  {
    vtkAbstractArray* any = pointData->GetAbstractArray(a);
    const std::string arrayName = any && any->GetName() ? any->GetName() : "";
    if (!any || arrayName == name::Weights || arrayName == name::WeightsCopy ||
      any == pointData->GetRationalWeights() || arrayName.rfind("vtk", 0) == 0)
    {
      continue;
    }
    vtkDataArray* array = vtkDataArray::SafeDownCast(any);
    const bool floating =
      array && (array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE);
    if (floating && !arrayName.empty() && array->GetNumberOfComponents() > 0 &&
      array->GetNumberOfTuples() == this->Grid->GetNumberOfPoints())
    {
      this->Fields.push_back(array);
    }
    else
    {
      this->Warn("point array '" + arrayName +
        "' is dropped: only floating-point arrays are coefficients of a spline");
    }
  }
  return {};
}

Status GridReader::GroupCells(std::vector<CellGroup>& groups)
{
  std::map<std::array<int, 2>, std::size_t> known; // (PatchId or dimension, PatchBasis)
  for (vtkIdType cell = 0; cell < this->Grid->GetNumberOfCells(); ++cell)
  {
    const auto i = static_cast<std::size_t>(cell);
    const int dimension = BezierCellDimension(this->Grid->GetCellType(cell));
    const int id = this->PatchIds.empty() ? dimension : this->PatchIds[i];
    const int basis = this->Bases.empty() || this->PatchIds.empty() ? 0 : this->Bases[i];
    const auto [entry, isNew] = known.emplace(std::array<int, 2>{ id, basis }, groups.size());
    if (isNew)
    {
      groups.push_back({ id, basis, {} });
    }
    CellGroup& group = groups[entry->second];
    if (!group.Cells.empty() &&
      BezierCellDimension(this->Grid->GetCellType(group.Cells.front())) != dimension)
    {
      return { ErrorCode::InvalidTopology,
        Patch(id) + " has cells of different dimensions: " + CellName(group.Cells.front()) +
          " and " + CellName(cell) };
    }
    group.Cells.push_back(cell);
  }
  if (this->PatchIds.empty()) // one patch a dimension, numbered from 0
  {
    std::sort(groups.begin(), groups.end(),
      [](const CellGroup& a, const CellGroup& b) { return a.Id < b.Id; });
    int next = 0;
    for (CellGroup& group : groups)
    {
      group.Id = next++;
    }
  }
  return {};
}

// The record that defines a group's space: its own, or that of another patch with the same basis
// (patches may be renumbered).
const PatchRecord* GridReader::FindRecord(const CellGroup& group) const
{
  const PatchRecord* found = nullptr;
  for (const PatchRecord& record : this->Schema.Patches)
  {
    const bool sameId = !this->PatchIds.empty() && record.Id == group.Id;
    const bool sameBasis = this->Bases.empty() ? sameId : HashOf(record.Basis) == group.Basis;
    if (sameBasis && (sameId || !found))
    {
      found = &record;
      if (sameId)
      {
        break;
      }
    }
  }
  return found;
}

int GridReader::TakeId(int wanted)
{
  if (this->UsedIds.insert(wanted).second)
  {
    return wanted;
  }
  int id = 0;
  const auto isTaken = [&]
  {
    return this->UsedIds.count(id) > 0 ||
      std::find(this->PatchIds.begin(), this->PatchIds.end(), id) != this->PatchIds.end();
  };
  while (isTaken())
  {
    ++id;
  }
  this->UsedIds.insert(id);
  this->Warn(
    Patch(wanted) + " occurs more than once; another one is now patch " + std::to_string(id));
  return id;
}

Status GridReader::Read()
{
  if (this->Grid->GetNumberOfCells() == 0)
  {
    return {};
  }
  if (Status status = this->FindArrays(); !status)
  {
    return status;
  }
  if (Status status = this->CheckCells(); !status)
  {
    return status;
  }
  Result<SplineSchema> schema = ReadSchema(this->Grid->GetFieldData());
  if (!schema)
  {
    return schema.Status;
  }
  this->Schema = std::move(schema.Value);
  std::vector<CellGroup> groups;
  if (Status status = this->GroupCells(groups); !status)
  {
    return status;
  }
  std::map<int, PatchPlace> places;
  for (const CellGroup& group : groups)
  {
    const std::size_t first = this->Model.Patches.size();
    if (Status status = this->ReadGroup(group); !status)
    {
      return status;
    }
    if (first < this->Model.Patches.size()) // of copies with one number the first has the topology
    {
      places.try_emplace(group.Id,
        PatchPlace{ static_cast<int>(first),
          static_cast<int>(this->Model.Patches[first].Geometry.index()) + 1 });
    }
  }
  this->ReadSides(places);
  return {};
}

void GridReader::ReadSides(const std::map<int, PatchPlace>& places)
{
  int lost = 0;
  const PatchTopology read = ReadTopology(this->Grid->GetFieldData(), places, lost);
  PatchTopology& all = this->Model.Topology;
  all.Interfaces.insert(all.Interfaces.end(), read.Interfaces.begin(), read.Interfaces.end());
  all.Boundary.insert(all.Boundary.end(), read.Boundary.begin(), read.Boundary.end());
  if (lost > 0)
  {
    this->Warn(std::to_string(lost) +
      " interfaces or boundaries of patches that are not there are left out");
  }
}

Status GridReader::ReadGroup(const CellGroup& group)
{
  const PatchRecord* record = this->FindRecord(group);
  const int dimension = BezierCellDimension(this->Grid->GetCellType(group.Cells.front()));
  if (!record)
  {
    const bool lost = this->Bases.empty() ? this->Schema.Present : group.Basis != 0;
    if (lost)
    {
      this->Warn(Patch(group.Id) +
        " lost the definition of its basis (appending grids keeps only the field data of the "
        "first): it is read as a set of Bezier elements");
    }
    return dimension == 1 ? this->ReadBezier<1>(group)
      : dimension == 2    ? this->ReadBezier<2>(group)
                          : this->ReadBezier<3>(group);
  }
  if (record->Basis.Dimension != dimension)
  {
    return { ErrorCode::InvalidTopology,
      Patch(group.Id) + ", " + CellName(group.Cells.front()) + ": the cell has dimension " +
        std::to_string(dimension) + ", the patch " + std::to_string(record->Basis.Dimension) };
  }
  return dimension == 1 ? this->ReadStructured<1>(group, *record)
    : dimension == 2    ? this->ReadStructured<2>(group, *record)
                        : this->ReadStructured<3>(group, *record);
}

// Cells by element. An appended copy of a patch has the same numbers: the k-th cells of all
// elements form copy k, which the points confirm.
Status GridReader::SplitCopies(
  const CellGroup& group, int numElements, std::vector<std::vector<vtkIdType>>& copies)
{
  const std::string where = Patch(group.Id);
  const std::string elements = std::to_string(numElements) + " elements";
  if (this->ElementIds.empty())
  {
    return { ErrorCode::InvalidTopology,
      where + ": the cell array ElementId is missing, its " + elements + " have no order" };
  }
  std::vector<int> present;
  for (vtkIdType cell : group.Cells)
  {
    present.push_back(this->ElementIds[static_cast<std::size_t>(cell)]);
    if (present.back() < 0 || present.back() >= numElements)
    {
      return { ErrorCode::InvalidTopology,
        where + ", " + CellName(cell) + ": ElementId is " + std::to_string(present.back()) +
          ", the patch has " + elements };
    }
  }
  std::sort(present.begin(), present.end());
  present.erase(std::unique(present.begin(), present.end()), present.end());
  if (const int missing = numElements - static_cast<int>(present.size()); missing > 0)
  {
    std::string list;
    int listed = 0;
    for (int e = 0; listed < missing && listed < 5; ++e)
    {
      if (!std::binary_search(present.begin(), present.end(), e))
      {
        list += (listed++ > 0 ? ", " : "") + std::to_string(e);
      }
    }
    return { ErrorCode::InvalidTopology,
      where + ": " + std::to_string(missing) + " of " + elements + " missing: " + list +
        (listed < missing ? ", ..." : "") + "; keep or remove whole patches" };
  }
  std::vector<int> count(static_cast<std::size_t>(numElements), 0);
  copies.clear();
  for (vtkIdType cell : group.Cells)
  {
    const auto element = static_cast<std::size_t>(this->ElementIds[static_cast<std::size_t>(cell)]);
    const auto copy = static_cast<std::size_t>(count[element]++);
    if (copy == copies.size())
    {
      copies.emplace_back(static_cast<std::size_t>(numElements), -1);
    }
    copies[copy][element] = cell;
  }
  const int fewest = *std::min_element(count.begin(), count.end());
  for (int e = 0; e < numElements; ++e)
  {
    if (count[static_cast<std::size_t>(e)] != fewest)
    {
      const auto i = static_cast<std::size_t>(e);
      return { ErrorCode::InvalidTopology,
        where + ": element " + std::to_string(e) + " occurs " + std::to_string(count[i]) +
          " times (" + CellName(copies[0][i]) + ", " + CellName(copies[1][i]) + "), others " +
          std::to_string(fewest) };
    }
  }
  if (copies.size() > 1)
  {
    std::vector<int> owner(static_cast<std::size_t>(this->Grid->GetNumberOfPoints()), -1);
    for (std::size_t k = 0; k < copies.size(); ++k)
    {
      for (vtkIdType cell : copies[k])
      {
        vtkIdType n = 0;
        const vtkIdType* points = nullptr;
        this->Grid->GetCellPoints(cell, n, points);
        for (vtkIdType i = 0; i < n; ++i)
        {
          int& of = owner[static_cast<std::size_t>(points[i])];
          if (of >= 0 && of != static_cast<int>(k))
          {
            return { ErrorCode::InvalidTopology,
              where + ", " + CellName(cell) + ": the patch occurs " +
                std::to_string(copies.size()) + " times and its copies cannot be told apart" };
          }
          of = static_cast<int>(k);
        }
      }
    }
  }
  return {};
}

template <int Dim>
Status GridReader::Gather(
  const std::string& where, const SplineSpace<Dim>* space, PatchCells<Dim>& cells) const
{
  std::vector<vtkIdType> points;
  for (vtkIdType cell : cells.Cells)
  {
    IntArray<Dim> degree{};
    const IntArray<Dim>* expected = space ? &space->Elements[cells.Degrees.size()].Degree : nullptr;
    if (Status status = this->Bezier.Read<Dim>(where + ", ", cell, expected, degree, points);
        !status)
    {
      return status;
    }
    if (cells.Points.empty())
    {
      cells.Degrees.reserve(cells.Cells.size());
      cells.Points.reserve(cells.Cells.size() * points.size());
    }
    cells.Points.insert(cells.Points.end(), points.begin(), points.end());
    cells.Degrees.push_back(degree);
  }
  // not kept: of many elements, Bezier points of all need more memory than the grid
  cells.Sum = BeginGeometryChecksum<Dim>(cells.Degrees);
  const std::string opening = where + ", ";
  std::size_t i = 0;
  for (std::size_t e = 0; e < cells.Cells.size(); ++e)
  {
    for (int k = 0; k < NumTensorFunctions<Dim>(cells.Degrees[e]); ++k, ++i)
    {
      std::array<double, 4> row{};
      if (Status status =
            this->Bezier.ReadPoint(opening, cells.Cells[e], cells.Points[i], row.data());
          !status)
      {
        return status;
      }
      std::for_each(row.begin(), row.end(), [&](double value) { cells.Sum.Add(value); });
      cells.Weighted = cells.Weighted || row[3] != 1.0;
    }
  }
  return {};
}

/// Of gathered cells x, y, z, w of all points.
template <int Dim>
PointMatrix GridReader::RowsOf(const PatchCells<Dim>& cells) const
{
  PointMatrix rows(static_cast<Eigen::Index>(cells.Points.size()), 4);
  std::size_t i = 0;
  for (std::size_t e = 0; e < cells.Cells.size(); ++e)
  {
    for (int k = 0; k < NumTensorFunctions<Dim>(cells.Degrees[e]); ++k, ++i)
    {
      static_cast<void>(this->Bezier.ReadPoint({}, cells.Cells[e], cells.Points[i],
        rows.row(static_cast<Eigen::Index>(i)).data())); // has been checked
    }
  }
  return rows;
}

PointMatrix ValuesOf(vtkDataArray* array, const std::vector<vtkIdType>& points)
{
  PointMatrix values(static_cast<Eigen::Index>(points.size()), array->GetNumberOfComponents());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    array->GetTuple(points[i], values.row(static_cast<Eigen::Index>(i)).data());
  }
  return values;
}

/// @param sum     of the values.
/// @param isZero  whether all are 0.
Status GridReader::CheckField(const std::string& where, vtkDataArray* array,
  const std::vector<vtkIdType>& points, Checksum& sum, bool& isZero) const
{
  Eigen::RowVectorXd row(array->GetNumberOfComponents());
  sum.Add(static_cast<std::uint64_t>(row.size()));
  isZero = true;
  bool isFinite = true;
  bool isWithinLimit = true;
  for (const vtkIdType point : points)
  {
    array->GetTuple(point, row.data());
    for (const double value : row)
    {
      isFinite = isFinite && std::isfinite(value);
      isWithinLimit = isWithinLimit && std::abs(value) <= LargestNumber;
      isZero = isZero && value == 0.0;
      sum.Add(value);
    }
  }
  if (!isFinite)
  {
    return { ErrorCode::NonFiniteInput,
      where + ": the point array '" + array->GetName() + "' has a value that is not finite" };
  }
  if (!isWithinLimit)
  {
    return { ErrorCode::TooLarge,
      where + ": point array '" + array->GetName() + "': " + BeyondLimit() };
  }
  return {};
}

template <int Dim>
Status GridReader::CheckBounds(const std::string& where, const SplineSpace<Dim>& space,
  const std::vector<vtkIdType>& cells) const
{
  vtkDataArray* bounds = this->Grid->GetCellData()->GetArray(name::Bounds);
  if (!space.HasDomain() || !bounds || bounds->GetNumberOfComponents() != 6 ||
    bounds->GetNumberOfTuples() != this->Grid->GetNumberOfCells())
  {
    return {};
  }
  const ParametricBox<Dim> domain = space.Domain();
  for (std::size_t e = 0; e < cells.size(); ++e)
  {
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const double slack = 1e-6 * (domain.Upper[d] - domain.Lower[d]); // the array may be float
      const int c = 2 * static_cast<int>(d);
      const ParametricBox<Dim>& box = space.Elements[e].Box;
      if (!(std::abs(bounds->GetComponent(cells[e], c) - box.Lower[d]) <= slack) ||
        !(std::abs(bounds->GetComponent(cells[e], c + 1) - box.Upper[d]) <= slack))
      {
        return { ErrorCode::InvalidTopology,
          where + ", " + CellName(cells[e]) + ": " + name::Bounds + " and " + name::ElementId +
            " " + std::to_string(e) + " do not fit together" };
      }
    }
  }
  return {};
}

template <int Dim>
Result<SplineSpacePtr<Dim>> GridReader::Space(const PatchRecord& record)
{
  const int hash = HashOf(record.Basis);
  const auto known = this->Spaces.find(hash);
  if (known != this->Spaces.end() && known->second.first == record.Basis)
  {
    return std::get<SplineSpacePtr<Dim>>(known->second.second);
  }
  Result<SplineSpacePtr<Dim>> made =
    FamilyOf<Dim>(record.Basis.Kind).Build(record.Basis, this->Threads);
  if (made &&
    (made.Value->NumElements() != record.NumElements ||
      made.Value->NumFunctions != record.NumFunctions))
  {
    made.Status = { ErrorCode::InvalidTopology,
      "its basis has " + std::to_string(made.Value->NumElements()) + " elements and " +
        std::to_string(made.Value->NumFunctions) + " functions, its record " +
        std::to_string(record.NumElements) + " and " + std::to_string(record.NumFunctions) };
  }
  if (made)
  {
    this->Spaces[hash] = { record.Basis, made.Value };
  }
  return made;
}

// Bezier form from gathered rows (x, y, z, w), homogeneous when rational.
template <int Dim>
BezierForm<Dim> FormOf(const SplineSpacePtr<Dim>& space, const PointMatrix& rows, int components,
  const Eigen::Index weightColumn)
{
  BezierForm<Dim> form;
  form.Space = space;
  form.NumComponents = components;
  form.Rational = weightColumn >= 0;
  form.Offsets.assign(1, 0);
  form.Data.reserve(static_cast<std::size_t>(rows.rows()) * form.NumPlanes());
  Eigen::Index first = 0;
  for (const auto& element : space->Elements)
  {
    const int n = NumTensorFunctions<Dim>(element.Degree);
    for (int c = 0; c < form.NumPlanes(); ++c)
    {
      for (Eigen::Index i = first; i < first + n; ++i)
      {
        const double w = form.Rational ? rows(i, weightColumn) : 1.0;
        form.Data.push_back(c < components ? w * rows(i, c) : w);
      }
    }
    first += n;
    form.Offsets.push_back(form.Data.size());
  }
  return form;
}

template <int Dim>
Status GridReader::ReadStructured(const CellGroup& group, const PatchRecord& record)
{
  std::vector<std::vector<vtkIdType>> copies;
  if (Status status = this->SplitCopies(group, record.NumElements, copies); !status)
  {
    return status;
  }
  const std::string where = Patch(group.Id);
  Result<SplineSpacePtr<Dim>> space = this->Space<Dim>(record);
  if (!space)
  {
    return { space.Status.Code, where + ": " + space.Status.Detail };
  }
  if (record.Rational && !this->Bezier.HasWeights())
  {
    return { ErrorCode::InvalidWeight,
      where + " is rational, and its weights are missing (point array " + name::Weights + ")" };
  }
  for (const std::vector<vtkIdType>& copy : copies)
  {
    PatchCells<Dim> cells;
    cells.Cells = copy;
    if (Status status = this->Gather<Dim>(where, space.Value.get(), cells); !status)
    {
      return status;
    }
    if (Status status = this->CheckBounds<Dim>(where, *space.Value, copy); !status)
    {
      return status;
    }
    const bool rational = record.Rational || cells.Weighted;
    SplinePatch patch;
    Spline<Dim> spline;
    spline.Space = space.Value;

    // A record of the same basis whose checksum fits holds the control points.
    const PatchRecord* cached = nullptr;
    for (const PatchRecord& other : this->Schema.Patches)
    {
      const PointMatrix& rows = other.ControlPoints.Rows;
      if (other.ControlPoints.Matches(cells.Sum) && other.Basis == record.Basis &&
        rows.rows() == space.Value->NumFunctions && rows.allFinite() &&
        (rows.col(3).array() > 0.0).all() && (!cached || other.Id == group.Id))
      {
        cached = &other;
      }
    }
    if (cached)
    {
      spline.ControlPoints = cached->ControlPoints.Rows.leftCols(3);
      if (cached->Rational)
      {
        spline.Weights = cached->ControlPoints.Rows.col(3);
      }
    }
    else
    {
      RecoveryResult<Dim> recovered = RecoverSpline(
        FormOf<Dim>(space.Value, this->RowsOf(cells), 3, rational ? 3 : -1), this->Threads);
      if (!recovered)
      {
        return { recovered.Status.Code, where + ": " + recovered.Status.Detail };
      }
      spline = std::move(recovered.Value);
      spline.Space = space.Value;
      patch.Recovered = true;
      patch.Residual = recovered.Residual;
      patch.Amplification = recovered.Amplification;
      const double rounding = 64.0 * this->Epsilon() * recovered.Amplification;
      if (recovered.Residual > rounding * recovered.Size || recovered.WeightResidual > rounding)
      {
        this->Warn(where +
          ": the points are not those of a spline of its space; they were projected, the largest "
          "distance is " +
          Digits(recovered.Residual));
      }
    }
    const Status status =
      this->ReadFields<Dim>(where, cached ? *cached : record, cells, spline, patch);
    if (!status)
    {
      return status;
    }
    patch.Id = this->TakeId(group.Id);
    patch.Block = this->Block;
    patch.Geometry = std::move(spline);
    for (vtkIdType cell : copy)
    {
      patch.Cells.push_back(this->FirstCell + cell);
    }
    this->Model.Patches.push_back(std::move(patch));
  }
  return {};
}

template <int Dim>
Status GridReader::ReadFields(const std::string& where, const PatchRecord& record,
  const PatchCells<Dim>& cells, const Spline<Dim>& spline, SplinePatch& patch)
{
  for (vtkDataArray* array : this->Fields)
  {
    SplineField field;
    field.Name = array->GetName();
    Checksum sum;
    bool isZero = true;
    if (Status status = this->CheckField(where, array, cells.Points, sum, isZero); !status)
    {
      return status;
    }
    const auto known = std::find_if(record.Fields.begin(), record.Fields.end(),
      [&](const FieldRecord& candidate) { return candidate.Name == field.Name; });
    if (known == record.Fields.end() && isZero)
    {
      continue; // a field of other patches
    }
    // Coefficients of a rational field belong to its weights: recovered weights, recovered field.
    if (known != record.Fields.end() && known->Cache.Matches(sum) &&
      known->Cache.Rows.rows() == spline.Space->NumFunctions &&
      known->Cache.Rows.cols() == array->GetNumberOfComponents() && known->Cache.Rows.allFinite() &&
      !(patch.Recovered && spline.IsRational()))
    {
      field.Coefficients = known->Cache.Rows;
    }
    else
    {
      RecoveryResult<Dim> recovered =
        RecoverField(FormOf<Dim>(spline.Space, ValuesOf(array, cells.Points),
                       array->GetNumberOfComponents(), -1),
          spline.Weights, this->Threads);
      if (!recovered)
      {
        return { recovered.Status.Code,
          where + ", field '" + field.Name + "': " + recovered.Status.Detail };
      }
      field.Coefficients = std::move(recovered.Value.ControlPoints);
      const double epsilon = array->GetDataType() == VTK_FLOAT
        ? static_cast<double>(std::numeric_limits<float>::epsilon())
        : this->Epsilon();
      if (recovered.Residual > 64.0 * epsilon * recovered.Amplification * recovered.Size)
      {
        this->Warn(where + ", field '" + field.Name +
          "': the values are not those of a spline of the patch's space; they were projected, the "
          "largest distance is " +
          Digits(recovered.Residual));
      }
    }
    patch.Fields.push_back(std::move(field));
  }
  return {};
}

template <int Dim>
Status GridReader::ReadBezier(const CellGroup& group)
{
  const std::string where = Patch(group.Id);
  PatchCells<Dim> cells;
  cells.Cells = group.Cells;
  if (!this->ElementIds.empty()) // in element order, if there is one
  {
    const auto id = [&](vtkIdType cell)
    { return this->ElementIds[static_cast<std::size_t>(cell)]; };
    std::stable_sort(cells.Cells.begin(), cells.Cells.end(),
      [&](vtkIdType a, vtkIdType b) { return id(a) < id(b); });
    const auto same = std::adjacent_find(cells.Cells.begin(), cells.Cells.end(),
      [&](vtkIdType a, vtkIdType b) { return id(a) == id(b); });
    if (same != cells.Cells.end())
    {
      cells.Cells = group.Cells;
    }
  }
  if (Status status = this->Gather<Dim>(where, nullptr, cells); !status)
  {
    return status;
  }
  // The points are the control points, numbered as in the grid.
  std::vector<vtkIdType> used = cells.Points;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::vector<int> functions;
  functions.reserve(cells.Points.size());
  const PointMatrix all = this->RowsOf(cells);
  PointMatrix rows(static_cast<Eigen::Index>(used.size()), 4);
  for (std::size_t i = 0; i < cells.Points.size(); ++i)
  {
    const auto at = std::lower_bound(used.begin(), used.end(), cells.Points[i]) - used.begin();
    functions.push_back(static_cast<int>(at));
    rows.row(at) = all.row(static_cast<Eigen::Index>(i));
  }
  Result<SplineSpacePtr<Dim>> space =
    MakeBezierSpace<Dim>(cells.Degrees, functions, static_cast<int>(used.size()));
  if (!space)
  {
    return { space.Status.Code, where + ": " + space.Status.Detail };
  }
  SplinePatch patch;
  Spline<Dim> spline;
  spline.Space = space.Value;
  spline.ControlPoints = rows.leftCols(3);
  if ((rows.col(3).array() != 1.0).any())
  {
    spline.Weights = rows.col(3);
  }
  for (vtkDataArray* array : this->Fields)
  {
    Checksum ignored;
    bool isZero = true;
    if (Status status = this->CheckField(where, array, used, ignored, isZero); !status)
    {
      return status;
    }
    SplineField field{ array->GetName(), ValuesOf(array, used) };
    patch.Fields.push_back(std::move(field));
  }
  patch.Id = this->TakeId(group.Id);
  patch.Block = this->Block;
  patch.Geometry = std::move(spline);
  for (vtkIdType cell : cells.Cells)
  {
    patch.Cells.push_back(this->FirstCell + cell);
  }
  this->Model.Patches.push_back(std::move(patch));
  return {};
}

Status DecodeCollection(
  vtkPartitionedDataSetCollection* collection, int threads, SplineModel& model)
{
  for (unsigned int b = 0; b < collection->GetNumberOfPartitionedDataSets(); ++b)
  {
    vtkPartitionedDataSet* block = collection->GetPartitionedDataSet(b);
    vtkIdType firstCell = 0;
    std::set<int> usedIds;
    for (unsigned int i = 0; block && i < block->GetNumberOfPartitions(); ++i)
    {
      vtkDataSet* piece = block->GetPartition(i);
      auto* grid = vtkUnstructuredGrid::SafeDownCast(piece);
      const std::string where = "block " + std::to_string(b);
      if (!grid)
      {
        if (piece)
        {
          model.Warnings.push_back(
            where + " has a " + piece->GetClassName() + ", which is no spline: it passes as it is");
        }
        continue;
      }
      const Status status =
        GridReader(grid, static_cast<int>(b), firstCell, usedIds, threads, model).Read();
      if (!status)
      {
        return { status.Code, where + ": " + status.Detail };
      }
      firstCell += grid->GetNumberOfCells();
    }
  }
  return {};
}
}

Result<SplineModel> DecodeSplineModel(vtkDataObject* data, int threads)
{
  SplineModel model;
  Status status;
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(data))
  {
    std::set<int> usedIds;
    status = GridReader(grid, 0, 0, usedIds, threads, model).Read();
  }
  else if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(data))
  {
    status = DecodeCollection(collection, threads, model);
  }
  else
  {
    status = { ErrorCode::InvalidTopology,
      std::string(data ? data->GetClassName() : "nothing") +
        " is no spline: needed is a vtkUnstructuredGrid of Bezier cells or a "
        "vtkPartitionedDataSetCollection of such grids" };
  }
  if (!status)
  {
    return status;
  }
  return model;
}
}
