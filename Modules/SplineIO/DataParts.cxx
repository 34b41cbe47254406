// SPDX-License-Identifier: BSD-3-Clause
#include "DataParts.h"

#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataAssembly.h>
#include <vtkDataObject.h>
#include <vtkExecutive.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkInformationIterator.h>
#include <vtkInformationKey.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSet.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLDataObjectWriter.h>
#include <vtkXMLGenericDataObjectReader.h>
#include <vtkXMLReader.h>
#include <vtkXMLWriter.h>

#include <array>
#include <cstdlib>
#include <cstring>

namespace knotwork
{
namespace
{
constexpr int Nothing = -1;              ///< type of a partition that is not there
constexpr const char* AsBytes = "bytes"; ///< of a grid or polydata whose arrays follow as they are
constexpr const char* AsXml = "xml";

std::string Take(std::vector<std::string>& parts, std::size_t& next)
{
  return next < parts.size() ? std::move(parts[next++]) : std::string();
}

long long TakeNumber(std::vector<std::string>& parts, std::size_t& next)
{
  return std::atoll(Take(parts, next).c_str());
}

/// Whether bytes are all there is to an array: no bits, no layout of somebody's own, no notes. The
/// norms that VTK keeps with arrays are computed again where they are asked for.
bool IsPlain(vtkAbstractArray* array)
{
  if (!array || vtkStringArray::SafeDownCast(array))
  {
    return true;
  }
  bool isPlain = vtkDataArray::SafeDownCast(array) && array->HasStandardMemoryLayout() &&
    array->GetDataType() != VTK_BIT;
  if (array->HasInformation())
  {
    vtkNew<vtkInformationIterator> notes;
    notes->SetInformation(array->GetInformation());
    for (notes->InitTraversal(); !notes->IsDoneWithTraversal(); notes->GoToNextItem())
    {
      isPlain = isPlain && std::string(notes->GetCurrentKey()->GetName()).rfind("L2_NORM", 0) == 0;
    }
  }
  return isPlain;
}

bool IsPlain(vtkFieldData* arrays)
{
  bool isPlain = true;
  for (int i = 0; arrays && i < arrays->GetNumberOfArrays(); ++i)
  {
    isPlain = isPlain && IsPlain(arrays->GetAbstractArray(i));
  }
  return isPlain;
}

bool IsPlain(vtkDataObject* data)
{
  auto* set = vtkPointSet::SafeDownCast(data);
  return (vtkUnstructuredGrid::SafeDownCast(data) || vtkPolyData::SafeDownCast(data)) &&
    (!set->GetPoints() || IsPlain(set->GetPoints()->GetData())) && IsPlain(set->GetPointData()) &&
    IsPlain(set->GetCellData()) && IsPlain(set->GetFieldData());
}

/// Type, components, tuples, name, names of the components, and the bytes or strings.
void AppendArray(vtkAbstractArray* array, std::vector<std::string>& parts)
{
  parts.push_back(std::to_string(array ? array->GetDataType() : Nothing));
  if (!array)
  {
    return;
  }
  const int components = array->GetNumberOfComponents();
  parts.push_back(std::to_string(components));
  parts.push_back(std::to_string(array->GetNumberOfTuples()));
  parts.emplace_back(array->GetName() ? array->GetName() : "");
  parts.push_back(array->HasAComponentName() ? "1" : "0");
  for (int c = 0; array->HasAComponentName() && c < components; ++c)
  {
    parts.emplace_back(array->GetComponentName(c) ? array->GetComponentName(c) : "");
  }
  if (auto* strings = vtkStringArray::SafeDownCast(array))
  {
    for (vtkIdType i = 0; i < strings->GetNumberOfValues(); ++i)
    {
      parts.push_back(strings->GetValue(i));
    }
    return;
  }
  const auto bytes = static_cast<std::size_t>(array->GetNumberOfValues()) *
    static_cast<std::size_t>(array->GetDataTypeSize());
  parts.emplace_back(static_cast<const char*>(array->GetVoidPointer(0)), bytes);
}

/// @param array  null where there was none.
/// @return false where the parts do not belong together.
bool TakeArray(
  vtkSmartPointer<vtkAbstractArray>& array, std::vector<std::string>& parts, std::size_t& next)
{
  array = nullptr;
  if (next >= parts.size())
  {
    return false;
  }
  const auto type = static_cast<int>(TakeNumber(parts, next));
  if (type == Nothing)
  {
    return true;
  }
  array = vtkSmartPointer<vtkAbstractArray>::Take(vtkAbstractArray::CreateArray(type));
  const auto components = static_cast<int>(TakeNumber(parts, next));
  const long long tuples = TakeNumber(parts, next);
  const std::string name = Take(parts, next);
  if (!array || components < 1 || tuples < 0)
  {
    return false;
  }
  array->SetNumberOfComponents(components);
  array->SetName(name.empty() ? nullptr : name.c_str());
  const bool isNamed = TakeNumber(parts, next) != 0;
  for (int c = 0; isNamed && c < components; ++c)
  {
    if (const std::string of = Take(parts, next); !of.empty())
    {
      array->SetComponentName(c, of.c_str());
    }
  }
  const auto values = static_cast<std::size_t>(tuples) * static_cast<std::size_t>(components);
  if (auto* strings = vtkStringArray::SafeDownCast(array))
  {
    if (next > parts.size() || values > parts.size() - next)
    {
      return false;
    }
    strings->SetNumberOfValues(static_cast<vtkIdType>(values));
    for (std::size_t i = 0; i < values; ++i)
    {
      strings->SetValue(static_cast<vtkIdType>(i), Take(parts, next));
    }
    return true;
  }
  const bool isThere = next < parts.size();
  const std::string bytes = Take(parts, next);
  if (!isThere || bytes.size() != values * static_cast<std::size_t>(array->GetDataTypeSize()))
  {
    return false;
  }
  array->SetNumberOfTuples(tuples);
  if (!bytes.empty())
  {
    std::memcpy(array->GetVoidPointer(0), bytes.data(), bytes.size());
  }
  return true;
}

/// Likewise, of numbers. @return false also where the array is of something else.
template <typename Array>
bool TakeArrayOf(vtkSmartPointer<Array>& array, std::vector<std::string>& parts, std::size_t& next)
{
  vtkSmartPointer<vtkAbstractArray> any;
  const bool isWhole = TakeArray(any, parts, next);
  array = Array::SafeDownCast(any);
  return isWhole && (array || !any);
}

/// Arrays of points, cells or the whole, and which of them are scalars, normals and so on.
void AppendArrays(vtkFieldData* arrays, std::vector<std::string>& parts)
{
  const int count = arrays ? arrays->GetNumberOfArrays() : 0;
  parts.push_back(std::to_string(count));
  for (int i = 0; i < count; ++i)
  {
    AppendArray(arrays->GetAbstractArray(i), parts);
  }
  if (auto* attributes = vtkDataSetAttributes::SafeDownCast(arrays))
  {
    std::array<int, vtkDataSetAttributes::NUM_ATTRIBUTES> indices{};
    attributes->GetAttributeIndices(indices.data());
    for (const int index : indices)
    {
      parts.push_back(std::to_string(index));
    }
  }
}

bool TakeArrays(vtkFieldData* arrays, std::vector<std::string>& parts, std::size_t& next)
{
  if (next >= parts.size())
  {
    return false;
  }
  const long long count = TakeNumber(parts, next);
  for (long long i = 0; i < count; ++i)
  {
    vtkSmartPointer<vtkAbstractArray> array;
    if (!TakeArray(array, parts, next) || !array)
    {
      return false;
    }
    arrays->AddArray(array);
  }
  if (auto* attributes = vtkDataSetAttributes::SafeDownCast(arrays))
  {
    if (parts.size() - next < vtkDataSetAttributes::NUM_ATTRIBUTES)
    {
      return false;
    }
    for (int type = 0; type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
    {
      if (const auto index = static_cast<int>(TakeNumber(parts, next)); index >= 0)
      {
        attributes->SetActiveAttribute(index, type);
      }
    }
  }
  return true;
}

void AppendCells(vtkCellArray* cells, std::vector<std::string>& parts)
{
  AppendArray(cells ? cells->GetOffsetsArray() : nullptr, parts);
  AppendArray(cells ? cells->GetConnectivityArray() : nullptr, parts);
}

/// @param cells  stays null without cells.
bool TakeCells(
  vtkSmartPointer<vtkCellArray>& cells, std::vector<std::string>& parts, std::size_t& next)
{
  vtkSmartPointer<vtkDataArray> offsets;
  vtkSmartPointer<vtkDataArray> points;
  if (!TakeArrayOf(offsets, parts, next) || !TakeArrayOf(points, parts, next) ||
    (offsets == nullptr) != (points == nullptr))
  {
    return false;
  }
  if (!offsets)
  {
    return true;
  }
  cells = vtkSmartPointer<vtkCellArray>::New();
  return offsets->GetDataType() == points->GetDataType() && cells->SetData(offsets, points);
}

/// The four lists of cells of polydata.
constexpr std::array<vtkCellArray* (vtkPolyData::*)(), 4> PolyCells = { &vtkPolyData::GetVerts,
  &vtkPolyData::GetLines, &vtkPolyData::GetPolys, &vtkPolyData::GetStrips };
constexpr std::array<void (vtkPolyData::*)(vtkCellArray*), 4> SetPolyCells = {
  &vtkPolyData::SetVerts, &vtkPolyData::SetLines, &vtkPolyData::SetPolys, &vtkPolyData::SetStrips
};

/// A grid or polydata of plain arrays: several times as fast as text, which large files feel.
void AppendBytes(vtkPointSet* data, std::vector<std::string>& parts)
{
  AppendArray(data->GetPoints() ? data->GetPoints()->GetData() : nullptr, parts);
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(data))
  {
    AppendCells(grid->GetCells(), parts);
    AppendArray(grid->GetCellTypesArray(), parts);
    AppendArray(grid->GetFaceLocations(), parts);
    AppendArray(grid->GetFaces(), parts);
  }
  else if (auto* poly = vtkPolyData::SafeDownCast(data))
  {
    for (const auto get : PolyCells)
    {
      AppendCells((poly->*get)(), parts);
    }
  }
  AppendArrays(data->GetPointData(), parts);
  AppendArrays(data->GetCellData(), parts);
  AppendArrays(data->GetFieldData(), parts);
}

vtkSmartPointer<vtkDataObject> TakeBytes(
  int type, std::vector<std::string>& parts, std::size_t& next)
{
  vtkSmartPointer<vtkPointSet> data;
  vtkSmartPointer<vtkDataArray> coordinates;
  if (!TakeArrayOf(coordinates, parts, next))
  {
    return nullptr;
  }
  if (type == VTK_UNSTRUCTURED_GRID)
  {
    const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    data = grid;
    vtkSmartPointer<vtkCellArray> cells;
    vtkSmartPointer<vtkUnsignedCharArray> types;
    vtkSmartPointer<vtkIdTypeArray> places;
    vtkSmartPointer<vtkIdTypeArray> faces;
    if (!TakeCells(cells, parts, next) || !TakeArrayOf(types, parts, next) ||
      !TakeArrayOf(places, parts, next) || !TakeArrayOf(faces, parts, next))
    {
      return nullptr;
    }
    if (cells)
    {
      grid->SetCells(types, cells, places, faces);
    }
  }
  else
  {
    const auto poly = vtkSmartPointer<vtkPolyData>::New();
    data = poly;
    for (const auto set : SetPolyCells)
    {
      vtkSmartPointer<vtkCellArray> cells;
      if (!TakeCells(cells, parts, next))
      {
        return nullptr;
      }
      if (cells && cells->GetNumberOfCells() > 0)
      {
        (poly->*set)(cells);
      }
    }
  }
  if (coordinates)
  {
    vtkNew<vtkPoints> points;
    points->SetData(coordinates);
    data->SetPoints(points);
  }
  const bool isWhole = TakeArrays(data->GetPointData(), parts, next) &&
    TakeArrays(data->GetCellData(), parts, next) && TakeArrays(data->GetFieldData(), parts, next);
  return isWhole ? data : nullptr;
}

void AppendCollection(vtkPartitionedDataSetCollection* data, std::vector<std::string>& parts)
{
  vtkDataAssembly* assembly = data->GetDataAssembly();
  parts.push_back(assembly ? assembly->SerializeToXML(vtkIndent()) : "");
  parts.push_back(std::to_string(data->GetNumberOfPartitionedDataSets()));
  for (unsigned int i = 0; i < data->GetNumberOfPartitionedDataSets(); ++i)
  {
    vtkPartitionedDataSet* set = data->GetPartitionedDataSet(i);
    vtkInformation* about = data->HasMetaData(i) ? data->GetMetaData(i) : nullptr;
    const char* name = about ? about->Get(vtkCompositeDataSet::NAME()) : nullptr;
    parts.emplace_back(name ? name : "");
    const unsigned int count = set ? set->GetNumberOfPartitions() : 0;
    parts.push_back(std::to_string(count));
    for (unsigned int k = 0; k < count; ++k)
    {
      AppendParts(set->GetPartitionAsDataObject(k), parts);
    }
  }
}

vtkSmartPointer<vtkDataObject> TakeCollection(std::vector<std::string>& parts, std::size_t& next)
{
  vtkNew<vtkPartitionedDataSetCollection> data;
  if (const std::string assembly = Take(parts, next); !assembly.empty())
  {
    vtkNew<vtkDataAssembly> tree;
    if (tree->InitializeFromXML(assembly.c_str()))
    {
      data->SetDataAssembly(tree);
    }
  }
  const long long sets = TakeNumber(parts, next);
  for (long long i = 0; i < sets && next < parts.size(); ++i)
  {
    vtkNew<vtkPartitionedDataSet> set;
    const std::string name = Take(parts, next);
    const long long count = TakeNumber(parts, next);
    for (long long k = 0; k < count && next < parts.size(); ++k)
    {
      set->SetPartition(static_cast<unsigned int>(k), TakeData(parts, next));
    }
    data->SetPartitionedDataSet(static_cast<unsigned int>(i), set);
    if (!name.empty())
    {
      data->GetMetaData(static_cast<unsigned int>(i))
        ->Set(vtkCompositeDataSet::NAME(), name.c_str());
    }
  }
  return data;
}

/// The text without the ranges of norms that VTK keeps with arrays: it writes infinite ones and
/// cannot read them. They are computed again where they are asked for.
std::string WithoutNorms(const std::string& xml)
{
  const std::string begin = "<InformationKey name=\"L2_NORM";
  const std::string end = "</InformationKey>";
  std::string text;
  text.reserve(xml.size());
  std::size_t from = 0;
  for (std::size_t at = xml.find(begin); at != std::string::npos; at = xml.find(begin, from))
  {
    text.append(xml, from, at - from);
    const std::size_t last = xml.find(end, at);
    from = last == std::string::npos ? xml.size() : last + end.size();
  }
  return text.append(xml, from, std::string::npos);
}
}

void AppendParts(vtkDataObject* data, std::vector<std::string>& parts)
{
  const int type = data ? data->GetDataObjectType() : Nothing;
  parts.push_back(std::to_string(type));
  if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(data))
  {
    AppendCollection(collection, parts);
    return;
  }
  if (!data)
  {
    return;
  }
  if (IsPlain(data))
  {
    parts.emplace_back(AsBytes);
    AppendBytes(vtkPointSet::SafeDownCast(data), parts);
    return;
  }
  parts.emplace_back(AsXml);
  const auto writer = vtkSmartPointer<vtkXMLWriter>::Take(vtkXMLDataObjectWriter::NewWriter(type));
  if (!writer)
  {
    parts.emplace_back();
    return;
  }
  writer->SetInputDataObject(data);
  // no appended data: VTK's parsers take its beginning for XML with expat's newer versions
  writer->SetDataModeToBinary();
  writer->SetHeaderTypeToUInt64();
  writer->SetCompressorTypeToNone();
  writer->WriteToOutputStringOn();
  writer->Write();
  parts.push_back(WithoutNorms(writer->GetOutputString()));
}

vtkSmartPointer<vtkDataObject> TakeData(std::vector<std::string>& parts, std::size_t& next)
{
  if (next >= parts.size())
  {
    return nullptr;
  }
  const auto type = static_cast<int>(TakeNumber(parts, next));
  if (type == VTK_PARTITIONED_DATA_SET_COLLECTION)
  {
    return TakeCollection(parts, next);
  }
  if (type != Nothing && Take(parts, next) == AsBytes)
  {
    return TakeBytes(type, parts, next);
  }
  const auto reader =
    type == Nothing ? nullptr : vtkXMLGenericDataObjectReader::CreateReader(type, false);
  if (!reader)
  {
    return nullptr;
  }
  reader->ReadFromInputStringOn();
  reader->SetInputString(Take(parts, next));
  bool failed = false;
  vtkNew<vtkCallbackCommand> errors; // and nothing is printed
  errors->SetClientData(&failed);
  errors->SetCallback(
    [](vtkObject*, unsigned long, void* found, void*) { *static_cast<bool*>(found) = true; });
  reader->AddObserver(vtkCommand::ErrorEvent, errors);
  reader->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, errors);
  reader->Update();
  return failed ? nullptr : vtkSmartPointer<vtkDataObject>(reader->GetOutputDataObject(0));
}
}
