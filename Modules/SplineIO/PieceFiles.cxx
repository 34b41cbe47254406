// SPDX-License-Identifier: BSD-3-Clause
#include "PieceFiles.h"

#include "ForeignFile.h"
#include "VTKText.h"
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineCore/FileOutput.h>
#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineGrid/PieceSchema.h>
#include <knotwork/SplineGrid/Processes.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SplineGrid/SplineSchema.h>

#include <vtkAbstractArray.h>
#include <vtkAppendFilter.h>
#include <vtkAppendPolyData.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <pugixml.hpp>

#include <algorithm>
#include <map>
#include <system_error>
#include <utility>

namespace fs = std::filesystem;

namespace knotwork
{
namespace
{
const char* const GridIndex = "PUnstructuredGrid";
const char* const PolygonIndex = "PPolyData";

bool IsOfPolygons(const std::string& index)
{
  return LowerEnding(index) == ".pvtp";
}

/// Where the pieces stand, and their names.
fs::path FolderOf(const fs::path& index)
{
  return index.parent_path() / index.stem();
}

std::string NameOf(const fs::path& index, std::size_t number)
{
  return index.stem().string() + "_" + std::to_string(number) +
    (IsOfPolygons(index.string()) ? ".vtp" : ".vtu");
}

/// Whether patches have definitions that the grid states, which need all of their cells.
bool IsSpline(vtkDataObject* piece)
{
  auto* grid = vtkUnstructuredGrid::SafeDownCast(piece);
  vtkDataArray* basis = grid ? grid->GetCellData()->GetArray(name::Basis) : nullptr;
  return basis && basis->GetRange()[1] > 0.0;
}

/// Puts arrays into the order that they have in another data set.
void InOrderOf(vtkDataSetAttributes* other, vtkDataSetAttributes* arrays)
{
  for (int i = 0; i < other->GetNumberOfArrays(); ++i)
  {
    const char* name = other->GetAbstractArray(i)->GetName();
    const vtkSmartPointer<vtkAbstractArray> array = arrays->GetAbstractArray(name);
    if (array)
    {
      arrays->RemoveArray(name);
      arrays->AddArray(array);
    }
  }
  for (int type = 0; type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
  {
    vtkAbstractArray* active = other->GetAbstractAttribute(type);
    if (active && active->GetName() && arrays->HasArray(active->GetName()) != 0)
    {
      arrays->SetActiveAttribute(active->GetName(), type);
    }
  }
}

vtkSmartPointer<vtkDataObject> Append(
  vtkAlgorithm* filter, const std::vector<vtkSmartPointer<vtkDataObject>>& pieces)
{
  for (const auto& piece : pieces)
  {
    filter->AddInputDataObject(0, piece);
  }
  filter->Update();
  auto* joined = vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  auto* first = vtkDataSet::SafeDownCast(pieces.front());
  InOrderOf(first->GetPointData(), joined->GetPointData());
  InOrderOf(first->GetCellData(), joined->GetCellData());
  return joined;
}

/// @param appended  the grids with their cells, whose arrays are taken over.
Result<vtkSmartPointer<vtkDataObject>> JoinSplines(
  const std::vector<vtkSmartPointer<vtkDataObject>>& pieces, vtkUnstructuredGrid* appended)
{
  SplineModel all;
  std::vector<vtkIdType> cells;
  vtkIdType before = 0;
  std::vector<vtkFieldData*> fieldData;
  std::map<int, std::pair<int, int>> places; // index and dimension by PatchId
  bool areNumbered = true;                   // each patch by a number of its own
  for (const auto& piece : pieces)
  {
    fieldData.push_back(piece->GetFieldData());
    auto model = DecodeSplineModel(piece, 1);
    if (!model)
    {
      return model.Status;
    }
    const int firstPatch = static_cast<int>(all.Patches.size());
    for (SplinePatch& patch : model->Patches)
    {
      for (const vtkIdType cell : patch.Cells)
      {
        cells.push_back(before + cell);
      }
      const int dimension = static_cast<int>(patch.Geometry.index()) + 1;
      areNumbered =
        places.try_emplace(patch.Id, static_cast<int>(all.Patches.size()), dimension).second &&
        areNumbered;
      all.Patches.push_back(std::move(patch));
    }
    for (PatchInterface one : model->Topology.Interfaces)
    {
      for (PatchSide& side : one.Sides)
      {
        side.Patch += firstPatch;
      }
      all.Topology.Interfaces.push_back(one);
    }
    for (PatchSide side : model->Topology.Boundary)
    {
      side.Patch += firstPatch;
      all.Topology.Boundary.push_back(side);
    }
    before += piece->GetNumberOfElements(vtkDataObject::CELL);
  }
  if (areNumbered)
  {
    all.Topology = JoinTopologies(fieldData, places);
  }
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  const Status status = EncodeSplineGrid(all, grid);
  if (!status)
  {
    return status;
  }
  PassCellData(appended, cells, grid);
  // what the schema stores is that of all patches; the rest every piece has
  vtkFieldData* const fields = pieces.front()->GetFieldData();
  for (int i = 0; i < fields->GetNumberOfArrays(); ++i)
  {
    const std::string name = fields->GetArrayName(i) ? fields->GetArrayName(i) : "";
    if (name.rfind("Knotwork", 0) != 0 && grid->GetFieldData()->HasArray(name.c_str()) == 0)
    {
      grid->GetFieldData()->AddArray(fields->GetAbstractArray(i));
    }
  }
  return vtkSmartPointer<vtkDataObject>(grid);
}

/// A grid without the points that no cell has.
vtkSmartPointer<vtkUnstructuredGrid> WithUsedPoints(vtkUnstructuredGrid* grid)
{
  std::vector<vtkIdType> place(static_cast<std::size_t>(grid->GetNumberOfPoints()), -1);
  vtkNew<vtkIdList> points;
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    grid->GetCellPoints(cell, points);
    for (const vtkIdType point : *points)
    {
      place[static_cast<std::size_t>(point)] = 0;
    }
  }
  vtkNew<vtkIdList> used; // in their order
  for (std::size_t i = 0; i < place.size(); ++i)
  {
    if (place[i] == 0)
    {
      place[i] = used->InsertNextId(static_cast<vtkIdType>(i));
    }
  }
  if (used->GetNumberOfIds() == grid->GetNumberOfPoints())
  {
    return grid;
  }
  auto part = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> places;
  places->SetDataType(grid->GetPoints()->GetDataType());
  places->SetNumberOfPoints(used->GetNumberOfIds());
  grid->GetPoints()->GetPoints(used, places);
  part->SetPoints(places);
  part->Allocate(grid->GetNumberOfCells());
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    grid->GetCellPoints(cell, points);
    for (vtkIdType& point : *points)
    {
      point = place[static_cast<std::size_t>(point)];
    }
    part->InsertNextCell(grid->GetCellType(cell), points);
  }
  part->GetPointData()->CopyAllOn();
  part->GetPointData()->CopyAllocate(grid->GetPointData(), used->GetNumberOfIds());
  for (vtkIdType i = 0; i < used->GetNumberOfIds(); ++i)
  {
    part->GetPointData()->CopyData(grid->GetPointData(), used->GetId(i), i);
  }
  part->GetCellData()->ShallowCopy(grid->GetCellData());
  part->GetFieldData()->ShallowCopy(grid->GetFieldData());
  return part;
}

void DescribeArrays(vtkDataSetAttributes* attributes, pugi::xml_node node)
{
  for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = attributes->GetAbstractArray(i);
    const bool isNumbers = vtkDataArray::SafeDownCast(array) != nullptr;
    pugi::xml_node one = node.append_child(isNumbers ? "PDataArray" : "PArray");
    const bool isReal = array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE;
    const bool isSigned = array->GetDataType() != VTK_UNSIGNED_CHAR &&
      array->GetDataType() != VTK_UNSIGNED_SHORT && array->GetDataType() != VTK_UNSIGNED_INT &&
      array->GetDataType() != VTK_UNSIGNED_LONG && array->GetDataType() != VTK_UNSIGNED_LONG_LONG;
    constexpr int bits = 8;
    const std::string type = !isNumbers ? "String"
                                        : (isReal        ? "Float"
                                              : isSigned ? "Int"
                                                         : "UInt") +
        std::to_string(bits * array->GetDataTypeSize());
    one.append_attribute("type") = type.c_str();
    one.append_attribute("Name") = array->GetName();
    one.append_attribute("NumberOfComponents") = array->GetNumberOfComponents();
  }
}

struct Text : pugi::xml_writer
{
  std::string Written;
  void write(const void* data, size_t size) override
  {
    this->Written.append(static_cast<const char*>(data), size);
  }
};
}

bool IsPieceIndex(const std::string& file)
{
  const std::string ending = LowerEnding(file);
  return ending == ".pvtu" || ending == ".pvtp";
}

Result<std::vector<fs::path>> ReadPieceIndex(const std::string& file)
{
  pugi::xml_document document;
  const auto parsed = document.load_file(file.c_str(), pugi::parse_minimal);
  if (!parsed)
  {
    const bool isThere = parsed.status != pugi::status_file_not_found;
    return { isThere ? ErrorCode::InvalidFormat : ErrorCode::FileError,
      "'" + file + "' " + (isThere ? "is no index of pieces: " : "cannot be read: ") +
        parsed.description() };
  }
  const char* kind = IsOfPolygons(file) ? PolygonIndex : GridIndex;
  const char* ending = IsOfPolygons(file) ? ".vtp" : ".vtu";
  std::vector<fs::path> pieces;
  for (const pugi::xml_node& piece : document.child("VTKFile").child(kind).children("Piece"))
  {
    const fs::path source = piece.attribute("Source").value();
    if (LowerEnding(source.string()) != ending)
    {
      return { ErrorCode::InvalidFormat,
        "'" + file + "': the piece '" + source.string() + "' is no " + ending + " file" };
    }
    pieces.push_back(source.is_absolute() ? source : fs::path(file).parent_path() / source);
  }
  if (pieces.empty())
  {
    return { ErrorCode::InvalidFormat,
      "'" + file + "' is no index of pieces: it names none in <" + kind + ">" };
  }
  return pieces;
}

Result<vtkSmartPointer<vtkDataObject>> ReadPieces(
  const std::string& file, std::size_t begin, std::size_t end)
{
  const auto index = ReadPieceIndex(file);
  if (!index)
  {
    return index.Status;
  }
  std::vector<vtkSmartPointer<vtkDataObject>> pieces;
  for (std::size_t i = begin; i < std::min(end, index->size()); ++i)
  {
    const fs::path& piece = index.Value[i];
    std::error_code ignored;
    if (!fs::is_regular_file(piece, ignored))
    {
      return { ErrorCode::FileError,
        "'" + file + "': its piece '" + piece.string() + "' is not there" };
    }
    auto read = ReadVTKFile(piece.string());
    if (!read)
    {
      return read.Status;
    }
    pieces.push_back(read.Value);
  }
  if (pieces.empty())
  {
    return IsOfPolygons(file)
      ? vtkSmartPointer<vtkDataObject>(vtkSmartPointer<vtkPolyData>::New())
      : vtkSmartPointer<vtkDataObject>(vtkSmartPointer<vtkUnstructuredGrid>::New());
  }
  auto joined = JoinPieces(pieces);
  return joined ? std::move(joined)
                : Result<vtkSmartPointer<vtkDataObject>>(
                    joined.Status.Code, "'" + file + "': " + joined.Status.Detail);
}

Result<vtkSmartPointer<vtkDataObject>> JoinPieces(
  const std::vector<vtkSmartPointer<vtkDataObject>>& pieces)
{
  if (pieces.size() == 1)
  {
    return pieces.front();
  }
  if (vtkPolyData::SafeDownCast(pieces.front()))
  {
    return Append(vtkNew<vtkAppendPolyData>(), pieces);
  }
  const vtkSmartPointer<vtkDataObject> appended = Append(vtkNew<vtkAppendFilter>(), pieces);
  return std::any_of(pieces.begin(), pieces.end(), [](const auto& one) { return IsSpline(one); })
    ? JoinSplines(pieces, vtkUnstructuredGrid::SafeDownCast(appended))
    : Result<vtkSmartPointer<vtkDataObject>>(appended);
}

Status WritePiece(vtkDataSet* piece, std::size_t number, const std::string& index,
  const std::string& encoding, int threads)
{
  const fs::path folder = FolderOf(index);
  std::error_code failure;
  fs::create_directory(folder, failure); // several processes do
  if (!fs::is_directory(folder))
  {
    return { ErrorCode::FileError, "'" + folder.string() + "': " + failure.message() };
  }
  auto* grid = vtkUnstructuredGrid::SafeDownCast(piece);
  const vtkSmartPointer<vtkDataObject> used =
    grid && grid->GetNumberOfCells() > 0 ? WithUsedPoints(grid).Get() : piece;
  return WriteVTKFile(used, (folder / NameOf(index, number)).string(), encoding, threads);
}

Status WritePieceIndex(
  vtkDataSet* like, const std::vector<std::size_t>& numbers, const std::string& index)
{
  const char* kind = IsOfPolygons(index) ? PolygonIndex : GridIndex;
  pugi::xml_document document;
  pugi::xml_node file = document.append_child("VTKFile");
  file.append_attribute("type") = kind;
  file.append_attribute("version") = "1.0";
  pugi::xml_node all = file.append_child(kind);
  all.append_attribute("GhostLevel") = 0;
  DescribeArrays(like->GetPointData(), all.append_child("PPointData"));
  DescribeArrays(like->GetCellData(), all.append_child("PCellData"));
  pugi::xml_node points = all.append_child("PPoints").append_child("PDataArray");
  auto* set = vtkPointSet::SafeDownCast(like);
  const bool isFloat = set && set->GetPoints() && set->GetPoints()->GetDataType() == VTK_FLOAT;
  points.append_attribute("type") = isFloat ? "Float32" : "Float64";
  points.append_attribute("Name") = "Points";
  points.append_attribute("NumberOfComponents") = 3;
  for (const std::size_t number : numbers)
  {
    all.append_child("Piece").append_attribute("Source") =
      (FolderOf(index).filename() / NameOf(index, number)).c_str();
  }
  Text text;
  document.save(text, "  ");
  return PutText(text.Written, index);
}

vtkSmartPointer<vtkUnstructuredGrid> CellRange(
  vtkUnstructuredGrid* grid, std::size_t begin, std::size_t end, std::size_t firstPoint)
{
  auto part = vtkSmartPointer<vtkUnstructuredGrid>::New();
  part->SetPoints(grid->GetPoints());
  part->GetPointData()->ShallowCopy(grid->GetPointData());
  part->GetFieldData()->ShallowCopy(grid->GetFieldData());
  const auto first = static_cast<vtkIdType>(begin);
  const auto count = static_cast<vtkIdType>(end - begin);
  part->Allocate(count);
  vtkNew<vtkIdList> points;
  for (vtkIdType cell = first; cell < first + count; ++cell)
  {
    grid->GetCellPoints(cell, points);
    part->InsertNextCell(grid->GetCellType(cell), points);
  }
  vtkCellData* data = part->GetCellData();
  data->CopyAllOn();
  data->CopyAllocate(grid->GetCellData(), count);
  data->CopyData(grid->GetCellData(), 0, count, first);
  if (!part->GetPointData()->GetGlobalIds())
  {
    const auto ids = NamedArray<vtkIdTypeArray>("GlobalPointIds", 1, grid->GetNumberOfPoints());
    for (vtkIdType i = 0; i < ids->GetNumberOfTuples(); ++i)
    {
      ids->SetValue(i, static_cast<vtkIdType>(firstPoint) + i);
    }
    part->GetPointData()->SetGlobalIds(ids);
  }
  return part;
}

std::vector<vtkSmartPointer<vtkUnstructuredGrid>> DivideGrid(
  vtkUnstructuredGrid* grid, std::size_t count)
{
  const auto cells = static_cast<std::size_t>(grid->GetNumberOfCells());
  vtkDataArray* patches = IsSpline(grid) ? grid->GetCellData()->GetArray(name::PatchId) : nullptr;
  const auto isEnd = [&](std::size_t cell) // of a patch, whose cells stand together
  {
    return !patches || cell == 0 || cell >= cells ||
      patches->GetComponent(static_cast<vtkIdType>(cell), 0) !=
      patches->GetComponent(static_cast<vtkIdType>(cell) - 1, 0);
  };
  std::vector<vtkSmartPointer<vtkUnstructuredGrid>> parts;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    std::size_t end =
      std::max(begin, Processes::PartOf(cells, static_cast<int>(i), static_cast<int>(count)).End);
    while (!isEnd(end))
    {
      ++end;
    }
    parts.push_back(WithUsedPoints(CellRange(grid, begin, end)));
    begin = end;
  }
  if (patches)
  {
    KeepOwnPatches(grid, parts);
  }
  return parts;
}
}
