// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <functional>
#include <string>
#include <vector>

namespace knotwork
{
/// What a worker hands over.
using Parts = std::vector<std::string>;

/// The main function of a worker: gives up all that reading a file does not need, reads, hands over
/// and ends the process. Arguments are the number of the process that waits, bytes of data, seconds
/// of the processor, the file, and options.
[[noreturn]] void RunWorker(int argc, char* argv[],
  const std::function<Status(const std::string& file, const Parts& options, Parts& found)>& read);
}
