// SPDX-License-Identifier: BSD-3-Clause
// Meshers in processes of their own, private to the module.
#pragma once
#include <knotwork/SplineGrid/WorkerProcess.h>

namespace knotwork
{
struct MesherProgram
{
  const char* File;   ///< of the program
  const char* Name;   ///< of the mesher, in messages
  const char* Input;  ///< as "the surface"
  const char* Remedy; ///< what to do with the input
};

/// What a mesher hands over.
/// @param goOn  false ends it.
/// @param end  result: how the process ended; null: not asked for.
/// @return InvalidTopology, EmptyInput, LibraryError with the mesher's reason, or that it crashed;
/// NotConverged after the time; TooLarge where memory was not enough; Aborted.
Result<std::vector<std::string>> RunMesher(const MesherProgram& program,
  const std::vector<std::string>& words, const std::vector<std::string>& input,
  const WorkerLimits& limits, const std::function<bool()>& goOn, WorkerEnd* end = nullptr);

/// NotConverged: it did not end within the seconds.
Status LateMesher(const MesherProgram& program, int seconds);
}
