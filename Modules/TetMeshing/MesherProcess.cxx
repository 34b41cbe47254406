// SPDX-License-Identifier: BSD-3-Clause
#include "MesherProcess.h"

namespace knotwork
{
Status LateMesher(const MesherProgram& program, int seconds)
{
  return { ErrorCode::NotConverged,
    std::string(program.Name) + " did not end within " + std::to_string(seconds) +
      " s; raise TimeLimit, or ask for less quality or fewer points" };
}

Result<std::vector<std::string>> RunMesher(const MesherProgram& program,
  const std::vector<std::string>& words, const std::vector<std::string>& input,
  const WorkerLimits& limits, const std::function<bool()>& goOn, WorkerEnd* end)
{
  const std::string name = program.Name;
  const std::string remedy = std::string("; ") + program.Remedy;
  WorkerAnswer answer = RunWorker(program.File, words, input, limits, goOn);
  if (end)
  {
    *end = answer.End;
  }
  switch (answer.End)
  {
    case WorkerEnd::Done:
      if (answer.Outcome)
      {
        return std::move(answer.Parts);
      }
      return { answer.Outcome.Code,
        answer.Outcome.Code == ErrorCode::InvalidParameter
          ? answer.Outcome.Detail
          : name + " refuses " + program.Input + ": " + answer.Outcome.Detail + remedy };
    case WorkerEnd::Missing:
      return { ErrorCode::LibraryError,
        std::string("the program ") + program.File +
          " is missing; install all of Knotwork, or set KNOTWORK_WORKERS to its folder" };
    case WorkerEnd::NotStarted:
      return { ErrorCode::LibraryError,
        "no process could be started for " + name + "; end other programs" };
    case WorkerEnd::Late:
      return LateMesher(program, limits.Seconds);
    case WorkerEnd::OutOfMemory:
      return { ErrorCode::TooLarge,
        name + " asked for more than " + std::to_string(limits.Memory >> 20U) +
          " MB; raise MemoryLimit, or ask for larger tetrahedra" };
    case WorkerEnd::Aborted:
      return { ErrorCode::Aborted, "" };
    case WorkerEnd::Crashed:
      break;
  }
  return { ErrorCode::LibraryError, name + " crashed on " + program.Input + remedy };
}
}
