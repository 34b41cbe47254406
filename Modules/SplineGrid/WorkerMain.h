// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <functional>
#include <string>
#include <vector>

#include <sys/resource.h>
#include <sys/types.h>

namespace knotwork
{
/// What a worker gets and hands over.
using Parts = std::vector<std::string>;

/// The main function of a worker (RunWorker starts it): gives up all that its work does not need,
/// takes its input, works, hands over and ends the process. It writes no files. Arguments are the
/// number of the process that waits, bytes of data, seconds of the processor, and words for the
/// work.
[[noreturn]] void WorkerMain(int argc, char* argv[],
  const std::function<Status(const Parts& words, const Parts& input, Parts& found)>& work);

/// Ends the process with its parent and bounds what it may take.
/// @param written  bytes of a file that it writes.
void ContainProcess(pid_t parent, rlim_t memory, rlim_t cpuSeconds, rlim_t written);
}
