// SPDX-License-Identifier: BSD-3-Clause
#include "DistributedInput.h"

#include "Processes.h"
#include "SplineBlocks.h"

#include "vtkCharArray.h"
#include "vtkCommunicator.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace knotwork
{
namespace
{
int PiecesAskedFor(vtkInformationVector* outputs)
{
  int pieces = 1;
  auto* key = vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES();
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkInformation* info = outputs->GetInformationObject(port);
    pieces = std::max(pieces, info->Has(key) ? info->Get(key) : 1);
  }
  return pieces;
}

constexpr const char* Remedy =
  "; work in one process: ParaView's built-in server, or a start without mpirun";
}

int NumberOfPieces(vtkInformationVector* outputs)
{
  return std::max(Processes::Count(), PiecesAskedFor(outputs));
}

bool IsPieceOfEveryProcess(vtkInformationVector* outputs)
{
  return Processes::Count() > 1 && PiecesAskedFor(outputs) == Processes::Count();
}

namespace
{
bool HasElements(vtkDataObject* data)
{
  for (int type : { vtkDataObject::POINT, vtkDataObject::CELL, vtkDataObject::ROW })
  {
    if (data && data->GetNumberOfElements(type) > 0)
    {
      return true;
    }
  }
  return false;
}
}

bool HasData(vtkInformationVector** inputs, int numInputPorts)
{
  for (int port = 0; port < numInputPorts; ++port)
  {
    for (int i = 0; i < inputs[port]->GetNumberOfInformationObjects(); ++i)
    {
      if (HasElements(vtkDataObject::GetData(inputs[port], i)))
      {
        return true;
      }
    }
  }
  return false;
}

Status CheckWholeInput(
  vtkInformationVector** inputs, int numInputPorts, vtkInformationVector* outputs, bool& speaks)
{
  speaks = true;
  const int pieces = PiecesAskedFor(outputs);
  const int processes = Processes::Count();
  if (pieces <= 1 && processes <= 1)
  {
    return {};
  }
  const int mine = HasData(inputs, numInputPorts) ? 1 : 0;
  if (pieces != processes)
  {
    return mine == 0
      ? Status()
      : Status(ErrorCode::InvalidTopology,
          (pieces > 1 ? "the whole input is needed, and one of " + std::to_string(pieces) +
                " pieces is asked for"
                      : "the whole input is needed, and this is one of " +
                std::to_string(processes) + " processes: what others have is not known") +
            Remedy);
  }
  const std::vector<int> all = Processes::ExchangeNumber(mine);
  const auto withData = std::count(all.begin(), all.end(), 1);
  if (withData <= 1)
  {
    return {};
  }
  speaks = std::find(all.begin(), all.end(), 1) - all.begin() == Processes::Own();
  return { ErrorCode::InvalidTopology,
    "the whole input is needed, and it is spread over " + std::to_string(withData) + " of " +
      std::to_string(processes) + " processes" + Remedy };
}

namespace
{
/// Of the places and values of all points, 0 without any: equal ones are taken for the same data.
std::uint64_t Fingerprint(vtkDataObject* data)
{
  constexpr std::uint64_t prime = 0x100000001b3; // Fowler, Noll, Vo: FNV-1a
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto add = [&hash](vtkDataArray* array)
  {
    const auto* bytes =
      array ? static_cast<const unsigned char*>(array->GetVoidPointer(0)) : nullptr;
    const auto size = array ? array->GetDataSize() * array->GetDataTypeSize() : 0;
    for (vtkIdType i = 0; i < size; ++i)
    {
      hash = (hash ^ bytes[i]) * prime;
    }
  };
  for (const auto& [block, grid] : GridsByBlock(data))
  {
    add(grid->GetPoints() ? grid->GetPoints()->GetData() : nullptr);
    for (int i = 0; i < grid->GetPointData()->GetNumberOfArrays(); ++i)
    {
      add(grid->GetPointData()->GetArray(i));
    }
  }
  return HasElements(data) ? hash : 0;
}

std::string BytesOf(vtkDataObject* data)
{
  vtkNew<vtkCharArray> bytes;
  vtkCommunicator::MarshalDataObject(data, bytes);
  return { bytes->GetPointer(0), static_cast<std::size_t>(bytes->GetNumberOfTuples()) };
}

vtkSmartPointer<vtkDataObject> DataOf(const std::string& sent)
{
  vtkNew<vtkCharArray> bytes;
  bytes->SetNumberOfTuples(static_cast<vtkIdType>(sent.size()));
  std::copy(sent.begin(), sent.end(), bytes->GetPointer(0));
  return vtkCommunicator::UnMarshalDataObject(bytes);
}
}

Result<vtkSmartPointer<vtkDataObject>> WholeForAll(vtkDataObject* own)
{
  int from = -1;
  int withData = 0;
  bool same = true;
  std::uint64_t first = 0;
  int process = 0;
  for (const auto& one : Processes::Exchange(std::vector<std::uint64_t>{ Fingerprint(own) }))
  {
    if (one.front() != 0)
    {
      from = from < 0 ? process : from;
      first = from == process ? one.front() : first;
      same = same && one.front() == first;
      ++withData;
    }
    ++process;
  }
  if (!same)
  {
    return { ErrorCode::InvalidTopology,
      "the input that every process needs whole is spread over " + std::to_string(withData) +
        " of them; have it in one, or the same in all" };
  }
  if (withData == 0 || withData == Processes::Count())
  {
    return vtkSmartPointer<vtkDataObject>(withData == 0 ? nullptr : own);
  }
  const std::string sent =
    Processes::Broadcast(from == Processes::Own() ? BytesOf(own) : std::string(), from);
  return HasElements(own) ? vtkSmartPointer<vtkDataObject>(own) : DataOf(sent);
}

std::vector<vtkSmartPointer<vtkDataObject>> CollectData(vtkDataObject* own)
{
  std::vector<vtkSmartPointer<vtkDataObject>> all;
  for (const std::string& bytes :
    Processes::Collect(Processes::Own() == 0 ? std::string() : BytesOf(own)))
  {
    all.push_back(all.empty() ? vtkSmartPointer<vtkDataObject>(own) : DataOf(bytes));
  }
  return all;
}

Status CheckOneWriter(vtkDataObject* data, bool& idle)
{
  const int processes = Processes::Count();
  idle = processes > 1 && !HasElements(data);
  return processes <= 1 || idle ? Status()
                                : Status(ErrorCode::InvalidTopology,
                                    "this is one of " + std::to_string(processes) +
                                      " processes, each of which would write the file" + Remedy +
                                      "; VTK's own writers of .pvtu and .vtpc write in pieces");
}
}
