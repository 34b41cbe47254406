// SPDX-License-Identifier: BSD-3-Clause
#include "GridReader.h"

#include <knotwork/SplineCore/Numbers.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkCellTypes.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

namespace knotwork
{
namespace
{
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
}

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
                 : PatchName(this->PatchIds[static_cast<std::size_t>(cell)]) + ", ") +
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
        PatchName(id) + " has cells of different dimensions: " + CellName(group.Cells.front()) +
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

void GridReader::IndexRecords()
{
  for (std::size_t r = 0; r < this->Schema.Patches.size(); ++r)
  {
    const PatchRecord& record = this->Schema.Patches[r];
    const int basis = HashOf(record.Basis);
    this->RecordsById.emplace(record.Id, r);
    this->RecordsByBasis.emplace(basis, r);
    this->RecordsByBoth.emplace(std::array<int, 2>{ basis, record.Id }, r);
    if (record.ControlPoints.Rows.rows() > 0)
    {
      this->Caches.emplace(record.ControlPoints.Matching(), r);
    }
  }
}

// The record that defines a group's space: its own, or that of another patch with the same basis
// (patches may be renumbered).
const PatchRecord* GridReader::FindRecord(const CellGroup& group) const
{
  const auto at = [this](const auto& index, const auto& key)
  {
    const auto found = index.find(key);
    return found == index.end() ? nullptr : &this->Schema.Patches[found->second];
  };
  if (this->PatchIds.empty())
  {
    return this->Bases.empty() ? nullptr : at(this->RecordsByBasis, group.Basis);
  }
  if (this->Bases.empty())
  {
    return at(this->RecordsById, group.Id);
  }
  const PatchRecord* own = at(this->RecordsByBoth, std::array<int, 2>{ group.Basis, group.Id });
  return own ? own : at(this->RecordsByBasis, group.Basis);
}

// A record of a basis with the control points of a grid, best that of a patch with a number.
const PatchRecord* GridReader::FindCache(
  const Checksum& sum, const SpaceDefinition& basis, int numFunctions, int id) const
{
  const PatchRecord* found = nullptr;
  const auto [begin, end] = this->Caches.equal_range(sum.Value());
  for (auto entry = begin; entry != end && !(found && found->Id == id); ++entry)
  {
    const PatchRecord& record = this->Schema.Patches[entry->second];
    const PointMatrix& rows = record.ControlPoints.Rows;
    if ((!found || record.Id == id) && record.Basis == basis && rows.rows() == numFunctions &&
      rows.allFinite() && (rows.col(3).array() > 0.0).all())
    {
      found = &record;
    }
  }
  return found;
}

int GridReader::TakeId(int wanted)
{
  if (this->Numbers.Used.insert(wanted).second)
  {
    return wanted;
  }
  if (this->GridIds.empty())
  {
    this->GridIds.insert(this->PatchIds.begin(), this->PatchIds.end());
  }
  int& id = this->Numbers.Next;
  while (this->Numbers.Used.count(id) > 0 || this->GridIds.count(id) > 0)
  {
    ++id;
  }
  this->Numbers.Used.insert(id);
  this->Warn(
    PatchName(wanted) + " occurs more than once; another one is now patch " + std::to_string(id));
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
  this->IndexRecords();
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
      this->Warn(PatchName(group.Id) +
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
      PatchName(group.Id) + ", " + CellName(group.Cells.front()) + ": the cell has dimension " +
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
  const std::string where = PatchName(group.Id);
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
    std::unordered_map<vtkIdType, std::size_t> owner;
    for (std::size_t k = 0; k < copies.size(); ++k)
    {
      for (vtkIdType cell : copies[k])
      {
        vtkIdType n = 0;
        const vtkIdType* points = nullptr;
        this->Grid->GetCellPoints(cell, n, points);
        for (vtkIdType i = 0; i < n; ++i)
        {
          if (owner.emplace(points[i], k).first->second != k)
          {
            return { ErrorCode::InvalidTopology,
              where + ", " + CellName(cell) + ": the patch occurs " +
                std::to_string(copies.size()) + " times and its copies cannot be told apart" };
          }
        }
      }
    }
  }
  return {};
}
}
