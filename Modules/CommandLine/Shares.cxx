// SPDX-License-Identifier: BSD-3-Clause
#include "Shares.h"

#include <knotwork/SplineGrid/Bytes.h>
#include <knotwork/SplineGrid/Processes.h>
#include <knotwork/SplineIO/DataParts.h>
#include <knotwork/SplineIO/PieceFiles.h>

#include <vtkAbstractArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSet.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace knotwork
{
namespace
{
/// Every data set of an object, in order.
std::vector<vtkDataSet*> SetsOf(vtkDataObject* data)
{
  std::vector<vtkDataSet*> sets;
  if (auto* one = vtkDataSet::SafeDownCast(data))
  {
    sets.push_back(one);
  }
  auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(data);
  for (unsigned int b = 0; collection && b < collection->GetNumberOfPartitionedDataSets(); ++b)
  {
    for (unsigned int i = 0; i < collection->GetNumberOfPartitions(b); ++i)
    {
      if (vtkDataSet* set = collection->GetPartition(b, i))
      {
        sets.push_back(set);
      }
    }
  }
  return sets;
}

/// A collection like another one, with its own containers for the same data sets.
vtkSmartPointer<vtkPartitionedDataSetCollection> CopyContainers(
  vtkPartitionedDataSetCollection* collection)
{
  auto copy = vtkSmartPointer<vtkPartitionedDataSetCollection>::New();
  copy->ShallowCopy(collection);
  for (unsigned int b = 0; b < collection->GetNumberOfPartitionedDataSets(); ++b)
  {
    vtkNew<vtkPartitionedDataSet> block;
    block->ShallowCopy(collection->GetPartitionedDataSet(b));
    copy->SetPartitionedDataSet(b, block);
  }
  return copy;
}

vtkSmartPointer<vtkDataObject> ShareOfCells(vtkDataObject* whole)
{
  const Processes::Part part =
    Processes::PartOf(static_cast<std::size_t>(whole->GetNumberOfElements(vtkDataObject::CELL)),
      Processes::Own(), Processes::Count());
  std::size_t firstCell = 0;
  std::size_t firstPoint = 0;
  const auto shareOf = [&](vtkDataSet* set) -> vtkSmartPointer<vtkDataSet>
  {
    auto* grid = vtkUnstructuredGrid::SafeDownCast(set);
    if (!grid)
    {
      return set;
    }
    const auto count = static_cast<std::size_t>(grid->GetNumberOfCells());
    const auto within = [&](std::size_t at)
    { return std::clamp(at, firstCell, firstCell + count) - firstCell; };
    auto share = CellRange(grid, within(part.Begin), within(part.End), firstPoint);
    firstCell += count;
    firstPoint += static_cast<std::size_t>(grid->GetNumberOfPoints());
    return share;
  };
  auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(whole);
  if (!collection)
  {
    return vtkSmartPointer<vtkDataObject>(shareOf(vtkDataSet::SafeDownCast(whole)));
  }
  auto copy = CopyContainers(collection);
  for (unsigned int b = 0; b < copy->GetNumberOfPartitionedDataSets(); ++b)
  {
    for (unsigned int i = 0; i < copy->GetNumberOfPartitions(b); ++i)
    {
      if (vtkDataSet* set = copy->GetPartition(b, i))
      {
        copy->SetPartition(b, i, shareOf(set));
      }
    }
  }
  return copy;
}

vtkSmartPointer<vtkDataObject> ShareOfPoints(vtkDataObject* whole)
{
  auto* all = vtkPointSet::SafeDownCast(whole);
  const Processes::Part part = Processes::PartOf(
    static_cast<std::size_t>(all->GetNumberOfPoints()), Processes::Own(), Processes::Count());
  const auto begin = static_cast<vtkIdType>(part.Begin);
  const auto end = static_cast<vtkIdType>(part.End);
  const auto points =
    vtkSmartPointer<vtkPointSet>::Take(vtkPointSet::SafeDownCast(all->NewInstance()));
  vtkNew<vtkPoints> places;
  places->SetDataType(all->GetPoints()->GetDataType());
  places->SetNumberOfPoints(end - begin);
  places->GetData()->InsertTuples(0, end - begin, begin, all->GetPoints()->GetData());
  points->SetPoints(places);
  points->GetPointData()->CopyAllOn();
  points->GetPointData()->CopyAllocate(all->GetPointData(), end - begin);
  points->GetPointData()->CopyData(all->GetPointData(), 0, end - begin, begin);
  points->GetFieldData()->ShallowCopy(all->GetFieldData());
  return points;
}

vtkSmartPointer<vtkDataObject> ShareOfFirst(vtkDataObject* whole)
{
  return Processes::Own() == 0 ? vtkSmartPointer<vtkDataObject>(whole)
                               : vtkSmartPointer<vtkDataObject>::Take(whole->NewInstance());
}

vtkSmartPointer<vtkDataObject> ShareOfBlocks(vtkDataObject* whole)
{
  auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(whole);
  if (!collection)
  {
    return ShareOfFirst(whole);
  }
  auto copy = CopyContainers(collection);
  const unsigned int count = copy->GetNumberOfPartitionedDataSets();
  const Processes::Part part = Processes::PartOf(count, Processes::Own(), Processes::Count());
  for (unsigned int b = 0; b < count; ++b)
  {
    if (b < part.Begin || b >= part.End)
    {
      copy->SetPartitionedDataSet(b, vtkNew<vtkPartitionedDataSet>());
    }
  }
  return copy;
}

std::string NameOf(vtkAbstractArray* array)
{
  return array->GetName() ? array->GetName() : "";
}

std::size_t SizeOf(vtkDataArray* array)
{
  return static_cast<std::size_t>(
    array->GetNumberOfValues() * static_cast<vtkIdType>(array->GetDataTypeSize()));
}

/// Type, components, tuples, name and values.
void AddArray(vtkDataArray* array, Bytes& bytes)
{
  bytes.Add(array->GetDataType());
  bytes.Add(array->GetNumberOfComponents());
  bytes.Add(array->GetNumberOfTuples());
  bytes.Add(NameOf(array));
  bytes.AddRaw(static_cast<const char*>(array->GetVoidPointer(0)), SizeOf(array));
}

vtkSmartPointer<vtkDataArray> TakeArray(Bytes& bytes)
{
  const int type = bytes.Take<int>();
  const auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  array->SetNumberOfComponents(bytes.Take<int>());
  array->SetNumberOfTuples(bytes.Take<vtkIdType>());
  array->SetName(bytes.Take<std::string>().c_str());
  bytes.TakeRaw(static_cast<char*>(array->GetVoidPointer(0)), SizeOf(array));
  return array;
}

/// Data objects as DataParts.h hands them over: the number of the parts, then each.
void AddObject(vtkDataObject* data, Bytes& bytes)
{
  std::vector<std::string> parts;
  AppendParts(data, parts);
  bytes.Add(std::uint64_t{ parts.size() });
  for (const std::string& part : parts)
  {
    bytes.Add(part);
  }
}

vtkSmartPointer<vtkDataObject> TakeObject(Bytes& bytes)
{
  std::vector<std::string> parts(bytes.Take<std::uint64_t>());
  for (std::string& part : parts)
  {
    part = bytes.Take<std::string>();
  }
  std::size_t next = 0;
  return TakeData(parts, next);
}

constexpr int NumKinds = 2; ///< attributes of points, of cells

vtkDataSetAttributes* AttributesOf(vtkDataSet* set, int kind)
{
  return set->GetAttributes(kind == 0 ? vtkDataObject::POINT : vtkDataObject::CELL);
}

/// The names of the output's arrays in order, and those that the input has not.
void PackAttributes(vtkDataSetAttributes* input, vtkDataSetAttributes* output, Bytes& bytes)
{
  std::vector<vtkDataArray*> made;
  bytes.Add(std::uint64_t(output->GetNumberOfArrays()));
  for (int i = 0; i < output->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = output->GetAbstractArray(i);
    bytes.Add(NameOf(array));
    if (input->GetAbstractArray(array->GetName()) != array)
    {
      made.push_back(vtkDataArray::SafeDownCast(array)); // filters make numbers alone
    }
  }
  vtkDataArray* scalars = output->GetScalars();
  bytes.Add(scalars ? NameOf(scalars) : std::string());
  bytes.Add(std::uint64_t{ made.size() });
  for (vtkDataArray* array : made)
  {
    AddArray(array, bytes);
  }
}

struct Attributes
{
  std::vector<std::string> Names;
  std::string Scalars;
  std::vector<vtkSmartPointer<vtkDataArray>> Made;
};

Attributes UnpackAttributes(Bytes& bytes)
{
  Attributes found;
  found.Names.resize(bytes.Take<std::uint64_t>());
  for (std::string& name : found.Names)
  {
    name = bytes.Take<std::string>();
  }
  found.Scalars = bytes.Take<std::string>();
  found.Made.resize(bytes.Take<std::uint64_t>());
  for (auto& array : found.Made)
  {
    array = TakeArray(bytes);
  }
  return found;
}

/// Arrays one after the other.
vtkSmartPointer<vtkDataArray> Joined(const std::vector<vtkSmartPointer<vtkDataArray>>& parts)
{
  const auto whole = vtkSmartPointer<vtkDataArray>::Take(parts.front()->NewInstance());
  whole->SetName(parts.front()->GetName());
  whole->SetNumberOfComponents(parts.front()->GetNumberOfComponents());
  for (const auto& part : parts)
  {
    whole->InsertTuples(whole->GetNumberOfTuples(), part->GetNumberOfTuples(), 0, part);
  }
  return whole;
}

void JoinAttributes(
  const std::vector<Attributes>& parts, vtkDataSetAttributes* whole, vtkDataSetAttributes* joined)
{
  joined->Initialize();
  const Attributes& first = parts.front();
  for (const std::string& name : first.Names)
  {
    const auto hasName = [&name](const auto& array) { return array->GetName() == name; };
    const auto made = std::find_if(first.Made.begin(), first.Made.end(), hasName);
    if (made == first.Made.end())
    {
      if (vtkAbstractArray* kept = whole->GetAbstractArray(name.c_str()))
      {
        joined->AddArray(kept);
      }
      continue;
    }
    std::vector<vtkSmartPointer<vtkDataArray>> arrays;
    for (const Attributes& part : parts)
    {
      arrays.push_back(part.Made[static_cast<std::size_t>(made - first.Made.begin())]);
    }
    joined->AddArray(Joined(arrays));
  }
  for (int type = 0; type < vtkDataSetAttributes::NUM_ATTRIBUTES; ++type)
  {
    vtkAbstractArray* active = whole->GetAbstractAttribute(type);
    if (active && active->GetName() && type != vtkDataSetAttributes::SCALARS &&
      joined->HasArray(active->GetName()) != 0)
    {
      joined->SetActiveAttribute(active->GetName(), type);
    }
  }
  joined->SetActiveScalars(first.Scalars.empty() ? nullptr : first.Scalars.c_str());
}

/// What a process has made of its share of a data set.
std::string PackSet(vtkDataSet* input, vtkDataSet* output)
{
  Bytes bytes;
  for (int kind = 0; kind < NumKinds; ++kind)
  {
    PackAttributes(AttributesOf(input, kind), AttributesOf(output, kind), bytes);
  }
  auto* before = vtkPointSet::SafeDownCast(input);
  auto* after = vtkPointSet::SafeDownCast(output);
  const bool isMoved = after->GetPoints() && after->GetPoints() != before->GetPoints();
  bytes.Add(isMoved);
  if (isMoved)
  {
    AddArray(after->GetPoints()->GetData(), bytes);
  }
  return bytes.Get();
}

void JoinSet(const std::vector<std::string>& parts, vtkDataSet* whole, vtkDataSet* joined)
{
  std::vector<std::vector<Attributes>> attributes(NumKinds);
  std::vector<vtkSmartPointer<vtkDataArray>> places;
  for (const std::string& part : parts)
  {
    Bytes bytes(part);
    for (auto& kind : attributes)
    {
      kind.push_back(UnpackAttributes(bytes));
    }
    if (bytes.Take<bool>())
    {
      places.push_back(TakeArray(bytes));
    }
  }
  for (int kind = 0; kind < NumKinds; ++kind)
  {
    JoinAttributes(attributes[static_cast<std::size_t>(kind)], AttributesOf(whole, kind),
      AttributesOf(joined, kind));
  }
  if (!places.empty())
  {
    vtkNew<vtkPoints> points;
    points->SetData(Joined(places));
    vtkPointSet::SafeDownCast(joined)->SetPoints(points);
  }
}
}

vtkSmartPointer<vtkDataObject> ShareOf(vtkDataObject* whole, Share share)
{
  switch (share)
  {
    case Share::Cells:
      return ShareOfCells(whole);
    case Share::Points:
      return ShareOfPoints(whole);
    case Share::Blocks:
      return ShareOfBlocks(whole);
    case Share::First:
      return ShareOfFirst(whole);
    case Share::All:
      break;
  }
  return whole;
}

vtkSmartPointer<vtkDataObject> JoinShares(
  Share share, vtkDataObject* whole, vtkDataObject* input, vtkDataObject* output)
{
  const std::vector<vtkDataSet*> before = SetsOf(input);
  const std::vector<vtkDataSet*> after = SetsOf(output);
  // a process without a share has made nothing
  Bytes bytes;
  const bool isIdle = after.size() != before.size() ||
    input->GetNumberOfElements(
      share == Share::Cells ? vtkDataObject::CELL : vtkDataObject::POINT) == 0;
  for (std::size_t i = 0; i < before.size() && !isIdle; ++i)
  {
    bytes.Add(PackSet(before[i], after[i]));
  }
  std::vector<Bytes> all;
  for (std::string& one : Processes::Collect(bytes.Get()))
  {
    if (!one.empty())
    {
      all.emplace_back(std::move(one));
    }
  }
  if (Processes::Own() != 0)
  {
    return nullptr;
  }
  auto joined = vtkSmartPointer<vtkDataObject>::Take(whole->NewInstance());
  joined->ShallowCopy(whole);
  if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(whole))
  {
    auto copy = CopyContainers(collection);
    for (unsigned int b = 0; b < copy->GetNumberOfPartitionedDataSets(); ++b)
    {
      for (unsigned int i = 0; i < copy->GetNumberOfPartitions(b); ++i)
      {
        if (vtkDataSet* set = copy->GetPartition(b, i))
        {
          const auto own = vtkSmartPointer<vtkDataSet>::Take(set->NewInstance());
          own->ShallowCopy(set);
          copy->SetPartition(b, i, own);
        }
      }
    }
    joined = copy;
  }
  const std::vector<vtkDataSet*> sets = SetsOf(whole);
  const std::vector<vtkDataSet*> results = SetsOf(joined);
  for (std::size_t i = 0; i < sets.size() && !all.empty(); ++i)
  {
    std::vector<std::string> parts;
    for (Bytes& one : all)
    {
      parts.push_back(one.Take<std::string>());
    }
    JoinSet(parts, sets[i], results[i]);
    vtkNew<vtkFieldData> fields; // of its own: copies of one that is shared lose it
    fields->ShallowCopy((isIdle ? sets : after)[i]->GetFieldData());
    results[i]->SetFieldData(fields);
  }
  return joined;
}

Result<std::vector<vtkSmartPointer<vtkDataObject>>> CollectPieces(vtkDataObject* output)
{
  const bool isEmpty = output->GetNumberOfElements(vtkDataObject::POINT) == 0;
  Bytes bytes;
  if (Processes::Own() != 0 && !isEmpty)
  {
    AddObject(output, bytes);
  }
  std::vector<vtkSmartPointer<vtkDataObject>> pieces;
  if (!isEmpty)
  {
    pieces.emplace_back(output);
  }
  for (std::string& one : Processes::Collect(bytes.Get()))
  {
    if (one.empty())
    {
      continue;
    }
    Bytes sent(std::move(one));
    pieces.push_back(TakeObject(sent));
    if (!pieces.back())
    {
      return { ErrorCode::LibraryError, "what another process has made cannot be taken over" };
    }
  }
  return pieces;
}

Result<vtkSmartPointer<vtkDataObject>> AppendShares(vtkDataObject* output)
{
  auto collected = CollectPieces(output);
  if (!collected)
  {
    return collected.Status;
  }
  const auto& pieces = collected.Value;
  if (Processes::Own() != 0 || pieces.size() < 2)
  {
    return pieces.empty() ? vtkSmartPointer<vtkDataObject>(output) : pieces.front();
  }
  if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(output))
  {
    auto joined = CopyContainers(collection);
    for (const auto& piece : pieces)
    {
      auto* blocks = vtkPartitionedDataSetCollection::SafeDownCast(piece);
      for (unsigned int b = 0; b < blocks->GetNumberOfPartitionedDataSets(); ++b)
      {
        for (unsigned int i = 0; i < blocks->GetNumberOfPartitions(b); ++i)
        {
          vtkDataSet* set = blocks->GetPartition(b, i);
          if (set && set->GetNumberOfPoints() > 0)
          {
            joined->SetPartition(b, i, set);
          }
        }
      }
    }
    return vtkSmartPointer<vtkDataObject>(joined);
  }
  return JoinPieces(pieces);
}

vtkSmartPointer<vtkDataObject> SameForAll(vtkDataObject* data, int from)
{
  if (Processes::Count() == 1)
  {
    return data;
  }
  Bytes bytes;
  if (Processes::Own() == from)
  {
    AddObject(data, bytes);
  }
  Bytes sent(Processes::Broadcast(bytes.Get(), from));
  return Processes::Own() == from ? vtkSmartPointer<vtkDataObject>(data) : TakeObject(sent);
}
}
