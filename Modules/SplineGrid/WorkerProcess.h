// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkSplineGridModule.h" // for export macro
#include <knotwork/SplineCore/Status.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace knotwork
{
/// What a process may take.
struct WorkerLimits
{
  std::uint64_t Memory = std::uint64_t{ 1 } << 32U; ///< bytes of data; also of what it hands over
  int CpuSeconds = 600;                             ///< of all its threads
  int Seconds = 1800;                               ///< until it has ended
};

enum class WorkerEnd
{
  Done,
  Missing,    ///< there is no such program
  NotStarted, ///< no process could be started
  Late,       ///< the time was over
  OutOfMemory,
  Crashed, ///< ended without an answer, or with none that can be read
  Aborted  ///< by the caller
};

struct WorkerAnswer
{
  WorkerEnd End = WorkerEnd::Crashed;
  Status Outcome;                 ///< Done: what the worker itself says
  std::vector<std::string> Parts; ///< what it hands over
};

/// Runs a program of libexec/knotwork, which works for this one and may crash, hang or ask for
/// gigabytes without harm (its main function is WorkerMain). The programs lie beside this library,
/// in ../libexec/knotwork, or in the folder that the environment variable KNOTWORK_WORKERS names.
/// @param words  arguments for it.
/// @param input  parts that it gets first.
/// @param goOn   asked about ten times a second; false ends the process.
/// @complexity that of the work, and about 10 ms
VTKKNOTWORKSPLINEGRID_EXPORT WorkerAnswer RunWorker(const std::string& program,
  const std::vector<std::string>& words, const std::vector<std::string>& input,
  const WorkerLimits& limits, const std::function<bool()>& goOn = {});

struct ProgramAnswer
{
  WorkerEnd End = WorkerEnd::Crashed; ///< Done: it has ended by itself, whatever its status
  int ExitStatus = 0;
  std::string Printed; ///< the last 64 kB of its standard output and error
};

/// Runs a program of others, found on PATH, under the same limits. Its home is the folder too, so
/// that nobody's settings change what it does. It and what it has started end with this process.
/// @param folder  it works here; what it writes may have as many bytes as its memory.
VTKKNOTWORKSPLINEGRID_EXPORT ProgramAnswer RunForeignProgram(const std::string& program,
  const std::vector<std::string>& words, const std::string& folder, const WorkerLimits& limits,
  const std::function<bool()>& goOn = {});

/// Full path of a script that such a program is to run, installed where the programs of RunWorker
/// are (knotwork_add_worker_script); empty where there is none.
VTKKNOTWORKSPLINEGRID_EXPORT std::string PathOfWorkerScript(const std::string& name);

/// A folder for files of such programs, removed at the end of its life.
class VTKKNOTWORKSPLINEGRID_EXPORT TemporaryFolder
{
public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// Empty where it could not be made.
  const std::string& Path() const { return this->Folder; }

private:
  std::string Folder;
};
}
