// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <memory>
#include <string>

namespace knotwork
{
/// A start of several processes at once (mpirun, mpiexec), as the environment tells.
struct ParallelStart
{
  std::string Variable; ///< that says so; empty: a single process
  int NumProcesses = 1;
  bool IsFirst = true; ///< the process that speaks for all
};

ParallelStart FindParallelStart();

/// The processes of such a start as VTK's global controller, while it lives.
class ProcessGroup
{
public:
  ProcessGroup();
  ~ProcessGroup();
  ProcessGroup(const ProcessGroup&) = delete;
  ProcessGroup& operator=(const ProcessGroup&) = delete;

  /// Meets the others.
  /// @return LibraryError: they are not found (VTK knows no MPI, or another one than that which
  /// started them).
  Status Join(const ParallelStart& start, int& argc, char**& argv);

  /// Threads of a process so that those of a machine share its cores.
  static int ThreadsOfEach();

  /// Ends all processes, with this one's exit status: what they wait for will not come.
  [[noreturn]] static void Abandon(int exitStatus);

private:
  struct Controller;
  std::unique_ptr<Controller> Own;
};
}
