// SPDX-License-Identifier: BSD-3-Clause
// usage: knotwork-run PARENT BYTES SECONDS FOLDER PROGRAM [ARGUMENT...]
// Becomes a program of others in a folder, contained as a worker is; see RunForeignProgram. What it
// prints goes to the process that waits.
#include "../WorkerStatus.h"
#include <knotwork/SplineGrid/WorkerMain.h>

#include <cstdlib>

#include <unistd.h>

int main(int argc, char* argv[])
{
  if (argc < 6)
  {
    return 2;
  }
  const rlim_t memory = std::strtoull(argv[2], nullptr, 10);
  knotwork::ContainProcess(
    static_cast<pid_t>(std::atoi(argv[1])), memory, std::strtoull(argv[3], nullptr, 10), memory);
  if (chdir(argv[4]) != 0 || setenv("HOME", argv[4], 1) != 0 ||
    dup2(knotwork::WorkerDescriptor, STDOUT_FILENO) < 0 ||
    dup2(knotwork::WorkerDescriptor, STDERR_FILENO) < 0)
  {
    return knotwork::WorkerNotStarted;
  }
  close(knotwork::WorkerDescriptor);
  execv(argv[5], argv + 5);
  return knotwork::WorkerNotStarted;
}
