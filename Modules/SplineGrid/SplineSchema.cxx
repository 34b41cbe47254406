// SPDX-License-Identifier: BSD-3-Clause
#include "SplineSchema.h"

#include "FieldTables.h"
#include "TopologyTable.h"

#include <knotwork/SplineCore/BezierSpace.h>
#include <knotwork/SplineCore/HierarchicalSpace.h>
#include <knotwork/SplineCore/LRSpace.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include "vtkFieldData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkStringArray.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace knotwork
{
namespace
{
constexpr const char* VersionArray = "KnotworkSchemaVersion";
constexpr const char* PatchArray = "KnotworkPatches";
constexpr const char* KnotArray = "KnotworkKnots";
constexpr const char* BoxArray = "KnotworkBoxes";
constexpr const char* PieceArray = "KnotworkMeshLines";
constexpr const char* LocalKnotArray = "KnotworkLocalKnots";
constexpr const char* ScalingArray = "KnotworkScaling";
constexpr const char* PointArray = "KnotworkControlPoints";
constexpr const char* FieldNameArray = "KnotworkFieldNames";
constexpr const char* FieldRowArray = "KnotworkFieldRows";
constexpr const char* FieldChecksumArray = "KnotworkFieldChecksums";
constexpr const char* FieldPrefix = "KnotworkField.";

// Columns of KnotworkPatches. Boxes counts the rows of KnotworkMeshLines for kind 3.
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
const char* const columnNames[NumColumns] = { "PatchId", "Kind", "Dimension", "Rational",
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
      return Damaged(patch + " has " + columnNames[c] + " " + std::to_string(patches.At(row, c)));
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
  switch (at(Kind))
  {
    case 1:
      record.Basis.Kind = SpaceKind::Tensor;
      break;
    case 2:
      record.Basis.Kind = SpaceKind::Hierarchical;
      break;
    case 3:
      record.Basis.Kind = SpaceKind::LocallyRefined;
      break;
    default:
      return Damaged(patch + " is of the unknown kind " + std::to_string(at(Kind)));
  }
  for (int d = 0; d < 3; ++d)
  {
    record.Basis.Degree[static_cast<std::size_t>(d)] = at(Degree0 + d);
  }
  record.ControlPoints.Stored = static_cast<std::uint64_t>(patches.At(row, GeometryCheck));
  return {};
}
}

int BasisDefinition::Hash() const
{
  if (this->Kind == SpaceKind::Bezier)
  {
    return 0;
  }
  Checksum sum;
  sum.Add(static_cast<std::uint64_t>(this->Kind));
  sum.Add(static_cast<std::uint64_t>(this->Dimension));
  for (std::size_t d = 0; d < 3; ++d)
  {
    sum.Add(static_cast<std::uint64_t>(this->Degree[d]));
    for (double knot : this->Knots[d])
    {
      sum.Add(knot + 0.0); // -0 and 0 are the same knot
    }
  }
  for (const auto& box : this->Boxes)
  {
    for (std::int64_t value : box)
    {
      sum.Add(static_cast<std::uint64_t>(value));
    }
  }
  for (const auto& piece : this->Pieces)
  {
    for (std::int64_t value : piece)
    {
      sum.Add(static_cast<std::uint64_t>(value));
    }
  }
  for (std::int64_t knot : this->LocalKnots)
  {
    sum.Add(static_cast<std::uint64_t>(knot));
  }
  for (double gamma : this->Scaling)
  {
    sum.Add(gamma);
  }
  return 1 + static_cast<int>(sum.Value() % 0x7ffffffeU);
}

namespace
{
void DescribeLRBasis(const LRBasis& from, BasisDefinition& basis)
{
  for (std::size_t d = 0; d < 2; ++d)
  {
    basis.Degree[d] = from.Degree[d];
    basis.Knots[d] = from.Knots[d];
    for (std::size_t k = 0; k < from.Lines[d].size(); ++k)
    {
      for (const LRPiece& piece : from.Lines[d][k])
      {
        basis.Pieces.push_back({ static_cast<std::int64_t>(d), static_cast<std::int64_t>(k),
          piece.Knot, piece.Multiplicity });
      }
    }
  }
  basis.LocalKnots.assign(from.LocalKnots.begin(), from.LocalKnots.end());
  basis.Scaling = from.Scaling;
}

// MakeLRSpace checks the rest.
Result<SplineSpacePtr<2>> BuildLRSpace(const BasisDefinition& basis, int threads)
{
  constexpr std::int64_t most = std::numeric_limits<int>::max();
  const auto fits = [](std::int64_t value) { return value >= 0 && value <= most; };
  LRBasis made;
  for (std::size_t d = 0; d < 2; ++d)
  {
    made.Degree[d] = basis.Degree[d];
    made.Knots[d] = basis.Knots[d];
    made.Lines[d].resize(basis.Knots[d].size());
  }
  for (const auto& piece : basis.Pieces)
  {
    const bool known = (piece[0] == 0 || piece[0] == 1) && fits(piece[1]) && fits(piece[2]) &&
      fits(piece[3]) &&
      static_cast<std::size_t>(piece[1]) < made.Lines[static_cast<std::size_t>(piece[0])].size();
    if (!known)
    {
      return { ErrorCode::InvalidTopology, "a piece of a mesh line is out of range" };
    }
    made.Lines[static_cast<std::size_t>(piece[0])][static_cast<std::size_t>(piece[1])].push_back(
      { static_cast<int>(piece[2]), static_cast<int>(piece[3]) });
  }
  for (const std::int64_t knot : basis.LocalKnots)
  {
    if (!fits(knot))
    {
      return { ErrorCode::InvalidTopology, "a local knot is out of range" };
    }
    made.LocalKnots.push_back(static_cast<int>(knot));
  }
  made.Scaling = basis.Scaling;
  return MakeLRSpace(std::move(made), threads);
}
}

template <int Dim>
BasisDefinition DescribeBasis(const SplineSpace<Dim>& space)
{
  BasisDefinition basis;
  basis.Dimension = Dim;
  if (space.Kind == SpaceKind::Bezier)
  {
    return basis;
  }
  basis.Kind = space.Kind;
  if (space.Kind == SpaceKind::LocallyRefined)
  {
    DescribeLRBasis(space.LocallyRefined->Basis, basis);
    return basis;
  }
  for (std::size_t d = 0; d < Dim; ++d)
  {
    basis.Degree[d] = space.Knots[d].Degree();
    basis.Knots[d] = space.Knots[d].Knots();
  }
  if (space.Kind == SpaceKind::Hierarchical)
  {
    for (const HierarchyBox<Dim>& box : HierarchyBoxes(space))
    {
      std::array<std::int64_t, 7> row{ box.Level };
      std::copy(box.Lower.begin(), box.Lower.end(), row.begin() + 1);
      std::copy(box.Upper.begin(), box.Upper.end(), row.begin() + 4);
      basis.Boxes.push_back(row);
    }
  }
  return basis;
}

template <int Dim>
Result<SplineSpacePtr<Dim>> BuildSpace(const BasisDefinition& basis, [[maybe_unused]] int threads)
{
  if constexpr (Dim == 2)
  {
    if (basis.Kind == SpaceKind::LocallyRefined)
    {
      return BuildLRSpace(basis, threads);
    }
  }
  std::array<KnotVector, Dim> knots;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    Result<KnotVector> made = KnotVector::Create(basis.Degree[d], basis.Knots[d]);
    if (!made)
    {
      return made.Status;
    }
    knots[d] = std::move(made.Value);
  }
  if (basis.Kind == SpaceKind::Tensor)
  {
    return MakeTensorSpace<Dim>(knots);
  }
  if (basis.Kind != SpaceKind::Hierarchical)
  {
    return { ErrorCode::InvalidTopology, "a Bezier space is made from its cells" };
  }
  std::vector<HierarchyBox<Dim>> boxes(basis.Boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    const auto& row = basis.Boxes[i];
    boxes[i].Level =
      static_cast<int>(std::min<std::int64_t>(std::max<std::int64_t>(row[0], 0), 99));
    std::copy_n(row.begin() + 1, Dim, boxes[i].Lower.begin());
    std::copy_n(row.begin() + 4, Dim, boxes[i].Upper.begin());
  }
  return MakeHierarchicalSpace<Dim>(knots, boxes);
}

namespace
{
std::int64_t NumberOfKind(SpaceKind kind)
{
  return kind == SpaceKind::LocallyRefined ? 3 : kind == SpaceKind::Hierarchical ? 2 : 1;
}

// The definitions of locally refined spaces, patch after patch.
class LRTables
{
public:
  explicit LRTables(vtkFieldData* fieldData)
  {
    ReadIntegers(fieldData, PieceArray, 4, this->Pieces);
    ReadIntegers(fieldData, LocalKnotArray, 1, this->LocalKnots);
    ReadDoubles(fieldData, ScalingArray, this->Scaling);
  }

  // The status has a detail for Damaged.
  Status Take(std::int64_t numPieces, PatchRecord& record)
  {
    const auto fail = [](const char* arrayName)
    { return Status(ErrorCode::InvalidTopology, std::string(arrayName) + " ends too early"); };
    BasisDefinition& basis = record.Basis;
    const auto stride =
      static_cast<std::size_t>(basis.Degree[0]) + static_cast<std::size_t>(basis.Degree[1]) + 4;
    const auto numFunctions = static_cast<std::size_t>(record.NumFunctions);
    if (static_cast<std::size_t>(numPieces) > this->Pieces.Rows() - this->NextPiece)
    {
      return fail(PieceArray);
    }
    if (numFunctions > (this->LocalKnots.Rows() - this->NextKnot) / stride)
    {
      return fail(LocalKnotArray);
    }
    PointMatrix taken;
    if (this->Scaling.cols() != 1 ||
      !TakeRows(this->Scaling, this->NextScaling, record.NumFunctions, taken))
    {
      return fail(ScalingArray);
    }
    for (std::int64_t i = 0; i < numPieces; ++i, ++this->NextPiece)
    {
      basis.Pieces.push_back(
        { this->Pieces.At(this->NextPiece, 0), this->Pieces.At(this->NextPiece, 1),
          this->Pieces.At(this->NextPiece, 2), this->Pieces.At(this->NextPiece, 3) });
    }
    const auto first =
      this->LocalKnots.Values.begin() + static_cast<std::ptrdiff_t>(this->NextKnot);
    this->NextKnot += numFunctions * stride;
    basis.LocalKnots.assign(
      first, this->LocalKnots.Values.begin() + static_cast<std::ptrdiff_t>(this->NextKnot));
    basis.Scaling.assign(taken.data(), taken.data() + taken.size());
    return {};
  }

private:
  IntegerTable Pieces;
  IntegerTable LocalKnots;
  PointMatrix Scaling;
  std::size_t NextPiece = 0;
  std::size_t NextKnot = 0;
  Eigen::Index NextScaling = 0;
};
}

void WriteSchema(const SplineSchema& schema, vtkFieldData* fieldData)
{
  std::vector<std::int64_t> patches, boxes, pieces, localKnots, fieldRows, fieldChecksums;
  std::vector<double> knots, points, scaling;
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
    const BasisDefinition& basis = record.Basis;
    std::array<std::int64_t, NumColumns> row{ record.Id, NumberOfKind(basis.Kind), basis.Dimension,
      record.Rational, record.NumElements, record.NumFunctions };
    for (std::size_t d = 0; d < 3; ++d)
    {
      row[Degree0 + d] = basis.Degree[d];
      row[Knots0 + d] = static_cast<std::int64_t>(basis.Knots[d].size());
      knots.insert(knots.end(), basis.Knots[d].begin(), basis.Knots[d].end());
    }
    const bool isLR = basis.Kind == SpaceKind::LocallyRefined;
    row[Boxes] = static_cast<std::int64_t>(isLR ? basis.Pieces.size() : basis.Boxes.size());
    row[BasisHash] = basis.Hash();
    row[GeometryCheck] = static_cast<std::int64_t>(record.ControlPoints.Stored);
    patches.insert(patches.end(), row.begin(), row.end());
    for (const auto& box : basis.Boxes)
    {
      boxes.insert(boxes.end(), box.begin(), box.end());
    }
    for (const auto& piece : basis.Pieces)
    {
      pieces.insert(pieces.end(), piece.begin(), piece.end());
    }
    localKnots.insert(localKnots.end(), basis.LocalKnots.begin(), basis.LocalKnots.end());
    scaling.insert(scaling.end(), basis.Scaling.begin(), basis.Scaling.end());
    Append(points, record.ControlPoints.Rows);
    for (std::size_t f = 0; f < names.size(); ++f)
    {
      std::int64_t rows = 0;
      std::int64_t checksum = 0;
      for (const FieldRecord& field : record.Fields)
      {
        if (field.Name == names[f])
        {
          rows = field.Cache.Rows.rows();
          checksum = static_cast<std::int64_t>(field.Cache.Stored);
          Append(fields[f], field.Cache.Rows);
        }
      }
      fieldRows.push_back(rows);
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
  WriteIntegers(fieldData, PatchArray, NumColumns, patches, columnNames);
  WriteDoubles(fieldData, KnotArray, 1, knots);
  if (!boxes.empty())
  {
    const char* const boxNames[] = { "Level", "Lower0", "Lower1", "Lower2", "Upper0", "Upper1",
      "Upper2" };
    WriteIntegers(fieldData, BoxArray, 7, boxes, boxNames);
  }
  if (!pieces.empty())
  {
    const char* const pieceNames[] = { "Direction", "Line", "Knot", "Multiplicity" };
    WriteIntegers(fieldData, PieceArray, 4, pieces, pieceNames);
    WriteIntegers(fieldData, LocalKnotArray, 1, localKnots);
    WriteDoubles(fieldData, ScalingArray, 1, scaling);
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
  IntegerTable boxes;
  const bool haveKnots = ReadDoubles(fieldData, KnotArray, knots) && knots.cols() == 1;
  ReadIntegers(fieldData, BoxArray, 7, boxes);
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

  LRTables lrBases(fieldData);
  Eigen::Index nextKnot = 0;
  Eigen::Index nextPoint = 0;
  std::size_t nextBox = 0;
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
    if (record.Basis.Kind == SpaceKind::LocallyRefined)
    {
      if (const Status status = lrBases.Take(patches.At(row, Boxes), record); !status)
      {
        return Damaged(status.Detail + patch);
      }
    }
    const bool hasBoxes = record.Basis.Kind != SpaceKind::LocallyRefined;
    for (std::int64_t b = 0; hasBoxes && b < patches.At(row, Boxes); ++b, ++nextBox)
    {
      if (nextBox >= boxes.Rows())
      {
        return Damaged(std::string(BoxArray) + " ends before the boxes" + patch);
      }
      std::array<std::int64_t, 7> box;
      for (int c = 0; c < 7; ++c)
      {
        box[static_cast<std::size_t>(c)] = boxes.At(nextBox, c);
      }
      record.Basis.Boxes.push_back(box);
    }
    if (record.Basis.Hash() != patches.At(row, BasisHash))
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

void Checksum::Add(std::uint64_t word)
{
  std::uint64_t h = this->H ^ (word * 0x9e3779b97f4a7c15ULL);
  h = (h << 27) | (h >> 37);
  this->H = h * 0xc2b2ae3d27d4eb4fULL + 0x165667b19e3779f9ULL;
}

void Checksum::Add(double value)
{
  std::uint64_t word;
  std::memcpy(&word, &value, sizeof word);
  this->Add(word);
}

void Checksum::Add(const PointMatrix& values)
{
  this->Add(static_cast<std::uint64_t>(values.cols()));
  for (Eigen::Index i = 0; i < values.size(); ++i)
  {
    this->Add(values.data()[i]);
  }
}

template <int Dim>
Checksum GeometryChecksum(const std::vector<IntArray<Dim>>& degrees, const PointMatrix& blocks)
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
  sum.Add(blocks);
  return sum;
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template BasisDefinition DescribeBasis<Dim>(const SplineSpace<Dim>&);                            \
  template Result<SplineSpacePtr<Dim>> BuildSpace<Dim>(const BasisDefinition&, int);               \
  template Checksum GeometryChecksum<Dim>(const std::vector<IntArray<Dim>>&, const PointMatrix&);
KNOTWORK_INSTANTIATE(1)
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
}
