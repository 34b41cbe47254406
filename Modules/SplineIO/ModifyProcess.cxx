// SPDX-License-Identifier: BSD-3-Clause
#include "ModifyProcess.h"

#include "ModifyParts.h"
#include <knotwork/SplineCore/FileOutput.h>
#include <knotwork/SplineGrid/WorkerProcess.h>

namespace knotwork
{
namespace
{
constexpr const char* Program = "knotwork-modify-cad";

/// Cuts of large parts take minutes.
WorkerLimits LimitsOfModification()
{
  WorkerLimits limits;
  limits.Memory = std::uint64_t{ 1 } << 34U;
  limits.CpuSeconds = 3600;
  limits.Seconds = 7200;
  return limits;
}
}

Result<std::vector<CADStep>> ModifyCADInProcess(const std::string& file, const std::string& output,
  const std::vector<CADOperation>& operations, const CADModifyParams& params,
  const std::function<bool()>& goOn)
{
  const std::string place = "'" + file + "'";
  std::vector<std::string> input;
  AppendTask({ operations, params }, input);
  const WorkerLimits limits = LimitsOfModification();
  const WorkerAnswer answer = RunWorker(Program, { file, output }, input, limits, goOn);
  const std::string remedy = "; heal the part, or move the cut";
  switch (answer.End)
  {
    case WorkerEnd::Done:
    {
      auto made = answer.Outcome ? TakeModified(answer.Parts) : Result<ModifiedCAD>(answer.Outcome);
      const Status status = made ? PutText(made->Text, output) : made.Status;
      return status ? Result<std::vector<CADStep>>(std::move(made->Steps))
                    : Result<std::vector<CADStep>>(status);
    }
    case WorkerEnd::Missing:
      return { ErrorCode::LibraryError,
        place + " cannot be modified: the program " + Program +
          " is missing; install all of Knotwork, or set KNOTWORK_WORKERS to its folder" };
    case WorkerEnd::NotStarted:
      return { ErrorCode::LibraryError,
        place + " cannot be modified: no process could be started for it; end other programs" };
    case WorkerEnd::Late:
      return { ErrorCode::NotConverged,
        place + ": OpenCASCADE did not end within " + std::to_string(limits.CpuSeconds) + " s" +
          remedy };
    case WorkerEnd::OutOfMemory:
      return { ErrorCode::TooLarge,
        place + ": OpenCASCADE asked for more than " + std::to_string(limits.Memory >> 20U) +
          " MB" + remedy };
    case WorkerEnd::Aborted:
      return { ErrorCode::Aborted, "" };
    case WorkerEnd::Crashed:
      break;
  }
  return { ErrorCode::LibraryError, place + ": OpenCASCADE crashes on it" + remedy };
}
}
