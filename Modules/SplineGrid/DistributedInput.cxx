// SPDX-License-Identifier: BSD-3-Clause
#include "DistributedInput.h"

#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <string>
#include <vector>

namespace knotwork
{
namespace
{
int NumberOfProcesses()
{
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  return controller ? controller->GetNumberOfProcesses() : 1;
}

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
  return std::max(NumberOfProcesses(), PiecesAskedFor(outputs));
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
  const int processes = NumberOfProcesses();
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
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  std::vector<int> all(static_cast<std::size_t>(processes), 0);
  controller->AllGather(&mine, all.data(), 1);
  const auto withData = std::count(all.begin(), all.end(), 1);
  if (withData <= 1)
  {
    return {};
  }
  speaks = std::find(all.begin(), all.end(), 1) - all.begin() == controller->GetLocalProcessId();
  return { ErrorCode::InvalidTopology,
    "the whole input is needed, and it is spread over " + std::to_string(withData) + " of " +
      std::to_string(processes) + " processes" + Remedy };
}

Status CheckOneWriter(vtkDataObject* data, bool& idle)
{
  const int processes = NumberOfProcesses();
  idle = processes > 1 && !HasElements(data);
  return processes <= 1 || idle ? Status()
                                : Status(ErrorCode::InvalidTopology,
                                    "this is one of " + std::to_string(processes) +
                                      " processes, each of which would write the file" + Remedy +
                                      "; VTK's own writers of .pvtu and .vtpc write in pieces");
}
}
