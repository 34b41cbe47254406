// SPDX-License-Identifier: BSD-3-Clause
#include "SplineSchema.h"

#include "FieldTables.h"
#include "TopologyTable.h"

#include "vtkFieldData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>

namespace knotwork
{
namespace
{
constexpr const char* VersionArray = "KnotworkSchemaVersion";
constexpr const char* PatchArray = "KnotworkPatches";
constexpr const char* KnotArray = "KnotworkKnots";
constexpr const char* PointArray = "KnotworkControlPoints";
constexpr const char* FieldNameArray = "KnotworkFieldNames";
constexpr const char* FieldRowArray = "KnotworkFieldRows";
constexpr const char* FieldChecksumArray = "KnotworkFieldChecksums";
constexpr const char* FieldPrefix = "KnotworkField.";

// The arrays of a family's tables are named after them.
std::string TableArray(const DefinitionTableLayout& layout)
{
  return std::string("Knotwork") + layout.Name;
}

// Columns of KnotworkPatches. Boxes counts the rows of the family's first table.
enum Column
{
  Id,
  Kind,
  Dimension,
  Rational,
  Elements,
  Functions,
  Degree0,
  Knots0 = Degree0 + 3,
  Boxes = Knots0 + 3,
  BasisHash,
  GeometryCheck,
  NumColumns
};
const char* const ColumnNames[NumColumns] = { "PatchId", "Kind", "Dimension", "Rational",
  "Elements", "Functions", "Degree0", "Degree1", "Degree2", "Knots0", "Knots1", "Knots2", "Boxes",
  "PatchBasis", "Checksum" };

void Append(std::vector<double>& values, const PointMatrix& rows)
{
  values.insert(values.end(), rows.data(), rows.data() + rows.size());
}

Status Damaged(const std::string& what)
{
  return { ErrorCode::InvalidTopology,
    "field data of the spline grid is damaged: " + what +
      "; without the field data Knotwork* the grid is read as plain Bezier elements" };
}

// Takes the next count rows of a table; false when there are not so many.
bool TakeRows(const PointMatrix& table, Eigen::Index& next, Eigen::Index count, PointMatrix& rows)
{
  if (count > table.rows() - next)
  {
    return false;
  }
  rows = table.middleRows(next, count);
  next += count;
  return true;
}

// The definition part of a record. Counts are checked before anything is allocated.
Status ReadRecord(const IntegerTable& patches, std::size_t row, PatchRecord& record)
{
  constexpr std::int64_t most = std::numeric_limits<int>::max();
  const std::string patch = "patch " + std::to_string(patches.At(row, Id));
  for (int c = 0; c < BasisHash; ++c)
  {
    if (patches.At(row, c) > most || (c != Id && patches.At(row, c) < 0) ||
      patches.At(row, c) < -most)
    {
      return Damaged(patch + " has " + ColumnNames[c] + " " + std::to_string(patches.At(row, c)));
    }
  }
  const auto at = [&](int c) { return static_cast<int>(patches.At(row, c)); };
  record.Id = at(Id);
  record.Rational = at(Rational) != 0;
  record.NumElements = at(Elements);
  record.NumFunctions = at(Functions);
  record.Basis.Dimension = at(Dimension);
  if (record.Basis.Dimension < 1 || record.Basis.Dimension > 3)
  {
    return Damaged(patch + " has dimension " + std::to_string(record.Basis.Dimension));
  }
  const auto stored = [&](SpaceKind kind)
  { return at(Kind) > 0 && FamilyOf<2>(kind).StoredNumber() == at(Kind); };
  const auto kind = std::find_if(std::begin(AllSpaceKinds), std::end(AllSpaceKinds), stored);
  if (kind == std::end(AllSpaceKinds))
  {
    return Damaged(patch + " is of the unknown kind " + std::to_string(at(Kind)));
  }
  record.Basis.Kind = *kind;
  for (int d = 0; d < 3; ++d)
  {
    record.Basis.Degree[static_cast<std::size_t>(d)] = at(Degree0 + d);
  }
  record.ControlPoints.Stored = static_cast<std::uint64_t>(patches.At(row, GeometryCheck));
  return {};
}
}

int HashOf(const SpaceDefinition& basis)
{
  if (FamilyOf<2>(basis.Kind).StoredNumber() == 0)
  {
    return 0;
  }
  Checksum sum;
  sum.Add(static_cast<std::uint64_t>(basis.Kind));
  sum.Add(static_cast<std::uint64_t>(basis.Dimension));
  for (std::size_t d = 0; d < 3; ++d)
  {
    sum.Add(static_cast<std::uint64_t>(basis.Degree[d]));
    for (double knot : basis.Knots[d])
    {
      sum.Add(knot + 0.0); // -0 and 0 are the same knot
    }
  }
  for (const DefinitionTable& table : basis.Tables)
  {
    for (std::int64_t value : table.Whole)
    {
      sum.Add(static_cast<std::uint64_t>(value));
    }
    for (double value : table.Real)
    {
      sum.Add(value);
    }
  }
  return 1 + static_cast<int>(sum.Value() % 0x7ffffffeU);
}

namespace
{
/// A table of a family in the grid, the rows of one patch after those of another.
struct StoredTable
{
  IntegerTable Whole;
  PointMatrix Real;
  std::size_t Next = 0;

  /// Moves the next rows to a definition; false when there are not so many.
  bool Take(const DefinitionTableLayout& layout, std::size_t rows, DefinitionTable& table)
  {
    const std::size_t all =
      layout.IsWhole ? this->Whole.Rows() : static_cast<std::size_t>(this->Real.rows());
    if (rows > all - this->Next)
    {
      return false;
    }
    const std::size_t columns = layout.Columns.size();
    const auto begin = static_cast<std::ptrdiff_t>(this->Next * columns);
    const auto end = static_cast<std::ptrdiff_t>((this->Next + rows) * columns);
    if (layout.IsWhole)
    {
      table.Whole.assign(this->Whole.Values.begin() + begin, this->Whole.Values.begin() + end);
    }
    else
    {
      table.Real.assign(this->Real.data() + begin, this->Real.data() + end);
    }
    this->Next += rows;
    return true;
  }
};

/// How the tables of a definition are stored.
const std::vector<DefinitionTableLayout>& LayoutsOf(const SpaceDefinition& basis)
{
  return basis.Dimension == 3 ? FamilyOf<3>(basis.Kind).Tables() : FamilyOf<2>(basis.Kind).Tables();
}

/// The tables of all families.
class StoredTables
{
public:
  /// @return a status with a detail for Damaged.
  Status Take(vtkFieldData* fieldData, std::size_t firstRows, PatchRecord& record)
  {
    const SpaceDefinition& basis = record.Basis;
    const std::vector<DefinitionTableLayout>& layouts = LayoutsOf(basis);
    record.Basis.Tables.resize(layouts.size());
    for (std::size_t t = 0; t < layouts.size(); ++t)
    {
      const std::size_t rows = t == 0 ? firstRows
        : basis.Dimension == 3 ? FamilyOf<3>(basis.Kind).NumRows(basis, record.NumFunctions, t)
                               : FamilyOf<2>(basis.Kind).NumRows(basis, record.NumFunctions, t);
      StoredTable& stored = this->Find(fieldData, layouts[t]);
      if (!stored.Take(layouts[t], rows, record.Basis.Tables[t]))
      {
        return { ErrorCode::InvalidTopology, TableArray(layouts[t]) + " ends before the rows" };
      }
    }
    return {};
  }

private:
  StoredTable& Find(vtkFieldData* fieldData, const DefinitionTableLayout& layout)
  {
    const auto [place, isNew] = this->Read.try_emplace(layout.Name);
    StoredTable& table = place->second;
    const auto columns = static_cast<int>(layout.Columns.size());
    if (isNew && layout.IsWhole)
    {
      ReadIntegers(fieldData, TableArray(layout).c_str(), columns, table.Whole);
    }
    else if (isNew && ReadDoubles(fieldData, TableArray(layout).c_str(), table.Real) &&
      table.Real.cols() != columns)
    {
      table.Real.resize(0, columns);
    }
    return table;
  }

  std::map<std::string, StoredTable> Read;
};
}

void WriteSchema(const SplineSchema& schema, vtkFieldData* fieldData)
{
  std::vector<std::int64_t> patches, fieldRows, fieldChecksums;
  std::vector<double> knots, points;
  std::map<SpaceKind, std::vector<std::pair<const DefinitionTableLayout*, DefinitionTable>>> tables;
  std::vector<std::string> names;
  std::vector<std::vector<double>> fields;
  std::vector<int> components;
  for (const PatchRecord& record : schema.Patches)
  {
    for (const FieldRecord& field : record.Fields)
    {
      if (std::find(names.begin(), names.end(), field.Name) == names.end())
      {
        names.push_back(field.Name);
        components.push_back(static_cast<int>(field.Cache.Rows.cols()));
      }
    }
  }
  fields.resize(names.size());
  for (const PatchRecord& record : schema.Patches)
  {
    const SpaceDefinition& basis = record.Basis;
    std::array<std::int64_t, NumColumns> row{ record.Id, FamilyOf<2>(basis.Kind).StoredNumber(),
      basis.Dimension, record.Rational, record.NumElements, record.NumFunctions };
    for (std::size_t d = 0; d < 3; ++d)
    {
      row[Degree0 + d] = basis.Degree[d];
      row[Knots0 + d] = static_cast<std::int64_t>(basis.Knots[d].size());
      knots.insert(knots.end(), basis.Knots[d].begin(), basis.Knots[d].end());
    }
    const std::vector<DefinitionTableLayout>& layouts = LayoutsOf(basis);
    auto& stored = tables[basis.Kind];
    for (std::size_t t = 0; t < layouts.size(); ++t)
    {
      const DefinitionTable& table = basis.Tables[t];
      auto place = std::find_if(stored.begin(), stored.end(),
        [&](const auto& other) { return std::strcmp(other.first->Name, layouts[t].Name) == 0; });
      if (place == stored.end())
      {
        place = stored.insert(stored.end(), { &layouts[t], DefinitionTable() });
      }
      DefinitionTable& rows = place->second;
      rows.Whole.insert(rows.Whole.end(), table.Whole.begin(), table.Whole.end());
      rows.Real.insert(rows.Real.end(), table.Real.begin(), table.Real.end());
      if (t == 0)
      {
        row[Boxes] = static_cast<std::int64_t>(
          (table.Whole.size() + table.Real.size()) / layouts[t].Columns.size());
      }
    }
    row[BasisHash] = HashOf(basis);
    row[GeometryCheck] = static_cast<std::int64_t>(record.ControlPoints.Stored);
    patches.insert(patches.end(), row.begin(), row.end());
    Append(points, record.ControlPoints.Rows);
    for (std::size_t f = 0; f < names.size(); ++f)
    {
      std::int64_t fieldRow = 0;
      std::int64_t checksum = 0;
      for (const FieldRecord& field : record.Fields)
      {
        if (field.Name == names[f])
        {
          fieldRow = field.Cache.Rows.rows();
          checksum = static_cast<std::int64_t>(field.Cache.Stored);
          Append(fields[f], field.Cache.Rows);
        }
      }
      fieldRows.push_back(fieldRow);
      fieldChecksums.push_back(checksum);
    }
  }

  const bool hasTopology = WriteTopology(schema.Topology, fieldData);
  vtkNew<vtkIntArray> version;
  version->SetName(VersionArray);
  version->InsertNextValue(hasTopology ? SchemaVersion : 1);
  fieldData->AddArray(version);
  if (patches.empty())
  {
    return;
  }
  WriteIntegers(fieldData, PatchArray, NumColumns, patches, ColumnNames);
  WriteDoubles(fieldData, KnotArray, 1, knots);
  for (const auto& [kind, stored] : tables)
  {
    for (const auto& [layout, rows] : stored)
    {
      const auto columns = static_cast<int>(layout->Columns.size());
      if (!rows.Whole.empty())
      {
        WriteIntegers(fieldData, TableArray(*layout), columns, rows.Whole,
          columns > 1 ? layout->Columns.data() : nullptr);
      }
      if (!rows.Real.empty())
      {
        WriteDoubles(fieldData, TableArray(*layout), columns, rows.Real);
      }
    }
  }
  WriteDoubles(fieldData, PointArray, 4, points);
  if (names.empty())
  {
    return;
  }
  vtkNew<vtkStringArray> fieldNames;
  fieldNames->SetName(FieldNameArray);
  for (const std::string& name : names)
  {
    fieldNames->InsertNextValue(name);
  }
  fieldData->AddArray(fieldNames);
  WriteIntegers(fieldData, FieldRowArray, static_cast<int>(names.size()), fieldRows);
  WriteIntegers(fieldData, FieldChecksumArray, static_cast<int>(names.size()), fieldChecksums);
  for (std::size_t f = 0; f < names.size(); ++f)
  {
    WriteDoubles(fieldData, FieldPrefix + names[f], components[f], fields[f]);
  }
}

Result<SplineSchema> ReadSchema(vtkFieldData* fieldData)
{
  SplineSchema schema;
  if (!fieldData || !fieldData->GetAbstractArray(VersionArray))
  {
    return schema;
  }
  IntegerTable version;
  if (!ReadIntegers(fieldData, VersionArray, 1, version) || version.Rows() != 1)
  {
    return Damaged(std::string(VersionArray) + " is not one whole number");
  }
  if (version.At(0, 0) < 1 || version.At(0, 0) > SchemaVersion)
  {
    return { ErrorCode::InvalidTopology,
      "the spline grid has schema version " + std::to_string(version.At(0, 0)) +
        "; this program reads versions 1 to " + std::to_string(SchemaVersion) };
  }
  schema.Present = true;
  if (!fieldData->GetAbstractArray(PatchArray))
  {
    return schema;
  }
  IntegerTable patches;
  if (!ReadIntegers(fieldData, PatchArray, NumColumns, patches))
  {
    return Damaged(std::string(PatchArray) + " is not a table of " + std::to_string(NumColumns) +
      " whole numbers a row");
  }
  PointMatrix knots, points;
  const bool haveKnots = ReadDoubles(fieldData, KnotArray, knots) && knots.cols() == 1;
  bool havePoints = ReadDoubles(fieldData, PointArray, points) && points.cols() == 4;
  vtkStringArray* names = vtkStringArray::SafeDownCast(fieldData->GetAbstractArray(FieldNameArray));
  const int numFields = names ? static_cast<int>(names->GetNumberOfValues()) : 0;
  IntegerTable fieldRows, fieldChecksums;
  const bool haveFields = numFields > 0 &&
    ReadIntegers(fieldData, FieldRowArray, numFields, fieldRows) &&
    ReadIntegers(fieldData, FieldChecksumArray, numFields, fieldChecksums) &&
    fieldRows.Rows() == patches.Rows() && fieldChecksums.Rows() == patches.Rows();
  std::vector<PointMatrix> fieldTables(static_cast<std::size_t>(haveFields ? numFields : 0));
  std::vector<Eigen::Index> nextField(fieldTables.size(), 0);
  for (std::size_t f = 0; f < fieldTables.size(); ++f)
  {
    const std::string fieldName = FieldPrefix + names->GetValue(static_cast<vtkIdType>(f));
    ReadDoubles(fieldData, fieldName.c_str(), fieldTables[f]);
  }

  StoredTables tables;
  Eigen::Index nextKnot = 0;
  Eigen::Index nextPoint = 0;
  for (std::size_t row = 0; row < patches.Rows(); ++row)
  {
    PatchRecord record;
    if (Status status = ReadRecord(patches, row, record); !status)
    {
      return status;
    }
    const std::string patch = " of patch " + std::to_string(record.Id);
    for (std::size_t d = 0; d < 3; ++d)
    {
      const auto count = static_cast<Eigen::Index>(patches.At(row, Knots0 + static_cast<int>(d)));
      PointMatrix taken;
      if (!haveKnots || !TakeRows(knots, nextKnot, count, taken))
      {
        return Damaged(std::string(KnotArray) + " ends before the knots" + patch);
      }
      record.Basis.Knots[d].assign(taken.data(), taken.data() + taken.size());
    }
    const Status taken =
      tables.Take(fieldData, static_cast<std::size_t>(patches.At(row, Boxes)), record);
    if (!taken)
    {
      return Damaged(taken.Detail + patch);
    }
    if (HashOf(record.Basis) != patches.At(row, BasisHash))
    {
      return Damaged("the basis" + patch + " does not match its PatchBasis");
    }
    havePoints =
      havePoints && TakeRows(points, nextPoint, record.NumFunctions, record.ControlPoints.Rows);
    for (std::size_t f = 0; f < fieldTables.size(); ++f)
    {
      const std::int64_t count = fieldRows.At(row, static_cast<int>(f));
      if (count <= 0)
      {
        continue;
      }
      FieldRecord field;
      field.Name = names->GetValue(static_cast<vtkIdType>(f));
      field.Cache.Stored = static_cast<std::uint64_t>(fieldChecksums.At(row, static_cast<int>(f)));
      TakeRows(fieldTables[f], nextField[f], static_cast<Eigen::Index>(count), field.Cache.Rows);
      record.Fields.push_back(std::move(field));
    }
    schema.Patches.push_back(std::move(record));
  }
  return schema;
}

void Checksum::Add(const PointMatrix& values)
{
  this->Add(static_cast<std::uint64_t>(values.cols()));
  for (Eigen::Index i = 0; i < values.size(); ++i)
  {
    this->Add(values.data()[i]);
  }
}

void Checksum::Remove(std::uint64_t word)
{
  // Newton's iteration for the inverse modulo 2^64: an odd number is its own modulo 8, and every
  // step doubles the bits that are right.
  constexpr auto inverse = []
  {
    std::uint64_t x = Factor;
    for (int i = 0; i < 5; ++i)
    {
      x *= 2 - Factor * x;
    }
    return x;
  }();
  const std::uint64_t h = (this->H - Offset) * inverse;
  this->H = ((h >> 27) | (h << 37)) ^ (word * Spread);
}

void Checksum::Remove(const PointMatrix& values)
{
  for (Eigen::Index i = values.size(); i-- > 0;)
  {
    std::uint64_t word;
    std::memcpy(&word, values.data() + i, sizeof word);
    this->Remove(word);
  }
  this->Remove(static_cast<std::uint64_t>(values.cols()));
}

template <int Dim>
Checksum BeginGeometryChecksum(const std::vector<IntArray<Dim>>& degrees)
{
  Checksum sum;
  sum.Add(static_cast<std::uint64_t>(Dim)); // the cells' type
  for (const IntArray<Dim>& degree : degrees)
  {
    for (int p : degree)
    {
      sum.Add(static_cast<std::uint64_t>(p));
    }
  }
  sum.Add(std::uint64_t{ 4 }); // values a point
  return sum;
}

template Checksum BeginGeometryChecksum<1>(const std::vector<IntArray<1>>&);
template Checksum BeginGeometryChecksum<2>(const std::vector<IntArray<2>>&);
template Checksum BeginGeometryChecksum<3>(const std::vector<IntArray<3>>&);
}
