// SPDX-License-Identifier: BSD-3-Clause
#include "ParallelStart.h"

#include "Termination.h"

#include <knotwork/SplineGrid/Processes.h>

#ifdef KNOTWORK_MPI
#include <vtkMPIController.h>
#include <vtkNew.h>
#endif

#include <algorithm>
#include <array>
#include <cstdlib>
#include <thread>
#include <vector>

#include <unistd.h>

namespace knotwork
{
namespace
{
std::string HostName()
{
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}
}

ParallelStart FindParallelStart()
{
  // Open MPI; MPICH and Intel MPI; MVAPICH
  constexpr const char* variables[][2] = { { "OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK" },
    { "PMI_SIZE", "PMI_RANK" }, { "MV2_COMM_WORLD_SIZE", "MV2_COMM_WORLD_RANK" } };
  ParallelStart start;
  for (const auto& [sizeName, rankName] : variables)
  {
    const char* size = std::getenv(sizeName);
    if (size && std::atol(size) > 1)
    {
      const char* rank = std::getenv(rankName);
      start.IsFirst = !rank || std::atol(rank) == 0;
      start.Variable = sizeName;
      start.NumProcesses = static_cast<int>(std::atol(size));
      return start;
    }
  }
  return start;
}

#ifdef KNOTWORK_MPI
struct ProcessGroup::Controller
{
  vtkNew<vtkMPIController> MPI;
};

ProcessGroup::~ProcessGroup()
{
  if (this->Own)
  {
    vtkMultiProcessController::SetGlobalController(nullptr);
    this->Own->MPI->Finalize();
  }
}

Status ProcessGroup::Join(const ParallelStart& start, int& argc, char**& argv)
{
  this->Own = std::make_unique<Controller>();
  this->Own->MPI->Initialize(&argc, &argv);
  const int found = this->Own->MPI->GetNumberOfProcesses();
  if (found != start.NumProcesses)
  {
    return { ErrorCode::LibraryError,
      start.Variable + " is " + std::to_string(start.NumProcesses) +
        ", and VTK's MPI finds a group of " + std::to_string(found) +
        "; start with the mpirun of the MPI that VTK is built with" };
  }
  vtkMultiProcessController::SetGlobalController(this->Own->MPI);
  // those of this machine, in order: the first that lives speaks where a signal ends them
  std::vector<int> before;
  const std::vector<std::string> hosts = Processes::Exchange(HostName());
  const std::vector<int> ids = Processes::ExchangeNumber(static_cast<int>(getpid()));
  for (int process = 0; process < Processes::Own(); ++process)
  {
    if (hosts[static_cast<std::size_t>(process)] == HostName())
    {
      before.push_back(ids[static_cast<std::size_t>(process)]);
    }
  }
  Termination::SpeakAfter(before);
  return {};
}

#else
struct ProcessGroup::Controller
{
};
ProcessGroup::~ProcessGroup() = default;
Status ProcessGroup::Join(const ParallelStart& start, int&, char**&)
{
  return { ErrorCode::LibraryError,
    start.Variable + " is " + std::to_string(start.NumProcesses) +
      ", and VTK is built without MPI; start it without mpirun" };
}
#endif

ProcessGroup::ProcessGroup() = default;

/// mpirun ends the others of a process that goes without a word to them.
void ProcessGroup::Abandon(int exitStatus)
{
  std::_Exit(exitStatus);
}

int ProcessGroup::ThreadsOfEach()
{
  const std::vector<std::string> hosts = Processes::Exchange(HostName());
  const auto here = std::count(hosts.begin(), hosts.end(), HostName());
  return std::max(
    1, static_cast<int>(std::thread::hardware_concurrency()) / static_cast<int>(here));
}
}
